# Pictures that are there with their frame's scene are kept, others are rendered anew; parts make the same pictures.
halflight make rings --size 24 --quiet
halflight render rings.nrrd --size 32x32 --sheet-spacing 4 --print-scene >scene.json
halflight animate scene.json --turntable 6 --quiet -o whole
cp -r whole again
rm again/0001.png again/0004.png
cp again/0000.png again/0002.png
head -c 300 whole/0003.png >again/0003.png
halflight animate scene.json --turntable 6 -o again 2>&1
cmp whole/0002.png again/0002.png && cmp whole/0003.png again/0003.png && cmp whole/0004.png again/0004.png
for part in 3 1 2; do halflight animate scene.json --turntable 6 --part $part/3 --quiet -o parts; done
for frame in 0 1 2 3 4 5; do cmp whole/000$frame.png parts/000$frame.png; done
ls parts | wc -l
