# NAME=LO,HI and NAME=V are for one volume alone: it looks as it does alone with this value, and the other volume as without it.
tool ball 16 a_16x16x16_uint8.raw
tool ball 12 b_12x12x12_uint8.raw
scene() { halflight render "$@" --print-scene --quiet; }
scene a_16x16x16_uint8.raw --range 100,200 >ranged.json
scene a_16x16x16_uint8.raw --threshold 90 >opaque.json
scene b_12x12x12_uint8.raw --range 10%,90% >percent.json
scene a_16x16x16_uint8.raw b_12x12x12_uint8.raw >plain.json
scene a_16x16x16_uint8.raw b_12x12x12_uint8.raw --range a=100,200 >one.json
scene a_16x16x16_uint8.raw b_12x12x12_uint8.raw --threshold a=90 --range b=10%,90% >each.json
"$PYTHON" - <<'END'
import json
def function(name, index):
    return json.load(open(name + ".json"))["volumes"][index]["transfer_function"]
def opacity(name, index):  # a volume's colour depends on its neighbours
    return function(name, index)["opacity"]
print("the range of one:", opacity("one", 0) == opacity("ranged", 0) != opacity("plain", 0))
print("none for the other:", function("one", 1) == function("plain", 1))
print("the threshold of one:", opacity("each", 0) == opacity("opaque", 0))
print("the range of the other:", opacity("each", 1) == opacity("percent", 0) != opacity("plain", 1))
END
for wrong in "--range c=1,2" "--range a=5,1" "--range a=" "--range 1,2 --range a=1,2" "--range a=1,2 --threshold a=1" "--range 1,2 --threshold a=1" \
  "--threshold b=x"; do
  halflight render a_16x16x16_uint8.raw b_12x12x12_uint8.raw $wrong --print-scene 2>&1 && echo "not refused: $wrong" || true
done
