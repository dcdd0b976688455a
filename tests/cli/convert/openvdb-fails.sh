# A .vdb file where its converter is absent, fails, writes no volume, or is interrupted: one line each, and nothing is left behind.
mkdir bin none
printf ' BDV and so on' >smoke.vdb
HALFLIGHT_OPENVDB=none/nanovdb_convert "$HALFLIGHT" info smoke.vdb && exit 9
cat >bin/nanovdb_convert <<'END'
#!/bin/sh
echo "cannot read $(basename "$1")" >&2
exit 1
END
chmod +x bin/nanovdb_convert
mkdir temporary
export TMPDIR=$PWD/temporary
HALFLIGHT_OPENVDB=bin/nanovdb_convert "$HALFLIGHT" info smoke.vdb && exit 9
printf '#!/bin/sh\necho text >"$2"\n' >bin/nanovdb_convert
HALFLIGHT_OPENVDB=bin/nanovdb_convert "$HALFLIGHT" info smoke.vdb && exit 9
printf '#!/bin/sh\nsleep 60\n' >bin/nanovdb_convert
HALFLIGHT_OPENVDB=bin/nanovdb_convert "$HALFLIGHT" info smoke.vdb &
await_handler $!
kill -INT $!
wait $! && exit 9
ls temporary | wc -l
