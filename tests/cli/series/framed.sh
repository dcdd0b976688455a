# A ball that grows and moves stays in the picture, which its first file alone would not tell.
"$PYTHON" -c 'import array
for t in range(3):
    middle, radius = 6 + 9 * t, 3 + 2 * t
    values = [max(0, 255 - int(128 * ((i - middle)**2 + (j - 16)**2 + (k - 16)**2) / radius**2))
              for k in range(32) for j in range(32) for i in range(32)]
    open(f"ball_{t}_32x32x32_uint8.raw", "wb").write(array.array("B", values).tobytes())'
halflight render 'ball_?_32x32x32_uint8.raw' -o '%d.png' --size 48x48 --quiet --background 0,0,0
for picture in 0 1 2; do
  tool png-border $picture.png | "$PYTHON" -c 'border, most = map(int, input().split())
print(border < 8 and most > 100)'
done
