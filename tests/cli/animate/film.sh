# ffmpeg joins the pictures: as many frames, the size made even; the pictures go, unless they are kept or parts.
command -v ffprobe >/dev/null || { echo "ffmpeg is not installed"; exit 77; }
halflight make rings --size 24 --quiet
halflight render rings.nrrd --size 61x40 --sheet-spacing 4 --print-scene >scene.json
about() { ffprobe -v error -count_frames -show_entries stream=codec_name,width,height,nb_read_frames,r_frame_rate -of csv=p=0 "$1"; }
for kind in mp4 webm gif; do
  halflight animate scene.json --turntable 5 --fps 10 --quiet -o turn.$kind
  about turn.$kind
done
ls
halflight animate scene.json --turntable 5 --keep-frames -o kept.mkv 2>&1
halflight animate scene.json --turntable 5 --keep-frames -o kept.mkv 2>&1
for part in 1 2; do halflight animate scene.json --turntable 5 --part $part/2 -o parts.mp4 2>&1; done
halflight animate scene.json --turntable 5 --fps 10 --quiet -o again.mp4
cmp turn.mp4 again.mp4
