# Mistakes in keys are said before the first frame, in one line each, and leave nothing behind.
halflight make rings --size 24 --quiet
halflight render rings.nrrd --size 32x32 --print-scene >scene.json
try() { halflight animate scene.json "$@" 2>&1 || echo $?; }
try
for key in lights.0.intensty=0:1 lights.9.intensity=0:1 lights.intensity=0:1 lights.0.type=0:1 camera.position=0:1 \
  nothing=0:1,5:2 lights.0.intensity lights.0.intensity= =0:1 lights.0.intensity=0:1,0:2 lights.0.intensity=x:1 \
  lights.0.intensity=0:one lights.0.intensity=0:1, lights.0.intensity=0:nan lights.0.intensity=-1:2 lights.0.intensity=0:-5 \
  camera.zoom=0:0 ..=0:1 lights.=0:1 lights.00000000000000.intensity=0:1; do
  try --key "$key"
done
try --key lights.0.intensity=0:1 --key lights.0.intensity=0:2
try --turntable 5 --part 0/3
try --turntable 5 -o film.avi
try --turntable 5 -o scene.json
ls
