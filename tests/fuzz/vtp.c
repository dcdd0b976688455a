/* tests/fuzz/vtp.c - fuzz target: VTK PolyData, XML and legacy. */
#include "target.h"

const uint64_t fuzz_memory_limit = 4 << 20;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_load_mesh("m.vtp", NULL, data, size);
  return 0;
}
