# The plan of a frame: its size, its sweeps, the lights with their shadow buffers; no picture beside it.
tool ball 24 ball_24x24x24_uint8.raw
plan() { halflight render ball_24x24x24_uint8.raw --size 40x30 --quiet "$@" --print-plan >plan.json; }
methods() { tool json plan.json "[[l['method'], l.get('sublights', 0), min(l['buffer']) > 20, l['sheet_bytes'] > 0] for s in d['sweeps'] for l in s['lights'] if 'method' in l]"; }
plan
tool json plan.json "d['picture']['size'], d['picture']['tiles'] >= 6, d['volumes'][0]['dimensions'], d['meshes'], d['sky']"
tool json plan.json "[(l['light'], l['wide'], l['image'], l['sun']) for l in d['lights']], d['volumes'][0]['visible'], d['volumes'][0]['casts_shadow']"
tool json plan.json "sorted(l['light'] for s in d['sweeps'] for l in s['lights'])"
tool json plan.json "sum(s['adds_even_light'] for s in d['sweeps']), sum(s['normal'][a] ** 2 for s in d['sweeps'][:1] for a in (0, 1, 2)) > 0.99"
methods
plan --shadows soft --soft-method sublights --light-samples 3
methods
plan --shadows off
methods
plan --sheet-spacing 0.25
fine=$(tool json plan.json "d['sweeps'][0]['sheets']")
plan --sheet-spacing 0.5
tool json plan.json "abs($fine / d['sweeps'][0]['sheets'] - 2) < 0.1"
code=0
halflight render ball_24x24x24_uint8.raw --print-plan -o a.png 2>message || code=$?
echo $code $(cat message)
ls | grep -c png || true
