for clip in x=0.5:0.2 w=0:1 x=0:2 x=: x=0.5 x=1foo:2foo; do
  code=0
  halflight render x.nrrd --clip $clip 2>message || code=$?
  echo $code
done
