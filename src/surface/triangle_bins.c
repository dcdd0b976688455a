/* surface/triangle_bins.c - see triangle_bins.h. */
#include "surface/triangle_bins.h"

#include <string.h>

#include "core/memory.h"

/* ---- one triangle in a view ---- */

/* Pixels around the view within which triangles are kept whole. */
static const double FRAME_AROUND = 4096;
/* The least distance in front of a perspective view's eye, as a fraction of the distance of the plane at
 * which rays are one long. */
static const double NEAREST = 1e-4;

/* (w, w u, w v) of a corner. */
typedef struct corner {
  double w, u, v;
} corner;

static corner corner_in_view(const view *view, vec3 point) {
  vec3 p = mat3_apply(view->inverse, vec3_subtract(point, view->perspective ? view->origin : view->corner));
  return (corner){view->perspective ? p.x : 1, p.y, p.z};
}

/* How far a corner lies inside the frame's side: 0 the eye, 1 and 2 left and right, 3 and 4 above and below.
 */
static double inside(const view *view, int side, corner c) {
  switch (side) {
    case 0: return c.w - NEAREST;
    case 1: return c.u + FRAME_AROUND * c.w;
    case 2: return (view->width + FRAME_AROUND) * c.w - c.u;
    case 3: return c.v + FRAME_AROUND * c.w;
    default: return (view->height + FRAME_AROUND) * c.w - c.v;
  }
}

/* Cuts a polygon by one side; returns how many corners are left. */
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

void hl_see_triangle(const view *view, const surfaces *all, uint32_t triangle, seen_polygon *polygon) {
  corner corners[2][CLIPPED_CORNERS + 1];
  int count = 3, at = 0;
  for (int i = 0; i < 3; i++)
    corners[0][i] = corner_in_view(view, hl_surface_vector(all->positions[all->triangles[triangle][i]]));
  for (int side = 0; side < 5 && count > 0; side++) {
    bool whole = true;
    for (int i = 0; i < count; i++) whole = whole && inside(view, side, corners[at][i]) >= 0;
    if (whole) continue;
    count = clip(view, side, corners[at], count, corners[!at]);
    at = !at;
  }
  polygon->count = count < 3 ? 0 : count;
  for (int i = 0; i < polygon->count; i++) {
    polygon->x[i] = (int32_t)floor(corners[at][i].u / corners[at][i].w * SUBPIXELS + 0.5);
    polygon->y[i] = (int32_t)floor(corners[at][i].v / corners[at][i].w * SUBPIXELS + 0.5);
  }
}

/* ---- sorting by tiles ---- */

enum { LEAST_A_TASK = 1 << 14, MOST_TASKS = 32 };

typedef struct bin_work {
  const surfaces *all;
  const view *view;
  const bool *wanted;
  triangle_bins *bins;
  uint32_t *places; /* [tasks][tiles]; first how many entries a task has for a tile, then where they go */
  size_t tiles;
  uint32_t a_task; /* triangles of a task */
  int tiles_x, tiles_y;
  bool counting;
} bin_work;

typedef struct tile_span {
  int x0, y0, x1, y1; /* the last ones included */
} tile_span;

static int clamp_tile(int32_t subpixels, int tiles) {
  int tile = subpixels < 0 ? -1 : subpixels / (SUBPIXELS * TILE);
  return tile < 0 ? 0 : tile >= tiles ? tiles - 1 : tile;
}

/* The tiles of a polygon's bounds. False where they lie outside the view. */
static bool tiles_of(const bin_work *work, const seen_polygon *polygon, tile_span *span) {
  int32_t x0 = INT32_MAX, y0 = INT32_MAX, x1 = INT32_MIN, y1 = INT32_MIN;
  for (int i = 0; i < polygon->count; i++) {
    x0 = polygon->x[i] < x0 ? polygon->x[i] : x0;
    x1 = polygon->x[i] > x1 ? polygon->x[i] : x1;
    y0 = polygon->y[i] < y0 ? polygon->y[i] : y0;
    y1 = polygon->y[i] > y1 ? polygon->y[i] : y1;
  }
  if (polygon->count == 0 || x1 < 0 || y1 < 0 || x0 >= work->view->width * SUBPIXELS ||
      y0 >= work->view->height * SUBPIXELS)
    return false;
  *span = (tile_span){clamp_tile(x0, work->tiles_x), clamp_tile(y0, work->tiles_y),
                      clamp_tile(x1, work->tiles_x), clamp_tile(y1, work->tiles_y)};
  return true;
}

static void bin_task(void *data, size_t index, int worker) {
  (void)worker;
  const bin_work *work = data;
  uint32_t *places = work->places + index * work->tiles;
  uint32_t end = work->all->triangle_count, first = (uint32_t)index * work->a_task;
  if (end - first > work->a_task) end = first + work->a_task;
  for (uint32_t t = first; t < end; t++) {
    seen_polygon polygon;
    tile_span span;
    if (!work->wanted[hl_surface_of(work->all, t) - work->all->meshes]) continue;
    hl_see_triangle(work->view, work->all, t, &polygon);
    if (!tiles_of(work, &polygon, &span)) continue;
    for (int y = span.y0; y <= span.y1; y++)
      for (int x = span.x0; x <= span.x1; x++) {
        uint32_t *place = &places[(size_t)y * (size_t)work->tiles_x + (size_t)x];
        if (!work->counting) work->bins->triangles[*place] = t;
        (*place)++;
      }
  }
}

/* Turns counts into places. False where there are more than 2^32 entries. */
static bool find_places(bin_work *work, size_t tasks) {
  uint64_t sum = 0;
  for (size_t tile = 0; tile < work->tiles; tile++) {
    work->bins->first[tile] = (uint32_t)sum;
    for (size_t task = 0; task < tasks; task++) {
      uint32_t count = work->places[task * work->tiles + tile];
      work->places[task * work->tiles + tile] = (uint32_t)sum;
      sum += count;
    }
  }
  work->bins->first[work->tiles] = (uint32_t)sum;
  return sum <= UINT32_MAX;
}

hl_status hl_triangle_bins_create(hl_context *context, hl_pool *pool, const surfaces *all, const view *view,
                                  const bool *wanted, triangle_bins *bins, hl_error *error) {
  bin_work work = {.all = all, .view = view, .wanted = wanted, .bins = bins, .counting = true};
  work.tiles_x = hl_tiles(view->width);
  work.tiles_y = hl_tiles(view->height);
  work.tiles = (size_t)work.tiles_x * (size_t)work.tiles_y;
  work.a_task = all->triangle_count / MOST_TASKS + 1;
  if (work.a_task < LEAST_A_TASK) work.a_task = LEAST_A_TASK;
  size_t tasks = ((size_t)all->triangle_count + work.a_task - 1) / work.a_task;
  *bins = (triangle_bins){.first = hl_allocate(context, work.tiles + 1, sizeof *bins->first)};
  work.places = hl_allocate_zeroed(context, tasks * work.tiles, sizeof *work.places);
  bool room = bins->first != NULL && work.places != NULL;
  if (room) {
    hl_pool_run(pool, tasks, bin_task, &work);
    room = find_places(&work, tasks);
    if (room) bins->triangles = hl_allocate(context, bins->first[work.tiles], sizeof *bins->triangles);
    room = bins->triangles != NULL;
    work.counting = false;
    if (room) hl_pool_run(pool, tasks, bin_task, &work);
  }
  hl_release(context, work.places);
  if (room) return HL_OK;
  hl_triangle_bins_release(context, bins);
  return hl_fail_memory(error, (tasks + 1) * work.tiles * sizeof *work.places, "triangles sorted by tiles");
}

void hl_triangle_bins_release(hl_context *context, triangle_bins *bins) {
  hl_release(context, bins->first);
  hl_release(context, bins->triangles);
  *bins = (triangle_bins){0};
}
