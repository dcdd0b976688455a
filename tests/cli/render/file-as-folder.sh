# A file in the place of the folder is told before the work, also one that may be written and run.
halflight make torus --size 16 --quiet
cp torus.nrrd file
chmod 755 file
halflight render torus.nrrd --size 16 -o file/x.png 2>&1 || echo $?
