# --sky is light from all directions: a scene's sky is replaced, 0 removes it, folds get less than what stands out.
cat >steps.json <<END
{ "halflight": 1, "image": { "width": 32, "height": 32 }, "camera": { "position": [0, -60, 60], "fovy_deg": 30 }, "ambient": [0, 0, 0],
  "lights": [], "sky": { "type": "gradient", "horizon": [0.2, 0.3, 0.4] },
  "volumes": [ { "shapes": [ { "type": "box", "size": [24, 24, 4], "position": [0, 0, -8] }, { "type": "sphere", "radius": 6 } ],
    "material": { "ambient": 0, "diffuse": 1, "specular": 0 } } ] }
END
halflight render steps.json --quiet --print-scene >told.json
tool json told.json 'd["sky"]["horizon"]'
halflight render steps.json --quiet --sky 0.5 --print-scene >even.json
tool json even.json 'd["sky"]["color"]'
halflight render steps.json --quiet --sky 0 --print-scene >none.json
tool json none.json '"sky" in d'
halflight render steps.json --quiet --sky 1 -o one.npy
halflight render steps.json --quiet --sky 2 --threads 3 -o two.npy
halflight render none.json --quiet -o dark.npy
python3 -c '
import numpy as np
one, two, dark = (np.load(name + ".npy") for name in ("one", "two", "dark"))
print("twice:", np.allclose(two[..., :3], 2 * one[..., :3]), "dark:", dark[..., :3].max() == 0, "opaque:", np.array_equal(one[..., 3], dark[..., 3]))
lit = one[..., 0][one[..., 3] > 0.99]
print("folds:", lit.min() < 0.7 * lit.max())'
