# The picture is named after the volume, compressed or not, and lands in the current folder.
mkdir volumes work
tool ball 12 volumes/ball_12x12x12_uint8.raw
gzip -k volumes/ball_12x12x12_uint8.raw
cat >volumes/head.v2.nhdr <<END
NRRD0004
type: uchar
dimension: 3
sizes: 12 12 12
encoding: raw
data file: ball_12x12x12_uint8.raw
END
cd work
halflight render ../volumes/ball_12x12x12_uint8.raw --size 16x16 --quiet
mv ball_12x12x12_uint8.png first.png
halflight render ../volumes/ball_12x12x12_uint8.raw.gz --size 16x16 --quiet
halflight diff first.png ball_12x12x12_uint8.png --max-error 0 >/dev/null
rm first.png
halflight render ../volumes/head.v2.nhdr --size 16x16 --quiet
ls
