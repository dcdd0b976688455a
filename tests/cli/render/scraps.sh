# Fifty little balls beside a large one and a middle one, in noise. The little ones are hidden, and said to be; the picture is that of
# the scan without them, pixel by pixel. --whole shows them, and so does a projection of the air around them. Where little balls are a tenth of
# the matter, they are no scraps.
# slow: 7 seconds of processor time
"$PYTHON" -c '
import math, random, sys
random.seed(1)
noise = [int(random.gauss(6, 2)) for _ in range(64 ** 3)]
def inside(p, c, r): return 160 / (1 + math.exp((math.dist(p, c) - r) / .4))
little = [c for c in ((x, y, z) for z in range(3, 64, 9) for y in range(3, 64, 9) for x in range(3, 64, 9)) if math.dist(c, (32, 32, 30)) > 25 and math.dist(c, (54, 54, 54)) > 10][:50]
def scan(name, balls, radius):
    near = [[max((inside((x, y, z), c, radius) for c in balls if max(abs(x - c[0]), abs(y - c[1]), abs(z - c[2])) < 5), default=0) for x in range(64)] for z in range(64) for y in range(64)]
    with open(name, "wb") as file:
        for z in range(64):
            for y in range(64):
                for x in range(64):
                    p = (x, y, z)
                    value = max(near[64 * z + y][x], inside(p, (32, 32, 30), 18), inside(p, (54, 54, 54), 4.5))
                    file.write(bytes([max(0, int(value) + noise[64 * (64 * z + y) + x])]))
scan("balls_64x64x64_uint8.raw", little, 1.1)
scan("two_64x64x64_uint8.raw", [], 1)
scan("many_64x64x64_uint8.raw", little, 1.7)'
halflight render balls_64x64x64_uint8.raw --size 200x200 --print-scene >made.json 2>message
cat message
tool json made.json "sorted(d['volumes'][0]['scraps'])"
sed s/balls_/two_/ made.json >two.json
halflight render made.json -o made.npy --quiet
halflight render two.json -o two.npy --quiet
cmp made.npy two.npy && echo same
halflight render balls_64x64x64_uint8.raw --size 200x200 --whole -o whole.npy --quiet
halflight render balls_64x64x64_uint8.raw --size 200x200 --whole --print-scene | grep -c scraps || true
"$PYTHON" -c '
import numpy
seen = [(numpy.load(name)[..., 3] > .5).sum() for name in ("made.npy", "whole.npy")]
print(seen[1] > seen[0] + 300)'
halflight render balls_64x64x64_uint8.raw --look mip -o mip.png 2>&1 | grep -c hidden || true
halflight render many_64x64x64_uint8.raw --print-scene | grep -c scraps || true
