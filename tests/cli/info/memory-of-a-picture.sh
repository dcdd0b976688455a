# A file that memory has no room for is no bad file: exit code 1, as for any other lack of memory.
limited() { (ulimit -v 800000 && halflight "$@"); }
limited --version >version.txt 2>&1 || { echo "the program cannot run in little memory"; exit 77; }
truncate -s 900M large.exr
truncate -s 900M large.json
limited info large.exr 2>&1 || echo $?
limited figure large.json 2>&1 || echo $?
halflight info missing.exr 2>&1 || echo $?
