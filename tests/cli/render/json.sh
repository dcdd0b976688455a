# Statistics are the whole of standard output; stages are within the total.
tool ball 12 ball_12x12x12_uint8.raw
halflight render ball_12x12x12_uint8.raw --size 16x8 --json --threads 2 -o out.npy >statistics.json
tool json statistics.json 'd["voxels"]["total"] == 1728 and 0 < d["voxels"]["kept"] < 1728 and d["sheets"] > 5 and d["threads"] == 2'
tool json statistics.json 'sum(d["seconds"][key] for key in ["load", "prepare", "render", "write"]) <= d["seconds"]["total"]'
tool json statistics.json 'd["peak_memory_bytes"] > 1e6 and d["instruction_set"] in ["scalar", "avx2", "avx512"]'
tool npy-shape out.npy
