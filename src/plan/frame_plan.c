/* plan/frame_plan.c - see frame_plan.h. */
#include "plan/frame_plan.h"

#include <string.h>

#include "core/memory.h"

/* ---- memory ---- */

hl_status hl_frame_plan_create(hl_context *context, const framed_scene *framed, frame_plan *plan,
                               hl_error *error) {
  const hl_scene_description *scene = &framed->scene;
  const size_t volumes = scene->volume_count, sources = LIGHT_SECTORS * scene->light_count;
  plan->settings = scene->render;
  plan->picture.width = scene->width;
  plan->picture.height = scene->height;
  plan->unit = framed->unit;
  memcpy(plan->ambient, scene->ambient, sizeof plan->ambient);
  plan->frame.content.points = hl_allocate(context, (volumes + scene->mesh_count) * 8 + 1,
                                           sizeof *plan->frame.content.points);
  plan->frame.lights = hl_allocate(context, sources, sizeof *plan->frame.lights);
  plan->lights = hl_allocate(context, scene->light_count, sizeof *plan->lights);
  plan->meshes = hl_allocate(context, scene->mesh_count, sizeof *plan->meshes);
  plan->volumes.grids = hl_allocate(context, volumes, sizeof *plan->volumes.grids);
  plan->volumes.list = hl_allocate(context, volumes, sizeof *plan->volumes.list);
  plan->sweeps.sheets = hl_allocate_zeroed(context, sources + 1, sizeof *plan->sweeps.sheets);
  if (plan->frame.content.points == NULL || plan->frame.lights == NULL || plan->lights == NULL ||
      plan->meshes == NULL || plan->volumes.grids == NULL || plan->volumes.list == NULL ||
      plan->sweeps.sheets == NULL)
    return hl_fail_memory(error, sources * sizeof *plan->sweeps.sheets, "the frame");
  for (size_t i = 0; i < scene->light_count; i++)
    plan->lights[plan->light_count++] = hl_frame_light(framed, i);
  for (size_t i = 0; i < scene->mesh_count; i++) plan->meshes[plan->mesh_count++] = hl_frame_mesh(framed, i);
  return HL_OK;
}

void hl_frame_plan_release(hl_context *context, frame_plan *plan) {
  for (int i = 0; i < plan->sweeps.light_count && plan->sweeps.lights != NULL; i++) {
    hl_light_shadow_end(&plan->sweeps.lights[i].shadow);
    hl_release(context, plan->sweeps.lights[i].emission);
  }
  hl_release(context, plan->sweeps.lights);
  hl_release(context, plan->sweeps.list);
  hl_release(context, plan->sweeps.sheets);
  hl_release(context, plan->seen);
  hl_release(context, plan->volumes.shown);
  hl_release(context, plan->volumes.list);
  hl_release(context, plan->volumes.grids);
  hl_release(context, plan->meshes);
  hl_release(context, plan->lights);
  hl_release(context, plan->frame.lights);
  hl_release(context, plan->frame.content.points);
  hl_share_release(context, &plan->picture.share);
}

/* ---- the sweeps ---- */

bool hl_layers_measure(const hl_layers *wanted) {
  return wanted != NULL && (wanted->depth_first != NULL || wanted->depth_mean != NULL ||
                            wanted->normal != NULL || wanted->object != NULL);
}

/* Chooses the sweep in which depth and normals are measured: a sweep that goes from front to back for the
 * eye. If no sweep does, the function adds one. */
static int choose_measuring_sweep(const frame *frame, plan_sweeps *sweeps) {
  int chosen = 0;
  while (chosen < sweeps->count && sweeps->sheets[chosen].back_to_front) chosen++;
  if (chosen == sweeps->count) hl_frame_add_eye_sweep(frame, sweeps->sheets, &sweeps->count);
  return chosen;
}

hl_status hl_plan_sweeps(hl_context *context, frame_plan *plan, hl_error *error) {
  plan_sweeps *sweeps = &plan->sweeps;
  int measuring = 0;
  sweeps->count = hl_frame_sweeps(&plan->frame, &plan->settings, sweeps->sheets);
  if (hl_layers_measure(plan->picture.layers)) measuring = choose_measuring_sweep(&plan->frame, sweeps);
  plan->picture.tiles_x = hl_tiles(plan->frame.width);
  plan->picture.tiles = (size_t)plan->picture.tiles_x * (size_t)hl_tiles(plan->frame.height);
  sweeps->list = hl_allocate(context, (size_t)sweeps->count, sizeof *sweeps->list);
  if (sweeps->list == NULL) return hl_fail_memory(error, sizeof *sweeps->list, "the frame");
  for (int s = 0; s < sweeps->count; s++)
    sweeps->list[s] = (sweep_plan){
        .geometry = &sweeps->sheets[s], .adds_even_light = s == 0, .measures = s == measuring};
  return hl_frame_check_sweeps(&plan->frame, sweeps->sheets, sweeps->count, error);
}

/* ---- the lights ---- */

/* Returns whether some volume that the eye sees has surfaces on which shadows fall. */
static bool has_surfaces(const plan_volumes *volumes) {
  for (int v = 0; v < volumes->count; v++) {
    const frame_volume *volume = &volumes->list[v];
    if (volume->visible && volume->receives_shadow && volume->look.shading == HL_SHADING_PHONG) return true;
  }
  return false;
}

/* Returns whether boxes cut inner corners into some volume, where two faces of a cut meet. */
static bool has_inner_corners(const plan_volumes *volumes) {
  for (int v = 0; v < volumes->count; v++) {
    const grid *grid = &volumes->grids[v];
    for (size_t i = 0; i < grid->cut_count; i++)
      if (hl_cut_hollows_out(&grid->cuts[i])) return true;
  }
  return false;
}

static shadow_setup setup_of_light(hl_context *context, const frame_plan *plan, const sweep_plan *sweep,
                                   const light_plan *light) {
  const frame *frame = &plan->frame;
  return (shadow_setup){.context = context,
                        .settings = &plan->settings,
                        .source = light->source,
                        .emission = light->emission == NULL || light->emission->even ? NULL : light->emission,
                        .sheets = &sweep->geometry->sheets,
                        .eye = &frame->eye,
                        .exchange = plan->picture.share.exchange,
                        .surfaces = has_surfaces(&plan->volumes),
                        .inner_corners = has_inner_corners(&plan->volumes),
                        .channels = plan->channels,
                        .voxel = frame->content.voxel,
                        .pixel = frame->pixel,
                        .middle_pixel = frame->middle_pixel,
                        .picture_pixels = (size_t)frame->width * (size_t)frame->height,
                        .seen = plan->seen,
                        .seen_count = plan->seen_count,
                        .content = frame->content.points,
                        .content_count = frame->content.point_count};
}

static hl_status plan_light(hl_context *context, const frame_plan *plan, const sweep_plan *sweep,
                            light_plan *light, hl_error *error) {
  hl_status status = hl_light_emission_create(context, light->source, &light->emission, error);
  if (status != HL_OK) return status;
  const shadow_setup setup = setup_of_light(context, plan, sweep, light);
  status = hl_light_shadow_plan(&light->shadow, &setup, error);
  if (status == HL_OK && light->shadow.method != NULL) light->memory = hl_light_shadow_count(&light->shadow);
  return status;
}

static hl_status find_seen(hl_context *context, frame_plan *plan, hl_error *error) {
  const size_t boxes = (size_t)plan->frame.content.point_count / 8;
  plan->seen = hl_allocate(context, boxes * CONTENT_POINTS + 1, sizeof *plan->seen);
  if (plan->seen == NULL) return hl_fail_memory(error, sizeof *plan->seen, "the content's corners");
  plan->seen_count = hl_frame_visible_points(&plan->frame, plan->seen);
  return HL_OK;
}

hl_status hl_plan_lights(hl_context *context, frame_plan *plan, hl_error *error) {
  plan_sweeps *sweeps = &plan->sweeps;
  for (int s = 0; s < sweeps->count; s++) sweeps->light_count += sweeps->sheets[s].light_count;
  sweeps->lights = hl_allocate_zeroed(context, (size_t)sweeps->light_count, sizeof *sweeps->lights);
  if (sweeps->lights == NULL) return hl_fail_memory(error, sizeof *sweeps->lights, "the lights");
  light_plan *next = sweeps->lights;
  hl_status status = find_seen(context, plan, error);
  for (int s = 0; s < sweeps->count && status == HL_OK; s++) {
    sweep_plan *sweep = &sweeps->list[s];
    sweep->lights = next;
    for (int i = 0; i < sweep->geometry->light_count && status == HL_OK; i++, next++) {
      next->source = &plan->frame.lights[sweep->geometry->light[i]];
      status = plan_light(context, plan, sweep, next, error);
    }
  }
  return status;
}
