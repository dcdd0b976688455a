/* volume/counts.c - see counts.h. */
#include "volume/counts.h"

static void count_u8(const uint8_t *voxels, size_t count, uint64_t *counts) {
  uint64_t lanes[4][256] = {{0}}; /* four tables are used in turn, so that in a run of equal values an
                                   * addition does not have to wait for the previous addition */
  size_t n = 0;
  for (; n + 4 <= count; n += 4)
    for (int lane = 0; lane < 4; lane++) lanes[lane][voxels[n + (size_t)lane]]++;
  for (; n < count; n++) lanes[0][voxels[n]]++;
  for (int value = 0; value < 256; value++)
    counts[value] += lanes[0][value] + lanes[1][value] + lanes[2][value] + lanes[3][value];
}

static void count_u16(const uint16_t *voxels, size_t count, uint64_t *counts) {
  for (size_t n = 0; n < count; n++) counts[voxels[n]]++;
}

size_t hl_values_of(hl_storage storage) {
  return storage == HL_STORAGE_U8 ? 256 : storage == HL_STORAGE_U16 ? 65536 : 0;
}

void hl_values_count(hl_storage storage, const void *voxels, size_t count, uint64_t *counts) {
  if (storage == HL_STORAGE_U8) count_u8(voxels, count, counts);
  else if (storage == HL_STORAGE_U16) count_u16(voxels, count, counts);
}
