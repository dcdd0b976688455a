/* scatter/direct.c - finds the lights' unscattered light at the nodes of the grid.
 *
 * The light that reaches a node is found for a few points of each light: extinction is summed on the way from
 * the node to the point, in steps as long as the distance of the nodes. A node holds the mean of the light
 * over the node's box. This mean is the light that reaches the lit side of the box, times (1 - exp(-t)) / t,
 * where t is the optical depth of the box. */
#include <math.h>
#include <string.h>

#include "light/light_extent.h"
#include "scatter/parts.h"

enum { SOFT_SIDE = 3 /* points along each side of a soft light's square */ };

/* exp(-x) for x >= 0. The result is the same on every machine. Derived: exp(-x) is 2^n (1 + a + ... + a^6 /
 * 6!), where n is -x / ln 2 rounded to a whole number, and a is ln 2 times the remainder of this rounding.
 * |a| is at most 0.35, so the remainder of the series is below 1e-7. */
static float falling(float x) {
  if (!(x < 80)) return 0;
  float y = -x * 1.44269504f, whole = floorf(y + 0.5f), a = (y - whole) * 0.693147181f;
  float series = 1 + a * (1 + a / 2 * (1 + a / 3 * (1 + a / 4 * (1 + a / 5 * (1 + a / 6)))));
  return ldexpf(series, (int)whole);
}

/* The mean of exp(-s) over 0 <= s <= t. */
static float mean_falling(float t) { return t > 1e-3f ? (1 - falling(t)) / t : 1 - t / 2; }

typedef struct direct_job {
  const scatter_scene *scene;
  const scatter_nodes *nodes;
  scatter_arrays *arrays;
  size_t node_count;
  const hl_light *light; /* the light in frame space; `source` is made from it */
  const light_source *source;
  light_cone cone;
  int side; /* number of points along each side of the unit square that stands for the light */
} direct_job;

/* Adds the extinction at a position in the grid, times a weight, to sums[channels]. at: the position, in
 * units of the grid's spacing. Returns false if the position lies outside the grid. */
static bool add_extinction(const direct_job *job, const float at[3], float weight, float *sums) {
  const int32_t *count = job->nodes->count;
  size_t low[3];
  float f[3];
  for (int a = 0; a < 3; a++) {
    if (!(at[a] >= 0 && at[a] < (float)(count[a] - 1))) return false;
    low[a] = (size_t)at[a];
    f[a] = at[a] - (float)low[a];
  }
  size_t row = (size_t)count[0], slice = row * (size_t)count[1];
  for (int c = 0; c < job->arrays->channels; c++) {
    const float *e = job->arrays->extinction + (size_t)c * job->node_count + low[2] * slice + low[1] * row +
                     low[0];
    float near[2];
    for (int z = 0; z < 2; z++, e += slice) {
      float front = e[0] + f[0] * (e[1] - e[0]), back = e[row] + f[0] * (e[row + 1] - e[row]);
      near[z] = front + f[1] * (back - front);
    }
    sums[c] += weight * (near[0] + f[2] * (near[1] - near[0]));
  }
  return true;
}

/* Finds, for each channel, the fraction of a light that passes the volumes on its way to a node. towards:
 * unit vector towards the light, which is `distance` away. */
static void find_passing(const direct_job *job, const int32_t at[3], size_t node, vec3 towards,
                         double distance, float passing[3]) {
  const double way[3] = {towards.x, towards.y, towards.z};
  double widest = fmax(fmax(fabs(way[0]), fabs(way[1])), fabs(way[2]));
  float depth[3] = {0, 0, 0}, through = (float)(job->nodes->spacing / widest);
  double step = 1 / widest, last = distance / job->nodes->spacing;
  for (double s = step; s < last; s += step) {
    float p[3];
    for (int a = 0; a < 3; a++) p[a] = (float)(at[a] + s * way[a]);
    if (!add_extinction(job, p, (float)step * job->nodes->spacing, depth)) break;
    if (depth[0] > 40 && job->arrays->channels == 1) break;
  }
  for (int c = 0; c < job->arrays->channels; c++)
    passing[c] = falling(depth[c]) *
                 mean_falling(job->arrays->extinction[(size_t)c * job->node_count + node] * through);
  for (int c = job->arrays->channels; c < 3; c++) passing[c] = passing[0];
}

/* The brightness of a spot light in a direction, as light_source.h defines it. */
static float within_cone(const light_cone *cone, vec3 towards) {
  if (!(cone->scale > 0)) return 1;
  double cosine = -(cone->axis[0] * towards.x + cone->axis[1] * towards.y + cone->axis[2] * towards.z);
  double x = fmin(fmax((cosine - cone->outer) * cone->scale, 0), 1);
  return (float)(x * x * (3 - 2 * x));
}

/* Multiplies the light of a ray by the fraction that a mesh lets pass at the point where the ray meets the
 * mesh. */
static void meet_mesh(void *data, const surface_hit *hit) {
  float *passing = data;
  const double *color = hit->mesh->look.attenuation_color;
  for (int c = 0; c < 3; c++) passing[c] *= (float)(1 - hit->opacity * color[c]);
}

/* Adds the light of one point of a light to a node. The points of a light have equal parts of its light. */
static void add_point(const direct_job *job, const int32_t at[3], size_t node, const double square[2]) {
  const light_source *source = job->source;
  vec3 offset = job->side > 1 ? hl_light_point(source, square[0], square[1]) : (vec3){0, 0, 0};
  vec3 here = {job->nodes->origin[0] + (double)job->nodes->spacing * at[0],
               job->nodes->origin[1] + (double)job->nodes->spacing * at[1],
               job->nodes->origin[2] + (double)job->nodes->spacing * at[2]};
  vec3 way = source->parallel ? vec3_scale(vec3_add(source->direction, offset), -1)
                              : vec3_subtract(vec3_add(source->position, offset), here);
  double distance = vec3_length(way), centre = 1;
  float passing[3], strength = 1 / (float)(job->side * job->side);
  if (source->of_sky > 0) strength *= (float)source->of_sky;
  if (!(distance > 0)) return;
  vec3 towards = vec3_scale(way, 1 / distance);
  if (!source->parallel) {
    centre = fmax(vec3_length(vec3_subtract(source->position, here)), job->nodes->spacing / 2);
    strength *= within_cone(&job->cone, towards);
    if (job->light->falloff == HL_FALLOFF_INVERSE_SQUARE) strength /= (float)(centre * centre);
  }
  find_passing(job, at, node, towards, source->parallel ? INFINITY : distance, passing);
  vec3 from = vec3_add(here, vec3_scale(SCATTER_BESIDE, job->nodes->spacing));
  hl_surface_tree_cast(job->arrays->tree, &(surface_ray){from, way, 0, source->parallel ? INFINITY : 1},
                       meet_mesh, passing);
  for (int c = 0; c < 3; c++)
    job->arrays->direct[(size_t)c * job->node_count + node] +=
        strength * passing[c] * (float)(job->light->color[c] * job->light->intensity);
}

/* Lights one row of nodes. Nodes that scatter nothing need no light. */
static void light_row(void *data, size_t row, int worker) {
  (void)worker;
  const direct_job *job = data;
  const int32_t *count = job->nodes->count;
  for (int32_t x = 0; x < count[0]; x++) {
    const int32_t at[3] = {x, (int32_t)(row % (size_t)count[1]), (int32_t)(row / (size_t)count[1])};
    size_t node = row * (size_t)count[0] + (size_t)x;
    float scattering = 0;
    for (int c = 0; c < job->arrays->channels; c++)
      scattering += job->arrays->scattering[(size_t)c * job->node_count + node];
    for (int p = 0; p < job->side * job->side && scattering > 0; p++) {
      double square[2] = {0.5, 0.5};
      if (job->side > 1) hl_sublight_grid_point(job->side, p % job->side, p / job->side, square);
      add_point(job, at, node, square);
    }
  }
}

void hl_scatter_fill_direct(const scatter_scene *scene, const scatter_nodes *nodes, scatter_arrays *arrays) {
  direct_job job = {
      .scene = scene, .nodes = nodes, .arrays = arrays, .node_count = hl_scatter_node_count(nodes)};
  memset(arrays->direct, 0, 3 * job.node_count * sizeof *arrays->direct);
  vec3 middle = {nodes->origin[0] + 0.5 * nodes->spacing * (nodes->count[0] - 1),
                 nodes->origin[1] + 0.5 * nodes->spacing * (nodes->count[1] - 1),
                 nodes->origin[2] + 0.5 * nodes->spacing * (nodes->count[2] - 1)};
  for (size_t l = 0; l < scene->scene->light_count; l++) {
    light_source source = hl_light_source(&scene->scene->lights[l], &scene->scene->render, middle);
    source.of_sky = scene->sun_parts[l];
    if (source.shadows == HL_SHADOWS_OFF) continue;
    job.light = &scene->scene->lights[l];
    job.source = &source;
    job.side = source.shadows == HL_SHADOWS_SOFT ? SOFT_SIDE : 1;
    job.cone = hl_light_cone(&source, middle, nodes->spacing);
    hl_pool_run(scene->pool, (size_t)nodes->count[1] * (size_t)nodes->count[2], light_row, &job);
  }
}
