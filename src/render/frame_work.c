/* render/frame_work.c - see frame_work.h. */
#include "render/frame_work.h"

#include "core/context.h"
#include "core/memory.h"
#include "grid/relevant.h"
#include "render/contact.h"
#include "render/estimate.h"
#include "surface/place_surfaces.h"

hl_status hl_renderer_check_room(hl_renderer *renderer, uint64_t bytes, hl_error *error) {
  uint64_t limit = renderer->context->options.memory_limit;
  if (limit != 0 && hl_context_memory_held(renderer->context) + bytes > limit)
    hl_reserve_drop_idle(&renderer->reserve);
  hl_status status = hl_check_room(renderer->context, bytes, &renderer->estimate, error);
  for (size_t v = 0; v < renderer->prepared_count && status == HL_OK; v++)
    if (renderer->prepared[v].grid.pages != NULL)
      hl_pages_leave_room(renderer->prepared[v].grid.pages, bytes);
  return status;
}

void hl_frame_work_release(hl_renderer *renderer, frame_work *work) {
  hl_context *context = renderer->context;
  hl_framed_scene_release(context, &work->framed);
  hl_release(context, work->frame.points);
  hl_release(context, work->frame.lights);
  hl_release(context, work->grids);
  hl_release(context, work->sweeps);
  if (!work->in_place) hl_reserve_return(&renderer->reserve, work->pixels);
  hl_release(context, work->tile_rows);
  hl_layer_pixels_release(context, &work->layers);
  hl_maximum_release(context, &work->maximum);
  hl_share_release(context, &work->share);
}

/* Whether a position lies in a volume's box: rays of an eye or a light there begin within it. */
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

/* Depth and normals are measured in a sweep that goes front to back for the eye; adds one if there is none.
 */
static void choose_measuring_sweep(frame_work *work) {
  while (work->measuring_sweep < work->sweep_count && work->sweeps[work->measuring_sweep].back_to_front)
    work->measuring_sweep++;
  if (work->measuring_sweep == work->sweep_count)
    hl_frame_add_eye_sweep(&work->frame, work->sweeps, &work->sweep_count);
}

/* Pixels of the frame's own, or rows of tiles beside the caller's pixels. */
static void lay_out_pixels(const hl_renderer *renderer, frame_work *work, hl_layout *layout) {
  size_t floats = TILE_PIXELS * 4 * sizeof(float), threads = (size_t)hl_pool_threads(renderer->pool);
  if (work->in_place) work->tile_rows = hl_layout_take(layout, threads * work->tiles_x, floats);
  else work->pixels = hl_layout_take(layout, (size_t)work->sweep_count * work->tiles, floats);
}

static void count_pixels(const hl_renderer *renderer, const hl_scene_description *scene,
                         const frame_request *request, frame_work *work, hl_layout *layout) {
  lay_out_pixels(renderer, work, layout);
  hl_layer_pixels_count(request->layers, &work->frame, work->tiles, layout);
  hl_maximum_count(scene, work->tiles, layout);
}

static hl_status take_pixels(hl_renderer *renderer, const frame_request *request, frame_work *work,
                             hl_error *error) {
  hl_layout counted = {0};
  lay_out_pixels(renderer, work, &counted);
  hl_layout handed = {.base = work->in_place ? hl_allocate(renderer->context, counted.bytes, 1)
                                             : hl_reserve_take(&renderer->reserve, counted.bytes, 1)};
  if (handed.base == NULL) return hl_fail_memory(error, counted.bytes, "the picture");
  lay_out_pixels(renderer, work, &handed);
  if (work->in_place) work->pixels = request->pixels;
  return HL_OK;
}

/* Chooses the memory that sweeps composite into: the caller's pixels where one sweep fills them exactly, in
 * whole tiles; else a block of the reserve. */
static hl_status place_pixels(hl_renderer *renderer, const hl_scene_description *scene,
                              const frame_request *request, frame_work *work, hl_error *error) {
  hl_context *context = renderer->context;
  size_t floats = (size_t)work->sweep_count * work->tiles * TILE_PIXELS * 4;
  bool whole = scene->width % TILE == 0 && scene->height % TILE == 0 &&
               request->row_stride == 4 * (size_t)scene->width;
  work->in_place = whole && work->sweep_count == 1 && work->frame.oversampling == 1 &&
                   (uintptr_t)request->pixels % 64 == 0;
  hl_layout counted = {0};
  hl_share_count(scene->width, scene->height, renderer->parts, &counted);
  count_pixels(renderer, scene, request, work, &counted);
  /* the blocks that one of several sweeps returns rarely fit the next one */
  renderer->reserve.keeps = work->sweep_count == 1;
  if (!renderer->reserve.keeps) hl_reserve_release(&renderer->reserve);
  hl_status status = hl_renderer_check_room(renderer, counted.most, error);
  if (status == HL_OK) status = take_pixels(renderer, request, work, error);
  if (status != HL_OK) return status;
  hl_pool_clear(renderer->pool, work->pixels, floats * sizeof *work->pixels);
  return hl_layer_pixels_create(context, renderer->pool, request->layers, &work->frame, work->tiles,
                                &work->layers, error);
}

/* Opens faces where volumes touch, in the frame's copies of the grids only (hl_open_faces). */
static void open_faces(const hl_scene_description *scene, grid *grids) {
  for (size_t i = 0; i < scene->volume_count; i++)
    for (size_t k = 0; k < scene->volume_count; k++)
      if (k != i && scene->volumes[k].casts_shadow) hl_open_faces(&grids[i], &grids[k]);
}

/* Brings the meshes to frame space, and adds their boxes to the content. */
static hl_status add_surfaces(hl_renderer *renderer, const hl_scene_description *scene, frame_work *work,
                              hl_error *error) {
  frame *frame = &work->frame;
  if (!hl_surfaces_current(&renderer->surfaces, scene)) {
    hl_surface_tree_release(renderer->context, &renderer->contact);
    hl_surfaces_release(renderer->context, &renderer->surfaces);
  }
  hl_layout counted = {0};
  hl_status status = HL_OK;
  if (renderer->surfaces.mesh_count == 0) status = hl_surfaces_count_memory(scene, &counted, error);
  if (status == HL_OK) status = hl_renderer_check_room(renderer, counted.most, error);
  if (status == HL_OK)
    status = hl_surfaces_update(renderer->context, renderer->pool, scene, &renderer->surfaces, error);
  if (status != HL_OK || scene->mesh_count == 0) return status;
  for (size_t i = 0; i < scene->mesh_count; i++, frame->point_count += 8)
    hl_surface_corners(&scene->meshes[i], frame->voxel, frame->points + frame->point_count);
  frame->surfaces = &renderer->surfaces;
  frame->contact = &renderer->contact;
  frame->mesh_objects = work->framed.mesh_objects;
  return HL_OK;
}

/* A volume that neither shows nor casts a shadow may be the second number of another's function: frames do
 * not fill its samples. */
static grid grid_of_frame(const hl_scene_volume *volume, const prepared_volume *prepared) {
  grid grid = prepared->grid;
  if (!volume->visible && !volume->casts_shadow) grid.relevant_count = 0;
  return grid;
}

/* Brings the tree of what shadow buffers leave light behind up to date; after the frame's lights. */
static hl_status update_contact(hl_renderer *renderer, const frame *frame, hl_error *error) {
  surface_tree *tree = &renderer->contact;
  double distance = hl_contact_distance(frame);
  bool shadows = false;
  for (int i = 0; i < frame->light_count; i++) shadows |= frame->lights[i].shadows != HL_SHADOWS_OFF;
  if (!shadows || frame->surfaces == NULL || hl_surface_tree_current(tree, &renderer->surfaces, distance))
    return HL_OK;
  hl_surface_tree_release(renderer->context, tree);
  hl_layout counted = {0};
  hl_surface_tree_count(&renderer->surfaces, distance, &counted);
  hl_status status = hl_renderer_check_room(renderer, counted.most, error);
  if (status != HL_OK) return status;
  return hl_surface_tree_create(renderer->context, &renderer->surfaces, distance, tree, error);
}

/* Finds the part of the picture that this renderer makes. */
static hl_status share_picture(hl_renderer *renderer, frame_work *work, int volumes, hl_error *error) {
  const share_content content = {&work->frame, work->grids, volumes, &work->sweeps[0].sheets};
  work->share = (picture_share){.part = renderer->part,
                                .parts = renderer->parts,
                                .exchange = renderer->exchange.gather != NULL ? &renderer->exchange : NULL};
  return hl_share_create(renderer->context, &content, &work->share, error);
}

hl_status hl_frame_work_set_up(hl_renderer *renderer, const hl_scene_description *scene,
                               const frame_request *request, frame_work *work, hl_error *error) {
  hl_context *context = renderer->context;
  frame *frame = &work->frame;
  frame->order = request->order;
  frame->points = hl_allocate(context, (scene->volume_count + scene->mesh_count) * 8 + 1, sizeof(vec3));
  frame->lights = hl_allocate(context, LIGHT_SECTORS * scene->light_count, sizeof(light_source));
  work->grids = hl_allocate(context, scene->volume_count, sizeof(grid));
  work->sweeps = hl_allocate_zeroed(context, LIGHT_SECTORS * scene->light_count + 1, sizeof(frame_sweep));
  if (frame->points == NULL || frame->lights == NULL || work->grids == NULL || work->sweeps == NULL)
    return hl_fail_memory(error, scene->light_count * sizeof(frame_sweep), "the frame");
  for (size_t i = 0; i < scene->volume_count; i++) {
    work->grids[i] = grid_of_frame(&scene->volumes[i], &renderer->prepared[i]);
    if (work->grids[i].relevant_count == 0) continue;
    hl_frame_content(&work->grids[i], frame->points + frame->point_count);
    frame->point_count += 8;
  }
  open_faces(scene, work->grids);
  frame->voxel = hl_scene_smallest_edge(scene);
  hl_status status = add_surfaces(renderer, scene, work, error);
  if (status == HL_OK) status = hl_frame_set_up_eye(frame, scene, error);
  if (status != HL_OK) return status;
  frame->spacing = fmin(scene->render.sheet_spacing, hl_is_maximum(scene) ? MAXIMUM_SPACING : GRID_MARGIN) *
                   frame->voxel; /* at most the margin by which volumes continue beyond their faces */
  hl_frame_set_up_lights(frame, scene);
  status = update_contact(renderer, frame, error);
  if (status != HL_OK) return status;
  for (size_t i = 0; i < scene->volume_count; i++)
    if (rays_start_inside(frame, &work->grids[i])) work->grids[i].cut = true;
  work->sweep_count = hl_frame_sweeps(frame, &scene->render, work->sweeps);
  if (hl_layers_measure(request->layers)) choose_measuring_sweep(work);
  status = hl_frame_check_sweeps(frame, work->sweeps, work->sweep_count, error);
  if (status != HL_OK) return status;
  work->tiles_x = (size_t)hl_tiles(frame->eye.width);
  work->tiles = work->tiles_x * (size_t)hl_tiles(frame->eye.height);
  status = place_pixels(renderer, scene, request, work, error);
  if (status == HL_OK) status = share_picture(renderer, work, (int)scene->volume_count, error);
  if (status != HL_OK) return status;
  return hl_maximum_create(context, renderer->pool, scene, renderer->prepared, work->tiles, &work->maximum,
                           error);
}
