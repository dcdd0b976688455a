/* tests/fuzz/gltf.c - fuzz target: glTF meshes, JSON and binary. */
#include "target.h"

const uint64_t fuzz_memory_limit = 4 << 20;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_load_mesh("m.gltf", "m.bin", data, size);
  return 0;
}
