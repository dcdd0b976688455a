# Statistics are the whole of standard output; stages are within the total.
tool ball 32 ball_32x32x32_uint8.raw
halflight render ball_32x32x32_uint8.raw --size 16x8 --json --threads 2 -o out.npy >statistics.json
tool json statistics.json 'd["voxels"]["total"] == 32768 and 0 < d["voxels"]["kept"] < 32768 and d["sheets"] > 5 and d["threads"] == 2'
tool json statistics.json 'sum(d["seconds"][key] for key in ["load", "prepare", "render", "write"]) <= d["seconds"]["total"]'
tool json statistics.json 'd["peak_memory_bytes"] > 1e6 and d["instruction_set"] in ["scalar", "avx2", "avx512", "avx512-vbmi", "neon"]'
tool npy-shape out.npy
