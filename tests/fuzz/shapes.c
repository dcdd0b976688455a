/* tests/fuzz/shapes.c - fuzz target: volumes described by shapes, as for `halflight make`. */
#include <math.h>
#include <string.h>

#include "target.h"

/* If the text gives a voxel size, this number of bytes bounds the grid. Else the grid has SIZE voxels along
 * its longest side. */
const uint64_t fuzz_memory_limit = 128 << 10;
enum { SIZE = 16 };

static bool mentions(const uint8_t *data, size_t size, const char *word) {
  size_t length = strlen(word);
  for (size_t at = 0; at + length <= size; at++)
    if (memcmp(data + at, word, length) == 0) return true;
  return false;
}

static void check_values(hl_volume *volume) {
  hl_volume_info info = {.struct_size = sizeof info};
  REQUIRE(hl_volume_get_info(volume, &info) == HL_OK);
  REQUIRE(info.nonfinite_count == 0);
  REQUIRE(info.range[0] >= -1 && info.range[1] <= 1);
  for (int a = 0; a < 3; a++)
    REQUIRE(info.spacing[a] > 0 && isfinite(info.spacing[a]) && isfinite(info.origin[a]));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  hl_shapes_options options;
  hl_shapes_options_defaults(&options);
  options.size = mentions(data, size, "voxel_size") ? 0 : SIZE;
  options.threads = 1;
  hl_volume *volume = NULL;
  hl_error error = {0};
  hl_status status = hl_volume_from_shapes(fuzz_context(), (const char *)data, size, "shapes", &options,
                                           &volume, &error);
  if (fuzz_check_answer(status, &error, volume != NULL)) check_values(volume);
  hl_volume_release(volume);
  fuzz_check_nothing_held();
  return 0;
}
