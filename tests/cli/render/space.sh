# --space tells to which directions in the body x, y and z of a file point whose own text does not tell it.
# slow: 4 seconds of processor time
tool ball 16 scan_16x16x16_uint8.raw
halflight make rings --size 16 --quiet
tool ball 16 map_16x16x16_uint8.raw
drawn() { halflight render "$@" --size 40x40 --no-metadata --quiet; }
# The axes of all 48 spaces, beside the directions of their letters.
for space in $(python3 -c "
import itertools
for axes in itertools.permutations(('RL', 'AP', 'SI')):
    print(*map(''.join, itertools.product(*axes)))"); do
  halflight info scan_16x16x16_uint8.raw --space $space --json | tr -d '\n' >about.json
  python3 - $space <<'END'
import json, sys
letters, about = sys.argv[1], json.load(open("about.json"))
ways = {"R": (1, 0, 0), "L": (-1, 0, 0), "A": (0, 1, 0), "P": (0, -1, 0), "S": (0, 0, 1), "I": (0, 0, -1)}
turn = {"RAS": (1, 1, 1), "LPS": (-1, -1, 1), "LAS": (-1, 1, 1)}[about["space"]]
columns = [tuple(turn[row] * about["direction"][row][axis] for row in range(3)) for axis in range(3)]
assert about["space"] == (letters if letters in ("RAS", "LPS", "LAS") else "RAS"), about["space"]
assert columns == [ways[letter] for letter in letters], (letters, columns)
END
done
# A file that tells its directions makes the same pictures as one of which --space tells them.
for space in RAS PIR; do
  halflight convert scan_16x16x16_uint8.raw told.nii --space $space --quiet
  for options in "--slice axial" "--slice coronal --axes letters" "--view left" "--slice sagittal=0.3 --axes letters"; do
    drawn told.nii $options -o told.png
    drawn scan_16x16x16_uint8.raw --space $space $options -o stated.png
    halflight diff --max-error 0 told.png stated.png >/dev/null || echo "$space $options"
  done
done
# A label map or mask whose file tells no directions lies in the body as the volume does; so in the picture's own scene.
halflight convert map_16x16x16_uint8.raw map.nii --space PIR --quiet
for option in labels mask; do
  drawn scan_16x16x16_uint8.raw --space PIR --$option map_16x16x16_uint8.raw -o raw.png
  drawn scan_16x16x16_uint8.raw --space PIR --$option map.nii -o placed.png
  halflight diff --max-error 0 raw.png placed.png >/dev/null
  halflight render scan_16x16x16_uint8.raw --space PIR --$option map_16x16x16_uint8.raw --size 40x40 --quiet -o own.png
  halflight render own.png --quiet -o again.png
  cmp own.png again.png
done
halflight render scan_16x16x16_uint8.raw --space pir --print-scene | grep -o '"space": "pir"'
# Directions that the file tells are replaced, and a line says so.
halflight convert scan_16x16x16_uint8.raw left.nrrd --space LPS --quiet
halflight info left.nrrd --space LPS 2>&1 | grep -c warning || true
halflight info left.nrrd --space RAS 2>&1 | grep -e warning -e "space  "
# Other texts are refused.
for space in RA RAX RLS RASP ''; do
  halflight info left.nrrd --space "$space" 2>&1 || echo $?
done
printf '{"halflight": 1, "volumes": [{"file": "left.nrrd", "space": "RAB"}]}' >wrong.json
halflight render wrong.json -o no.png 2>&1 || echo $?
# The messages of options that need the directions lead here.
halflight render scan_16x16x16_uint8.raw --slice axial -o no.png 2>&1 || echo $?
halflight render scan_16x16x16_uint8.raw --axes letters -o no.png 2>&1 || echo $?
