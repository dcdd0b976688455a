/* tests/fuzz/vtu.c - fuzz target: the cells of VTK's unstructured and curvilinear grids, XML. */
#include "target.h"

const uint64_t fuzz_memory_limit = 3 << 20;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_load_volume("v.vtu", NULL, data, size);
  return 0;
}
