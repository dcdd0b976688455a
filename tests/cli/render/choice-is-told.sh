# That the transfer function was chosen from the file is told on a terminal and in the statistics, and not where it was not.
tool ball 16 ball_16x16x16_uint8.raw
on_terminal() { # what the program says on a terminal
  "$PYTHON" - "$@" <<'END'
import os, pty, sys
main, end = pty.openpty()
if os.fork() == 0:
    os.dup2(end, 2)
    os.execvp(os.environ["HALFLIGHT"], ["halflight", *sys.argv[1:]])
os.wait()
os.close(end)
text = b""
try:
    while piece := os.read(main, 4096):
        text += piece
except OSError:
    pass
print(text.count(b"chosen from this file"), text.count(b"scanned matter"), text.count(b"--look translucent"))
END
}
on_terminal render ball_16x16x16_uint8.raw --size 16x16
on_terminal render ball_16x16x16_uint8.raw --size 16x16 --tf ct-bone
on_terminal render ball_16x16x16_uint8.raw --size 16x16 --look surface
on_terminal render ball_16x16x16_uint8.raw --size 16x16 --quiet
halflight render ball_16x16x16_uint8.raw --size 16x16 2>text
grep -c 'chosen from this file' text || true
halflight render ball_16x16x16_uint8.raw --size 16x16 --json --quiet >a.json
tool json a.json 'd["taken_for"]'
tool json a.json 'd["next_look"]'
halflight render ball_16x16x16_uint8.raw --size 16x16 --json --quiet --tf ct-bone >b.json
tool json b.json '"taken_for" in d'
