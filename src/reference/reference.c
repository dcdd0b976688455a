/* reference/reference.c - the entry of the reference: makes camera rays, and adds up emission and absorption
 * along them.
 *
 * In: a scene. Out: linear premultiplied RGBA without a background, top row first. Pixels are independent of
 * each other. Each thread takes runs of pixels of a row. */
#include <stdatomic.h>

#include <halflight/render.h>

#include "core/context.h"
#include "core/door.h"
#include "core/memory.h"
#include "elementary/elementary.h"
#include "reference/reference.h"
#include "scene/check/check.h"

/* A ray ends when its alpha reaches this value. */
static const double OPAQUE = 1 - 1e-5;

/* The alpha that a ray must reach for its first depth (halflight/layers.h). */
static const double FIRST_OPACITY = 0.01;

/* The greatest opacity that one sample may add to a pixel. The bound is small, because light that grazes a
 * dense volume fades within a small fraction of a step. The picture's error grows linearly with this bound,
 * and with the square of the step. So a step coarser than the default allows more opacity: the bound grows
 * with the square of the step, up to COARSEST_OPACITY. */
static const double MOST_OPACITY = 0.02, USUAL_STEP = 0.25, COARSEST_OPACITY = 0.1;

enum { RUN_PIXELS = 16 };

typedef struct eye_rays {
  vec3 position, forward;
  vec3 right, up; /* vectors from the picture's centre to the middle of its right and of its top edge: on the
                   * plane at the distance 1 (perspective), or in world units (orthographic) */
  bool orthographic;
} eye_rays;

typedef struct picture {
  const reference *all;
  eye_rays eye;
  reference_worker *workers; /* [threads] */
  float *pixels;             /* the caller's pixels */
  const hl_layers *layers;   /* the caller's layers; null if the caller wants none */
  size_t row_stride;         /* number of floats from one row to the next */
  size_t runs_per_row, runs; /* number of runs of pixels in a row, and in the picture */
  size_t stride;             /* the distance, in runs and modulo `runs`, between the runs that successive work
                              * items take */
  atomic_size_t runs_done;
} picture;

static eye_rays eye_rays_of(const hl_scene_description *scene) {
  const hl_camera *camera = &scene->camera;
  eye_rays eye = {.position = vec3_of(camera->position),
                  .orthographic = camera->type == HL_CAMERA_ORTHOGRAPHIC};
  eye.forward = vec3_normalise(vec3_subtract(vec3_of(camera->target), eye.position));
  vec3 right = vec3_normalise(vec3_cross(eye.forward, vec3_of(camera->up)));
  double half_height = eye.orthographic ? camera->height / 2 : hl_tan(camera->fovy_deg * HL_PI / 360);
  eye.up = vec3_scale(vec3_cross(right, eye.forward), half_height);
  eye.right = vec3_scale(right, half_height * scene->width / scene->height);
  return eye;
}

/* Makes ray (x, y) of the picture. Rays are numbered across the whole picture; each pixel has `rays` rays
 * along each side. *direction: a unit vector. */
static void eye_ray(const picture *all, size_t x, size_t y, vec3 *origin, vec3 *direction) {
  const eye_rays *eye = &all->eye;
  double across = 2 * ((double)x + 0.5) / ((double)all->all->scene->width * all->all->rays) - 1;
  double upwards = 1 - 2 * ((double)y + 0.5) / ((double)all->all->scene->height * all->all->rays);
  vec3 offset = vec3_add(vec3_scale(eye->right, across), vec3_scale(eye->up, upwards));
  *origin = eye->orthographic ? vec3_add(eye->position, offset) : eye->position;
  *direction = eye->orthographic ? eye->forward : vec3_normalise(vec3_add(eye->forward, offset));
}

static double total_extinction(const march *walk) {
  double total = 0;
  for (size_t v = 0; v < walk->count; v++) {
    const crossing *part = &walk->crossings[v];
    if (part->occupied)
      total += hl_reference_extinction(part->volume, hl_reference_value(part->volume, part->here),
                                       part->here);
  }
  return total;
}

/* The light that the current sample of each volume sends to the eye, weighted by extinction and summed over
 * all volumes. */
static void sample(const reference *all, const march *walk, vec3 point, vec3 to_eye,
                   reference_worker *worker) {
  reference_parts *made = &worker->sample;
  hl_reference_parts_clear(made, all->scene->light_count);
  for (size_t v = 0; v < walk->count; v++) {
    const crossing *part = &walk->crossings[v];
    if (!part->occupied) continue;
    double value = hl_reference_value(part->volume, part->here);
    double extinction = hl_reference_extinction(part->volume, value, part->here);
    if (extinction <= 0) continue;
    if (made->weight == 0)
      for (size_t l = 0; l < all->scene->light_count; l++)
        hl_reference_light_arrive(&all->lights[l], point, &worker->arrivals[l]);
    hl_reference_shade(all, &(reference_sample){part->volume, point, part->here, value, extinction, to_eye},
                       worker);
  }
  made->depth = made->weight * walk->at;
}

/* Adds the samples of all volumes at the march's position, for a step of the given length. Returns the sum of
 * the volumes' extinctions. Samples are composited front to back: C += (1-A) a c, A += (1-A) a, with a = 1 -
 * exp(-sigma dt). This sum is the exact integral if nothing varies in the step. */
static double composite(const reference *all, const march *walk, double length, vec3 origin, vec3 direction,
                        reference_worker *worker) {
  vec3 point = vec3_add(origin, vec3_scale(direction, walk->at));
  sample(all, walk, point, vec3_scale(direction, -1), worker);
  double extinction = worker->sample.weight;
  if (extinction <= 0) return 0;
  double opacity = (1 - worker->ray.weight) * -hl_expm1(-extinction * length);
  hl_reference_parts_add(&worker->ray, &worker->sample, opacity / extinction, all->scene->light_count);
  return extinction;
}

/* The distance at which a ray's alpha reaches FIRST_OPACITY, in a step that begins at the distance `start`
 * with the alpha `before`. Derived: (1 - A) exp(-sigma t) = 1 - FIRST_OPACITY. */
static double first_within(double before, double extinction, double start) {
  return start + hl_ln((1 - before) / (1 - FIRST_OPACITY)) / extinction;
}

/* Marches along a part of a camera ray. Every step is cut into pieces, each of which adds at most
 * most_opacity to the ray's opacity. The length of a piece follows from the extinction of the piece before
 * it. Adds the contributions of the part's samples to worker->ray. Sets *first to the first depth if the
 * first depth lies in this part. */
static void trace_part(const reference *all, const reference_ray *way, reference_worker *worker,
                       double *first) {
  march walk;
  reference_parts *ray = &worker->ray;
  hl_reference_march_begin(all, REFERENCE_SEEN, way, worker->eye, &walk);
  while (ray->weight < OPAQUE && !hl_pool_stops(all->pool, worker->number) &&
         hl_reference_march_next(&walk)) {
    double at = walk.at - walk.length / 2, end = at + walk.length, extinction = total_extinction(&walk);
    if (extinction <= 0) continue;
    while (at < end && ray->weight < OPAQUE) {
      double length = end - at, before = ray->weight;
      if (extinction > 0) length = fmin(length, all->most_opacity / (extinction * (1 - before)));
      hl_reference_march_place(&walk, at + length / 2);
      extinction = composite(all, &walk, length, way->origin, way->direction, worker);
      if (before < FIRST_OPACITY && ray->weight >= FIRST_OPACITY) {
        *first = first_within(before, extinction, at);
        ray->object = worker->sample.object;
      }
      at += length;
    }
  }
}

/* Follows one camera ray from surface to surface, and marches through the volumes between them. A perspective
 * ray begins at the eye; an orthographic ray has no beginning. Leaves the ray's contributions in worker->ray.
 * Returns the first depth. */
static double trace(const reference *all, vec3 origin, vec3 direction, reference_worker *worker) {
  reference_parts *ray = &worker->ray;
  bool orthographic = all->scene->camera.type == HL_CAMERA_ORTHOGRAPHIC;
  reference_ray way = {origin, direction, orthographic ? -INFINITY : 0, INFINITY};
  double first = INFINITY;
  hl_reference_parts_clear(ray, all->scene->light_count);
  for (bool met = true; met && ray->weight < OPAQUE;) {
    reference_hit hit;
    const reference_ray whole = {origin, direction, way.nearest, INFINITY};
    met = hl_reference_surface_next(all, REFERENCE_SEEN, &whole, way.nearest, &hit);
    way.farthest = met ? hit.distance : INFINITY;
    trace_part(all, &way, worker, &first);
    if (!met || ray->weight >= OPAQUE) break;
    double before = ray->weight;
    hl_reference_surface_shade(all, &hit, &way, worker);
    hl_reference_parts_add(ray, &worker->sample, (1 - before) * hit.opacity, all->scene->light_count);
    if (before < FIRST_OPACITY && ray->weight >= FIRST_OPACITY) {
      first = hit.distance;
      ray->object = worker->sample.object;
    }
    way.nearest = hit.distance;
  }
  return first;
}

/* Writes a pixel as the sum of the ray's contributions. */
static void write_pixel(const reference_parts *ray, size_t light_count, float rgba[4]) {
  for (int c = 0; c < 3; c++) {
    double sum = ray->ambient[c] + ray->emission[c] + ray->sky[c];
    for (size_t l = 0; l < light_count; l++) sum += ray->lights[l].picture[c];
    rgba[c] = (float)sum;
  }
  rgba[3] = (float)ray->weight;
}

/* Follows the pixel's random paths, adds the light that they find to the pixel's ambient light, and writes
 * the standard error of this light. */
static void follow_paths(const picture *all, size_t x, size_t y, reference_worker *worker) {
  size_t rays = (size_t)all->all->rays, pixel = y * (size_t)all->all->scene->width + x;
  double sum[3] = {0, 0, 0}, squares[3] = {0, 0, 0}, count = all->all->paths;
  for (int p = 0; p < all->all->paths && !hl_pool_stops(all->all->pool, worker->number); p++) {
    vec3 origin, direction;
    double one[3] = {0, 0, 0};
    size_t ray = (size_t)p % (rays * rays);
    eye_ray(all, x * rays + ray % rays, y * rays + ray / rays, &origin, &direction);
    hl_reference_path(all->all, origin, direction, ((uint64_t)pixel << 24 | (uint64_t)p) * 0x2545f4914f6cdd1d,
                      worker, one);
    for (int c = 0; c < 3; c++) sum[c] += one[c], squares[c] += one[c] * one[c];
  }
  for (int c = 0; c < 3; c++) {
    double mean = sum[c] / count, spread = fmax(squares[c] / count - mean * mean, 0);
    worker->pixel.ambient[c] += mean;
    if (all->all->error != NULL) all->all->error[3 * pixel + (size_t)c] = (float)sqrt(spread / count);
  }
}

/* Returns the number that occurs most often in the array. Of several numbers that occur equally often, the
 * function returns the least. Returns 0 if the array is empty. */
static int most_frequent(const int *numbers, size_t count) {
  size_t most = 0;
  int found = 0;
  for (size_t i = 0; i < count; i++) {
    size_t same = 0;
    for (size_t k = 0; k < count; k++) same += numbers[k] == numbers[i];
    if (same < most || (same == most && numbers[i] > found)) continue;
    most = same;
    found = numbers[i];
  }
  return found;
}

/* Averages the rays of a pixel. The first depth is averaged only over the rays that meet something. */
static void trace_pixel(const picture *all, size_t x, size_t y, int worker) {
  reference_worker *own = &all->workers[worker];
  size_t lights = all->all->scene->light_count, rays = (size_t)all->all->rays, hits = 0;
  int objects[HL_REFERENCE_RAYS * HL_REFERENCE_RAYS];
  double first = 0;
  hl_reference_parts_clear(&own->pixel, lights);
  for (size_t r = 0; r < rays * rays; r++) {
    vec3 origin, direction;
    eye_ray(all, x * rays + r % rays, y * rays + r / rays, &origin, &direction);
    double depth = trace(all->all, origin, direction, own);
    hl_reference_parts_add(&own->pixel, &own->ray, 1 / (double)(rays * rays), lights);
    if (!(depth < INFINITY)) continue;
    first += depth;
    objects[hits++] = own->ray.object;
  }
  own->pixel.object = most_frequent(objects, hits);
  if (all->all->paths > 0) follow_paths(all, x, y, own);
  write_pixel(&own->pixel, lights, all->pixels + y * all->row_stride + 4 * x);
  double depth_first = hits > 0 ? first / (double)hits : INFINITY;
  if (all->layers != NULL)
    hl_reference_parts_write(&own->pixel, depth_first, all->layers, y * (size_t)all->all->scene->width + x);
}

static void project_pixel(const picture *all, size_t x, size_t y, int worker) {
  size_t rays = (size_t)all->all->rays;
  float *pixel = all->pixels + y * all->row_stride + 4 * x;
  double sum[4] = {0, 0, 0, 0};
  for (size_t r = 0; r < rays * rays; r++) {
    vec3 origin, direction;
    float one[4];
    eye_ray(all, x * rays + r % rays, y * rays + r / rays, &origin, &direction);
    hl_reference_maximum(all->all, origin, direction, &all->workers[worker], one);
    for (int c = 0; c < 4; c++) sum[c] += (double)one[c];
  }
  for (int c = 0; c < 4; c++) pixel[c] = (float)(sum[c] / (double)(rays * rays));
}

/* Returns the stride between runs of pixels that are rendered one after the other. The stride has no common
 * divisor with the number of runs, so that each run is rendered once. The stride is near the golden section
 * of the number of runs, so that successive runs are spread evenly over the picture. A picture's border is
 * mostly empty and quick to render. Because of the even spread, the fraction of runs that are done tells the
 * fraction of time that has passed. */
static size_t stride_for(size_t count) {
  size_t stride = (size_t)(0.6180339887498949 * (double)count);
  for (bool common = true; common; stride += common) {
    size_t a = count, b = stride;
    while (b != 0) {
      size_t rest = a % b;
      a = b;
      b = rest;
    }
    common = a != 1;
  }
  return stride;
}

static void render_run(void *data, size_t number, int worker) {
  picture *all = data;
  const hl_scene_description *scene = all->all->scene;
  size_t index = (size_t)((uint64_t)number * all->stride % all->runs);
  size_t y = index / all->runs_per_row, first = index % all->runs_per_row * RUN_PIXELS;
  for (size_t x = first; x < first + RUN_PIXELS && x < (size_t)scene->width; x++) {
    if (hl_pool_stops(all->all->pool, worker)) return;
    if (scene->render.compositing == HL_COMPOSITING_MAXIMUM) project_pixel(all, x, y, worker);
    else trace_pixel(all, x, y, worker);
  }
  size_t done = atomic_fetch_add(&all->runs_done, 1) + 1;
  if (worker == 0) hl_progress(all->all->context, "render", (double)done / (double)all->runs);
}

static hl_status prepare(reference *all, const hl_reference_options *options, hl_pool *pool,
                         hl_error *error) {
  const hl_scene_description *scene = all->scene;
  all->volumes = hl_allocate_zeroed(all->context, scene->volume_count, sizeof *all->volumes);
  all->lights = hl_allocate_zeroed(all->context, scene->light_count, sizeof *all->lights);
  if (all->volumes == NULL || all->lights == NULL)
    return hl_fail_memory(error, scene->volume_count * sizeof *all->volumes,
                          "the reference's volumes and lights");
  double edge = INFINITY;
  for (size_t v = 0; v < scene->volume_count; v++) {
    hl_status status = hl_reference_volume_create(all, &scene->volumes[v], pool, &all->volumes[v], error);
    if (status != HL_OK) return status;
    edge = fmin(edge, all->volumes[v].smallest_edge);
  }
  for (size_t v = 0; v < scene->volume_count; v++) hl_reference_find_second(all, v);
  if (scene->volume_count == 0) edge = hl_scene_smallest_edge(scene);
  all->step = options->step * edge;
  all->rays = options->rays > 0 ? options->rays : hl_reference_rays(all, edge);
  hl_status made = hl_reference_surfaces_create(all, error);
  if (made != HL_OK) return made;
  all->error = options->error;
  for (size_t v = 0; v < scene->volume_count; v++)
    if (scene->volumes[v].multiple_scattering) all->paths = options->paths;
  double coarser = fmax(options->step / USUAL_STEP, 1);
  all->most_opacity = fmin(MOST_OPACITY * coarser * coarser, COARSEST_OPACITY);
  for (size_t l = 0; l < scene->light_count; l++) {
    hl_status status = hl_reference_light_create(all, &scene->lights[l], options->light_points,
                                                 &all->lights[l], error);
    if (status != HL_OK) return status;
  }
  return hl_reference_sky_create(all, options->light_points, error);
}

static void release(reference *all) {
  for (size_t v = 0; all->volumes != NULL && v < all->scene->volume_count; v++)
    hl_reference_volume_release(all->context, &all->volumes[v]);
  for (size_t l = 0; all->lights != NULL && l < all->scene->light_count; l++) {
    hl_release(all->context, all->lights[l].points);
    hl_release(all->context, all->lights[l].extent);
  }
  hl_release(all->context, all->volumes);
  hl_release(all->context, all->lights);
  hl_release(all->context, all->sky.cells);
  hl_reference_surfaces_release(all);
}

/* Makes the workers' state. All workers share four blocks of memory: one for the workers, one for their
 * crossings, one for their arrivals and one for their contributions. */
static reference_worker *workers_create(const reference *all, size_t threads) {
  size_t volumes = all->scene->volume_count, lights = all->scene->light_count;
  reference_worker *workers = hl_allocate_zeroed(all->context, threads, sizeof *workers);
  crossing *crossings = hl_allocate_zeroed(all->context, 2 * threads * volumes, sizeof *crossings);
  arrival *arrivals = hl_allocate_zeroed(all->context, threads * lights, sizeof *arrivals);
  light_part *parts = hl_allocate_zeroed(all->context, 3 * threads * lights, sizeof *parts);
  if (workers == NULL || crossings == NULL || arrivals == NULL || parts == NULL) {
    hl_release(all->context, workers);
    hl_release(all->context, crossings);
    hl_release(all->context, arrivals);
    hl_release(all->context, parts);
    return NULL;
  }
  for (size_t t = 0; t < threads; t++)
    workers[t] = (reference_worker){(int)t,
                                    crossings + 2 * t * volumes,
                                    crossings + (2 * t + 1) * volumes,
                                    arrivals + t * lights,
                                    {.lights = parts + 3 * t * lights},
                                    {.lights = parts + (3 * t + 1) * lights},
                                    {.lights = parts + (3 * t + 2) * lights}};
  return workers;
}

static void workers_release(hl_context *context, reference_worker *workers) {
  hl_release(context, workers[0].eye);
  hl_release(context, workers[0].arrivals);
  hl_release(context, workers[0].sample.lights);
  hl_release(context, workers);
}

static hl_status render(const reference *all, hl_pool *pool, float *pixels, size_t row_stride,
                        const hl_layers *layers, hl_error *error) {
  size_t threads = (size_t)hl_pool_threads(pool), width = (size_t)all->scene->width;
  picture made = {.all = all,
                  .eye = eye_rays_of(all->scene),
                  .pixels = pixels,
                  .layers = layers,
                  .row_stride = row_stride,
                  .runs_per_row = (width + RUN_PIXELS - 1) / RUN_PIXELS};
  made.runs = made.runs_per_row * (size_t)all->scene->height;
  made.stride = stride_for(made.runs);
  made.workers = workers_create(all, threads);
  if (made.workers == NULL)
    return hl_fail_memory(error, threads * sizeof(reference_worker), "the reference's threads");
  hl_pool_run(pool, made.runs, render_run, &made);
  workers_release(all->context, made.workers);
  return hl_pool_check(pool, "rendering", error);
}

void hl_reference_options_defaults(hl_reference_options *options) {
  if (options == NULL) return;
  *options = (hl_reference_options){
      .struct_size = sizeof *options, .light_points = 1024, .step = USUAL_STEP, .rays = 1, .paths = 64};
}

static hl_status check(const hl_reference_options *options, const hl_scene_description *scene,
                       size_t row_stride, hl_error *error) {
  if (options->struct_size != sizeof *options)
    return hl_fail(
        error, HL_ERROR_ARGUMENT,
        "hl_reference_render: struct_size is %zu, expected %zu: call hl_reference_options_defaults first",
        options->struct_size, sizeof *options);
  if (!(options->step >= 0.001 && options->step <= 100))
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_reference_render: step is %g, must be from 0.001 to 100 voxels", options->step);
  if (options->light_points < 1 || options->light_points > 1 << 20)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_reference_render: light_points is %d, must be from 1 to %d",
                   options->light_points, 1 << 20);
  if (options->threads < 0)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_reference_render: threads is %d, must be 0 or more",
                   options->threads);
  if (options->rays < 0 || options->rays > HL_REFERENCE_RAYS)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_reference_render: rays is %d, must be from 0 to %d",
                   options->rays, HL_REFERENCE_RAYS);
  if (options->paths < 1 || options->paths > 1 << 24)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_reference_render: paths is %d, must be from 1 to %d",
                   options->paths, 1 << 24);
  if (row_stride / 4 < (size_t)scene->width)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_reference_render: row_stride is %zu, a row needs %d x 4 floats", row_stride,
                   scene->width);
  return HL_OK;
}

static bool shadows_wanted(const hl_layers *layers) {
  for (size_t l = 0; layers != NULL && l < layers->light_count; l++)
    if (layers->lights[l].shadow != NULL) return true;
  return false;
}

hl_status hl_reference_render_layers(hl_context *context, const hl_scene *scene,
                                     const hl_reference_options *options, float *pixels, size_t row_stride,
                                     const hl_layers *layers, hl_error *error) {
  HL_DOOR;
  if (context == NULL || scene == NULL || pixels == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_reference_render: context, scene and pixels must not be null");
  hl_reference_options chosen;
  hl_reference_options_defaults(&chosen);
  if (options != NULL) chosen = *options;
  hl_status status = check(&chosen, &scene->description, row_stride, error);
  if (status == HL_OK) status = hl_layers_check(layers, &scene->description, error);
  if (status != HL_OK) return status;
  hl_pool *pool = NULL;
  const drawn_scene *drawn;
  status = hl_scene_draw(scene, &drawn, error);
  if (status == HL_OK) status = hl_pool_create(context, chosen.threads, &pool, error);
  if (status != HL_OK) return status;
  /* The reference renders the whole sky image. The reference makes no lights of the image's suns. */
  hl_scene_description whole = drawn->description;
  whole.sky = scene->description.sky;
  whole.light_count = scene->description.light_count;
  reference all = {.context = context, .pool = pool, .scene = &whole, .all_shadows = shadows_wanted(layers)};
  status = prepare(&all, &chosen, pool, error);
  if (status == HL_OK) status = render(&all, pool, pixels, row_stride, layers, error);
  release(&all);
  hl_pool_destroy(pool);
  if (status == HL_OK) status = hl_scene_show_sky(scene, pixels, row_stride, error);
  return status;
}

hl_status hl_reference_render(hl_context *context, const hl_scene *scene, const hl_reference_options *options,
                              float *pixels, size_t row_stride, hl_error *error) {
  HL_DOOR;
  return hl_reference_render_layers(context, scene, options, pixels, row_stride, NULL, error);
}
