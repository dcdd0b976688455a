# A colour by name or hexadecimal is sRGB: the picture has its very codes. Numbers are linear: 0.5 is 188 of 255.
tool ball 12 ball_12x12x12_uint8.raw
for color in white '#336699' '#369' steelblue SteelBlue 0.5 1,0,0.5; do
  halflight render ball_12x12x12_uint8.raw --size 32x32 --quiet --background "$color" -o a.png
  tool png-pixel a.png 0 0
done
