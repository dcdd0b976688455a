# TIFF files, as `render` writes them, are the same pictures as its PNG files: in 8 and 16 bits, with and without alpha.
tool ball 8 ball_8x8x8_uint8.raw
draw() { halflight render ball_8x8x8_uint8.raw --size 40x24 --quiet "$@"; }
for depth in 8 16; do
  for background in navy transparent; do
    draw --depth $depth --background $background -o a.png
    draw --depth $depth --background $background -o a.tif
    halflight diff a.png a.tif --max-error 0 | tail -1
  done
done
# A file that is cut short is refused, and so is a kind of TIFF that is not read.
head -c 300 a.tif >cut.tif
halflight diff a.tif cut.tif 2>&1 || echo $?
halflight diff a.png cut.tif 2>&1 || echo $?
"$PYTHON" -c "
import struct
tags = [(256, 3, 1, 4), (257, 3, 1, 4), (258, 3, 1, 32), (259, 3, 1, 1), (262, 3, 1, 1), (273, 4, 1, 200), (277, 3, 1, 1), (278, 3, 1, 4), (279, 4, 1, 64)]
open('floats.tif', 'wb').write((struct.pack('<2sHIH', b'II', 42, 8, len(tags)) + b''.join(struct.pack('<HHII', *tag) for tag in tags)).ljust(264, b'\0'))"
halflight diff a.tif floats.tif 2>&1 || echo $?
