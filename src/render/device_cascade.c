/* render/device_cascade.c - see device_cascade.h.
 *
 * The order of the passes and the choice of groups are the same as on the processors (shadow_cascade). Only
 * the passes themselves differ: they are recorded here, and at a chunk's end they run on the device, over all
 * tiles. A tile that the processors leave out holds zeros, or is not read. */
#include "render/device_cascade.h"

#include <string.h>

#include "shadow_cascade/cascade_passes.h"

bool hl_is_chunked(const light_shadow *shadow) { return shadow->method == &hl_shadow_cascade; }

/* ---- recording ---- */

/* The light for whose shadows a crew records passes. */
typedef struct device_crew {
  device_cascades *cascades;
  device_soft_light *of;
  hl_gpu *gpu;
  const gpu_sweep *sweep;
} device_crew;

/* Makes room for more members of an array. Returns false if memory is short. */
static bool make_room(hl_context *context, void *array, size_t count, size_t more, size_t size,
                      size_t *capacity) {
  void *old;
  memcpy(&old, array, sizeof old);
  if (count + more <= *capacity) return true;
  const size_t wanted = 2 * (count + more);
  void *grown = hl_allocate(context, wanted, size);
  if (grown == NULL) return false;
  if (count > 0) memcpy(grown, old, count * size);
  hl_release(context, old);
  memcpy(array, &grown, sizeof grown);
  *capacity = wanted;
  return true;
}

static void record(const device_crew *crew, plan_pass pass) {
  device_passes *passes = &crew->cascades->passes;
  if (passes->failed || !make_room(crew->cascades->context, &passes->list, passes->count, 1,
                                   sizeof *passes->list, &passes->capacity)) {
    passes->failed = true;
    return;
  }
  passes->list[passes->count++] = pass;
}

/* The index of a field's pixel (0, 0) among the pixels of all fields. */
static unsigned place_of(const device_crew *crew, const cascade_field *field) {
  return field == NULL ? PASS_NOTHING : (unsigned)(crew->of->first_pixel + field->place);
}

static plan_pass pass_on(const cascade_level *level, int kind) {
  return (plan_pass){.kind = kind,
                     .tiles_x = level->tiles_x,
                     .tiles_y = level->tiles_y,
                     .stride = (int)level->stride,
                     .a = PASS_NOTHING,
                     .b = PASS_NOTHING,
                     .thin = PASS_NOTHING};
}

static void record_add(const cascade_crew *crew, const cascade_sum *sum) {
  const device_crew *own = crew->device;
  const int scale = sum->level->scale;
  plan_pass pass = pass_on(sum->level, sum->level_a->scale < scale                     ? PASS_HALF
                                       : sum->b != NULL && sum->level_b->scale > scale ? PASS_DOUBLE
                                                                                       : PASS_ADD);
  pass.stride_in = (int)(sum->b == NULL ? sum->level_a->stride : sum->level_b->stride);
  pass.a = place_of(own, sum->a);
  pass.b = place_of(own, sum->b);
  pass.thin = place_of(own, sum->thin);
  pass.to = place_of(own, sum->to);
  record(own, pass);
}

/* Records the boxes of a level's columns and rows of tiles. Returns the number of the first recorded box. */
static unsigned record_boxes(const device_crew *crew, const cascade_level *level) {
  device_passes *passes = &crew->cascades->passes;
  const size_t first = passes->box_count, count = (size_t)level->tiles_x + (size_t)level->tiles_y;
  if (passes->failed || !make_room(crew->cascades->context, &passes->boxes, first, count,
                                   sizeof *passes->boxes, &passes->box_capacity)) {
    passes->failed = true;
    return 0;
  }
  for (size_t i = 0; i < count; i++) {
    const blur_box *box = &level->boxes[i].box;
    passes->boxes[first + i] = (plan_blur){box->reach, box->edge, box->scale};
  }
  passes->box_count += count;
  return (unsigned)first;
}

static void record_blur_add(const cascade_crew *crew, const cascade_blurred_sum *sum) {
  const device_crew *own = crew->device;
  const cascade_level *level = sum->level;
  plan_pass pass = pass_on(level, PASS_BLUR);
  int reach_x, reach_y;
  hl_cascade_find_boxes(level, &sum->blur, &reach_x, &reach_y);
  pass.boxes = record_boxes(own, level);
  pass.a = place_of(own, sum->a);
  pass.b = place_of(own, sum->from);
  pass.thin = place_of(own, sum->thin);
  pass.to = place_of(own, sum->to);
  record(own, pass);
}

static void record_merge(const cascade_crew *crew, const cascade_merger *merger) {
  const device_crew *own = crew->device;
  cascade_sum sums[MERGE_SUMS];
  plan_pass pass = pass_on(merger->level, PASS_SPLIT);
  pass.a = pass.to = place_of(own, merger->b.absorbed);
  pass.thin = pass.to_thin = place_of(own, merger->b.thin);
  pass.second = place_of(own, merger->spare.absorbed);
  pass.second_thin = place_of(own, merger->spare.thin);
  pass.late = (float)merger->late;
  record(own, pass);
  hl_cascade_find_merge_sums(merger, sums);
  for (int i = 0; i < MERGE_SUMS; i++) record_add(crew, &sums[i]);
}

/* Returns whether any slab of a chunk absorbed light. */
static bool any_touched(const device_crew *crew, int chunk) {
  const plan_light *light = &crew->sweep->plan->lights[crew->of->light];
  device_passes *passes = &crew->cascades->passes;
  int32_t *chunks = hl_allocate(crew->cascades->context, (size_t)light->tiles, sizeof *chunks);
  bool any = false;
  passes->failed = passes->failed || chunks == NULL || !hl_gpu_touched(crew->gpu, light, chunks);
  for (int tile = 0; tile < light->tiles && !passes->failed; tile++) any = any || chunks[tile] == chunk;
  hl_release(crew->cascades->context, chunks);
  return any;
}

static bool record_absorb(const cascade_crew *crew, const cascade_absorption *absorption) {
  const device_crew *own = crew->device;
  const soft_cascade *cascade = absorption->cascade;
  const cascade_level *level = &cascade->level[0];
  for (int c = 0; c < cascade->channels; c++) {
    plan_pass pass = pass_on(level, PASS_ABSORB);
    pass.to = place_of(own, &absorption->start->absorbed[c]);
    pass.to_thin = place_of(own, &absorption->start->thin[c]);
    pass.second = place_of(own, &absorption->end->absorbed[c]);
    pass.second_thin = place_of(own, &absorption->end->thin[c]);
    pass.length = (float)absorption->length;
    pass.light = own->of->light;
    pass.channel = c;
    pass.chunk = (int)cascade->chunks + 1;
    record(own, pass);
  }
  return any_touched(own, (int)cascade->chunks + 1);
}

/* Records the marks of a light's tiles. Returns the number of the first recorded mark. */
static unsigned record_marks(const device_crew *crew, const soft_cascade *cascade) {
  device_passes *passes = &crew->cascades->passes;
  const cascade_level *level = &cascade->level[0];
  const size_t first = passes->mark_count, count = (size_t)level->tiles_x * (size_t)level->tiles_y;
  if (passes->failed ||
      !make_room(crew->cascades->context, &passes->marks, first, count, 1, &passes->mark_capacity)) {
    passes->failed = true;
    return 0;
  }
  for (int y = 0; y < level->tiles_y; y++) {
    const read_row read = hl_cascade_read_row(&cascade->reads, 1, y, 0);
    for (int x = 0; x < level->tiles_x; x++) {
      const size_t tile = (size_t)y * (size_t)level->tiles_x + (size_t)x;
      unsigned char mark = 0;
      if (read.any && hl_cascade_is_read(&read, &read.all, x)) {
        mark = MARK_READ | (cascade->refilled[tile] & REFILLED_BEFORE ? MARK_AGAIN : 0);
        cascade->refilled[tile] |= REFILLED_NOW;
      }
      passes->marks[first + tile] = mark;
    }
  }
  passes->mark_count += count;
  return (unsigned)first;
}

static void record_refill(const cascade_crew *crew, const cascade_refilling *refilling) {
  const device_crew *own = crew->device;
  const soft_cascade *cascade = refilling->cascade;
  const cascade_level *level = &cascade->level[0];
  const unsigned marks = record_marks(own, cascade);
  for (int c = 0; c < cascade->channels; c++) {
    plan_pass pass = pass_on(level, PASS_REFILL);
    pass.a = place_of(own, &cascade->absorbed[c]);
    pass.light = own->of->light;
    pass.channel = c;
    pass.chunk = (int)cascade->chunks;
    pass.sheet = refilling->sheet;
    pass.marks = marks;
    record(own, pass);
  }
}

static const cascade_works device_works = {.add = record_add,
                                           .blur_add = record_blur_add,
                                           .merge = record_merge,
                                           .absorb = record_absorb,
                                           .refill = record_refill};

/* Ends the chunks of all lights that end at a given sheet. */
static bool end_chunks(void *data, hl_gpu *gpu, const gpu_sweep *sweep, int sheet) {
  device_cascades *cascades = data;
  device_passes *passes = &cascades->passes;
  passes->count = passes->box_count = passes->mark_count = 0;
  for (int i = 0; i < cascades->count; i++) {
    device_soft_light *of = &cascades->lights[i];
    device_crew own = {cascades, of, gpu, sweep};
    const cascade_crew crew = {.works = &device_works, .device = &own};
    if (of->slabs[sheet].ends) hl_cascade_end_chunk(&of->shadow, &of->occupancy, sheet, &crew);
  }
  return !passes->failed && hl_gpu_pass(gpu, sweep,
                                        &(gpu_passes){passes->list, passes->count, passes->boxes,
                                                      passes->box_count, passes->marks, passes->mark_count});
}

/* ---- begin and end ---- */

/* memory: the amount of memory that the shadow method was planned to take. */
static hl_status copy_shadow(hl_context *context, const light_shadow *planned, const shadow_layouts *memory,
                             device_soft_light *of, hl_error *error) {
  const size_t bytes = planned->method->state_bytes;
  of->shadow.state = hl_allocate(context, 1, bytes);
  of->passing = hl_allocate(context, memory->passing.bytes, 1);
  if (of->shadow.state == NULL || of->passing == NULL)
    return hl_fail_memory(error, bytes + memory->passing.bytes, "a light's shadows");
  memcpy(of->shadow.state, planned->state, bytes);
  shadow_layouts handed = {.passing.base = of->passing};
  planned->method->lay_out(&of->shadow, &handed);
  hl_cascade_begin_elsewhere(&of->shadow);
  return HL_OK;
}

/* Describes the chunks of a light. rays: the light's rays, in frame space. */
static void note_chunks(const sheet_stack *sheets, const device_soft_light *of, plan_rays *rays,
                        unsigned char *ends) {
  for (int sheet = 1; sheet < sheets->count; sheet++) {
    const cascade_slab *slab = &of->slabs[sheet];
    rays[sheet].position = slab->position;
    rays[sheet].young = slab->young;
    rays[sheet].chunk = slab->chunk;
    if (slab->ends) ends[sheet] = 1;
  }
}

/* Gives the levels of a light their places among the pixels of all fields. */
static void place_levels(device_soft_light *of, gpu_sweep *sweep) {
  const soft_cascade *cascade = of->shadow.state;
  of->first_pixel = sweep->field_pixels;
  for (int i = 0; i < cascade->level_count; i++) {
    const cascade_level *level = &cascade->level[i];
    const size_t rows = (size_t)level->tiles_y * TILE + 2 * CASCADE_MARGIN,
                 floats = rows * (size_t)level->tiles_x * TILE;
    sweep->field_pixels += level->pixels;
    if (sweep->row_floats < floats) sweep->row_floats = floats;
  }
}

static hl_status begin_light(const sweep_means *means, const frame_plan *frame_plan, const sweep_plan *plan,
                             device_soft_light *of, hl_error *error) {
  const sheet_stack *sheets = &plan->geometry->sheets;
  const light_shadow *planned = &plan->lights[of->light].shadow;
  of->shadow = *planned;
  of->shadow.state = NULL;
  of->slabs = hl_allocate_zeroed(means->context, (size_t)sheets->count, sizeof *of->slabs);
  if (of->slabs == NULL)
    return hl_fail_memory(error, (size_t)sheets->count * sizeof *of->slabs, "a light's shadows");
  hl_cascade_find_chunks(planned, hl_first_beyond(sheets, planned->setup.source), of->slabs);
  const occupancy_source source = {frame_plan->volumes.grids, frame_plan->volumes.count, &planned->plan.view,
                                   sheets, planned->plan.spare};
  hl_status status = hl_occupancy_build(means->context, means->pool, means->hot->view->brick_ranges, &source,
                                        &of->occupancy, error);
  if (status != HL_OK) return status;
  return copy_shadow(means->context, planned, &plan->lights[of->light].memory, of, error);
}

hl_status hl_device_cascades_begin(const sweep_means *means, const frame_plan *frame_plan,
                                   const sweep_plan *plan, plan_rays *rays, device_cascades *cascades,
                                   gpu_sweep *sweep, hl_error *error) {
  const sheet_stack *sheets = &plan->geometry->sheets;
  const int lights = plan->geometry->light_count;
  hl_status status = HL_OK;
  cascades->context = means->context;
  cascades->lights = hl_allocate_zeroed(means->context, (size_t)lights + 1, sizeof *cascades->lights);
  cascades->ends = hl_allocate_zeroed(means->context, (size_t)sheets->count, 1);
  if (cascades->lights == NULL || cascades->ends == NULL)
    return hl_fail_memory(error, (size_t)lights * sizeof *cascades->lights, "soft lights");
  for (int i = 0; i < lights && status == HL_OK; i++) {
    if (!hl_is_chunked(&plan->lights[i].shadow)) continue;
    device_soft_light *of = &cascades->lights[cascades->count++];
    of->light = i;
    status = begin_light(means, frame_plan, plan, of, error);
    if (status != HL_OK) break;
    note_chunks(sheets, of, rays + (3 + 2 * i) * sheets->count, cascades->ends);
    place_levels(of, sweep);
  }
  if (status == HL_OK && sweep->field_pixels >= PASS_NOTHING)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s", "the soft shadows are too large for a device");
  sweep->ends = cascades->ends;
  sweep->advance = end_chunks;
  sweep->of_advance = cascades;
  return status;
}

void hl_device_cascades_release(device_cascades *cascades) {
  hl_context *context = cascades->context;
  for (int i = 0; i < cascades->count; i++) {
    device_soft_light *of = &cascades->lights[i];
    hl_release(context, of->shadow.state);
    hl_release(context, of->passing);
    hl_release(context, of->slabs);
    hl_occupancy_release(context, &of->occupancy);
  }
  if (context == NULL) return;
  hl_release(context, cascades->lights);
  hl_release(context, cascades->ends);
  hl_release(context, cascades->passes.list);
  hl_release(context, cascades->passes.boxes);
  hl_release(context, cascades->passes.marks);
  *cascades = (device_cascades){0};
}
