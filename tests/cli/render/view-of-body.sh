# A side of a scanned body whose file tells no anatomy is told of, since the file's front may be the body's back.
"$PYTHON" -c "
import numpy
z, y, x = numpy.mgrid[0:40, 0:40, 0:40]
distance = numpy.sqrt((x - 20)**2 + (y - 20)**2 + (z - 12)**2)
values = numpy.where(distance < 15, 40, -1000) + numpy.where(abs(distance - 10) < 1, 900, 0)
(values + numpy.random.default_rng(1).normal(0, 12, values.shape)).clip(-1024, 3000).astype(numpy.int16).tofile('head_40x40x40_int16.raw')"
halflight info head_40x40x40_int16.raw | grep 'taken for'
for options in '--view front' '--view right' '--view top' '--view front --azimuth 20' ''; do
  halflight render head_40x40x40_int16.raw $options --print-scene 2>&1 >scene.json | grep directions || echo nothing
done
