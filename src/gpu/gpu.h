/* gpu/gpu.h - declares the back end for GPUs: a device that keeps a volume, runs the sweeps of a frame and
 * gives their pixels.
 *
 * The steps of a frame are: hl_gpu_prepare() copies the volume and its tables to the device, unless the
 * device has them already; hl_gpu_run() starts one sweep; hl_gpu_read() waits for the sweep's pixels. A
 * function that fails returns false, and leaves a line of text that hl_gpu_problem() returns. After a failure
 * the device is closed, and the processors make the frame. */
#ifndef HL_GPU_GPU_H
#define HL_GPU_GPU_H

#include "core/memory.h"
#include "gpu/device_sweep.h"
#include "gpu/driver.h"

typedef struct hl_gpu hl_gpu;

/* Calls `found` for each device of the system, until `found` returns false. driver: name of the driver whose
 * devices are listed; if null, the devices of all drivers are listed. problem: [GPU_PROBLEM_BYTES]; says why
 * a driver offers no device. */
typedef bool gpu_found(void *data, const gpu_driver *driver, void *library, int index,
                       const gpu_device_info *info);
void hl_gpu_find(const char *driver, gpu_found *found, void *data, char *problem);

/* Opens a device. wanted: "gpu" or "auto" mean the first device that is no processor; "cuda" or "opencl" mean
 * the first device of this driver; any other text means the first device with this text in its name; upper
 * and lower case are the same. cache_folder: folder of compiled kernels; borrowed; null if compiled kernels
 * are not kept. Returns null after a failure, and `problem`, [GPU_PROBLEM_BYTES], says why. */
hl_gpu *hl_gpu_open(hl_context *context, const char *wanted, const char *cache_folder, char *problem);
void hl_gpu_close(hl_gpu *gpu); /* gpu may be null */

const gpu_device *hl_gpu_device(const hl_gpu *gpu);
const char *hl_gpu_problem(const hl_gpu *gpu);

/* The parts of a volume's mask (MASK_BRICKS and so on), borrowed. */
typedef struct gpu_mask {
  const void *part[PLAN_MASK_PARTS]; /* null if there is no such part */
  size_t bytes[PLAN_MASK_PARTS];
} gpu_mask;

/* The beginning of a part of a mask on the device, in bytes from the first part; a multiple of 16. */
size_t hl_gpu_mask_begin(const gpu_mask *mask, int part);

/* A volume as the renderer has prepared it; borrowed. */
typedef struct gpu_volume {
  uint64_t version, tables_version; /* version of the voxels, and version of everything that follows from the
                                     * transfer function */
  const void *voxels;               /* [z][y][x], rows packed; or, for a field in bricks, the coefficients
                                     * [slots][z][y][x] */
  /* A function that copies a row of `pages`. It is set for a volume whose voxels are not in memory, else
   * null. */
  void (*load_row)(const void *pages, size_t y, size_t z, void *row);
  const void *pages;
  const plan_brick *directory;  /* [z][y][x]; the directory of the field in bricks; null if the volume is not
                                 * a field in bricks */
  const size_t *directory_size; /* number of entries along x, y, z */
  const unsigned char *colors;  /* [z][y][x][4]; null if the voxels have no colours */
  size_t color_bytes;
  size_t slots, brick_width; /* slots: number of bricks that have coefficients; brick_width: number of a
                              * brick's coefficients along an axis */
  int storage;               /* as in plan_variant */
  const int32_t *dimension, *brick_count;
  const unsigned char *relevant;           /* [bricks] */
  const uint64_t *cell_bits;               /* [bricks]; null if there are no bits */
  const float *sums, *color, *shown;       /* [PLAN_TABLE_ROWS][4] */
  const float *outside, *bent, *steepness; /* [PLAN_TABLE_ROWS]; bent and steepness are null if there is no
                                            * such table */
  gpu_mask mask;                           /* the mask; tables_version changes with it */
  const float *plane_sums, *plane_color;   /* [PLAN_PLANE_FLOATS]; null if the function is not one of two
                                            * numbers */
} gpu_volume;

/* The number of bytes of a row of the device's voxels. */
size_t hl_gpu_row_bytes(const gpu_volume *volume);

/* Where a volume's data begin on the device, behind the data of the volumes before it. */
typedef struct gpu_place {
  size_t voxels, colors, mask; /* in bytes, multiples of 16 */
  size_t directory;            /* number of entries */
  size_t bricks;               /* number of bricks */
  size_t tables;               /* number of floats */
} gpu_place;

/* The places of several volumes. volumes: [count]. places: [count + 1]; the last place is the end of all
 * data. */
void hl_gpu_find_places(const gpu_volume *volumes, int count, gpu_place *places);

/* Copies the volumes of a frame to the device. volumes: [count]; at most PLAN_VOLUMES. */
bool hl_gpu_prepare(hl_gpu *gpu, const gpu_volume *volumes, int count);
/* Forgets the volumes on the device: the next volumes count as different volumes, whatever their versions
 * are. */
void hl_gpu_forget(hl_gpu *gpu);

/* Computes the trial's results for some numbers (gpu/kernels/trial.h). numbers: [count][3]; results:
 * [count][result_count]. */
bool hl_gpu_try(hl_gpu *gpu, const float *numbers, uint32_t count, float *results, uint32_t result_count);

/* The cells of the sky's field; borrowed. */
typedef struct gpu_sky {
  uint64_t version;     /* of the cells */
  const int16_t *cells; /* null if there is no sky */
  size_t bytes;
} gpu_sky;

/* Passes over the buffers of lights, one after the other. */
typedef struct gpu_passes {
  const plan_pass *list; /* [count] */
  size_t count;
  const plan_blur *boxes; /* [box_count] */
  size_t box_count;
  const unsigned char *marks; /* [mark_count] */
  size_t mark_count;
} gpu_passes;

/* The sub-lights of all lights; borrowed. */
typedef struct gpu_sublights {
  const plan_sublight *list;         /* [count]; null if there are none */
  const plan_sublight_place *places; /* [sheets][count] */
  const plan_sublight_maps *maps;    /* [runs][count]; runs of LIT_SLABS slabs */
  size_t count, runs;
  size_t pixels, half_floats, marks; /* numbers of pixels of all planes, of floats of the slabs' copies, and
                                      * of marks */
} gpu_sublights;

/* The table of a volume's phase function; borrowed. The tables of the volumes that have one follow each other
 * on the device, in the order of the volumes. */
typedef struct gpu_phases {
  const float *rows[PLAN_LIGHTS]; /* [PLAN_PHASE_COLUMNS] for each light; null for lights without a row */
  const float *caps;              /* [PLAN_PHASE_CAPS][PLAN_PHASE_COLUMNS][2]; null if they are not read */
} gpu_phases;

/* The pixels of an image, or of a blurred level of an image, that a light projects; borrowed. */
typedef struct gpu_pixels {
  const float *pixels; /* [floats] */
  size_t floats;
} gpu_pixels;

/* The images that lights project; borrowed. */
typedef struct gpu_textures {
  const plan_texture *list; /* [lights]; null if no light projects an image */
  const gpu_pixels *parts;  /* [part_count]; the parts follow each other on the device */
  size_t part_count;
} gpu_textures;

/* A sweep as plain data; borrowed until hl_gpu_read(). */
typedef struct gpu_sweep gpu_sweep;
struct gpu_sweep {
  const device_sweep *plan;
  const plan_volume *volumes; /* [variant.volumes] */
  const plan_bounds *bounds;  /* [1 + lights][variant.volumes] */
  plan_variant variant;
  const plan_rays *rays; /* [ray_sets][sheets] (gpu/kernels/slabs.h) */
  size_t ray_sets;
  const plan_cut *cuts; /* [cut_count]; the cuts of all views, the eye's first; null if there is none */
  size_t cut_count;
  const int32_t *shown_from; /* [tiles][16 blocks]; the first visible slab of each block, if slabs are
                              * composited from back to front; null stands for slab 1 for all blocks */
  gpu_sky sky;
  gpu_sublights sublights;
  gpu_phases phases[PLAN_VOLUMES]; /* [variant.volumes] */
  gpu_textures textures;
  const float *shown_values; /* [PLAN_TABLE_ROWS][4]; the table of shown values of a maximum projection; null
                              * for other pictures */
  size_t plane_floats;       /* number of floats of the planes of all lights together */
  int slabs;                 /* the greatest number of slabs of a run */
  /* The next members are for lights whose buffers change as a whole at some sheets: */
  const unsigned char *ends;       /* [sheets]; not 0 for these sheets; null if there are no such lights */
  size_t field_pixels, row_floats; /* number of pixels of the fields of all soft lights; number of pixels of
                                    * the rows of a blur, or of the planes between the two directions of
                                    * convolutions */
  /* If all passes are known before the sweep: the passes, and the first pass of each sheet, [sheets + 1]. The
   * passes of sheet 0 come before the first run. The passes of such a sheet come as soon as the light has
   * passed the slabs before the sheet. Null if the next function makes the passes. */
  const gpu_passes *passes;
  const int32_t *first_pass;
  /* The function that is called at such a sheet, after the slabs before it. It makes the passes
   * (hl_gpu_pass()) that change the lights' buffers. data: of_advance. */
  bool (*advance)(void *data, hl_gpu *gpu, const gpu_sweep *sweep, int sheet);
  void *of_advance;
};

bool hl_gpu_pass(hl_gpu *gpu, const gpu_sweep *sweep, const gpu_passes *passes);
/* Waits for the slabs that were started so far. Finds, for each tile of a light, the last chunk whose slabs
 * absorbed light in the tile; 0 if there is no chunk. chunks: [light->tiles]. */
bool hl_gpu_touched(hl_gpu *gpu, const plan_light *light, int32_t *chunks);

/* The time and the work that one sweep took on a device. */
typedef struct gpu_times {
  double milliseconds; /* time on the device, without copies */
  int launches;
  uint64_t samples; /* number of pixels composited, summed over slabs */
} gpu_times;

bool hl_gpu_run(hl_gpu *gpu, const gpu_sweep *sweep);
/* Waits for the sweep's pixels, and copies them to `pixels`, [tiles][16 blocks][R G B A][16] floats. In a
 * maximum projection the first of the four numbers is the greatest value, as in render/slab.h. times:
 * receives the times of the sweep in addition to the times before. */
bool hl_gpu_read(hl_gpu *gpu, const gpu_sweep *sweep, float *pixels, gpu_times *times);

#endif
