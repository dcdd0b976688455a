/* guess/holders.c - finds the holders of a scanned object, as bodies of cells, and planes that cut them off.
 *
 * All lengths are in the world of the volume's file. A body's reach along a direction follows from the two
 * end cells of each of its rows of cells alone, because half spaces are convex. */
#include "guess/holders.h"

#include <string.h>

#include "core/memory.h"
#include "guess/outline.h"
#include "guess/sample.h"
#include "guess/seen_cells.h"

#define OBJECT_CELLS 0.8 /* least fraction of all visible cells that must belong to the object */
/* least fraction of the visible cells' optical depth that must belong to the object */
#define OBJECT_DEPTH 0.9
/* Least number of cells of a body, as a fraction of the object's cells; smaller bodies are specks. */
#define LEAST 0.005
/* least length of a holder, such as a table, as a fraction of the object's length */
#define LONG          0.5
#define THIN          0.25  /* greatest thickness of a holder, as a fraction of its length */
#define DENSEST       0.9   /* the quantile of the object's matter from which on matter counts as dense */
#define DENSE_AT_MOST 0.005 /* greatest fraction of a holder's matter that may be dense */
/* distance, in cells, from the centres of the object's outermost cells to a plane */
#define RIM 1.0
/* The least distance, in cells, from the centres of the object's outermost cells to a cell that a plane cuts
 * off, so that the cell lies wholly beyond the plane. */
#define CLEAR 1.5

#define LEFT      0.01 /* fraction of a holder that may remain in the gap beside the object */
#define RIM_LEVEL 0.3  /* cells of rims have at least this fraction of the level's optical depth */

enum { DIRECTIONS = 1000 };
enum { SAMPLE = 4096 }; /* greatest number of cells or voxels of a body that are examined */
enum { FOR_EACH = 4 };  /* greatest number of planes that cut off one holder */
/* The number that cells of holders and rims have in place of a body's number. */
static const uint32_t BESIDE = UINT32_MAX;

/* The levels of mean optical depth, as fractions of the greatest cell's depth, beyond which cells belong to
 * bodies. At the first level even faint holders are seen. At the second level, foam and clothes no longer
 * join a holder to the object. Each level is searched, because at the first level one part of a holder may be
 * free, while foam joins another part to the object. */
static const double levels[] = {0.02, 0.1};

/* A list of cells of a body: either the two end cells of each of the body's rows of cells, or all of its
 * cells. */
typedef struct body_cells {
  vec3 *point; /* owned; [count]; centres of cells */
  size_t count;
  bool at_border; /* whether the body has cells at the grid's border */
} body_cells;

/* A direction, and the lengths that are measured along it. */
typedef struct side {
  vec3 direction;
  double cell_width; /* width of one cell */
  double hull;       /* reach of the centres of the object's cells */
} side;

typedef struct search {
  hl_context *context;
  const hl_data_analysis *analysis;
  hl_seen *seen;         /* borrowed; cells that planes have cut off are made clear before the next level */
  affine3 cell_to_world; /* maps whole numbers of cells to their centres */
  hl_bodies bodies;
  side sides[DIRECTIONS];
  body_cells object;
  double object_length;
  double grid_length; /* the sum of the lengths of the grid's three edges; no two cells are farther apart */
  double densest; /* the distance from the background beyond which the object's matter counts as dense; NaN:
                   * not found yet */
  float faint;    /* mean depth of the cells in the faintest rims */
  side planes[HL_HOLDER_PLANES];
  size_t plane_count;
  size_t kept; /* the number of planes that were found at earlier levels */
} search;

/* ---- bodies ---- */

static void cells_release(hl_context *context, body_cells *cells) { hl_release(context, cells->point); }

static bool lies_beyond(vec3 point, const side *plane) {
  return vec3_dot(point, plane->direction) > plane->hull + CLEAR * plane->cell_width;
}

static vec3 center_of(const search *s, int i, int j, int k) {
  return affine3_apply(s->cell_to_world, (vec3){i, j, k});
}

static void add_cell(const search *s, body_cells *cells, int i, int j, int k) {
  const int *n = s->seen->size;
  cells->point[cells->count++] = center_of(s, i, j, k);
  cells->at_border = cells->at_border || i == 0 || j == 0 || k == 0 || i == n[0] - 1 || j == n[1] - 1 ||
                     k == n[2] - 1;
}

/* Finds the ends of a body. Fails for lack of memory; release the ends in any case. */
static hl_status find_ends(const search *s, uint32_t body, body_cells *ends, hl_error *error) {
  const int *n = s->seen->size;
  size_t rows = (size_t)n[1] * (size_t)n[2];
  *ends = (body_cells){.point = hl_allocate(s->context, 2 * rows, sizeof *ends->point)};
  if (ends->point == NULL)
    return hl_fail_memory(error, 2 * rows * sizeof *ends->point, "the rows of a volume's bodies");
  for (size_t row = 0; row < rows; row++) {
    const uint32_t *cells = s->bodies.body + row * (size_t)n[0];
    int first = 0, last = n[0] - 1, j = (int)(row % (size_t)n[1]), k = (int)(row / (size_t)n[1]);
    while (first < n[0] && cells[first] != body) first++;
    while (last > first && cells[last] != body) last--;
    if (first == n[0]) continue;
    add_cell(s, ends, first, j, k);
    if (last > first) add_cell(s, ends, last, j, k);
  }
  return HL_OK;
}

/* Finds all cells of a body. Fails for lack of memory; release the cells in any case. */
static hl_status find_cells(const search *s, uint32_t body, body_cells *found, hl_error *error) {
  const int *n = s->seen->size;
  const size_t cells = (size_t)n[0] * (size_t)n[1] * (size_t)n[2];
  size_t count = 0;
  for (size_t c = 0; c < cells; c++) count += s->bodies.body[c] == body;
  *found = (body_cells){.point = hl_allocate(s->context, count + 1, sizeof *found->point)};
  if (found->point == NULL)
    return hl_fail_memory(error, (count + 1) * sizeof *found->point, "the cells of a volume's bodies");
  for (size_t c = 0; c < cells; c++)
    if (s->bodies.body[c] == body)
      add_cell(s, found, (int)(c % (size_t)n[0]), (int)(c / (size_t)n[0] % (size_t)n[1]),
               (int)(c / (size_t)n[0] / (size_t)n[1]));
  return HL_OK;
}

/* Returns the farthest place of a body's cells along the direction of a side. *width: the length of the body
 * along this direction. */
static double reach(const body_cells *ends, const side *along, double *width) {
  double low = INFINITY, high = -INFINITY;
  for (size_t n = 0; n < ends->count; n++) {
    double at = vec3_dot(ends->point[n], along->direction);
    low = at < low ? at : low;
    high = at > high ? at : high;
  }
  *width = high - low + along->cell_width;
  return high;
}

/* Measures the object along a direction. *width: the object's width. */
static side side_along(const search *s, vec3 direction, double *width) {
  side along = {.direction = direction};
  for (int a = 0; a < 3; a++)
    along.cell_width += fabs(vec3_dot(mat3_column(s->cell_to_world.linear, a), direction));
  along.hull = reach(&s->object, &along, width);
  return along;
}

/* Looks at the voxels in the middle of a body's cells. Without a limit, finds a quantile of the voxels'
 * distances from the background; with a limit, finds the fraction of the voxels whose distance reaches the
 * limit. Fails for lack of memory. */
static hl_status look_at_matter(const search *s, uint32_t body, const double *limit, double *found,
                                hl_error *error) {
  const hl_seen *seen = s->seen;
  float distances[SAMPLE];
  size_t nx = (size_t)seen->size[0], ny = (size_t)seen->size[1], cells = nx * ny * (size_t)seen->size[2],
         each = s->bodies.places[body] / SAMPLE + 1, met = 0, count = 0, above = 0;
  for (size_t c = 0; c < cells && count < SAMPLE; c++) {
    if (s->bodies.body[c] != body || met++ % each != 0) continue;
    size_t step = seen->step, half = step / 2;
    double value = hl_volume_value_within(seen->volume, c % nx * step + half, c / nx % ny * step + half,
                                          c / nx / ny * step + half);
    if (!isfinite(value)) continue;
    double distance = s->analysis->direction * (value - s->analysis->background);
    distances[count++] = (float)distance;
    above += limit != NULL && (float)distance >= (float)*limit;
  }
  if (limit == NULL && !hl_sort(s->context, distances, count))
    return hl_fail_memory(error, sizeof distances, "a sample of a volume's body");
  *found = count == 0      ? INFINITY
           : limit != NULL ? (double)above / (double)count
                           : hl_quantile(distances, count, DENSEST);
  return HL_OK;
}

/* ---- the object ---- */

/* Finds the bodies at a level, and the object, which is the largest of them. *is_one: set to whether the
 * object is nearly everything that is seen. */
static hl_status find_object(search *s, double level, bool *is_one, hl_error *error) {
  const hl_seen *seen = s->seen;
  const size_t cells = (size_t)seen->size[0] * (size_t)seen->size[1] * (size_t)seen->size[2];
  unsigned char *marked = hl_allocate(s->context, cells, 1);
  if (marked == NULL) return hl_fail_memory(error, cells, "a volume's marked cells");
  float most = 0;
  for (size_t c = 0; c < cells; c++) most = fmaxf(most, seen->mean[c]);
  for (size_t c = 0; c < cells; c++) marked[c] = seen->mean[c] > level * most;
  s->faint = (float)(RIM_LEVEL * level * most);
  hl_status status = hl_bodies_find(s->context, marked, seen->size, &s->bodies, error);
  hl_release(s->context, marked);
  if (status != HL_OK) return status;
  double all = 0, depth = 0, own = 0;
  for (uint32_t b = 1; b <= s->bodies.count; b++) all += s->bodies.places[b];
  for (size_t c = 0; c < cells; c++) {
    uint32_t body = s->bodies.body[c];
    depth += body != 0 ? seen->mean[c] : 0;
    own += body != 0 && body == s->bodies.largest ? seen->mean[c] : 0;
  }
  *is_one = s->bodies.count > 1 && s->bodies.places[s->bodies.largest] >= OBJECT_CELLS * all &&
            own >= OBJECT_DEPTH * depth;
  return HL_OK;
}

static hl_status measure_object(search *s, hl_error *error) {
  hl_status status = find_ends(s, s->bodies.largest, &s->object, error);
  s->object_length = 0;
  for (int d = 0; status == HL_OK && d < DIRECTIONS; d++) {
    double width;
    s->sides[d] = side_along(s, hl_even_direction(d, DIRECTIONS), &width);
    s->object_length = fmax(s->object_length, width);
  }
  return status;
}

/* ---- holders ---- */

/* The number of cells beyond a plane. At most SAMPLE cells are examined. */
static size_t count_beyond(const body_cells *cells, const side *plane) {
  size_t count = 0, each = cells->count / SAMPLE + 1;
  for (size_t n = 0; n < cells->count; n += each) count += lies_beyond(cells->point[n], plane);
  return count;
}

/* Removes the cells beyond a plane from a list. */
static void take_out(body_cells *cells, const side *plane) {
  size_t left = 0;
  for (size_t n = 0; n < cells->count; n++)
    if (!lies_beyond(cells->point[n], plane)) cells->point[left++] = cells->point[n];
  cells->count = left;
}

/* Tilts a plane, by smaller and smaller angles, so that it cuts off more of a body. *most: the number of
 * examined cells that the plane cuts off. The first angle is the angle between neighbouring sides (derived:
 * each side has 4 pi / DIRECTIONS of the sphere). The last angle moves no cell of the grid by more than half
 * a cell. */
static side tilt(const search *s, const body_cells *cells, side plane, size_t *most) {
  const double first = sqrt(4 * HL_PI / DIRECTIONS);
  for (double angle = first; angle * s->grid_length > plane.cell_width / 2; angle /= 2) {
    const vec3 from = plane.direction, across = vec3_perpendicular(from), along = vec3_cross(from, across);
    for (int way = 0; way < 9; way++) { /* eight directions of tilting, and no tilting */
      const vec3 to = vec3_add(vec3_scale(across, way % 3 - 1), vec3_scale(along, way / 3 - 1));
      double width;
      const side tilted = side_along(s, vec3_normalise(vec3_add(from, vec3_scale(to, angle))), &width);
      const size_t beyond = count_beyond(cells, &tilted);
      if (beyond > *most) *most = beyond, plane = tilted;
    }
  }
  return plane;
}

/* Finds the plane that cuts off most of a body, among the planes across the directions of `sides`. *most: the
 * number of examined cells that the plane cuts off. */
static side best_plane(const search *s, const body_cells *cells, size_t *most) {
  side plane = s->sides[0];
  *most = 0;
  for (int d = 0; d < DIRECTIONS; d++) {
    const size_t beyond = count_beyond(cells, &s->sides[d]);
    if (beyond > *most) *most = beyond, plane = s->sides[d];
  }
  return *most > 0 ? tilt(s, cells, plane, most) : plane;
}

/* Adds planes that cut off a body, until s->plane_count is `most_planes`. Each new plane cuts off the
 * greatest possible number of the remaining cells. *left: the fraction of the body that remains in the end.
 * Fails for lack of memory. */
static hl_status cut_off(search *s, uint32_t body, size_t most_planes, double *left, hl_error *error) {
  body_cells cells;
  hl_status status = find_cells(s, body, &cells, error);
  const double all = (double)cells.count;
  while (status == HL_OK && cells.count > 0 && s->plane_count < most_planes) {
    size_t most;
    const side plane = best_plane(s, &cells, &most);
    if (most == 0) break;
    s->planes[s->plane_count++] = plane;
    take_out(&cells, &plane);
  }
  *left = all > 0 ? (double)cells.count / all : 0;
  cells_release(s->context, &cells);
  return status;
}

static bool is_long_and_thin(const search *s, const body_cells *ends) {
  double most = 0, least = INFINITY, width;
  for (int d = 0; d < DIRECTIONS; d++) {
    reach(ends, &s->sides[d], &width);
    most = fmax(most, width);
    least = fmin(least, width);
  }
  return most >= LONG * s->object_length && least <= THIN * most;
}

static hl_status holds_dense_matter(search *s, uint32_t body, bool *dense, hl_error *error) {
  double above = 0;
  hl_status status = HL_OK;
  if (isnan(s->densest)) status = look_at_matter(s, s->bodies.largest, NULL, &s->densest, error);
  if (status == HL_OK) status = look_at_matter(s, body, &s->densest, &above, error);
  *dense = above > DENSE_AT_MOST;
  return status;
}

/* Finds whether a body is a holder: whether a few planes of its own cut off nearly all of it. */
static hl_status is_holder(search *s, uint32_t body, bool *is_one, hl_error *error) {
  body_cells ends;
  bool dense = false;
  double left = 1;
  hl_status status = find_ends(s, body, &ends, error);
  if (status == HL_OK && ends.at_border && is_long_and_thin(s, &ends))
    status = cut_off(s, body, s->kept + FOR_EACH, &left, error);
  s->plane_count = s->kept;
  if (status == HL_OK && left <= LEFT) status = holds_dense_matter(s, body, &dense, error);
  *is_one = left <= LEFT && !dense;
  cells_release(s->context, &ends);
  return status;
}

/* Finds whether one of the planes found at this level would cut a body that is no holder. */
static hl_status is_met(const search *s, uint32_t body, bool *met, hl_error *error) {
  body_cells ends;
  hl_status status = find_ends(s, body, &ends, error);
  for (size_t n = 0; status == HL_OK && n < ends.count && !*met; n++)
    for (size_t p = s->kept; p < s->plane_count && !*met; p++) {
      const side *plane = &s->planes[p];
      *met = vec3_dot(ends.point[n], plane->direction) > plane->hull + (RIM - 0.5) * plane->cell_width;
    }
  cells_release(s->context, &ends);
  return status;
}

/* Returns true if a point lies beyond the object's hull in some direction, so that a plane could cut it
 * off. */
static bool is_beside(const search *s, vec3 point) {
  bool beside = false;
  for (int d = 0; d < DIRECTIONS && !beside; d++) beside = lies_beyond(point, &s->sides[d]);
  return beside;
}

/* Removes cells from the holders and rims (BESIDE) if no plane could cut them off. In each row, the cells
 * that no plane could cut off are neighbours, because the points that lie beyond no side form a convex shape.
 */
static void drop_what_is_within(search *s) {
  const int *n = s->seen->size;
  for (int k = 0; k < n[2]; k++)
    for (int j = 0; j < n[1]; j++) {
      uint32_t *cells = s->bodies.body + ((size_t)k * (size_t)n[1] + (size_t)j) * (size_t)n[0];
      int first = 0, last = n[0] - 1;
      while (first < n[0] && (cells[first] != BESIDE || is_beside(s, center_of(s, first, j, k)))) first++;
      while (last > first && (cells[last] != BESIDE || is_beside(s, center_of(s, last, j, k)))) last--;
      for (int i = first; i <= last; i++)
        if (cells[i] == BESIDE) cells[i] = 0;
    }
}

/* Cuts off the holders, together with the faint rims around them. other: [bodies + 1]; whether a body is
 * neither a holder nor a speck. */
static hl_status cut_holders_off(search *s, const unsigned char *other, hl_error *error) {
  const hl_seen *seen = s->seen;
  const size_t cells = (size_t)seen->size[0] * (size_t)seen->size[1] * (size_t)seen->size[2];
  double left;
  for (size_t c = 0; c < cells; c++)
    if (!other[s->bodies.body[c]]) s->bodies.body[c] = seen->mean[c] > s->faint ? BESIDE : 0;
  drop_what_is_within(s);
  return cut_off(s, BESIDE, HL_HOLDER_PLANES, &left, error);
}

/* Finds the holders among the bodies. other: [bodies + 1]; set to whether a body is neither a holder nor a
 * speck. *any: set to whether there is a holder. */
static hl_status find_holders(search *s, unsigned char *other, bool *any, hl_error *error) {
  const double least = LEAST * s->bodies.places[s->bodies.largest];
  hl_status status = HL_OK;
  for (uint32_t b = 1; status == HL_OK && b <= s->bodies.count; b++) {
    bool is_one = false;
    other[b] = b == s->bodies.largest || !(s->bodies.places[b] < least);
    if (b == s->bodies.largest || !other[b]) continue;
    status = is_holder(s, b, &is_one, error);
    other[b] = !is_one;
    *any = *any || is_one;
  }
  return status;
}

/* Finds further planes at one level. If one of the planes would cut a body that is no holder, no plane is
 * added. */
static hl_status find_planes(search *s, double level, hl_error *error) {
  bool is_one = false, any = false, doubt = false;
  hl_status status = find_object(s, level, &is_one, error);
  if (status != HL_OK || !is_one) return status;
  unsigned char *other = hl_allocate_zeroed(s->context, (size_t)s->bodies.count + 1, 1);
  if (other == NULL) return hl_fail_memory(error, (size_t)s->bodies.count + 1, "a volume's bodies");
  status = measure_object(s, error);
  if (status == HL_OK) status = find_holders(s, other, &any, error);
  if (status == HL_OK && any) status = cut_holders_off(s, other, error);
  for (uint32_t b = 1; status == HL_OK && any && b <= s->bodies.count; b++)
    if (other[b] && b != s->bodies.largest) status = is_met(s, b, &doubt, error);
  if (doubt) s->plane_count = s->kept;
  cells_release(s->context, &s->object);
  hl_release(s->context, other);
  return status;
}

/* ---- all steps together ---- */

static void set_out(search *s, affine3 index_to_world) {
  double step = (double)s->seen->step, middle = (step - 1) / 2;
  s->cell_to_world.linear = index_to_world.linear;
  for (int row = 0; row < 3; row++)
    s->cell_to_world.linear.row[row] = vec3_scale(index_to_world.linear.row[row], step);
  s->cell_to_world.offset = affine3_apply(index_to_world, (vec3){middle, middle, middle});
  for (int a = 0; a < 3; a++)
    s->grid_length += s->seen->size[a] * vec3_length(mat3_column(s->cell_to_world.linear, a));
}

/* Keeps the planes of the last level, and makes those cells clear whose centres these planes cut off. */
static void keep_planes(search *s) {
  const int *n = s->seen->size;
  float *mean = s->seen->mean;
  for (int k = 0; k < n[2] && s->kept < s->plane_count; k++)
    for (int j = 0; j < n[1]; j++)
      for (int i = 0; i < n[0]; i++, mean++)
        for (size_t p = s->kept; p<s->plane_count && * mean> 0; p++) {
          const side *plane = &s->planes[p];
          if (vec3_dot(center_of(s, i, j, k), plane->direction) > plane->hull + RIM * plane->cell_width)
            *mean = 0;
        }
  s->kept = s->plane_count;
}

static void make_cuts(const search *s, hl_cut planes[HL_HOLDER_PLANES]) {
  for (size_t p = 0; p < s->plane_count; p++) {
    const side *plane = &s->planes[p];
    const vec3 normal = plane->direction, at = vec3_scale(normal, plane->hull + RIM * plane->cell_width);
    hl_cut_defaults(&planes[p]);
    memcpy(planes[p].normal, &normal, sizeof planes[p].normal);
    memcpy(planes[p].point, &at, sizeof planes[p].point);
  }
}

hl_status hl_holders_find(const hl_scene_volume *volume, const hl_data_analysis *analysis,
                          hl_cut planes[HL_HOLDER_PLANES], size_t *count, hl_error *error) {
  *count = 0;
  if (analysis->kind != HL_DATA_SURFACES || analysis->vessels > 0) return HL_OK; /* vessels have no holders */
  hl_seen seen;
  bool any = false;
  hl_status status = hl_seen_find(volume, &seen, &any, error);
  hl_context *context = volume->volume->context;
  search *s = hl_allocate_zeroed(context, 1, sizeof *s);
  if (status == HL_OK && s == NULL) status = hl_fail_memory(error, sizeof *s, "the search for holders");
  if (status == HL_OK && any) {
    *s = (search){.context = context, .analysis = analysis, .seen = &seen, .densest = NAN};
    set_out(s, volume->volume->index_to_world);
    for (size_t n = 0; n < sizeof levels / sizeof *levels && status == HL_OK; n++) {
      status = find_planes(s, levels[n], error);
      keep_planes(s);
      hl_bodies_release(context, &s->bodies);
      s->densest = NAN;
    }
    if (status == HL_OK) *count = s->plane_count;
    make_cuts(s, planes);
  }
  hl_release(context, s);
  hl_seen_release(&seen);
  return status;
}
