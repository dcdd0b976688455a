# Where the program takes another axis than +z for up, a line says which side of the file a --view is: the side that the eye is on. The cone is cut off
# by the end of the grid where z is greatest, and stands on it.
"$PYTHON" -c "
import numpy
z, y, x = numpy.mgrid[0:40, 0:40, 0:40]
values = numpy.where(numpy.hypot(x - 20, y - 20) < (z - 4) * 0.4, 200, 10)
(values + numpy.random.default_rng(1).normal(0, 4, values.shape)).clip(0, 255).astype(numpy.uint8).tofile('cone_40x40x40_uint8.raw')"
for options in '--view front' '--view back' '--view left' '--view top' '--view bottom' '--view iso' '--view front --up z' ''; do
  halflight render cone_40x40x40_uint8.raw $options --print-scene 2>&1 >scene.json | grep -o 'which way is up.*' || echo nothing
  tool json scene.json '["xyz"[axis] + " is " + ("greatest" if d["camera"]["position"][axis] > d["camera"]["target"][axis] else "least")
    for axis in range(3) if abs(d["camera"]["position"][axis] - d["camera"]["target"][axis]) > 1e-3 * d["camera"].get("height", 50)]'
done
