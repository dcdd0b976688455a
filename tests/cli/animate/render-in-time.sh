# A film takes render's options: a frame is the picture that render makes with them. Easing is slow at both ends, a light
# sweeps as --light says, and a pattern of files is time.
halflight make rings --size 24 --quiet
look="--size 120x96 --look mip --colormap viridis --legend auto --place legend=upper-right --quiet"
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
halflight animate --turntable rings.nrrd --size 16x16 --sheet-spacing 4 --quiet --fps 2 -o unnumbered
ls preset turntable unnumbered | grep -c png
cmp turntable/0003.png unnumbered/0003.png
for n in 8 9 10; do cp rings.nrrd flame_$n.nrrd; done
halflight animate 'flame_*.nrrd' --size 16x16 --sheet-spacing 4 --quiet -o flames
ls flames
halflight animate 'flame_*.nrrd' --frames 4 -o no 2>&1 || echo $?
# Keys move in a film of several files, too: a frame of theirs is a file. Made again, no picture is rendered.
halflight animate 'flame_*.nrrd' --size 16x16 --sheet-spacing 4 --key lights.0.intensity=0:1,2:3 --turntable 6 -o moving 2>&1 |
  grep -o '3 pictures, 3 of them rendered now'
for frame in 0 1 2; do
  tool png-scene moving/00000$frame.png >frame.json
  tool json frame.json '[d["lights"][0]["intensity"], d["volumes"][0]["file"].split("/")[-1]]'
done
halflight render flame_8.nrrd --size 16x16 --sheet-spacing 4 --print-scene >still.json
"$PYTHON" - still.json frame.json <<'END'
import json, math, sys
still, moved = (json.load(open(path))["camera"] for path in sys.argv[1:])
first, last = ([p - t for p, t in zip(c["position"], c["target"])] for c in (still, moved))
turned = math.degrees(math.atan2(last[1], last[0]) - math.atan2(first[1], first[0])) % 360
print(min(round(turned), round(360 - turned)))
END
halflight animate 'flame_*.nrrd' --size 16x16 --sheet-spacing 4 --key lights.0.intensity=0:1,2:3 --turntable 6 -o moving 2>&1 |
  grep -o '3 pictures, 0 of them rendered now'
# A turn without a number goes once around in all files.
halflight animate 'flame_*.nrrd' --size 16x16 --sheet-spacing 4 --quiet --turntable -o around
halflight animate 'flame_*.nrrd' --size 16x16 --sheet-spacing 4 --quiet --turntable 3 -o around3
cmp around/000002.png around3/000002.png
halflight animate 'flame_*.nrrd' --size 16x16 --key lights.7.azimuth=0:1,4:2 -o no 2>&1 || echo $?
halflight animate rings.nrrd --key lights.7.azimuth=0:1,4:2 -o no 2>&1 || echo $?
if command -v ffmpeg >/dev/null; then
  halflight animate 'flame_*.nrrd' --size 16x16 --sheet-spacing 4 -o flames.mp4 2>&1 | grep ' frames, '
  ls | grep flames
else
  printf 'flames.mp4: 3 frames, 0.1 s at 30 a second\nflames\nflames.mp4\n'
fi
