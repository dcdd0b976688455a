# A word for what only a scene says leads to the scene's key.
for word in emission specular light-color seed anisotropy henyey-greenstein opening-angle casts-shadow zenith falloff albedo; do
  halflight render --$word 1 x.nrrd 2>>told || true
done
sed 's/.*unknown option //' told
# Of render alone.
halflight info --emission 1 x.nrrd 2>told || true
cat told
