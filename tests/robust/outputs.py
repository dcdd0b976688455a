#!/usr/bin/env python3
"""The program when its outputs fail, its inputs stall and its user loses patience; prints TAP.

usage: outputs.py [--quick] PROGRAM

Whatever goes wrong: the exit code and one line on stderr say so, the old file stands, and nothing new lies beside it.
--quick leaves out kinds of files that the program writes by the same code as another kind.
"""
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

os.environ.pop("MALLOC_PERTURB_", None)  # fills what is freed, which takes longer than giving it back
QUICK = sys.argv[1] == "--quick"
PROGRAM = str(pathlib.Path(sys.argv[-1]).resolve())
TOOL = str(pathlib.Path(__file__).resolve().parent.parent / "cli" / "tool.py")
OLD = b"old"
UNSUPPORTED = 4  # the exit code where the build lacks a library
HANG = 1800  # seconds; no run takes a tenth of it, on a slow machine either

# (name, arguments, outputs): every kind of file that the program writes
OUTPUTS = [
    ("png", "render ball_16x16x16_uint8.raw --size 60x60 -o out.png", ["out.png"]),
    ("png 16", "render ball_16x16x16_uint8.raw --size 60x60 --depth 16 -o out.png", ["out.png"]),
    ("exr", "render ball_16x16x16_uint8.raw --size 60x60 -o out.exr", ["out.exr"]),
    ("npy", "render ball_16x16x16_uint8.raw --size 60x60 -o out.npy", ["out.npy"]),
    ("exr with layers", "render ball_16x16x16_uint8.raw --size 60x60 --layers -o out.exr", ["out.exr"]),
    ("npy with layers", "render ball_16x16x16_uint8.raw --size 60x60 --layers -o out.npy",
     ["out.npy", "out-ambient.npy"]),
    ("nrrd", "make rings --size 24 -o out.nrrd", ["out.nrrd"]),
    ("tiff", "render ball_16x16x16_uint8.raw --size 60x60 -o out.tif", ["out.tif"]),
    ("pdf with a scale bar", "render ball_16x16x16_uint8.raw --size 60x60 --scale-bar auto --unit mm --ortho -o out.pdf", ["out.pdf"]),
    ("svg with a scale bar", "render ball_16x16x16_uint8.raw --size 60x60 --scale-bar auto --unit mm --ortho -o out.svg", ["out.svg"]),
    ("looks", "looks ball_16x16x16_uint8.raw --size 100 -o out.png", ["out.png"]),
    ("difference", "diff a.npy b.npy -o out.png", ["out.png"]),
    *((f"converted to {ending}", f"convert ball_16x16x16_uint8.raw -o out{ending}", [f"out{ending}"])
      for ending in (".nii", ".nii.gz", ".mha", ".vti", ".mrc", ".npy", "_16x16x16_uint8.raw", "_16x16x16_uint8.raw.gz")),
    *((f"surface as {ending}", f"convert ball_16x16x16_uint8.raw --iso 100 -o out{ending}", [f"out{ending}"]) for ending in (".ply", ".stl", ".obj")),
    ("converted picture", "convert a.npy -o out.tif", ["out.tif"]),
]
ALIKE = {"png 16", "exr", "npy", "svg with a scale bar", "looks", "converted to .nii", "converted to _16x16x16_uint8.raw"}  # another one is like each
FILMS = (".gif", ".mp4", ".mov", ".mkv", ".webm")
if QUICK:
    OUTPUTS, FILMS = [output for output in OUTPUTS if output[0] not in ALIKE], FILMS[:1]


class Skip(Exception):
    pass


def run(arguments, **options):
    return subprocess.run([PROGRAM, *arguments.split(), *([] if arguments.startswith("diff") else ["--quiet"])],
                          stdin=subprocess.DEVNULL, stdout=options.pop("stdout", subprocess.PIPE),
                          stderr=subprocess.PIPE, timeout=HANG, **options)


def check(condition, what):
    if not condition:
        raise AssertionError(what)


def check_failed(done, code, words):
    message = done.stderr.decode(errors="replace")
    check(done.returncode == code, f"exit code {done.returncode}, expected {code}: {message!r}")
    check(message.count("\n") == 1 and message.startswith("halflight: "), f"not one line: {message!r}")
    check(words in message, f"{words!r} is not in {message!r}")


def put_old(names):
    for name in names:
        pathlib.Path(name).write_bytes(OLD)


def check_untouched(before, names):
    check(sorted(os.listdir()) == before, f"the folder had {before}, has {sorted(os.listdir())}")
    for name in names:
        check(pathlib.Path(name).read_bytes() == OLD, f"{name} has changed")


def limit_of(size):
    """To be called in the child. Signals are as a shell leaves them."""
    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
    return limit


def test_files_that_may_not_grow():
    for name, arguments, outputs in OUTPUTS:
        if not outputs:
            continue
        whole = run(arguments).returncode
        if whole == UNSUPPORTED:
            continue
        check(whole == 0, f"{name} does not work at all")
        size = os.path.getsize(outputs[0])
        for limit in (0, size - 1) if QUICK else (0, 1, size // 2, size - 1):
            for other in outputs[1:]:
                if limit >= os.path.getsize(other):
                    os.remove(other)  # written before the picture, and whole
            put_old(outputs)
            before = sorted(os.listdir())
            done = run(arguments, preexec_fn=limit_of(limit))
            check_failed(done, 1, "File too large")
            check(outputs[0][:3] in done.stderr.decode(), "the message names no file")
            check_untouched(before, outputs[:1])
        for path in pathlib.Path().glob("out*"):
            path.unlink()


def test_films_that_may_not_grow():
    """A film that ffmpeg cannot write whole is no film. Its frames are smaller than the limits here, so that they are written."""
    for ending in FILMS if shutil.which("ffmpeg") else ():
        film, arguments = f"film{ending}", f"animate ball_16x16x16_uint8.raw --size 24x24 --sheet-spacing 4 --turntable 40 -o film{ending}"
        check(run(arguments).returncode == 0, f"{film} cannot be made at all")
        size = os.path.getsize(film)
        for limit in (size - 1, (size + 4096) // 2):
            put_old([film])
            done = run(arguments, preexec_fn=limit_of(limit))
            check_failed(done, 1, "File too large")
            check(film in done.stderr.decode() and pathlib.Path(film).read_bytes() == OLD, f"{film} of at most {limit} of {size} bytes")
            check([name for name in os.listdir() if "unfinished" in name] == [], "nothing unfinished is left")
        os.remove(film)
        shutil.rmtree("film-frames", ignore_errors=True)


def test_a_disk_that_is_full():
    os.mkdir("disk")
    if os.getuid() != 0 or subprocess.run(["mount", "-t", "tmpfs", "-o", "size=8k", "none", "disk"], stderr=subprocess.DEVNULL).returncode != 0:
        os.rmdir("disk")
        raise Skip("no small disk can be mounted here")
    try:
        for name, arguments, outputs in OUTPUTS:
            if not outputs or len(outputs) > 1:
                continue
            path = f"disk/{outputs[0]}"
            pathlib.Path(path).write_bytes(OLD)
            done = run(arguments.replace(outputs[0], path).replace("60x60", "300x300").replace("--size 24", "--size 64"))
            if done.returncode == UNSUPPORTED or (done.returncode == 0 and os.path.getsize(path) < 8192):
                os.remove(path)
                continue  # this build has no such files, or the file fits
            check_failed(done, 1, "No space left on device")
            check(os.listdir("disk") == [outputs[0]] and pathlib.Path(path).read_bytes() == OLD, f"{name}: the disk has changed")
            os.remove(path)
    finally:
        subprocess.run(["umount", "disk"], check=True)
        os.rmdir("disk")


def test_a_reader_that_goes_away():
    for arguments in ("render ball_16x16x16_uint8.raw --size 8x8 --json -o gone.npy", "info ball_16x16x16_uint8.raw --json",
                      "make --list", "help presets", "diff a.npy b.npy --json"):
        reader, writer = os.pipe()
        os.close(reader)
        done = subprocess.run([PROGRAM, *arguments.split()], stdin=subprocess.DEVNULL, stdout=writer, stderr=subprocess.PIPE)
        os.close(writer)
        lines = done.stderr.decode().splitlines()
        check(done.returncode == 1 and "standard output: Broken pipe" in lines[-1], f"{arguments}: {done.returncode} {lines}")
    os.remove("gone.npy")


def test_closed_standard_streams():
    """Files opened later must not take their numbers, or messages would go into them."""
    good = run("render ball_16x16x16_uint8.raw --size 20x20 -o good.npy")
    check(good.returncode == 0, "it does not work at all")
    for descriptor in (0, 1, 2):
        done = subprocess.run(f"'{PROGRAM}' render ball_16x16x16_uint8.raw --size 20x20 --json -o closed.npy {descriptor}>&-",
                              shell=True, capture_output=True)
        check(done.returncode == (1 if descriptor == 1 else 0), f"without {descriptor}: exit code {done.returncode}")
        check(pathlib.Path("closed.npy").read_bytes() == pathlib.Path("good.npy").read_bytes(), f"without {descriptor}: other bytes")
        os.remove("closed.npy")
    os.remove("good.npy")


def processor_seconds(process):
    fields = open(f"/proc/{process}/stat").read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def interrupt(arguments, signal_number, after):
    """The exit code of a run interrupted after so many processor seconds."""
    child = subprocess.Popen([PROGRAM, *arguments.split()], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        while processor_seconds(child.pid) < after:
            time.sleep(0.005)
        os.kill(child.pid, signal_number)
        return child.wait(HANG)
    finally:
        child.kill()
        child.wait()


def test_interrupted():
    """Each of these runs takes far longer than the wait. How much is done after the signal: patience.py."""
    heavy = "ball_64x64x64_uint8.raw --threads 1 --quiet"
    runs = [f"render {heavy} --size 900x900 --sheet-spacing 0.02 -o out.png",
            f"render {heavy} --size 900x900 --sheet-spacing 0.02 --soft-method paper -o out.exr",
            f"render {heavy} --size 600x600 --sheet-spacing 0.02 --soft-method sublights --light-samples 3 -o out.npy",
            f"render {heavy} --size 900x900 --sheet-spacing 0.02 --shadows hard --layers -o out.exr",
            f"render {heavy} --size 4000x4000 --reference -o out.npy",
            "make fire-ball --size 700 --threads 1 --quiet -o out.nrrd"]
    for arguments in runs:
        put_old([arguments.split()[-1]])
        before = sorted(os.listdir())
        for signal_number, after in ((signal.SIGINT, 0.15), (signal.SIGTERM, 0.6), (signal.SIGHUP, 0.3)):
            code = interrupt(arguments, signal_number, after)
            check(code == 130, f"{arguments}: exit code {code}")
            check_untouched(before, [arguments.split()[-1]])
        os.remove(arguments.split()[-1])


def feed(path, pieces, pause):
    def write():
        with open(path, "wb", buffering=0) as file:
            for piece in pieces:
                file.write(piece)
                time.sleep(pause)
    thread = threading.Thread(target=write)
    thread.start()
    return thread


def test_a_pipe_for_a_volume():
    whole = pathlib.Path("ball_16x16x16_uint8.raw").read_bytes()
    check(run("render ball_16x16x16_uint8.raw --size 20x20 -o file.npy").returncode == 0, "it does not work at all")
    os.mkdir("pipes")
    os.mkfifo("pipes/ball_16x16x16_uint8.raw")
    slow = feed("pipes/ball_16x16x16_uint8.raw", [whole[:1], whole[1:700], whole[700:4000], whole[4000:]], 0.05)
    done = run("render pipes/ball_16x16x16_uint8.raw --size 20x20 -o pipe.npy")
    slow.join()
    check(done.returncode == 0, f"a slow pipe: {done.stderr.decode()!r}")
    check(pathlib.Path("pipe.npy").read_bytes() == pathlib.Path("file.npy").read_bytes(), "a slow pipe gives another picture")
    os.remove("pipe.npy")
    short = feed("pipes/ball_16x16x16_uint8.raw", [whole[:1000]], 0)
    check_failed(run("render pipes/ball_16x16x16_uint8.raw --size 20x20 -o pipe.npy"), 3, "only 1000 bytes")
    short.join()
    for program in ("render", "info"):  # nobody writes: it waits, and can be stopped
        child = subprocess.Popen([PROGRAM, program, "pipes/ball_16x16x16_uint8.raw"], stderr=subprocess.PIPE)
        time.sleep(1)
        check(child.poll() is None, f"{program} did not wait for the pipe's writer")
        child.send_signal(signal.SIGINT)
        child.communicate(timeout=HANG)
        check(child.returncode == 130, f"{program}: exit code {child.returncode}")
    shutil.rmtree("pipes")
    os.remove("file.npy")


def main():
    tests = [value for name, value in globals().items() if name.startswith("test_")]
    print(f"1..{len(tests)}")
    failed = 0
    folder = tempfile.mkdtemp(prefix="halflight-outputs-")
    os.chdir(folder)
    for size in (16, 64):
        subprocess.run([sys.executable, TOOL, "ball", str(size), f"ball_{size}x{size}x{size}_uint8.raw"], check=True)
    for name, azimuth in (("a", 0), ("b", 90)):
        check(run(f"render ball_16x16x16_uint8.raw --size 60x60 --azimuth {azimuth} -o {name}.npy").returncode == 0, "no picture")
    for number, test in enumerate(tests, 1):
        name = test.__name__[5:].replace("_", " ")
        try:
            test()
            print(f"ok {number} - {name}", flush=True)
        except Skip as reason:
            print(f"ok {number} - {name} # SKIP {reason}", flush=True)
        except AssertionError as reason:
            failed += 1
            print(f"not ok {number} - {name}\n# {reason}", flush=True)
    os.chdir("/")
    shutil.rmtree(folder)
    sys.exit(1 if failed else 0)


main()
