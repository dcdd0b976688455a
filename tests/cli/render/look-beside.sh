# A look stays beside --colormap and --labels; a maximum projection fits a background that is given; --tf beside --look tells which gives what.
tool ball 16 ball_16x16x16_uint8.raw
function() { tool json "$1" "[d['volumes'][0].get('shading'), d['volumes'][0]['transfer_function']['opacity']]"; }
halflight render ball_16x16x16_uint8.raw --look translucent --print-scene >plain.json
halflight render ball_16x16x16_uint8.raw --look translucent --colormap viridis --print-scene >map.json
halflight render ball_16x16x16_uint8.raw --look translucent --labels ball_16x16x16_uint8.raw --print-scene >labels.json
function plain.json >plain
function map.json | cmp plain && echo stays
function labels.json | cmp plain && echo stays
halflight render ball_16x16x16_uint8.raw --print-scene >auto.json
function auto.json | cmp -s plain || echo is another
colors() { tool json "$1" "[[round(one) for one in d['volumes'][0]['transfer_function']['color'][n][1:]] for n in (0, -1)]"; }
for background in 1 0 transparent; do
  halflight render ball_16x16x16_uint8.raw --look mip --background $background --print-scene >mip.json
  colors mip.json
done
halflight render ball_16x16x16_uint8.raw --look xray --tf ct-bone --print-scene 2>&1 >tf.json | grep -c -- '--tf beside --look xray'
