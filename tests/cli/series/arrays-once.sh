# What is said of the first file of a series is not said again of the files that only the camera and the range look at.
for number in 0 1 2 3; do
  cat >"flame_$number.vti" <<END
<VTKFile type="ImageData"><ImageData WholeExtent="0 1 0 1 0 1"><PointData>
<DataArray type="UInt8" Name="heat">0 2 3 4 5 6 7 20$number</DataArray><DataArray type="UInt8" Name="OH">8 7 6 5 4 3 2 10</DataArray>
</PointData></ImageData></VTKFile>
END
done
for words in '' --range-of-all; do
  halflight render 'flame_*.vti' $words --size 8 -o 'flame-%d.png' 2>message
  grep -c 'heat is taken' message
  rm flame-*.png
done
