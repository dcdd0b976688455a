/* tests/fuzz/vtr.c - fuzz target: rectilinear grids of VTK, XML, and in the legacy format. */
#include "target.h"

const uint64_t fuzz_memory_limit = 3 << 20;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_load_volume("v.vtr", NULL, data, size);
  return 0;
}
