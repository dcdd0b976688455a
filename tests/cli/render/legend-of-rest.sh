# The legend lists solid labels before translucent ones. It lists neither labels that are not seen, nor a translucent rest.
tool atlas 16 map.nrrd
printf '997,one\n182305693,two\n614454277,three\n614454278,four\n' >names.csv
legend() { halflight render map.nrrd --label-table names.csv --show "$1" --legend auto --place legend=below --size 200 --quiet -o legend.pdf; pdftotext -layout legend.pdf - | grep -oE 'one|two|three|four' | tr '\n' ' '; echo; }
legend one:0.5,three
legend three,rest:0.2
legend three,rest:0
legend three,rest
legend all:0.2
# A scene keeps what its legend lists.
halflight render map.nrrd --label-table names.csv --show three,rest:0.2 --size 32 --print-scene --quiet >scene.json
halflight render scene.json --legend auto --place legend=below --size 200 --quiet -o legend.pdf; pdftotext -layout legend.pdf - | grep -oE 'one|two|three|four'
