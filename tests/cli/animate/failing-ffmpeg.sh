# What ffmpeg says of its failure is said; the pictures stay, an old film too.
halflight make rings --size 24 --quiet
halflight render rings.nrrd --size 32x32 --sheet-spacing 4 --print-scene >scene.json
echo old >turn.mp4
mkdir bin
printf '#!/bin/sh\nread -r line; echo "the disk is on fire" >&2; exit 1\n' >bin/ffmpeg
chmod +x bin/ffmpeg
code=0
PATH=$PWD/bin:$PATH "$HALFLIGHT" animate scene.json --turntable 30 -o turn.mp4 || code=$?
echo $code
cat turn.mp4
ls turn-frames | wc -l
ls
