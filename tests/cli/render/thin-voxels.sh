# Voxels that are thin on one axis make many sheets, which a warning says. Sheets that are too many are refused at once, with one line of error.
tool ball 16 ball_16x16x16_uint8.raw
halflight render ball_16x16x16_uint8.raw --spacing .01,1,1 --size 8x8 --shadows off -o a.npy 2>errors
grep warning errors | sed 's/about [0-9]* sheets/about N sheets/'
halflight render ball_16x16x16_uint8.raw --spacing 1e-6,1,1 --size 8x8 -o b.npy 2>errors && exit 1
tail -1 errors
