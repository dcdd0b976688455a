# A stack of TIFF reads back the same, in every type, with an odd number of bytes and with one slice: values, voxels' lengths to seven digits, the
# unit as micrometres. ImageJ's description says what each page is.
"$PYTHON" - <<'END'
import struct
kinds = {"uint8": "B", "int8": "b", "uint16": "H", "int16": "h", "uint32": "I", "int32": "i", "uint64": "Q", "int64": "q", "float": "f", "double": "d"}
for type, letter in kinds.items():
    for name, (nx, ny, nz) in {"stack": (5, 3, 3), "page": (5, 3, 1)}.items():
        with open(f"{name}-{type}.nrrd", "wb") as file:
            file.write(f'NRRD0004\ntype: {type}\ndimension: 3\nspace dimension: 3\nsizes: {nx} {ny} {nz}\nspace directions: (0.25,0,0) (0,0.3,0) (0,0,1.7)\n'
                       f'space units: "mm" "mm" "mm"\nendian: little\nencoding: raw\n\n'.encode())
            file.write(b"".join(struct.pack("<" + letter, n * (2 if letter in "fd" else 1) + (0.5 if letter in "fd" else 0)) for n in range(nx * ny * nz)))
END
for name in stack-uint8 stack-int8 stack-uint16 stack-int16 stack-uint32 stack-int32 stack-uint64 stack-int64 stack-float stack-double page-uint8 page-float; do
  halflight convert $name.nrrd $name.tif --quiet
  halflight convert $name.tif back.nrrd --quiet --spacing 0.25,0.3,1.7
  halflight convert $name.nrrd again.nrrd --quiet --spacing 0.25,0.3,1.7
  cmp back.nrrd again.nrrd && echo "$name: the same"
done
halflight info --json stack-uint8.tif >told
tool json told '[round(length, 3) for length in d["spacing"]], d["unit"]'
grep -a -o 'ImageJ=.*\|images=.*\|slices=.*\|unit=.*\|spacing=.*' stack-uint8.tif | sort -u
# A picture is still a picture, and what a TIFF cannot tell is told.
halflight render stack-uint8.nrrd --size 8 --quiet -o picture.png
halflight convert picture.png picture.tif --quiet && "$PYTHON" -c 'print("a stack:", b"ImageJ=" in open("picture.tif", "rb").read())'
halflight convert picture.png picture.npy --quiet && halflight convert picture.npy picture2.tif --quiet && cmp picture.tif picture2.tif
halflight convert stack-uint8.nrrd stack.npy --quiet 2>/dev/null && halflight convert stack.npy stack.tiff --quiet && grep -a -c 'ImageJ=' stack.tiff
sed -e 's/(0,0,1.7)/(0,0.5,1.7)/' stack-uint8.nrrd >sheared.nrrd
halflight convert sheared.nrrd sheared.tif 2>&1 | grep warning
halflight make rings --size 16 --quiet -o made.tif && halflight info --json made.tif | grep -c '"dimensions"'
