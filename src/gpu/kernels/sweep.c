/* gpu/kernels/sweep.c - defines the kernels' entry points. */
#include "gpu/kernels/attenuate.h"
#include "gpu/kernels/cascade.h"
#include "gpu/kernels/paper.h"
#include "gpu/kernels/sublights.h"
#include "gpu/kernels/trial.h"

/* Sets all floats of a buffer to a value. Each member of the kernel sets four floats. */
KERNEL(16) fill_floats(GLOBAL float *at, unsigned fours, float value) {
  unsigned number = (unsigned)work_number();
  if (number >= fours) return;
  for (unsigned i = 0; i < 4; i++) at[(wide)number * 4 + i] = value;
}

/* from: [count][3]; to: [count][TRIAL_RESULTS]. */
KERNEL(8) try_arithmetic(GLOBAL const float *from, GLOBAL float *to, unsigned count) {
  unsigned number = (unsigned)work_number();
  float result[TRIAL_RESULTS];
  if (number >= count) return;
  try_numbers(from[number * 3], from[number * 3 + 1], from[number * 3 + 2], result);
  for (int i = 0; i < TRIAL_RESULTS; i++) to[number * TRIAL_RESULTS + (unsigned)i] = result[i];
}

/* Finds, for each brick, the distance in bricks to the nearest brick that may show something. This takes
 * three passes, one along each axis; a call makes one pass. x, y, z: the numbers of bricks. first: the number
 * of the volume's first brick. relevant: not 0 in the first pass. In this pass `from` holds 1 for each brick
 * that may show something, and no distances yet. */
KERNEL(16)
spread_distances(GLOBAL const byte *from, GLOBAL byte *to, unsigned x, unsigned y, unsigned z, unsigned axis,
                 unsigned relevant, unsigned first) {
  wide number = (wide)(unsigned)work_number(), count = (wide)x * y * z;
  if (number >= count) return;
  unsigned column = (unsigned)(number % x), row = (unsigned)(number / x % y),
           slice = (unsigned)(number / x / y);
  int at = (int)(axis == 0   ? column
                 : axis == 1 ? row
                             : slice),
      length = (int)(axis == 0   ? x
                     : axis == 1 ? y
                                 : z);
  wide stride = axis == 0 ? 1 : axis == 1 ? (wide)x : (wide)x * y;
  int least = FARTHEST_BRICK;
  from += first;
  for (int offset = 1 - FARTHEST_BRICK; offset < FARTHEST_BRICK; offset++) {
    if (at + offset < 0 || at + offset >= length) continue;
    int value = from[number - (wide)at * stride + (wide)(at + offset) * stride];
    if (relevant) value = value ? 0 : FARTHEST_BRICK;
    int size = offset < 0 ? -offset : offset;
    int farther = value > size ? value : size;
    if (farther < least) least = farther;
  }
  to[first + number] = (byte)least;
}

/* The arguments of the kernels that work on a run of slabs. */
#define SWEEP_ARGUMENTS                                                                                    \
  GLOBAL const device_sweep *APART plan, GLOBAL const plan_rays *APART rays,                               \
      GLOBAL const byte *APART voxels, GLOBAL const byte *APART distances,                                 \
      GLOBAL const wide *APART cell_bits, GLOBAL const float *APART tables, GLOBAL float *APART pixels,    \
      GLOBAL float *APART planes, GLOBAL float *APART light_state, GLOBAL int *APART changed,              \
      GLOBAL const int *APART shown_from, GLOBAL unsigned *APART counts, GLOBAL float *APART slots,        \
      GLOBAL unsigned *APART list, GLOBAL unsigned *APART masks, GLOBAL const plan_cut *APART cuts,        \
      GLOBAL const plan_brick *APART directory, GLOBAL const byte *APART colors, GLOBAL float *APART soft, \
      GLOBAL int *APART touched, GLOBAL const short *APART sky, GLOBAL const byte *APART mask,             \
      GLOBAL const plan_sublight *APART sublights, GLOBAL const word16 *APART of_sublights,                \
      GLOBAL int *APART sublight_marks_of_all, GLOBAL const float *APART phases,                           \
      GLOBAL const plan_texture *APART textures, int first, int end, int run

DEVICE sweep_data sweep_of(SWEEP_ARGUMENTS) {
  sweep_data sweep;
  sweep.plan = plan;
  sweep.rays = rays;
  sweep.volume.plan = (GLOBAL const plan_volume *)(plan + 1);
  sweep.volume.bounds = (GLOBAL const plan_bounds *)(sweep.volume.plan + VOLUMES);
  sweep.volume.voxels = voxels;
  sweep.volume.distances = distances;
  sweep.volume.cell_bits = cell_bits;
  sweep.volume.tables = tables;
  sweep.volume.cuts = cuts;
  sweep.volume.directory = directory;
  sweep.volume.colors = colors;
  sweep.volume.mask = mask;
  sweep.volume.phases = phases;
  sweep.textures = textures;
  sweep.pixels = pixels;
  sweep.soft = soft;
  sweep.touched = touched;
  sweep.sublights = sublights;
  sweep.of_sublights = of_sublights;
  (void)sublight_marks_of_all;
  sweep.sky = sky;
  sweep.planes = planes;
  sweep.light = light_state;
  sweep.changed = changed;
  sweep.shown_from = shown_from;
  sweep.counts = counts;
  const wide pixel_count = (wide)plan->tiles * 256, slot_count = pixel_count * (wide)(plan->ring / 2);
  sweep.slots = slots + (wide)(run & 1) * slot_count * SLOT_FLOATS;
  sweep.list = list + (wide)(run & 1) * slot_count;
  sweep.masks = masks + (wide)(run & 1) * pixel_count;
  (void)first;
  (void)end;
  return sweep;
}

#define SWEEP_OF_ARGUMENTS                                                                            \
  sweep_of(plan, rays, voxels, distances, cell_bits, tables, pixels, planes, light_state, changed,    \
           shown_from, counts, slots, list, masks, cuts, directory, colors, soft, touched, sky, mask, \
           sublights, of_sublights, sublight_marks_of_all, phases, textures, first, end, run)

/* Lists the samples that the picture's pixels may see in slabs first to end - 1. In a maximum projection,
 * finds the greatest values in these slabs instead; there the next two kernels have nothing to do. */
KERNEL(16) find_samples(SWEEP_ARGUMENTS) {
  const sweep_data sweep = SWEEP_OF_ARGUMENTS;
  sweep.masks[work_number()] = find_slabs(&sweep, work_number(), first, end, counts + 256 + run);
}

/* Lights the listed samples. */
KERNEL(10) shade_samples(SWEEP_ARGUMENTS) {
#if !MAXIMUM
  const sweep_data sweep = SWEEP_OF_ARGUMENTS;
  const unsigned count = counts[256 + run];
  for (unsigned i = (unsigned)work_number(); i < count; i += work_count())
    shade_slot(&sweep, sweep.list[i], first);
#endif
}

KERNEL(16) composite_samples(SWEEP_ARGUMENTS) {
#if !MAXIMUM
  const sweep_data sweep = SWEEP_OF_ARGUMENTS;
  composite_slabs(&sweep, work_number());
#endif
}

/* Composites slabs first to end - 1 into the tiles of all lights' buffers. */
KERNEL(12) run_light(SWEEP_ARGUMENTS) {
#if SHADOWED
  SHARED_VOTES;
  const sweep_data sweep = SWEEP_OF_ARGUMENTS;
  const int tile = group_number() / TILE_GROUPS, number = light_of_tile(plan, tile),
            member = group_number() % TILE_GROUPS * GROUP + member_number();
  GLOBAL const plan_light *light = &plan->lights[number];
  const int own_tile = tile - light->first_tile, column = own_tile % light->tiles_x * 16 + column_of(member),
            row = own_tile / light->tiles_x * 16 + row_of(member), perspective = !light->parallel;
  const float u = (float)column, v = (float)row;
  GLOBAL const plan_rays *in_frame = rays + (3 + 2 * number) * plan->sheets;
  GLOBAL float *state = light_state + (wide)tile * (256 * PLANES_OF_SHEET) + member;
  GLOBAL float *pixel = planes + (wide)light->planes * 16 + light->origin + (wide)row * (wide)light->stride +
                        column;
  light_pixel own;
  for (int c = 0; c < PLANES_OF_SHEET; c++) own.passing[c] = state[c * 256];
#if SOFT
  GLOBAL float *moments = soft + (wide)tile * (512 * CHANNELS) + member;
  for (int c = 0; c < CHANNELS; c++) own.moment[c] = moments[c * 512];
#endif
  int changed_at = changed[(wide)tile * 256 + member];
  ray_left lefts[VOLUMES];
  for (int i = 0; i < VOLUMES; i++) {
    const volume_data volume = volume_of_sweep(&sweep, i);
    lefts[i] = left_of_ray(volume.plan, &bounds_in_light(&volume, light)->box, volume.cuts + light->first_cut,
                           volume.plan->light_cut_count, u, v);
  }
  int lit = block_any(votes, is_lit(&own));
#if SUBLIGHTS
  /* the buffer of a light with sub-lights takes each slab for itself, where some sub-light reaches it */
  const int single = light->sublights > 0;
  const sublight_marks of_light = marks_of_light(plan, light, sublight_marks_of_all);
  own.left = own.passing[0];
  if (single) lit = in_frame[first].chunk <= 1 || (of_light.lit[own_tile] >> (member >> 4) & 1) != 0;
#else
  const int single = 0;
#endif
  const slab_range slabs = slabs_of_ray(&sweep, 1 + number, u, v, first, end);
  const int own_first = slabs.first > light->first_slab ? slabs.first : light->first_slab;
  ways_of_ray ways;
  begin_ways(&sweep, 1 + number, perspective, first - 1, u, v, &ways);
  for (int sheet = first - 1, step; sheet < end; sheet += step) {
    int does = 0;
    step = 1;
    for (int c = 0; c < PLANES_OF_SHEET && single; c++) own.passing[c] = 1.0f;
    if (lit && sheet >= own_first - 1 && sheet < slabs.end) {
      step = fill_ways(&sweep, 1 + number, perspective, sheet, u, v, sheet == own_first - 1, &ways);
      if (ways_show(&ways) && sheet >= own_first)
        does = attenuate_slab(&sweep, light, in_frame + sheet, sheet, lefts, &ways, &own);
    } else {
      step = !lit || sheet >= slabs.end ? end - sheet : own_first - 1 - sheet;
      forget_ways(&ways);
    }
    if (does == SLAB_TAKES) changed_at = sheet;
#if SUBLIGHTS
    if (does == SLAB_TAKES && single) of_light.touched[sheet % plan->ring * light->tiles + own_tile] = sheet;
#endif
#if SOFT || PAPER
    if (does == SLAB_TAKES) touched[tile] = SOFT ? in_frame[sheet].chunk : 1;
#endif
#if OUTSIDE
    if (does == SLAB_HIDES) {
      leave_surface(&own);
      changed_at = sheet;
    }
#endif
    step = least_of_group(step);
    if (step > end - sheet) step = end - sheet;
    if (step > 1) forget_ways(&ways);
    for (int k = sheet < first ? first : sheet;
         k < sheet + step && changed_at > 0 && changed_at + single > k - plan->ring; k++)
      for (int c = 0; c < PLANES_OF_SHEET; c++)
        pixel[((wide)(k % plan->ring) * PLANES_OF_SHEET + c) * (wide)light->plane] = single && k != sheet
                                                                                         ? 1.0f
                                                                                         : own.passing[c];
    const int goes_on = block_any(votes, is_lit(&own));
    if (!single) lit = goes_on;
  }
#if SUBLIGHTS
  if (single) own.passing[0] = own.left;
#endif
  for (int c = 0; c < PLANES_OF_SHEET; c++) state[c * 256] = own.passing[c];
#if SOFT
  for (int c = 0; c < CHANNELS; c++) moments[c * 512] = own.moment[c];
#endif
  changed[(wide)tile * 256 + member] = changed_at;
#endif
}

#if SOFT || PAPER

/* ---- passes over the buffers of lights ---- */

/* The arguments of the kernels that make one pass. number: the number of the pass. */
#define PASS_ARGUMENTS                                                                            \
  GLOBAL const device_sweep *APART plan, GLOBAL const plan_pass *APART passes,                    \
      GLOBAL const plan_blur *APART boxes, GLOBAL const byte *APART marks, GLOBAL word16 *fields, \
      GLOBAL float *APART rows, GLOBAL float *APART planes, GLOBAL float *APART light_state,      \
      GLOBAL float *APART soft, GLOBAL int *APART touched, GLOBAL int *APART changed, int number

#endif

#if SOFT

KERNEL(16) pass_rows(PASS_ARGUMENTS) {
  (void)plan, (void)marks, (void)planes, (void)light_state, (void)soft, (void)touched, (void)changed;
  blur_row(passes + number, boxes, fields, rows, work_number());
}

KERNEL(16) pass_fields(PASS_ARGUMENTS) {
  (void)plan, (void)marks, (void)planes, (void)light_state, (void)soft, (void)touched, (void)changed;
  if (passes[number].kind == PASS_SPLIT) split_pixel(passes + number, fields, work_number());
  else sum_pixel(passes + number, boxes, fields, rows, work_number());
}

KERNEL(16) pass_absorbed(PASS_ARGUMENTS) {
  SHARED_VOTES;
  (void)boxes, (void)marks, (void)rows, (void)planes, (void)changed;
  const light_place place = place_of_member(plan, passes + number, work_number());
  GLOBAL float *own = soft + ((wide)place.tile * CHANNELS + passes[number].channel) * 512 + place.member;
  const float
      before = 1.0f - own[256],
      now = light_state[((wide)place.tile * PLANES_OF_SHEET + passes[number].channel) * 256 + place.member];
  const float taken = greater(before - greater(now, 0.0f), 0.0f);
  const int any = block_any(votes, taken > 0.0f), counts = touched[place.tile] == passes[number].chunk;
  absorb_pixel(passes + number, fields, place.at, before, taken, own, any && counts);
}

KERNEL(16) pass_refill(PASS_ARGUMENTS) {
  (void)boxes, (void)rows;
  refill_pixel(plan, passes + number, marks, fields, planes, light_state, soft, touched, changed,
               work_number());
}

#endif

#if PAPER

KERNEL(16) pass_below(PASS_ARGUMENTS) {
  (void)boxes, (void)marks, (void)fields, (void)rows, (void)planes, (void)soft, (void)changed;
  find_below(plan, passes + number, light_state, touched, work_number());
}

KERNEL(16) pass_wanted(PASS_ARGUMENTS) {
  (void)boxes, (void)marks, (void)fields, (void)rows, (void)planes, (void)light_state, (void)soft;
  (void)changed;
  find_wanted(plan, passes + number, touched, work_number());
}

KERNEL(16) convolve_rows(PASS_ARGUMENTS) {
  (void)marks, (void)fields, (void)light_state, (void)soft, (void)changed;
  convolve_row(plan, passes + number, boxes, rows, planes, touched, work_number());
}

KERNEL(16) convolve_columns(PASS_ARGUMENTS) {
  (void)marks, (void)fields, (void)soft;
  convolve_column(plan, passes + number, boxes, rows, planes, light_state, touched, changed, work_number());
}

#endif

#if SUBLIGHTS

/* ---- passes of sub-lights ---- */

/* The arguments of the kernels that make one pass. number: the number of the pass. */
#define SUBLIGHT_ARGUMENTS                                                                         \
  GLOBAL const device_sweep *APART plan, GLOBAL const plan_pass *APART passes,                     \
      GLOBAL const plan_sublight_place *APART places, GLOBAL const plan_sublight_maps *APART maps, \
      GLOBAL float *APART planes, GLOBAL float *APART halves, GLOBAL word16 *APART of_sublights,   \
      GLOBAL int *APART marks, int number

KERNEL(8) slab_halves(SUBLIGHT_ARGUMENTS) {
  (void)places, (void)maps, (void)of_sublights;
  make_halves(plan, passes + number, planes, halves, marks, work_number());
}

KERNEL(12) run_sublights(SUBLIGHT_ARGUMENTS) {
  (void)maps;
  composite_sublights(plan, passes + number, places, planes, halves, of_sublights, marks, work_number());
}

KERNEL(16) dark_sublights(SUBLIGHT_ARGUMENTS) {
  (void)maps, (void)planes, (void)halves;
  find_dark(plan, passes + number, places, of_sublights, marks, work_number());
}

KERNEL(16) reached_blocks(SUBLIGHT_ARGUMENTS) {
  (void)places, (void)planes, (void)halves, (void)of_sublights;
  GLOBAL const plan_light *light = &plan->lights[passes[number].light];
  int tile;
  const int bits = blocks_reached(plan, passes + number, maps, marks, work_number(), &tile);
  if (bits != 0) or_to(marks_of_light(plan, light, marks).lit + tile, bits);
}

#endif
