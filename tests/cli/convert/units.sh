# The unit of lengths, as each format tells it.
halflight make rings --size 16 --quiet -o a.nrrd
halflight convert a.nrrd b.mrc --quiet
halflight info --json a.nrrd | grep unit
halflight info --json b.mrc | grep unit
halflight convert a.nrrd c.nii --quiet
printf '\012' | dd of=c.nii bs=1 seek=123 conv=notrunc 2>/dev/null
halflight info --json c.nii | grep unit
printf '\003' | dd of=c.nii bs=1 seek=123 conv=notrunc 2>/dev/null
halflight info --json c.nii | grep unit
