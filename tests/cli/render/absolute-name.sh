# A line that begins with a name that begins with a slash has it once.
printf 'no volume' >bad.nrrd
halflight render "$PWD/bad.nrrd" 2>message || echo $?
test "$(grep -o bad.nrrd message | wc -l)" = 1
