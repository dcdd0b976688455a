# Of pictures that never end no more is read than their headers announce, and 64 MiB; of what is no picture next to nothing.
tool ball 16 ball_16x16x16_uint8.raw
for kind in png exr npy; do
  halflight render ball_16x16x16_uint8.raw --size 16x16 --quiet -o small.$kind
  mkfifo endless.$kind
  cat small.$kind /dev/zero >endless.$kind 2>/dev/null &
  halflight diff endless.$kind small.$kind || echo $?
done
halflight diff /dev/zero small.png || echo $?
(head -c 100 small.exr; cat /dev/zero) >endless.exr 2>/dev/null &
halflight diff endless.exr small.exr || echo $?
cat >scene.json <<'END'
{ "halflight": 1, "volumes": [ { "file": "ball_16x16x16_uint8.raw" } ],
  "lights": [ { "type": "point", "position": [0, 0, 99], "texture": { "file": "endless.png",
                "screen": { "center": [8, 8, 40], "right": [16, 0, 0], "up": [0, 16, 0] } } } ] }
END
cat small.png /dev/zero >endless.png 2>/dev/null &
halflight render scene.json --quiet -o out.png || echo $?
