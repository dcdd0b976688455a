# A scene need not be named .json; its volume is found beside it.
mkdir folder
tool ball 8 folder/ball_8x8x8_uint8.raw
printf '\n  { "halflight": 1, "image": { "width": 9, "height": 5 }, "volumes": [ { "file": "ball_8x8x8_uint8.raw" } ] }' >folder/picture
halflight render folder/picture --quiet
rm -r folder
echo *
tool png-header picture.png >header
grep -q '^9 5 ' header
