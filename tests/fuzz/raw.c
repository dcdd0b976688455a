/* tests/fuzz/raw.c - fuzz target: bare voxels, whose name says what they are, and .dat descriptors.
 *
 * The input's first line is the file's name.
 */
#include <string.h>

#include "target.h"

const uint64_t fuzz_memory_limit = 3 << 20;

enum { NAME_BYTES = 120 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  const uint8_t *end = size > 0 ? memchr(data, '\n', size) : NULL;
  if (end == NULL || end - data >= NAME_BYTES || end == data) return 0;
  char name[NAME_BYTES];
  size_t length = (size_t)(end - data);
  memcpy(name, data, length);
  name[length] = 0;
  if (strlen(name) != length || strchr(name, '/') != NULL || name[0] == '.' || strcmp(name, "v.raw") == 0)
    return 0;
  fuzz_load_volume(name, "v.raw", end + 1, size - length - 1);
  return 0;
}
