# The legend lists solid labels before translucent ones, and no labels that are not seen.
tool atlas 16 map.nrrd
printf '997,one\n182305693,two\n614454277,three\n614454278,four\n' >names.csv
legend() { halflight render map.nrrd --label-table names.csv --show "$1" --legend auto --place legend=below --size 200 --quiet -o legend.pdf; pdftotext -layout legend.pdf - | grep -oE 'one|two|three|four' | tr '\n' ' '; echo; }
legend three,rest:0.2
legend three,rest:0
