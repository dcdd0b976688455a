# The figures of the paper are made from the scenes that come with the program, each under its own name.
halflight figures 12-cube --size 16x16 --quiet
ls
halflight figures beams-b --size 16x16 --quiet -o '%s-again.png'
cmp fig12-cube-beams-b.png fig12-cube-beams-b-again.png
halflight render "$SOURCE/examples/fig12-cube-beams-a.json" --size 16x16 --quiet -o alone.png
halflight diff --max-error 0 alone.png fig12-cube-beams-a.png >/dev/null
halflight figures --help | grep -c -e '--size' -e '--output' -e '--data'
halflight figures no-such 2>error || echo "exit $?"
cat error
halflight figures a/b 2>error || echo "exit $?"
cat error
# --list names figures.
halflight figures 12 --list
# The text may be a name as --list writes it, or its beginning.
halflight figures fig01 --list
halflight figures fig23-hole --list
halflight figures --list | grep -c '^fig'
