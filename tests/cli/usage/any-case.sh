# Names that are written in capitals are the same names: choices, presets, colormaps, colours, all channels.
tool ball 16 ball_16x16x16_uint8.raw
scene() { halflight render ball_16x16x16_uint8.raw "$@" --print-scene; }
scene --look surface --light-rig rim --tone filmic --view iso --background sky --sky 1 >one.json
scene --look SURFACE --light-rig Rim --tone Filmic --view ISO --background Sky --sky 1 >other.json
cmp one.json other.json
scene --quiet --tf ct-bone --colormap viridis >one.json
scene --quiet --tf CT-Bone --colormap Viridis >other.json
cmp one.json other.json
scene --channel all >one.json
scene --channel ALL >other.json
cmp one.json other.json
scene --look Surfaces 2>told && exit 1
grep -o 'did you mean surface' told
