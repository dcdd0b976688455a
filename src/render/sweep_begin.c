/* render/sweep_begin.c - steps 1 to 4: views, sorting, memory, full light. */
#include "core/memory.h"
#include "light/light_extent.h"
#include "render/clock.h"
#include "render/sweep.h"

static hl_status allocate_image(sweep *sweep, hl_error *error) {
  sweep->tiles_x = sweep->image.occupancy.tiles_x;
  sweep->tiles_y = sweep->image.occupancy.tiles_y;
  sweep->tiles = (size_t)sweep->tiles_x * (size_t)sweep->tiles_y;
  sweep->open = hl_allocate(sweep->context, sweep->tiles, sizeof *sweep->open);
  if (sweep->open == NULL)
    return hl_fail_memory(error, sweep->tiles * sizeof *sweep->open, "the image's tiles");
  return HL_OK;
}

/* Blocks outside the picture are closed from the start. */
void hl_sweep_open(sweep *sweep) {
  for (size_t tile = 0; tile < sweep->tiles; tile++) {
    uint32_t open = 0;
    int x0 = (int)(tile % (size_t)sweep->tiles_x) * TILE, y0 = (int)(tile / (size_t)sweep->tiles_x) * TILE;
    for (int block = 0; block < TILE_BLOCKS; block++) {
      int x = x0 + block % 4 * BLOCK, y = y0 + block / 4 * BLOCK;
      if (x < sweep->frame->width && y < sweep->frame->height) open |= 1u << block;
    }
    sweep->open[tile] = (uint16_t)open;
  }
}

/* seen: [seen_count] corners of what the eye sees. image: null where the light is even. */
static shadow_setup setup_of_light(const sweep *sweep, const light_source *source, light_image *image,
                                   const vec3 *seen, int seen_count) {
  const frame *frame = sweep->frame;
  return (shadow_setup){.context = sweep->context,
                        .pool = sweep->pool,
                        .reserve = sweep->reserve,
                        .functions = &sweep->hot->shadow,
                        .settings = &sweep->scene->render,
                        .source = source,
                        .image = image == NULL || image->even ? NULL : image,
                        .sheets = &sweep->geometry->sheets,
                        .eye = &frame->eye,
                        .channels = sweep->channels,
                        .voxel = frame->voxel,
                        .pixel = frame->pixel,
                        .middle_pixel = frame->middle_pixel,
                        .picture_pixels = (size_t)frame->width * (size_t)frame->height,
                        .seen = seen,
                        .seen_count = seen_count,
                        .content = frame->points,
                        .content_count = frame->point_count};
}

/* One light's part of hl_sweep_bytes; as begin_light takes it. */
static hl_status add_light_bytes(const sweep *sweep, int index, light_image *image, vec3 *points,
                                 sweep_bytes *bytes, hl_error *error) {
  light_shadow shadow;
  shadow_setup setup = setup_of_light(sweep, &sweep->frame->lights[sweep->geometry->light[index]], image,
                                      points, hl_frame_visible_points(sweep->frame, points));
  hl_status status = hl_light_shadow_plan(&shadow, &setup, error);
  if (status == HL_OK && shadow.method != NULL) {
    const view *view = &shadow.plan.view;
    shadow_layouts of_method = hl_light_shadow_count(&shadow);
    bytes->buffers += hl_light_shadow_buffer_bytes(&shadow);
    bytes->memory[index] = of_method.kept.bytes;
    bytes->passing += of_method.passing.bytes + shadow.method->state_bytes +
                      (image != NULL ? sizeof *image : 0) +
                      hl_view_sheets_bytes(sweep, view, shadow.plan.spare) +
                      (uint64_t)hl_tiles(view->width) * (uint64_t)hl_tiles(view->height) *
                          sizeof *sweep->tasks;
  }
  hl_light_shadow_end(&shadow);
  return status;
}

hl_status hl_sweep_bytes(const sweep *sweep, vec3 *points, int threads, sweep_bytes *bytes, hl_error *error) {
  uint64_t a_grid = SHADE_SCRATCH_BYTES + sizeof *sweep->scratch_volumes + 2 * sizeof *sweep->shade_patches;
  uint64_t tiles = (uint64_t)hl_tiles(sweep->frame->width) * (uint64_t)hl_tiles(sweep->frame->height);
  *bytes = (sweep_bytes){.passing = hl_view_sheets_bytes(sweep, &sweep->frame->eye, PIXEL_TO_SPARE)};
  bytes->passing += tiles * (sizeof *sweep->tasks + sizeof *sweep->open) +
                    (uint64_t)threads * (uint64_t)sweep->volume_count * a_grid;
  if (sweep->geometry->back_to_front) bytes->passing += tiles * TILE_BLOCKS * sizeof *sweep->shown_from;
  hl_status status = HL_OK;
  for (int i = 0; i < sweep->geometry->light_count && status == HL_OK; i++) {
    light_image *image = NULL;
    status = hl_light_image_create(sweep->context, &sweep->frame->lights[sweep->geometry->light[i]], &image,
                                   error);
    if (status == HL_OK) status = add_light_bytes(sweep, i, image, points, bytes, error);
    hl_release(sweep->context, image);
  }
  return status;
}

static hl_status begin_light(sweep *sweep, sweep_light *light, const light_source *source,
                             shadow_buffer *buffer, shadow_memory *memory, vec3 *points, hl_error *error) {
  const frame *frame = sweep->frame;
  light->source = source;
  hl_status status = hl_light_image_create(sweep->context, source, &light->image, error);
  if (status == HL_OK)
    status = hl_light_screen_create(sweep->context, source, frame->points, frame->point_count, frame->middle,
                                    frame->middle_pixel, &light->screen, error);
  if (status != HL_OK) return status;
  light_shadow *shadow = &light->shadow;
  shadow_setup setup = setup_of_light(sweep, source, light->image, points,
                                      hl_frame_visible_points(frame, points));
  status = hl_light_shadow_plan(shadow, &setup, error);
  if (status != HL_OK || shadow->method == NULL) return status;
  status = hl_light_shadow_begin(shadow, buffer, memory, error);
  if (status == HL_OK)
    status = hl_view_sheets_begin(sweep, &shadow->plan.view, shadow->plan.spare, &light->sheets, error);
  return status;
}

static hl_status allocate_stages(sweep *sweep, hl_error *error) {
  hl_context *context = sweep->context;
  size_t grids = (size_t)sweep->volume_count, threads = (size_t)hl_pool_threads(sweep->pool);
  sweep->task_capacity = sweep->tiles;
  for (int i = 0; i < sweep->geometry->light_count; i++)
    sweep->task_capacity += (size_t)sweep->lights[i].sheets.occupancy.tiles_x *
                            (size_t)sweep->lights[i].sheets.occupancy.tiles_y;
  sweep->tasks = hl_allocate(context, sweep->task_capacity, sizeof *sweep->tasks);
  sweep->shade_volumes = hl_allocate_zeroed(context, grids, sizeof *sweep->shade_volumes);
  sweep->shade_patches = hl_allocate(context, threads * grids, sizeof *sweep->shade_patches);
  sweep->scratch = hl_allocate(context, threads * grids, SHADE_SCRATCH_BYTES);
  sweep->scratch_volumes = hl_allocate(context, threads * grids, sizeof *sweep->scratch_volumes);
  sweep->counts = hl_allocate_zeroed(context, threads, sizeof *sweep->counts);
  if (sweep->tasks == NULL || sweep->shade_volumes == NULL || sweep->shade_patches == NULL ||
      sweep->scratch == NULL || sweep->scratch_volumes == NULL || sweep->counts == NULL)
    return hl_fail_memory(error, sweep->task_capacity * sizeof *sweep->tasks, "the sheet loop");
  return HL_OK;
}

static void set_up_shading(sweep *sweep) {
  int rank = 0;
  for (int g = 0; g < sweep->volume_count; g++) {
    const hl_scene_volume *volume = sweep->volumes[g].scene;
    shade_volume *shade = &sweep->shade_volumes[g];
    *shade = (shade_volume){.classifier = &sweep->volumes[g].classifier,
                            .grid = &sweep->grids[g],
                            .kernel = sweep->kernel,
                            .phong = volume->shading == HL_SHADING_PHONG,
                            .lit = volume->shading != HL_SHADING_FLAT,
                            .visible = volume->visible,
                            .receives_shadow = volume->receives_shadow,
                            .ambient = (float)volume->material.ambient,
                            .diffuse = (float)volume->material.diffuse,
                            .specular = (float)volume->material.specular,
                            .shininess = (float)volume->material.shininess};
    shade->emission = shade->lit ? (float)volume->material.emission : 1;
    if (!shade->lit) shade->ambient = shade->receives_shadow = 0;
    if (sweep->maximum->values != NULL && volume->visible) {
      shade->rank = rank++;
      shade->shown = (const float(*)[4])(sweep->maximum->shown +
                                         (size_t)shade->rank * (CLASSIFIER_ENTRIES + 2));
    }
    for (int c = 0; c < HL_CHANNELS; c++)
      shade->cast[c] = volume->casts_shadow ? (float)volume->attenuation_color[c] : 0;
    const grid *grid = &sweep->grids[g];
    double finest = 0;
    for (int axis = 0; axis < 3; axis++)
      finest = fmax(finest, vec3_length(grid->frame_to_index.linear.row[axis]));
    shade->voxel = (float)(1 / finest);
    const double offset[3] = {grid->frame_to_index.offset.x, grid->frame_to_index.offset.y,
                              grid->frame_to_index.offset.z};
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
  *light = (shade_light){
      .parallel = from->source->parallel,
      .shadowed = from->shadow.method != NULL,
      .inverse_square = scene->falloff == HL_FALLOFF_INVERSE_SQUARE,
      .screen = from->screen,
      .share = hl_light_share(from->source->sectors, from->source->sector),
      .cone = hl_light_cone(from->source, sweep->frame->middle, sweep->frame->middle_pixel),
      .nearest = sweep->scene->render.shadow_lookup == HL_LOOKUP_NEAREST,
      .cubic = from->shadow.plan.cubic};
  vec3_store(light->towards, vec3_scale(from->source->direction, -1));
  vec3_store(light->position, from->source->position);
  for (int c = 0; c < 3; c++)
    light->color[c] = (float)(scene->color[c] * scene->intensity *
                              (from->image == NULL ? 1 : from->image->mean[c]));
  light->path = (float)spacing;
  if (from->source->parallel)
    light->path = (float)(spacing / fmax(fabs(vec3_dot(from->source->direction, normal)), 1e-3));
  if (from->shadow.method == NULL) return;
  light->channels = from->shadow.buffer->channels;
  light->lookup = &from->shadow.lookup;
  light->parts = from->shadow.sublights;
  light->part_count = from->shadow.sublight_count;
}

static void set_up_jobs(sweep *sweep) {
  const view *eye = &sweep->frame->eye;
  vec3 normal = sweep->geometry->sheets.normal;
  double spacing = sweep->geometry->sheets.spacing;
  shade_job *shade = &sweep->shade;
  *shade = (shade_job){.path = (float)spacing,
                       .spacing = (float)spacing,
                       .back_to_front = sweep->geometry->back_to_front,
                       .lights = sweep->shade_lights,
                       .light_count = sweep->geometry->light_count,
                       .channels = sweep->channels};
  vec3_store(shade->normal, normal);
  vec3_store(shade->eye, eye->origin);
  if (!eye->perspective) {
    double climb = vec3_dot(eye->direction, normal);
    shade->path = (float)(spacing / fabs(climb));
    vec3_store(shade->through, vec3_scale(eye->direction, spacing / climb));
    vec3_store(shade->towards_eye, vec3_scale(eye->direction, -1));
  }
  for (int c = 0; c < 3 && sweep->first; c++) shade->ambient[c] = (float)sweep->scene->ambient[c];
  shade->emission = sweep->first ? 1 : 0;
  for (int i = 0; i < sweep->geometry->light_count; i++) {
    set_up_light(sweep, &sweep->lights[i], &sweep->shade_lights[i]);
    attenuate_job *job = &sweep->attenuate[i];
    *job = (attenuate_job){
        .path = sweep->shade_lights[i].path, .spacing = (float)spacing, .channels = sweep->channels};
    if (sweep->lights[i].shadow.method != NULL) job->stride = sweep->lights[i].shadow.buffer->stride;
  }
}

/* Below this share of its way, light that climbs over the sheets counts as running along them. */
static const double LEAST_CLIMB = 0.05;

/* Directions within some angle of the normal form a cone: between the content's corners light climbs as at
 * one of them at least. */
static double least_climb(const sweep *sweep, const light_source *source) {
  vec3 normal = sweep->geometry->sheets.normal;
  if (source->parallel) return vec3_dot(source->direction, normal);
  double least = 1;
  for (int i = 0; i < sweep->frame->point_count; i++)
    least = fmin(least,
                 vec3_dot(vec3_normalise(vec3_subtract(sweep->frame->points[i], source->position)), normal));
  return least;
}

static double longest_way(const sweep *sweep) {
  double least = 1;
  for (int i = 0; i < sweep->geometry->light_count; i++)
    if (sweep->lights[i].shadow.method != NULL)
      least = fmin(least, least_climb(sweep, sweep->lights[i].source));
  return least < LEAST_CLIMB ? INFINITY : sweep->geometry->sheets.spacing / least;
}

hl_status hl_sweep_begin(sweep *sweep, shadow_buffer *buffers, shadow_memory *memory, hl_error *error) {
  double start = hl_clock_seconds();
  hl_status status = hl_view_sheets_begin(sweep, &sweep->frame->eye, PIXEL_TO_SPARE, &sweep->image, error);
  if (status == HL_OK) status = allocate_image(sweep, error);
  if (status != HL_OK) return status;
  hl_sweep_open(sweep);
  vec3 *points = hl_allocate(sweep->context, (size_t)sweep->volume_count * CONTENT_POINTS + 1,
                             sizeof *points);
  if (points == NULL) return hl_fail_memory(error, sizeof *points, "the content's corners");
  for (int i = 0; i < sweep->geometry->light_count && status == HL_OK; i++)
    status = begin_light(sweep, &sweep->lights[i], &sweep->frame->lights[sweep->geometry->light[i]],
                         &buffers[sweep->geometry->light[i]], &memory[i], points, error);
  hl_release(sweep->context, points);
  if (status == HL_OK) status = allocate_stages(sweep, error);
  if (status != HL_OK) return status;
  set_up_shading(sweep);
  set_up_jobs(sweep);
  sweep->longest_way = longest_way(sweep);
  status = hl_sweep_layers_begin(sweep, error);
  sweep->seconds_sort = hl_clock_seconds() - start;
  return status;
}

void hl_sweep_end(sweep *sweep) {
  hl_context *context = sweep->context;
  hl_sweep_layers_end(sweep);
  for (int i = 0; i < FRAME_LIGHTS; i++) {
    sweep_light *light = &sweep->lights[i];
    hl_view_sheets_end(sweep, &light->sheets);
    hl_light_screen_release(context, &light->screen);
    hl_release(context, light->image);
    hl_light_shadow_end(&light->shadow);
  }
  hl_view_sheets_end(sweep, &sweep->image);
  void *owned[] = {sweep->open,    sweep->tasks,           sweep->shade_volumes, sweep->shade_patches,
                   sweep->scratch, sweep->scratch_volumes, sweep->counts};
  for (size_t i = 0; i < sizeof owned / sizeof owned[0]; i++) hl_release(context, owned[i]);
}
