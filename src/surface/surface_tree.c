/* surface/surface_tree.c - makes the tree of boxes, and follows rays through it. */
#include "surface/surface_tree.h"

#include "core/memory.h"
#include "mesh/mesh.h"

/* A range is halved at the middle of its primitives' middles, and by their number where this would make the
 * tree too deep. */
enum { LEAF_PRIMITIVES = 4, DEEP = 32, DEEPEST = DEEP + 40 };

/* ---- primitives ---- */

static void box_of(const surfaces *all, uint32_t primitive, float low[3], float high[3]) {
  if (primitive >= all->triangle_count) {
    const float *sphere = all->spheres[primitive - all->triangle_count];
    for (int a = 0; a < 3; a++) {
      float reach = sphere[3] + 1e-6f * (fabsf(sphere[a]) + sphere[3]); /* what rounding may take */
      low[a] = sphere[a] - reach, high[a] = sphere[a] + reach;
    }
    return;
  }
  const uint32_t *corners = all->triangles[primitive];
  for (int a = 0; a < 3; a++) {
    low[a] = high[a] = all->positions[corners[0]][a];
    for (int i = 1; i < 3; i++) {
      low[a] = fminf(low[a], all->positions[corners[i]][a]);
      high[a] = fmaxf(high[a], all->positions[corners[i]][a]);
    }
  }
}

static float middle_of(const surfaces *all, uint32_t primitive, int axis) {
  float low[3], high[3];
  box_of(all, primitive, low, high);
  return low[axis] + (high[axis] - low[axis]) / 2;
}

/* ---- the tree ---- */

/* Moves the primitives whose middle lies below `at` to the front; returns how many. */
static uint32_t part(const surface_tree *tree, uint32_t first, uint32_t count, int axis, float at) {
  uint32_t *primitives = tree->primitives + first, below = 0;
  for (uint32_t i = 0; i < count; i++) {
    uint32_t moved = primitives[i];
    if (middle_of(tree->all, moved, axis) >= at) continue;
    primitives[i] = primitives[below];
    primitives[below++] = moved;
  }
  return below;
}

/* Makes the tree of a range of primitives, which it sorts. */
static void make(surface_tree *tree, uint32_t first, uint32_t count, int depth) {
  surface_box *made = &tree->boxes[tree->box_count++];
  float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  *made = (surface_box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, first, count};
  for (uint32_t i = first; i < first + count; i++) {
    float from[3], to[3];
    box_of(tree->all, tree->primitives[i], from, to);
    for (int a = 0; a < 3; a++) {
      float middle = from[a] + (to[a] - from[a]) / 2;
      made->low[a] = fminf(made->low[a], from[a]), made->high[a] = fmaxf(made->high[a], to[a]);
      low[a] = fminf(low[a], middle), high[a] = fmaxf(high[a], middle);
    }
  }
  if (count <= LEAF_PRIMITIVES) return;
  int axis = 0;
  for (int other = 1; other < 3; other++)
    if (high[other] - low[other] > high[axis] - low[axis]) axis = other;
  uint32_t below = part(tree, first, count, axis, low[axis] + (high[axis] - low[axis]) / 2);
  if (below == 0 || below == count || depth >= DEEP) below = count / 2;
  made->count = 0;
  make(tree, first, below, depth + 1);
  made->first = tree->box_count;
  make(tree, first + below, count - below, depth + 1);
}

static size_t most_boxes(size_t primitives) { return 2 * primitives; }

uint64_t hl_surface_tree_bytes(const hl_scene_description *scene) {
  uint64_t count = 0;
  for (size_t m = 0; m < scene->mesh_count; m++) {
    const hl_mesh_description *d = &scene->meshes[m].mesh->description;
    if (hl_mesh_takes_light(&scene->meshes[m])) count += d->triangle_count + d->sphere_count;
  }
  return count * sizeof(uint32_t) + most_boxes(count) * sizeof(surface_box);
}

static void take_primitives(surface_tree *tree, const surface_mesh *mesh) {
  const surfaces *all = tree->all;
  if (!hl_mesh_takes_light(mesh->scene)) return;
  for (uint32_t t = 0; t < mesh->triangle_count; t++)
    tree->primitives[tree->count++] = mesh->first_triangle + t;
  for (uint32_t s = 0; s < mesh->sphere_count; s++)
    tree->primitives[tree->count++] = all->triangle_count + mesh->first_sphere + s;
}

hl_status hl_surface_tree_create(hl_context *context, const surfaces *all, surface_tree *tree,
                                 hl_error *error) {
  *tree = (surface_tree){.all = all};
  size_t count = 0;
  for (size_t m = 0; all != NULL && m < all->mesh_count; m++)
    if (hl_mesh_takes_light(all->meshes[m].scene))
      count += all->meshes[m].triangle_count + all->meshes[m].sphere_count;
  if (count == 0) return HL_OK;
  tree->primitives = hl_allocate(context, count, sizeof *tree->primitives);
  tree->boxes = hl_allocate(context, most_boxes(count), sizeof *tree->boxes);
  if (tree->primitives == NULL || tree->boxes == NULL) {
    hl_surface_tree_release(context, tree);
    return hl_fail_memory(error, most_boxes(count) * sizeof *tree->boxes, "the boxes of meshes");
  }
  for (size_t m = 0; m < all->mesh_count; m++) take_primitives(tree, &all->meshes[m]);
  make(tree, 0, tree->count, 0);
  return HL_OK;
}

void hl_surface_tree_release(hl_context *context, surface_tree *tree) {
  hl_release(context, tree->primitives);
  hl_release(context, tree->boxes);
  *tree = (surface_tree){0};
}

/* ---- rays ---- */

/* The slab method. */
static bool meets_box(const surface_box *box, const surface_ray *ray) {
  const double o[3] = {ray->origin.x, ray->origin.y, ray->origin.z},
               d[3] = {ray->way.x, ray->way.y, ray->way.z};
  double nearest = ray->first, farthest = ray->last;
  for (int a = 0; a < 3; a++) {
    double low = (double)box->low[a] - o[a], high = (double)box->high[a] - o[a];
    if (d[a] == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    double from = low / d[a], to = high / d[a];
    nearest = fmax(nearest, fmin(from, to)), farthest = fmin(farthest, fmax(from, to));
  }
  return nearest <= farthest + 1e-9 * fabs(farthest); /* boxes of flat triangles are flat */
}

/* Moeller and Trumbore, "Fast, minimum storage ray/triangle intersection" (1997). */
static bool meet_triangle(const surfaces *all, uint32_t primitive, const surface_ray *ray, double *distance) {
  const uint32_t *corners = all->triangles[primitive];
  vec3 a = hl_surface_vector(all->positions[corners[0]]),
       ab = vec3_subtract(hl_surface_vector(all->positions[corners[1]]), a),
       ac = vec3_subtract(hl_surface_vector(all->positions[corners[2]]), a);
  vec3 p = vec3_cross(ray->way, ac), away = vec3_subtract(ray->origin, a), q = vec3_cross(away, ab);
  double determinant = vec3_dot(ab, p);
  if (determinant == 0) return false;
  double u = vec3_dot(away, p) / determinant, v = vec3_dot(ray->way, q) / determinant;
  *distance = vec3_dot(ac, q) / determinant;
  return u >= 0 && v >= 0 && u + v <= 1 && *distance > ray->first && *distance < ray->last;
}

static double opacity_of(const surfaces *all, const surface_mesh *mesh, uint32_t primitive) {
  double opacity = mesh->scene->opacity, sum = 0;
  if (primitive >= all->triangle_count) {
    uint32_t sphere = primitive - all->triangle_count - mesh->first_sphere;
    return mesh->sphere_colors == NULL ? opacity : opacity * (double)mesh->sphere_colors[sphere][3];
  }
  if (mesh->face_colors != NULL) opacity *= (double)mesh->face_colors[primitive - mesh->first_triangle][3];
  if (mesh->colors == NULL) return opacity;
  for (int i = 0; i < 3; i++)
    sum += (double)mesh->colors[all->triangles[primitive][i] - mesh->first_vertex][3] / 3;
  return opacity * sum;
}

/* A ray meets a sphere twice: |origin + s way - centre| = r. */
static int meet_sphere(const float sphere[4], const surface_ray *ray, double distance[2]) {
  vec3 away = vec3_subtract(ray->origin, hl_surface_vector(sphere));
  double square = vec3_dot(ray->way, ray->way), along = vec3_dot(away, ray->way) / square;
  vec3 nearest = vec3_subtract(away, vec3_scale(ray->way, along));
  double left = ((double)sphere[3] * (double)sphere[3] - vec3_dot(nearest, nearest)) / square;
  int count = 0;
  for (int side = -1; side <= 1 && left > 0; side += 2) {
    double at = -along + side * sqrt(left);
    if (at > ray->first && at < ray->last) distance[count++] = at;
  }
  return count;
}

static void meet_leaf(const surface_tree *tree, const surface_box *leaf, const surface_ray *ray,
                      surface_met *met, void *data) {
  const surfaces *all = tree->all;
  for (uint32_t i = leaf->first; i < leaf->first + leaf->count; i++) {
    uint32_t primitive = tree->primitives[i];
    double distance[2];
    int count = primitive < all->triangle_count
                    ? meet_triangle(all, primitive, ray, distance)
                    : meet_sphere(all->spheres[primitive - all->triangle_count], ray, distance);
    if (count == 0) continue;
    const surface_mesh *mesh = &all->meshes[hl_surface_mesh_of(all, primitive)];
    double opacity = fmin(fmax(opacity_of(all, mesh, primitive), 0), 1);
    for (int k = 0; k < count; k++)
      if (hl_surface_left(all, mesh, vec3_add(ray->origin, vec3_scale(ray->way, distance[k]))))
        met(data, distance[k], opacity, mesh->scene);
  }
}

void hl_surface_tree_cast(const surface_tree *tree, const surface_ray *ray, surface_met *met, void *data) {
  uint32_t waiting[DEEPEST + 2], count = 0;
  if (tree->box_count > 0) waiting[count++] = 0;
  while (count > 0) {
    uint32_t index = waiting[--count];
    const surface_box *box = &tree->boxes[index];
    if (!meets_box(box, ray)) continue;
    if (box->count > 0) {
      meet_leaf(tree, box, ray, met, data);
      continue;
    }
    waiting[count++] = box->first;
    waiting[count++] = index + 1;
  }
}
