# A pixel of N x N samples is the mean of the N x N pixels of a picture that is N times as large.
tool ball 16 a_16x16x16_uint8.raw
cut="--cut-plane 0.5,0.5,0.6:0.3,-0.4,1 --zoom 0.8"
halflight render a_16x16x16_uint8.raw $cut --size 48x40 --pixel-samples 3 --quiet -o mean.npy
halflight render a_16x16x16_uint8.raw $cut --size 144x120 --quiet -o large.npy
halflight render a_16x16x16_uint8.raw $cut --size 48x40 --quiet -o single.npy
"$PYTHON" - <<'END'
from array import array
def pixels(name, count):
    values = array("f")
    values.frombytes(open(name, "rb").read()[-16 * count:])
    return values
mean, large, single = pixels("mean.npy", 48 * 40), pixels("large.npy", 144 * 120), pixels("single.npy", 48 * 40)
far = beside = 0
for y in range(40):
    for x in range(48):
        for c in range(4):
            wanted = sum(large[4 * (144 * (3 * y + j) + 3 * x + i) + c] for j in range(3) for i in range(3)) / 9
            far = max(far, abs(mean[4 * (48 * y + x) + c] - wanted))
            beside = max(beside, abs(single[4 * (48 * y + x) + c] - wanted))
print("the mean:", far < 1e-6, "not the pixel's middle:", beside > 0.05)
END
halflight render a_16x16x16_uint8.raw --pixel-samples 3 --print-scene | grep pixel_samples
halflight render a_16x16x16_uint8.raw --print-scene | grep -c pixel_samples || true
code=0
halflight render a_16x16x16_uint8.raw --pixel-samples 9 2>message || code=$?
echo $code $(cat message)
code=0
halflight render a_16x16x16_uint8.raw --antialias 2 2>message || code=$?
echo $code $(cat message)
