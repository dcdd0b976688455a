# Numbers of the scene lie on the line between their keys, and stay at the ends; whole numbers stay whole.
halflight make rings --size 24 --quiet
halflight render rings.nrrd --size 16x16 --sheet-spacing 4 --print-scene >scene.json
halflight animate scene.json --key lights.0.intensity=1:1,3:2 --key lights.0.angular_diameter_deg=0:0,4:20 \
  --key image.exposure=0:-1,4:1 --key render.light_samples=0:1,4:8 --key volumes.0.material.diffuse=0:0.5 --quiet -o out
for frame in 0 1 2 3 4; do
  tool png-scene out/000$frame.png >frame.json
  tool json frame.json '[d["lights"][0]["intensity"], d["lights"][0]["angular_diameter_deg"], d["image"].get("exposure", 0),
    d["render"]["light_samples"], d["volumes"][0]["material"]["diffuse"]]'
done
# A size of 7 degrees, which the scene has as a whole number, is none. A number that must be whole is one also where the scene does not have it yet.
halflight animate scene.json --key lights.0.angular_diameter_deg=0:7,2:8 --key render.pixel_samples=0:1,2:4 --quiet -o between
tool png-scene between/0001.png >frame.json
tool json frame.json '[d["lights"][0]["angular_diameter_deg"], d["render"]["pixel_samples"]]'
# A part that the scene leaves out has its defaults. The camera's height is no whole number, as the picture's is.
halflight render rings.nrrd --size 16x16 --sheet-spacing 4 --ortho --print-scene >flat.json
halflight animate flat.json --key volumes.0.scattering.anisotropy=0:0,2:0.5 --key volumes.0.scattering.albedo.1=0:0.5 --key camera.height=0:3,2:4 --quiet -o parts
tool png-scene parts/0001.png >frame.json
tool json frame.json '[d["volumes"][0]["scattering"], d["camera"]["height"]]'
halflight animate scene.json --key volumes.0.scattering.albedo=0:red --key ambient=0:#00f --quiet -o coloured
tool png-scene coloured/0000.png >frame.json
tool json frame.json '[d["volumes"][0]["scattering"], d["ambient"]]'
for key in volumes.0.scatering.albedo.0 volumes.0.iso.0.value; do halflight animate scene.json --key $key=0:1 2>&1 || true; done
# A time in seconds is the frame that is nearest to it; fractions of seconds and frames may stand in one key.
halflight animate scene.json --key lights.0.intensity=0s:1,0.5s:2,6:4 --fps 4 --quiet -o seconds
ls seconds
tool png-scene seconds/0001.png >frame.json
tool json frame.json 'd["lights"][0]["intensity"]'
for key in 1m:2 1.5:2 2s 2es:1 1e9s:1; do halflight animate scene.json --key lights.0.intensity=$key 2>&1 || true; done
