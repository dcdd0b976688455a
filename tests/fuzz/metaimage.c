/* tests/fuzz/metaimage.c - fuzz target: MetaImage, with its voxels inside or in a second file. */
#include "target.h"

const uint64_t fuzz_memory_limit = 3 << 20;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_load_volume("v.mha", "v.raw", data, size);
  return 0;
}
