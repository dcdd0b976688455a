# The legend goes over the range that --range states, whatever values the volume has: pictures compare by their legends.
tool ball 16 a_16x16x16_uint8.raw
halflight render a_16x16x16_uint8.raw --size 160x160 --shading flat --colormap turbo --range 0,1000 --legend auto --place legend=upper-right --quiet -o a.png || { echo "this build draws nothing"; exit 77; }
tool png-pixel a.png 118 17 | python3 -c '
red, green, blue = (int(code) for code in input().split())
print("the strip ends in the red of turbo:", red > 100 and green < 60 and blue < 60)'
# The legend of a slice goes over the values of its greys or colours, here those of soft tissue, and not over all values of the volume.
"$PYTHON" -c "
import math, struct
def value(away): return -1000 if away > 10 else 60 if away > 5 else 1200 if away > 3 else 30
open('ct_24x24x24_int16.raw', 'wb').write(b''.join(struct.pack('<h', value(math.dist((x, y, z), (11.5,) * 3)) + (7 * x + 5 * y + 3 * z) % 11)
                                                   for z in range(24) for y in range(24) for x in range(24)))"
for words in '' '--colormap viridis'; do
  halflight render ct_24x24x24_int16.raw --slice z=0.5 $words --legend auto --place legend=below --size 200 --quiet -o slice.pdf
  pdftotext -layout slice.pdf - | grep -oE '[0-9]+' | sort -n | tr '\n' ' '; echo
done
# A range of one volume ends this volume's legend, too, with a colormap and without; another volume keeps the range of its own legend.
tool ball 12 b_12x12x12_uint8.raw
for name in a_16x16x16 b_12x12x12; do halflight convert ${name}_uint8.raw ${name%%_*}.nrrd --quiet; done
numbers() { halflight render "$@" --legend auto --place legend=below --size 200 --no-metadata --quiet -o numbers.pdf && pdftotext -layout numbers.pdf - | grep -oE '[0-9]+'; }
numbers b.nrrd >plain.txt
numbers a.nrrd --range 40,1000 >ranged.txt
numbers a.nrrd b.nrrd --range a=40,1000 >both.txt
"$PYTHON" -c "
read = lambda name: sorted(int(word) for word in open(name))
print(read('ranged.txt')[-1], read('both.txt') == sorted(read('ranged.txt') + read('plain.txt')))"
for range in 40,120 a_16x16x16_uint8=40,120; do
  halflight render a_16x16x16_uint8.raw --size 160x160 --colormap turbo --range $range --legend auto --no-metadata --quiet -o ranged-${range%=*}.png
done
cmp ranged-40,120.png ranged-a_16x16x16_uint8.png
