# --views: files are the pictures that --view makes, a sheet has the same pixels side by side.
halflight make rings --size 24 --quiet
halflight render rings.nrrd --views front,left,top --size 50x40 --quiet -o 'side-%s.png'
for side in front left top; do
  halflight render rings.nrrd --view $side --size 50x40 --quiet -o alone.png
  cmp alone.png side-$side.png
done
halflight render rings.nrrd --views front,left,top --size 50x40 -o sheet.png 2>&1 | sed 's/, [0-9.e-]* s$//'
# --width is the width of the whole sheet: 60 mm at 100 dots an inch are 236 pixels, to the rounding of three sides.
halflight render rings.nrrd --views front,left,top --width 60mm --dpi 100 --quiet -o wide.png
tool png-header wide.png
halflight render rings.nrrd --views front,lft -o no.png 2>&1 || echo $?
halflight render rings.nrrd --views front --view left -o no.png 2>&1 || echo $?
halflight render rings.nrrd --views front,left -o no.exr 2>&1 || echo $?
halflight render rings.nrrd --views front,left 2>&1 || echo $?
ls
