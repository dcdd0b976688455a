# A map of a statistic over a slice of anatomy: from the low end of its range on the picture has the map's colours, as a
# slice of the map alone has them, and elsewhere the anatomy's greys. Without a colormap the colours of volumes add up.
"$PYTHON" - <<'END'
import struct
n = 24
def write(name, value):
    with open(name, "wb") as file:
        file.write(f"NRRD0004\ntype: float\ndimension: 3\nsizes: {n} {n} {n}\nendian: little\nencoding: raw\n\n".encode())
        file.write(struct.pack(f"<{n**3}f", *(value(i, j) for k in range(n) for j in range(n) for i in range(n))))
write("anatomy.nrrd", lambda i, j: 10.3 * j + 0.37 * i)
write("zmap.nrrd", lambda i, j: i / 2 - 4)
write("top.nrrd", lambda i, j: j)
END
slice() { halflight render "$@" --slice z=0.5 --view bottom --size 96 --quiet; }
slice anatomy.nrrd zmap.nrrd --range zmap=2.5,7 --colormap zmap=hot -o both.npy
slice anatomy.nrrd -o under.npy
slice zmap.nrrd --range 2.5,7 --colormap hot -o over.npy
slice anatomy.nrrd zmap.nrrd top.nrrd --range zmap=2.5,7 --range top=12,23 --colormap zmap=hot --colormap top=viridis -o three.npy
slice top.nrrd --range 12,23 --colormap viridis -o top.npy
slice anatomy.nrrd zmap.nrrd -o sum.npy
"$PYTHON" - <<'END'
import ast, struct
def pixels(name):
    data = open(name, "rb").read()
    length, = struct.unpack("<H", data[8:10])
    height, width, channels = ast.literal_eval(data[10:10 + length].decode())["shape"]
    numbers = struct.unpack(f"<{height * width * channels}f", data[10 + length:])
    return [numbers[4 * p:4 * p + 3] for p in range(width * height)]
def same(a, b):
    return max(abs(x - y) for x, y in zip(a, b)) < 5e-4
both, under, over, three, top, added = (pixels(name + ".npy") for name in ("both", "under", "over", "three", "top", "sum"))
lit = [p for p in range(96 * 96) if max(under[p]) > 0]
left, right = min(p % 96 for p in lit), max(p % 96 for p in lit) + 1
upper, lower = min(p // 96 for p in lit), max(p // 96 for p in lit) + 1
def column(p):  # the coordinate along x; z is above 2.5 from 13 on
    return (p % 96 + 0.5 - left) / (right - left) * 24 - 0.5
def row(p):
    return (p // 96 + 0.5 - upper) / (lower - upper) * 24 - 0.5
clear = [p for p in lit if column(p) < 12.7]
shown = [p for p in lit if column(p) > 13.3]
print(len(clear) > 1000, len(shown) > 1000)
print(all(same(both[p], under[p]) for p in clear), all(same(both[p], over[p]) for p in shown))
print(all(same(three[p], top[p]) for p in lit if 12.5 < row(p) < 22), all(same(three[p], both[p]) for p in lit if 0.5 < row(p) < 11.5))
print(all(same(both[p], added[p]) for p in lit))
END
# No curve of opacity stands beside the strips of the legend: all values along them are opaque.
slice anatomy.nrrd zmap.nrrd --range zmap=2.5,7 --colormap zmap=hot --legend auto -o layers.svg || { echo "this build draws nothing"; exit 77; }
halflight render zmap.nrrd --look translucent --legend auto --size 96 --quiet -o solid.svg
for picture in layers solid; do echo "$picture: $(grep -c 'fill-opacity[:=]"*0.3' $picture.svg) curves"; done
