/* tests/fuzz/vgi.c - fuzz target: headers of VGStudio with their voxels, and boxes of VTK's adaptive grids.
 */
#include "target.h"

const uint64_t fuzz_memory_limit = 3 << 20;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_load_volume("v.vgi", "v.raw", data, size);
  fuzz_load_volume("v.vthb", "b.vti", data, size);
  return 0;
}
