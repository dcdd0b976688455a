# Labels that other matter hides from the camera are told of, once for each map; those that are seen, or that nothing hides, are not.
tool ball 24 scan_24x24x24_uint8.raw
"$PYTHON" -c "
import numpy
for name, place in (('core', 12), ('rim', 3)):
    labels = numpy.zeros((24, 24, 24), numpy.uint8)
    labels[10:14, place - 1:place + 2, 10:14] = 1
    labels.tofile(name + '_24x24x24_uint8.raw')"
for name in core rim; do
  for options in '--view front' '--view back' '--iso scan_24x24x24_uint8=60:silver:0.2' '--cut-box scan_24x24x24_uint8=y=:0.5' '--look mip'; do
    halflight render scan_24x24x24_uint8.raw --labels ${name}_24x24x24_uint8.raw $options --print-scene 2>message >scene.json || true
    echo "$name $options: $(cut -d: -f1 message)"
  done
done
