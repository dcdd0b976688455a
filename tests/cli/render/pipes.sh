# What comes through a pipe is the same as the file: a scene, a volume, a picture; by '-', /dev/stdin and a named pipe.
tool ball 12 ball_12x12x12_uint8.raw
{ printf 'NRRD0004\ntype: uint8\ndimension: 3\nsizes: 12 12 12\nencoding: raw\n\n'; cat ball_12x12x12_uint8.raw; } >ball.nrrd
echo '{"halflight": 1, "image": {"width": 20, "height": 16}, "volumes": [{"file": "ball.nrrd"}]}' >scene.json
halflight render scene.json --quiet -o scene.npy
halflight render ball.nrrd --size 20x16 --quiet -o volume.npy
cat scene.json | halflight render - --quiet -o a.npy
cat scene.json | halflight render /dev/stdin --quiet -o b.npy
halflight render - --quiet -o c.npy <scene.json
# Names of files in a scene start in the current folder, not in /dev.
halflight render /dev/stdin --quiet -o i.npy <scene.json
cmp scene.npy i.npy
# A folder of files in /dev is none of these.
if [ -w /dev/shm ]; then
  folder=$(mktemp -d /dev/shm/halflight-XXXXXX)
  cp ball.nrrd "$folder/moved.nrrd"
  sed 's/ball.nrrd/moved.nrrd/' scene.json >"$folder/scene.json"
  halflight render "$folder/scene.json" --quiet -o j.npy || true
  rm -r "$folder"
  cmp scene.npy j.npy
fi
mkfifo pipe
cat scene.json >pipe & halflight render pipe --quiet -o d.npy
for picture in a b c d; do cmp scene.npy $picture.npy; done
cat ball.nrrd | halflight render - --size 20x16 --quiet -o e.npy
cat ball.nrrd >pipe & halflight render pipe --size 20x16 --quiet -o f.npy
cmp volume.npy e.npy
cmp volume.npy f.npy
halflight render ball.nrrd --size 20x16 --quiet -o picture.png
cat picture.png | halflight render - --quiet -o g.npy
cmp volume.npy g.npy
# Without -o the picture has a name of its own; its scene reads standard input again.
halflight render - --size 20x16 --quiet <ball.nrrd
halflight render stdin.png --quiet -o h.npy <ball.nrrd
cmp volume.npy h.npy
# Readers that go back can: .vti. And info, and bench.
printf '<VTKFile type="ImageData"><ImageData WholeExtent="0 1 0 1 0 1"><PointData><DataArray type="UInt8">1 2 3 4 5 6 7 8</DataArray></PointData></ImageData></VTKFile>' | halflight info - | sed -n 1,2p
code=0
: | halflight render - --quiet -o i.npy 2>message || code=$?
echo $code $(cat message)
