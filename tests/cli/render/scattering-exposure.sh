# A bare cloud that scatters light again and again is not brighter than white: its lights are weaker, all by one factor. Without --scattering, and
# where little of the light is left, the light is the look's own. A scene keeps its own light.
halflight make cloud --size 48 --quiet
made() { name=$1; shift; halflight render "$@" --print-scene >$name.json; }
made once cloud.nrrd
made again cloud.nrrd --scattering 0.95
made dark cloud.nrrd --scattering 0.3
made kept once.json --scattering 0.95
"$PYTHON" - <<'END'
import json
def light(name):
    scene = json.load(open(name + ".json"))
    return [*(one["intensity"] for one in scene["lights"]), *scene["ambient"], scene["sky"]["strength"]]
for name in "again", "dark", "kept":
    ratios = [ours / once for ours, once in zip(light(name), light("once")) if once > 0]
    print(name, max(ratios) - min(ratios) < 1e-9, "weaker" if ratios[0] < 0.95 else "the same light" if ratios[0] == 1 else ratios[0])
END
# Of its pixels few are brighter than white, of the scene's many.
for name in again kept; do
  halflight render $name.json --size 96 --quiet -o $name.npy
  "$PYTHON" - $name <<'END'
import struct, sys
data = open(sys.argv[1] + ".npy", "rb").read()
values = struct.unpack("<%df" % (96 * 96 * 4), data[-96 * 96 * 16:])
seen = [max(values[n:n + 3]) for n in range(0, len(values), 4) if values[n + 3] > 0.5]
print(sys.argv[1], "mostly below white" if sum(one > 1 for one in seen) < 0.05 * len(seen) else "brighter than white")
END
done
