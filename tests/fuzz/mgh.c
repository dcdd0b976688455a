/* tests/fuzz/mgh.c - fuzz target: FreeSurfer's volumes, plain and packed by gzip. */
#include "target.h"

const uint64_t fuzz_memory_limit = 3 << 20;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_load_volume("v.mgh", NULL, data, size);
  return 0;
}
