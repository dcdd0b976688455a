/* tests/fuzz/tiff.c - fuzz target: TIFF and BigTIFF, OME-TIFF of two files, ImageJ's hyperstacks. */
#include "target.h"

const uint64_t fuzz_memory_limit = 3 << 20;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_load_volume("v.tif", "w.tif", data, size);
  return 0;
}
