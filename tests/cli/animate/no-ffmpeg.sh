# Without ffmpeg numbered pictures stay, and the run says so; with it, the same command joins them.
halflight make rings --size 24 --quiet
halflight render rings.nrrd --size 32x32 --sheet-spacing 4 --print-scene >scene.json
mkdir empty
PATH=$PWD/empty "$HALFLIGHT" animate scene.json --turntable 3 -o turn.mp4
/bin/ls turn-frames
