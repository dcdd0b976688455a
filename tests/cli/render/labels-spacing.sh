# The spacing that --spacing states for bare voxels also holds for a label map or a mask of as many voxels.
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
