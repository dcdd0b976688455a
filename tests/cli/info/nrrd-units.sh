# A NRRD header without a space tells the unit of its spacings in the field "units", one for each axis. "space units" goes before it.
"$PYTHON" -c 'import sys; sys.stdout.buffer.write(bytes(range(48)))' >voxels.raw
told() {
  printf 'NRRD0004\ntype: uint8\n%s\nencoding: raw\ndata file: voxels.raw\n' "$1" >grid.nhdr
  halflight info grid.nhdr --json 2>warnings >info.json
  tool json info.json 'd["unit"], d["spacing"]'
}
GRID='dimension: 3
sizes: 4 4 3
spacings: 2 2 5'
told "$GRID"
told "$GRID
units: \"mm\" \"mm\" \"mm\""
told "$GRID
units: \"micron\" \"um\" \"micrometer\""
told "$GRID
units: \"mm\" \"mm\" \"um\""
told "$GRID
units: \"mm\" \"mm\" \"slice\""
told "$GRID
units: \"s\" \"s\" \"s\""
told 'dimension: 4
sizes: 4 4 3 1
spacings: 2 2 5 NaN
kinds: domain domain domain list
units: "mm" "mm" "mm" "ms"'
told 'dimension: 4
sizes: 1 4 4 3
spacings: NaN 2 2 5
kinds: vector domain domain domain
units: "" "mm" "mm" "mm"'
told 'dimension: 3
sizes: 4 4 3
units: "mm" "mm" "mm"
space dimension: 3
space directions: (2,0,0) (0,2,0) (0,0,5)
space units: "um" "um" "um"'
told 'dimension: 3
sizes: 4 4 3
space dimension: 3
space directions: (2,0,0) (0,2,0) (0,0,5)
space units: "um" "um" "um"
units: "mm" "mm" "mm"'
