/* gpu/gpu_run.c - copies volumes to an open device, and runs sweeps on it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gpu/gpu_state.h"
#include "gpu/program_cache.h"

extern const char hl_kernel_text[]; /* made by kernels/text.py */

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
static const char *const common_kernels[KERNEL_PASSES] = {
    "fill_floats",  "try_arithmetic", "spread_distances", "run_light",
    "find_samples", "shade_samples",  "composite_samples"};

/* The kernels of the passes of soft lights, and of lights that are convolved by the paper's method. */
enum { KERNEL_ROWS = KERNEL_PASSES, KERNEL_FIELDS, KERNEL_ABSORBED, KERNEL_REFILL };
static const char *const soft_kernels[] = {"pass_rows", "pass_fields", "pass_absorbed", "pass_refill"};
enum { KERNEL_BELOW = KERNEL_PASSES, KERNEL_WANTED, KERNEL_CONVOLVE_ROWS, KERNEL_CONVOLVE_COLUMNS };
static const char *const paper_kernels[] = {"pass_below", "pass_wanted", "convolve_rows", "convolve_columns"};

enum { VARIANT_DEFINES = 20, SAMPLE_COUNTERS = 256, TILE_SIDE = 16 };

/* ---- memory ---- */

/* Makes room for a number of bytes in a buffer. If the buffer has to grow, its content is lost. */
static bool reserve(hl_gpu *gpu, enum buffer_use use, size_t bytes) {
  gpu_buffer *buffer = &gpu->buffers[use];
  if (bytes < 64) bytes = 64;
  if (buffer->bytes >= bytes) return true;
  gpu->device.driver->release(&gpu->device, buffer);
  if (use >= BUFFER_PIXELS || use == BUFFER_RAYS)
    bytes += bytes / 4; /* a quarter more is reserved, because frames need slightly different sizes while a
                         * camera turns */
  return gpu->device.driver->allocate(&gpu->device, bytes, buffer);
}

static bool upload(hl_gpu *gpu, enum buffer_use use, size_t offset, const void *from, size_t bytes) {
  return bytes == 0 || gpu->device.driver->upload(&gpu->device, &gpu->buffers[use], offset, from, bytes);
}

static bool reserve_and_upload(hl_gpu *gpu, enum buffer_use use, const void *from, size_t bytes) {
  return reserve(gpu, use, bytes) && upload(gpu, use, 0, from, bytes);
}

static size_t storage_bytes(int storage) { return storage == 0 ? 1 : storage == 1 ? 2 : 4; }

/* Rows begin at multiples of sixteen bytes, because kernels load aligned words. The multiple is odd:
 * otherwise neighbouring rows of a volume with rows of 256 or 2048 bytes would share a cache's banks and
 * sets. */
size_t hl_gpu_row_bytes(const gpu_volume *volume) {
  if (volume->directory != NULL) return volume->brick_width * sizeof(float);
  return ((size_t)volume->dimension[0] * storage_bytes(volume->storage) + 15) / 16 * 16 | 16;
}

/* READ_BEHIND: the number of bytes after the last voxel that kernels may read. */
enum { READ_BEHIND = 16, STAGE_BYTES = 1 << 20 };

/* Copies a row of the volume's voxels. number: the index of the row among the rows of all slices. */
static void load_row(const gpu_volume *volume, size_t number, size_t packed, unsigned char *row) {
  const size_t rows = (size_t)volume->dimension[1];
  if (volume->load_row != NULL) volume->load_row(volume->pages, number % rows, number / rows, row);
  else memcpy(row, (const unsigned char *)volume->voxels + number * packed, packed);
}

static bool upload_voxels(hl_gpu *gpu, const gpu_volume *volume) {
  const size_t packed = (size_t)volume->dimension[0] * storage_bytes(volume->storage),
               row = hl_gpu_row_bytes(volume),
               rows = (size_t)volume->dimension[1] * (size_t)volume->dimension[2];
  if (!reserve(gpu, BUFFER_VOXELS, rows * row + READ_BEHIND)) return false;
  if (packed == row && volume->load_row == NULL)
    return upload(gpu, BUFFER_VOXELS, 0, volume->voxels, rows * row);
  const size_t at_once = STAGE_BYTES / row + 1;
  unsigned char *stage = hl_allocate_zeroed(gpu->context, at_once, row);
  if (stage == NULL)
    return snprintf(gpu->device.problem, sizeof gpu->device.problem, "no memory is left"), false;
  bool done = true;
  for (size_t first = 0; first < rows && done; first += at_once) {
    size_t count = rows - first < at_once ? rows - first : at_once;
    for (size_t i = 0; i < count; i++) load_row(volume, first + i, packed, stage + i * row);
    done = upload(gpu, BUFFER_VOXELS, first * row, stage, count * row);
  }
  hl_release(gpu->context, stage);
  return done;
}

/* Copies the coefficients and the directory of a field in bricks to the device. */
static bool upload_bricks(hl_gpu *gpu, const gpu_volume *volume) {
  const size_t width = hl_gpu_row_bytes(volume) / sizeof(float),
               bytes = volume->slots * width * width * width * sizeof(float);
  size_t entries = 1;
  for (int axis = 0; axis < 3; axis++) entries *= volume->directory_size[axis];
  return reserve(gpu, BUFFER_VOXELS, bytes) && upload(gpu, BUFFER_VOXELS, 0, volume->voxels, bytes) &&
         reserve_and_upload(gpu, BUFFER_DIRECTORY, volume->directory, entries * sizeof *volume->directory);
}

static bool upload_colors(hl_gpu *gpu, const gpu_volume *volume) {
  if (volume->colors == NULL) return reserve(gpu, BUFFER_COLORS, 0);
  return reserve_and_upload(gpu, BUFFER_COLORS, volume->colors, volume->color_bytes);
}

size_t hl_gpu_mask_begin(const gpu_mask *mask, int part) {
  size_t begin = 0;
  for (int before = 0; before < part; before++) begin += (mask->bytes[before] + 15) / 16 * 16;
  return begin;
}

static bool upload_mask(hl_gpu *gpu, const gpu_mask *mask) {
  bool done = reserve(gpu, BUFFER_MASK, hl_gpu_mask_begin(mask, PLAN_MASK_PARTS));
  for (int part = 0; part < PLAN_MASK_PARTS && done; part++)
    done = upload(gpu, BUFFER_MASK, hl_gpu_mask_begin(mask, part), mask->part[part], mask->bytes[part]);
  return done;
}

static bool upload_tables(hl_gpu *gpu, const gpu_volume *volume) {
  size_t bricks = (size_t)volume->brick_count[0] * (size_t)volume->brick_count[1] *
                  (size_t)volume->brick_count[2];
  const size_t column = PLAN_TABLE_ROWS * sizeof(float);
  const size_t tables = PLAN_TABLE_FLOATS * sizeof(float), plane = PLAN_PLANE_FLOATS * sizeof(float);
  bool done = reserve(gpu, BUFFER_TABLES, tables + (volume->plane_sums != NULL ? 2 * plane : 0)) &&
              upload(gpu, BUFFER_TABLES, 0, volume->sums, 4 * column) &&
              upload(gpu, BUFFER_TABLES, 4 * column, volume->color, 4 * column) &&
              upload(gpu, BUFFER_TABLES, 8 * column, volume->shown, 4 * column);
  done = done && upload(gpu, BUFFER_TABLES, 12 * column, volume->outside, column);
  if (done && volume->bent != NULL) done = upload(gpu, BUFFER_TABLES, 13 * column, volume->bent, column);
  if (done && volume->steepness != NULL)
    done = upload(gpu, BUFFER_TABLES, 14 * column, volume->steepness, column);
  if (done && volume->plane_sums != NULL)
    done = upload(gpu, BUFFER_TABLES, tables, volume->plane_sums, plane) &&
           upload(gpu, BUFFER_TABLES, tables + plane, volume->plane_color, plane);
  if (done)
    done = reserve_and_upload(gpu, BUFFER_DISTANCES, volume->relevant, bricks) &&
           reserve(gpu, BUFFER_DISTANCES_MADE, bricks);
  memcpy(gpu->brick_count, volume->brick_count, sizeof gpu->brick_count);
  gpu->has_distances = false;
  if (done && volume->cell_bits != NULL)
    done = reserve_and_upload(gpu, BUFFER_CELL_BITS, volume->cell_bits, bricks * sizeof *volume->cell_bits);
  return done && reserve(gpu, BUFFER_CELL_BITS, 64) && reserve(gpu, BUFFER_DIRECTORY, 64);
}

bool hl_gpu_prepare(hl_gpu *gpu, const gpu_volume *volume) {
  if (gpu->version != volume->version) {
    gpu->version = gpu->tables_version = 0;
    if (!(volume->directory != NULL ? upload_bricks(gpu, volume) : upload_voxels(gpu, volume)) ||
        !upload_colors(gpu, volume))
      return false;
    gpu->version = volume->version;
  }
  if (gpu->tables_version != volume->tables_version) {
    gpu->tables_version = 0;
    if (!upload_tables(gpu, volume) || !upload_mask(gpu, &volume->mask)) return false;
    gpu->tables_version = volume->tables_version;
  }
  return true;
}

void hl_gpu_forget(hl_gpu *gpu) { gpu->version = gpu->tables_version = gpu->sky_version = 0; }

/* ---- programs ---- */

static void define_variant(const plan_variant *v, char defines[VARIANT_DEFINES][40]) {
  const struct {
    const char *name;
    int value;
  } all[VARIANT_DEFINES] = {
      {"STORAGE", v->storage},   {"BSPLINE", v->bspline}, {"EYE_PERSPECTIVE", v->eye_perspective},
      {"PHONG", v->phong},       {"LIT", v->lit},         {"SHADOWED", v->shadowed},
      {"OUTSIDE", v->outside},   {"BOXED", v->boxed},     {"BACK_TO_FRONT", v->back_to_front},
      {"CHANNELS", v->channels}, {"CUTS", v->cuts},       {"BRICKS", v->bricks},
      {"STEEP", v->steep},       {"MASKED", v->masked},   {"PLANE", v->plane},
      {"COLORED", v->colored},   {"SOFT", v->soft},       {"SKY", v->sky},
      {"MAXIMUM", v->maximum},   {"PAPER", v->paper}};
  for (int i = 0; i < VARIANT_DEFINES; i++)
    snprintf(defines[i], sizeof defines[i], "%s=%d", all[i].name, all[i].value);
}

/* Finds the names of a variant's kernels. Returns the number of kernels. */
static int names_of_kernels(const plan_variant *variant, const char *names[KERNELS]) {
  memcpy(names, common_kernels, sizeof common_kernels);
  if (!variant->soft && !variant->paper) return KERNEL_PASSES;
  memcpy(names + KERNEL_PASSES, variant->soft ? soft_kernels : paper_kernels, sizeof soft_kernels);
  return KERNELS;
}

static bool compile(hl_gpu *gpu, const plan_variant *variant, gpu_program *program) {
  const gpu_driver *driver = gpu->device.driver;
  const char *names[KERNELS];
  const int kernels = names_of_kernels(variant, names);
  char words[VARIANT_DEFINES][40], key[PROGRAM_KEY_BYTES];
  const char *defines[VARIANT_DEFINES];
  gpu_binary binary = {0};
  define_variant(variant, words);
  int length = snprintf(key, sizeof key, "%s %s, %s, %016llx", driver->name, gpu->device.info.name,
                        gpu->device.info.version, (unsigned long long)hl_program_number(hl_kernel_text));
  for (int i = 0; i < VARIANT_DEFINES; i++) {
    defines[i] = words[i];
    length += snprintf(key + length, sizeof key - (size_t)length, " %s", words[i]);
  }
  bool loaded = hl_program_stored(gpu->cache_folder, key, &binary) &&
                driver->load_program(&gpu->device, &binary, names, kernels, program);
  if (!loaded) {
    free(binary.bytes);
    binary = (gpu_binary){0};
    if (!driver->compile(&gpu->device, hl_kernel_text, defines, VARIANT_DEFINES, &binary)) return false;
    hl_program_store(gpu->cache_folder, key, &binary);
    loaded = driver->load_program(&gpu->device, &binary, names, kernels, program);
  }
  free(binary.bytes);
  return loaded;
}

static const gpu_program *program_of(hl_gpu *gpu, const plan_variant *variant) {
  for (int i = 0; i < gpu->program_count; i++)
    if (memcmp(&gpu->programs[i].variant, variant, sizeof *variant) == 0) return &gpu->programs[i].program;
  if (gpu->program_count == MOST_VARIANTS)
    gpu->device.driver->release_program(&gpu->device, &gpu->programs[--gpu->program_count].program);
  known_program *next = &gpu->programs[gpu->program_count];
  if (!compile(gpu, variant, &next->program)) return NULL;
  next->variant = *variant;
  gpu->program_count++;
  return &next->program;
}

/* ---- a sweep ---- */

static gpu_argument memory(const hl_gpu *gpu, enum buffer_use use) {
  return (gpu_argument){.buffer = &gpu->buffers[use]};
}
static gpu_argument number(int value) { return (gpu_argument){.value = (uint32_t)value}; }
static gpu_argument number_of_float(float value) {
  gpu_argument argument = {0};
  memcpy(&argument.value, &value, sizeof value);
  return argument;
}

static bool launch(hl_gpu *gpu, const gpu_program *program, int kernel, int line, uint32_t groups,
                   const gpu_argument *arguments, int count) {
  gpu->launches++;
  return gpu->device.driver->launch(&gpu->device, program, kernel, line, groups, arguments, count);
}

static uint32_t groups_of(size_t members) { return (uint32_t)((members + GPU_GROUP - 1) / GPU_GROUP); }

/* Sets the first `floats` floats of a buffer to a value. floats: a multiple of four. */
static bool fill(hl_gpu *gpu, const gpu_program *program, enum buffer_use use, size_t floats, float value) {
  uint32_t fours = (uint32_t)(floats / 4);
  const gpu_argument arguments[] = {memory(gpu, use), {.value = fours}, number_of_float(value)};
  return fours == 0 || launch(gpu, program, KERNEL_FILL, 0, groups_of(fours), arguments, 3);
}

/* Finds the distances of bricks, by three passes, one along each axis. */
static bool find_distances(hl_gpu *gpu, const gpu_program *program) {
  size_t bricks = 1;
  bool done = true;
  for (int axis = 0; axis < 3; axis++) bricks *= (size_t)gpu->brick_count[axis];
  for (int axis = 0; axis < 3 && done && !gpu->has_distances; axis++) {
    enum buffer_use from = axis == 1 ? BUFFER_DISTANCES_MADE : BUFFER_DISTANCES,
                    to = axis == 1 ? BUFFER_DISTANCES : BUFFER_DISTANCES_MADE;
    const gpu_argument arguments[] = {memory(gpu, from),
                                      memory(gpu, to),
                                      number(gpu->brick_count[0]),
                                      number(gpu->brick_count[1]),
                                      number(gpu->brick_count[2]),
                                      number(axis),
                                      number(axis == 0)};
    done = launch(gpu, program, KERNEL_DISTANCES, 0, groups_of(bricks), arguments, 7);
  }
  gpu->has_distances = done;
  return done;
}

static size_t light_floats(const gpu_sweep *sweep) {
  return (size_t)sweep->plan->light_tiles * 256 * (size_t)sweep->variant.channels *
         (size_t)(1 + sweep->variant.outside + sweep->variant.soft);
}

/* The number of counters of a sweep: counters of samples, and a counter for the list of each run. It is
 * rounded up to a multiple of four. */
static size_t counters_of(const gpu_sweep *sweep) {
  size_t runs = (size_t)(sweep->plan->sheets / sweep->slabs);
  for (int sheet = 0; sheet < sweep->plan->sheets && sweep->ends != NULL; sheet++)
    runs += sweep->ends[sheet] != 0;
  return SAMPLE_COUNTERS + (runs + 4) / 4 * 4;
}

/* Numbers of floats of the buffers of soft lights, rounded up to multiples of four. */
static size_t soft_floats(const gpu_sweep *sweep) {
  return sweep->variant.soft ? (size_t)sweep->plan->light_tiles * 512 * (size_t)sweep->variant.channels : 0;
}
/* Lights that are convolved have three numbers for each tile (gpu/kernels/paper.h). */
static size_t touched_floats(const gpu_sweep *sweep) {
  const size_t numbers = sweep->variant.soft ? 1 : sweep->variant.paper ? 3 : 0;
  return (numbers * (size_t)sweep->plan->light_tiles + 3) / 4 * 4;
}
static size_t field_floats(const gpu_sweep *sweep) { return (sweep->field_pixels + 7) / 8 * 4; }

static bool make_soft_room(hl_gpu *gpu, const gpu_sweep *sweep) {
  return reserve(gpu, BUFFER_SOFT, soft_floats(sweep) * sizeof(float)) &&
         reserve(gpu, BUFFER_TOUCHED, touched_floats(sweep) * sizeof(float)) &&
         reserve(gpu, BUFFER_FIELDS, field_floats(sweep) * sizeof(float)) &&
         reserve(gpu, BUFFER_ROWS, sweep->row_floats * sizeof(float));
}

static bool reset_soft(hl_gpu *gpu, const gpu_sweep *sweep, const gpu_program *program) {
  return fill(gpu, program, BUFFER_SOFT, soft_floats(sweep), 0) &&
         fill(gpu, program, BUFFER_TOUCHED, touched_floats(sweep), 0) &&
         fill(gpu, program, BUFFER_FIELDS, field_floats(sweep), 0) &&
         fill(gpu, program, BUFFER_ROWS, sweep->variant.paper ? sweep->row_floats : 0, 1);
}

/* Brings the cells of the sky's field to the device, unless the device has them already. */
static bool prepare_sky(hl_gpu *gpu, const gpu_sky *sky) {
  if (sky->cells == NULL || sky->version == gpu->sky_version) return reserve(gpu, BUFFER_SKY, 0);
  gpu->sky_version = 0;
  if (!reserve_and_upload(gpu, BUFFER_SKY, sky->cells, sky->bytes)) return false;
  gpu->sky_version = sky->version;
  return true;
}

static bool upload_passes(hl_gpu *gpu, const gpu_passes *passes) {
  return reserve_and_upload(gpu, BUFFER_PASSES, passes->list, passes->count * sizeof *passes->list) &&
         reserve_and_upload(gpu, BUFFER_BOXES, passes->boxes, passes->box_count * sizeof *passes->boxes) &&
         reserve_and_upload(gpu, BUFFER_MARKS, passes->marks, passes->mark_count);
}

static bool make_room(hl_gpu *gpu, const gpu_sweep *sweep) {
  const device_sweep *plan = sweep->plan;
  const size_t views = 2 + 2 * (size_t)plan->light_count, tiles = (size_t)plan->tiles,
               slots = sweep->variant.maximum ? 0 : 2 * tiles * 256 * (size_t)sweep->slabs;
  bool done = reserve_and_upload(gpu, BUFFER_PLAN, plan, sizeof *plan) &&
              reserve_and_upload(gpu, BUFFER_RAYS, sweep->rays,
                                 views * (size_t)plan->sheets * sizeof *sweep->rays) &&
              reserve(gpu, BUFFER_PIXELS, tiles * 1024 * sizeof(float)) &&
              reserve(gpu, BUFFER_PLANES, sweep->plane_floats * sizeof(float)) &&
              reserve(gpu, BUFFER_LIGHT, light_floats(sweep) * sizeof(float)) &&
              reserve(gpu, BUFFER_CHANGED, (size_t)plan->light_tiles * 256 * sizeof(int32_t)) &&
              reserve(gpu, BUFFER_SHOWN_FROM, tiles * 16 * sizeof(int32_t)) &&
              reserve(gpu, BUFFER_COUNTS, counters_of(sweep) * sizeof(uint32_t)) &&
              reserve(gpu, BUFFER_SLOTS, slots * 4 * sizeof(float)) &&
              reserve(gpu, BUFFER_LIST, slots * sizeof(uint32_t)) &&
              reserve(gpu, BUFFER_MASKS, 2 * tiles * 256 * sizeof(uint32_t)) &&
              reserve(gpu, BUFFER_CUTS, sweep->cut_count * sizeof *sweep->cuts) &&
              make_soft_room(gpu, sweep) && prepare_sky(gpu, &sweep->sky) &&
              (sweep->passes == NULL || upload_passes(gpu, sweep->passes));
  if (done && sweep->shown_from != NULL)
    done = upload(gpu, BUFFER_SHOWN_FROM, 0, sweep->shown_from, tiles * 16 * sizeof(int32_t));
  if (done && sweep->cut_count > 0)
    done = upload(gpu, BUFFER_CUTS, 0, sweep->cuts, sweep->cut_count * sizeof *sweep->cuts);
  if (done && sweep->variant.maximum)
    done = upload(gpu, BUFFER_TABLES, PLAN_SHOWN_VALUES * sizeof(float), sweep->shown_values,
                  (PLAN_TABLE_FLOATS - PLAN_SHOWN_VALUES) * sizeof(float));
  return done;
}

/* Starts a sweep: sets the lights' buffers to full light, the picture to empty, and the counters to 0. The
 * numbers of an empty maximum projection are -1. */
static bool reset(hl_gpu *gpu, const gpu_sweep *sweep, const gpu_program *program) {
  const device_sweep *plan = sweep->plan;
  bool done = fill(gpu, program, BUFFER_PIXELS, (size_t)plan->tiles * 1024,
                   sweep->variant.maximum ? -1 : 0) &&
              fill(gpu, program, BUFFER_COUNTS, counters_of(sweep), 0) &&
              fill(gpu, program, BUFFER_PLANES, sweep->plane_floats, 1) &&
              fill(gpu, program, BUFFER_LIGHT, light_floats(sweep), 1) &&
              fill(gpu, program, BUFFER_CHANGED, (size_t)plan->light_tiles * 256, 0) &&
              reset_soft(gpu, sweep, program);
  if (done && sweep->shown_from == NULL)
    done = fill(gpu, program, BUFFER_SHOWN_FROM, (size_t)plan->tiles * 16, 0);
  return done;
}

/* The two lines of launches. LINE_AHEAD finds the samples of a run, and composites the run's slabs into the
 * lights' buffers. LINE_PICTURE lights the samples and composites them into the picture. */
enum { LINE_PICTURE, LINE_AHEAD };

/* The greatest number of members that light the samples of a run. This number is enough to fill any
 * device. */
enum { SHADING_MEMBERS = 1 << 18 };

/* ---- passes over the buffers of lights ---- */

/* The kernel of each kind of pass. */
static const int kernels_of_passes[] = {[PASS_ADD] = KERNEL_FIELDS,
                                        [PASS_HALF] = KERNEL_FIELDS,
                                        [PASS_DOUBLE] = KERNEL_FIELDS,
                                        [PASS_BLUR] = KERNEL_FIELDS,
                                        [PASS_SPLIT] = KERNEL_FIELDS,
                                        [PASS_ABSORB] = KERNEL_ABSORBED,
                                        [PASS_REFILL] = KERNEL_REFILL,
                                        [PASS_BELOW] = KERNEL_BELOW,
                                        [PASS_WANTED] = KERNEL_WANTED,
                                        [PASS_ROWS] = KERNEL_CONVOLVE_ROWS,
                                        [PASS_COLUMNS] = KERNEL_CONVOLVE_COLUMNS};

/* The number of members that make a pass: one for each pixel of the output, or for each tile. */
static size_t members_of_pass(const plan_pass *pass) {
  const size_t tiles = (size_t)pass->tiles_x * (size_t)pass->tiles_y;
  return pass->kind == PASS_WANTED ? tiles : tiles * 256;
}

static bool launch_pass(hl_gpu *gpu, const gpu_program *program, int kernel, size_t members, int index) {
  const gpu_argument arguments[] = {
      memory(gpu, BUFFER_PLAN),    memory(gpu, BUFFER_PASSES),  memory(gpu, BUFFER_BOXES),
      memory(gpu, BUFFER_MARKS),   memory(gpu, BUFFER_FIELDS),  memory(gpu, BUFFER_ROWS),
      memory(gpu, BUFFER_PLANES),  memory(gpu, BUFFER_LIGHT),   memory(gpu, BUFFER_SOFT),
      memory(gpu, BUFFER_TOUCHED), memory(gpu, BUFFER_CHANGED), number(index)};
  return launch(gpu, program, kernel, LINE_AHEAD, groups_of(members), arguments,
                (int)(sizeof arguments / sizeof *arguments));
}

/* Launches the passes from number `first` to number end - 1. */
static bool launch_passes(hl_gpu *gpu, const gpu_program *program, const gpu_passes *passes, size_t first,
                          size_t end) {
  bool done = true;
  for (size_t i = first; i < end && done; i++) {
    const plan_pass *pass = &passes->list[i];
    if (pass->kind == PASS_BLUR)
      done = launch_pass(gpu, program, KERNEL_ROWS,
                         members_of_pass(pass) + (size_t)pass->tiles_x * TILE_SIDE * 2 * PASS_MARGIN, (int)i);
    done = done && launch_pass(gpu, program, kernels_of_passes[pass->kind], members_of_pass(pass), (int)i);
  }
  return done;
}

bool hl_gpu_pass(hl_gpu *gpu, const gpu_sweep *sweep, const gpu_passes *passes) {
  const gpu_program *program = program_of(gpu, &sweep->variant);
  return program != NULL && upload_passes(gpu, passes) &&
         gpu->device.driver->follow(&gpu->device, LINE_AHEAD, LINE_PICTURE) &&
         launch_passes(gpu, program, passes, 0, passes->count);
}

bool hl_gpu_touched(hl_gpu *gpu, const plan_light *light, int32_t *chunks) {
  return gpu->device.driver->download(&gpu->device, &gpu->buffers[BUFFER_TOUCHED],
                                      (size_t)light->first_tile * sizeof *chunks, chunks,
                                      (size_t)light->tiles * sizeof *chunks);
}

/* ---- runs of slabs ---- */

/* A run of slabs. */
typedef struct device_run {
  int first, end, number;
} device_run;

static bool launch_kernel(hl_gpu *gpu, const gpu_program *program, int kernel, size_t members,
                          device_run run) {
  const gpu_argument arguments[] = {memory(gpu, BUFFER_PLAN),
                                    memory(gpu, BUFFER_RAYS),
                                    memory(gpu, BUFFER_VOXELS),
                                    memory(gpu, BUFFER_DISTANCES_MADE),
                                    memory(gpu, BUFFER_CELL_BITS),
                                    memory(gpu, BUFFER_TABLES),
                                    memory(gpu, BUFFER_PIXELS),
                                    memory(gpu, BUFFER_PLANES),
                                    memory(gpu, BUFFER_LIGHT),
                                    memory(gpu, BUFFER_CHANGED),
                                    memory(gpu, BUFFER_SHOWN_FROM),
                                    memory(gpu, BUFFER_COUNTS),
                                    memory(gpu, BUFFER_SLOTS),
                                    memory(gpu, BUFFER_LIST),
                                    memory(gpu, BUFFER_MASKS),
                                    memory(gpu, BUFFER_CUTS),
                                    memory(gpu, BUFFER_DIRECTORY),
                                    memory(gpu, BUFFER_COLORS),
                                    memory(gpu, BUFFER_SOFT),
                                    memory(gpu, BUFFER_TOUCHED),
                                    memory(gpu, BUFFER_SKY),
                                    memory(gpu, BUFFER_MASK),
                                    number(run.first),
                                    number(run.end),
                                    number(run.number)};
  return launch(gpu, program, kernel,
                kernel == KERNEL_LIGHT || kernel == KERNEL_FIND ? LINE_AHEAD : LINE_PICTURE,
                groups_of(members), arguments, (int)(sizeof arguments / sizeof *arguments));
}

/* Lights the samples of a run and composites them. */
static bool launch_shading(hl_gpu *gpu, const gpu_sweep *sweep, const gpu_program *program, device_run run) {
  const size_t pixels = (size_t)sweep->plan->tiles * 256;
  return launch_kernel(gpu, program, KERNEL_SHADE, pixels < SHADING_MEMBERS ? pixels : SHADING_MEMBERS,
                       run) &&
         launch_kernel(gpu, program, KERNEL_COMPOSITE, pixels, run);
}

/* Launches the passes of a sheet that are known before the sweep. */
static bool launch_known(hl_gpu *gpu, const gpu_sweep *sweep, const gpu_program *program, int sheet) {
  return sweep->passes == NULL || launch_passes(gpu, program, sweep->passes, (size_t)sweep->first_pass[sheet],
                                                (size_t)sweep->first_pass[sheet + 1]);
}

/* Launches a run. While the samples of one run are lit, LINE_AHEAD works on the next run. Its work on run r
 * begins when run r - 2 has been lit. It writes planes of the ring and lists that are not read while run r -
 * 1 is lit. LINE_AHEAD may find samples of a pixel that run r - 1 makes opaque; these samples are then lit in
 * vain. */
static bool launch_run(hl_gpu *gpu, const gpu_sweep *sweep, const gpu_program *program, device_run run) {
  const gpu_driver *driver = gpu->device.driver;
  const size_t pixels = (size_t)sweep->plan->tiles * 256,
               light_pixels = (size_t)sweep->plan->light_tiles * 256;
  return (light_pixels == 0 || launch_kernel(gpu, program, KERNEL_LIGHT, light_pixels, run)) &&
         launch_known(gpu, sweep, program, run.end - 1) &&
         launch_kernel(gpu, program, KERNEL_FIND, pixels, run) &&
         driver->follow(&gpu->device, LINE_PICTURE, LINE_AHEAD) &&
         driver->follow(&gpu->device, LINE_AHEAD, LINE_PICTURE) &&
         (sweep->variant.maximum || launch_shading(gpu, sweep, program, run));
}

/* The end of a run that begins with a slab. A run ends at the latest where a soft light's chunk ends. */
static int end_of_run(const gpu_sweep *sweep, int first) {
  int end = first + 1;
  while (end < sweep->plan->sheets && end - first < sweep->slabs &&
         (sweep->ends == NULL || !sweep->ends[end - 1]))
    end++;
  return end;
}

static bool launch_runs(hl_gpu *gpu, const gpu_sweep *sweep, const gpu_program *program) {
  const int sheets = sweep->plan->sheets;
  bool done = gpu->device.driver->follow(&gpu->device, LINE_AHEAD, LINE_PICTURE) &&
              launch_known(gpu, sweep, program, 0);
  for (int first = 1, number = 0, end; first < sheets && done; first = end, number++) {
    end = end_of_run(sweep, first);
    done = launch_run(gpu, sweep, program, (device_run){first, end, number});
    if (done && end < sheets && sweep->advance != NULL && sweep->ends[end - 1])
      done = sweep->advance(sweep->of_advance, gpu, sweep, end - 1);
  }
  return done;
}

/* ---- the trial ---- */

bool hl_gpu_try(hl_gpu *gpu, const float *numbers, uint32_t count, float *results, uint32_t result_count) {
  const plan_variant plainest = {.bspline = 1, .lit = 1, .channels = 1};
  const gpu_program *program = program_of(gpu, &plainest);
  const gpu_argument arguments[] = {memory(gpu, BUFFER_RAYS), memory(gpu, BUFFER_PIXELS), {.value = count}};
  const size_t bytes = (size_t)count * result_count * sizeof *results;
  return program != NULL &&
         reserve_and_upload(gpu, BUFFER_RAYS, numbers, (size_t)count * 3 * sizeof *numbers) &&
         reserve(gpu, BUFFER_PIXELS, bytes) &&
         launch(gpu, program, KERNEL_TRY, 0, groups_of(count), arguments, 3) &&
         gpu->device.driver->download(&gpu->device, &gpu->buffers[BUFFER_PIXELS], 0, results, bytes);
}

bool hl_gpu_run(hl_gpu *gpu, const gpu_sweep *sweep) {
  const gpu_program *program = program_of(gpu, &sweep->variant);
  gpu->launches = 0;
  return program != NULL && make_room(gpu, sweep) && find_distances(gpu, program) &&
         gpu->device.driver->mark(&gpu->device, 0) && reset(gpu, sweep, program) &&
         launch_runs(gpu, sweep, program) && gpu->device.driver->mark(&gpu->device, 1);
}

bool hl_gpu_read(hl_gpu *gpu, const gpu_sweep *sweep, float *pixels, gpu_times *times) {
  const gpu_driver *driver = gpu->device.driver;
  uint32_t counts[SAMPLE_COUNTERS];
  if (!driver->download(&gpu->device, &gpu->buffers[BUFFER_COUNTS], 0, counts, sizeof counts) ||
      !driver->download(&gpu->device, &gpu->buffers[BUFFER_PIXELS], 0, pixels,
                        (size_t)sweep->plan->tiles * 1024 * sizeof *pixels))
    return false;
  times->milliseconds += driver->milliseconds(&gpu->device);
  times->launches += gpu->launches;
  for (int i = 0; i < SAMPLE_COUNTERS; i++) times->samples += counts[i];
  return true;
}
