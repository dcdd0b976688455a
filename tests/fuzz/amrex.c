/* tests/fuzz/amrex.c - fuzz target: plotfiles of AMReX in zip archives. */
#include "target.h"

const uint64_t fuzz_memory_limit = 3 << 20;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_load_volume("v.zip", NULL, data, size);
  return 0;
}
