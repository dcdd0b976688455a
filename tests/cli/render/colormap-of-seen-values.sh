# A block of 100 in which one voxel is 250 and which a fog of 30 surrounds: the colormap is for the values that are seen.
"$PYTHON" -c '
import sys
n = 24
inside = lambda *p: all(6 <= c < 18 for c in p)
voxel = lambda x, y, z: 250 if (x, y, z) == (12, 12, 12) else 100 + (x + y + z) % 5 if inside(x, y, z) else 30
sys.stdout.buffer.write(bytes(voxel(x, y, z) for z in range(n) for y in range(n) for x in range(n)))' >b_24x24x24_uint8.raw
echo '{"unit_distance": 1, "opacity": [[60, 0], [90, 0.4], [255, 0.9]]}' >tf.json
halflight render b_24x24x24_uint8.raw --tf tf.json --colormap viridis --smooth 0 --print-scene >scene.json
tool json scene.json "[round(d['volumes'][0]['transfer_function']['color'][end][0]) for end in (0, -1)]"
