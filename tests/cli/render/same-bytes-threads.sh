# Any number of threads gives the same bytes, for each kind of shadows, and so does a second run.
tool ball 20 ball_20x20x20_uint8.raw
for shadows in off hard soft; do
  halflight render ball_20x20x20_uint8.raw --size 61x47 --quiet --shadows $shadows --threads 1 -o first.npy
  tool coverage first.npy >box
  for threads in 1 2 7; do
    halflight render ball_20x20x20_uint8.raw --size 61x47 --quiet --shadows $shadows --threads $threads -o again.npy
    cmp first.npy again.npy
  done
done
# The scene in a picture does not tell the threads that made it.
for threads in 0 1 3; do
  halflight render ball_20x20x20_uint8.raw --size 20x16 --quiet --threads $threads -o picture.png
  [ $threads != 0 ] || cp picture.png first.png
  cmp first.png picture.png
done
