/* splat/occupancy.c - projects relevant bricks into tiles and sheets. */
#include "splat/occupancy.h"

#include <string.h>

#include "core/memory.h"

void hl_footprint_map(const view *view, vec3 normal, affine3 index_to_frame, footprint_map *map) {
  hl_view_homogeneous(view, index_to_frame, map->view);
  const mat3 *m = &index_to_frame.linear;
  map->height[0] = vec3_dot(normal, mat3_column(*m, 0));
  map->height[1] = vec3_dot(normal, mat3_column(*m, 1));
  map->height[2] = vec3_dot(normal, mat3_column(*m, 2));
  map->height[3] = vec3_dot(normal, index_to_frame.offset);
}

static double at(const double row[4], const double p[3]) {
  return row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3];
}
static double spread(const double row[4], const double half[3]) {
  return fabs(row[0]) * half[0] + fabs(row[1]) * half[1] + fabs(row[2]) * half[2];
}

bool hl_footprint_bounds(const footprint_map *map, const double centre[3], const double half[3],
                         footprint_bounds *bounds) {
  double height = at(map->height, centre), reach = spread(map->height, half);
  bounds->low_height = height - reach;
  bounds->high_height = height + reach;
  double w = at(map->view[0], centre), w_reach = spread(map->view[0], half);
  if (w + w_reach <= 0) return false;
  double nearest = w - w_reach, farthest = w + w_reach;
  for (int axis = 0; axis < 2; axis++) {
    double middle = at(map->view[1 + axis], centre), extent = spread(map->view[1 + axis], half);
    double low = middle - extent, high = middle + extent;
    if (nearest <= 1e-9 * farthest) { /* the box reaches behind the eye: it may be anywhere */
      bounds->low[axis] = -INFINITY;
      bounds->high[axis] = INFINITY;
    } else {
      bounds->low[axis] = low / (low < 0 ? nearest : farthest);
      bounds->high[axis] = high / (high < 0 ? farthest : nearest);
    }
  }
  return true;
}

void hl_brick_bounds(const grid *grid, const int32_t b[3], double margin, double centre[3], double half[3]) {
  for (int axis = 0; axis < 3; axis++) {
    double low = (double)b[axis] * HL_BRICK_CELLS - 1, high = low + HL_BRICK_CELLS;
    if (b[axis] == 0) low -= margin;
    if (high >= grid->dimension[axis] - 1) high = grid->dimension[axis] - 0.5 + margin;
    centre[axis] = (low + high) / 2;
    half[axis] = (high - low) / 2;
  }
}

typedef struct occupancy_job {
  occupancy *occupancy;
  const grid *grid;
  int grid_index;
  footprint_map map;
  const sheet_stack *sheets;
} occupancy_job;

enum { BRICKS_A_TASK = 1024 };

static int first_tile(double low) { return low <= 0 ? 0 : low >= 1e9 ? INT32_MAX : (int)(low / TILE); }
static int last_tile(double high, int tiles) {
  return high < 0 ? -1 : high >= (double)tiles * TILE ? tiles - 1 : (int)(high / TILE);
}

static void mark_bits(uint64_t *words, int first, int last) {
  for (int word = first / 64; word <= last / 64; word++) {
    int low = word == first / 64 ? first % 64 : 0, high = word == last / 64 ? last % 64 : 63;
    uint64_t mask = (high == 63 ? ~(uint64_t)0 : ((uint64_t)1 << (high + 1)) - 1) & (~(uint64_t)0 << low);
    __atomic_fetch_or(&words[word], mask, __ATOMIC_RELAXED);
  }
}

static void mark_brick(const occupancy_job *job, uint32_t brick) {
  occupancy *o = job->occupancy;
  int32_t b[3];
  double centre[3], half[3];
  footprint_bounds bounds;
  hl_grid_brick_place(job->grid, brick, b);
  hl_brick_bounds(job->grid, b, GRID_MARGIN, centre, half);
  if (!hl_footprint_bounds(&job->map, centre, half, &bounds)) return;
  double low = ceil((bounds.low_height - job->sheets->first) / job->sheets->spacing - 1e-6);
  double high = floor((bounds.high_height - job->sheets->first) / job->sheets->spacing + 1e-6);
  int first = low < 0 ? 0 : low >= o->sheets ? o->sheets : (int)low;
  int last = high < 0 ? -1 : high >= o->sheets ? o->sheets - 1 : (int)high;
  if (first > last) return;
  int x1 = last_tile(bounds.high[0] + 1, o->tiles_x), y1 = last_tile(bounds.high[1] + 1, o->tiles_y);
  for (int y = first_tile(bounds.low[1] - 1); y <= y1; y++)
    for (int x = first_tile(bounds.low[0] - 1); x <= x1; x++) {
      size_t tile = ((size_t)job->grid_index * (size_t)o->tiles_y + (size_t)y) * (size_t)o->tiles_x + (size_t)x;
      mark_bits(o->by_tile + tile * (size_t)o->words, first, last);
    }
}

static void mark_bricks(void *data, size_t index, int worker) {
  (void)worker;
  const occupancy_job *job = data;
  size_t end = (index + 1) * BRICKS_A_TASK;
  if (end > job->grid->relevant_count) end = job->grid->relevant_count;
  for (size_t i = index * BRICKS_A_TASK; i < end; i++) mark_brick(job, job->grid->relevant_list[i]);
}

/* Transposes 64 tiles x 64 sheets at a time; index: a word column of by_sheet. */
static void transpose_tiles(void *data, size_t index, int worker) {
  (void)worker;
  occupancy *o = data;
  size_t tiles = (size_t)o->tiles_x * (size_t)o->tiles_y;
  for (int word = 0; word < o->words; word++)
    for (size_t t = 0; t < 64 && index * 64 + t < tiles; t++) {
      uint64_t bits = 0;
      for (int g = 0; g < o->grid_count; g++)
        bits |= o->by_tile[((size_t)g * tiles + index * 64 + t) * (size_t)o->words + (size_t)word];
      for (; bits != 0; bits &= bits - 1) {
        size_t sheet = (size_t)word * 64 + (size_t)__builtin_ctzll(bits);
        o->by_sheet[sheet * (size_t)o->tile_words + index] |= (uint64_t)1 << t;
      }
    }
}

static hl_status reserve(hl_context *context, uint64_t **words, size_t *capacity, size_t needed, hl_error *error) {
  if (*capacity < needed) {
    hl_release(context, *words);
    *words = hl_allocate(context, needed, sizeof(uint64_t));
    *capacity = *words == NULL ? 0 : needed;
    if (*words == NULL) return hl_fail_memory(error, needed * sizeof(uint64_t), "the occupancy of tiles");
  }
  memset(*words, 0, needed * sizeof(uint64_t));
  return HL_OK;
}

hl_status hl_occupancy_build(hl_context *context, hl_pool *pool, const grid *grids, int grid_count, const view *view,
                             const sheet_stack *sheets, occupancy *occupancy, hl_error *error) {
  occupancy->grid_count = grid_count;
  occupancy->tiles_x = hl_tiles(view->width);
  occupancy->tiles_y = hl_tiles(view->height);
  occupancy->sheets = sheets->count;
  occupancy->words = (sheets->count + 63) / 64;
  size_t tiles = (size_t)occupancy->tiles_x * (size_t)occupancy->tiles_y;
  occupancy->tile_words = (int)((tiles + 63) / 64);
  hl_status status = reserve(context, &occupancy->by_tile, &occupancy->by_tile_capacity,
                             (size_t)grid_count * tiles * (size_t)occupancy->words, error);
  if (status == HL_OK)
    status = reserve(context, &occupancy->by_sheet, &occupancy->by_sheet_capacity,
                     (size_t)occupancy->words * 64 * (size_t)occupancy->tile_words, error);
  if (status != HL_OK) return status;
  for (int g = 0; g < grid_count; g++) {
    occupancy_job job = {occupancy, &grids[g], g, {{{0}}, {0}}, sheets};
    hl_footprint_map(view, sheets->normal, grids[g].index_to_frame, &job.map);
    hl_pool_run(pool, (grids[g].relevant_count + BRICKS_A_TASK - 1) / BRICKS_A_TASK, mark_bricks, &job);
  }
  hl_pool_run(pool, (size_t)occupancy->tile_words, transpose_tiles, occupancy);
  return HL_OK;
}

void hl_occupancy_release(hl_context *context, occupancy *occupancy) {
  hl_release(context, occupancy->by_tile);
  hl_release(context, occupancy->by_sheet);
  *occupancy = (struct occupancy){0};
}
