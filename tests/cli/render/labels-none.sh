# A map without any label is told: the picture shows nothing of it.
tool ball 12 scan_12x12x12_uint8.raw
head -c 1728 /dev/zero >empty_12x12x12_uint8.raw
for option in --labels --mask; do
  halflight render scan_12x12x12_uint8.raw $option empty_12x12x12_uint8.raw --size 16 -o picture.png 2>&1 | grep -v '^picture.png'
done
