halflight make rings --size 16 --quiet -o a.nrrd
halflight convert a.nrrd b.jpg && exit 9
halflight convert a.nrrd a.nrrd && exit 9
halflight convert a.nrrd b.nrrd --crop x=1:2 && exit 9
halflight convert a.nrrd b.nrrd --crop i=5:99 && exit 9
halflight convert a.nrrd b.mrc --type uint8 && exit 9
halflight convert a.nrrd b.raw && exit 9
halflight convert none.nrrd b.nrrd && exit 9
halflight convert a.nrrd && exit 9
halflight convert a.nrrd b.nrrd -o c.nrrd && exit 9
test ! -e b.nrrd
