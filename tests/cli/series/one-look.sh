for seed in 1 2 10; do halflight make cloud --size 16 --seed $seed --quiet -o dump_$seed.nrrd; done
echo junk >dump_3.nrrd
halflight render 'dump_*.nrrd' -o 'all/%02d.png' --size 32x32 --quiet && exit 9
ls all
# The look is the first file's; all have one camera.
halflight render dump_1.nrrd --size 32x32 --quiet -o first.png
halflight render first.png --print-scene >first.json
halflight render all/00.png --print-scene >all.json
"$PYTHON" -c 'import json
first, every = json.load(open("first.json")), json.load(open("all.json"))
del first["camera"], every["camera"]
assert first == every'
sed 's/dump_1/dump_10/' all.json >tenth.json
halflight render tenth.json --quiet -o tenth.png
halflight diff --max-error 0 tenth.png all/03.png >difference
# Where the first file's picture holds the others, its camera stays.
mkdir less
cp dump_1.nrrd less/1.nrrd
cp dump_1.nrrd less/2.nrrd
(cd less && halflight render '[12].nrrd' -o '%d.png' --size 32x32 --quiet)
halflight diff --max-error 0 first.png less/0.png >difference
# A run goes on where it was, and parts share the work.
rm dump_3.nrrd
mkdir parts
halflight render 'dump_*.nrrd' -o 'parts/%02d.png' --size 32x32 --part 2/2 --quiet
ls parts
before=$(stat -c %i parts/01.png)
halflight render 'dump_*.nrrd' -o 'parts/%02d.png' --size 32x32 --quiet
ls parts
test "$before" = "$(stat -c %i parts/01.png)"
# The range of all: the first file's look, spread.
halflight render 'dump_*.nrrd' -o 'range/%d.png' --size 32x32 --quiet --range-of-all
halflight render 'dump_*.nrrd' -o 'given/%d.png' --size 32x32 --quiet --range "$(for f in dump_*.nrrd; do halflight info --json $f; done |
  "$PYTHON" -c 'import json, re, sys
ranges = [json.loads(part)["range"] for part in re.split(r"(?<=^})\n", sys.stdin.read(), flags=re.M) if part.strip()]
print("%r,%r" % (min(r[0] for r in ranges), max(r[1] for r in ranges)))')"
cmp range/2.png given/2.png
