# Of a folder of DICOM slices, one that was cut, even to nothing, is not left out without a word; other short files are.
tool stack 8x8x6 s.dicom
echo "not a slice" >s.dicom/README
halflight info --json s.dicom >whole.json
for bytes in 0 100 140; do
  head -c $bytes s.dicom/4.dcm >s.dicom/5.dcm
  halflight info --json s.dicom 2>&1 >cut.json | grep -o '1 DICOM files cannot be read and are left out; the first: s.dicom/5.dcm'
  tool json cut.json 'd["dimensions"]'
done
rm s.dicom/5.dcm
: >s.dicom/without_an_ending
halflight info --json s.dicom 2>&1 >cut.json | grep -o '1 DICOM files cannot be read.*'
