halflight make cloud --size 16 --quiet -o dump_1.nrrd
halflight render 'none*.nrrd' -o '%d.png' && exit 9
halflight render 'dump_*.nrrd' -o one.png && exit 9
halflight render 'dump_*.nrrd' -o '%d-%d.png' && exit 9
halflight render 'dump_*.nrrd' -o '%s-%d.png' && exit 9
halflight render 'dump_*.nrrd' -o '%d.png' --part 3/2 && exit 9
halflight render 'dump_*.nrrd' -o '%d.png' --json && exit 9
halflight render dump_1.nrrd --part 1/2 && exit 9
mkdir other
cp dump_1.nrrd other/dump_1.nrrd
halflight render dump_1.nrrd other/dump_1.nrrd -o 'pictures/%s.png' && exit 9
rm -r other
test "$(ls)" = dump_1.nrrd
