/* render/device_sublights.c - see device_sublights.h. */
#include "render/device_sublights.h"

#include <string.h>

bool hl_has_sublights(const light_shadow *shadow) { return shadow->method == &hl_shadow_sublights; }

/* The number of pixels of a plane of one sub-light. */
static size_t sublight_plane(const light_shadow *shadow) {
  return (size_t)shadow->sublight_tiles_x * (size_t)shadow->sublight_tiles_y * TILE_PIXELS;
}

size_t hl_device_sublight_bytes(const light_shadow *shadow, size_t planes) {
  return (size_t)shadow->sublight_count * planes * sublight_plane(shadow) * sizeof(sublight_pixel);
}

/* ---- a light ---- */

/* Gives the arrays of a light's sub-lights their places on the device. */
static void place_light(const light_shadow *shadow, const device_sweep *plan, gpu_sweep *sweep,
                        plan_light *light) {
  gpu_sublights *all = &sweep->sublights;
  const size_t planes = (size_t)sweep->variant.channels * (1 + (size_t)sweep->variant.outside),
               ring = (size_t)plan->ring, count = (size_t)shadow->sublight_count,
               tiles = (size_t)shadow->sublight_tiles_x * (size_t)shadow->sublight_tiles_y;
  light->sublights = shadow->sublight_count;
  light->first_sublight = (int)all->count;
  light->sublight_tiles_x = shadow->sublight_tiles_x;
  light->sublight_tiles_y = shadow->sublight_tiles_y;
  light->sublight_stride = shadow->sublight_tiles_x * TILE;
  light->sublight_plane = (int)sublight_plane(shadow);
  light->sublight_planes = (unsigned)(all->pixels / 16);
  light->halves = (unsigned)(all->half_floats / 16);
  light->sublight_marks = (unsigned)all->marks;
  all->pixels += ring * count * planes * sublight_plane(shadow);
  all->half_floats += (ring * planes * (SLAB_COPIES - 1) * (size_t)light->plane + 15) / 16 * 16;
  all->marks += (2 * ring + 1) * (size_t)light->tiles + 3 * count * tiles;
  all->count += count;
}

static plan_sublight_maps planned_maps(const sublight_maps *maps) {
  return (plan_sublight_maps){.reaches = maps->reaches,
                              .comes = maps->comes,
                              .near_scale = {maps->near.scale[0], maps->near.scale[1]},
                              .near_shift = {maps->near.shift[0], maps->near.shift[1]},
                              .far_scale = {maps->far.scale[0], maps->far.scale[1]},
                              .far_shift = {maps->far.shift[0], maps->far.shift[1]}};
}

/* Describes one sub-light. first: the first slab beyond the light. count: the number of sub-lights of all
 * lights. */
static void describe_sublight(const light_shadow *shadow, int number, int first, size_t count,
                              plan_sublight *to, plan_sublight_place *places, plan_sublight_maps *maps) {
  const sheet_stack *sheets = shadow->setup.sheets;
  const view *slab = &shadow->plan.view;
  view view;
  hl_sublight_view(shadow, number, &view);
  const shadow_map map = hl_map_of_view(&view);
  memcpy(to->map, map.rows, sizeof to->map);
  to->width = map.width;
  to->height = map.height;
  for (int sheet = first; sheet < sheets->count; sheet++) {
    const double from = hl_sheet_height(sheets, sheet - 1), height = hl_sheet_height(sheets, sheet);
    const int slabs = sheet - first, run = hl_sublight_run(slabs), next = hl_sublight_run(slabs + 1);
    plan_sublight_place *place = &places[(size_t)sheet * count];
    sublight_place found;
    place->reaches = hl_sublight_place(&view, slab, sheets->normal, (from + height) / 2, &found);
    place->shifted = found.shifted;
    memcpy(place->scale, found.scale, sizeof place->scale);
    memcpy(place->shift, found.shift, sizeof place->shift);
    memcpy(place->halves, found.half, sizeof place->halves);
    place->carry = hl_sublight_carry(slabs, number, shadow->sublight_count);
    if (next == run) continue;
    const sublight_maps of_run = hl_sublight_maps(&view, slab, sheets->normal, height, height - from);
    maps[(size_t)next * count] = planned_maps(&of_run);
  }
}

/* ---- the passes ---- */

/* The greatest number of passes of a light after a run of slabs. */
enum { PASSES_OF_RUN = 4 };

/* Adds the passes of a light after the run of slabs from `first` to `last`. beyond: the first slab beyond the
 * light. */
static void add_run(const plan_light *light, int index, int beyond, int first, int last, int run,
                    known_passes *passes) {
  const int tiles_y = light->tiles / light->tiles_x, slabs = last - beyond,
            own = light->sublight_tiles_y * light->sublights,
            all = own * light->sublight_tiles_x > light->tiles ? own * light->sublight_tiles_x : light->tiles;
  plan_pass pass = {.light = index, .first = first, .sheet = last, .run = run};
  pass.kind = PASS_HALVES;
  pass.tiles_x = light->tiles_x;
  pass.tiles_y = tiles_y * (last - first + 1);
  hl_known_passes_add(passes, pass);
  pass.kind = PASS_SUBLIGHTS;
  pass.tiles_x = light->sublight_tiles_x;
  pass.tiles_y = own;
  hl_known_passes_add(passes, pass);
  if (slabs < 0 || hl_sublight_run(slabs) == hl_sublight_run(slabs + 1)) return;
  pass.kind = PASS_DARK;
  pass.tiles_x = 1;
  pass.tiles_y = all;
  hl_known_passes_add(passes, pass);
  pass.kind = PASS_REACHED;
  pass.tiles_x = light->tiles;
  pass.tiles_y = light->sublights;
  pass.chunk = hl_sublight_run(slabs + 1);
  hl_known_passes_add(passes, pass);
}

/* Returns whether the lit blocks of some light are found after a slab. */
static bool ends_run(const device_sweep *plan, const int *beyond, int sheet) {
  for (int i = 0; i < plan->light_count; i++) {
    const int slabs = sheet - beyond[i];
    if (plan->lights[i].sublights > 0 && slabs >= 0 && hl_sublight_run(slabs) != hl_sublight_run(slabs + 1))
      return true;
  }
  return false;
}

static void add_runs(const device_sweep *plan, const int *beyond, int slabs, known_passes *passes) {
  for (int sheet = 1, first = 1, run = 0; sheet < plan->sheets; sheet++) {
    passes->first[sheet] = (int32_t)passes->passes.count;
    if (!ends_run(plan, beyond, sheet) && sheet - first + 1 < slabs && sheet + 1 < plan->sheets) continue;
    passes->ends[sheet] = 1;
    for (int i = 0; i < plan->light_count; i++)
      if (plan->lights[i].sublights > 0) add_run(&plan->lights[i], i, beyond[i], first, sheet, run, passes);
    first = sheet + 1;
    run++;
  }
  passes->first[plan->sheets] = (int32_t)passes->passes.count;
}

bool hl_weigh_sublights(const light_shadow *shadow) {
  return hl_has_sublights(shadow) && shadow->setup.emission != NULL;
}

/* Sets the weights of a light's sub-lights, as the processors do when they begin a sweep. list: the light's
 * sub-lights. */
static hl_status find_weights(hl_context *context, const light_shadow *shadow, plan_sublight *list,
                              hl_error *error) {
  const size_t count = (size_t)shadow->sublight_count;
  double mean[HL_CHANNELS];
  if (!hl_weigh_sublights(shadow)) return HL_OK;
  float(*weights)[HL_CHANNELS] = hl_allocate(context, count, sizeof *weights);
  if (weights == NULL) return hl_fail_memory(error, count * sizeof *weights, "sub-lights");
  hl_light_emission_weights(shadow->setup.source, shadow->setup.settings->light_samples, weights, mean);
  for (size_t i = 0; i < count; i++) memcpy(list[i].weight, weights[i], sizeof list[i].weight);
  hl_release(context, weights);
  return HL_OK;
}

hl_status hl_device_sublights_begin(hl_context *context, const sweep_plan *of, device_sweep *plan,
                                    plan_rays *rays, device_sublights *sublights, known_passes *passes,
                                    gpu_sweep *sweep, hl_error *error) {
  const sheet_stack *sheets = &of->geometry->sheets;
  const size_t sheet_count = (size_t)sheets->count;
  gpu_sublights *all = &sweep->sublights;
  int beyond[PLAN_LIGHTS] = {0};
  size_t lights = 0;
  for (int i = 0; i < plan->light_count; i++) {
    const light_shadow *shadow = &of->lights[i].shadow;
    if (!hl_has_sublights(shadow)) continue;
    beyond[i] = hl_first_beyond(sheets, shadow->setup.source);
    place_light(shadow, plan, sweep, &plan->lights[i]);
    for (int sheet = beyond[i]; sheet < sheets->count; sheet++)
      rays[(size_t)(3 + 2 * i) * sheet_count + (size_t)sheet].chunk = hl_sublight_run(sheet - beyond[i]);
    lights++;
  }
  all->pixels += (size_t)TILE_PIXELS * TILE_PIXELS; /* a look-up may read a row behind the last plane */
  all->runs = (size_t)hl_sublight_run(sheets->count) + 1;
  plan->sublight_count = (int)all->count;
  all->list = sublights->list = hl_allocate_zeroed(context, all->count, sizeof *sublights->list);
  all->places = sublights->places = hl_allocate_zeroed(context, sheet_count * all->count,
                                                       sizeof *sublights->places);
  all->maps = sublights->maps = hl_allocate_zeroed(context, all->runs * all->count, sizeof *sublights->maps);
  if (sublights->list == NULL || sublights->places == NULL || sublights->maps == NULL)
    return hl_fail_memory(error, sheet_count * all->count * sizeof *sublights->places, "sub-lights");
  hl_status status = HL_OK;
  for (int i = 0; i < plan->light_count && status == HL_OK; i++) {
    const size_t first = (size_t)plan->lights[i].first_sublight;
    for (int n = 0; n < plan->lights[i].sublights; n++)
      describe_sublight(&of->lights[i].shadow, n, beyond[i], all->count, &sublights->list[first + (size_t)n],
                        &sublights->places[first + (size_t)n], &sublights->maps[first + (size_t)n]);
    status = find_weights(context, &of->lights[i].shadow, sublights->list + first, error);
  }
  if (status == HL_OK)
    status = hl_known_passes_begin(context, sheets->count, PASSES_OF_RUN * lights * sheet_count, passes,
                                   sweep, error);
  if (status == HL_OK) add_runs(plan, beyond, sweep->slabs, passes);
  return status;
}

void hl_device_sublights_release(hl_context *context, device_sublights *sublights) {
  hl_release(context, sublights->list);
  hl_release(context, sublights->places);
  hl_release(context, sublights->maps);
  *sublights = (device_sublights){0};
}
