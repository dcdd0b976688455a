# A .vdb file by way of the program beside this one, or of nanovdb_convert; its name could be taken for an option.
[ -x "$(dirname "$HALFLIGHT")/halflight-openvdb" ] || command -v nanovdb_convert >bin.txt || { echo "no converter of OpenVDB"; exit 77; }
/usr/bin/python3 -c 'import pyopenvdb' 2>import.txt || { echo "no python3-openvdb"; exit 77; }
/usr/bin/python3 - <<'END'
import pyopenvdb
grid = pyopenvdb.FloatGrid()
grid.name = "density"
grid.fill((0, 0, 0), (4, 5, 6), 0.5)
pyopenvdb.write("-smoke.vdb", grids=[grid])
END
mkdir temporary
export TMPDIR=$PWD/temporary
halflight info ./-smoke.vdb | grep "dimensions\|^  range"
ls temporary | wc -l
