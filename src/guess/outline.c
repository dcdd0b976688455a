/* guess/outline.c - finds the outermost visible voxels of a scene, and the range of visible values.
 *
 * Only the first and the last visible voxel of a row can be outermost. Of the first and last voxels of a
 * slice's rows, only the corners of the slice's convex hull can be outermost. */
#include "guess/outline.h"

#include <string.h>

#include "core/door.h"
#include "core/error.h"
#include "core/memory.h"
#include "elementary/elementary.h"
#include "guess/sample.h"
#include "guess/seen_cells.h"
#include "mesh/mesh.h"
#include "scene/scene.h"

enum { POINTS_AT_FIRST = 1024, DIRECTIONS = 400 };

static hl_status add(hl_outline *outline, vec3 point, double radius, hl_error *error) {
  if (outline->count == outline->capacity) {
    size_t capacity = outline->capacity > 0 ? 2 * outline->capacity : POINTS_AT_FIRST;
    vec3 *points = hl_reallocate(outline->context, outline->point, capacity, sizeof *points);
    if (points != NULL) outline->point = points;
    double *radii = hl_reallocate(outline->context, outline->radius, capacity, sizeof *radii);
    if (radii != NULL) outline->radius = radii;
    if (points == NULL || radii == NULL)
      return hl_fail_memory(error, capacity * sizeof *points, "a scene's outline");
    outline->capacity = capacity;
  }
  outline->point[outline->count] = point;
  outline->radius[outline->count++] = radius;
  return HL_OK;
}

/* One side of a slice's convex hull: the ends of rows, in the order of rising j. */
typedef struct chain {
  ptrdiff_t *i, *j; /* owned */
  int count;
  int side; /* 1: the last voxels of rows; -1: the first voxels */
} chain;

/* Adds a corner. Derived: an earlier corner is dropped if the chain does not turn outwards there (monotone
 * chain; Andrew 1979). */
static void chain_add(chain *c, ptrdiff_t i, ptrdiff_t j) {
  for (; c->count >= 2; c->count--) {
    ptrdiff_t i0 = c->i[c->count - 2], j0 = c->j[c->count - 2], i1 = c->i[c->count - 1],
              j1 = c->j[c->count - 1];
    if (c->side * ((i1 - i0) * (j - j0) - (i - i0) * (j1 - j0)) > 0) break;
  }
  c->i[c->count] = i;
  c->j[c->count++] = j;
}

static hl_status add_chain(hl_outline *outline, const chain *c, ptrdiff_t k, affine3 placement,
                           hl_error *error) {
  vec3 edges = {vec3_length(mat3_column(placement.linear, 0)), vec3_length(mat3_column(placement.linear, 1)),
                vec3_length(mat3_column(placement.linear, 2))};
  hl_status status = HL_OK;
  for (int n = 0; status == HL_OK && n < c->count; n++)
    status = add(outline, affine3_apply(placement, (vec3){(double)c->i[n], (double)c->j[n], (double)k}),
                 vec3_length(edges) / 2, error);
  return status;
}

static hl_status add_slices(hl_outline *outline, const hl_seen *seen, affine3 placement, chain chains[2],
                            hl_error *error) {
  hl_status status = HL_OK;
  ptrdiff_t stride = (ptrdiff_t)seen->stride, first, last;
  for (ptrdiff_t k = seen->first[2]; status == HL_OK && k < seen->end[2]; k += stride) {
    chains[0].count = chains[1].count = 0;
    for (ptrdiff_t j = seen->first[1]; j < seen->end[1]; j += stride) {
      if (!hl_seen_row(seen, j, k, &first, &last)) continue;
      chain_add(&chains[0], first, j);
      chain_add(&chains[1], last, j);
    }
    for (int side = 0; status == HL_OK && side < 2; side++)
      status = add_chain(outline, &chains[side], k, placement, error);
  }
  return status;
}

/* The fraction of the cells in a face of the grid that hold visible matter. end: 0 for the face at the
 * beginning of an axis, 1 for the face at its end. */
static double share_of_face(const hl_seen *seen, int axis, int end) {
  const int across = (axis + 1) % 3, along = (axis + 2) % 3;
  int at[3], count = 0;
  at[axis] = end ? seen->size[axis] - 1 : 0;
  for (at[across] = 0; at[across] < seen->size[across]; at[across]++)
    for (at[along] = 0; at[along] < seen->size[along]; at[along]++)
      count += seen->kind[((ptrdiff_t)at[2] * seen->size[1] + at[1]) * seen->size[0] + at[0]] == HL_SEEN;
  return (double)count / ((double)seen->size[across] * seen->size[along]);
}

/* Adds the matter that the transfer function shows. share: receives hl_outline.share of each of the grid's
 * six faces; null if the fractions are not wanted. */
static hl_status add_shown(hl_outline *outline, const hl_scene_volume *volume, double *share,
                           hl_error *error) {
  hl_seen seen;
  bool any;
  size_t rows = volume->volume->dimension[1];
  hl_status status = hl_seen_find(volume, &seen, &any, error);
  for (int face = 0; share != NULL && status == HL_OK && any && face < 6; face++)
    share[face] = share_of_face(&seen, face / 2, face % 2);
  if (status == HL_OK && any) {
    ptrdiff_t *ends = hl_allocate(outline->context, 4 * rows, sizeof *ends);
    if (ends != NULL) {
      chain chains[2] = {{ends, ends + rows, 0, -1}, {ends + 2 * rows, ends + 3 * rows, 0, 1}};
      status = add_slices(outline, &seen, hl_scene_volume_index_to_world(volume), chains, error);
    } else {
      status = hl_fail_memory(error, 4 * rows * sizeof *ends, "a volume's rows");
    }
    hl_release(outline->context, ends);
  }
  hl_seen_release(&seen);
  return status;
}

/* Adds the visible part of a volume: the matter that its transfer function shows, and the matter within the
 * isosurface of the least value. */
static hl_status add_volume(hl_outline *outline, const hl_scene_volume *volume, double *share,
                            hl_error *error) {
  hl_status status = add_shown(outline, volume, share, error);
  double least = INFINITY;
  for (size_t i = 0; i < volume->iso_count; i++) least = fmin(least, volume->iso[i].value);
  if (status != HL_OK || volume->iso_count == 0 || !volume->visible) return status;
  const hl_opacity_point points[2] = {{least, 0}, {least + 1e-9 * fmax(fabs(least), 1), 0.99}};
  hl_scene_volume solid = *volume;
  solid.transfer_function = (hl_transfer_function){.opacity = points, .opacity_count = 2};
  solid.transfer_function.unit_distance = mat3_shortest_column(volume->volume->index_to_world.linear);
  return add_shown(outline, &solid, NULL, error);
}

/* Adds the visible part of a volume, without the part that the scene's cuts remove. */
static hl_status add_cut_volume(hl_outline *outline, const hl_scene_description *scene,
                                const hl_scene_volume *volume, hl_error *error) {
  double *share = volume == scene->volumes ? outline->share : NULL;
  if (scene->cut_count == 0) return add_volume(outline, volume, share, error);
  size_t count = volume->cut_count + scene->cut_count;
  hl_scene_volume both = *volume;
  hl_cut *cuts = hl_allocate(outline->context, count, sizeof *cuts);
  if (cuts == NULL) return hl_fail_memory(error, count * sizeof *cuts, "cuts");
  hl_add_scene_cuts(scene, &both, cuts);
  hl_status status = add_volume(outline, &both, share, error);
  hl_release(outline->context, cuts);
  return status;
}

static hl_status add_box(hl_outline *outline, const hl_scene_volume *volume, hl_error *error) {
  affine3 placement = hl_scene_volume_index_to_world(volume);
  double box[2][3];
  hl_status status = HL_OK;
  hl_scene_volume_box(volume, box[0], box[1]);
  for (int corner = 0; status == HL_OK && corner < 8; corner++)
    status = add(
        outline,
        affine3_apply(placement, (vec3){box[corner & 1][0], box[corner >> 1 & 1][1], box[corner >> 2][2]}), 0,
        error);
  return status;
}

void hl_outline_release(hl_outline *outline) {
  hl_release(outline->context, outline->point);
  hl_release(outline->context, outline->radius);
}

vec3 hl_even_direction(int n, int count) {
  double z = 1 - (2 * n + 1.0) / count, across = sqrt(1 - z * z), angle = n * HL_PI * (3 - sqrt(5));
  return (vec3){across * hl_cos(angle), across * hl_sin(angle), z};
}

/* A box around up to POINTS_A_BOX consecutive points of an outline, and the greatest radius of these points.
 */
enum { POINTS_A_BOX = 64 };
typedef struct points_box {
  double low[3], high[3], radius;
} points_box;

static size_t boxes_of(const hl_outline *outline) {
  return (outline->count + POINTS_A_BOX - 1) / POINTS_A_BOX;
}

static void bound_points(const hl_outline *outline, points_box *boxes) {
  for (size_t b = 0; b < boxes_of(outline); b++)
    boxes[b] = (points_box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, 0};
  for (size_t n = 0; n < outline->count; n++) {
    points_box *box = &boxes[n / POINTS_A_BOX];
    vec3_bound_ball(outline->point[n], 0, box->low, box->high);
    box->radius = fmax(box->radius, outline->radius[n]);
  }
}

/* A bound of the coordinates of the box's points along a unit vector. The bound allows for rounding. */
static double farthest_of_box(const points_box *box, vec3 along) {
  const double way[3] = {along.x, along.y, along.z};
  double sum = box->radius, size = box->radius;
  for (int a = 0; a < 3; a++) {
    sum += way[a] > 0 ? box->high[a] * way[a] : box->low[a] * way[a];
    size += fmax(fabs(box->low[a]), fabs(box->high[a]));
  }
  return sum + 1e-12 * size;
}

/* The index of the point that reaches farthest along a direction; of equally far points, the index of the
 * first. */
static size_t farthest(const hl_outline *outline, const points_box *boxes, vec3 along) {
  size_t best = 0;
  double most = -INFINITY;
  for (size_t b = 0; b < boxes_of(outline); b++) {
    size_t first = b * POINTS_A_BOX, left = outline->count - first;
    if (farthest_of_box(&boxes[b], along) <= most) continue;
    for (size_t n = first; n < first + (left < POINTS_A_BOX ? left : POINTS_A_BOX); n++) {
      double here = vec3_dot(outline->point[n], along) + outline->radius[n];
      if (here > most) most = here, best = n;
    }
  }
  return best;
}

hl_status hl_outline_thin(const hl_outline *outline, hl_outline *thinned, hl_error *error) {
  hl_status status = HL_OK;
  *thinned = (hl_outline){.context = outline->context};
  points_box *boxes = hl_allocate(outline->context, boxes_of(outline), sizeof *boxes);
  if (boxes == NULL) return hl_fail_memory(error, boxes_of(outline) * sizeof *boxes, "an outline");
  bound_points(outline, boxes);
  for (int n = 0; status == HL_OK && n < DIRECTIONS; n++) {
    size_t best = farthest(outline, boxes, hl_even_direction(n, DIRECTIONS));
    bool known = false;
    for (size_t m = 0; m < thinned->count && !known; m++)
      known = memcmp(&thinned->point[m], &outline->point[best], sizeof *thinned->point) == 0;
    if (!known) status = add(thinned, outline->point[best], outline->radius[best], error);
  }
  hl_release(outline->context, boxes);
  return status;
}

/* AXES: the number of coordinate axes and diagonals. The struct holds the points of a mesh that lie farthest
 * along each axis and diagonal, in both directions. */
enum { AXES = 13 };
typedef struct farthest_points {
  vec3 along[AXES], point[2][AXES];
  double radius[2][AXES], most[2][AXES];
} farthest_points;

static void begin_farthest(farthest_points *far) {
  for (int n = 0; n < AXES; n++) {
    far->along[n] = vec3_normalise((vec3){n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1});
    far->most[0][n] = far->most[1][n] = -INFINITY;
  }
}

static void look_at_point(farthest_points *far, vec3 point, double radius) {
  for (int n = 0; n < AXES; n++) {
    double along = vec3_dot(point, far->along[n]);
    for (int way = 0; way < 2; way++) {
      double here = (way ? along : -along) + radius;
      if (here <= far->most[way][n]) continue;
      far->most[way][n] = here;
      far->point[way][n] = point;
      far->radius[way][n] = radius;
    }
  }
}

/* Compares a mesh's vertices with the farthest points so far. used: [vertex_count]; all false at first. */
static void look_at_mesh(farthest_points *far, const hl_scene_mesh *mesh, bool *used) {
  const hl_mesh_description *d = hl_mesh_describe(mesh->mesh);
  affine3 placement = hl_scene_mesh_to_world(mesh);
  for (size_t t = 0; t < d->triangle_count; t++)
    for (int i = 0; i < 3; i++) used[d->triangles[t][i]] = true;
  for (size_t v = 0; v < d->vertex_count; v++) {
    const float *p = d->positions[v];
    if (used[v]) look_at_point(far, affine3_apply(placement, (vec3){p[0], p[1], p[2]}), 0);
  }
  for (size_t n = 0; n < d->sphere_count; n++) {
    const float *s = d->spheres[n];
    look_at_point(far, affine3_apply(placement, (vec3){s[0], s[1], s[2]}), s[3] * mesh->scale);
  }
}

/* Adds the vertices and spheres of a mesh that lie farthest along axes and diagonals. All vertices are
 * compared, because a floor must touch the lowest one, and a single vertex that sticks out of the picture
 * would be seen. */
static hl_status add_farthest(hl_outline *outline, const hl_scene_mesh *mesh, hl_error *error) {
  size_t vertices = hl_mesh_describe(mesh->mesh)->vertex_count;
  bool *used = hl_allocate_zeroed(outline->context, vertices, sizeof *used);
  farthest_points far;
  hl_status status = HL_OK;
  if (used == NULL) return hl_fail_memory(error, vertices * sizeof *used, "a mesh's outline");
  begin_farthest(&far);
  look_at_mesh(&far, mesh, used);
  hl_release(outline->context, used);
  for (int n = 0; n < 2 * AXES && status == HL_OK; n++)
    status = add(outline, far.point[n % 2][n / 2], far.radius[n % 2][n / 2], error);
  return status;
}

/* Adds the vertices and spheres of a mesh that lie farthest in any of many directions. Of a large mesh, only
 * some vertices are compared. */
static hl_status add_mesh(hl_outline *outline, const hl_scene_mesh *mesh, hl_error *error) {
  enum { MOST_CORNERS = 60000 };
  const hl_mesh_description *d = hl_mesh_describe(mesh->mesh);
  affine3 placement = hl_scene_mesh_to_world(mesh);
  size_t corners = 3 * d->triangle_count, stride = corners / MOST_CORNERS + 1;
  hl_outline all = {.context = outline->context}, few = {.context = outline->context};
  hl_status status = HL_OK;
  for (size_t c = 0; c < corners && status == HL_OK; c += stride) {
    const float *p = d->positions[d->triangles[c / 3][c % 3]];
    status = add(&all, affine3_apply(placement, (vec3){p[0], p[1], p[2]}), 0, error);
  }
  stride = d->sphere_count / MOST_CORNERS + 1;
  for (size_t n = 0; n < d->sphere_count && status == HL_OK; n += stride) {
    const float *s = d->spheres[n];
    status = add(&all, affine3_apply(placement, (vec3){s[0], s[1], s[2]}), s[3] * mesh->scale, error);
  }
  if (status == HL_OK) status = hl_outline_thin(&all, &few, error);
  for (size_t n = 0; n < few.count && status == HL_OK; n++)
    status = add(outline, few.point[n], few.radius[n], error);
  if (status == HL_OK) status = add_farthest(outline, mesh, error);
  hl_outline_release(&all);
  hl_outline_release(&few);
  return status;
}

hl_status hl_outline_find(const hl_scene_description *description, hl_outline *outline, hl_error *error) {
  hl_status status = HL_OK;
  *outline = (hl_outline){.context = description->volume_count > 0 ? description->volumes[0].volume->context
                                                                   : description->meshes[0].mesh->context};
  for (size_t n = 0; status == HL_OK && n < description->volume_count; n++)
    status = add_cut_volume(outline, description, &description->volumes[n], error);
  for (size_t n = 0; status == HL_OK && n < description->mesh_count; n++)
    if (description->meshes[n].visible && description->meshes[n].mesh != NULL)
      status = add_mesh(outline, &description->meshes[n], error);
  bool nothing = outline->count == 0;
  for (size_t n = 0; nothing && status == HL_OK && n < description->volume_count; n++)
    status = add_box(outline, &description->volumes[n], error);
  return status;
}

double hl_outline_reach(const hl_outline *outline, vec3 along, vec3 forward, double tangent) {
  vec3 normal = vec3_subtract(along, vec3_scale(forward, tangent));
  double length = vec3_length(normal), greatest = -INFINITY;
  for (size_t n = 0; n < outline->count; n++) {
    const double here = vec3_dot(outline->point[n], normal) + length * outline->radius[n];
    greatest = here > greatest ? here : greatest;
  }
  return greatest;
}

/* ---- the range of values that a transfer function shows, from any side.
 *
 * Voxels within opaque matter are hidden from every side; of a surface, the outer voxels are seen. So a voxel
 * counts with its opacity times the fraction of light that its most transparent neighbour lets through on the
 * way in and out. */

#define TAIL 0.01 /* fraction of the counts that is left out at each end of the range */

enum { BINS = 4096 };

/* The least opacity per voxel edge among the six neighbours of a voxel; a neighbour outside the grid has 0.
 */
static double least_opacity_around(const hl_volume *volume, const hl_transfer_function *function,
                                   const size_t at[3]) {
  double least = 1;
  for (int n = 0; n < 6; n++) {
    size_t next[3] = {at[0], at[1], at[2]};
    /* an index below 0 wraps round to a large number, which is outside the grid as well */
    next[n / 2] += n % 2 == 0 ? 1 : (size_t)-1;
    least = fmin(least, hl_transfer_function_opacity(
                            function, hl_volume_value_within(volume, next[0], next[1], next[2])));
  }
  return least;
}

/* Adds the weights of visible voxels in equal bins over [low, high]; returns their sum. */
static double count_seen(const hl_volume *volume, const hl_transfer_function *function, double low,
                         double high, double *counts) {
  const size_t *n = volume->dimension;
  size_t step = hl_lattice_step(n, HL_LATTICE_PLACES), at[3];
  double sum = 0;
  for (at[2] = 0; at[2] < n[2]; at[2] += step)
    for (at[1] = 0; at[1] < n[1]; at[1] += step)
      for (at[0] = 0; at[0] < n[0]; at[0] += step) {
        double value = hl_volume_value_within(volume, at[0], at[1], at[2]),
               opacity = hl_transfer_function_opacity(function, value);
        if (!(opacity > 0) || !(value >= low && value <= high)) continue;
        double light = 1 - least_opacity_around(volume, function, at), seen = opacity * light * light;
        int bin = (int)((value - low) / (high - low) * BINS);
        counts[bin < BINS ? bin : BINS - 1] += seen;
        sum += seen;
      }
  return sum;
}

/* The value below which a fraction of the counts lies. */
static double quantile(const double *counts, double sum, double fraction, double low, double high) {
  double below = 0;
  int bin = 0;
  while (bin + 1 < BINS && below + counts[bin] < fraction * sum) below += counts[bin++];
  double within = counts[bin] > 0 ? (fraction * sum - below) / counts[bin] : 0.5;
  return low + (high - low) * (bin + fmin(fmax(within, 0), 1)) / BINS;
}

hl_status hl_transfer_function_seen_range(const hl_volume *volume, const hl_transfer_function *function,
                                          double range[2], hl_error *error) {
  HL_DOOR;
  if (volume == NULL || function == NULL || range == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_transfer_function_seen_range: null volume, function or range");
  double counts[BINS] = {0}, low = volume->minimum, high = volume->maximum;
  range[0] = low;
  range[1] = high > low ? high : low + 1;
  double sum = high > low ? count_seen(volume, function, low, high, counts) : 0;
  if (!(sum > 0)) return HL_OK;
  double first = quantile(counts, sum, TAIL, low, high), last = quantile(counts, sum, 1 - TAIL, low, high);
  /* If a few outliers leave nearly all bins empty, values are counted anew in bins between the ends found so
   * far. */
  if (last - first < 100 * (high - low) / BINS) {
    double bin = (high - low) / BINS, near[BINS] = {0};
    low = fmax(low, first - bin), high = fmin(high, last + bin);
    sum = count_seen(volume, function, low, high, near);
    first = quantile(near, sum, TAIL, low, high), last = quantile(near, sum, 1 - TAIL, low, high);
  }
  if (last > first) range[0] = first, range[1] = last;
  return HL_OK;
}
