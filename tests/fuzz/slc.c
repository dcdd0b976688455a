/* tests/fuzz/slc.c - fuzz target: volumes of VolVis, plain and run-length encoded. */
#include "target.h"

const uint64_t fuzz_memory_limit = 3 << 20;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_load_volume("v.slc", NULL, data, size);
  return 0;
}
