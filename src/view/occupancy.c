/* view/occupancy.c - projects relevant bricks onto tiles and sheets. */
#include "view/occupancy.h"

#include <string.h>

#include "core/memory.h"
#include "core/sheet_constants.h"
#include "grid/relevant.h"

typedef struct occupancy_job {
  occupancy *occupancy;
  const grid *grid;
  const tile_rectangle *rectangle;
  brick_view view;
  brick_ranges_function *ranges;
} occupancy_job;

enum { BRICKS_A_TASK = 1024 };

static int first_tile(double low) { return low <= 0 ? 0 : low >= 1e9 ? INT32_MAX : (int)(low / TILE); }
static int last_tile(double high, int tiles) {
  return high < 0 ? -1 : high >= (double)tiles * TILE ? tiles - 1 : (int)(high / TILE);
}

/* The rectangle of the tiles that are touched by bounds enlarged by a margin. The rectangle is empty if the
 * view does not see the bounds. */
static tile_rectangle tiles_of(const footprint_bounds *bounds, const occupancy *o) {
  tile_rectangle r = {.x = first_tile(bounds->low[0] - o->spare), .y = first_tile(bounds->low[1] - o->spare)};
  int x1 = last_tile(bounds->high[0] + o->spare, o->tiles_x),
      y1 = last_tile(bounds->high[1] + o->spare, o->tiles_y);
  r.width = x1 < r.x ? 0 : x1 - r.x + 1;
  r.height = y1 < r.y ? 0 : y1 - r.y + 1;
  return r;
}

/* The rectangle of tiles that a grid's relevant bricks touch. The rectangle is found from the box around
 * all relevant bricks, whose bounds contain the bounds of each brick. */
static tile_rectangle find_rectangle(const grid *grid, const footprint_map *map, const occupancy *o) {
  double low[3], high[3], centre[3], half[3];
  footprint_bounds bounds;
  if (!hl_relevant_bounds(grid, GRID_MARGIN, low, high)) return (tile_rectangle){0};
  for (int axis = 0; axis < 3; axis++) {
    centre[axis] = (low[axis] + high[axis]) / 2;
    half[axis] = (high[axis] - low[axis]) / 2;
  }
  if (!hl_footprint_bounds(map, centre, half, &bounds)) return (tile_rectangle){0};
  return tiles_of(&bounds, o);
}

static bool in_rectangle(const tile_rectangle *r, int x, int y) {
  return x >= r->x && y >= r->y && x < r->x + r->width && y < r->y + r->height;
}

/* Numbers the patches of an occupancy, tile after tile. */
static void number_patches(occupancy *o, int grid_count) {
  uint32_t patch = 0;
  for (int y = 0; y < o->tiles_y; y++)
    for (int x = 0; x < o->tiles_x; x++) {
      o->first_patch[(size_t)y * (size_t)o->tiles_x + (size_t)x] = patch;
      for (int g = 0; g < grid_count; g++) {
        const tile_rectangle *r = &o->rectangle[g];
        if (!in_rectangle(r, x, y)) continue;
        o->patch_of[r->first + (size_t)(y - r->y) * (size_t)r->width + (size_t)(x - r->x)] = patch;
        o->patch_grid[patch++] = (uint32_t)g;
      }
    }
  o->first_patch[(size_t)o->tiles_x * (size_t)o->tiles_y] = patch;
}

/* Rounds the row of an affine function of points to floats. Returns a bound of the rounding error. The bound
 * is a small multiple of 2^-24, times the greatest value within the grid of the sum of the magnitudes of the
 * function's terms. */
static float set_row(const double row[4], const double middle[3], const double half[3], double scale,
                     float rounded[4]) {
  double offset = row[3], greatest = 0;
  for (int axis = 0; axis < 3; axis++) {
    rounded[axis] = (float)(row[axis] * scale);
    offset += row[axis] * middle[axis];
    greatest += fabs(row[axis]) * half[axis];
  }
  rounded[3] = (float)(offset * scale);
  return (float)((greatest + fabs(offset)) * fabs(scale) * 1e-6);
}

static void set_view(const footprint_map *map, const grid *grid, const sheet_stack *sheets,
                     const occupancy *o, const tile_rectangle *r, brick_view *view) {
  double middle[3], half[3], height[4];
  for (int axis = 0; axis < 3; axis++) {
    middle[axis] = 0.5 * grid->dimension[axis];
    half[axis] = 0.5 * grid->dimension[axis] + GRID_MARGIN + HL_BRICK_CELLS;
    view->middle[axis] = (float)middle[axis];
    height[axis] = map->height[axis];
  }
  height[3] = map->height[3] - sheets->first;
  view->slack[0] = set_row(map->view[0], middle, half, 1, view->view[0]);
  for (int axis = 0; axis < 2; axis++)
    view->slack[1 + axis] = set_row(map->view[1 + axis], middle, half, 1.0 / TILE, view->view[1 + axis]);
  view->slack[3] = set_row(height, middle, half, 1 / sheets->spacing, view->height);
  view->spare = (float)(o->spare / TILE);
  const int32_t first[RANGE_AXES] = {r->x, r->y, 0},
                last[RANGE_AXES] = {r->x + r->width - 1, r->y + r->height - 1, o->sheets - 1};
  memcpy(view->first, first, sizeof first);
  memcpy(view->last, last, sizeof last);
}

/* Sets the bits from `first` to `last` in an array of words. Words whose bits are set already are not
 * written. */
static void mark_bits(uint64_t *words, int first, int last) {
  for (int word = first / 64; word <= last / 64; word++) {
    int low = word == first / 64 ? first % 64 : 0, high = word == last / 64 ? last % 64 : 63;
    uint64_t mask = (high == 63 ? ~(uint64_t)0 : ((uint64_t)1 << (high + 1)) - 1) & (~(uint64_t)0 << low);
    if ((__atomic_load_n(&words[word], __ATOMIC_RELAXED) & mask) != mask)
      __atomic_fetch_or(&words[word], mask, __ATOMIC_RELAXED);
  }
}

static void mark_brick(const occupancy_job *job, const brick_ranges *ranges, int brick) {
  const occupancy *o = job->occupancy;
  const tile_rectangle *r = job->rectangle;
  int first = ranges->first[RANGE_SHEETS][brick], last = ranges->last[RANGE_SHEETS][brick];
  if (first > last) return;
  for (int y = ranges->first[RANGE_Y][brick]; y <= ranges->last[RANGE_Y][brick]; y++) {
    const uint32_t *patch = o->patch_of + r->first + (size_t)(y - r->y) * (size_t)r->width;
    for (int x = ranges->first[RANGE_X][brick]; x <= ranges->last[RANGE_X][brick]; x++)
      mark_bits(o->by_patch + patch[x - r->x] * (size_t)o->words, first, last);
  }
}

/* Finds the coordinates of sixteen bricks. Their indices rise, so the next brick is most often in the same
 * row. */
static void coordinates_of_bricks(const grid *grid, const uint32_t *bricks, int count,
                                  int32_t coordinates[3][BRICKS_AT_ONCE]) {
  uint32_t row_start = 0, row_end = 0;
  int32_t b[3] = {0};
  for (int i = 0; i < BRICKS_AT_ONCE; i++) {
    uint32_t brick = bricks[i < count ? i : count - 1];
    if (brick < row_start || brick >= row_end) {
      hl_brick_coordinates(grid, brick, b);
      row_start = brick - (uint32_t)b[0];
      row_end = row_start + (uint32_t)grid->brick_count[0];
    }
    b[0] = (int32_t)(brick - row_start);
    for (int axis = 0; axis < 3; axis++) coordinates[axis][i] = b[axis];
  }
}

static void mark_bricks(void *data, size_t index, int worker) {
  (void)worker;
  const occupancy_job *job = data;
  size_t end = (index + 1) * BRICKS_A_TASK;
  if (end > job->grid->relevant_count) end = job->grid->relevant_count;
  for (size_t i = index * BRICKS_A_TASK; i < end; i += BRICKS_AT_ONCE) {
    int count = end - i < BRICKS_AT_ONCE ? (int)(end - i) : BRICKS_AT_ONCE;
    int32_t coordinates[3][BRICKS_AT_ONCE];
    brick_ranges ranges;
    coordinates_of_bricks(job->grid, job->grid->relevant_list + i, count, coordinates);
    job->ranges(&job->view, job->grid, (const int32_t(*)[BRICKS_AT_ONCE])coordinates, &ranges);
    for (int brick = 0; brick < count; brick++) mark_brick(job, &ranges, brick);
  }
}

/* Turns the bits of patches, which are ordered by sheets, into bits of sheets, which are ordered by tiles: 64
 * tiles x 64 sheets at a time. index: number of the word in each sheet's row of by_sheet. */
static void transpose_tiles(void *data, size_t index, int worker) {
  (void)worker;
  occupancy *o = data;
  size_t tiles = (size_t)o->tiles_x * (size_t)o->tiles_y;
  for (int word = 0; word < o->words; word++)
    for (size_t t = 0; t < 64 && index * 64 + t < tiles; t++) {
      uint64_t bits = 0;
      for (size_t patch = o->first_patch[index * 64 + t]; patch < o->first_patch[index * 64 + t + 1]; patch++)
        bits |= o->by_patch[patch * (size_t)o->words + (size_t)word];
      for (; bits != 0; bits &= bits - 1) {
        size_t sheet = (size_t)word * 64 + (size_t)__builtin_ctzll(bits);
        o->by_sheet[sheet * (size_t)o->tile_words + index] |= (uint64_t)1 << t;
      }
    }
}

/* Finds the range of the sheets that a grid touches in any tile. */
static void find_range(const occupancy *o, int grid) {
  const tile_rectangle *r = &o->rectangle[grid];
  sheet_range *range = &o->sheets_of[grid];
  *range = (sheet_range){INT32_MAX, -1};
  for (size_t n = 0; n < (size_t)r->width * (size_t)r->height; n++) {
    const uint64_t *bits = o->by_patch + o->patch_of[r->first + n] * (size_t)o->words;
    for (int word = 0; word < o->words; word++) {
      if (bits[word] == 0) continue;
      int first = word * 64 + __builtin_ctzll(bits[word]),
          last = word * 64 + 63 - __builtin_clzll(bits[word]);
      range->first = first < range->first ? first : range->first;
      range->last = last > range->last ? last : range->last;
    }
  }
}

int32_t hl_occupancy_next_slab(const occupancy *o, size_t patch, int slab) {
  const uint64_t *bits = o->by_patch + patch * (size_t)o->words;
  const int before = slab - 1;
  uint64_t left = bits[before / 64] & ~(uint64_t)0 << (before % 64);
  for (int word = before / 64;; left = bits[word]) {
    if (left != 0) {
      int sheet = word * 64 + __builtin_ctzll(left);
      return sheet == before ? slab : sheet;
    }
    if (++word == o->words) return INT32_MAX;
  }
}

static void set_size(const occupancy_source *source, occupancy *o) {
  o->spare = source->spare;
  o->tiles_x = hl_tiles(source->view->width);
  o->tiles_y = hl_tiles(source->view->height);
  o->sheets = source->sheets->count;
  o->words = (source->sheets->count + 63) / 64;
  o->tile_words = (int)(((size_t)o->tiles_x * (size_t)o->tiles_y + 63) / 64);
}

static footprint_map map_of_grid(const occupancy_source *source, int g) {
  footprint_map map;
  hl_footprint_map(source->view, source->sheets->normal, source->grids[g].index_to_frame, &map);
  return map;
}

/* Counts the patches of all grids. If memory for the rectangles has been allocated, also sets the
 * rectangles. */
static void place_rectangles(const occupancy_source *source, occupancy *o) {
  o->patch_count = 0;
  for (int g = 0; g < source->grid_count; g++) {
    footprint_map map = map_of_grid(source, g);
    tile_rectangle r = find_rectangle(&source->grids[g], &map, o);
    r.first = o->patch_count;
    o->patch_count += (size_t)r.width * (size_t)r.height;
    if (o->rectangle != NULL) o->rectangle[g] = r;
  }
}

/* Lays out the arrays of an occupancy whose sizes are set. */
static void lay_out(occupancy *o, int grid_count, hl_layout *layout) {
  size_t tiles = (size_t)o->tiles_x * (size_t)o->tiles_y, words = (size_t)o->words;
  /* the array `rectangle` is the first one in the block of memory, and so owns the block */
  o->rectangle = hl_layout_take(layout, (size_t)grid_count, sizeof *o->rectangle);
  o->patch_of = hl_layout_take(layout, o->patch_count, sizeof *o->patch_of);
  o->patch_grid = hl_layout_take(layout, o->patch_count, sizeof *o->patch_grid);
  o->first_patch = hl_layout_take(layout, tiles + 1, sizeof *o->first_patch);
  o->sheets_of = hl_layout_take(layout, (size_t)grid_count, sizeof *o->sheets_of);
  o->by_patch = hl_layout_take(layout, o->patch_count, words * sizeof *o->by_patch);
  o->by_sheet = hl_layout_take(layout, words * 64, (size_t)o->tile_words * sizeof *o->by_sheet);
}

void hl_occupancy_count(const occupancy_source *source, occupancy *occupancy, hl_layout *layout) {
  set_size(source, occupancy);
  place_rectangles(source, occupancy);
  lay_out(occupancy, source->grid_count, layout);
}

hl_status hl_occupancy_build(hl_context *context, hl_pool *pool, brick_ranges_function *ranges,
                             const occupancy_source *source, occupancy *occupancy, hl_error *error) {
  hl_layout layout = {0};
  set_size(source, occupancy);
  place_rectangles(source, occupancy);
  while (hl_layout_pass(&layout, context)) lay_out(occupancy, source->grid_count, &layout);
  if (layout.base == NULL) return hl_fail_memory(error, layout.bytes, "the occupancy of tiles");
  size_t words = (size_t)occupancy->words;
  memset(occupancy->by_patch, 0, occupancy->patch_count * words * sizeof *occupancy->by_patch);
  memset(occupancy->by_sheet, 0, words * 64 * (size_t)occupancy->tile_words * sizeof *occupancy->by_sheet);
  place_rectangles(source, occupancy);
  number_patches(occupancy, source->grid_count);
  for (int g = 0; g < source->grid_count; g++) {
    const grid *grid = &source->grids[g];
    occupancy_job job = {
        .occupancy = occupancy, .grid = grid, .rectangle = &occupancy->rectangle[g], .ranges = ranges};
    footprint_map map = map_of_grid(source, g);
    set_view(&map, grid, source->sheets, occupancy, job.rectangle, &job.view);
    hl_pool_run(pool, (grid->relevant_count + BRICKS_A_TASK - 1) / BRICKS_A_TASK, mark_bricks, &job);
    find_range(occupancy, g);
  }
  hl_pool_run(pool, (size_t)occupancy->tile_words, transpose_tiles, occupancy);
  return HL_OK;
}

void hl_occupancy_release(hl_context *context, occupancy *occupancy) {
  hl_release(context, occupancy->rectangle);
  *occupancy = (struct occupancy){0};
}
