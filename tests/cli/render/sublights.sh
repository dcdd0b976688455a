# A light in parts: one changes the picture more than sixteen, wherever these stand; without them the option is idle, and
# says so.
tool ball 16 ball_16x16x16_uint8.raw
for parts in 1 2 4 6; do
  halflight render ball_16x16x16_uint8.raw --size 48x48 --quiet --light-size 66 --soft-method sublights \
    --light-samples $parts -o $parts.npy
done
halflight render ball_16x16x16_uint8.raw --size 48x48 --quiet --light-size 66 --soft-method sublights -o plain.npy
cmp 4.npy plain.npy
halflight diff 6.npy 4.npy --max-rmse 0.00001 >text
halflight diff 6.npy 1.npy --max-rmse 0.00001 >text 2>&1 && exit 1
halflight render ball_16x16x16_uint8.raw --size 8x8 --light-samples 3 -o idle.npy 2>&1 >/dev/null | grep warning
