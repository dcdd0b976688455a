/* surface/sphere.c - defines the table of functions for primitives that are spheres (primitive.h). */
#include "mesh/mesh.h"
#include "surface/primitive_lattice.h"
#include "surface/primitive_raster.h"

static size_t count_of(const hl_mesh_description *mesh) { return mesh->sphere_count; }

static void lay_out(surfaces *made, hl_layout *layout) {
  const uint32_t count = made->first[PRIMITIVE_sphere + 1] - made->first[PRIMITIVE_sphere];
  made->spheres = hl_layout_take(layout, count, sizeof *made->spheres);
}

static void place(hl_pool *pool, surfaces *made, const surface_mesh *mesh) {
  const float(*from)[4] = mesh->mesh->description.spheres;
  const primitive_range own = mesh->primitives[PRIMITIVE_sphere];
  float(*to)[4] = made->spheres + (own.first - made->first[PRIMITIVE_sphere]);
  (void)pool;
  for (uint32_t n = 0; n < own.count; n++) {
    vec3_store(to[n], affine3_apply(mesh->placement, hl_surface_vector(from[n])));
    to[n][3] = (float)((double)from[n][3] * mesh->scale);
  }
}

static double lesser(double a, double b) { return a < b ? a : b; }
static double greater(double a, double b) { return a > b ? a : b; }

static void bound(const surfaces *all, uint32_t primitive, float low[3], float high[3]) {
  const float *sphere = hl_sphere_of(all, primitive);
  for (int a = 0; a < 3; a++) {
    float reach = sphere[3] + 1e-6f * (fabsf(sphere[a]) + sphere[3]); /* half of the edge of a box around the
                                                                       * sphere; it is a little too large, to
                                                                       * allow for rounding */
    low[a] = sphere[a] - reach, high[a] = sphere[a] + reach;
  }
}

/* The colour that a mesh stores for a single sphere; null if the mesh stores none. */
static const float *color_of(const surface_mesh *mesh, uint32_t primitive) {
  if (mesh->sphere_colors == NULL) return NULL;
  return mesh->sphere_colors[primitive - mesh->primitives[PRIMITIVE_sphere].first];
}

static double opacity(const surfaces *all, const surface_mesh *mesh, uint32_t primitive) {
  (void)all;
  double opacity = mesh->look.opacity;
  const float *own = color_of(mesh, primitive);
  return own == NULL ? opacity : opacity * fmin(fmax((double)own[3], 0), 1);
}

static vec3 normal(const surfaces *all, uint32_t primitive, vec3 met, vec3 point, double *from) {
  const vec3 centre = hl_surface_vector(hl_sphere_of(all, primitive)),
             normal = vec3_normalise(vec3_subtract(met, centre));
  *from = vec3_dot(normal, vec3_subtract(point, met));
  return normal;
}

static void plane(const view *view, const sheet_stack *sheets, const surfaces *all, uint32_t primitive,
                  vec3 met, surface_plane *plane) {
  hl_plane_of_sphere(view, sheets, hl_sphere_of(all, primitive), met, plane);
}

static vec3 look(const surfaces *all, const surface_mesh *mesh, uint32_t primitive, vec3 at, vec3 *normal,
                 double color[3]) {
  hl_primitive_color(mesh, color_of(mesh, primitive), color);
  *normal = vec3_normalise(vec3_subtract(at, hl_surface_vector(hl_sphere_of(all, primitive))));
  return *normal;
}

/* The bend of a sphere: 1 / radius if it is seen from within, as a hollow, and -1 / radius if it is seen from
 * outside. */
static double bend(const surfaces *all, const surface_mesh *mesh, uint32_t primitive, vec3 at, vec3 normal,
                   vec3 along) {
  (void)along;
  const float *sphere = hl_sphere_of(all, primitive), *color = color_of(mesh, primitive);
  if (color != NULL && color[3] < 1) return 0;
  vec3 inwards = vec3_subtract(hl_surface_vector(sphere), at);
  return (vec3_dot(inwards, normal) > 0 ? 1 : -1) / (double)sphere[3];
}

/* Finds where a ray meets a sphere: the two solutions s of |origin + s way - centre| = r. */
static int intersect(const surfaces *all, uint32_t primitive, const surface_ray *ray, double distance[2]) {
  const float *sphere = hl_sphere_of(all, primitive);
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

/* Returns whether the convex hull of balls may have points on both sides of a sphere's surface. The result is
 * false if the hull lies completely within the sphere, or completely beyond a plane: the plane that touches
 * the sphere at the point nearest to the first ball. Derived: the inside of the sphere is convex, and so is
 * each side of the plane; a hull lies in a convex region if its balls do. */
static bool parts(const surfaces *all, uint32_t primitive, const hull_ball *balls, int count, double least) {
  const float *sphere = hl_sphere_of(all, primitive);
  const vec3 centre = hl_surface_vector(sphere), up = vec3_normalise(vec3_subtract(balls[0].at, centre));
  double lowest = INFINITY, farthest = 0;
  for (int i = 0; i < count; i++) {
    vec3 from = vec3_subtract(balls[i].at, centre);
    lowest = lesser(lowest, vec3_dot(from, up) - balls[i].radius);
    farthest = greater(farthest, vec3_length(from) + balls[i].radius);
  }
  return lowest < (double)sphere[3] - least && farthest > (double)sphere[3] + least;
}

const primitive_kind hl_primitive_sphere = {.noun = "spheres",
                                            .has_corners = false,
                                            .raster = &hl_raster_sphere,
                                            .lattice = &hl_lattice_sphere,
                                            .count = count_of,
                                            .lay_out = lay_out,
                                            .place = place,
                                            .point = hl_sphere_of,
                                            .bound = bound,
                                            .opacity = opacity,
                                            .normal = normal,
                                            .plane = plane,
                                            .look = look,
                                            .bend = bend,
                                            .intersect = intersect,
                                            .parts = parts};
