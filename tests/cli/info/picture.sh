# `info` of a picture: its size and bits, and what it holds of its scene, whether or not the scene's files are there.
tool ball 8 ball_8x8x8_uint8.raw
halflight render ball_8x8x8_uint8.raw --size 40x30 --depth 16 --ortho --quiet -o p.png
halflight info p.png | sed -n '1,5s/, at .*height .*/, height/p;1,3p;5,6p'
halflight info p.png --json | "$PYTHON" -c 'import json, sys
told = json.load(sys.stdin)
camera = told["picture"].pop("camera")
print(told["width"], told["picture"], sorted(camera), [v["dimensions"] for v in told["volumes"]])'
rm ball_8x8x8_uint8.raw
halflight info p.png | sed -n '2p;4p;5s/ball.*//p'
halflight info p.png --json | "$PYTHON" -c 'import json, sys; told = json.load(sys.stdin); print(told["picture"]["volumes"], "volumes" in told)'
# A picture without a scene is told as such.
tool ball 8 ball_8x8x8_uint8.raw
halflight render ball_8x8x8_uint8.raw --size 40x30 --no-metadata --background transparent --quiet -o plain.png
halflight render ball_8x8x8_uint8.raw --size 40x30 --quiet -o light.exr
for picture in plain.png light.exr; do
  halflight info $picture
  halflight info $picture --json | "$PYTHON" -c 'import json, sys; print(json.load(sys.stdin)["picture"])'
done
halflight info - <plain.png
# The layers of an .exr are named.
halflight render ball_8x8x8_uint8.raw --size 40x30 --layers --quiet -o layers.exr
halflight info layers.exr
: >page.pdf
halflight info page.pdf
if halflight info plain.png --time 1 2>refused.txt; then exit 1; fi
if halflight info missing.exr 2>>refused.txt; then exit 1; fi
printf '\211PNG\r\n\032\n' >cut.png
if halflight info cut.png 2>>refused.txt; then exit 1; fi
cat refused.txt
