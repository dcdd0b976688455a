/* gpu/gpu_state.h - defines the data of an open device. */
#ifndef HL_GPU_GPU_STATE_H
#define HL_GPU_GPU_STATE_H

#include "gpu/gpu.h"

enum { MOST_VARIANTS = 64 };

/* The kernels of a program. */
enum {
  KERNEL_FILL,
  KERNEL_TRY,
  KERNEL_DISTANCES,
  KERNEL_LIGHT,
  KERNEL_FIND,
  KERNEL_SHADE,
  KERNEL_COMPOSITE,
  KERNEL_PASSES, /* the first of the kernels of passes, which exist only in some variants */
  KERNELS = KERNEL_PASSES + 4
};
_Static_assert(KERNELS <= (int)GPU_KERNELS, "a program holds all kernels of a variant");

/* The kernels of the passes of soft lights, of lights that are convolved by the paper's method, and of
 * sub-lights. */
enum { KERNEL_ROWS = KERNEL_PASSES, KERNEL_FIELDS, KERNEL_ABSORBED, KERNEL_REFILL };
enum { KERNEL_BELOW = KERNEL_PASSES, KERNEL_WANTED, KERNEL_CONVOLVE_ROWS, KERNEL_CONVOLVE_COLUMNS };
enum { KERNEL_HALVES = KERNEL_PASSES, KERNEL_SUBLIGHTS, KERNEL_DARK, KERNEL_REACHED };

/* The two lines of launches. LINE_AHEAD finds the samples of a run, and composites the run's slabs into the
 * lights' buffers. LINE_PICTURE lights the samples and composites them into the picture. */
enum { LINE_PICTURE, LINE_AHEAD };

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
  BUFFER_SUBLIGHTS,
  BUFFER_PLACES,
  BUFFER_MAPS,
  BUFFER_OF_SUBLIGHTS,
  BUFFER_HALVES,
  BUFFER_SUBLIGHT_MARKS,
  BUFFER_PHASES,
  BUFFER_TEXTURES,
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
  int volume_count;                                             /* number of volumes on the device */
  uint64_t version[PLAN_VOLUMES], tables_version[PLAN_VOLUMES]; /* versions of the volumes' voxels and tables
                                                                 * on the device; 0 if there are none */
  uint64_t sky_version; /* version of the sky's cells on the device; 0 if there are none */
  known_program programs[MOST_VARIANTS];
  int program_count, launches;
  int32_t brick_count[PLAN_VOLUMES][3];
  bool has_distances; /* whether the distances of bricks have been found; if not, BUFFER_DISTANCES tells which
                       * bricks are relevant */
};

/* ---- memory (gpu_volume.c) ---- */

/* Makes room for a number of bytes in a buffer. If the buffer has to grow, its content is lost. */
bool hl_gpu_reserve(hl_gpu *gpu, enum buffer_use use, size_t bytes);
bool hl_gpu_upload(hl_gpu *gpu, enum buffer_use use, size_t offset, const void *from, size_t bytes);
bool hl_gpu_reserve_and_upload(hl_gpu *gpu, enum buffer_use use, const void *from, size_t bytes);

/* ---- programs and their launches (gpu_program.c) ---- */

/* The program of a variant, compiled when it is first asked for. Returns null after a failure. */
const gpu_program *hl_gpu_program_of(hl_gpu *gpu, const plan_variant *variant);
gpu_argument hl_gpu_memory(const hl_gpu *gpu, enum buffer_use use);
gpu_argument hl_gpu_number(int value);
gpu_argument hl_gpu_number_of_float(float value);
/* The number of groups that hold a number of members. */
uint32_t hl_gpu_groups(size_t members);
bool hl_gpu_launch(hl_gpu *gpu, const gpu_program *program, int kernel, int line, uint32_t groups,
                   const gpu_argument *arguments, int count);

/* ---- passes over the buffers of lights (gpu_passes.c) ---- */

bool hl_gpu_upload_passes(hl_gpu *gpu, const gpu_passes *passes);
/* Launches the passes from number `first` to number end - 1. */
bool hl_gpu_launch_passes(hl_gpu *gpu, const gpu_program *program, const gpu_passes *passes, size_t first,
                          size_t end);

#endif
