/* volume/volume.h - the inside of hl_volume.
 *
 * Voxels are kept as u8, u16 or f32 in native byte order, never widened further: signed integers are
 * stored with their sign bit flipped (and an offset that undoes it), other types become f32.
 */
#ifndef HL_VOLUME_VOLUME_H
#define HL_VOLUME_VOLUME_H

#include <stdatomic.h>

#include <halflight/volume.h>

#include "core/vector.h"

typedef enum hl_storage { HL_STORAGE_U8 = 0, HL_STORAGE_U16 = 1, HL_STORAGE_F32 = 2 } hl_storage;

struct hl_volume {
  hl_context *context;
  atomic_int references;
  size_t dimension[3];       /* i, j, k */
  hl_storage storage;
  const void *voxels;        /* [k][j][i]; stored values; owned unless borrowed */
  void *owned_voxels;        /* what hl_release gets; null if borrowed */
  double value_scale;        /* data value = value_scale * stored + value_offset */
  double value_offset;
  affine3 index_to_world;    /* voxel centres at integer indices */
  hl_voxel_type type;        /* as in the file */
  double minimum, maximum;   /* data values over finite voxels */
  double mean;
  uint64_t nonfinite_count;
  uint64_t histogram[HL_HISTOGRAM_BINS];
};

static inline size_t hl_storage_bytes(hl_storage storage) {
  return storage == HL_STORAGE_U8 ? 1 : storage == HL_STORAGE_U16 ? 2 : 4;
}
static inline size_t hl_volume_voxel_count(const hl_volume *volume) {
  return volume->dimension[0] * volume->dimension[1] * volume->dimension[2];
}
size_t hl_voxel_type_bytes(hl_voxel_type type);

#endif
