# The frames of a turn are the pictures that render makes at their angles.
halflight make rings --size 24 --quiet
halflight render rings.nrrd --size 64x64 --sheet-spacing 2 --azimuth 10 --print-scene >scene.json
halflight animate scene.json --key camera.azimuth=0:10,4:50 --quiet -o turn
ls turn
for frame in 1 4; do
  halflight render scene.json --azimuth $((10 + 10 * frame)) --quiet -o rendered.png
  cmp rendered.png turn/000$frame.png
done
halflight animate scene.json --turntable 36 --frames 5 --quiet -o whole
for frame in 0 1 2 3 4; do halflight diff --max-error 0.01 turn/000$frame.png whole/000$frame.png >/dev/null; done
