# Of a scene that never ends, and of voxels under --max-memory, a pipe gives no more than there may be.
(echo '{ "halflight": 1, "volumes": ['; cat /dev/zero) 2>/dev/null | halflight render - -o out.png || echo $?
cat /dev/zero 2>/dev/null | halflight render - --max-memory 50M -o out.png || echo $?
