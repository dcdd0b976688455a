# Every ready-made shape is made, in the size asked for, the same bytes with any number of threads.
halflight make --list | cut -d ' ' -f 1 >names
[ "$(wc -l <names)" -ge 8 ]
while read -r name; do
  halflight make "$name" --size 32 --threads 1 --quiet
  halflight make "$name" --size 32 --threads 7 --quiet -o again.nrrd
  cmp "$name.nrrd" again.nrrd
  halflight info "$name.nrrd" --json >info.json
  longest=$(tool json info.json 'max(d["dimensions"])')
  [ "$longest" -ge 30 ] && [ "$longest" -le 32 ]
done <names
halflight make furry-sphere --size 32 --seed 1 --quiet -o again.nrrd
if cmp -s furry-sphere.nrrd again.nrrd; then exit 1; fi
