# What this build reads and writes: what is always there, and what depends on libraries.
halflight info --formats >list
grep '^[a-z]' list
grep '^  NRRD \|^  STL \|^  PNG \|^  Radiance\|^  gzip ' list
halflight info --formats --json >list.json
tool json list.json 'sorted(d)'
tool json list.json '[f for f in d["volumes"] if f["name"] == "NIfTI"]'
# formats that are neither read nor written are those that lack a library
tool json list.json '[f["name"] for k in d.values() for f in k if (f["missing"] is None) != (f["reads"] or f["writes"])]'
# what is listed as written is written, and read again
tool ball 8 ball_8x8x8_uint8.raw
tool json list.json '" ".join(e for f in d["volumes"] for e in f["written_endings"])' | tee endings
for ending in $(cat endings); do
  halflight convert ball_8x8x8_uint8.raw "written_8x8x8_int16$ending" --type int16 --quiet
  halflight info "written_8x8x8_int16$ending" --json >told.json
  tool json told.json 'd["type"]'
done
