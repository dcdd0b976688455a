/* gpu/gpu_run.c - runs sweeps on an open device. */
#include <string.h>

#include "gpu/gpu_state.h"

enum { SAMPLE_COUNTERS = 256 };

/* Sets the first `floats` floats of a buffer to a value. floats: a multiple of four. */
static bool fill(hl_gpu *gpu, const gpu_program *program, enum buffer_use use, size_t floats, float value) {
  uint32_t fours = (uint32_t)(floats / 4);
  const gpu_argument arguments[] = {hl_gpu_memory(gpu, use), {.value = fours}, hl_gpu_number_of_float(value)};
  return fours == 0 || hl_gpu_launch(gpu, program, KERNEL_FILL, 0, hl_gpu_groups(fours), arguments, 3);
}

/* Finds the distances of the bricks of one volume, by three passes, one along each axis. first: the number of
 * the volume's first brick. */
static bool find_own_distances(hl_gpu *gpu, const gpu_program *program, const int32_t count[3],
                               unsigned first) {
  const size_t bricks = (size_t)count[0] * (size_t)count[1] * (size_t)count[2];
  bool done = true;
  for (int axis = 0; axis < 3 && done; axis++) {
    enum buffer_use from = axis == 1 ? BUFFER_DISTANCES_MADE : BUFFER_DISTANCES,
                    to = axis == 1 ? BUFFER_DISTANCES : BUFFER_DISTANCES_MADE;
    const gpu_argument arguments[] = {
        hl_gpu_memory(gpu, from), hl_gpu_memory(gpu, to), hl_gpu_number(count[0]),  hl_gpu_number(count[1]),
        hl_gpu_number(count[2]),  hl_gpu_number(axis),    hl_gpu_number(axis == 0), {.value = first}};
    done = hl_gpu_launch(gpu, program, KERNEL_DISTANCES, 0, hl_gpu_groups(bricks), arguments, 8);
  }
  return done;
}

static bool find_distances(hl_gpu *gpu, const gpu_sweep *sweep, const gpu_program *program) {
  bool done = true;
  if (gpu->has_distances) return true;
  for (int v = 0; v < gpu->volume_count && done; v++)
    done = find_own_distances(gpu, program, gpu->brick_count[v], sweep->volumes[v].bricks_begin);
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
  return hl_gpu_reserve(gpu, BUFFER_SOFT, soft_floats(sweep) * sizeof(float)) &&
         hl_gpu_reserve(gpu, BUFFER_TOUCHED, touched_floats(sweep) * sizeof(float)) &&
         hl_gpu_reserve(gpu, BUFFER_FIELDS, field_floats(sweep) * sizeof(float)) &&
         hl_gpu_reserve(gpu, BUFFER_ROWS, sweep->row_floats * sizeof(float));
}

static bool reset_soft(hl_gpu *gpu, const gpu_sweep *sweep, const gpu_program *program) {
  return fill(gpu, program, BUFFER_SOFT, soft_floats(sweep), 0) &&
         fill(gpu, program, BUFFER_TOUCHED, touched_floats(sweep), 0) &&
         fill(gpu, program, BUFFER_FIELDS, field_floats(sweep), 0) &&
         fill(gpu, program, BUFFER_ROWS, sweep->variant.paper ? sweep->row_floats : 0, 1);
}

/* The numbers of floats that hold the pixels of sub-lights, the slabs' copies, and the marks. */
static size_t sublight_floats(const gpu_sweep *sweep) { return (sweep->sublights.pixels + 7) / 8 * 4; }
static size_t half_floats(const gpu_sweep *sweep) { return sweep->sublights.half_floats; }
static size_t mark_floats(const gpu_sweep *sweep) { return (sweep->sublights.marks + 3) / 4 * 4; }

static bool make_sublight_room(hl_gpu *gpu, const gpu_sweep *sweep) {
  const gpu_sublights *of = &sweep->sublights;
  const size_t sheets = (size_t)sweep->plan->sheets;
  return hl_gpu_reserve_and_upload(gpu, BUFFER_SUBLIGHTS, of->list, of->count * sizeof *of->list) &&
         hl_gpu_reserve_and_upload(gpu, BUFFER_PLACES, of->places, sheets * of->count * sizeof *of->places) &&
         hl_gpu_reserve_and_upload(gpu, BUFFER_MAPS, of->maps, of->runs * of->count * sizeof *of->maps) &&
         hl_gpu_reserve(gpu, BUFFER_OF_SUBLIGHTS, sublight_floats(sweep) * sizeof(float)) &&
         hl_gpu_reserve(gpu, BUFFER_HALVES, half_floats(sweep) * sizeof(float)) &&
         hl_gpu_reserve(gpu, BUFFER_SUBLIGHT_MARKS, mark_floats(sweep) * sizeof(float));
}

/* Full light is a number whose bits are all set. */
static bool reset_sublights(hl_gpu *gpu, const gpu_sweep *sweep, const gpu_program *program) {
  const uint32_t all_bits = 0xffffffff;
  float full;
  memcpy(&full, &all_bits, sizeof full);
  return fill(gpu, program, BUFFER_OF_SUBLIGHTS, sublight_floats(sweep), full) &&
         fill(gpu, program, BUFFER_SUBLIGHT_MARKS, mark_floats(sweep), 0);
}

/* Brings the tables of phase functions to the device: for each volume that has one, a row for each light,
 * then the caps. */
static bool upload_phases(hl_gpu *gpu, const gpu_sweep *sweep) {
  const size_t row = PLAN_PHASE_COLUMNS * sizeof(float), lights = (size_t)sweep->plan->light_count,
               caps = 2 * PLAN_PHASE_CAPS * row, volumes = (size_t)sweep->variant.volumes;
  bool done = hl_gpu_reserve(gpu, BUFFER_PHASES, sweep->variant.phases ? volumes * (lights * row + caps) : 0);
  for (size_t v = 0; v < volumes && done && sweep->variant.phases; v++) {
    const gpu_phases *phases = &sweep->phases[v];
    const size_t begin = sweep->volumes[v].phases_begin * sizeof(float);
    for (size_t i = 0; i < lights && done; i++)
      if (phases->rows[i] != NULL)
        done = hl_gpu_upload(gpu, BUFFER_PHASES, begin + i * row, phases->rows[i], row);
    if (done && phases->caps != NULL)
      done = hl_gpu_upload(gpu, BUFFER_PHASES, begin + lights * row, phases->caps, caps);
  }
  return done;
}

/* Brings the images that lights project to the device: their descriptions, then their pixels. */
static bool upload_textures(hl_gpu *gpu, const gpu_sweep *sweep) {
  const gpu_textures *textures = &sweep->textures;
  const size_t list = textures->list == NULL ? 0 : (size_t)sweep->plan->light_count * sizeof *textures->list;
  size_t bytes = list;
  for (size_t i = 0; i < textures->part_count; i++) bytes += textures->parts[i].floats * sizeof(float);
  bool done = hl_gpu_reserve(gpu, BUFFER_TEXTURES, bytes);
  if (done && list > 0) done = hl_gpu_upload(gpu, BUFFER_TEXTURES, 0, textures->list, list);
  size_t at = list;
  for (size_t i = 0; i < textures->part_count && done; i++) {
    const gpu_pixels *part = &textures->parts[i];
    done = hl_gpu_upload(gpu, BUFFER_TEXTURES, at, part->pixels, part->floats * sizeof(float));
    at += part->floats * sizeof(float);
  }
  return done;
}

/* Brings the cells of the sky's field to the device, unless the device has them already. */
static bool prepare_sky(hl_gpu *gpu, const gpu_sky *sky) {
  if (sky->cells == NULL || sky->version == gpu->sky_version) return hl_gpu_reserve(gpu, BUFFER_SKY, 0);
  gpu->sky_version = 0;
  if (!hl_gpu_reserve_and_upload(gpu, BUFFER_SKY, sky->cells, sky->bytes)) return false;
  gpu->sky_version = sky->version;
  return true;
}

/* Brings the sweep's numbers to the device, and behind them the volumes and their bounds. */
static bool upload_plan(hl_gpu *gpu, const gpu_sweep *sweep) {
  const size_t volumes = (size_t)sweep->variant.volumes,
               bounds = (1 + (size_t)sweep->plan->light_count) * volumes * sizeof *sweep->bounds,
               of_volumes = volumes * sizeof *sweep->volumes, own = sizeof *sweep->plan;
  return hl_gpu_reserve(gpu, BUFFER_PLAN, own + of_volumes + bounds) &&
         hl_gpu_upload(gpu, BUFFER_PLAN, 0, sweep->plan, own) &&
         hl_gpu_upload(gpu, BUFFER_PLAN, own, sweep->volumes, of_volumes) &&
         hl_gpu_upload(gpu, BUFFER_PLAN, own + of_volumes, sweep->bounds, bounds);
}

/* The number of floats of a slot: four, or two for each volume (gpu/kernels/slabs.h). */
static size_t slot_floats(const gpu_sweep *sweep) {
  return sweep->variant.volumes > 2 ? 2 * (size_t)sweep->variant.volumes : 4;
}

static bool make_room(hl_gpu *gpu, const gpu_sweep *sweep) {
  const device_sweep *plan = sweep->plan;
  const size_t tiles = (size_t)plan->tiles,
               slots = sweep->variant.maximum ? 0 : 2 * tiles * 256 * (size_t)sweep->slabs;
  bool done = upload_plan(gpu, sweep) &&
              hl_gpu_reserve_and_upload(gpu, BUFFER_RAYS, sweep->rays,
                                        sweep->ray_sets * (size_t)plan->sheets * sizeof *sweep->rays) &&
              hl_gpu_reserve(gpu, BUFFER_PIXELS, tiles * 1024 * sizeof(float)) &&
              hl_gpu_reserve(gpu, BUFFER_PLANES, sweep->plane_floats * sizeof(float)) &&
              hl_gpu_reserve(gpu, BUFFER_LIGHT, light_floats(sweep) * sizeof(float)) &&
              hl_gpu_reserve(gpu, BUFFER_CHANGED, (size_t)plan->light_tiles * 256 * sizeof(int32_t)) &&
              hl_gpu_reserve(gpu, BUFFER_SHOWN_FROM, tiles * 16 * sizeof(int32_t)) &&
              hl_gpu_reserve(gpu, BUFFER_COUNTS, counters_of(sweep) * sizeof(uint32_t)) &&
              hl_gpu_reserve(gpu, BUFFER_SLOTS, slots * slot_floats(sweep) * sizeof(float)) &&
              hl_gpu_reserve(gpu, BUFFER_LIST, slots * sizeof(uint32_t)) &&
              hl_gpu_reserve(gpu, BUFFER_MASKS, 2 * tiles * 256 * sizeof(uint32_t)) &&
              hl_gpu_reserve(gpu, BUFFER_CUTS, sweep->cut_count * sizeof *sweep->cuts) &&
              make_soft_room(gpu, sweep) && make_sublight_room(gpu, sweep) && upload_phases(gpu, sweep) &&
              upload_textures(gpu, sweep) && prepare_sky(gpu, &sweep->sky) &&
              (sweep->passes == NULL || hl_gpu_upload_passes(gpu, sweep->passes));
  if (done && sweep->shown_from != NULL)
    done = hl_gpu_upload(gpu, BUFFER_SHOWN_FROM, 0, sweep->shown_from, tiles * 16 * sizeof(int32_t));
  if (done && sweep->cut_count > 0)
    done = hl_gpu_upload(gpu, BUFFER_CUTS, 0, sweep->cuts, sweep->cut_count * sizeof *sweep->cuts);
  if (done && sweep->variant.maximum)
    done = hl_gpu_upload(gpu, BUFFER_TABLES, PLAN_SHOWN_VALUES * sizeof(float), sweep->shown_values,
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
              reset_soft(gpu, sweep, program) && reset_sublights(gpu, sweep, program);
  if (done && sweep->shown_from == NULL)
    done = fill(gpu, program, BUFFER_SHOWN_FROM, (size_t)plan->tiles * 16, 0);
  return done;
}

/* The greatest number of members that light the samples of a run. This number is enough to fill any
 * device. */
enum { SHADING_MEMBERS = 1 << 18 };
/* ---- runs of slabs ---- */

/* A run of slabs. */
typedef struct device_run {
  int first, end, number;
} device_run;

static bool launch_kernel(hl_gpu *gpu, const gpu_program *program, int kernel, size_t members,
                          device_run run) {
  const gpu_argument arguments[] = {hl_gpu_memory(gpu, BUFFER_PLAN),
                                    hl_gpu_memory(gpu, BUFFER_RAYS),
                                    hl_gpu_memory(gpu, BUFFER_VOXELS),
                                    hl_gpu_memory(gpu, BUFFER_DISTANCES_MADE),
                                    hl_gpu_memory(gpu, BUFFER_CELL_BITS),
                                    hl_gpu_memory(gpu, BUFFER_TABLES),
                                    hl_gpu_memory(gpu, BUFFER_PIXELS),
                                    hl_gpu_memory(gpu, BUFFER_PLANES),
                                    hl_gpu_memory(gpu, BUFFER_LIGHT),
                                    hl_gpu_memory(gpu, BUFFER_CHANGED),
                                    hl_gpu_memory(gpu, BUFFER_SHOWN_FROM),
                                    hl_gpu_memory(gpu, BUFFER_COUNTS),
                                    hl_gpu_memory(gpu, BUFFER_SLOTS),
                                    hl_gpu_memory(gpu, BUFFER_LIST),
                                    hl_gpu_memory(gpu, BUFFER_MASKS),
                                    hl_gpu_memory(gpu, BUFFER_CUTS),
                                    hl_gpu_memory(gpu, BUFFER_DIRECTORY),
                                    hl_gpu_memory(gpu, BUFFER_COLORS),
                                    hl_gpu_memory(gpu, BUFFER_SOFT),
                                    hl_gpu_memory(gpu, BUFFER_TOUCHED),
                                    hl_gpu_memory(gpu, BUFFER_SKY),
                                    hl_gpu_memory(gpu, BUFFER_MASK),
                                    hl_gpu_memory(gpu, BUFFER_SUBLIGHTS),
                                    hl_gpu_memory(gpu, BUFFER_OF_SUBLIGHTS),
                                    hl_gpu_memory(gpu, BUFFER_SUBLIGHT_MARKS),
                                    hl_gpu_memory(gpu, BUFFER_PHASES),
                                    hl_gpu_memory(gpu, BUFFER_TEXTURES),
                                    hl_gpu_number(run.first),
                                    hl_gpu_number(run.end),
                                    hl_gpu_number(run.number)};
  return hl_gpu_launch(gpu, program, kernel,
                       kernel == KERNEL_LIGHT || kernel == KERNEL_FIND ? LINE_AHEAD : LINE_PICTURE,
                       hl_gpu_groups(members), arguments, (int)(sizeof arguments / sizeof *arguments));
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
  return sweep->passes == NULL ||
         hl_gpu_launch_passes(gpu, program, sweep->passes, (size_t)sweep->first_pass[sheet],
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
  const plan_variant plainest = {.volumes = 1, .bspline = 1, .lit = 1, .channels = 1};
  const gpu_program *program = hl_gpu_program_of(gpu, &plainest);
  const gpu_argument arguments[] = {
      hl_gpu_memory(gpu, BUFFER_RAYS), hl_gpu_memory(gpu, BUFFER_PIXELS), {.value = count}};
  const size_t bytes = (size_t)count * result_count * sizeof *results;
  return program != NULL &&
         hl_gpu_reserve_and_upload(gpu, BUFFER_RAYS, numbers, (size_t)count * 3 * sizeof *numbers) &&
         hl_gpu_reserve(gpu, BUFFER_PIXELS, bytes) &&
         hl_gpu_launch(gpu, program, KERNEL_TRY, 0, hl_gpu_groups(count), arguments, 3) &&
         gpu->device.driver->download(&gpu->device, &gpu->buffers[BUFFER_PIXELS], 0, results, bytes);
}

bool hl_gpu_run(hl_gpu *gpu, const gpu_sweep *sweep) {
  const gpu_program *program = hl_gpu_program_of(gpu, &sweep->variant);
  gpu->launches = 0;
  return program != NULL && make_room(gpu, sweep) && find_distances(gpu, sweep, program) &&
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
