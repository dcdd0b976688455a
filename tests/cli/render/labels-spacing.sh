# The spacing that --spacing states for bare voxels also holds for a label map or a mask of as many voxels.
# slow: 7 seconds of processor time
tool ball 24 map_24x24x24_uint8.raw
halflight make rings --size 24 --quiet
tool ball 24 scan_24x24x24_uint8.raw
spaced() { halflight render "$@" --spacing 0.1,0.1,0.3 --size 60x50 --quiet; }
halflight convert map_24x24x24_uint8.raw map.nrrd --spacing 0.1,0.1,0.3 --quiet
spaced scan_24x24x24_uint8.raw --labels map_24x24x24_uint8.raw -o raw.png
halflight render scan_24x24x24_uint8.raw --spacing 0.1,0.1,0.3 --labels map.nrrd --size 60x50 --quiet -o placed.png
halflight diff --max-error 0 raw.png placed.png >/dev/null
spaced scan_24x24x24_uint8.raw --mask map_24x24x24_uint8.raw -o raw-mask.png
spaced scan_24x24x24_uint8.raw --mask map.nrrd -o placed-mask.png
halflight diff --max-error 0 raw-mask.png placed-mask.png >/dev/null
# The picture's own scene places the map in the same way.
for kind in raw raw-mask; do
  halflight render $kind.png --quiet -o again.png
  cmp $kind.png again.png
done
# A map on another grid keeps its own spacing.
tool ball 12 small_12x12x12_uint8.raw
spaced scan_24x24x24_uint8.raw --labels small_12x12x12_uint8.raw --print-scene | grep -c '"spacing"'
# A map whose file tells no spacing lies over a volume whose file tells one.
halflight convert scan_24x24x24_uint8.raw scan.nrrd --spacing 0.1,0.1,0.3 --quiet
told() { halflight render scan.nrrd "$@" --size 60x50 --quiet; }
told --labels map_24x24x24_uint8.raw -o bare.png
told --labels map.nrrd -o told.png
halflight diff --max-error 0 bare.png told.png >/dev/null
told --mask map_24x24x24_uint8.raw -o bare-mask.png
told --mask map.nrrd -o told-mask.png
halflight diff --max-error 0 bare-mask.png told-mask.png >/dev/null
for kind in bare bare-mask; do
  halflight render $kind.png --quiet -o again.png
  cmp $kind.png again.png
done
# A map that lies elsewhere is told.
halflight convert map_24x24x24_uint8.raw far.nrrd --spacing 0.1,0.1,0.3 --quiet
sed 's/space origin: (.*)/space origin: (500,0,0)/' far.nrrd >away.nrrd
halflight render scan.nrrd --mask away.nrrd --size 60x50 -o none.png 2>&1 | grep -o "away.nrrd: lies beside the volume: x"
