/* guess/holders.c - finds the holders of a scanned object, as bodies of cells, and planes that cut them off.
 *
 * All lengths are in the world of the volume's file. Of each row of a body's cells only the two ends are
 * kept: planes need no more, because half spaces are convex. */
#include "guess/holders.h"

#include <string.h>

#include "core/memory.h"
#include "guess/outline.h"
#include "guess/sample.h"
#include "guess/seen_cells.h"

#define OBJECT_CELLS 0.8  /* least fraction of all visible cells that the object has */
#define OBJECT_DEPTH 0.95 /* least fraction of the visible cells' optical depth that the object has */
/* Least number of cells of a body, as a fraction of the object's cells; smaller bodies are specks. */
#define LEAST         0.005
#define LONG          0.5   /* least length of a holder, as a fraction of the object's length */
#define THIN          0.25  /* greatest thickness of a holder, as a fraction of its length */
#define DENSEST       0.9   /* quantile of the object's matter that counts as dense */
#define DENSE_AT_MOST 0.005 /* greatest fraction of a holder that is as dense */
#define RIM           1.0   /* cells from the centres of the object's outermost cells to a plane */
/* The least number of cells from a plane to the centres of a holder's cells, which then lie wholly beyond
 * the plane. */
#define CLEAR 1.5

#define LEFT      0.01 /* fraction of a holder that may remain in the gap beside the object */
#define RIM_LEVEL 0.3  /* fraction of the level from which cells are seen as rims */
#define MANY      0.1  /* least fraction of all rims that a plane must cut off */

enum { DIRECTIONS = 1000, VOXELS = 4096 };
enum { FOR_EACH = 4, FOR_RIMS = 4 };     /* most planes for one holder, and for all rims */
static const uint32_t RIMS = UINT32_MAX; /* stands in place of a body's number */

/* The levels by which cells belong to bodies: mean optical depths, as fractions of the greatest cell's. At
 * the first level faint holders are seen. At the second one, foam and clothes no longer join a holder to the
 * object. */
static const double levels[] = {0.02, 0.1};

/* The two end cells of each row of a body's cells. */
typedef struct body_ends {
  vec3 *point;    /* owned; [count]; centres of cells */
  uint32_t *cell; /* owned; [count] */
  size_t count;
  bool at_border; /* the body has cells at the grid's border */
} body_ends;

typedef struct search {
  hl_context *context;
  const hl_data_analysis *analysis;
  const hl_seen *seen;
  affine3 cell_to_world; /* maps whole numbers of cells to their centres */
  hl_bodies bodies;
  vec3 direction[DIRECTIONS];
  double cell_width[DIRECTIONS]; /* width of one cell along each direction */
  double hull[DIRECTIONS];       /* reach of the object's cell centres along each direction */
  double object_length;
  double densest;                   /* distance from the background; NaN: not found yet */
  float faint;                      /* mean depth of the cells in the faintest rims */
  uint32_t plane[HL_HOLDER_PLANES]; /* numbers of the planes' directions */
  size_t plane_count;
} search;

/* ---- bodies ---- */

static void ends_release(hl_context *context, body_ends *ends) {
  hl_release(context, ends->point);
  hl_release(context, ends->cell);
}

static void add_end(const search *s, body_ends *ends, int i, int j, int k) {
  const int *n = s->seen->size;
  ends->point[ends->count] = affine3_apply(s->cell_to_world, (vec3){i, j, k});
  ends->cell[ends->count++] = ((uint32_t)k * (uint32_t)n[1] + (uint32_t)j) * (uint32_t)n[0] + (uint32_t)i;
  ends->at_border = ends->at_border || i == 0 || j == 0 || k == 0 || i == n[0] - 1 || j == n[1] - 1 ||
                    k == n[2] - 1;
}

/* Finds the ends of a body. Fails for lack of memory; release the ends in any case. */
static hl_status find_ends(const search *s, uint32_t body, body_ends *ends, hl_error *error) {
  const int *n = s->seen->size;
  size_t rows = (size_t)n[1] * (size_t)n[2];
  *ends = (body_ends){.point = hl_allocate(s->context, 2 * rows, sizeof *ends->point),
                      .cell = hl_allocate(s->context, 2 * rows, sizeof *ends->cell)};
  if (ends->point == NULL || ends->cell == NULL)
    return hl_fail_memory(error, 2 * rows * sizeof *ends->point, "the rows of a volume's bodies");
  for (size_t row = 0; row < rows; row++) {
    const uint32_t *cells = s->bodies.body + row * (size_t)n[0];
    int first = 0, last = n[0] - 1, j = (int)(row % (size_t)n[1]), k = (int)(row / (size_t)n[1]);
    while (first < n[0] && cells[first] != body) first++;
    while (last > first && cells[last] != body) last--;
    if (first == n[0]) continue;
    add_end(s, ends, first, j, k);
    if (last > first) add_end(s, ends, last, j, k);
  }
  return HL_OK;
}

/* The reach of a body's cells along a direction, and the body's width there. */
static double reach(const search *s, const body_ends *ends, int d, double *width) {
  double low = INFINITY, high = -INFINITY;
  for (size_t n = 0; n < ends->count; n++) {
    double at = vec3_dot(ends->point[n], s->direction[d]);
    low = fmin(low, at);
    high = fmax(high, at);
  }
  *width = high - low + s->cell_width[d];
  return high;
}

/* Looks at voxels in the middle of a body's cells. Finds a quantile of their distances from the background
 * or, with a limit, the fraction of them that reaches the limit. Fails for lack of memory. */
static hl_status look_at_matter(const search *s, uint32_t body, const double *limit, double *found,
                                hl_error *error) {
  const hl_seen *seen = s->seen;
  float distances[VOXELS];
  size_t nx = (size_t)seen->size[0], ny = (size_t)seen->size[1], cells = nx * ny * (size_t)seen->size[2],
         each = s->bodies.places[body] / VOXELS + 1, met = 0, count = 0, above = 0;
  for (size_t c = 0; c < cells && count < VOXELS; c++) {
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

/* Finds the bodies at a level, and the object, which is the largest of them. *is_one: the object is nearly
 * everything that is seen. */
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
  body_ends ends;
  hl_status status = find_ends(s, s->bodies.largest, &ends, error);
  s->object_length = 0;
  for (int d = 0; status == HL_OK && d < DIRECTIONS; d++) {
    double width;
    s->hull[d] = reach(s, &ends, d, &width);
    s->object_length = fmax(s->object_length, width);
  }
  ends_release(s->context, &ends);
  return status;
}

/* ---- holders ---- */

static bool lies_beyond(const search *s, vec3 point, size_t d) {
  return vec3_dot(point, s->direction[d]) > s->hull[d] + CLEAR * s->cell_width[d];
}

static bool is_cut_off(const search *s, vec3 point) {
  bool cut = false;
  for (size_t p = 0; p < s->plane_count && !cut; p++) cut = lies_beyond(s, point, s->plane[p]);
  return cut;
}

/* Adds planes, at most `most_planes`, and removes the ends that they cut off. Each plane is the one that cuts
 * off most of the rest of a body. It must cut off more than a fraction of the body, or, once nearly nothing
 * is left, anything at all. True if nearly nothing is left. */
static bool cut_off(search *s, int most_planes, double fraction, body_ends *ends) {
  const double enough = fraction * (double)ends->count, rest = LEFT * (double)ends->count;
  for (int added = 0;; added++) {
    size_t left = 0, most = 0;
    for (size_t n = 0; n < ends->count; n++)
      if (!is_cut_off(s, ends->point[n])) ends->point[left++] = ends->point[n];
    ends->count = left;
    const bool nearly = (double)left <= rest;
    if (left == 0 || added == most_planes || s->plane_count == HL_HOLDER_PLANES) return nearly;
    for (uint32_t d = 0; d < DIRECTIONS; d++) {
      size_t beyond = 0;
      for (size_t n = 0; n < left; n++) beyond += lies_beyond(s, ends->point[n], d);
      if (beyond > most) most = beyond, s->plane[s->plane_count] = d;
    }
    if (!((double)most > (nearly ? 0 : enough))) return nearly;
    s->plane_count++;
  }
}

static bool is_long_and_thin(const search *s, const body_ends *ends) {
  double most = 0, least = INFINITY, width;
  for (int d = 0; d < DIRECTIONS; d++) {
    reach(s, ends, d, &width);
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

/* Cuts the body off if it is a holder. */
static hl_status take(search *s, uint32_t body, bool *is_holder, hl_error *error) {
  body_ends ends;
  const size_t planes = s->plane_count;
  bool dense = false;
  hl_status status = find_ends(s, body, &ends, error);
  *is_holder = status == HL_OK && ends.at_border && is_long_and_thin(s, &ends) &&
               cut_off(s, FOR_EACH, 0, &ends);
  if (*is_holder) status = holds_dense_matter(s, body, &dense, error);
  if (dense) *is_holder = false;
  if (!*is_holder) s->plane_count = planes;
  ends_release(s->context, &ends);
  return status;
}

/* Finds whether a plane would cut a body that is no holder. */
static hl_status is_met(const search *s, uint32_t body, bool *met, hl_error *error) {
  body_ends ends;
  hl_status status = find_ends(s, body, &ends, error);
  for (size_t n = 0; status == HL_OK && n < ends.count && !*met; n++)
    for (size_t p = 0; p < s->plane_count && !*met; p++) {
      uint32_t d = s->plane[p];
      *met = vec3_dot(ends.point[n], s->direction[d]) > s->hull[d] + (RIM - 0.5) * s->cell_width[d];
    }
  ends_release(s->context, &ends);
  return status;
}

/* True if a plane could cut off a point. */
static bool is_beside(const search *s, vec3 point) {
  bool beside = false;
  for (uint32_t d = 0; d < DIRECTIONS && !beside; d++) beside = lies_beyond(s, point, d);
  return beside;
}

/* Cuts off the faint rims of holders: adds planes that each take away much of all rims beside the object. */
static hl_status cut_rims_off(search *s, hl_error *error) {
  const hl_seen *seen = s->seen;
  const size_t cells = (size_t)seen->size[0] * (size_t)seen->size[1] * (size_t)seen->size[2];
  body_ends ends;
  for (size_t c = 0; c < cells; c++)
    if (s->bodies.body[c] != s->bodies.largest) s->bodies.body[c] = seen->mean[c] > s->faint ? RIMS : 0;
  hl_status status = find_ends(s, RIMS, &ends, error);
  size_t beside = 0;
  for (size_t n = 0; status == HL_OK && n < ends.count; n++)
    if (!is_cut_off(s, ends.point[n]) && is_beside(s, ends.point[n])) ends.point[beside++] = ends.point[n];
  ends.count = beside;
  if (status == HL_OK) cut_off(s, FOR_RIMS, MANY, &ends);
  ends_release(s->context, &ends);
  return status;
}

/* Finds the planes at one level; where in doubt, none. */
static hl_status find_planes(search *s, double level, hl_error *error) {
  bool is_one = false, doubt = false;
  hl_status status = find_object(s, level, &is_one, error);
  if (status != HL_OK || !is_one) return status;
  double least = LEAST * s->bodies.places[s->bodies.largest];
  unsigned char *holder = hl_allocate_zeroed(s->context, (size_t)s->bodies.count + 1, 1);
  if (holder == NULL) return hl_fail_memory(error, (size_t)s->bodies.count + 1, "a volume's bodies");
  status = measure_object(s, error);
  for (int pass = 0; pass < 2; pass++)
    for (uint32_t b = 1; status == HL_OK && b <= s->bodies.count; b++) {
      if (b == s->bodies.largest || s->bodies.places[b] < least || holder[b]) continue;
      bool is_holder = false;
      status = pass == 0 ? take(s, b, &is_holder, error) : is_met(s, b, &doubt, error);
      holder[b] = is_holder;
    }
  if (status == HL_OK && !doubt && s->plane_count > 0) status = cut_rims_off(s, error);
  if (doubt) s->plane_count = 0;
  hl_release(s->context, holder);
  return status;
}

/* ---- the whole ---- */

static void set_out(search *s, affine3 index_to_world) {
  double step = (double)s->seen->step, middle = (step - 1) / 2;
  s->cell_to_world.linear = index_to_world.linear;
  for (int row = 0; row < 3; row++)
    s->cell_to_world.linear.row[row] = vec3_scale(index_to_world.linear.row[row], step);
  s->cell_to_world.offset = affine3_apply(index_to_world, (vec3){middle, middle, middle});
  for (int d = 0; d < DIRECTIONS; d++) {
    s->direction[d] = hl_even_direction(d, DIRECTIONS);
    s->cell_width[d] = 0;
    for (int a = 0; a < 3; a++)
      s->cell_width[d] += fabs(vec3_dot(mat3_column(s->cell_to_world.linear, a), s->direction[d]));
  }
}

static void make_cuts(const search *s, hl_cut planes[HL_HOLDER_PLANES]) {
  for (size_t p = 0; p < s->plane_count; p++) {
    const uint32_t d = s->plane[p];
    const vec3 normal = s->direction[d], at = vec3_scale(normal, s->hull[d] + RIM * s->cell_width[d]);
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
    for (size_t n = 0; n < sizeof levels / sizeof *levels && s->plane_count == 0 && status == HL_OK; n++) {
      status = find_planes(s, levels[n], error);
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
