# A floor whose top the camera does not see is told of, with the mend; one that is seen, from a little above it too, is not.
tool ball 16 ball_16x16x16_uint8.raw
floor() { echo "$*:"; halflight render ball_16x16x16_uint8.raw --floor "$@" --print-scene 2>&1 >scene.json | sed 's/.*the camera //'; }
floor --view front --ortho
floor --view front
floor --elevation -20
floor --elevation 20 --ortho
floor --view iso
