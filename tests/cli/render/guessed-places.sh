# Places that people write without the manual: those with one meaning are what the long form is, the others lead to it.
cat >lps.nhdr <<'END'
NRRD0004
type: uint8
dimension: 3
sizes: 16 16 16
space: left-posterior-superior
space directions: (1,0,0) (0,1,0) (0,0,1)
space origin: (0,0,0)
encoding: raw
data file: ball_16x16x16_uint8.raw
END
tool ball 16 ball_16x16x16_uint8.raw
scene() { halflight render "$@" --print-scene 2>/dev/null; }
same() { # FILE: both options make the same scene
  scene "$1" $2 >one.json
  scene "$1" $3 >other.json
  cmp -s one.json other.json && echo "$2 is $3" || echo "$2 is not $3"
}
same lps.nhdr "--slice axial" "--slice z=0.5"
same lps.nhdr "--slice coronal=0.25" "--slice y=0.25"
same lps.nhdr "--slice sagittal=4mm" "--slice x=4mm"
same lps.nhdr "--slice z" "--slice z=0.5"
same lps.nhdr "--clip x=0:0.5,z=0.25:" "--clip x=0:0.5 --clip z=0.25:"
same lps.nhdr "--clip 0:0.5,0:1,0.25:1" "--clip x=0:0.5 --clip y=0:1 --clip z=0.25:1"
same lps.nhdr "--cut-box 0.5:,:0.5,0.5:" "--cut-box x=0.5:,y=:0.5,z=0.5:"
same lps.nhdr "--iso 30,90,120:gold:0.5" "--iso 30 --iso 90 --iso 120:gold:0.5"
same lps.nhdr "--iso lps=30,90" "--iso lps=30 --iso lps=90"
for wrong in "--slice axial" "--slice axial=8mm" "--slice axial=2" "--slice oblique" "--clip left=0:0.5" "--clip 0:0.5" "--cut-plane anterior" \
  "--cut-box upper-left" "--iso 30,90," "--iso 30:gold,90" "--annotate A@upper-left" "--annotate @0.1,0.1"; do
  code=0
  halflight render ball_16x16x16_uint8.raw $wrong --quiet -o no.png 2>message || code=$?
  echo $code "$(cut -c12-150 message)"
done
# What hides another surface is told once.
halflight render ball_16x16x16_uint8.raw --iso 30,90 --print-scene 2>&1 >no.json | grep -c "hides the others"
halflight render ball_16x16x16_uint8.raw --iso 30::0.3 --iso 90 --print-scene 2>&1 >no.json | grep -c "hides the others" || true
# Texts without a place stand at the upper left, below one another.
halflight render ball_16x16x16_uint8.raw --size 400 --annotate One --annotate Two --quiet -o free.png
halflight render ball_16x16x16_uint8.raw --size 400 --annotate One@0.03,0.05 --annotate Two@0.03,0.1 --quiet -o placed.png
cmp free.png placed.png
