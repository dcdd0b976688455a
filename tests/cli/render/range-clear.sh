# With a colormap, and over the range of all values, what is clear stays clear: opacity begins where it begins without --range.
tool ball 16 ball_16x16x16_uint8.raw
halflight render ball_16x16x16_uint8.raw --print-scene >auto.json
tool json auto.json "round(d['volumes'][0]['transfer_function']['opacity'][0][0], 3) > 20"
tool json auto.json "round(d['volumes'][0]['transfer_function']['opacity'][0][0], 3)" >auto.txt
for options in '--colormap inferno --range 10,255' '--colormap inferno --range 0,255' '--range 0,255' '--colormap red --range 0,255'; do
  halflight render ball_16x16x16_uint8.raw $options --print-scene >a.json
  tool json a.json "round(d['volumes'][0]['transfer_function']['opacity'][0][0], 3)" >a.txt
  cmp auto.txt a.txt
done
# A range within the values, without a colormap or with one colour, begins where it says.
for options in '--range 10,255' '--colormap red --range 10,255'; do
  halflight render ball_16x16x16_uint8.raw $options --print-scene >a.json
  tool json a.json "round(d['volumes'][0]['transfer_function']['opacity'][0][0], 3)"
done
# gray is a colormap, as in other programs, and no colour.
halflight render ball_16x16x16_uint8.raw --colormap grays --print-scene >a.json
halflight render ball_16x16x16_uint8.raw --colormap Grey --print-scene >b.json
cmp a.json b.json
