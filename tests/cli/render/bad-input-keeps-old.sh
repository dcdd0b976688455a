trap 'cat bad.png' EXIT
echo old >bad.png
echo 'NRRD0004' >bad.nrrd
halflight render bad.nrrd
