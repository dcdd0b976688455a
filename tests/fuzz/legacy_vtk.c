/* tests/fuzz/legacy_vtk.c - fuzz target: legacy VTK structured points, text and binary. */
#include "target.h"

const uint64_t fuzz_memory_limit = 3 << 20;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_load_volume("v.vtk", "v.raw", data, size);
  return 0;
}
