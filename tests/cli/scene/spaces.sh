"$PYTHON" - <<'END'
import random
random.seed(1)
def write(name, space, sign, voxels, shift):
    with open(name, "wb") as file:
        file.write(("NRRD0004\ntype: uint8\ndimension: 3\nspace: %s\nsizes: 12 12 12\nspace directions: (%d,0,0) (0,%d,0) (0,0,1)\n"
                    "space origin: (%d,%d,2)\nencoding: raw\n\n" % (space, sign, sign, sign * shift, sign * shift)).encode())
        file.write(voxels)
ball = bytes(max(0, 250 - 8 * ((i - 6) ** 2 + (j - 5) ** 2 + (k - 6) ** 2)) for k in range(12) for j in range(12) for i in range(12))
write("first.nrrd", "left-posterior-superior", 1, ball, 3)
write("same.nrrd", "left-posterior-superior", 1, ball, 9)
write("turned.nrrd", "right-anterior-superior", -1, ball, 9)
END
halflight render first.nrrd same.nrrd --size 64x64 --quiet -o same.npy
halflight render first.nrrd turned.nrrd --size 64x64 -o turned.npy --quiet
halflight diff --max-error 0 same.npy turned.npy >difference
# A scene agrees on the space of its first volume, too.
halflight render first.nrrd turned.nrrd --size 64x64 --quiet --print-scene >both.json
halflight render both.json -o again.npy --quiet
halflight diff --max-error 0 same.npy again.npy >difference
halflight render both.json -o again.npy 2>told || exit 9
grep -c "turned.nrrd: its world is RAS: it is turned into LPS, that of the volumes before it" told
