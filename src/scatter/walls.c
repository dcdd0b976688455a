/* scatter/walls.c - finds how meshes attenuate the light along the lines of the grid.
 *
 * A few rays beside each line are tested for meshes. The mean of the fractions of light that pass along these
 * rays serves as the fraction that meshes let pass between two nodes. Beyond the ends of the line the rays
 * spread over the part of the sky for which the line stands. For each channel of extinction, the fractions
 * are turned into optical depths (derived). A wall lets the fraction T of light through and sends none back.
 * With t = (1 - T) / (1 + T), the mean u of both ways, and the excess v of the light that travels onwards,
 * obey on its two sides
 *
 *     v_1 = t u_1 + (u_1 - u_2) / d,  v_2 = (u_1 - u_2) / d - t u_2,  d = 2 t / (1 - t^2)
 *
 * So a wall adds t to the depths of the nodes on both sides, and the depth d between them. Let matter of the
 * depth r lie between each node and the wall. Then even light on both sides (u_1 = u_2) meets 1 / t + r
 * instead of 1 / t, and opposite light (u_1 = -u_2) meets t + r instead of t. So t and d become
 *
 *     t' = t / (1 + r t),  d' = 2 (t + r) (1 + r t) / (1 - t^2) */
#include <math.h>

#include "scatter/parts.h"

enum { RAYS = 2 /* number of rays through a node's box, along each side */ };

/* The side, in radians, of the square of directions of the sky that are nearest to one line, approximately:
 * sqrt(4 pi / 26). The rays leave the grid in different directions within this square. */
static const double CELL_OF_SKY = 0.695;

/* A wall counts as letting at least this fraction of light pass, so that optical depths are finite. */
static const float LEAST_PASSING = 1.0f / 16384;

typedef struct wall_job {
  const surface_tree *tree;
  const scatter_nodes *nodes;
  const scatter_walls *walls;
} wall_job;

/* The fractions of light that meshes let through along one ray: before its first node, between its nodes, and
 * after its last node. */
typedef struct wall_ray {
  vec3 origin, step; /* position of the first node, and step from node to node */
  vec3 tilt;         /* a vector that is added to the unit vector from an end of the ray towards the sky, so
                      * that rays spread over the sky */
  double passing[SCATTER_MOST_NODES + 1];
  int count; /* number of nodes */
} wall_ray;

static double passing_of(const surface_hit *hit) {
  const double *color = hit->mesh->look.attenuation_color;
  return 1 - hit->opacity * (color[0] + color[1] + color[2]) / 3;
}

static void meet_between(void *data, const surface_hit *hit) {
  wall_ray *ray = data;
  ray->passing[(int)fmin(floor(hit->distance), ray->count - 2) + 1] *= passing_of(hit);
}

static void meet_beyond(void *data, const surface_hit *hit) { *(double *)data *= passing_of(hit); }

/* Returns whether the grid has a node at a place, which is given in steps from the first node. */
static bool is_node(const scatter_nodes *nodes, const int32_t at[3]) {
  for (int a = 0; a < 3; a++)
    if (at[a] < 0 || at[a] >= nodes->count[a]) return false;
  return true;
}

/* Places one of the rays of a line. */
static void place_ray(const scatter_nodes *nodes, int line, const int32_t from[3], int index, wall_ray *ray) {
  const int *way = hl_scatter_step(line);
  int major = way[0] != 0 ? 0 : way[1] != 0 ? 1 : 2, across = (major + 1) % 3, down = (major + 2) % 3;
  const double beside[3] = {SCATTER_BESIDE.x, SCATTER_BESIDE.y, SCATTER_BESIDE.z};
  double origin[3], step[3], part[3] = {0, 0, 0};
  part[across] = (index % RAYS + 0.5) / RAYS - 0.5;
  part[down] = (index / RAYS + 0.5) / RAYS - 0.5;
  for (int a = 0; a < 3; a++) {
    origin[a] = (double)nodes->origin[a] + (double)nodes->spacing * (from[a] + beside[a] + part[a]);
    step[a] = (double)nodes->spacing * way[a];
  }
  ray->origin = vec3_of(origin), ray->step = vec3_of(step);
  ray->tilt = vec3_scale(vec3_of(part), CELL_OF_SKY);
}

/* The fraction of light that meshes let through between an end of the ray and the sky. */
static double passing_beyond(const surface_tree *tree, const wall_ray *ray, double at, double sign) {
  vec3 way = vec3_add(vec3_scale(vec3_normalise(ray->step), sign), ray->tilt);
  double passing = 1;
  hl_surface_tree_cast(tree,
                       &(surface_ray){vec3_add(ray->origin, vec3_scale(ray->step, at)), way, 0, INFINITY},
                       meet_beyond, &passing);
  return passing;
}

static void follow_ray(const surface_tree *tree, wall_ray *ray) {
  double last = ray->count - 1;
  for (int i = 0; i <= ray->count; i++) ray->passing[i] = 1;
  hl_surface_tree_cast(tree, &(surface_ray){ray->origin, ray->step, 0, last}, meet_between, ray);
  ray->passing[0] = passing_beyond(tree, ray, 0, -1);
  ray->passing[ray->count] = passing_beyond(tree, ray, last, 1);
}

/* Finds the fractions that meshes let through along one line, from its first node on. */
static void fill_line(const wall_job *job, int line, const int32_t from[3]) {
  const int32_t *count = job->nodes->count;
  const int *way = hl_scatter_step(line);
  size_t first = ((size_t)from[2] * (size_t)count[1] + (size_t)from[1]) * (size_t)count[0] + (size_t)from[0];
  ptrdiff_t step = (ptrdiff_t)way[0] + ((ptrdiff_t)way[2] * count[1] + way[1]) * count[0];
  wall_ray ray = {.count = 0};
  for (int32_t at[3] = {from[0], from[1], from[2]}; is_node(job->nodes, at); ray.count++)
    for (int a = 0; a < 3; a++) at[a] += way[a];
  float *outside = job->walls->outside[line] + first, *after = job->walls->after[line] + first;
  for (int k = 0; k < RAYS * RAYS; k++) {
    place_ray(job->nodes, line, from, k, &ray);
    follow_ray(job->tree, &ray);
    *outside += (float)ray.passing[0] / (RAYS * RAYS);
    for (int i = 0; i < ray.count; i++) after[i * step] += (float)ray.passing[i + 1] / (RAYS * RAYS);
  }
}

/* Finds the fractions for the lines of one direction that begin in one slice of nodes. */
static void fill_lines(void *data, size_t index, int worker) {
  (void)worker;
  const wall_job *job = data;
  const int32_t *count = job->nodes->count;
  int line = (int)(index / (size_t)count[2]);
  const int *way = hl_scatter_step(line);
  int32_t from[3] = {0, 0, (int32_t)(index % (size_t)count[2])};
  for (from[1] = 0; from[1] < count[1]; from[1]++)
    for (from[0] = 0; from[0] < count[0]; from[0]++) {
      const int32_t before[3] = {from[0] - way[0], from[1] - way[1], from[2] - way[2]};
      if (!is_node(job->nodes, before)) fill_line(job, line, from);
    }
}

void hl_scatter_fill_walls(const scatter_scene *scene, const scatter_nodes *nodes, const surface_tree *tree,
                           const scatter_walls *walls) {
  wall_job job = {tree, nodes, walls};
  size_t bytes = hl_scatter_node_count(nodes) * sizeof(float);
  for (int line = 0; line < SCATTER_LINES; line++) {
    hl_pool_clear(scene->pool, walls->outside[line], bytes);
    hl_pool_clear(scene->pool, walls->after[line], bytes);
  }
  hl_pool_run(scene->pool, SCATTER_LINES * (size_t)nodes->count[2], fill_lines, &job);
}

void hl_scatter_add_wall(const scatter_walls *walls, int line, size_t node, size_t next,
                         const float *extinction, float length) {
  float passing = fmaxf(walls->after[line][node], LEAST_PASSING), t = (1 - passing) / (1 + passing),
        r = 0.25f * length * (extinction[node] + extinction[next]), met = 1 + r * t;
  walls->between[line][node] = 2 * (t + r) * met / (1 - t * t);
  walls->at_node[line][node] += t / met;
  walls->at_node[line][next] += t / met;
}
