/* surface/seen.c - see seen.h. */
#include "surface/seen.h"

/* The width, in pixels, of the frame around the view to which triangles are cut. A triangle within this frame
 * is not cut. */
static const double FRAME_AROUND = 4096;
/* In a perspective view, the least distance from the eye at which points are seen. The unit is the distance
 * at which rays have the length 1. */
static const double NEAREST = 1e-4;

/* A corner of a polygon in homogeneous coordinates (w, w u, w v), where (u, v) is its continuous pixel. */
typedef struct corner {
  double w, u, v;
} corner;

static corner corner_in_view(const view *view, vec3 point) {
  vec3 p = mat3_apply(view->inverse, vec3_subtract(point, view->perspective ? view->origin : view->corner));
  return (corner){view->perspective ? p.x : 1, p.y, p.z};
}

/* The distance of a corner from a side of the frame, above 0 inside. Side 0 is the plane of the eye. Sides
 * 1 and 2 are the left and the right side; sides 3 and 4 are the upper and the lower side. */
static double inside(const view *view, int side, corner c) {
  switch (side) {
    case 0: return c.w - NEAREST;
    case 1: return c.u + FRAME_AROUND * c.w;
    case 2: return (view->width + FRAME_AROUND) * c.w - c.u;
    case 3: return c.v + FRAME_AROUND * c.w;
    default: return (view->height + FRAME_AROUND) * c.w - c.v;
  }
}

static int32_t subpixels_of(double pixels) { return (int32_t)floor(pixels * SUBPIXELS + 0.5); }

/* ---- triangles ---- */

bool hl_see_vertex(const seen_surfaces *seen, uint32_t vertex, int32_t at[2]) {
  corner c = corner_in_view(seen->view, hl_surface_vector(seen->all->positions[vertex]));
  for (int side = 0; side < 5; side++)
    if (!(inside(seen->view, side, c) >= 0)) return false;
  at[0] = subpixels_of(c.u / c.w);
  at[1] = subpixels_of(c.v / c.w);
  return true;
}

/* Cuts a polygon at one side of the frame. Returns the number of corners that are left. */
static int clip(const view *view, int side, const corner *from, int count, corner *to) {
  int kept = 0;
  for (int i = 0; i < count; i++) {
    corner a = from[i], b = from[(i + 1) % count];
    double da = inside(view, side, a), db = inside(view, side, b);
    if (da >= 0) to[kept++] = a;
    if ((da >= 0) == (db >= 0)) continue;
    double t = da / (da - db);
    to[kept++] = (corner){a.w + t * (b.w - a.w), a.u + t * (b.u - a.u), a.v + t * (b.v - a.v)};
  }
  return kept;
}

static void see_cut_triangle(const seen_surfaces *seen, const uint32_t *vertex, seen_polygon *polygon) {
  const view *view = seen->view;
  corner corners[2][CLIPPED_CORNERS + 1];
  int count = 3, at = 0;
  for (int i = 0; i < 3; i++)
    corners[0][i] = corner_in_view(view, hl_surface_vector(seen->all->positions[vertex[i]]));
  for (int side = 0; side < 5 && count > 0; side++) {
    bool whole = true;
    for (int i = 0; i < count; i++) whole = whole && inside(view, side, corners[at][i]) >= 0;
    if (whole) continue;
    count = clip(view, side, corners[at], count, corners[!at]);
    at = !at;
  }
  polygon->count = count < 3 ? 0 : count;
  for (int i = 0; i < polygon->count; i++) {
    polygon->x[i] = subpixels_of(corners[at][i].u / corners[at][i].w);
    polygon->y[i] = subpixels_of(corners[at][i].v / corners[at][i].w);
  }
}

void hl_see_triangle(const seen_surfaces *seen, uint32_t triangle, seen_polygon *polygon) {
  const uint32_t *vertex = seen->all->triangles[triangle];
  polygon->count = 3;
  for (int i = 0; i < 3; i++) {
    int32_t at[2];
    if (!hl_see_vertex(seen, vertex[i], at)) {
      see_cut_triangle(seen, vertex, polygon);
      return;
    }
    polygon->x[i] = at[0];
    polygon->y[i] = at[1];
  }
}

bool hl_faces_view(const seen_surfaces *seen, uint32_t triangle) {
  seen_polygon p;
  hl_see_triangle(seen, triangle, &p);
  return p.count > 0 && hl_polygon_area(p.x, p.y) <= 0;
}

/* ---- spheres ---- */

/* Finds the least and the greatest u of the points of a sphere, where u is a coordinate in the picture. w u
 * and w are linear functions of the point. At the sphere's centre they have the values a and w; their
 * gradients are ga and gw. w must be above 0 on the sphere. Derived: the plane a - w u = 0 touches the sphere
 * if (a - w u)^2 = r^2 |ga - u gw|^2, a quadratic equation for u. */
static void find_extent(double a, double w, vec3 ga, vec3 gw, double radius, double *least,
                        double *greatest) {
  double rr = radius * radius, p = w * w - rr * vec3_dot(gw, gw), q = a * w - rr * vec3_dot(ga, gw),
         s = a * a - rr * vec3_dot(ga, ga), root = sqrt(fmax(q * q - p * s, 0));
  *least = (q - root) / p;
  *greatest = (q + root) / p;
}

bool hl_see_sphere(const view *view, const float sphere[4], seen_bounds *bounds) {
  corner c = corner_in_view(view, hl_surface_vector(sphere));
  vec3 none = {0, 0, 0}, nearer = view->perspective ? view->inverse.row[0] : none;
  double reach = sphere[3] * vec3_length(nearer);
  *bounds = (seen_bounds){0, 0, view->width, view->height};
  if (c.w + reach < NEAREST) return false;
  if (c.w - reach >= NEAREST) {
    find_extent(c.u, c.w, view->inverse.row[1], nearer, sphere[3], &bounds->u0, &bounds->u1);
    find_extent(c.v, c.w, view->inverse.row[2], nearer, sphere[3], &bounds->v0, &bounds->v1);
  }
  return bounds->u1 >= 0 && bounds->v1 >= 0 && bounds->u0 < view->width && bounds->v0 < view->height;
}

/* ---- boxes ---- */

seen_box hl_see_box(const view *view, const float low[3], const float high[3], seen_bounds *bounds) {
  bool whole = true;
  int outside[5] = {0};
  *bounds = (seen_bounds){INFINITY, INFINITY, -INFINITY, -INFINITY};
  for (int i = 0; i < 8; i++) {
    corner c = corner_in_view(
        view, (vec3){i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]});
    for (int side = 0; side < 5; side++)
      if (!(inside(view, side, c) >= 0)) whole = false, outside[side]++;
    if (!whole) continue;
    bounds->u0 = fmin(bounds->u0, c.u / c.w), bounds->u1 = fmax(bounds->u1, c.u / c.w);
    bounds->v0 = fmin(bounds->v0, c.v / c.w), bounds->v1 = fmax(bounds->v1, c.v / c.w);
  }
  for (int side = 0; side < 5; side++)
    if (outside[side] == 8) return BOX_UNSEEN;
  if (!whole) return BOX_CUT;
  const double rounded = 4.0 / SUBPIXELS; /* the bounds allow for the rounding of triangles' corners */
  bounds->u0 -= rounded, bounds->v0 -= rounded;
  bounds->u1 += rounded, bounds->v1 += rounded;
  return bounds->u1 >= 0 && bounds->v1 >= 0 && bounds->u0 < view->width && bounds->v0 < view->height
             ? BOX_WHOLE
             : BOX_UNSEEN;
}
