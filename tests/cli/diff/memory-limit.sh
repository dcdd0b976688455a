tool ball 16 ball_16x16x16_uint8.raw
halflight render ball_16x16x16_uint8.raw --size 200x200 --shadows off --quiet -o a.png
halflight diff a.png a.png --max-memory 2M >/dev/null
halflight diff a.png a.png --max-memory 100K
