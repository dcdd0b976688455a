# Options that say what is so already change nothing, to the last bit, on volumes with any way up; other angles keep what is up.
# slow: it renders each of four volumes a dozen times
tool ball 16 ball_16x16x16_uint8.raw
"$PYTHON" - <<'END' # smoke: y is up; a pot on a plate at low -y; and one with anatomy, whose front is +y
import math, random, struct
random.seed(1)
n = 24
def write(name, value, head=""):
    numbers = [value(x, y, z) for z in range(n) for y in range(n) for x in range(n)]
    with open(name, "wb") as file:
        file.write(f"NRRD0004\ntype: float\ndimension: 3\nsizes: {n} {n} {n}\nencoding: raw\nendian: little\n{head}\n".encode())
        file.write(struct.pack(f"<{n ** 3}f", *numbers))
def smoke(x, y, z):
    r = math.dist((x, z), (11, 12)) / (2 + 0.3 * y)
    return max(0, 1 - r) * random.random() if y > 1 else 0
def pot(x, y, z):
    return float(y < 3 or (y < 19 and math.dist((x, z), (11, 11)) < 4) or math.dist((x, y, z), (11, 12, 7)) < 3)
write("smoke.nrrd", smoke)
write("pot.nrrd", pot)
write("body.nrrd", pot, "space: right-anterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n")
END
small() { input=$1; out=$2; shift 2; halflight render $input --size 40x40 --quiet -o $out "$@"; }
look() { halflight render $1 --size 40x40 --print-scene >scene.json; tool json scene.json 'd["camera"]["up"]' >up; }
for input in ball_16x16x16_uint8.raw smoke.nrrd pot.nrrd body.nrrd; do
  small $input a.npy
  look $input
  up=$(tr -d '[] ' <up)
  case $input in smoke*) light=-75,40 ;; *) light=-40,45 ;; esac
  for same in '--elevation 20' '--roll 0' '--zoom 1' '--fovy 30' "--up $up" '--size 40x40' "--light $light" '--light-size 7' \
    '--elevation 20 --roll 0' "--up $up --elevation 20"; do
    rm -f b.npy
    case $same in --size*) halflight render $input --quiet -o b.npy $same ;; *) small $input b.npy $same ;; esac
    cmp a.npy b.npy || { echo "$input $same"; exit 1; }
  done
  # another elevation: the same up, target and distance
  halflight render $input --size 40x40 --elevation 50 --azimuth 77 --print-scene >turned.json
  tool json turned.json 'd["camera"]["up"]' | cmp - up
  "$PYTHON" - <<'END'
import json, math
a, b = (json.load(open(name))["camera"] for name in ("scene.json", "turned.json"))
assert a["target"] == b["target"], (a, b)
assert abs(math.dist(a["position"], a["target"]) / math.dist(b["position"], b["target"]) - 1) < 1e-12
END
done
# Settings of the render do not ask which volume it is.
small ball_16x16x16_uint8.raw a.npy
for same in '--shadows soft' '--soft-method cascade' '--shadow-resolution auto' '--shadow-lookup auto' '--kernel bspline' '--reconstruction auto' \
  '--slicing half-vector' '--threads 1' '--instruction-set auto'; do
  small ball_16x16x16_uint8.raw b.npy $same
  cmp a.npy b.npy
done
# the azimuth that the view has: recovered from a scene of the picture's own
halflight render ball_16x16x16_uint8.raw --size 40x40 --print-scene >scene.json
halflight render scene.json --quiet -o a.npy
for same in '--azimuth 30' '--elevation 20' '--azimuth 30 --elevation 20 --roll 0'; do
  halflight render scene.json --quiet -o b.npy $same
  cmp a.npy b.npy
done
