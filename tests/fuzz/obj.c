/* tests/fuzz/obj.c - fuzz target: OBJ meshes, with a library of materials beside them. */
#include "target.h"

const uint64_t fuzz_memory_limit = 4 << 20;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_load_mesh("m.obj", "m.mtl", data, size);
  return 0;
}
