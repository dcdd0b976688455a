/* render/sweep_begin.c - steps 1 to 4: views, sorting, memory, full light. */
#include <string.h>

#include "core/memory.h"
#include "render/sweep.h"
#include "splat/voxel_sort.h"

enum { SHADOW_PIXELS_PER_IMAGE_PIXEL = 4, LEAST_SHADOW_PIXELS = 1 << 20 };

/* Central differences read a pixel around the tiles. */
static size_t sheet_stride(const tile_rectangle *r) { return ((size_t)r->width + 2) * TILE; }
static size_t sheet_floats(const tile_rectangle *r) { return ((size_t)r->height * TILE + 2) * sheet_stride(r); }

static hl_status allocate_image(sweep *sweep, hl_error *error) {
  hl_context *context = sweep->context;
  size_t grids = (size_t)sweep->volume_count;
  sweep->tiles_x = sweep->occupancy.tiles_x;
  sweep->tiles_y = sweep->occupancy.tiles_y;
  sweep->tiles = (size_t)sweep->tiles_x * (size_t)sweep->tiles_y;
  sweep->sheets = hl_allocate_zeroed(context, grids, sizeof *sweep->sheets);
  sweep->open = hl_allocate(context, sweep->tiles, sizeof *sweep->open);
  for (int slot = 0; slot < RING; slot++)
    sweep->filled[slot] = hl_allocate_zeroed(context, sweep->occupancy.patch_count, sizeof(uint16_t));
  if (sweep->sheets == NULL || sweep->open == NULL || sweep->filled[0] == NULL || sweep->filled[1] == NULL)
    return hl_fail_memory(error, sweep->occupancy.patch_count * 4, "the image's tiles");
  size_t floats = 0;
  for (size_t g = 0; g < grids; g++) floats += RING * sheet_floats(&sweep->occupancy.rectangle[g]);
  sweep->sheet_memory = hl_allocate_zeroed(context, floats, sizeof(float));
  if (sweep->sheet_memory == NULL) return hl_fail_memory(error, floats * sizeof(float), "the image's sheets");
  float *memory = sweep->sheet_memory;
  for (size_t g = 0; g < grids; g++) {
    image_sheets *sheets = &sweep->sheets[g];
    sheets->stride = sheet_stride(&sweep->occupancy.rectangle[g]);
    for (int slot = 0; slot < RING; slot++, memory += sheet_floats(&sweep->occupancy.rectangle[g]))
      sheets->density[slot] = memory + sheets->stride + TILE;
  }
  return HL_OK;
}

/* Blocks outside the picture are closed from the start. */
static void open_blocks(sweep *sweep) {
  for (size_t tile = 0; tile < sweep->tiles; tile++) {
    uint32_t open = 0;
    int x0 = (int)(tile % (size_t)sweep->tiles_x) * TILE, y0 = (int)(tile / (size_t)sweep->tiles_x) * TILE;
    for (int block = 0; block < TILE_BLOCKS; block++) {
      int x = x0 + block % 4 * BLOCK - FRAME_MARGIN, y = y0 + block / 4 * BLOCK - FRAME_MARGIN;
      if (x >= 0 && y >= 0 && x < sweep->frame->width && y < sweep->frame->height) open |= 1u << block;
    }
    sweep->open[tile] = (uint16_t)open;
  }
}

typedef struct coverage_work {
  coverage_tile_function *coverage_tile;
  box_rays rays;
  const occupancy *occupancy;
  const tile_rectangle *rectangle;
  float *enter, *leave;
} coverage_work;

static void cover_tile(void *data, size_t index, int worker) {
  (void)worker;
  const coverage_work *work = data;
  const tile_rectangle *r = work->rectangle;
  size_t at = (size_t)work->occupancy->patch_of[r->first + index] * TILE_PIXELS;
  work->coverage_tile(&work->rays, r->x + (int)(index % (size_t)r->width), r->y + (int)(index / (size_t)r->width),
                      work->enter + at, work->leave + at);
}

/* Where a view's rays enter and leave the boxes that cut something visible. */
static hl_status cover(sweep *sweep, const view *view, const occupancy *occupancy, float **enter, float **leave,
                       hl_error *error) {
  bool any = false;
  for (int g = 0; g < sweep->volume_count; g++) any = any || sweep->grids[g].cut;
  if (!any) return HL_OK;
  *enter = hl_allocate(sweep->context, occupancy->patch_count * TILE_PIXELS, sizeof(float));
  *leave = hl_allocate(sweep->context, occupancy->patch_count * TILE_PIXELS, sizeof(float));
  if (*enter == NULL || *leave == NULL)
    return hl_fail_memory(error, occupancy->patch_count * TILE_PIXELS * 8, "the rays' entries");
  const sheet_stack *sheets = &sweep->geometry->sheets;
  for (int g = 0; g < sweep->volume_count; g++) {
    const grid *grid = &sweep->grids[g];
    const tile_rectangle *r = &occupancy->rectangle[g];
    if (!grid->cut) continue;
    coverage_work work = {.coverage_tile = sweep->hot->coverage_tile, .occupancy = occupancy, .rectangle = r,
                          .enter = *enter, .leave = *leave};
    hl_box_rays(view, sheets->normal, sheets->first, grid->frame_to_index, grid->box_low, grid->box_high, &work.rays);
    hl_pool_run(sweep->pool, (size_t)r->width * (size_t)r->height, cover_tile, &work);
  }
  return HL_OK;
}

/* The light's last two sheets: a slab needs both. */
static hl_status keep_light_sheets(sweep *sweep, sweep_light *light, hl_error *error) {
  size_t count = light->occupancy.patch_count * RING;
  light->density = hl_allocate(sweep->context, count * TILE_PIXELS, sizeof(float));
  light->kept = hl_allocate_zeroed(sweep->context, count, sizeof *light->kept);
  if (light->density == NULL || light->kept == NULL)
    return hl_fail_memory(error, count * TILE_PIXELS * sizeof(float), "the light's sheets");
  for (size_t i = 0; i < count; i++) light->kept[i].sheet = -1;
  return HL_OK;
}

static hl_status sort_voxels(sweep *sweep, const view *view, voxel_lists **lists, hl_error *error) {
  if (!sweep->splat) return HL_OK;
  *lists = hl_allocate_zeroed(sweep->context, (size_t)sweep->volume_count, sizeof **lists);
  if (*lists == NULL) return hl_fail_memory(error, sizeof **lists, "the sorted voxels");
  for (int g = 0; g < sweep->volume_count; g++) {
    hl_status status = hl_voxel_lists_build(sweep->context, sweep->pool, &sweep->grids[g], sweep->kernel, view,
                                            &sweep->geometry->sheets, &(*lists)[g], error);
    if (status != HL_OK) return status;
  }
  return HL_OK;
}

/* Penumbrae reach beyond what casts them: the greatest width a parallel light can give in this sweep. */
static double penumbra_margin(const sweep *sweep, const light_source *source) {
  if (source->shadows != HL_SHADOWS_SOFT || !source->parallel) return 0;
  double tilt = fmax(vec3_dot(source->direction, sweep->geometry->sheets.normal), 0.1);
  double depth = sweep->geometry->sheets.spacing * sweep->geometry->sheets.count;
  return 0.5 * source->size * depth / (tilt * tilt);
}

static hl_status begin_light(sweep *sweep, sweep_light *light, const light_source *source, shadow_buffer *buffer,
                             vec3 *points, hl_error *error) {
  light->source = source;
  hl_status status = hl_light_screen_create(sweep->context, source, sweep->frame->middle, sweep->frame->middle_pixel,
                                            &light->screen, &light->screen_pixels, error);
  if (status != HL_OK || source->shadows == HL_SHADOWS_OFF) return status;
  light->buffer = buffer;
  bool soft = source->shadows == HL_SHADOWS_SOFT;
  vec3 plane_normal = soft ? sweep->geometry->sheets.normal : source->direction;
  size_t greatest = (size_t)sweep->frame->width * (size_t)sweep->frame->height * SHADOW_PIXELS_PER_IMAGE_PIXEL;
  /* hard edges must hold at the nearest matter; soft ones are wider than a pixel where it matters */
  double pixel = soft ? sweep->frame->middle_pixel : sweep->frame->pixel;
  shadow_extent extent = {points, hl_frame_visible_points(sweep->frame, points), pixel,
                          sweep->scene->render.shadow_resolution,
                          greatest < LEAST_SHADOW_PIXELS ? LEAST_SHADOW_PIXELS : greatest,
                          penumbra_margin(sweep, source)};
  if (extent.point_count == 0) { /* nothing of the content is in the picture */
    light->buffer = NULL;
    return HL_OK;
  }
  view view;
  hl_shadow_view(source, plane_normal, &extent, &view);
  double edge = vec3_length(view.du);
  bool paper = soft && source->soft_method == HL_SOFT_PAPER;
  int reach = 0;
  const sheet_stack *sheets = &sweep->geometry->sheets;
  if (paper) {
    hl_soft_paper_begin(&light->paper, source, sheets->normal, sheets->first, edge);
    reach = hl_soft_paper_reach(&light->paper, sheets->first, sheets->spacing, sheets->count);
  }
  status = hl_shadow_buffer_reset(sweep->context, buffer, &view, sweep->channels, paper, reach, error);
  if (status == HL_OK && soft && source->soft_method == HL_SOFT_CASCADE)
    status = hl_soft_cascade_begin(sweep->context, &light->cascade, source, sheets->normal, sheets->first,
                                   sheets->first + (sheets->count - 1) * sheets->spacing, edge, buffer, error);
  if (status == HL_OK)
    status = hl_occupancy_build(sweep->context, sweep->pool, sweep->grids, sweep->volume_count, &view, sheets,
                                &light->occupancy, error);
  if (status == HL_OK) status = sort_voxels(sweep, &view, &light->lists, error);
  if (status == HL_OK) status = cover(sweep, &view, &light->occupancy, &light->enter, &light->leave, error);
  if (status == HL_OK) status = keep_light_sheets(sweep, light, error);
  return status;
}

static hl_status allocate_stages(sweep *sweep, hl_error *error) {
  hl_context *context = sweep->context;
  size_t grids = (size_t)sweep->volume_count, threads = (size_t)hl_pool_threads(sweep->pool);
  sweep->task_capacity = sweep->tiles;
  for (int i = 0; i < sweep->geometry->light_count; i++)
    sweep->task_capacity += (size_t)sweep->lights[i].occupancy.tiles_x * (size_t)sweep->lights[i].occupancy.tiles_y;
  sweep->tasks = hl_allocate(context, sweep->task_capacity, sizeof *sweep->tasks);
  sweep->image_sources = hl_allocate_zeroed(context, grids, sizeof *sweep->image_sources);
  sweep->light_sources = hl_allocate_zeroed(context, grids * FRAME_LIGHTS * RING, sizeof *sweep->light_sources);
  sweep->shade_volumes = hl_allocate_zeroed(context, grids, sizeof *sweep->shade_volumes);
  sweep->shade_patches = hl_allocate(context, threads * grids, sizeof *sweep->shade_patches);
  sweep->scratch = hl_allocate(context, threads * grids * TILE_PIXELS, sizeof(float));
  sweep->scratch_volumes = hl_allocate(context, threads * grids, sizeof *sweep->scratch_volumes);
  sweep->counts = hl_allocate_zeroed(context, threads, sizeof *sweep->counts);
  if (sweep->tasks == NULL || sweep->image_sources == NULL || sweep->light_sources == NULL ||
      sweep->shade_volumes == NULL || sweep->shade_patches == NULL || sweep->scratch == NULL || sweep->scratch_volumes == NULL || sweep->counts == NULL)
    return hl_fail_memory(error, sweep->task_capacity * sizeof *sweep->tasks, "the sheet loop");
  return HL_OK;
}

static void set_up_shading(sweep *sweep) {
  for (int g = 0; g < sweep->volume_count; g++) {
    const hl_scene_volume *volume = sweep->volumes[g].scene;
    shade_volume *shade = &sweep->shade_volumes[g];
    *shade = (shade_volume){.classifier = &sweep->volumes[g].classifier,
                            .stride = sweep->sheets[g].stride,
                            .phong = volume->shading == HL_SHADING_PHONG,
                            .visible = volume->visible,
                            .receives_shadow = volume->receives_shadow,
                            .ambient = (float)volume->material.ambient,
                            .diffuse = (float)volume->material.diffuse,
                            .specular = (float)volume->material.specular,
                            .shininess = (float)volume->material.shininess};
    for (int c = 0; c < HL_CHANNELS; c++)
      shade->cast[c] = volume->casts_shadow ? (float)volume->attenuation_color[c] : 0;
    const grid *grid = &sweep->grids[g];
    const double offset[3] = {grid->frame_to_index.offset.x, grid->frame_to_index.offset.y, grid->frame_to_index.offset.z};
    for (int axis = 0; axis < 3; axis++) {
      vec3_store(shade->to_index[axis], grid->frame_to_index.linear.row[axis]);
      shade->to_index[axis][3] = (float)offset[axis];
      shade->low[axis] = (float)grid->box_low[axis];
      shade->high[axis] = (float)grid->box_high[axis];
    }
  }
}

static void set_up_light(sweep *sweep, const sweep_light *from, shade_light *light) {
  const hl_light *scene = from->source->light;
  vec3 normal = sweep->geometry->sheets.normal;
  double spacing = sweep->geometry->sheets.spacing;
  *light = (shade_light){.parallel = from->source->parallel, .shadowed = from->buffer != NULL,
                         .inverse_square = scene->falloff == HL_FALLOFF_INVERSE_SQUARE, .screen = from->screen,
                         .nearest = sweep->scene->render.shadow_lookup == HL_LOOKUP_NEAREST};
  vec3_store(light->towards, vec3_scale(from->source->direction, -1));
  vec3_store(light->position, from->source->position);
  for (int c = 0; c < 3; c++) light->color[c] = (float)(scene->color[c] * scene->intensity);
  light->path = (float)spacing;
  if (from->source->parallel) light->path = (float)(spacing / fmax(fabs(vec3_dot(from->source->direction, normal)), 1e-3));
  if (from->buffer == NULL) return;
  double rows[3][4];
  hl_view_homogeneous(&from->buffer->view, affine3_identity(), rows);
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 4; column++) light->map[row][column] = (float)rows[row][column];
  for (int c = 0; c < from->buffer->channels; c++) light->transmittance[c] = from->buffer->transmittance[c];
  light->stride = from->buffer->stride;
  light->width = from->buffer->view.width;
  light->height = from->buffer->view.height;
  light->channels = from->buffer->channels;
}

static void set_up_jobs(sweep *sweep) {
  const view *eye = &sweep->frame->eye;
  vec3 normal = sweep->geometry->sheets.normal;
  double spacing = sweep->geometry->sheets.spacing;
  shade_job *shade = &sweep->shade;
  *shade = (shade_job){.path = (float)spacing, .spacing = (float)spacing, .back_to_front = sweep->geometry->back_to_front,
                       .lights = sweep->shade_lights, .light_count = sweep->geometry->light_count,
                       .channels = sweep->channels};
  vec3_store(shade->normal, normal);
  if (!eye->perspective) {
    double climb = vec3_dot(eye->direction, normal);
    shade->path = (float)(spacing / fabs(climb));
    vec3_store(shade->through, vec3_scale(eye->direction, spacing / climb));
    vec3_store(shade->towards_eye, vec3_scale(eye->direction, -1));
  }
  for (int c = 0; c < 3 && sweep->first; c++) shade->ambient[c] = (float)sweep->scene->ambient[c];
  for (int i = 0; i < sweep->geometry->light_count; i++) {
    set_up_light(sweep, &sweep->lights[i], &sweep->shade_lights[i]);
    attenuate_job *job = &sweep->attenuate[i];
    *job = (attenuate_job){.path = sweep->shade_lights[i].path, .spacing = (float)spacing, .channels = sweep->channels};
    if (sweep->lights[i].buffer != NULL) job->stride = sweep->lights[i].buffer->stride;
  }
}

hl_status hl_sweep_begin(sweep *sweep, shadow_buffer *buffers, hl_error *error) {
  const sheet_stack *sheets = &sweep->geometry->sheets;
  hl_status status = hl_occupancy_build(sweep->context, sweep->pool, sweep->grids, sweep->volume_count,
                                        &sweep->frame->eye, sheets, &sweep->occupancy, error);
  if (status == HL_OK) status = sort_voxels(sweep, &sweep->frame->eye, &sweep->lists, error);
  if (status == HL_OK) status = allocate_image(sweep, error);
  if (status == HL_OK) status = cover(sweep, &sweep->frame->eye, &sweep->occupancy, &sweep->enter, &sweep->leave, error);
  if (status != HL_OK) return status;
  open_blocks(sweep);
  vec3 *points = hl_allocate(sweep->context, (size_t)sweep->volume_count * CONTENT_POINTS + 1, sizeof *points);
  if (points == NULL) return hl_fail_memory(error, sizeof *points, "the content's corners");
  for (int i = 0; i < sweep->geometry->light_count && status == HL_OK; i++)
    status = begin_light(sweep, &sweep->lights[i], &sweep->frame->lights[sweep->geometry->light[i]],
                         &buffers[sweep->geometry->light[i]], points, error);
  hl_release(sweep->context, points);
  if (status == HL_OK) status = allocate_stages(sweep, error);
  if (status != HL_OK) return status;
  set_up_shading(sweep);
  set_up_jobs(sweep);
  return HL_OK;
}

static void release_lists(sweep *sweep, voxel_lists *lists) {
  for (int g = 0; lists != NULL && g < sweep->volume_count; g++) hl_voxel_lists_release(sweep->context, &lists[g]);
  hl_release(sweep->context, lists);
}

void hl_sweep_end(sweep *sweep) {
  hl_context *context = sweep->context;
  for (int i = 0; i < FRAME_LIGHTS; i++) {
    sweep_light *light = &sweep->lights[i];
    hl_occupancy_release(context, &light->occupancy);
    release_lists(sweep, light->lists);
    hl_release(context, light->screen_pixels);
    hl_release(context, light->enter);
    hl_release(context, light->leave);
    hl_release(context, light->density);
    hl_release(context, light->kept);
    hl_soft_cascade_release(context, &light->cascade);
  }
  hl_occupancy_release(context, &sweep->occupancy);
  release_lists(sweep, sweep->lists);
  void *owned[] = {sweep->filled[0], sweep->filled[1], sweep->enter, sweep->leave, sweep->shade_patches,
                   sweep->sheet_memory, sweep->sheets, sweep->open, sweep->tasks, sweep->image_sources,
                   sweep->light_sources, sweep->shade_volumes, sweep->scratch, sweep->scratch_volumes, sweep->counts};
  for (size_t i = 0; i < sizeof owned / sizeof owned[0]; i++) hl_release(context, owned[i]);
}
