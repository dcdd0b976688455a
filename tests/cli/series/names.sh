# Pictures of a series have the names of their files where OUT has %s or is a folder, and so has the picture of one file.
mkdir scans there%
halflight make cloud --size 16 --quiet -o scans/b2.nrrd
halflight make torus --size 16 --quiet -o scans/a.2.nii.gz
halflight render 'scans/*' --size 16x16 -o 'out/x-%s%%.png' --quiet
halflight render scans/b2.nrrd scans/a.2.nii.gz --size 16x16 -o folder/ --quiet
halflight render 'scans/*' --size 16x16 -o there% --quiet
halflight render scans/b2.nrrd --size 16x16 -o one/ --quiet
halflight render scans/b2.nrrd --size 16x16 -o one --format exr --quiet
halflight render scans/b2.nrrd --size 16x16 --views front,top -o sides/ --quiet
halflight render scans/b2.nrrd --size 16x16 --print-scene >scene.json 2>/dev/null
halflight render 'sc*.json' -o scenes/ --quiet
ls out folder there% one sides scenes
