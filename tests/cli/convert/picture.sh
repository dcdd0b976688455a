# A picture in another format: what `render` writes is the same by way of an .exr. Layers, which a .png cannot hold, are left out.
tool ball 8 ball_8x8x8_uint8.raw
draw() { halflight render ball_8x8x8_uint8.raw --size 24 --quiet --no-metadata "$@"; }
draw --layers -o a.exr
draw --background transparent -o direct.png
halflight convert a.exr a.png --quiet
cmp direct.png a.png
draw --background '#204060' --exposure 1 --tone filmic -o direct.png
halflight convert a.exr -o b.png --background '#204060' --exposure 1 --tone filmic --quiet
cmp direct.png b.png
halflight convert a.exr a.npy --quiet
halflight diff a.exr a.npy --max-error 0 | head -1
halflight convert a.exr c.png 2>&1 | cut -d' ' -f1-2
# What does not go together is refused, and leads on.
for words in 'ball_8x8x8_uint8.raw d.png' 'a.exr d.nrrd' 'a.exr d.npy --exposure 1' 'a.exr d.png --unit mm' 'ball_8x8x8_uint8.raw d.nrrd --tone clip' 'none.exr d.png'; do
  halflight convert $words --quiet 2>&1 || echo $?
done
halflight render a.exr -o d.png 2>&1 || echo $?
test ! -e d.png
