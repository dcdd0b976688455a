# The sheets agree with the independent ray marcher, and a wrong light direction would not.
tool ball 16 ball_16x16x16_uint8.raw
set -- --size 32x32 --quiet --shadows hard --light-size 0 --sky 0
halflight render ball_16x16x16_uint8.raw "$@" --sheet-spacing 0.25 -o sheets.npy
halflight render ball_16x16x16_uint8.raw "$@" --reference --json -o exact.npy >statistics.json
tool json statistics.json 'd["method"]'
halflight diff exact.npy sheets.npy --max-rmse 0.002 --max-mean 0.001 >text
halflight render ball_16x16x16_uint8.raw "$@" --sheet-spacing 0.25 --light 40,-40 -o wrong.npy
if halflight diff exact.npy wrong.npy --max-rmse 0.02 >text 2>message; then exit 1; fi
