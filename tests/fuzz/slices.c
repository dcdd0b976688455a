/* tests/fuzz/slices.c - fuzz target: one picture of a series of slices (PNG, JPEG, TIFF): its shape, then its
 * voxels. */
#include "core/memory.h"
#include "target.h"
#include "volume/convert.h"
#include "volume/formats/slices/slice_picture.h"

const uint64_t fuzz_memory_limit = 6 << 20;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  hl_context *context = fuzz_context();
  hl_slice_file file = {.context = context, .path = "v", .bytes = data, .length = size};
  hl_slice_shape shape;
  hl_slice_stack stack;
  hl_error error = {0};
  hl_status status = hl_slice_find_stack(&file, &stack, &error);
  if (status == HL_OK) status = hl_slice_measure(&file, &shape, &error);
  if (status == HL_OK && shape.width * shape.height <= 1 << 18) {
    void *voxels = hl_allocate(context, shape.width * shape.height, sizeof(float));
    int last = (int)shape.samples - 1;
    if (voxels != NULL)
      status = hl_slice_decode(&file, &shape, last > 0 ? HL_COMPONENT_MAGNITUDE : 0, voxels, &error);
    hl_release(context, voxels);
  }
  fuzz_check_answer(status, &error, status == HL_OK);
  fuzz_check_nothing_held();
  return 0;
}
