/* tests/fuzz/mesh.c - fuzz target: PLY, STL and OBJ files. The input's first byte chooses the name's ending.
 */
#include "target.h"

const uint64_t fuzz_memory_limit = 4 << 20;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static const char *const names[] = {"m.ply", "m.stl", "m.obj"};
  if (size > 0) fuzz_load_mesh(names[data[0] % 3], data + 1, size - 1);
  return 0;
}
