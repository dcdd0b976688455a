# A raw volume whose first voxel is the character "{" is a volume.
printf '{' >brace_8x8x8_uint8.raw
head -c 511 /dev/zero >>brace_8x8x8_uint8.raw
halflight render brace_8x8x8_uint8.raw --size 8x8 --quiet --json -o a.npy >statistics.json
tool json statistics.json 'd["voxels"]["total"]'
