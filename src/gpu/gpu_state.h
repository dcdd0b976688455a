/* gpu/gpu_state.h - defines the data of an open device. */
#ifndef HL_GPU_GPU_STATE_H
#define HL_GPU_GPU_STATE_H

#include "gpu/gpu.h"

enum { MOST_VARIANTS = 64 };

/* The buffers of a device. */
enum buffer_use {
  BUFFER_PLAN,
  BUFFER_RAYS,
  BUFFER_VOXELS,
  BUFFER_DISTANCES,
  BUFFER_DISTANCES_MADE, /* distances of bricks after the first pass, and after the third pass; kernels read
                          * the distances after the third pass */
  BUFFER_CELL_BITS,
  BUFFER_TABLES,
  BUFFER_DIRECTORY,
  BUFFER_COLORS,
  BUFFER_MASK,
  BUFFER_SKY,
  BUFFER_PIXELS, /* the content of this buffer and of the next ones depends on the camera */
  BUFFER_PLANES,
  BUFFER_LIGHT,
  BUFFER_CHANGED,
  BUFFER_SHOWN_FROM,
  BUFFER_COUNTS,
  BUFFER_SLOTS,
  BUFFER_LIST,
  BUFFER_MASKS,
  BUFFER_CUTS,
  BUFFER_SOFT,
  BUFFER_TOUCHED,
  BUFFER_FIELDS,
  BUFFER_ROWS,
  BUFFER_PASSES,
  BUFFER_BOXES,
  BUFFER_MARKS,
  BUFFERS
};

typedef struct known_program {
  plan_variant variant;
  gpu_program program;
} known_program;

struct hl_gpu {
  hl_context *context;
  void *library;
  gpu_device device;
  const char *cache_folder;
  gpu_buffer buffers[BUFFERS];
  uint64_t version, tables_version, sky_version; /* versions of the voxels, of the tables and of the sky's
                                                  * cells on the device; 0 if there are none */
  known_program programs[MOST_VARIANTS];
  int program_count, launches;
  int32_t brick_count[3];
  bool has_distances; /* whether the distances of bricks have been found; if not, BUFFER_DISTANCES tells which
                       * bricks are relevant */
};

#endif
