# --colormap takes a colour: one for all values; of a maximum projection from black to it.
tool ball 8 ball_8x8x8_uint8.raw
halflight render ball_8x8x8_uint8.raw --colormap '#ff0000' --print-scene | tr -d ' \n' | grep -o '"color":\[\[[^]]*\]\]' |
  sed 's/\[\[[^,]*,/[[value,/'
halflight render ball_8x8x8_uint8.raw --colormap red --range 0,100 --look mip --print-scene |
  tr -d ' \n' | grep -o '"color":\[\[[^:]*\]\]'
