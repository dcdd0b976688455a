/* surface/clusters.c - see clusters.h. */
#include "surface/clusters.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "mesh/mesh.h"
#include "surface/cluster_order.h"
#include "surface/primitive.h"

enum { A_TASK = 1 << 9 };

static uint64_t clusters_of(uint64_t primitives) { return (primitives + CLUSTER_SIZE - 1) / CLUSTER_SIZE; }

/* The number of a cluster's vertices, rounded up to a multiple of sixteen, because vertices are read sixteen
 * at a time. */
static uint16_t filled_up(uint32_t vertices) { return (uint16_t)((vertices + 15) / 16 * 16); }

/* ---- memory ---- */

/* The numbers of clusters and of primitives of a scene's meshes. */
typedef struct cluster_counts {
  size_t all, with_corners; /* all: the number of all clusters; with_corners: the number of the clusters whose
                             * primitives have corners */
  size_t primitives;
  uint64_t most; /* the greatest number of primitives of one kind in one mesh */
} cluster_counts;

/* Counts the primitives of kind number k that a mesh has. */
static void count_kind(int k, uint64_t primitives, cluster_counts *counts) {
  if (hl_primitive_kinds[k]->has_corners) counts->with_corners += clusters_of(primitives);
  counts->all += clusters_of(primitives);
  counts->primitives += primitives;
  counts->most = primitives > counts->most ? primitives : counts->most;
}

/* Lays out the arrays of the clusters in one block of memory. all->clusters is the first array of the
 * block. */
static void lay_out(const cluster_counts *counts, surfaces *all, hl_layout *layout) {
  all->clusters = hl_layout_take(layout, counts->all, sizeof *all->clusters);
  all->order = hl_layout_take(layout, counts->primitives, sizeof *all->order);
  all->cluster_corners = hl_layout_take(layout, counts->with_corners, sizeof *all->cluster_corners);
  all->cluster_normals = hl_layout_take(layout, counts->with_corners, sizeof *all->cluster_normals);
}

static uint32_t *lay_out_spare(const cluster_counts *counts, hl_layout *layout) {
  return hl_layout_take(layout, counts->most, ORDER_SPARE * sizeof(uint32_t));
}

static void lay_out_vertices(size_t vertices, surfaces *all, hl_layout *layout) {
  all->cluster_positions = hl_layout_take(layout, vertices, sizeof(float[3]));
}

void hl_clusters_count(const hl_scene_description *scene, hl_layout *layout) {
  cluster_counts counts = {0};
  surfaces all = {0};
  for (size_t m = 0; m < scene->mesh_count; m++)
    for (int k = 0; k < PRIMITIVE_KINDS; k++)
      count_kind(k, hl_primitive_kinds[k]->count(&scene->meshes[m].mesh->description), &counts);
  lay_out(&counts, &all, layout);
  lay_out_vertices(counts.with_corners * CLUSTER_SIZE, &all, layout);
  const size_t kept = layout->bytes;
  lay_out_spare(&counts, layout);
  hl_layout_give_back(layout, kept);
}

/* ---- boxes ---- */

static void find_box(const surfaces *all, surface_cluster *cluster) {
  for (int axis = 0; axis < 3; axis++) cluster->low[axis] = INFINITY, cluster->high[axis] = -INFINITY;
  for (uint32_t i = cluster->first; i < cluster->first + cluster->count; i++) {
    const uint32_t p = all->order[i];
    float low[3], high[3];
    hl_primitive_kind(all, p)->bound(all, p, low, high);
    for (int axis = 0; axis < 3; axis++) {
      cluster->low[axis] = low[axis] < cluster->low[axis] ? low[axis] : cluster->low[axis];
      cluster->high[axis] = high[axis] > cluster->high[axis] ? high[axis] : cluster->high[axis];
    }
  }
}

/* ---- cones ---- */

/* Finds the cone of a cluster's normals: the mean of the normals, and the greatest angle between a normal and
 * the mean. Triangles without an area have no normal. Such triangles do not count, because they are never
 * seen. Primitives without corners have normals in all directions. */
static void find_cone(const surfaces *all, surface_cluster *cluster) {
  vec3 normals[CLUSTER_SIZE], sum = {0, 0, 0};
  double least = 1;
  cluster->cosine = -1;
  memset(cluster->axis, 0, sizeof cluster->axis);
  if (!hl_has_corners(all, cluster->first)) return;
  for (int i = 0; i < cluster->count; i++) {
    normals[i] = hl_surface_normal(all, all->order[cluster->first + (uint32_t)i]);
    if (vec3_length(normals[i]) < 2) sum = vec3_add(sum, normals[i]); /* normals that are NaN are left out */
  }
  vec3 axis = vec3_normalise(sum);
  if (!(vec3_length(axis) < 2)) return;
  for (int i = 0; i < cluster->count; i++) least = fmin(least, vec3_dot(axis, normals[i]));
  vec3_store(cluster->axis, axis);
  cluster->cosine = (float)least;
}

/* ---- vertices ---- */

/* A set of the vertices of a cluster. It is a hash table. */
enum { SLOTS = 512 };
typedef struct vertex_set {
  uint32_t slot[SLOTS]; /* the vertex's index in `vertex`, plus 1; if 0, the slot is free */
  uint32_t vertex[CLUSTER_VERTICES], count;
} vertex_set;

static uint8_t number_of(vertex_set *set, uint32_t vertex) {
  uint32_t at = vertex * 2654435769u >> 23;
  for (; set->slot[at] != 0; at = (at + 1) % SLOTS)
    if (set->vertex[set->slot[at] - 1] == vertex) return (uint8_t)(set->slot[at] - 1);
  set->vertex[set->count] = vertex;
  set->slot[at] = ++set->count;
  return (uint8_t)(set->count - 1);
}

/* Gives numbers to the vertices of cluster number c, which must consist of triangles. */
static void number_vertices(surfaces *all, size_t c, vertex_set *set) {
  surface_cluster *cluster = &all->clusters[c];
  memset(set->slot, 0, sizeof set->slot);
  set->count = 0;
  memset(all->cluster_corners[c], 0, sizeof all->cluster_corners[c]);
  for (uint32_t t = 0; t < cluster->count; t++)
    for (int i = 0; i < 3; i++)
      all->cluster_corners[c][i][t] = number_of(set, all->triangles[all->order[cluster->first + t]][i]);
  cluster->vertices = filled_up(set->count);
}

static void copy_normals(surfaces *all, size_t c) {
  const surface_cluster *cluster = &all->clusters[c];
  memset(all->cluster_normals[c], 0, sizeof all->cluster_normals[c]);
  for (uint32_t t = 0; t < cluster->count; t++) {
    const uint32_t *vertex = all->triangles[all->order[cluster->first + t]];
    const float *const corner[3] = {all->positions[vertex[0]], all->positions[vertex[1]],
                                    all->positions[vertex[2]]};
    float normal[3];
    hl_corner_product(corner, normal);
    for (int axis = 0; axis < 3; axis++) all->cluster_normals[c][axis][t] = normal[axis];
  }
}

/* ---- all clusters ---- */

static size_t end_of_task(size_t task, size_t count) {
  return (task + 1) * A_TASK < count ? (task + 1) * A_TASK : count;
}

static void describe_task(void *data, size_t task, int worker) {
  (void)worker;
  surfaces *all = data;
  vertex_set set;
  for (size_t c = task * A_TASK; c < end_of_task(task, all->cluster_count); c++) {
    find_box(all, &all->clusters[c]);
    find_cone(all, &all->clusters[c]);
    if (!hl_has_corners(all, all->clusters[c].first)) continue;
    number_vertices(all, c, &set);
    copy_normals(all, c);
  }
}

static void copy_task(void *data, size_t task, int worker) {
  (void)worker;
  surfaces *all = data;
  vertex_set set;
  for (size_t c = task * A_TASK; c < end_of_task(task, all->cluster_count); c++) {
    const surface_cluster *cluster = &all->clusters[c];
    if (!hl_has_corners(all, cluster->first)) continue;
    float *to = all->cluster_positions + 3 * cluster->first_vertex;
    number_vertices(all, c, &set);
    for (uint32_t v = 0; v < cluster->vertices; v++)
      for (int axis = 0; axis < 3; axis++)
        to[(size_t)axis * cluster->vertices + v] = all->positions[set.vertex[v < set.count ? v : 0]][axis];
  }
}

/* Divides the primitives of a mesh into clusters; returns the number of clusters. */
static size_t cut(surface_cluster *clusters, size_t mesh, uint32_t first, uint32_t count) {
  size_t made = 0;
  for (uint32_t at = 0; at < count; at += CLUSTER_SIZE) {
    uint32_t own = count - at < CLUSTER_SIZE ? count - at : CLUSTER_SIZE;
    clusters[made++] = (surface_cluster){.first = first + at, .count = (uint16_t)own, .mesh = (uint16_t)mesh};
  }
  return made;
}

/* Orders the primitives, and cuts them into clusters. */
static void cut_all(hl_pool *pool, surfaces *all, uint32_t *spare) {
  size_t count = 0;
  for (int k = 0; k < PRIMITIVE_KINDS; k++)
    for (size_t m = 0; m < all->mesh_count; m++) {
      const primitive_range own = all->meshes[m].primitives[k];
      hl_cluster_order_fill(pool, all, own.first, own.count, spare);
      count += cut(all->clusters + count, m, own.first, own.count);
    }
}

/* Gives each cluster of triangles a place for its own copy of the vertices. Returns the number of vertices in
 * all these copies. */
static size_t place_vertices(surfaces *all, size_t triangles) {
  size_t vertices = 0;
  for (size_t c = 0; c < triangles; c++) {
    all->clusters[c].first_vertex = vertices;
    vertices += all->clusters[c].vertices;
  }
  return vertices;
}

hl_status hl_clusters_create(hl_context *context, hl_pool *pool, surfaces *all, hl_error *error) {
  cluster_counts counts = {0};
  for (size_t m = 0; m < all->mesh_count; m++)
    for (int k = 0; k < PRIMITIVE_KINDS; k++) count_kind(k, all->meshes[m].primitives[k].count, &counts);
  const size_t tasks = (counts.all + A_TASK - 1) / A_TASK;
  uint32_t *spare = NULL;
  hl_layout kept = {0}, passing = {0}, vertices = {0};
  all->cluster_count = counts.all;
  while (hl_layout_pass(&kept, context)) lay_out(&counts, all, &kept);
  if (kept.base == NULL) return hl_fail_memory(error, kept.bytes, "the meshes");
  while (hl_layout_pass(&passing, context)) spare = lay_out_spare(&counts, &passing);
  if (passing.base == NULL) return hl_fail_memory(error, passing.bytes, "the meshes");
  cut_all(pool, all, spare);
  hl_release(context, passing.base);
  hl_pool_run(pool, tasks, describe_task, all);
  const size_t vertex_count = place_vertices(all, counts.with_corners);
  while (hl_layout_pass(&vertices, context)) lay_out_vertices(vertex_count, all, &vertices);
  if (vertices.base == NULL) return hl_fail_memory(error, vertices.bytes, "the meshes");
  hl_pool_run(pool, tasks, copy_task, all);
  return HL_OK;
}

void hl_clusters_release(hl_context *context, surfaces *all) {
  hl_release(context, all->clusters);
  hl_release(context, all->cluster_positions);
}

/* The sine of the smallest angle that counts. A triangle counts as turned away from the view only if it is
 * turned away by more than this angle. */
static const double AWAY = 0.02;

/* Returns whether all triangles of a cluster surely turn their backs to a view. Derived: let v be the vector
 * from the eye to the middle of the box, t the angle between v and the cone's axis n, and m a normal that
 * differs from n by at most the angle a. Then m.v >= |v| cos(t + a). Let r be half the box's diagonal.
 * Another point of the box lies at v + w with |w| <= r, so m.(v + w) >= |v| cos(t + a) - r. */
bool hl_cluster_faces_away(const surface_cluster *cluster, const view *view) {
  vec3 low = hl_surface_vector(cluster->low), high = hl_surface_vector(cluster->high), way = view->direction;
  double reach = 0, a = cluster->cosine;
  if (!(a > 0)) return false;
  if (view->perspective) {
    way = vec3_subtract(vec3_scale(vec3_add(low, high), 0.5), view->origin);
    reach = vec3_length(vec3_subtract(high, low)) / 2;
  }
  double length = vec3_length(way), t = vec3_dot(way, hl_surface_vector(cluster->axis)) / length;
  double both = t * a - sqrt(fmax(1 - t * t, 0) * fmax(1 - a * a, 0));
  return length * (both - AWAY) > reach;
}

double hl_lowest_height(const sheet_stack *sheets, const surface_cluster *cluster) {
  const double n[3] = {sheets->normal.x, sheets->normal.y, sheets->normal.z};
  double height = -sheets->first;
  for (int axis = 0; axis < 3; axis++)
    height += n[axis] * (double)(n[axis] > 0 ? cluster->low[axis] : cluster->high[axis]);
  return height;
}
