/* surface/triangle_raster.c - finds how views see triangles, and makes fragments of triangles
 * (primitive_raster.h). */
#include "surface/primitive_fragments.h"
#include "surface/shown_surface.h"
#include "surface/small_batch.h"
#include "surface/triangle.h"

/* ---- the places in a view ---- */

static bool see(const seen_surfaces *seen, uint32_t primitive, bool fronts, seen_bounds *bounds) {
  seen_polygon polygon;
  hl_see_triangle(seen, primitive, &polygon);
  if (polygon.count == 0 || (fronts && hl_polygon_area(polygon.x, polygon.y) > 0)) return false;
  int32_t x0 = polygon.x[0], y0 = polygon.y[0], x1 = x0, y1 = y0;
  for (int i = 1; i < polygon.count; i++) {
    x0 = polygon.x[i] < x0 ? polygon.x[i] : x0;
    x1 = polygon.x[i] > x1 ? polygon.x[i] : x1;
    y0 = polygon.y[i] < y0 ? polygon.y[i] : y0;
    y1 = polygon.y[i] > y1 ? polygon.y[i] : y1;
  }
  const double pixel = 1.0 / SUBPIXELS;
  *bounds = (seen_bounds){x0 * pixel, y0 * pixel, x1 * pixel, y1 * pixel};
  return x1 >= 0 && y1 >= 0 && x0 < seen->view->width * SUBPIXELS && y0 < seen->view->height * SUBPIXELS;
}

static float lowest(const surfaces *all, const sheet_stack *sheets, uint32_t primitive) {
  double height = INFINITY;
  for (int i = 0; i < 3; i++) {
    vec3 corner = hl_surface_vector(all->positions[all->triangles[primitive][i]]);
    height = fmin(height, vec3_dot(sheets->normal, corner));
  }
  return (float)(height - sheets->first);
}

/* ---- sixteen triangles at a time ---- */

/* Adds a triangle to a batch. Returns false if the view or the scene's cuts cut it. */
static bool collect(const fragment_work *work, const tile_part *part, small_batch *batch,
                    uint32_t primitive) {
  const surfaces *all = work->source->surfaces;
  const uint32_t *vertex = all->triangles[primitive];
  int32_t left = part->tile_x * TILE * SUBPIXELS, top = part->tile_y * TILE * SUBPIXELS;
  int lane = batch->count;
  const float *n = batch->view.normal, *corner[3];
  float normal[3];
  if (hl_surface_cut(all, &all->meshes[batch->mesh], primitive) != CUT_LEAVES_ALL) return false;
  for (int i = 0; i < 3; i++) {
    int32_t at[2];
    if (!hl_see_vertex(work->seen, vertex[i], at)) return false;
    corner[i] = all->positions[vertex[i]];
    batch->triangles.x[i][lane] = at[0] - left;
    batch->triangles.y[i][lane] = at[1] - top;
    batch->triangles.height[i][lane] = n[0] * corner[i][0] + n[1] * corner[i][1] + n[2] * corner[i][2] -
                                       batch->view.first;
  }
  hl_corner_product(corner, normal);
  for (int axis = 0; axis < 3; axis++) {
    batch->triangles.normal[axis][lane] = normal[axis];
    batch->triangles.corner[axis][lane] = corner[0][axis];
  }
  batch->primitives[batch->count++] = primitive;
  return true;
}

static uint32_t cover_small(const surface_functions *functions, small_batch *batch) {
  return functions->cover_small(&batch->view, &batch->triangles, &batch->cover);
}

/* ---- one triangle at a time ---- */

/* A triangle's plane as a view sees it. */
typedef struct seen_plane {
  const view *view;
  const surface_plane *plane;
} seen_plane;

static vec3 point_of(const void *shape, double u, double v) {
  const seen_plane *seen = shape;
  const view *view = seen->view;
  vec3 pixel = vec3_add(view->corner, vec3_add(vec3_scale(view->du, u), vec3_scale(view->dv, v)));
  double along = hl_plane_linear(seen->plane->rise, u, v) / hl_plane_linear(seen->plane->way, u, v);
  return view->perspective ? vec3_add(view->origin, vec3_scale(pixel, along))
                           : vec3_add(pixel, vec3_scale(view->direction, along));
}

static void cover(const fragment_work *work, fragment_worker *worker, tile_part *part,
                  const fragment *common) {
  const fragments_source *source = work->source;
  fragment f = *common;
  seen_polygon polygon;
  seen_seams seams;
  surface_plane plane;
  covered_pixel pixel;
  hl_see_triangle(work->seen, f.primitive, &polygon);
  if (!hl_cover_tile(&polygon, part->tile_x, part->tile_y, &part->span, part->covered)) return;
  int at[2] = {part->span.x0, part->span.y0};
  hl_plane_of_triangle(source->view, source->sheets, source->surfaces, f.primitive, &plane);
  plane.leaving = work->dark_backs[f.mesh] && hl_plane_linear(plane.way, part->tile_x * TILE + TILE / 2,
                                                              part->tile_y * TILE + TILE / 2) > 0;
  const seen_plane shape = {source->view, &plane};
  const seen_part seen = {part->is_cut ? source->surfaces : NULL, point_of, &shape};
  hl_see_seams(work, &f, &seams);
  while (hl_next_pixel(source->view, part, &seen, at, &f, &pixel))
    hl_add_pixel(work, worker, &plane, f, &pixel, &seams);
}

/* ---- heights within a pixel ---- */

/* Finds the linear function that has given values at three points of the picture. area: twice the area of the
 * triangle between the points. */
static void set_linear(double f[3], const double x[3], const double y[3], double area,
                       const double value[3]) {
  double a = value[1] - value[0], b = value[2] - value[0];
  f[1] = (a * (y[2] - y[0]) - b * (y[1] - y[0])) / area;
  f[2] = (b * (x[1] - x[0]) - a * (x[2] - x[0])) / area;
  f[0] = value[0] - f[1] * x[0] - f[2] * y[0];
}

/* Finds the heights of a triangle as linear functions between its corners. The corners are rounded to the
 * grid of 1/256 pixels on which coverage is found. So even a triangle that is seen from its edge has, at all
 * its samples, heights between the heights of its corners, and it meets its neighbours. The heights of the
 * triangle's plane would not have this property. Derived: height divided by distance is linear in the
 * picture, and so is 1 divided by distance. */
static void set_corners(const seen_surfaces *seen, const sheet_stack *sheets, uint32_t triangle,
                        shown_surface *shown) {
  const view *view = seen->view;
  double x[3], y[3], rise[3], part[3];
  shown->by_corners = false;
  for (int i = 0; i < 3; i++) {
    uint32_t vertex = seen->all->triangles[triangle][i];
    vec3 at = hl_surface_vector(seen->all->positions[vertex]);
    int32_t pixel[2];
    if (!hl_see_vertex(seen, vertex, pixel)) return;
    x[i] = pixel[0] / (double)SUBPIXELS;
    y[i] = pixel[1] / (double)SUBPIXELS;
    part[i] = view->perspective ? 1 / vec3_dot(view->inverse.row[0], vec3_subtract(at, view->origin)) : 1;
    rise[i] = (vec3_dot(sheets->normal, at) - sheets->first) * part[i];
  }
  double area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  shown->by_corners = fabs(area) > 0;
  set_linear(shown->rise, x, y, area, rise);
  set_linear(shown->part, x, y, area, part);
}

static void show(const seen_surfaces *seen, const sheet_stack *sheets, const fragment *f, double u, double v,
                 shown_surface *shown) {
  (void)u, (void)v;
  set_corners(seen, sheets, f->primitive, shown);
  hl_plane_of_triangle(seen->view, sheets, seen->all, f->primitive, &shown->plane);
  shown->lowest = shown->plane.lowest;
  shown->highest = shown->plane.highest;
}

static double height(const sheet_stack *sheets, const shown_surface *shown, double u, double v) {
  (void)sheets;
  if (shown->by_corners) return hl_plane_linear(shown->rise, u, v) / hl_plane_linear(shown->part, u, v);
  return hl_plane_height(&shown->plane, u, v);
}

const primitive_raster hl_raster_triangle = {.see = see,
                                             .lowest = lowest,
                                             .collect = collect,
                                             .cover_small = cover_small,
                                             .cover = cover,
                                             .show = show,
                                             .height = height};
