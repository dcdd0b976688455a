/* reference/surfaces.c - finds where rays meet the triangles and spheres of a scene's meshes, by a tree of
 * boxes around them. */
#include <string.h>

#include "core/memory.h"
#include "mesh/mesh.h"
#include "reference/reference.h"

enum { LEAF_TRIANGLES = 4, DEEPEST = 96 };

/* ---- the tree ---- */

static void grow_box(double low[3], double high[3], const vec3 *corner, int count) {
  for (int i = 0; i < count; i++) {
    const double at[3] = {corner[i].x, corner[i].y, corner[i].z};
    for (int axis = 0; axis < 3; axis++) {
      low[axis] = fmin(low[axis], at[axis]);
      high[axis] = fmax(high[axis], at[axis]);
    }
  }
}

static double middle_of(const reference_triangle *triangle, int axis) {
  double sum = 0;
  for (int i = 0; i < 3; i++) sum += (&triangle->corner[i].x)[axis];
  return sum / 3;
}

/* Moves the triangles whose middles lie below the coordinate `at` along an axis to the front of the array.
 * Returns the number of these triangles. */
static size_t part_triangles(reference_triangle *triangles, size_t count, int axis, double at) {
  size_t below = 0;
  for (size_t t = 0; t < count; t++) {
    if (middle_of(&triangles[t], axis) >= at) continue;
    reference_triangle moved = triangles[t];
    triangles[t] = triangles[below];
    triangles[below++] = moved;
  }
  return below;
}

/* Makes the tree of boxes for a range of triangles, and sorts the range. Returns the index of the tree's
 * root. A node's first child follows the node in the array, and its second child is at the index `second`. */
static size_t make_tree(reference_surfaces *all, size_t first, size_t count, int depth) {
  size_t made = all->node_count++;
  reference_node *node = &all->nodes[made];
  *node = (reference_node){
      {INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, first, count, 0};
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (size_t t = first; t < first + count; t++) {
    const reference_triangle *triangle = &all->triangles[t];
    vec3 middle = {middle_of(triangle, 0), middle_of(triangle, 1), middle_of(triangle, 2)};
    grow_box(node->low, node->high, triangle->corner, 3);
    grow_box(low, high, &middle, 1);
  }
  if (count <= LEAF_TRIANGLES || depth == DEEPEST) return made;
  int axis = 0;
  for (int other = 1; other < 3; other++)
    if (high[other] - low[other] > high[axis] - low[axis]) axis = other;
  size_t below = part_triangles(all->triangles + first, count, axis, (low[axis] + high[axis]) / 2);
  if (below == 0 || below == count) return made;
  (void)make_tree(all, first, below, depth + 1);
  size_t second = make_tree(all, first + below, count - below, depth + 1);
  all->nodes[made].second = second;
  return made;
}

static double clamped(float opacity) { return fmin(fmax((double)opacity, 0), 1); }

static void add_spheres(reference_surfaces *all, const hl_scene_mesh *mesh, affine3 placement) {
  const hl_mesh_description *d = &mesh->mesh->description;
  for (size_t n = 0; n < d->sphere_count; n++) {
    const float *s = d->spheres[n];
    double r = s[3] * mesh->scale;
    vec3 centre = affine3_apply(placement, (vec3){s[0], s[1], s[2]}), reach = {r, r, r};
    all->triangles[all->triangle_count++] = (reference_triangle){
        .corner = {vec3_subtract(centre, reach), vec3_add(centre, reach), centre},
        .radius = r,
        .mesh = mesh,
        .index = n,
        .opacity = mesh->opacity * (d->sphere_colors != NULL ? clamped(d->sphere_colors[n][3]) : 1)};
  }
}

static void add_mesh(reference_surfaces *all, const hl_scene_mesh *mesh) {
  const hl_mesh_description *d = &mesh->mesh->description;
  affine3 placement = hl_scene_mesh_to_world(mesh);
  add_spheres(all, mesh, placement);
  for (size_t t = 0; t < d->triangle_count; t++) {
    reference_triangle *made = &all->triangles[all->triangle_count++];
    double opacity = 0;
    *made = (reference_triangle){.mesh = mesh, .index = t};
    for (int i = 0; i < 3; i++) {
      const float *p = d->positions[d->triangles[t][i]];
      made->corner[i] = affine3_apply(placement, (vec3){p[0], p[1], p[2]});
      const float *color = d->face_colors != NULL ? d->face_colors[t]
                           : d->colors != NULL    ? d->colors[d->triangles[t][i]]
                                                  : NULL;
      opacity += color != NULL ? clamped(color[3]) / 3 : 1.0 / 3;
    }
    made->opacity = opacity * mesh->opacity;
  }
}

/* Adds the normals of a mesh's vertices, in the world. A mesh without normals of its own gets, at each
 * vertex, the sum of the cross products of the triangles around the vertex. */
static void add_normals(const hl_scene_mesh *mesh, vec3 *normals) {
  const hl_mesh_description *d = &mesh->mesh->description;
  affine3 placement = hl_scene_mesh_to_world(mesh);
  for (size_t v = 0; v < d->vertex_count && d->normals != NULL; v++)
    normals[v] = mat3_apply(placement.linear, (vec3){d->normals[v][0], d->normals[v][1], d->normals[v][2]});
  for (size_t t = 0; t < d->triangle_count && d->normals == NULL; t++) {
    vec3 corner[3];
    for (int i = 0; i < 3; i++) {
      const float *p = d->positions[d->triangles[t][i]];
      corner[i] = affine3_apply(placement, (vec3){p[0], p[1], p[2]});
    }
    vec3 cross = vec3_cross(vec3_subtract(corner[1], corner[0]), vec3_subtract(corner[2], corner[0]));
    for (int i = 0; i < 3; i++) normals[d->triangles[t][i]] = vec3_add(normals[d->triangles[t][i]], cross);
  }
}

hl_status hl_reference_surfaces_create(reference *all, hl_error *error) {
  const hl_scene_description *scene = all->scene;
  reference_surfaces *made = &all->surfaces;
  size_t triangles = 0, vertices = 0, at = 0;
  for (size_t m = 0; m < scene->mesh_count; m++) {
    triangles += scene->meshes[m].mesh->description.triangle_count +
                 scene->meshes[m].mesh->description.sphere_count;
    vertices += scene->meshes[m].mesh->description.vertex_count;
  }
  if (triangles == 0) return HL_OK;
  made->triangles = hl_allocate(all->context, triangles, sizeof *made->triangles);
  made->nodes = hl_allocate(all->context, 2 * triangles, sizeof *made->nodes);
  made->normals = hl_allocate_zeroed(all->context, vertices, sizeof *made->normals);
  made->first_normal = hl_allocate(all->context, scene->mesh_count, sizeof *made->first_normal);
  if (made->triangles == NULL || made->nodes == NULL || made->normals == NULL || made->first_normal == NULL)
    return hl_fail_memory(error, triangles * sizeof *made->triangles, "the reference's meshes");
  for (size_t m = 0; m < scene->mesh_count; m++) {
    made->first_normal[m] = at;
    add_mesh(made, &scene->meshes[m]);
    add_normals(&scene->meshes[m], made->normals + at);
    at += scene->meshes[m].mesh->description.vertex_count;
  }
  (void)make_tree(made, 0, triangles, 0);
  return HL_OK;
}

void hl_reference_surfaces_release(reference *all) {
  hl_release(all->context, all->surfaces.triangles);
  hl_release(all->context, all->surfaces.nodes);
  hl_release(all->context, all->surfaces.normals);
  hl_release(all->context, all->surfaces.first_normal);
}

/* ---- rays ---- */

/* The distance at which a ray meets a triangle; infinite if the ray misses it (Moeller and Trumbore, "Fast,
 * minimum storage ray/triangle intersection", 1997). */
static double meet_triangle(const reference_triangle *triangle, const reference_ray *ray, double weight[3]) {
  vec3 ab = vec3_subtract(triangle->corner[1], triangle->corner[0]);
  vec3 ac = vec3_subtract(triangle->corner[2], triangle->corner[0]);
  vec3 p = vec3_cross(ray->direction, ac), away = vec3_subtract(ray->origin, triangle->corner[0]);
  vec3 q = vec3_cross(away, ab);
  double determinant = vec3_dot(ab, p);
  if (determinant == 0) return INFINITY;
  weight[1] = vec3_dot(away, p) / determinant;
  weight[2] = vec3_dot(ray->direction, q) / determinant;
  weight[0] = 1 - weight[1] - weight[2];
  if (weight[0] < 0 || weight[1] < 0 || weight[2] < 0) return INFINITY;
  return vec3_dot(ac, q) / determinant;
}

/* The least distance greater than a given one at which a ray meets a sphere: a solution s of |origin + s
 * direction - centre| = r. */
static double meet_sphere(const reference_triangle *sphere, const reference_ray *ray, double after) {
  vec3 away = vec3_subtract(ray->origin, sphere->corner[2]);
  double along = vec3_dot(away, ray->direction);
  vec3 nearest = vec3_subtract(away, vec3_scale(ray->direction, along));
  double square = sphere->radius * sphere->radius - vec3_dot(nearest, nearest);
  if (square < 0) return INFINITY;
  double first = -along - sqrt(square);
  return first > after ? first : -along + sqrt(square);
}

static vec3 along(const reference_ray *ray, double distance) {
  return vec3_add(ray->origin, vec3_scale(ray->direction, distance));
}

/* The distance of the first hit beyond the distance `after` that lies at a place which the scene's cuts do
 * not remove. */
static double meet(const hl_scene_description *scene, const reference_triangle *triangle,
                   const reference_ray *ray, double after, double weight[3]) {
  if (triangle->radius == 0) {
    double at = meet_triangle(triangle, ray, weight);
    return hl_reference_mesh_left(scene, triangle->mesh, along(ray, at)) ? at : INFINITY;
  }
  double at = meet_sphere(triangle, ray, after);
  if (hl_reference_mesh_left(scene, triangle->mesh, along(ray, at))) return at;
  double second = meet_sphere(triangle, ray, at);
  return second > at && hl_reference_mesh_left(scene, triangle->mesh, along(ray, second)) ? second : INFINITY;
}

static bool meets_box(const reference_node *node, const reference_ray *ray, double nearest, double farthest) {
  const double o[3] = {ray->origin.x, ray->origin.y, ray->origin.z};
  const double d[3] = {ray->direction.x, ray->direction.y, ray->direction.z};
  for (int axis = 0; axis < 3; axis++) {
    if (d[axis] == 0) {
      if (o[axis] < node->low[axis] || o[axis] > node->high[axis]) return false;
      continue;
    }
    double a = (node->low[axis] - o[axis]) / d[axis], b = (node->high[axis] - o[axis]) / d[axis];
    nearest = fmax(nearest, fmin(a, b) * (1 - 1e-12) - 1e-300);
    farthest = fmin(farthest, fmax(a, b) * (1 + 1e-12) + 1e-300);
  }
  return nearest <= farthest;
}

static bool takes_part(const reference_triangle *triangle, reference_role role) {
  return role == REFERENCE_SEEN ? triangle->mesh->visible : triangle->mesh->casts_shadow;
}

/* Finds the next hit by walking through the tree. Only nodes whose boxes the ray meets are visited. */
bool hl_reference_surface_next(const reference *all, reference_role role, const reference_ray *ray,
                               double after, reference_hit *hit) {
  const reference_surfaces *surfaces = &all->surfaces;
  size_t waiting[DEEPEST + 2], count = 0;
  *hit = (reference_hit){.distance = ray->farthest};
  if (surfaces->node_count > 0) waiting[count++] = 0;
  while (count > 0) {
    const reference_node *node = &surfaces->nodes[waiting[--count]];
    if (!meets_box(node, ray, after, hit->distance)) continue;
    if (node->second != 0) {
      waiting[count++] = node->second;
      waiting[count++] = (size_t)(node - surfaces->nodes) + 1;
      continue;
    }
    for (size_t t = node->first; t < node->first + node->count; t++) {
      double weight[3] = {0, 0, 0}, distance = meet(all->scene, &surfaces->triangles[t], ray, after, weight);
      if (!(distance > after && distance < hit->distance) || !takes_part(&surfaces->triangles[t], role))
        continue;
      *hit = (reference_hit){.triangle = &surfaces->triangles[t],
                             .distance = distance,
                             .weight = {weight[0], weight[1], weight[2]},
                             .opacity = surfaces->triangles[t].opacity};
    }
  }
  hl_reference_iso_next(all, role, ray, after, hit);
  return hit->triangle != NULL || hit->iso != NULL;
}

void hl_reference_surfaces_passing(const reference *all, const reference_ray *ray, double passing[3]) {
  double least = all->step * LEAST_GAP;
  reference_hit hit;
  for (int c = 0; c < 3; c++) passing[c] = 1;
  for (double after = ray->nearest + least; fmax(passing[0], fmax(passing[1], passing[2])) > 0;
       after = hit.distance + 1e-9 * least) {
    if (!hl_reference_surface_next(all, REFERENCE_CASTS_SHADOW, ray, after, &hit)) break;
    const hl_scene_mesh *mesh = hit.triangle != NULL ? hit.triangle->mesh : NULL;
    for (int c = 0; c < 3; c++)
      passing[c] *= 1 - hit.opacity * (mesh != NULL ? mesh->attenuation_color[c] : 1);
  }
}
