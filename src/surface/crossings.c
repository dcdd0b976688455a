/* surface/crossings.c - see crossings.h. */
#include "surface/crossings.h"

#include <string.h>

#include "surface/primitive.h"
#include "surface/sample_rows.h"
#include "surface/sphere_coverage.h"

/* Of a pixel's fragments only so many are looked at: a pixel that has more is a thicket. */
enum { MOST_FRAGMENTS = 32 };

/* Heights of the surface that a fragment shows: of a triangle, or of one side of a sphere. */
typedef struct shown_surface {
  surface_plane plane;
  const float *sphere;     /* null: a triangle */
  bool leaving;            /* the side of the sphere where rays leave it */
  bool by_corners;         /* a triangle none of whose corners is cut: its height is rise / part, below */
  double rise[3], part[3]; /* linear functions of the pixel, as those of surface_plane */
  sphere_rays rays;        /* of a sphere */
} shown_surface;

/* The fragments of a pixel, and the surfaces of those that may cross others. */
typedef struct pixel_fragments {
  const crossing_tile *tile;
  fragment
      list[2 * MOST_FRAGMENTS];    /* [count]; first those given, then their parts that come before others */
  uint8_t part_of[MOST_FRAGMENTS]; /* of each part: the fragment whose surface it shows */
  size_t given, count;
  shown_surface surfaces[MOST_FRAGMENTS];
  uint32_t has_surface, changed; /* one bit for each of those given */
  int x, y;                      /* the pixel */
} pixel_fragments;

/* Grows along the view's rays. */
static double depth_of(const pixel_fragments *pixel, double height) {
  return pixel->tile->order->falling ? -height : height;
}

/* The height of a surface at a point of the pixel. */
static double height_at(const pixel_fragments *pixel, const shown_surface *surface, double u, double v) {
  const crossing_tile *tile = pixel->tile;
  vec3 point;
  u += pixel->x, v += pixel->y;
  if (surface->by_corners) return hl_plane_linear(surface->rise, u, v) / hl_plane_linear(surface->part, u, v);
  if (surface->sphere == NULL) return hl_plane_height(&surface->plane, u, v);
  (void)hl_meet_sphere(&surface->rays, u, v, surface->leaving, &point);
  return vec3_dot(tile->sheets->normal, point) - tile->sheets->first;
}

/* The side of a sphere that is nearer to a fragment's height. */
static void find_side(const pixel_fragments *pixel, const fragment *f, shown_surface *surface) {
  double u, v, away[2];
  hl_fragment_middle(f->samples, &u, &v);
  for (int side = 0; side < 2; side++) {
    surface->leaving = side;
    away[side] = fabs(height_at(pixel, surface, u, v) - (double)f->height);
  }
  surface->leaving = away[1] < away[0];
}

/* A linear function that has these values at three points, with so much area, twice, between them. */
static void set_linear(double f[3], const double x[3], const double y[3], double area,
                       const double value[3]) {
  double a = value[1] - value[0], b = value[2] - value[0];
  f[1] = (a * (y[2] - y[0]) - b * (y[1] - y[0])) / area;
  f[2] = (b * (x[1] - x[0]) - a * (x[2] - x[0])) / area;
  f[0] = value[0] - f[1] * x[0] - f[2] * y[0];
}

/* Heights between a triangle's corners where these are seen: on the grid by which samples are covered. So a
 * triangle that is seen from its edge has heights between those of its corners at all its samples, and meets
 * its neighbours, which its plane does not. Derived: heights over the distance are linear in the picture, as
 * is one over the distance. */
static void set_corners(const crossing_tile *tile, uint32_t triangle, shown_surface *surface) {
  const view *view = tile->view;
  double x[3], y[3], rise[3], part[3];
  surface->by_corners = false;
  for (int i = 0; i < 3; i++) {
    uint32_t vertex = tile->all->triangles[triangle][i];
    vec3 at = hl_surface_vector(tile->all->positions[vertex]);
    int32_t seen[2];
    if (!hl_see_vertex(tile->seen, vertex, seen)) return;
    x[i] = seen[0] / (double)SUBPIXELS;
    y[i] = seen[1] / (double)SUBPIXELS;
    part[i] = view->perspective ? 1 / vec3_dot(view->inverse.row[0], vec3_subtract(at, view->origin)) : 1;
    rise[i] = (vec3_dot(tile->sheets->normal, at) - tile->sheets->first) * part[i];
  }
  double area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  surface->by_corners = fabs(area) > 0;
  set_linear(surface->rise, x, y, area, rise);
  set_linear(surface->part, x, y, area, part);
}

static const shown_surface *surface_of(pixel_fragments *pixel, size_t i) {
  const crossing_tile *tile = pixel->tile;
  const fragment *f = &pixel->list[i];
  shown_surface *surface = &pixel->surfaces[i];
  if (pixel->has_surface >> i & 1) return surface;
  pixel->has_surface |= 1u << i;
  if (hl_is_triangle(tile->all, f->primitive)) {
    surface->sphere = NULL;
    set_corners(tile, f->primitive, surface);
    hl_plane_of_triangle(tile->view, tile->sheets, tile->all, f->primitive, &surface->plane);
  } else {
    surface->by_corners = false;
    surface->sphere = hl_sphere_of(tile->all, f->primitive);
    surface->rays = hl_sphere_rays(tile->view, surface->sphere);
    find_side(pixel, f, surface);
  }
  return surface;
}

/* The samples, among those given, at which fragment i lies before fragment j. */
static uint32_t samples_before(pixel_fragments *pixel, size_t i, size_t j, uint32_t samples) {
  const shown_surface *own = surface_of(pixel, i), *other = surface_of(pixel, j);
  uint32_t before = 0;
  for (; samples != 0; samples &= samples - 1) {
    int s = __builtin_ctz(samples);
    double u = (s + 0.5) / FRAGMENT_SAMPLES, v = (SAMPLE_ROWS[s] + 0.5) / FRAGMENT_SAMPLES;
    if (depth_of(pixel, height_at(pixel, own, u, v)) < depth_of(pixel, height_at(pixel, other, u, v)))
      before |= 1u << s;
  }
  return before;
}

/* Whether two fragments, the first of which comes first, may cross in samples that they share. */
static bool may_cross(const pixel_fragments *pixel, const fragment *first, const fragment *second) {
  double apart = depth_of(pixel, (double)second->height) - depth_of(pixel, (double)first->height);
  return (first->samples & second->samples) != 0 &&
         apart <= hl_reach_of(first->reach, pixel->tile->sheets->spacing) +
                      hl_reach_of(second->reach, pixel->tile->sheets->spacing);
}

static void set_height(const pixel_fragments *pixel, const shown_surface *surface, fragment *f) {
  double u, v;
  hl_fragment_middle(f->samples, &u, &v);
  double height = height_at(pixel, surface, u, v);
  if (surface->sphere == NULL) height = fmin(fmax(height, surface->plane.lowest), surface->plane.highest);
  f->height = (float)height;
}

/* Puts samples of fragment i, which lets light through, before fragment j. There are at most as many parts as
 * fragments. */
static void add_part(pixel_fragments *pixel, size_t i, size_t j, uint32_t samples) {
  fragment part = pixel->list[i], *other = &pixel->list[j];
  size_t number = pixel->count - pixel->given;
  if (number == pixel->given) return;
  pixel->list[i].samples &= (uint16_t)~samples;
  part.samples = (uint16_t)samples;
  set_height(pixel, surface_of(pixel, i), &part);
  if (depth_of(pixel, (double)part.height) > depth_of(pixel, (double)other->height))
    part.height = other->height;
  pixel->part_of[number] = (uint8_t)i;
  pixel->list[pixel->count++] = part;
}

/* Parts fragment i, which lets light through, from those before it. */
static void part_translucent(pixel_fragments *pixel, size_t i) {
  for (size_t j = 0; j < i; j++) {
    const fragment *own = &pixel->list[i], *other = &pixel->list[j];
    if (!may_cross(pixel, other, own)) continue;
    uint32_t nearer = samples_before(pixel, i, j, own->samples & other->samples);
    if (nearer != 0) add_part(pixel, i, j, nearer);
  }
}

/* Parts fragment i, which is opaque, and those before it: each loses the samples that the other hides. */
static void part_opaque(pixel_fragments *pixel, size_t i) {
  const float *least = pixel->tile->order->least;
  fragment *own = &pixel->list[i];
  for (size_t k = 0; k < pixel->count; k++) {
    size_t j = k < pixel->given ? k : pixel->part_of[k - pixel->given];
    fragment *other = &pixel->list[k];
    if (j >= i || !may_cross(pixel, other, own)) continue;
    uint32_t both = own->samples & other->samples, nearer = samples_before(pixel, i, j, both);
    other->samples &= (uint16_t)~nearer;
    if (nearer == 0 || !hl_is_opaque(other, least)) continue;
    own->samples &= (uint16_t) ~(both & ~nearer);
    pixel->changed |= 1u << i | 1u << j;
  }
}

/* Writes a pixel's fragments in the order of their depths; parts come before what has the same. */
static size_t write_pixel(pixel_fragments *pixel, fragment *to) {
  size_t kept = 0, parts = pixel->count - pixel->given;
  for (size_t n = 0; n < pixel->count; n++) {
    size_t i = n < parts ? pixel->given + n : n - parts;
    fragment f = pixel->list[i];
    if (f.samples == 0) continue;
    if (i < pixel->given && (pixel->changed >> i & 1)) set_height(pixel, surface_of(pixel, i), &f);
    f.slab = hl_slab_of(pixel->tile->sheets, (double)f.height);
    size_t at = kept++;
    for (; at > 0 && depth_of(pixel, (double)to[at - 1].height) > depth_of(pixel, (double)f.height); at--)
      to[at] = to[at - 1];
    to[at] = f;
  }
  return kept;
}

/* Whether any fragments of a pixel share samples and may cross. */
static bool any_may_cross(const pixel_fragments *pixel, const fragment *list, size_t count) {
  uint32_t seen = 0;
  for (size_t i = 0; i < count; seen |= list[i++].samples)
    for (size_t j = 0; (list[i].samples & seen) != 0 && j < i; j++)
      if (may_cross(pixel, &list[j], &list[i])) return true;
  return false;
}

/* Parts a pixel's fragments; *parted is set where any were. */
static size_t part_pixel(const crossing_tile *tile, const fragment *list, size_t count, fragment *to,
                         bool *parted) {
  pixel_fragments pixel;
  pixel.tile = tile;
  pixel.x = tile->x + hl_pixel_column(list->pixel);
  pixel.y = tile->y + hl_pixel_row(list->pixel);
  if (count > MOST_FRAGMENTS || !any_may_cross(&pixel, list, count)) {
    memcpy(to, list, count * sizeof *to);
    return count;
  }
  memcpy(pixel.list, list, count * sizeof *list);
  pixel.given = pixel.count = count;
  pixel.has_surface = pixel.changed = 0;
  for (size_t i = 1; i < count; i++)
    if (hl_is_opaque(&list[i], tile->order->least)) part_opaque(&pixel, i);
    else part_translucent(&pixel, i);
  *parted = true;
  return write_pixel(&pixel, to);
}

size_t hl_part_crossings(const crossing_tile *tile, const fragment *list, size_t count, fragment *to,
                         bool *parted) {
  size_t kept = 0;
  *parted = false;
  for (size_t i = 0, end; i < count; i = end) {
    for (end = i + 1; end < count && list[end].pixel == list[i].pixel;) end++;
    kept += part_pixel(tile, list + i, end - i, to + kept, parted);
  }
  return kept;
}
