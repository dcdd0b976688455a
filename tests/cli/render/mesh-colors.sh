# --colormap NAME=COLOR names meshes, too; without it a mesh beside a volume does not have the volumes' colour.
tool ball 16 ball_16x16x16_uint8.raw
printf 'v 0 0 0\nv 40 0 0\nv 40 40 0\nv 0 40 0\nf 1 2 3 4\n' >board.obj
color="[[round(c, 2) for c in m['color']] for m in d['meshes']]"
halflight render ball_16x16x16_uint8.raw board.obj --print-scene >scene.json
tool json scene.json "$color"
halflight render ball_16x16x16_uint8.raw board.obj --colormap board=red --colormap ball_16x16x16_uint8=viridis --print-scene >scene.json
tool json scene.json "$color, len(d['volumes'][0]['transfer_function']['color']) > 2"
halflight render board.obj --colormap board=#00f --floor --print-scene >scene.json
tool json scene.json "d['meshes'][0]['color'], len(d['meshes'])"
halflight render ball_16x16x16_uint8.raw board.obj --colormap board=viridis --print-scene 2>&1 || true
halflight render ball_16x16x16_uint8.raw board.obj --colormap borad=red --print-scene 2>&1 || true
# Where there are no volumes, a colour without a name is for all meshes.
halflight render board.obj --colormap '#00f' --print-scene >scene.json
tool json scene.json "d['meshes'][0]['color']"
halflight render board.obj --colormap viridis --print-scene 2>&1 || true
