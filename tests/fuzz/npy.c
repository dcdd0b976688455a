/* tests/fuzz/npy.c - fuzz target: NumPy arrays as volumes. */
#include "target.h"

const uint64_t fuzz_memory_limit = 3 << 20;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_load_volume("v.npy", "v.raw", data, size);
  return 0;
}
