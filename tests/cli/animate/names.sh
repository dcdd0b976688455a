# Names of files are names, whatever a program may take them for: ffmpeg for a protocol, the options for one of them.
command -v ffprobe >/dev/null || { echo "ffmpeg is not installed"; exit 77; }
halflight make rings --size 24 --quiet
halflight render rings.nrrd --size 60x40 --sheet-spacing 4 --print-scene >tcp:127.0.0.1:9.json
cp tcp:127.0.0.1:9.json ./-scene.json
halflight animate tcp:127.0.0.1:9.json --turntable 2 --quiet -o 12:30.mp4
halflight animate tcp:127.0.0.1:9.json --turntable 2 --quiet
halflight animate --turntable 2 --quiet -o ./-turn.webm -- -scene.json
halflight render --quiet -o ./-o.png -- -scene.json
mv rings.nrrd 'a:b=c.nrrd'
halflight render 'a:b=c.nrrd' --size 30x20 --quiet
halflight render 'a:b=c.png' --quiet -o again.png
cmp 'a:b=c.png' again.png
for film in ./12:30.mp4 ./tcp:127.0.0.1:9.mp4 ./-turn.webm; do
  ffprobe -v error -count_frames -show_entries stream=nb_read_frames -of csv=p=0 "file:$film"
done
LC_ALL=C ls
