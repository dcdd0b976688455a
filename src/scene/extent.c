/* scene/extent.c - finds the visible voxels that reach farthest, without looking at most of the others.
 *
 * Along a row of voxels every bound is linear, so those that raise none of them are neighbours: only what lies before
 * and after them is looked at. Rows far apart come first, which leaves little to the others. */
#include "scene/extent.h"

#include <string.h>

#define FAINT 0.02           /* of the greatest opacity: fainter voxels need not be in the picture */
#define TABLE 4096           /* equal steps over the volume's range */
#define VOXELS_EXAMINED 40e6 /* of one volume: larger ones are sampled by rows */
#define ROUNDING 1e-9        /* of a voxel's coordinates: far more than what rounding does to them */

enum { FARTHEST_ROWS = 16, NEARER_ROWS = 4, VOXELS_AT_ONCE = 64 };

/* What a ball reaches along each bound. */
static void reach_of_ball(const extent *e, vec3 p, double radius, double reach[EXTENT_BOUNDS]) {
  double x = vec3_dot(p, e->right), y = vec3_dot(p, e->up), z = vec3_dot(p, e->forward);
  double reach_x = radius * sqrt(1 + e->tangent_x * e->tangent_x);
  double reach_y = radius * sqrt(1 + e->tangent_y * e->tangent_y);
  reach[EXTENT_LEFT] = x - z * e->tangent_x + reach_x;
  reach[EXTENT_RIGHT] = -x - z * e->tangent_x + reach_x;
  reach[EXTENT_BOTTOM] = y - z * e->tangent_y + reach_y;
  reach[EXTENT_TOP] = -y - z * e->tangent_y + reach_y;
  reach[EXTENT_FAR] = z + radius;
  reach[EXTENT_NEAR] = -z + radius;
}

static void extent_add(extent *e, vec3 p, double radius) {
  double reach[EXTENT_BOUNDS];
  reach_of_ball(e, p, radius, reach);
  for (int b = 0; b < EXTENT_BOUNDS; b++) e->bound[b] = fmax(e->bound[b], reach[b]);
}

/* ---- which values count as visible ---- */

typedef struct visibility {
  const hl_transfer_function *function;
  double low, scale, threshold;
  unsigned char kind[TABLE]; /* over the volume's range; 0: none, 1: all, 2: ask the function */
  double least, greatest;    /* stored values beyond these are invisible */
} visibility;

static double greatest_opacity(const hl_transfer_function *function, double low, double high) {
  double greatest =
      fmax(hl_transfer_function_opacity(function, low), hl_transfer_function_opacity(function, high));
  for (size_t p = 0; p < function->opacity_count; p++)
    if (function->opacity[p].value >= low && function->opacity[p].value <= high)
      greatest = fmax(greatest, function->opacity[p].opacity);
  return greatest;
}

/* Where the function reaches the threshold between two of its points. */
static double crossing(const hl_opacity_point *below, const hl_opacity_point *above, double threshold) {
  return below->value + (above->value - below->value) * (threshold - below->opacity) / (above->opacity - below->opacity);
}

static void bound_stored_values(const hl_volume *volume, visibility *visible) {
  const hl_opacity_point *points = visible->function->opacity;
  size_t first = 0, last = visible->function->opacity_count - 1;
  double threshold = visible->threshold * (1 - ROUNDING), low = -INFINITY, high = INFINITY;
  while (first < last && points[first].opacity < threshold) first++;
  while (last > first && points[last].opacity < threshold) last--;
  double largest = fmax(fabs(volume->value_offset), fmax(fabs(volume->minimum), fabs(volume->maximum)));
  if (first > 0)
    low = crossing(&points[first - 1], &points[first], threshold) - ROUNDING * fmax(largest, fabs(points[first - 1].value));
  if (last + 1 < visible->function->opacity_count)
    high = crossing(&points[last + 1], &points[last], threshold) + ROUNDING * fmax(largest, fabs(points[last + 1].value));
  double a = (low - volume->value_offset) / volume->value_scale, b = (high - volume->value_offset) / volume->value_scale;
  visible->least = fmin(a, b);
  visible->greatest = fmax(a, b);
}

/* False if nothing of the volume can be seen. */
static bool visibility_make(const hl_scene_volume *volume, visibility *visible) {
  const hl_volume *v = volume->volume;
  const hl_transfer_function *function = &volume->transfer_function;
  double greatest = greatest_opacity(function, v->minimum, v->maximum), range = v->maximum - v->minimum;
  if (!(greatest > 0)) return false;
  visible->function = function;
  visible->low = v->minimum;
  visible->scale = range > 0 ? TABLE / range : 0;
  visible->threshold = FAINT * greatest;
  memset(visible->kind, 2, sizeof visible->kind);
  size_t point = 0;
  for (int t = 0; t < TABLE; t++) { /* steps without a point inside are linear: their ends decide */
    double a = v->minimum + range * t / TABLE, b = v->minimum + range * (t + 1) / TABLE;
    while (point < function->opacity_count && function->opacity[point].value < a) point++;
    if (point < function->opacity_count && function->opacity[point].value <= b) continue;
    bool at_a = hl_transfer_function_opacity(function, a) >= visible->threshold;
    if (at_a == (hl_transfer_function_opacity(function, b) >= visible->threshold)) visible->kind[t] = at_a;
  }
  bound_stored_values(v, visible);
  return true;
}

static bool is_visible(const visibility *visible, double value) {
  if (!isfinite(value)) return false;
  double t = (value - visible->low) * visible->scale;
  int kind = visible->kind[t < 0 ? 0 : t >= TABLE ? TABLE - 1 : (int)t];
  return kind == 2 ? hl_transfer_function_opacity(visible->function, value) >= visible->threshold : kind;
}

/* ---- a row of voxels ---- */

typedef struct voxel_row {
  const hl_volume *volume;
  const visibility *visible;
  ptrdiff_t j, k; /* its indices along y and z */
} voxel_row;

static bool shows(const voxel_row *row, ptrdiff_t i) {
  return is_visible(row->visible, hl_volume_value(row->volume, (size_t)i, (size_t)row->j, (size_t)row->k));
}

static bool any_u8(const uint8_t *values, size_t count, uint8_t least, uint8_t greatest) {
  int any = 0;
  for (size_t i = 0; i < count; i++) any |= (values[i] >= least) & (values[i] <= greatest);
  return any;
}
static bool any_u16(const uint16_t *values, size_t count, uint16_t least, uint16_t greatest) {
  int any = 0;
  for (size_t i = 0; i < count; i++) any |= (values[i] >= least) & (values[i] <= greatest);
  return any;
}
static bool any_f32(const float *values, size_t count, float least, float greatest) {
  int any = 0;
  for (size_t i = 0; i < count; i++) any |= (values[i] >= least) & (values[i] <= greatest);
  return any;
}

/* Whether any of the voxels from i on may be visible: a quick look at their bounds. */
static bool any_may_show(const voxel_row *row, ptrdiff_t i, size_t count) {
  const hl_volume *volume = row->volume;
  size_t index = ((size_t)row->k * volume->dimension[1] + (size_t)row->j) * volume->dimension[0] + (size_t)i;
  double least = row->visible->least, greatest = row->visible->greatest;
  if (volume->storage == HL_STORAGE_F32)
    return any_f32((const float *)volume->voxels + index, count, nextafterf((float)least, -INFINITY),
                   nextafterf((float)greatest, INFINITY));
  double most = volume->storage == HL_STORAGE_U8 ? UINT8_MAX : UINT16_MAX;
  uint16_t low = (uint16_t)fmin(fmax(floor(least), 0), most), high = (uint16_t)fmin(fmax(ceil(greatest), 0), most);
  return volume->storage == HL_STORAGE_U8
             ? any_u8((const uint8_t *)volume->voxels + index, count, (uint8_t)low, (uint8_t)high)
             : any_u16((const uint16_t *)volume->voxels + index, count, low, high);
}

/* The first visible voxel from `from` on and before end; end: none. */
static ptrdiff_t first_visible(const voxel_row *row, ptrdiff_t from, ptrdiff_t end) {
  while (from < end) {
    ptrdiff_t next = end - from < VOXELS_AT_ONCE ? end : from + VOXELS_AT_ONCE;
    if (!any_may_show(row, from, (size_t)(next - from))) from = next;
    for (; from < next; from++)
      if (shows(row, from)) return from;
  }
  return end;
}

/* The last one; from - 1: none. */
static ptrdiff_t last_visible(const voxel_row *row, ptrdiff_t from, ptrdiff_t end) {
  while (from < end) {
    ptrdiff_t next = end - from < VOXELS_AT_ONCE ? from : end - VOXELS_AT_ONCE;
    if (!any_may_show(row, next, (size_t)(end - next))) end = next;
    for (; end > next; end--)
      if (shows(row, end - 1)) return end - 1;
  }
  return from - 1;
}

/* ---- a volume ---- */

/* Voxels as balls. What each reaches is linear in its indices. */
typedef struct voxel_reach {
  affine3 placement;
  double radius;
  double at_zero[EXTENT_BOUNDS], step[3][EXTENT_BOUNDS]; /* of the first voxel, and along each axis */
  double rounding;
} voxel_reach;

static voxel_reach reach_of_voxels(const extent *e, const hl_scene_volume *volume) {
  affine3 placement = hl_scene_volume_index_to_world(volume);
  voxel_reach reach = {.placement = placement};
  vec3 edges = {vec3_length(mat3_column(placement.linear, 0)), vec3_length(mat3_column(placement.linear, 1)),
                vec3_length(mat3_column(placement.linear, 2))};
  reach.radius = 0.5 * vec3_length(edges);
  reach_of_ball(e, placement.offset, reach.radius, reach.at_zero);
  double farthest = vec3_length(placement.offset) + reach.radius;
  for (int a = 0; a < 3; a++) {
    vec3 edge = mat3_column(placement.linear, a);
    reach_of_ball(e, edge, 0, reach.step[a]);
    farthest += vec3_length(edge) * (double)volume->volume->dimension[a];
  }
  reach.rounding = ROUNDING * farthest * (1 + e->tangent_x + e->tangent_y);
  return reach;
}

/* The voxels first .. end - 1 of a row raise no bound. */
typedef struct quiet_span { ptrdiff_t first, end; } quiet_span;

static quiet_span span_without_effect(const extent *e, const voxel_reach *reach, ptrdiff_t j, ptrdiff_t k, ptrdiff_t first,
                                      ptrdiff_t end) {
  double low = (double)first, high = (double)end - 1;
  for (int b = 0; b < EXTENT_BOUNDS; b++) {
    double room = e->bound[b] - reach->rounding - reach->at_zero[b] - (double)j * reach->step[1][b] - (double)k * reach->step[2][b];
    double step = reach->step[0][b];
    if (step > 0) high = fmin(high, floor(room / step));
    else if (step < 0) low = fmax(low, ceil(room / step));
    else if (room < 0) return (quiet_span){end, end};
  }
  return low <= high ? (quiet_span){(ptrdiff_t)low, (ptrdiff_t)high + 1} : (quiet_span){end, end};
}

/* Adds the first and the last visible voxel of a row, unless neither raises a bound. */
static void extent_add_row(extent *e, const voxel_reach *reach, const voxel_row *row, ptrdiff_t first, ptrdiff_t end) {
  quiet_span quiet = span_without_effect(e, reach, row->j, row->k, first, end);
  ptrdiff_t left = first_visible(row, first, quiet.first), right = last_visible(row, quiet.end, end);
  bool none_left = left == quiet.first, none_right = right < quiet.end;
  if (none_left && none_right) return;
  if (none_left) left = first_visible(row, quiet.first, end);
  if (none_right) right = last_visible(row, left, quiet.end);
  extent_add(e, affine3_apply(reach->placement, (vec3){(double)left, (double)row->j, (double)row->k}), reach->radius);
  extent_add(e, affine3_apply(reach->placement, (vec3){(double)right, (double)row->j, (double)row->k}), reach->radius);
}

/* Index range along axis a of the voxels whose centres are inside the volume's box; empty: *first >= *end. */
static void box_range(const hl_scene_volume *volume, int a, ptrdiff_t *first, ptrdiff_t *end) {
  double low[3], high[3];
  hl_scene_volume_box(volume, low, high);
  *first = (ptrdiff_t)ceil(fmax(low[a], 0));
  *end = (ptrdiff_t)floor(fmin(high[a], (double)volume->volume->dimension[a] - 1)) + 1;
}

static void extent_add_voxels(extent *e, const hl_scene_volume *volume, const visibility *visible) {
  const hl_volume *v = volume->volume;
  const ptrdiff_t rows_apart[] = {FARTHEST_ROWS, NEARER_ROWS, 1};
  voxel_reach reach = reach_of_voxels(e, volume);
  ptrdiff_t first[3], end[3], stride = (ptrdiff_t)ceil(sqrt((double)hl_volume_voxel_count(v) / VOXELS_EXAMINED));
  for (int a = 0; a < 3; a++) box_range(volume, a, &first[a], &end[a]);
  if (first[0] >= end[0]) return;
  for (int pass = 0; pass < 3; pass++) {
    ptrdiff_t step = stride * rows_apart[pass];
    for (ptrdiff_t k = first[2]; k < end[2]; k += step)
      for (ptrdiff_t j = first[1]; j < end[1]; j += step) {
        voxel_row row = {v, visible, j, k};
        extent_add_row(e, &reach, &row, first[0], end[0]);
      }
  }
}

static void extent_add_box(extent *e, const hl_scene_volume *volume) {
  affine3 placement = hl_scene_volume_index_to_world(volume);
  double low[3], high[3];
  hl_scene_volume_box(volume, low, high);
  for (int corner = 0; corner < 8; corner++) {
    vec3 index = {corner & 1 ? high[0] : low[0], corner & 2 ? high[1] : low[1],
                  corner & 4 ? high[2] : low[2]};
    extent_add(e, affine3_apply(placement, index), 0);
  }
}

void hl_extent_add_scene(extent *e, const hl_scene_description *description) {
  for (size_t n = 0; n < description->volume_count; n++) {
    const hl_scene_volume *volume = &description->volumes[n];
    visibility visible;
    if (volume->visible && visibility_make(volume, &visible)) extent_add_voxels(e, volume, &visible);
  }
  bool nothing = e->bound[EXTENT_FAR] == -INFINITY;
  for (size_t n = 0; nothing && n < description->volume_count; n++)
    extent_add_box(e, &description->volumes[n]);
}
