/* surface/sphere_raster.c - finds how views see spheres, and makes fragments of spheres
 * (primitive_raster.h). */
#include "surface/primitive_fragments.h"
#include "surface/shown_surface.h"
#include "surface/small_batch.h"
#include "surface/sphere_coverage.h"

/* ---- the places in a view ---- */

/* a sphere that is seen has a front side, so `fronts` makes no difference */
static bool see(const seen_surfaces *seen, uint32_t primitive, bool fronts, seen_bounds *bounds) {
  (void)fronts;
  return hl_see_sphere(seen->view, hl_sphere_of(seen->all, primitive), bounds);
}

/* The least height is not needed for spheres, because they are rasterised before triangles. */
static float lowest(const surfaces *all, const sheet_stack *sheets, uint32_t primitive) {
  (void)all, (void)sheets, (void)primitive;
  return (float)-INFINITY;
}

/* ---- sixteen spheres at a time ---- */

/* Adds a sphere to a batch. Returns false if the scene's cuts may cut it, if it lets light pass, or if its
 * fragments may fill several slabs. */
static bool collect(const fragment_work *work, const tile_part *part, small_batch *batch,
                    uint32_t primitive) {
  (void)part;
  const surfaces *all = work->source->surfaces;
  const surface_mesh *mesh = &all->meshes[batch->mesh];
  const float *sphere = hl_sphere_of(all, primitive);
  if (mesh->is_cut || work->source->rise > 0 || hl_primitive_opacity(all, mesh, primitive) < 1) return false;
  for (int axis = 0; axis < 3; axis++) batch->spheres.centre[axis][batch->count] = sphere[axis];
  batch->spheres.radius[batch->count] = sphere[3];
  batch->primitives[batch->count++] = primitive;
  return true;
}

static uint32_t cover_small(const surface_functions *functions, small_batch *batch) {
  return functions->cover_spheres(&batch->view, &batch->spheres, &batch->cover);
}

/* ---- one sphere at a time ---- */

/* Returns whether a light does not light a sphere from within: the sphere's surface lets no light pass, and
 * the light is outside. */
static bool has_dark_inside(const fragment_work *work, const float sphere[4], const fragment *f) {
  const view *view = work->source->view;
  if (f->opacity < 1 || work->least[f->mesh] < 1) return false;
  vec3 away = vec3_subtract(view->origin, hl_surface_vector(sphere));
  return !view->perspective || vec3_length(away) > (double)sphere[3];
}

/* One of the two sides of a sphere as a view sees it. */
typedef struct seen_side {
  const sphere_rays *rays;
  bool leaving; /* whether this side is the one where rays leave the sphere */
} seen_side;

static vec3 point_of(const void *shape, double u, double v) {
  const seen_side *side = shape;
  vec3 point = {NAN, NAN, NAN};
  (void)hl_meet_sphere(side->rays, u, v, side->leaving, &point);
  return point;
}

/* Adds one side of a sphere: the side at which rays leave it (leaving), or the side at which they enter
 * it. */
static void add_side(const fragment_work *work, fragment_worker *worker, const tile_part *part, fragment f,
                     bool leaving) {
  const fragments_source *source = work->source;
  const float *sphere = hl_sphere_of(source->surfaces, f.primitive);
  covered_pixel pixel;
  int at[2] = {part->span.x0, part->span.y0};
  bool dark = leaving && !part->is_cut && has_dark_inside(work, sphere, &f);
  const sphere_rays rays = hl_sphere_rays(source->view, sphere);
  const seen_side shape = {&rays, leaving};
  const seen_part seen = {part->is_cut ? source->surfaces : NULL, point_of, &shape};
  surface_plane plane;
  hl_plane_begin(source->view, source->sheets, &plane);
  plane.leaving = dark;
  while (hl_next_pixel(source->view, part, &seen, at, &f, &pixel)) {
    vec3 point;
    if (!hl_meet_sphere(&rays, pixel.u, pixel.v, leaving, &point)) continue;
    hl_plane_touch_sphere(source->view, source->sheets, sphere, point, &plane);
    hl_add_pixel(work, worker, &plane, f, &pixel, NULL);
  }
}

/* Returns whether a sphere's far side is needed. A view sees the far side of an opaque sphere only from
 * within. */
static bool has_far_side(const fragment_work *work, const float sphere[4], float opacity) {
  const view *view = work->source->view;
  if (work->source->rise > 0 || opacity < 1) return true;
  vec3 away = vec3_subtract(view->origin, hl_surface_vector(sphere));
  return view->perspective && vec3_length(away) <= 1.01 * (double)sphere[3];
}

static void cover(const fragment_work *work, fragment_worker *worker, tile_part *part, const fragment *f) {
  const fragments_source *source = work->source;
  const float *sphere = hl_sphere_of(source->surfaces, f->primitive);
  seen_bounds bounds;
  if (!hl_see_sphere(source->view, sphere, &bounds) ||
      !hl_cover_sphere(source->view, sphere, &bounds, part->tile_x, part->tile_y, &part->span, part->covered))
    return;
  add_side(work, worker, part, *f, false);
  if (part->is_cut || has_far_side(work, sphere, f->opacity)) add_side(work, worker, part, *f, true);
}

/* ---- heights within a pixel ---- */

static double height(const sheet_stack *sheets, const shown_surface *shown, double u, double v) {
  vec3 point;
  (void)hl_meet_sphere(&shown->rays, u, v, shown->leaving, &point);
  return vec3_dot(sheets->normal, point) - sheets->first;
}

/* Shows one of the sphere's two sides: the side that is nearer to the fragment's height. */
static void show(const seen_surfaces *seen, const sheet_stack *sheets, const fragment *f, double u, double v,
                 shown_surface *shown) {
  double away[2];
  shown->lowest = -INFINITY;
  shown->highest = INFINITY;
  shown->rays = hl_sphere_rays(seen->view, hl_sphere_of(seen->all, f->primitive));
  for (int side = 0; side < 2; side++) {
    shown->leaving = side;
    away[side] = fabs(height(sheets, shown, u, v) - (double)f->height);
  }
  shown->leaving = away[1] < away[0];
}

const primitive_raster hl_raster_sphere = {.see = see,
                                           .lowest = lowest,
                                           .collect = collect,
                                           .cover_small = cover_small,
                                           .cover = cover,
                                           .show = show,
                                           .height = height};
