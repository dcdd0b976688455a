/* render/device_plan.c - see device_plan.h.
 *
 * The numbers are copied one by one from the structs of the processors' sweep (render/slab.h,
 * shadow/attenuate.h). So a device computes with the same floats as the processors. */
#include "render/device_plan.h"

#include <string.h>

#include "core/sheet_constants.h"
#include "grid/relevant.h"
#include "plan/shown_values.h"
#include "render/view_sheets.h"

_Static_assert(PLAN_LIGHTS >= MAXIMUM_SWEEP_LIGHTS && PLAN_SECTORS == LIGHT_SECTORS &&
                   PLAN_ENTRIES == CLASSIFIER_ENTRIES && PLAN_ENTRIES == STEEPNESS_ENTRIES &&
                   PLAN_KERNEL_POWERS == HL_KERNEL_DEGREE + 1,
               "plans hold what sweeps hold");
_Static_assert(PLAN_SHOWN_FROM == SHOWN_FROM && PLAN_SHOWN_TO == SHOWN_TO &&
                   PLAN_SHOWN_BELOW == SHOWN_BELOW && PLAN_TABLE_ROWS == (int)SHOWN_ENTRIES,
               "tables of shown values of plans are those of frames");
_Static_assert(PLAN_PHASE_COLUMNS == PHASE_COLUMNS && PLAN_PHASE_CAPS == PHASE_CAPS &&
                   PLAN_LIGHT_CAPS == MOST_CAPS && sizeof(plan_cap) == sizeof(light_cap),
               "tables of phase functions of plans are those of lights");
_Static_assert(PLAN_HARMONICS == FIELD_HARMONICS, "skies of plans are skies of fields");
_Static_assert(CUT_PLANE == (int)HL_CUT_PLANE && CUT_BOX == (int)HL_CUT_BOX &&
                   CUT_SPHERE == (int)HL_CUT_SPHERE,
               "cuts of plans are cuts of scenes");
_Static_assert(offsetof(plan_rays, height) == sizeof(sheet_rays) && sizeof(plan_box) == sizeof(box_rays),
               "rays of plans are rays of views");

/* ---- the light of a sky ---- */

static void plan_sky_light(const sky_light *sky, plan_sky *planned) {
  memcpy(planned->count, sky->count, sizeof planned->count);
  planned->channels = sky->channels;
  planned->cut = sky->cut;
  planned->row_numbers = (unsigned)sky->row_numbers;
  memcpy(planned->low, sky->low, sizeof planned->low);
  planned->inverse_cell = sky->inverse_cell;
  planned->cell = sky->cell;
  planned->lift = sky->lift;
  memcpy(planned->stored_unit, sky->stored_unit, sizeof planned->stored_unit);
  memcpy(planned->color, sky->color, sizeof planned->color);
  memcpy(planned->open, sky->open, sizeof planned->open);
}

static gpu_sky cells_of_sky(const sky_light *sky) {
  if (sky == NULL) return (gpu_sky){0};
  const size_t rows = (size_t)sky->count[1] * (size_t)sky->count[2];
  return (gpu_sky){sky->version, sky->cells, rows * sky->row_numbers * sizeof *sky->cells};
}

/* ---- the lights ---- */

static void plan_brightness(const shade_light *shade, plan_light *light) {
  light->parallel = shade->parallel;
  light->shadowed = shade->shadowed;
  light->inverse_square = shade->inverse_square;
  light->nearest = shade->nearest;
  light->cubic = shade->cubic;
  memcpy(light->towards, shade->towards, sizeof light->towards);
  memcpy(light->position, shade->position, sizeof light->position);
  memcpy(light->color, shade->color, sizeof light->color);
  light->of_sky = shade->of_sky;
  light->path = shade->path;
  memcpy(light->cone_axis, shade->cone.axis, sizeof light->cone_axis);
  light->wide_parallel = shade->parallel_row >= 0;
  light->cap_count = shade->caps.count;
  memcpy(light->caps, shade->caps.cap, sizeof light->caps);
  light->cone_outer = shade->cone.outer;
  light->cone_scale = shade->cone.scale;
  light->sector_count = shade->sector.count;
  light->sector = shade->sector.sector;
  memcpy(light->sector_axis, shade->sector.axis, sizeof light->sector_axis);
  light->sector_least = shade->sector.least;
}

/* The rows and caps of a volume's phase table that a sweep reads. */
static gpu_phases phases_of(const sweep_constants *constants, int volume, int lights) {
  const phase_table *table = constants->volumes[volume].phase_once;
  gpu_phases phases = {0};
  if (table == NULL) return phases;
  bool caps = constants->shade.sky != NULL;
  for (int i = 0; i < lights; i++) {
    const shade_light *light = &constants->lights[i];
    if (light->parallel_row >= 0) phases.rows[i] = table->parallel[light->parallel_row];
    caps = caps || light->caps.count > 0;
  }
  if (caps) phases.caps = &table->caps[0][0][0];
  return phases;
}

/* The data from which a sweep is described for a device. */
typedef struct sweep_task {
  const frame_plan *frame_plan;
  const sweep_plan *plan;
  const sweep_constants *constants;
} sweep_task;

/* Finds the first slab that a light's shadows reach. */
static int first_reached(const sheet_stack *sheets, const light_shadow *shadow) {
  int slab = 1;
  while (slab < sheets->count && !hl_is_reached(sheets, shadow, slab)) slab++;
  return slab;
}

static void plan_box_rays(const view *view, const sweep_task *task, const grid *grid, plan_box *box) {
  const sheet_stack *sheets = &task->plan->geometry->sheets;
  box_rays rays;
  hl_box_rays(view, sheets->normal, sheets->first, grid->frame_to_index, grid->box_low, grid->box_high,
              &rays);
  memcpy(box, &rays, sizeof *box);
}

/* Finds the box around everything visible. It is one voxel larger on each side, because of rounding. */
static void plan_content(const view *view, const sweep_task *task, const grid *grid, plan_box *box) {
  const sheet_stack *sheets = &task->plan->geometry->sheets;
  double low[3], high[3];
  box_rays rays;
  if (!hl_relevant_bounds(grid, GRID_MARGIN, low, high)) return;
  for (int axis = 0; axis < 3; axis++) {
    low[axis] -= 1;
    high[axis] += 1;
  }
  hl_box_rays(view, sheets->normal, sheets->first, grid->frame_to_index, low, high, &rays);
  memcpy(box, &rays, sizeof *box);
}

/* Finds a margin. Samples that are closer to a face than the margin count as near the face. The margin is
 * measured along an axis of the box or of a cut's shape. row: the gradient of the coordinate along this axis,
 * in frame space. Derived: on the sheet, one pixel of a parallel light's buffer along u is (grad v x h) /
 * (grad u . (grad v x h)), where h is the sheets' normal. The step along v has the same form, with u and v
 * exchanged. The pixels around a sample are at most one such step away, and a face matters up to twice this
 * distance. The light's way through the slab is as long as its path. The margin is a little larger because of
 * rounding. The pixels of a near light grow with distance, so for such a light all samples count as near a
 * face. */
static float margin_along(const sweep_task *task, const grid *grid, int index, double way, vec3 row) {
  const sheet_stack *sheets = &task->plan->geometry->sheets;
  const light_source *source = task->plan->lights[index].source;
  double rows[3][4];
  const light_shadow *shadow = &task->plan->lights[index].shadow;
  view view = shadow->plan.view;
  if (hl_has_sublights(shadow)) hl_sublight_view(shadow, 0, &view);
  hl_view_homogeneous(&view, affine3_identity(), rows);
  const vec3 u = {rows[1][0], rows[1][1], rows[1][2]}, v = {rows[2][0], rows[2][1], rows[2][2]};
  vec3 along_u = vec3_cross(v, sheets->normal), along_v = vec3_cross(sheets->normal, u);
  double rise = vec3_dot(u, along_u), pixels = fabs(vec3_dot(row, along_u)) + fabs(vec3_dot(row, along_v));
  double least = 0.01 * hl_smallest_edge(grid) * vec3_length(row);
  if (!source->parallel || !(fabs(rise) > 1e-9 * (vec3_length(along_u) + vec3_length(along_v)))) return 1e30f;
  return (float)(2.05 * pixels / fabs(rise) + 1.05 * fabs(vec3_dot(row, source->direction)) * way + least);
}

/* Describes a volume in the view of a light. */
static void plan_bounds_of_light(const sweep_task *task, const grid *grid, int index, plan_bounds *bounds) {
  const view *view = &task->plan->lights[index].shadow.plan.view;
  plan_box_rays(view, task, grid, &bounds->box);
  plan_content(view, task, grid, &bounds->content);
  for (int axis = 0; axis < 3; axis++)
    bounds->margin[axis] = margin_along(task, grid, index, (double)task->constants->lights[index].path,
                                        grid->frame_to_index.linear.row[axis]);
}

static hl_status plan_all_bounds(hl_context *context, const sweep_task *task, planned_sweep *planned,
                                 hl_error *error) {
  const plan_volumes *volumes = &task->frame_plan->volumes;
  const int lights = task->plan->geometry->light_count;
  const size_t count = (1 + (size_t)lights) * (size_t)volumes->count;
  plan_bounds *bounds = planned->bounds = hl_allocate_zeroed(context, count, sizeof *bounds);
  if (bounds == NULL) return hl_fail_memory(error, count * sizeof *bounds, "the bounds of volumes");
  for (int v = 0; v < volumes->count; v++) {
    const grid *grid = &volumes->grids[v];
    plan_box_rays(&task->frame_plan->frame.eye, task, grid, &bounds[v].box);
    plan_content(&task->frame_plan->frame.eye, task, grid, &bounds[v].content);
    for (int i = 0; i < lights; i++)
      if (task->plan->lights[i].shadow.method != NULL)
        plan_bounds_of_light(task, grid, i, &bounds[(1 + i) * volumes->count + v]);
  }
  planned->sweep.bounds = bounds;
  return HL_OK;
}

/* ---- the cuts ---- */

/* Describes a volume's cuts for one view. light: the light to which the view belongs; -1: the eye's view. */
static void plan_cuts_of_view(const sweep_task *task, int volume, const view *view, int light,
                              plan_cut *cuts) {
  const grid *grid = &task->frame_plan->volumes.grids[volume];
  const shade_volume *shade = &task->constants->volumes[volume];
  for (int i = 0; i < shade->cut_count; i++) {
    const affine3 to_shape = affine3_multiply(grid->cuts[i].to_shape, grid->frame_to_index);
    plan_cut *cut = &cuts[i];
    run_cut in_view;
    box_rays rays;
    hl_view_cut(view, &task->plan->geometry->sheets, grid, &grid->cuts[i], &in_view, &rays);
    cut->shape = shade->cuts[i].type;
    cut->keep_inside = shade->cuts[i].keep_inside;
    memcpy(cut->rows, shade->cuts[i].rows, sizeof cut->rows);
    memcpy(cut->in_index, in_view.rows, sizeof cut->in_index);
    memcpy(&cut->rays, &rays, sizeof cut->rays);
    for (int axis = 0; axis < 3; axis++) {
      cut->scale[axis] = 1.0f / (in_view.size[axis] * shade->voxel);
      if (light < 0) continue;
      cut->margin[axis] = margin_along(task, grid, light, (double)task->constants->lights[light].path,
                                       to_shape.linear.row[axis]);
    }
  }
}

/* Describes the cuts of all volumes for one view. */
static void plan_all_cuts_of_view(const sweep_task *task, const planned_sweep *planned, const view *view,
                                  int light, plan_cut *cuts) {
  for (int v = 0; v < task->frame_plan->volumes.count; v++)
    plan_cuts_of_view(task, v, view, light, cuts + planned->volumes[v].first_cut);
}

static hl_status plan_cuts(hl_context *context, const sweep_task *task, planned_sweep *planned,
                           hl_error *error) {
  const int lights = task->plan->geometry->light_count;
  int own = 0;
  for (int v = 0; v < task->frame_plan->volumes.count; v++) own += task->constants->volumes[v].cut_count;
  const size_t count = (1 + (size_t)lights) * (size_t)own;
  if (own == 0) return HL_OK;
  planned->cuts = hl_allocate_zeroed(context, count, sizeof *planned->cuts);
  if (planned->cuts == NULL) return hl_fail_memory(error, count * sizeof *planned->cuts, "the cuts");
  plan_all_cuts_of_view(task, planned, &task->frame_plan->frame.eye, -1, planned->cuts);
  for (int i = 0; i < lights; i++) {
    const light_shadow *shadow = &task->plan->lights[i].shadow;
    plan_light *light = &planned->plan.lights[i];
    light->first_cut = (1 + i) * own;
    if (shadow->method != NULL)
      plan_all_cuts_of_view(task, planned, &shadow->plan.view, i, planned->cuts + light->first_cut);
  }
  planned->sweep.cuts = planned->cuts;
  planned->sweep.cut_count = count;
  return HL_OK;
}

/* Returns whether the shadows of any light are of a kind. */
static bool any_light(const sweep_task *task, bool (*is_of_kind)(const light_shadow *shadow)) {
  for (int i = 0; i < task->plan->geometry->light_count; i++)
    if (is_of_kind(&task->plan->lights[i].shadow)) return true;
  return false;
}

/* Returns whether the shadows of any light are made in chunks. */
static bool has_soft_lights(const sweep_task *task) { return any_light(task, hl_is_chunked); }

/* The number of planes of one sheet of a light's buffer. The transmittance has one plane for each channel.
 * The light at the outside of surfaces has one plane for each channel, too, if it is kept. So does the older
 * light from which samples of soft lights fade. */
static size_t planes_of_sheet(const sweep_task *task, const light_shadow *shadow) {
  const size_t kinds = 1 + (shadow->plan.outside ? 1u : 0) + (has_soft_lights(task) ? 1u : 0);
  return (size_t)task->frame_plan->channels * kinds;
}

/* Describes a light's buffer. *floats: the number of floats before the buffer's planes; it is raised by the
 * number of floats of these planes. */
static void plan_buffer(const sweep_task *task, int index, int ring, size_t *floats, int *tiles,
                        plan_light *light) {
  const light_shadow *shadow = &task->plan->lights[index].shadow;
  const view *view = &shadow->plan.view;
  shadow_buffer buffer = {0};
  hl_shadow_buffer_measure(view, shadow->plan.reach, &buffer);
  const shadow_map map = hl_map_of_view(view);
  light->soft = hl_is_chunked(shadow);
  light->width = view->width;
  light->height = view->height;
  light->tiles_x = buffer.tiles_x;
  light->tiles = buffer.tiles_x * buffer.tiles_y;
  light->first_tile = *tiles;
  light->first_slab = first_reached(&task->plan->geometry->sheets, shadow);
  light->stride = (int)buffer.stride;
  light->plane = (int)buffer.plane;
  light->origin = (int)buffer.origin;
  light->planes = (unsigned)(*floats / 16);
  memcpy(light->map, map.rows, sizeof light->map);
  light->slab_path = task->constants->attenuate[index].path;
  memcpy(light->through, task->constants->attenuate[index].through, sizeof light->through);
  *tiles += light->tiles;
  *floats += ((size_t)ring * planes_of_sheet(task, shadow) * buffer.plane + 15) / 16 * 16;
}

/* PLANES_BYTES: the greatest number of bytes that the planes of all lights take together. SLOTS_BYTES: the
 * greatest number of bytes that the picture's slots of a run of slabs take. */
static const size_t PLANES_BYTES = (size_t)1 << 30, SLOTS_BYTES = (size_t)1 << 30;
enum { SLABS_OF_RUN = 32 /* one bit for each slab */, SLOT_BYTES = 40 };

/* The bytes of a slot for each pixel and slab. Slots of more than two volumes hold two floats for each. */
static size_t slot_bytes(const sweep_task *task) {
  const size_t volumes = (size_t)task->frame_plan->volumes.count;
  return SLOT_BYTES + (volumes > 2 ? 2 * (volumes - 2) * 2 * sizeof(float) : 0);
}

static size_t bytes_of_sheet(const sweep_task *task) {
  size_t bytes = 0;
  for (int i = 0; i < task->plan->geometry->light_count; i++) {
    const light_shadow *shadow = &task->plan->lights[i].shadow;
    if (shadow->method == NULL) continue;
    const size_t planes = planes_of_sheet(task, shadow);
    bytes += planes * hl_shadow_plane(&shadow->plan.view, shadow->plan.reach) * sizeof(float);
    if (hl_has_sublights(shadow)) bytes += hl_device_sublight_bytes(shadow, planes);
  }
  return bytes;
}

static int slabs_of_run(const sweep_task *task) {
  const int wanted = task->frame_plan->settings.slabs_at_once;
  int slabs = wanted > 0 ? wanted : SLABS_OF_RUN;
  const size_t sheet = bytes_of_sheet(task),
               slots = task->frame_plan->picture.tiles * TILE_PIXELS * slot_bytes(task);
  if (slabs > SLABS_OF_RUN) slabs = SLABS_OF_RUN;
  if (slabs > LIT_SLABS && any_light(task, hl_has_sublights)) slabs = LIT_SLABS;
  while (slabs > 1 && (size_t)slabs * slots > SLOTS_BYTES) slabs--;
  while (slabs > 1 && (2 * (size_t)slabs + 1) * sheet > PLANES_BYTES) slabs--;
  return slabs;
}

/* ---- the rays ---- */

static void plan_rays_of(const view *view, const sheet_stack *sheets, double height, affine3 from_frame,
                         int sheet, plan_rays *rays) {
  sheet_rays found;
  hl_view_sheet_rays(view, sheets->normal, height, from_frame, &found);
  memcpy(rays, &found, sizeof found);
  rays->height = (float)(sheet * sheets->spacing);
}

/* Describes a view's rays for the device. middle: if set, the rays' points lie in the middle of the slab
 * before each sheet, else on the sheet. */
static void plan_view(const view *view, const sheet_stack *sheets, affine3 from_frame, bool middle,
                      plan_rays *rays) {
  for (int sheet = 0; sheet < sheets->count; sheet++)
    plan_rays_of(view, sheets, hl_sheet_height(sheets, sheet) - (middle ? 0.5 * sheets->spacing : 0),
                 from_frame, sheet, &rays[sheet]);
}

/* Describes the rays of all views: first the rays in the first volume's index space and in frame space, for
 * each view, then the rays in the index spaces of the other volumes, for each volume and view. */
static hl_status plan_all_rays(hl_context *context, const sweep_task *task, planned_sweep *planned,
                               hl_error *error) {
  const sheet_stack *sheets = &task->plan->geometry->sheets;
  const plan_volumes *volumes = &task->frame_plan->volumes;
  const size_t views = 1 + (size_t)task->plan->geometry->light_count,
               sets = views * (1 + (size_t)volumes->count), length = (size_t)sheets->count;
  plan_rays *rays = planned->rays = hl_allocate_zeroed(context, sets * length, sizeof *planned->rays);
  if (rays == NULL) return hl_fail_memory(error, sets * length * sizeof *planned->rays, "the rays");
  planned->sweep.rays = rays;
  planned->sweep.ray_sets = sets;
  for (size_t i = 0; i < views; i++) {
    const light_shadow *shadow = i == 0 ? NULL : &task->plan->lights[i - 1].shadow;
    if (shadow != NULL && shadow->method == NULL) continue;
    const view *view = i == 0 ? &task->frame_plan->frame.eye : &shadow->plan.view;
    plan_view(view, sheets, volumes->grids[0].frame_to_index, false, rays + 2 * i * length);
    plan_view(view, sheets, affine3_identity(), i == 0, rays + (2 * i + 1) * length);
    for (size_t v = 1; v < (size_t)volumes->count; v++)
      plan_view(view, sheets, volumes->grids[v].frame_to_index, false, rays + ((1 + v) * views + i) * length);
  }
  return HL_OK;
}

/* ---- the sweep ---- */

/* Returns whether the lights' buffers keep the light at the outside of surfaces. Either all of them do, or
 * none does. */
static bool keeps_outside(const sweep_task *task) {
  for (int i = 0; i < task->plan->geometry->light_count; i++)
    if (task->plan->lights[i].shadow.method != NULL && task->plan->lights[i].shadow.plan.outside) return true;
  return false;
}

/* Sets a variant's members that are properties of volumes, which some volume has. */
static void add_volume(const sweep_constants *constants, int index, plan_variant *variant) {
  const shade_volume *shade = &constants->volumes[index];
  const grid *grid = shade->grid;
  variant->storage = hl_device_storage(grid);
  variant->bricks |= grid->bricks != NULL;
  variant->phong |= shade->phong;
  variant->lit |= shade->lit;
  variant->boxed |= grid->cut;
  variant->cuts |= shade->cut_count > 0;
  variant->phases |= shade->phase_once != NULL;
  variant->maximum |= shade->shown != NULL;
  variant->colored |= shade->colors.voxels != NULL;
  variant->steep |= shade->classifier->steepness != NULL;
  variant->plane |= shade->classifier->plane.sums != NULL;
  variant->masked |= shade->classifier->mask.factors != NULL;
}

static plan_variant variant_of(const sweep_task *task, const device_sweep *plan) {
  const plan_volumes *volumes = &task->frame_plan->volumes;
  plan_variant variant = {.volumes = volumes->count,
                          .bspline = volumes->kernel->degree == HL_BSPLINE_DEGREE,
                          .eye_perspective = task->frame_plan->frame.eye.perspective,
                          .shadowed = plan->light_tiles > 0,
                          .outside = keeps_outside(task),
                          .soft = has_soft_lights(task),
                          .paper = any_light(task, hl_is_convolved),
                          .sublights = any_light(task, hl_has_sublights),
                          .textures = hl_project_images(task->plan),
                          .emissions = any_light(task, hl_weigh_sublights),
                          .sky = task->constants->shade.sky != NULL,
                          .back_to_front = task->plan->geometry->back_to_front,
                          .channels = task->frame_plan->channels};
  for (int v = 0; v < volumes->count; v++) add_volume(task->constants, v, &variant);
  return variant;
}

/* Describes the tables of phase functions that a sweep reads. */
static void plan_phases(const sweep_task *task, planned_sweep *planned) {
  const int lights = task->plan->geometry->light_count;
  size_t floats = 0;
  for (int v = 0; v < task->frame_plan->volumes.count; v++) {
    planned->sweep.phases[v] = phases_of(task->constants, v, lights);
    if (task->constants->volumes[v].phase_once == NULL) continue;
    planned->volumes[v].phases_begin = (unsigned)floats;
    floats += ((size_t)lights + 2 * PLAN_PHASE_CAPS) * PLAN_PHASE_COLUMNS;
  }
}

static hl_status find_constants(hl_context *context, const frame_plan *frame_plan, const sweep_plan *plan,
                                planned_sweep *planned, hl_error *error) {
  hl_layout layout = {0};
  while (hl_layout_pass(&layout, context))
    hl_sweep_constants_lay_out(frame_plan, &planned->constants, &layout);
  planned->memory = layout.base;
  if (layout.base == NULL) return hl_fail_memory(error, layout.bytes, "the device's sweep");
  hl_sweep_constants_find(frame_plan, plan, &planned->constants);
  return HL_OK;
}

hl_status hl_plan_sweep(const sweep_means *means, const frame_plan *frame_plan, const sweep_plan *of,
                        const int32_t *shown_from, planned_sweep *planned, hl_error *error) {
  hl_context *context = means->context;
  const sweep_task sweep = {frame_plan, of, &planned->constants}, *task = &sweep;
  device_sweep *plan = &planned->plan;
  memset(planned, 0, sizeof *planned);
  hl_status status = find_constants(context, frame_plan, of, planned, error);
  if (status != HL_OK) return status;
  const shade_job *job = &planned->constants.shade;
  const shade_volume *shade = &planned->constants.volumes[0];
  const int slabs = slabs_of_run(task);
  plan->sheets = task->plan->geometry->sheets.count;
  plan->ring = 2 * slabs + 1;
  plan->width = task->frame_plan->frame.width;
  plan->height = task->frame_plan->frame.height;
  plan->tiles_x = task->frame_plan->picture.tiles_x;
  plan->tiles = (int)task->frame_plan->picture.tiles;
  plan->light_count = task->plan->geometry->light_count;
  plan->spacing = job->spacing;
  plan->path = job->path;
  memcpy(plan->through, job->through, sizeof plan->through);
  memcpy(plan->towards_eye, job->towards_eye, sizeof plan->towards_eye);
  memcpy(plan->normal, job->normal, sizeof plan->normal);
  memcpy(plan->ambient, job->ambient, sizeof plan->ambient);
  plan->emission = job->emission;
  hl_device_volumes_describe(frame_plan, shade, planned->volumes);
  if (job->sky != NULL) plan_sky_light(job->sky, &plan->sky);
  size_t floats = 0;
  for (int i = 0; i < plan->light_count; i++) {
    plan->lights[i].number = i;
    plan_brightness(&task->constants->lights[i], &plan->lights[i]);
    if (task->plan->lights[i].shadow.method != NULL)
      plan_buffer(task, i, plan->ring, &floats, &plan->light_tiles, &plan->lights[i]);
  }
  planned->sweep = (gpu_sweep){.plan = plan,
                               .volumes = planned->volumes,
                               .variant = variant_of(task, plan),
                               .shown_from = shown_from,
                               .sky = cells_of_sky(job->sky),
                               .shown_values = shade->shown == NULL ? NULL : &shade->shown[0][0],
                               .plane_floats = floats,
                               .slabs = slabs};
  plan_phases(task, planned);
  status = plan_all_bounds(context, task, planned, error);
  if (status == HL_OK) status = plan_all_rays(context, task, planned, error);
  if (status == HL_OK && planned->sweep.variant.soft)
    status = hl_device_cascades_begin(means, frame_plan, of, planned->rays, &planned->cascades,
                                      &planned->sweep, error);
  if (status == HL_OK && planned->sweep.variant.paper)
    status = hl_device_paper_begin(context, of, plan, &planned->passes, &planned->sweep, error);
  if (status == HL_OK && planned->sweep.variant.sublights)
    status = hl_device_sublights_begin(context, of, plan, planned->rays, &planned->sublights,
                                       &planned->passes, &planned->sweep, error);
  if (status == HL_OK && planned->sweep.variant.textures)
    status = hl_device_textures_begin(context, frame_plan, of, &planned->textures, &planned->sweep, error);
  return status == HL_OK ? plan_cuts(context, task, planned, error) : status;
}

void hl_plan_release(hl_context *context, planned_sweep *planned) {
  hl_release(context, planned->memory);
  hl_release(context, planned->bounds);
  hl_release(context, planned->rays);
  hl_release(context, planned->cuts);
  hl_device_cascades_release(&planned->cascades);
  hl_known_passes_release(&planned->passes);
  hl_device_sublights_release(context, &planned->sublights);
  hl_device_textures_release(context, &planned->textures);
  planned->memory = NULL;
  planned->bounds = NULL;
  planned->rays = NULL;
  planned->cuts = NULL;
}
