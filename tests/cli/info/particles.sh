# Particles: the quantities that a file has, and which one is read.
printf 'x,y,z,mass,h,temperature,kind\n0,0,0,1,0.5,10,gas\n1,2,3,2,0.25,20,gas\n' >t.csv
halflight info t.csv 2>message | grep -A2 arrays
grep -c 'of 3 arrays, log density is taken' message
grep -c '2 particles, spread by their smoothing lengths over' message
# The mean of a quantity.
halflight info t.csv --array temperature --json 2>message >info.json
tool json info.json "[round(n, 3) for n in d['range']]"
# A step of a dump, whose box is periodic along x and y: its voxels reach from end to end.
for step in 0 1; do
  printf 'ITEM: TIMESTEP\n%d\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp ff\n0 4\n0 8\n0 2\nITEM: ATOMS id type xs ys zs h\n' $step
  printf '1 1 .1 .2 .3 1\n2 5 .6 .7 .%d 1\n' $step
done >t.dump
halflight info t.dump --time 1 --array density --json 2>message >info.json
tool json info.json "d['times'], d['time'], d['origin'][:2], [(n - 1) * s for n, s in zip(d['dimensions'], d['spacing'])][:2]"
# Atoms without a box.
printf '3\nwater\nO 0 0 0.1\nH 0.75 0 -0.5\nH -0.75 0 -0.5\n' >w.xyz
halflight info w.xyz --array density 2>message | grep -c density
# VTK's points with masses are particles, too.
halflight info "$SOURCE/tests/fuzz/corpus/particle_files/two_pieces.vtp" --array v --json 2>message >info.json
tool json info.json "[a['name'] for a in d['arrays']], [round(n, 3) for n in d['range']]"
