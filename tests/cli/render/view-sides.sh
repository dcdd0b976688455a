# Sides, up and roll: a bar along +x and a shorter one along +z on a block tell every view from the others.
"$PYTHON" - <<'END'
import struct
n = 20
def thing(x, y, z):
    return float((6 <= x <= 12 and 6 <= y <= 12 and 6 <= z <= 12) or (x > 12 and 8 <= y <= 10 and 8 <= z <= 10) or (12 < z < 17 and 8 <= y <= 10 and 8 <= x <= 10))
for name, head in (("plain", ""), ("body", "space: right-anterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n")):
    with open(name + ".nrrd", "wb") as file:
        file.write(f"NRRD0004\ntype: float\ndimension: 3\nsizes: {n} {n} {n}\nencoding: raw\nendian: little\n{head}\n".encode())
        file.write(struct.pack(f"<{n ** 3}f", *(thing(x, y, z) for z in range(n) for y in range(n) for x in range(n))))
END
eye() { halflight render "$@" --print-scene >scene.json; tool json scene.json '[round((p - t) / max(abs(q - u) for q, u in zip(d["camera"]["position"], d["camera"]["target"])), 6) + 0 for p, t in zip(d["camera"]["position"], d["camera"]["target"])]'; }
for side in front back left right top bottom; do
  echo $side
  eye plain.nrrd --up +z --view $side
  eye body.nrrd --view $side
done
eye plain.nrrd --up -y --view front
eye plain.nrrd --up 0,0,-2 --view front --azimuth 90
eye plain.nrrd --up y --view iso
for degrees in 0 90 180 270; do # the block is the heavier end: at the bottom, and clockwise from there
  halflight render plain.nrrd --up z --view front --roll $degrees --light 0,0 --shadows off --size 64x64 --quiet -o a.npy
  tool brightness a.npy | awk '{ across = $1 - $2; down = $3 - $4; if (across * across > down * down) print (across > 0 ? "left" : "right"); else print (down > 0 ? "top" : "bottom") }'
done
halflight render plain.nrrd --up 0,0,0 -o a.npy || echo $?
