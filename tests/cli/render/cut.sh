# Cuts from options and from a scene add up; fractions are of the box around the cells, from -0.5 to 15.5.
tool ball 16 ball_16x16x16_uint8.raw
cuts() { halflight render "$@" --print-scene >made.json; tool json made.json "d['volumes'][0]['cuts']"; }
cuts ball_16x16x16_uint8.raw --cut-plane 0.5,0.5,2mm:1,0,0.5
cuts ball_16x16x16_uint8.raw --cut-box x=0.5:,z=1u:7u --cut-sphere 0.5,0.5,0.5:0.25
cp made.json scene.json
cuts scene.json --cut-sphere 0,0,0:3mm --cut-shading none --cut-casts-shadow
tool json made.json "d['volumes'][0]['cut_shading']"
tool json made.json "d['volumes'][0]['cut_casts_shadow']"
# A plane across an axis, which cuts away what lies from there on, or before.
for plane in x=0.25 x=0.25: y=:2mm; do cuts ball_16x16x16_uint8.raw --cut-plane $plane; done
for cut in plane=0.5,0.5:1,0,0 plane=0,0,0:0,0,0 plane=0,0,2:1,0,0 box=x=0.5:,x=:0.7 box=w=0:1 box=x=0:1, sphere=0,0,0:0 sphere=0,0,0 plane=x=0.2:0.5 plane=x= plane=w=1 plane=x=2; do
  code=0
  halflight render ball_16x16x16_uint8.raw --cut-${cut%%=*} ${cut#*=} 2>message || code=$?
  echo $code
done
# A view that an option chooses may look at the uncut side: a line names the option for the other side.
halflight make torus --size 16 --quiet -o side.nrrd
for options in "--cut-plane y=0.5 --view front" "--cut-plane y=:0.5 --view front" "--cut-plane y=:0.5 --view back --ortho" \
    "--cut-plane 0.5,0.5,0.5:0,1,0 --view front" "--cut-plane y=0.5" "--cut-plane y=0.5 --cut-plane x=0.5 --view right --azimuth 80"; do
  echo "$options: $(halflight render side.nrrd $options --size 16x16 -o side.png 2>&1 | grep -o 'away from the eye.*')"
done
