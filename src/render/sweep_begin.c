/* render/sweep_begin.c - steps 1 to 4: views, sorting, memory, full light. */
#include "core/memory.h"
#include "light/light_extent.h"
#include "render/clock.h"
#include "render/sweep.h"

/* Pixels of shadow buffers are as coarse as adds little to the error that the sheets leave (measured against
 * the reference, docs/performance.md): three quarters of their distance, three quarters of a voxel at most
 * and three tenths at least; and somewhat coarser than the image's. */
static const double SHADOW_PIXEL_PER_SPACING = 0.75, LEAST_SHADOW_PIXEL = 0.3, GREATEST_SHADOW_PIXEL = 0.75;
static const double SHADOW_PIXEL_PER_IMAGE_PIXEL = 1.4, PART_PIXEL_PER_IMAGE_PIXEL = 1.5;
/* Read by cubic convolution, shadows lose no more on pixels larger by that part of a voxel than bilinear
 * look-ups do on these. */
static const double CUBIC_LARGER = 1.0 / 8;
enum { SHADOW_PIXELS_PER_IMAGE_PIXEL = 4, LEAST_SHADOW_PIXELS = 1 << 20 };

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

/* Penumbrae reach beyond what casts them by half their width, blurs in several steps further: the widest of
 * this sweep, in the soft buffer's units. */
static double penumbra_margin(const sweep *sweep, const light_source *source, const sheet_light *seen) {
  const sheet_stack *sheets = &sweep->geometry->sheets;
  double width = fmax(seen->width_u, seen->width_v), depth = sheets->spacing * sheets->count;
  if (source->parallel) return width * depth;
  double nearest = fmax(sheets->first - vec3_dot(source->position, sheets->normal), 0);
  return width * (1 / nearest - 1 / (nearest + depth));
}

/* What the sheets' distance allows, in voxels. */
static double pixel_of_sheets(const sweep *sweep) {
  double of_sheets = SHADOW_PIXEL_PER_SPACING * sweep->geometry->sheets.spacing / sweep->frame->voxel;
  return fmin(fmax(of_sheets, LEAST_SHADOW_PIXEL), GREATEST_SHADOW_PIXEL);
}

/* Hard shadows where larger pixels do not exceed the greatest; the paper's as the paper has it. image: of the
 * light, null where it is even; the penumbrae of others have edges of their own. */
static bool is_read_cubic(const sweep *sweep, const light_source *source, const light_image *image) {
  hl_shadow_lookup lookup = sweep->scene->render.shadow_lookup;
  bool soft = source->shadows == HL_SHADOWS_SOFT;
  if (soft && source->soft_method == HL_SOFT_SUBLIGHTS) return false;
  if (lookup != HL_LOOKUP_AUTO) return lookup == HL_LOOKUP_CUBIC;
  if (soft) return source->soft_method == HL_SOFT_CASCADE && image == NULL;
  return pixel_of_sheets(sweep) + CUBIC_LARGER <= GREATEST_SHADOW_PIXEL;
}

/* A bilinear look-up weighs two pixels by their distances p and 1 - p: a variance of p (1 - p), 1/6 on
 * average. Cubic convolution has none. */
static double lookup_variance(bool cubic) { return cubic ? 0 : 1.0 / 6; }

static double shadow_pixel(const sweep *sweep, const light_source *source, bool cubic) {
  const frame *frame = sweep->frame;
  double pixel = (pixel_of_sheets(sweep) + (cubic ? CUBIC_LARGER : 0)) * frame->voxel;
  if (source->shadows != HL_SHADOWS_SOFT)
    return fmin(SHADOW_PIXEL_PER_IMAGE_PIXEL * frame->pixel,
                fmin(pixel, GREATEST_SHADOW_PIXEL * frame->voxel));
  if (source->soft_method == HL_SOFT_SUBLIGHTS)
    return fmin(PART_PIXEL_PER_IMAGE_PIXEL * frame->middle_pixel, pixel);
  /* a pixel on the sheets is narrower seen along the light: as large as a hard shadow's there */
  double slant = source->parallel ? fabs(vec3_dot(source->direction, sweep->geometry->sheets.normal)) : 1;
  return fmin(SHADOW_PIXEL_PER_IMAGE_PIXEL * frame->middle_pixel, pixel / sqrt(fmax(slant, 0.5)));
}

/* Places the buffer: perpendicular to the light for hard shadows; parallel to the sheets for soft ones,
 * around the middle and along the axes of the light as they see it. False where nothing of the content is in
 * the picture. */
static bool place_buffer(const sweep *sweep, const light_source *source, bool cubic, vec3 *points,
                         shadow_extent *extent, sheet_light *seen, view *view) {
  size_t greatest = (size_t)sweep->frame->width * (size_t)sweep->frame->height *
                    SHADOW_PIXELS_PER_IMAGE_PIXEL;
  *extent = (shadow_extent){
      .points = points,
      .point_count = hl_frame_visible_points(sweep->frame, points),
      .pixel = shadow_pixel(sweep, source, cubic),
      .resolution = sweep->scene->render.shadow_resolution,
      .greatest_pixels = greatest < LEAST_SHADOW_PIXELS ? LEAST_SHADOW_PIXELS : greatest,
      .content = sweep->frame->points,
      .content_count = sweep->frame->point_count};
  if (extent->point_count == 0) return false;
  if (source->shadows != HL_SHADOWS_SOFT) {
    hl_shadow_view(source, source->direction, extent, view);
    return true;
  }
  light_source middle = *source;
  *seen = hl_light_on_sheets(source, sweep->geometry->sheets.normal);
  extent->margin = penumbra_margin(sweep, source, seen);
  if (source->soft_method == HL_SOFT_SUBLIGHTS) extent->u = seen->u;
  if (source->soft_method == HL_SOFT_CASCADE) {
    extent->u = seen->u;
    if (source->parallel) middle.direction = vec3_normalise(seen->middle);
    else middle.position = seen->middle;
  }
  hl_shadow_view(&middle, sweep->geometry->sheets.normal, extent, view);
  return true;
}

/* The greatest tangent of a view's rays against the sheets' normal (a quadrangle's rays meet a sheet in one:
 * corners are farthest). Infinite where some rays run along the sheets. */
static double steepest_tangent(const view *view, vec3 normal) {
  double greatest = 0, first = 0;
  for (int corner = 0; corner < 4; corner++) {
    vec3 start, way;
    hl_view_ray(view, corner % 2 * view->width, corner / 2 * view->height, &start, &way);
    double climb = vec3_dot(way, normal);
    if (corner == 0) first = climb;
    if (!(climb * first > 0)) return INFINITY;
    greatest = fmax(greatest, vec3_length(vec3_subtract(way, vec3_scale(normal, climb))) / fabs(climb));
  }
  return greatest;
}

/* A cascade keeps its buffer where it is looked up. What is seen of a brick is looked up in the middle of the
 * slab, up to half a slab further along the eye's ray: derived, in a buffer parallel to the sheets that is
 * half their distance times the difference of the two rays' tangents away. Near a light within the content a
 * tile must do. */
static double look_up_spare(const sweep *sweep, const light_source *source, bool cubic, const view *view) {
  const sheet_stack *sheets = &sweep->geometry->sheets;
  if (source->shadows != HL_SHADOWS_SOFT || source->soft_method != HL_SOFT_CASCADE) return PIXEL_TO_SPARE;
  double nearest = 1, pixel = fmin(vec3_length(view->du), vec3_length(view->dv));
  if (view->perspective) nearest = fmax(sheets->first - vec3_dot(view->origin, sheets->normal), 1e-9 * pixel);
  double tangents = steepest_tangent(&sweep->frame->eye, sheets->normal) +
                    steepest_tangent(view, sheets->normal);
  int taps = cubic ? 2 * PIXEL_TO_SPARE : PIXEL_TO_SPARE;
  return taps + fmin(0.5 * sheets->spacing * tangents / (pixel * nearest), TILE);
}

/* One light's part of hl_sweep_bytes; as begin_light takes it. image: null where penumbrae are even. */
static void add_light_bytes(const sweep *sweep, int index, const light_image *image, vec3 *points,
                            sweep_bytes *bytes) {
  const light_source *source = &sweep->frame->lights[sweep->geometry->light[index]];
  const sheet_stack *sheets = &sweep->geometry->sheets;
  double last = sheets->first + (sheets->count - 1) * sheets->spacing;
  view view;
  shadow_extent extent;
  sheet_light seen = {0};
  bool cubic = is_read_cubic(sweep, source, image);
  if (source->shadows == HL_SHADOWS_OFF || !place_buffer(sweep, source, cubic, points, &extent, &seen, &view))
    return;
  bool soft = source->shadows == HL_SHADOWS_SOFT, paper = soft && source->soft_method == HL_SOFT_PAPER;
  bool cascade = soft && source->soft_method == HL_SOFT_CASCADE;
  int reach = soft && source->soft_method == HL_SOFT_SUBLIGHTS ? SUBLIGHT_REACH : 0;
  if (paper) {
    soft_paper begun;
    light_image seen_image = image != NULL ? *image : (light_image){0};
    hl_soft_paper_begin(&begun, source, sheets->normal, sheets->first, &view,
                        image != NULL ? &seen_image : NULL);
    reach = hl_soft_paper_reach(&begun, sheets->first, sheets->spacing, sheets->count);
  }
  uint64_t tiles = (uint64_t)hl_tiles(view.width) * (uint64_t)hl_tiles(view.height), passing = 0;
  bytes->buffers += hl_shadow_buffer_bytes(&view, sweep->channels, paper || cascade, reach);
  bytes->passing += hl_view_sheets_bytes(sweep, &view, look_up_spare(sweep, source, cubic, &view));
  bytes->passing += tiles * sizeof *sweep->tasks + (image != NULL ? sizeof *image : 0);
  if (soft && source->soft_method == HL_SOFT_SUBLIGHTS)
    bytes->passing += hl_sublights_bytes(source, image, sweep->scene->render.light_samples, sheets->normal,
                                         &extent, sweep->channels, &view, reach);
  if (soft && source->soft_method == HL_SOFT_CASCADE)
    hl_soft_cascade_bytes(&seen, image, sheets->normal, sheets->first, last, vec3_length(view.du), &view,
                          sweep->channels, &bytes->cascades[index], &passing);
  bytes->passing += passing;
}

sweep_bytes hl_sweep_bytes(const sweep *sweep, vec3 *points, int threads) {
  uint64_t a_grid = SHADE_SCRATCH_BYTES + sizeof *sweep->scratch_volumes + 2 * sizeof *sweep->shade_patches;
  uint64_t tiles = (uint64_t)hl_tiles(sweep->frame->width) * (uint64_t)hl_tiles(sweep->frame->height);
  sweep_bytes bytes = {.passing = hl_view_sheets_bytes(sweep, &sweep->frame->eye, PIXEL_TO_SPARE)};
  bytes.passing += tiles * (sizeof *sweep->tasks + sizeof *sweep->open) +
                   (uint64_t)threads * (uint64_t)sweep->volume_count * a_grid;
  if (sweep->geometry->back_to_front) bytes.passing += tiles * TILE_BLOCKS * sizeof *sweep->shown_from;
  for (int i = 0; i < sweep->geometry->light_count; i++) {
    light_image *image = NULL; /* without memory for one, hl_sweep_begin tells */
    hl_status status = hl_light_image_create(sweep->context, &sweep->frame->lights[sweep->geometry->light[i]],
                                             &image, NULL);
    add_light_bytes(sweep, i, status != HL_OK || image == NULL || image->even ? NULL : image, points, &bytes);
    hl_release(sweep->context, image);
  }
  return bytes;
}

static hl_status begin_light(sweep *sweep, sweep_light *light, const light_source *source,
                             shadow_buffer *buffer, cascade_memory *memory, vec3 *points, hl_error *error) {
  light->source = source;
  hl_status status = hl_light_image_create(sweep->context, source, &light->image, error);
  if (status != HL_OK) return status;
  light_image *image = light->image == NULL || light->image->even ? NULL : light->image;
  light->cubic = is_read_cubic(sweep, source, image);
  status = hl_light_screen_create(sweep->context, source, sweep->frame->points, sweep->frame->point_count,
                                  sweep->frame->middle, sweep->frame->middle_pixel, &light->screen, error);
  view view;
  shadow_extent extent;
  sheet_light seen = {0};
  if (status != HL_OK || source->shadows == HL_SHADOWS_OFF ||
      !place_buffer(sweep, source, light->cubic, points, &extent, &seen, &view))
    return status;
  light->buffer = buffer;
  double edge = vec3_length(view.du);
  bool soft = source->shadows == HL_SHADOWS_SOFT, paper = soft && source->soft_method == HL_SOFT_PAPER;
  bool cascade = soft && source->soft_method == HL_SOFT_CASCADE;
  int reach = soft && source->soft_method == HL_SOFT_SUBLIGHTS ? SUBLIGHT_REACH : 0;
  const sheet_stack *sheets = &sweep->geometry->sheets;
  if (paper) {
    hl_soft_paper_begin(&light->paper, source, sheets->normal, sheets->first, &view, image);
    reach = hl_soft_paper_reach(&light->paper, sheets->first, sheets->spacing, sheets->count);
  }
  status = hl_shadow_buffer_reset(sweep->context, sweep->pool, buffer, &view, sweep->channels,
                                  paper || cascade, reach, error);
  light->lookup.map = hl_map_of_view(&view);
  light->lookup.map.stride = buffer->stride;
  for (int c = 0; c < sweep->channels; c++) {
    light->lookup.transmittance[c] = buffer->transmittance[c];
    light->lookup.older[c] = cascade ? buffer->second[c] : NULL;
  }
  double last = sheets->first + (sheets->count - 1) * sheets->spacing;
  if (status == HL_OK && soft && source->soft_method == HL_SOFT_SUBLIGHTS)
    status = hl_sublights_begin(sweep->reserve, sweep->pool, &light->sublights, source, image,
                                sweep->scene->render.light_samples, sheets->normal, &extent, buffer, error);
  if (cascade && image != NULL) hl_light_image_see(source, &seen, sheets->normal, image);
  if (status == HL_OK && cascade)
    status = hl_soft_cascade_begin(sweep->context, sweep->pool, memory, &light->cascade, &seen, image,
                                   sheets->normal, sheets->first, last, edge, lookup_variance(light->cubic),
                                   buffer, error);
  if (status == HL_OK)
    status = hl_view_sheets_begin(sweep, &view, look_up_spare(sweep, source, light->cubic, &view),
                                  &light->sheets, error);
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
      .shadowed = from->buffer != NULL,
      .inverse_square = scene->falloff == HL_FALLOFF_INVERSE_SQUARE,
      .screen = from->screen,
      .share = hl_light_share(from->source->sectors, from->source->sector),
      .cone = hl_light_cone(from->source, sweep->frame->middle, sweep->frame->middle_pixel),
      .nearest = sweep->scene->render.shadow_lookup == HL_LOOKUP_NEAREST,
      .cubic = from->cubic};
  vec3_store(light->towards, vec3_scale(from->source->direction, -1));
  vec3_store(light->position, from->source->position);
  for (int c = 0; c < 3; c++)
    light->color[c] = (float)(scene->color[c] * scene->intensity *
                              (from->image == NULL ? 1 : from->image->mean[c]));
  light->path = (float)spacing;
  if (from->source->parallel)
    light->path = (float)(spacing / fmax(fabs(vec3_dot(from->source->direction, normal)), 1e-3));
  if (from->buffer == NULL) return;
  light->channels = from->buffer->channels;
  light->lookup = &from->lookup;
  light->parts = from->sublights.lookups;
  light->part_count = from->sublights.count;
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
    if (sweep->lights[i].buffer != NULL) job->stride = sweep->lights[i].buffer->stride;
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
    if (sweep->lights[i].buffer != NULL) least = fmin(least, least_climb(sweep, sweep->lights[i].source));
  return least < LEAST_CLIMB ? INFINITY : sweep->geometry->sheets.spacing / least;
}

hl_status hl_sweep_begin(sweep *sweep, shadow_buffer *buffers, cascade_memory *memory, hl_error *error) {
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
    hl_soft_cascade_release(context, sweep->pool, &light->cascade);
    hl_sublights_release(sweep->reserve, &light->sublights);
  }
  hl_view_sheets_end(sweep, &sweep->image);
  void *owned[] = {sweep->open,    sweep->tasks,           sweep->shade_volumes, sweep->shade_patches,
                   sweep->scratch, sweep->scratch_volumes, sweep->counts};
  for (size_t i = 0; i < sizeof owned / sizeof owned[0]; i++) hl_release(context, owned[i]);
}
