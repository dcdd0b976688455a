/* tests/fuzz/mesh.c - fuzz target: PLY, STL and OBJ files. The input's first byte chooses the name's ending.
 */
#include "target.h"

#include <math.h>

const uint64_t fuzz_memory_limit = 4 << 20;

static void check_mesh(const hl_mesh *mesh) {
  const hl_mesh_description *d = hl_mesh_describe(mesh);
  double low[3], high[3];
  REQUIRE(d->triangle_count > 0 && hl_mesh_get_box(mesh, low, high) == HL_OK);
  for (int axis = 0; axis < 3; axis++) REQUIRE(isfinite(low[axis]) && low[axis] <= high[axis]);
  for (size_t t = 0; t < d->triangle_count; t++)
    for (int i = 0; i < 3; i++) REQUIRE(d->triangles[t][i] < d->vertex_count);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static const char *const names[] = {"m.ply", "m.stl", "m.obj"};
  hl_mesh *mesh = NULL;
  hl_error error = {0};
  if (size == 0) return 0;
  const char *path = fuzz_write_file(0, names[data[0] % 3], data + 1, size - 1);
  hl_status status = hl_mesh_load(fuzz_context(), path, &mesh, &error);
  if (fuzz_check_answer(status, &error, mesh != NULL)) check_mesh(mesh);
  hl_mesh_release(mesh);
  fuzz_remove_file(0);
  fuzz_check_nothing_held();
  return 0;
}
