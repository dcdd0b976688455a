halflight make rings --size 24 --quiet -o a.nrrd
for format in mha vti nrrd; do
  halflight convert --quiet a.nrrd "b.$format"
  halflight convert --quiet "b.$format" -o c.nrrd
  halflight info --json a.nrrd >a
  halflight info --json c.nrrd >c
  grep -v '"file"\|"space"' a >a.told
  grep -v '"file"\|"space"' c >c.told
  cmp a.told c.told && echo "$format: the same"
done
