# Scenes that a pattern finds are rendered each for itself, under their own names; a damaged one stops no other.
ball='{"halflight": 1, "image": {"width": 16, "height": 16}, "volumes": [{"shapes": [{"type": "sphere", "radius": 8}], "voxel_size": 1}]}'
echo "$ball" >fig2.json
echo "$ball" >fig10.json
mkdir pictures
halflight render 'fig*.json' -o 'pictures/%s-small.png' --quiet
halflight render fig2.json -o alone.png --quiet
cmp pictures/fig2-small.png alone.png && echo same
ls pictures
halflight render 'fig*.json' --quiet
ls *.png
halflight render 'fig*.json' -o one.png 2>&1 | cut -c1-60
echo '{' >fig3.json
halflight render 'fig*.json' -o 'pictures/%s.png' --quiet 2>/dev/null || echo "exit $?"
ls pictures
