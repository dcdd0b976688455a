/* tests/fuzz/mrc.c - fuzz target: MRC and CCP4 maps, plain and gzip. */
#include "target.h"

const uint64_t fuzz_memory_limit = 3 << 20;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_load_volume("v.mrc", "v.raw", data, size);
  return 0;
}
