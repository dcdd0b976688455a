# --help wins over what else is wrong on the line.
halflight help render >help
grep -q -- '--shadows off|hard|soft' help
halflight render --help | cmp help -
halflight render missing.nrrd --size 3x3 -h | cmp help -
halflight help diff | grep -q -- '--max-rmse X'
