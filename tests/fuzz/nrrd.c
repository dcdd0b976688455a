/* tests/fuzz/nrrd.c - fuzz target: NRRD files, attached and detached, raw, gzip, text and hex. */
#include "target.h"

const uint64_t fuzz_memory_limit = 3 << 20;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_load_volume("v.nrrd", "v.raw", data, size);
  return 0;
}
