/* render/plan_frame.c - see plan_frame.h. */
#include "render/plan_frame.h"

#include <math.h>

#include "core/context.h"
#include "core/memory.h"
#include "core/sheet_constants.h"
#include "grid/relevant.h"
#include "render/late/late_surfaces.h"
#include "render/maximum.h"
#include "surface/place_surfaces.h"

/* ---- volumes and surfaces ---- */

/* Returns whether a position lies in a volume's box. The rays of an eye or a light at such a position begin
 * within the box. */
static bool inside_box(const grid *grid, vec3 origin) {
  vec3 p = affine3_apply(grid->frame_to_index, origin);
  const double at[3] = {p.x, p.y, p.z};
  for (int axis = 0; axis < 3; axis++)
    if (at[axis] < grid->box_low[axis] || at[axis] > grid->box_high[axis]) return false;
  return true;
}

static bool rays_start_inside(const frame *frame, const grid *grid) {
  bool inside = frame->eye.perspective && inside_box(grid, frame->eye.origin);
  for (int i = 0; i < frame->light_count; i++) {
    const light_source *light = &frame->lights[i];
    inside = inside ||
             (light->shadows != HL_SHADOWS_OFF && !light->parallel && inside_box(grid, light->position));
  }
  return inside;
}

/* Opens the faces at which volumes touch each other (hl_open_faces). It changes only the frame's copies of
 * the grids. */
static void open_faces(const hl_scene_description *scene, grid *grids) {
  for (size_t i = 0; i < scene->volume_count; i++)
    for (size_t k = 0; k < scene->volume_count; k++)
      if (k != i && scene->volumes[k].casts_shadow) hl_open_faces(&grids[i], &grids[k]);
}

/* Brings the meshes to frame space, and adds their boxes to the content. */
static hl_status add_surfaces(hl_renderer *renderer, const framed_scene *framed, frame *frame,
                              hl_error *error) {
  const hl_scene_description *scene = &framed->scene;
  if (!hl_surfaces_current(&renderer->cache.surfaces, scene)) {
    hl_surface_tree_release(renderer->context, &renderer->cache.contact);
    hl_surfaces_release(renderer->context, &renderer->cache.surfaces);
  }
  hl_layout counted = {0};
  hl_status status = HL_OK;
  if (renderer->cache.surfaces.mesh_count == 0) status = hl_surfaces_count_memory(scene, &counted, error);
  if (status == HL_OK) status = hl_renderer_check_room(renderer, counted.most, error);
  if (status == HL_OK)
    status = hl_surfaces_update(renderer->context, renderer->pool, scene, &renderer->cache.surfaces, error);
  if (status != HL_OK || scene->mesh_count == 0) return status;
  for (size_t i = 0; i < scene->mesh_count; i++, frame->content.point_count += 8)
    hl_surface_corners(&renderer->cache.surfaces.meshes[i], frame->content.voxel,
                       frame->content.points + frame->content.point_count);
  frame->surfaces = &renderer->cache.surfaces;
  frame->contact = &renderer->cache.contact;
  return HL_OK;
}

/* The grid of a volume as the frame uses it. A volume that is neither visible nor casts shadows may still be
 * needed, because its values may be the second number of another volume's transfer function. The grid of such
 * a volume gets no relevant bricks, so that no densities are found for it. */
static grid grid_of_frame(const hl_scene_volume *volume, const prepared_volume *prepared) {
  grid grid = prepared->grid;
  if (!volume->visible && !volume->casts_shadow) grid.relevant_count = 0;
  return grid;
}

/* Brings up to date the tree of surfaces with which the light close behind surfaces is corrected. Call it
 * after the frame's lights are placed. */
static hl_status update_contact(hl_renderer *renderer, const frame *frame, hl_error *error) {
  surface_tree *tree = &renderer->cache.contact;
  double distance = hl_contact_distance(frame);
  bool shadows = false;
  for (int i = 0; i < frame->light_count; i++) shadows |= frame->lights[i].shadows != HL_SHADOWS_OFF;
  if (!shadows || frame->surfaces == NULL ||
      hl_surface_tree_current(tree, &renderer->cache.surfaces, distance))
    return HL_OK;
  hl_surface_tree_release(renderer->context, tree);
  hl_layout counted = {0};
  hl_surface_tree_count(&renderer->cache.surfaces, distance, &counted);
  hl_status status = hl_renderer_check_room(renderer, counted.most, error);
  if (status != HL_OK) return status;
  return hl_surface_tree_create(renderer->context, &renderer->cache.surfaces, distance, tree, error);
}

/* ---- light ---- */

/* The number of channels in which light is attenuated. It is three if matter absorbs the three colours
 * differently, or if the colours of an emission image come from different places. Otherwise it is one. */
static int attenuation_channels(const frame_plan *plan) {
  for (int i = 0; i < plan->light_count; i++)
    if (plan->lights[i].has_colored_image) return 3;
  for (int i = 0; i < plan->volumes.count; i++)
    if (plan->volumes.list[i].casts_shadow && !hl_is_grey(plan->volumes.list[i].look.attenuation_color))
      return 3;
  for (int i = 0; i < plan->mesh_count; i++)
    if (plan->meshes[i].look.casts_shadow && !hl_is_grey(plan->meshes[i].look.attenuation_color)) return 3;
  return 1;
}

/* Computes the light that is scattered more than once, where the scene asks for it. */
static hl_status scatter_light(hl_renderer *renderer, const framed_scene *framed, const frame_plan *plan,
                               uint64_t sky_mark, hl_error *error) {
  const hl_scene_description *scene = &framed->scene;
  hl_context *context = renderer->context;
  if (!plan->fields.scatters) {
    hl_scatter_release(context, &renderer->cache.scattered);
    return HL_OK;
  }
  scatter_volume *volumes = hl_allocate(context, scene->volume_count, sizeof *volumes);
  if (volumes == NULL) return hl_fail_memory(error, scene->volume_count * sizeof *volumes, "the volumes");
  for (size_t v = 0; v < scene->volume_count; v++)
    volumes[v] = (scatter_volume){&scene->volumes[v], framed->plane_marks[v], &plan->volumes.grids[v],
                                  &renderer->cache.prepared[v].classifier};
  const scatter_scene all = {context,  renderer->pool,      scene, framed->sun_parts, volumes,
                             sky_mark, plan->frame.surfaces};
  hl_layout counted = {0};
  hl_scatter_count(&all, &counted);
  hl_status status = hl_renderer_check_room(renderer, counted.most, error);
  if (status == HL_OK) status = hl_scatter_update(&all, &renderer->cache.scattered, error);
  hl_release(context, volumes);
  return status;
}

static hl_status check_sky_room(void *data, uint64_t bytes, hl_error *error) {
  return hl_renderer_check_room(data, bytes, error);
}

static hl_status update_sky(hl_renderer *renderer, const hl_scene_description *scene, const frame_plan *plan,
                            uint64_t mark, hl_error *error) {
  const frame_sky of = {scene, renderer->cache.prepared,    plan->volumes.grids, &plan->frame,
                        mark,  plan->picture.share.exchange};
  const hot_functions *hot = hl_hot_functions(renderer->context->options.instruction_set);
  return hl_frame_sky_update(renderer->context, renderer->pool, hot, &of,
                             &(sky_room){check_sky_room, renderer}, &renderer->cache.sky, error);
}

static hl_status update_phases(hl_renderer *renderer, const hl_scene_description *scene, hl_error *error) {
  hl_layout counted = {0};
  hl_phase_count(scene, &counted);
  uint64_t bytes = counted.bytes, held = renderer->cache.phases.bytes;
  hl_status status = bytes > held ? hl_renderer_check_room(renderer, bytes - held, error) : HL_OK;
  if (status != HL_OK) return status;
  return hl_phase_update(renderer->context, renderer->pool, scene, &renderer->cache.phases, error);
}

/* ---- the plan ---- */

/* Brings the volumes to the frame: their grids, and the corners of their visible parts. The frame's grid
 * differs from the prepared grid if no densities are found for it, and at faces where volumes touch. */
static void place_volumes(const hl_renderer *renderer, const framed_scene *framed, frame_plan *plan) {
  const hl_scene_description *scene = &framed->scene;
  plan_volumes *volumes = &plan->volumes;
  frame *frame = &plan->frame;
  volumes->count = (int)scene->volume_count;
  volumes->kernel = hl_kernel_get(scene->render.kernel);
  volumes->splat = scene->render.reconstruction == HL_RECONSTRUCTION_SPLAT;
  for (size_t i = 0; i < scene->volume_count; i++) {
    const prepared_volume *prepared = &renderer->cache.prepared[i];
    volumes->grids[i] = grid_of_frame(&scene->volumes[i], prepared);
    volumes->list[i] = hl_frame_volume(framed, i);
    volumes->list[i].classifier = &prepared->classifier;
    volumes->list[i].empty = prepared->empty;
    volumes->list[i].version = prepared->version;
    volumes->list[i].tables_version = prepared->tables_version;
    if (volumes->grids[i].relevant_count == 0) continue;
    hl_frame_content(&volumes->grids[i], frame->content.points + frame->content.point_count);
    frame->content.point_count += 8;
  }
  open_faces(scene, volumes->grids);
  frame->content.voxel = hl_scene_smallest_edge(scene);
}

/* Finds the values that volumes show, which a maximum projection needs. */
static hl_status find_shown_values(hl_context *context, const framed_scene *framed, plan_volumes *volumes,
                                   hl_error *error) {
  const hl_scene_description *scene = &framed->scene;
  if (!hl_is_maximum(&scene->render)) return HL_OK;
  volumes->shown = hl_allocate(context, scene->volume_count, sizeof *volumes->shown);
  if (volumes->shown == NULL)
    return hl_fail_memory(error, scene->volume_count * sizeof *volumes->shown, "a maximum projection");
  for (size_t i = 0; i < scene->volume_count; i++)
    if (scene->volumes[i].visible)
      hl_shown_values_fill(&scene->volumes[i].transfer_function, &volumes->list[i], &volumes->grids[i],
                           volumes->shown[i]);
  return HL_OK;
}

/* Places the eye and the lights in frame space. */
static hl_status place_eye_and_lights(const framed_scene *framed, frame_plan *plan, hl_error *error) {
  const hl_scene_description *scene = &framed->scene;
  frame *frame = &plan->frame;
  hl_status status = hl_frame_set_up_eye(frame, scene, error);
  if (status != HL_OK) return status;
  /* The spacing is at most the distance by which volumes continue beyond their faces */
  frame->spacing = fmin(scene->render.sheet_spacing,
                        hl_is_maximum(&scene->render) ? MAXIMUM_SPACING : GRID_MARGIN) *
                   frame->content.voxel;
  hl_frame_set_up_lights(frame, framed);
  for (int i = 0; i < plan->volumes.count; i++)
    if (rays_start_inside(frame, &plan->volumes.grids[i])) plan->volumes.grids[i].cut = true;
  plan->channels = attenuation_channels(plan);
  return HL_OK;
}

/* Finds the part of the picture that this renderer makes. */
static hl_status share_picture(hl_renderer *renderer, frame_plan *plan, hl_error *error) {
  const share_content content = {&plan->frame, plan->lights, plan->volumes.grids, plan->volumes.count,
                                 &plan->sweeps.sheets[0].sheets};
  hl_layout counted = {0};
  plan->picture.share = (picture_share){
      .part = renderer->part,
      .parts = renderer->parts,
      .exchange = renderer->exchange.gather != NULL ? &renderer->exchange : NULL};
  hl_share_count(plan->picture.width, plan->picture.height, renderer->parts, &counted);
  hl_status status = hl_renderer_check_room(renderer, counted.most, error);
  return status == HL_OK ? hl_share_create(renderer->context, &content, &plan->picture.share, error) : status;
}

/* Finds the light that does not travel from sheet to sheet: light scattered more than once, and the sky's
 * light. Also finds the tables of phase functions. */
static hl_status find_fields(hl_renderer *renderer, const framed_scene *framed, uint64_t sky_mark,
                             frame_plan *plan, hl_error *error) {
  const hl_scene_description *scene = &framed->scene;
  plan->fields.scatters = hl_scatter_wanted(scene);
  hl_status status = scatter_light(renderer, framed, plan, sky_mark, error);
  if (status == HL_OK) status = update_sky(renderer, scene, plan, sky_mark, error);
  if (status == HL_OK) status = update_phases(renderer, scene, error);
  plan->fields.scattered = renderer->cache.scattered.light != NULL ? &renderer->cache.scattered : NULL;
  plan->fields.sky = renderer->cache.sky.light.cells != NULL ? &renderer->cache.sky.light : NULL;
  plan->fields.phases = &renderer->cache.phases;
  return status;
}

hl_status hl_plan_frame(hl_renderer *renderer, const framed_scene *framed, const frame_request *request,
                        frame_plan *plan, hl_error *error) {
  hl_context *context = renderer->context;
  plan->picture.layers = request->layers;
  hl_status status = hl_frame_plan_create(context, framed, plan, error);
  if (status != HL_OK) return status;
  place_volumes(renderer, framed, plan);
  status = find_shown_values(context, framed, &plan->volumes, error);
  if (status == HL_OK) status = add_surfaces(renderer, framed, &plan->frame, error);
  if (status == HL_OK) status = place_eye_and_lights(framed, plan, error);
  if (status == HL_OK) status = update_contact(renderer, &plan->frame, error);
  if (status == HL_OK) status = hl_plan_sweeps(context, plan, error);
  if (status == HL_OK) status = share_picture(renderer, plan, error);
  if (status == HL_OK) status = find_fields(renderer, framed, request->scene->sky_mark, plan, error);
  return status == HL_OK ? hl_plan_lights(context, plan, error) : status;
}
