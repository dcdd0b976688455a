head -c 4096 /dev/zero >voxels.raw
halflight info voxels.raw
