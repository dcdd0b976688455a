/* tests/fuzz/vti.c - fuzz target: VTK image data (XML), every encoding and compressed blocks. */
#include "target.h"

const uint64_t fuzz_memory_limit = 3 << 20;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_load_volume("v.vti", "v.raw", data, size);
  return 0;
}
