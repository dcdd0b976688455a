# Rails beside a scanned ball, cut away by planes that the scene names; --whole alone shows them.
"$PYTHON" -c '
import math, sys
ball = lambda x, y, z: 160 / (1 + math.exp((math.dist((x, y, z), (24, 24, 26)) - 15) / .6)) + 60 * (math.dist((x, y, z), (24, 24, 26)) < 8)
rail = lambda x, y, z: 90 * (21 <= y < 27 and 3 <= z < 5)
sys.stdout.buffer.write(bytes(min(255, int(max(ball(x, y, z), rail(x, y, z)) + (3 * x + 5 * y + 7 * z) % 5))
                              for z in range(48) for y in range(48) for x in range(48)))' >rail_48x48x48_uint8.raw
planes() { halflight render rail_48x48x48_uint8.raw "$@" --print-scene >made.json; tool json made.json "len(d['volumes'][0].get('cuts', []))"; }
planes 2>message
cat message
planes --look xray --quiet
planes --whole
planes --threshold 60 --quiet
planes --iso 60 --quiet
planes --tf ct-bone --quiet
planes --threshold 60 --whole
planes --whole --cut-plane 0.5,0.5,0.5:1,0,0
planes --cut-plane 0.5,0.5,0.5:1,0,0 --quiet
