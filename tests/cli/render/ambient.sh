# With ambient light alone, of a grey twice as bright, a picture is twice as bright; a colour is seen as such.
tool ball 16 ball_16x16x16_uint8.raw
cat >dark.json <<'END'
{"halflight": 1, "lights": [], "volumes": [{"file": "ball_16x16x16_uint8.raw"}]}
END
for ambient in 0.2 0.4 '#ff0000'; do
  halflight render dark.json --quiet --size 24x24 --ambient "$ambient" -o "a$ambient.npy"
done
tool ratio a0.2.npy a0.4.npy
tool ratio a0.2.npy 'a#ff0000.npy'
