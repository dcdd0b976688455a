/* tests/fuzz/particle_files.c - fuzz target: particles in tables, dumps of LAMMPS, XYZ and VTK's PolyData. */
#include "target.h"

const uint64_t fuzz_memory_limit = 8 << 20;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_load_volume("v.csv", "v.raw", data, size);
  fuzz_load_volume("v.xyz", "v.raw", data, size);
  fuzz_load_volume("v.vtp", "v.raw", data, size);
  return 0;
}
