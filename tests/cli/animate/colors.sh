# A key of a setting that is a colour goes from colour to colour in linear light.
halflight make rings --size 24 --quiet
halflight render rings.nrrd --size 16x16 --sheet-spacing 4 --print-scene >scene.json
halflight animate scene.json --key lights.0.color=0:blue,2:#f00 --key image.background=0:white,2:black --quiet -o out
for frame in 0 1 2; do
  tool png-scene out/000$frame.png >frame.json
  tool json frame.json '[d["lights"][0].get("color", 1), d["image"].get("background", 0)]'
done
for key in lights.0.color=0:1,2:red lights.0.color=0:reddish lights.0.intensity=0:red camera.position=0:red camera.azimuth=0:red; do
  halflight animate scene.json --key $key --quiet -o none 2>&1 || true
done
