# A bare volume that is cut open gets the light that suits what is left of it: the key light, the one beside it, the sky and
# ambient light change by one factor. A scene keeps its own light.
tool ball 16 ball_16x16x16_uint8.raw
made() { name=$1; shift; halflight render "$@" --print-scene >$name.json; }
made whole ball_16x16x16_uint8.raw --view front
made cut ball_16x16x16_uint8.raw --view front --cut-plane 0.5,0.5,0.5:0,-1,1
made clip ball_16x16x16_uint8.raw --view front --clip y=0.5:1
made kept whole.json --cut-plane 0.5,0.5,0.5:0,-1,1
python3 - <<'END'
import json
def light(name):
    scene = json.load(open(name + ".json"))
    return [*(one["intensity"] for one in scene["lights"]), *scene["ambient"], scene["sky"]["strength"]]
for name in "cut", "clip", "kept":
    ratios = [ours / whole for ours, whole in zip(light(name), light("whole"))]
    print(name, max(ratios) - min(ratios) < 1e-9, "another light" if abs(ratios[0] - 1) > 0.01 else "the same light")
END
