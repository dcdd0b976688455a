# A picture renders to itself, bytes and all, and is not written over.
tool ball 16 ball_16x16x16_uint8.raw
halflight render ball_16x16x16_uint8.raw --size 24x20 --quiet --azimuth 50 --threshold 90 --colormap viridis -o first.png
cp first.png kept.png
halflight render first.png --quiet
cmp first.png kept.png
cmp first.png first-again.png
halflight render first.png --quiet --size 12x10 --light 0,90 -o other.png
tool png-header other.png
# A picture by another name, and one without a scene.
cp first.png no-extension
halflight render no-extension --quiet -o c.npy
halflight diff first.png first.png -o plain.png >numbers
code=0
halflight render plain.png 2>message || code=$?
echo $code $(cat message)
head -c 100 first.png >cut.png
code=0
halflight render cut.png 2>message || code=$?
echo $code $(cat message)
