/* surface/primitive_bins.c - see primitive_bins.h. */
#include "surface/primitive_bins.h"

#include "core/memory.h"

enum { LEAST_A_TASK = 1 << 14, MOST_TASKS = 32 };

/* The tiles that a primitive touches, the last ones included; none where x0 is greater than x1. */
typedef struct tile_span {
  uint16_t x0, y0, x1, y1;
} tile_span;

typedef struct bin_work {
  const seen_vertices *seen;
  const binned *wanted;
  primitive_bins *bins;
  tile_span *spans; /* [primitives] */
  uint32_t *places; /* [tasks][tiles]; first how many entries a task has for a tile, then where they go */
  size_t tiles;
  uint32_t a_task; /* primitives of a task */
  int tiles_x, tiles_y;
} bin_work;

static uint16_t clamp_tile(int32_t tile, int tiles) {
  return (uint16_t)(tile < 0 ? 0 : tile >= tiles ? tiles - 1 : tile);
}

/* Twice a triangle's area: below 0 where it faces the view. */
static int64_t area_of(const int32_t x[3], const int32_t y[3]) {
  return (int64_t)(x[1] - x[0]) * (y[2] - y[0]) - (int64_t)(x[2] - x[0]) * (y[1] - y[0]);
}

static void set_triangle_span(const bin_work *work, const int32_t *x, const int32_t *y, int corners,
                              tile_span *span) {
  const view *view = work->seen->view;
  int32_t x0 = x[0], y0 = y[0], x1 = x[0], y1 = y[0];
  for (int i = 1; i < corners; i++) {
    x0 = x[i] < x0 ? x[i] : x0;
    x1 = x[i] > x1 ? x[i] : x1;
    y0 = y[i] < y0 ? y[i] : y0;
    y1 = y[i] > y1 ? y[i] : y1;
  }
  if (x1 < 0 || y1 < 0 || x0 >= view->width * SUBPIXELS || y0 >= view->height * SUBPIXELS) return;
  enum { TILE_SHIFT = 12 };
  _Static_assert(1 << TILE_SHIFT == TILE * SUBPIXELS, "a shift divides by the size of a tile");
  *span = (tile_span){
      clamp_tile(x0 >> TILE_SHIFT, work->tiles_x), clamp_tile(y0 >> TILE_SHIFT, work->tiles_y),
      clamp_tile(x1 >> TILE_SHIFT, work->tiles_x), clamp_tile(y1 >> TILE_SHIFT, work->tiles_y)};
}

static void find_triangle_span(const bin_work *work, uint32_t triangle, binned wanted, tile_span *span) {
  const uint32_t *vertex = work->seen->all->triangles[triangle];
  int32_t x[3], y[3];
  seen_polygon polygon;
  bool cut = false;
  for (int i = 0; i < 3; i++) {
    x[i] = work->seen->at[vertex[i]][0], y[i] = work->seen->at[vertex[i]][1];
    cut = cut || x[i] == VERTEX_IS_CUT;
  }
  if (cut) {
    hl_see_triangle(work->seen, triangle, &polygon);
    if (polygon.count > 0 && (wanted != BINNED_FRONTS || area_of(polygon.x, polygon.y) <= 0))
      set_triangle_span(work, polygon.x, polygon.y, polygon.count, span);
  } else if (wanted != BINNED_FRONTS || area_of(x, y) <= 0) {
    set_triangle_span(work, x, y, 3, span);
  }
}

static void set_sphere_span(const bin_work *work, const seen_bounds *bounds, tile_span *span) {
  const double limit = 1 << 20; /* tiles: whole numbers hold them */
  int32_t at[4];
  const double ends[4] = {bounds->u0, bounds->v0, bounds->u1, bounds->v1};
  for (int i = 0; i < 4; i++) at[i] = (int32_t)floor(fmin(fmax(ends[i] / TILE, -limit), limit));
  *span = (tile_span){clamp_tile(at[0], work->tiles_x), clamp_tile(at[1], work->tiles_y),
                      clamp_tile(at[2], work->tiles_x), clamp_tile(at[3], work->tiles_y)};
}

static void find_span(const bin_work *work, uint32_t primitive, binned wanted, tile_span *span) {
  const surfaces *all = work->seen->all;
  seen_bounds bounds;
  *span = (tile_span){1, 1, 0, 0};
  if (wanted == BINNED_NOTHING) return;
  if (primitive < all->triangle_count) find_triangle_span(work, primitive, wanted, span);
  else if (hl_see_sphere(work->seen->view, all->spheres[primitive - all->triangle_count], &bounds))
    set_sphere_span(work, &bounds, span);
}

static void task_range(const bin_work *work, size_t index, uint32_t *first, uint32_t *end) {
  *first = (uint32_t)index * work->a_task;
  *end = hl_surfaces_count(work->seen->all);
  if (*end - *first > work->a_task) *end = *first + work->a_task;
}

/* Finds the spans of a task's primitives, and how many of them touch each tile. */
static void count_task(void *data, size_t index, int worker) {
  (void)worker;
  const bin_work *work = data;
  const surfaces *all = work->seen->all;
  uint32_t *places = work->places + index * work->tiles, first, end, next;
  task_range(work, index, &first, &end);
  for (uint32_t from = first; from < end; from = next) {
    size_t mesh = hl_surface_mesh_of(all, from);
    next = hl_surface_mesh_end(all, mesh, from);
    for (uint32_t t = from; t < next && t < end; t++) {
      tile_span span;
      find_span(work, t, work->wanted[mesh], &span);
      work->spans[t] = span;
      for (int y = span.y0; y <= span.y1; y++)
        for (int x = span.x0; x <= span.x1; x++) places[(size_t)y * (size_t)work->tiles_x + (size_t)x]++;
    }
  }
}

static void place_task(void *data, size_t index, int worker) {
  (void)worker;
  const bin_work *work = data;
  uint32_t *places = work->places + index * work->tiles, first, end;
  task_range(work, index, &first, &end);
  for (uint32_t t = first; t < end; t++) {
    tile_span span = work->spans[t];
    for (int y = span.y0; y <= span.y1; y++)
      for (int x = span.x0; x <= span.x1; x++)
        work->bins->primitives[places[(size_t)y * (size_t)work->tiles_x + (size_t)x]++] = t;
  }
}

/* Turns the numbers of entries into the index of each bin's first entry. False where there are more than 2^32
 * entries. */
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

uint64_t hl_primitive_bins_bytes(const surfaces *all, const view *view) {
  uint64_t count = hl_surfaces_count(all), tiles = hl_view_tiles(view);
  uint64_t tasks = count / LEAST_A_TASK + 1 < MOST_TASKS ? count / LEAST_A_TASK + 1 : MOST_TASKS;
  return count * (sizeof(tile_span) + sizeof(uint32_t)) + (tasks + 1) * tiles * sizeof(uint32_t);
}

hl_status hl_primitive_bins_create(hl_context *context, hl_pool *pool, const seen_vertices *seen,
                                   const binned *wanted, primitive_bins *bins, hl_error *error) {
  bin_work work = {.seen = seen, .wanted = wanted, .bins = bins};
  uint32_t count = hl_surfaces_count(seen->all);
  work.tiles_x = hl_tiles(seen->view->width);
  work.tiles_y = hl_tiles(seen->view->height);
  work.tiles = (size_t)work.tiles_x * (size_t)work.tiles_y;
  work.a_task = count / MOST_TASKS + 1;
  if (work.a_task < LEAST_A_TASK) work.a_task = LEAST_A_TASK;
  size_t tasks = ((size_t)count + work.a_task - 1) / work.a_task;
  *bins = (primitive_bins){.first = hl_allocate(context, work.tiles + 1, sizeof *bins->first)};
  work.places = hl_allocate_zeroed(context, tasks * work.tiles, sizeof *work.places);
  work.spans = hl_allocate(context, count, sizeof *work.spans);
  bool room = bins->first != NULL && work.places != NULL && work.spans != NULL;
  if (room) {
    hl_pool_run(pool, tasks, count_task, &work);
    room = find_places(&work, tasks);
    if (room) bins->primitives = hl_allocate(context, bins->first[work.tiles], sizeof *bins->primitives);
    room = bins->primitives != NULL;
    if (room) hl_pool_run(pool, tasks, place_task, &work);
  }
  hl_release(context, work.places);
  hl_release(context, work.spans);
  if (room) return HL_OK;
  hl_primitive_bins_release(context, bins);
  return hl_fail_memory(error, (tasks + 1) * work.tiles * sizeof *work.places, "surfaces sorted by tiles");
}

void hl_primitive_bins_release(hl_context *context, primitive_bins *bins) {
  hl_release(context, bins->first);
  hl_release(context, bins->primitives);
  *bins = (primitive_bins){0};
}
