# The legend goes over the range that --range states, whatever values the volume has: pictures compare by their legends.
tool ball 16 a_16x16x16_uint8.raw
halflight render a_16x16x16_uint8.raw --size 160x160 --shading flat --colormap turbo --range 0,1000 --legend auto --quiet -o a.png || { echo "this build draws nothing"; exit 77; }
tool png-pixel a.png 118 17 | python3 -c '
red, green, blue = (int(code) for code in input().split())
print("the strip ends in the red of turbo:", red > 100 and green < 60 and blue < 60)'
