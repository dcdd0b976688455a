# A series of VTK files of cells is of volumes, as each of its files is alone.
for t in 0 1; do
  cat >cell-$t.vtu <<END
<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid><Piece NumberOfPoints="8" NumberOfCells="1">
<PointData Scalars="f"><DataArray type="Float32" Name="f" format="ascii">0 1 2 3 4 5 6 $((7 + t))</DataArray></PointData>
<Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1</DataArray></Points>
<Cells><DataArray type="Int32" Name="connectivity" format="ascii">0 1 2 3 4 5 6 7</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">8</DataArray><DataArray type="UInt8" Name="types" format="ascii">12</DataArray></Cells>
</Piece></UnstructuredGrid></VTKFile>
END
done
cp cell-0.vtu other-0.vtu
cp cell-0.vtu other-1.vtu
halflight render cell-0.vtu --size 16x16 -o alone.png --quiet
halflight render 'other-*.vtu' --size 16x16 -o 'other-%d.png' --quiet
halflight render 'cell-*.vtu' --size 16x16 -o '%d.png' --quiet
halflight diff alone.png other-0.png --max-error 0 >/dev/null && echo same
halflight info cell-0.vtu 2>/dev/null | grep -c voxels
halflight render 0.png --print-scene 2>/dev/null | grep -c '"file": "cell-0.vtu"'
