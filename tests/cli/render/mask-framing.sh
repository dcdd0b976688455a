# The part of a volume that a mask leaves is framed as if there were nothing else: a ball in the corner of a filled cube is in the picture's middle
# and fills it as the same ball without matter around it does. The mask's grid may be coarser than the volume's.
"$PYTHON" -c 'import math
def write(name, edge, value):
    n = 48 // edge
    places = [edge * (i + 0.5) - 0.5 for i in range(n)]
    header = f"NRRD0004\ntype: uint8\ndimension: 3\nsizes: {n} {n} {n}\nspacings: {edge} {edge} {edge}\nencoding: raw\n"
    header += f"space origin: ({places[0]},{places[0]},{places[0]})\n\n"
    header = header.replace(f"spacings: {edge} {edge} {edge}\n", f"space dimension: 3\nspace directions: ({edge},0,0) (0,{edge},0) (0,0,{edge})\n")
    open(name, "wb").write(header.encode() + bytes(value(x, y, z) for z in places for y in places for x in places))
def ball(x, y, z):
    return math.dist((x, y, z), (12, 36, 36)) < 8
write("cube.nrrd", 1, lambda x, y, z: 1)
write("ball.nrrd", 1, ball)
write("fine.nrrd", 1, ball)
write("coarse.nrrd", 2, ball)
write("all.nrrd", 1, lambda x, y, z: 2 - ball(x, y, z))'
echo '{"opacity": [[0.5, 0], [0.6, 0.9]], "color": [1, 1, 1], "unit_distance": 1}' >tf.json
shown() { halflight render "$@" --tf tf.json --view left --size 96x96 --quiet -o p.npy && "$PYTHON" - <<'END'
import struct
data = open("p.npy", "rb").read()
begin = 10 + struct.unpack("<H", data[8:10])[0]
alphas = struct.unpack_from(f"<{96 * 96 * 4}f", data, begin)[3::4]
seen = [divmod(n, 96) for n, alpha in enumerate(alphas) if alpha > 0.1]
for along in zip(*seen):
    print("filled" if max(along) - min(along) >= 75 else (min(along), max(along)),
          "in the middle" if abs(min(along) + max(along) - 95) <= 3 else (min(along), max(along)))
END
}
shown ball.nrrd
for mask in fine coarse; do shown cube.nrrd --mask $mask.nrrd; done
# So it is where the other matter has a label that is not shown. A mask of which all labels are shown changes no framing.
shown cube.nrrd --mask all.nrrd --show 1
halflight render cube.nrrd --mask all.nrrd --show 1,2 --tf tf.json --view left --size 96x96 --print-scene --quiet >both.json
halflight render cube.nrrd --tf tf.json --view left --size 96x96 --print-scene --quiet >bare.json
for scene in both bare; do tool json $scene.json "d['camera']"; done | uniq | wc -l
