/* volume/formats/vdb/nanovdb_bricks.c - makes bricks from a NanoVDB grid of floats.
 *
 * In: a grid's tree. Out: bricks of level 0, of 32^3 cells. A brick whose coefficients, margins included, are
 * all equal is stored as a constant, which changes no bit of the field. Each brick is read twice, the first
 * time only to find which bricks are constants. Beyond the box of active voxels, the field has the values at
 * the box's faces, as in a dense volume. */
#include "volume/formats/vdb/nanovdb_bricks.h"

#include <math.h>
#include <string.h>

#include "bricks/evaluate.h"
#include "core/memory.h"
#include "volume/io/parallel.h"

enum { SHIFT = 5, SIDE = 1 << SHIFT, WIDTH = SIDE + BRICK_MARGIN, COEFFICIENTS = WIDTH * WIDTH * WIDTH };

/* The greatest number of bricks in the box of active voxels, because a damaged or hostile file may state a
 * box of any size. */
enum { MOST_BRICKS = 1 << 22 };
/* Bricks are made only if the bricks take fewer bytes than the fraction WORTH_WHILE of the dense volume's
 * bytes, because sampling bricks is slower. */
static const double WORTH_WHILE = 0.6;

typedef struct brick_reader {
  const nanovdb_grid *grid;
  const size_t *size; /* voxels of the box along x, y, z */
  hl_bricks *bricks;
  float *scratch; /* owned; [threads][2][COEFFICIENTS]; each thread's memory for a box and a brick */
} brick_reader;

/* Reads the coefficients of a brick. The brick's part in the box of active voxels is read into `box`, which
 * is scratch memory. A coefficient beyond the box's faces equals the nearest coefficient at the faces. */
static hl_status read_brick(const brick_reader *r, size_t number, float *box, float *brick, hl_error *error) {
  const hl_bricks *bricks = r->bricks;
  int64_t first[3];
  size_t low[3], count[3], at[3][WIDTH]; /* at: for each coefficient along an axis, its index in `box` */
  for (int a = 0; a < 3; a++) {
    int64_t block = (int64_t)(number % bricks->directory_size[a]), last = (int64_t)r->size[a] - 1;
    number /= bricks->directory_size[a];
    first[a] = block * SIDE - 1 - (int64_t)bricks->origin[a];
    int64_t from = first[a] < 0 ? 0 : first[a] > last ? last : first[a], to = first[a] + WIDTH - 1;
    to = to < 0 ? 0 : to > last ? last : to;
    low[a] = (size_t)from;
    count[a] = (size_t)(to - from) + 1;
    for (int64_t n = 0; n < WIDTH; n++) {
      int64_t voxel = first[a] + n;
      at[a][n] = (size_t)((voxel < from ? from : voxel > to ? to : voxel) - from);
    }
  }
  hl_status status = nanovdb_grid_read_box(r->grid, low, count, box, error);
  for (size_t k = 0; k < WIDTH && status == HL_OK; k++)
    for (size_t j = 0; j < WIDTH; j++) {
      const float *row = box + (at[2][k] * count[1] + at[1][j]) * count[0];
      for (size_t i = 0; i < WIDTH; i++) *brick++ = row[at[0][i]];
    }
  return status;
}

static bool is_constant(const float *brick) {
  return memcmp(brick, brick + 1, (COEFFICIENTS - 1) * sizeof *brick) == 0;
}

/* Reads a brick, and stores whether the brick is a constant. */
static hl_status look_at_brick(void *data, size_t number, int worker, hl_error *error) {
  const brick_reader *r = data;
  float *box = r->scratch + (size_t)worker * 2 * COEFFICIENTS, *brick = box + COEFFICIENTS;
  hl_status status = read_brick(r, number, box, brick, error);
  if (status == HL_OK)
    r->bricks->directory[number] = (hl_brick_entry){.slot = is_constant(brick) ? -1 : 0,
                                                    .constant = brick[0]};
  return status;
}

static hl_status keep_brick(void *data, size_t number, int worker, hl_error *error) {
  const brick_reader *r = data;
  float *box = r->scratch + (size_t)worker * 2 * COEFFICIENTS;
  int32_t slot = r->bricks->directory[number].slot;
  return slot < 0 ? HL_OK : read_brick(r, number, box, r->bricks->pool + (size_t)slot * COEFFICIENTS, error);
}

/* Assigns slots of the pool to the bricks that are not constant. Returns false if the bricks would take too
 * large a fraction of a dense volume's memory. */
static bool number_slots(hl_bricks *bricks, const size_t size[3], size_t entries) {
  for (size_t n = 0; n < entries; n++)
    if (bricks->directory[n].slot >= 0) bricks->directory[n].slot = (int32_t)bricks->slots++;
  return (double)hl_bricks_bytes(bricks) <
         WORTH_WHILE * (double)size[0] * (double)size[1] * (double)size[2] * (double)sizeof(float);
}

hl_status nanovdb_bricks_read(const nanovdb_grid *grid, const hl_volume_description *description,
                              hl_bricks *bricks, hl_error *error) {
  hl_context *context = grid->context;
  brick_reader r = {.grid = grid, .size = description->dimensions, .bricks = bricks};
  hl_pool *pool = NULL;
  size_t entries = 1;
  *bricks = (hl_bricks){.shift = SHIFT, .levels = 1};
  for (int a = 0; a < 3; a++) {
    /* with this origin, coordinates in the lattice equal the coordinates of a dense volume's voxels in the
     * renderer's grid (grid/grid.h), so that pictures have the same bytes */
    bricks->origin[a] = 1;
    bricks->dimension[a] = description->dimensions[a] + 2;
    bricks->directory_size[a] = (bricks->dimension[a] + SIDE - 1) / SIDE;
    if (!hl_multiply(entries, bricks->directory_size[a], &entries) || entries > MOST_BRICKS) return HL_OK;
  }
  hl_status status = hl_pool_create(context, 0, &pool, error);
  if (status != HL_OK) return status;
  bricks->directory = hl_allocate(context, entries, sizeof *bricks->directory);
  r.scratch = hl_allocate(context, (size_t)hl_pool_threads(pool) * 2 * COEFFICIENTS, sizeof *r.scratch);
  bool better = false;
  if (bricks->directory == NULL || r.scratch == NULL)
    status = hl_fail_memory(error, entries * sizeof *bricks->directory, grid->path);
  if (status == HL_OK)
    status = hl_parallel_read(context, pool, grid->path, entries, look_at_brick, &r, error);
  if (status == HL_OK) better = number_slots(bricks, r.size, entries);
  if (better) {
    bricks->pool = hl_allocate(context, bricks->slots * COEFFICIENTS, sizeof *bricks->pool);
    status = bricks->pool == NULL
                 ? hl_fail_memory(error, bricks->slots * COEFFICIENTS * sizeof *bricks->pool, grid->path)
                 : hl_parallel_read(context, pool, grid->path, entries, keep_brick, &r, error);
  }
  hl_release(context, r.scratch);
  hl_pool_destroy(pool);
  if (status != HL_OK || !better) hl_bricks_release(context, bricks);
  return status;
}
