# --spacing tells where the voxels of a raw file lie; one number stands for all axes.
tool ball 8 ball_8x8x8_uint8.raw
halflight info ball_8x8x8_uint8.raw --spacing 0.5,1,2 | grep -e spacing -e box
halflight info ball_8x8x8_uint8.raw --spacing 0.25 | grep -e spacing -e box
halflight info ball_8x8x8_uint8.raw --spacing 1,2 2>&1 || echo $?
# An option's NAME= is a raw file's name without its size, or with it.
halflight render ball_8x8x8_uint8.raw --iso ball=90:red --size 16x16 --quiet -o short.png
halflight render ball_8x8x8_uint8.raw --iso ball_8x8x8_uint8=90:red --size 16x16 --quiet -o long.png
halflight diff --max-error 0 short.png long.png >/dev/null
halflight render ball_8x8x8_uint8.raw --iso ball_8=90:red --size 16x16 -o no.png 2>&1 || echo $?
