/* shape/sample.c - samples a list of shapes into voxels.
 *
 * Blocks of 8x8x8 voxels are sampled in parallel. Most blocks are far from every surface. Bounds of the
 * distance over a block tell this before any of its voxels is sampled. Densities are stored in 16 bits,
 * orbitals as floats. */
#include <math.h>

#include "core/context.h"
#include "core/memory.h"
#include "core/pool.h"
#include "shape/shape.h"

enum { BLOCK = 8, DENSITY_STEPS = 65535 };

typedef struct sampling {
  const hl_shape_list *list;
  const hl_shape_grid *grid;
  unsigned char *live; /* owned; [threads][list->count]; for each shape, whether it can affect the distance
                        * in a block */
  uint16_t *density;   /* the voxels of solids; null for orbitals */
  float *wave;         /* the voxels of orbitals; null for solids */
  size_t blocks[3];
  size_t layer; /* the current layer of blocks, along k */
} sampling;

/* The voxels of one block: [low, high) along each axis. */
typedef struct block {
  size_t low[3], high[3];
} block;

static block block_at(const sampling *s, size_t index) {
  size_t at[3] = {index % s->blocks[0], index / s->blocks[0], s->layer};
  block b;
  for (int axis = 0; axis < 3; axis++) {
    size_t end = (at[axis] + 1) * BLOCK, dimension = s->grid->dimension[axis];
    b.low[axis] = at[axis] * BLOCK;
    b.high[axis] = end < dimension ? end : dimension;
  }
  return b;
}

static vec3 voxel_centre(const hl_shape_grid *grid, double i, double j, double k) {
  return (vec3){((double)grid->first[0] + i) * grid->voxel_size,
                ((double)grid->first[1] + j) * grid->voxel_size,
                ((double)grid->first[2] + k) * grid->voxel_size};
}

static size_t row_start(const sampling *s, size_t i, size_t j, size_t k) {
  return (k * s->grid->dimension[1] + j) * s->grid->dimension[0] + i;
}

static uint16_t density_at(double distance, double edge) {
  double density = 0.5 - distance / edge;
  return (uint16_t)(DENSITY_STEPS * (density > 0 ? density < 1 ? density : 1 : 0) + 0.5);
}

static void fill_block(const sampling *s, const block *b, uint16_t value) {
  for (size_t k = b->low[2]; k < b->high[2]; k++)
    for (size_t j = b->low[1]; j < b->high[1]; j++) {
      uint16_t *row = s->density + row_start(s, 0, j, k);
      for (size_t i = b->low[0]; i < b->high[0]; i++) row[i] = value;
    }
}

static void sample_solids(void *data, size_t index, int worker) {
  const sampling *s = data;
  const hl_shape_grid *grid = s->grid;
  block b = block_at(s, index);
  double half[3], middle[3], edge = HL_SHAPE_EDGE * grid->voxel_size;
  for (int axis = 0; axis < 3; axis++) {
    half[axis] = 0.5 * (double)(b.high[axis] - 1 - b.low[axis]);
    middle[axis] = (double)b.low[axis] + half[axis];
  }
  unsigned char *live = s->live + (size_t)worker * s->list->count;
  double radius = grid->voxel_size * sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]);
  /* the radius is a little greater than the block's, to make up for rounding */
  hl_interval bounds = hl_shapes_bounds(s->list, voxel_centre(grid, middle[0], middle[1], middle[2]),
                                        radius + 1e-3 * grid->voxel_size, live);
  if (bounds.low >= edge / 2 || bounds.high <= -edge / 2) {
    fill_block(s, &b, bounds.low >= edge / 2 ? 0 : DENSITY_STEPS);
    return;
  }
  for (size_t k = b.low[2]; k < b.high[2]; k++)
    for (size_t j = b.low[1]; j < b.high[1]; j++) {
      uint16_t *row = s->density + row_start(s, 0, j, k);
      for (size_t i = b.low[0]; i < b.high[0]; i++)
        row[i] = density_at(
            hl_shapes_distance(s->list, live, voxel_centre(grid, (double)i, (double)j, (double)k)), edge);
    }
}

static void sample_orbitals(void *data, size_t index, int worker) {
  const sampling *s = data;
  const hl_shape_list *list = s->list;
  (void)worker;
  block b = block_at(s, index);
  for (size_t k = b.low[2]; k < b.high[2]; k++)
    for (size_t j = b.low[1]; j < b.high[1]; j++) {
      float *row = s->wave + row_start(s, 0, j, k);
      for (size_t i = b.low[0]; i < b.high[0]; i++) {
        vec3 p = voxel_centre(s->grid, (double)i, (double)j, (double)k);
        double sum = 0;
        for (size_t n = 0; n < list->count; n++)
          sum += hl_orbital_at(&list->shapes[n], affine3_apply(list->shapes[n].to_local, p));
        row[i] = (float)sum;
      }
    }
}

static void scale_to_one(float *wave, size_t count) {
  float greatest = 0;
  for (size_t n = 0; n < count; n++) greatest = fabsf(wave[n]) > greatest ? fabsf(wave[n]) : greatest;
  if (greatest > 0)
    for (size_t n = 0; n < count; n++) wave[n] /= greatest;
}

/* Samples the blocks layer by layer, so that the function can report progress and be cancelled between
 * layers. */
static hl_status sample(hl_context *context, sampling *s, int threads, const char *subject, hl_error *error) {
  hl_pool *pool = NULL;
  hl_status status = hl_pool_create(context, threads, &pool, error);
  if (status != HL_OK) return status;
  size_t layers = s->blocks[2];
  s->live = hl_allocate(context, (size_t)hl_pool_threads(pool), s->list->count);
  if (s->live == NULL) status = hl_fail_memory(error, s->list->count, subject);
  for (s->layer = 0; status == HL_OK && s->layer < layers; s->layer++) {
    hl_pool_run(pool, s->blocks[0] * s->blocks[1], s->density != NULL ? sample_solids : sample_orbitals, s);
    hl_progress(context, "load", (double)(s->layer + 1) / (double)layers);
    if (hl_pool_cancelled(pool)) status = hl_fail(error, HL_ERROR_CANCELLED, "%s: stopped", subject);
  }
  hl_release(context, s->live);
  hl_pool_destroy(pool);
  return status;
}

static void describe(const hl_shape_grid *grid, bool orbitals, hl_volume_description *description) {
  hl_volume_description_defaults(description);
  vec3 origin = voxel_centre(grid, 0, 0, 0);
  description->origin[0] = origin.x, description->origin[1] = origin.y, description->origin[2] = origin.z;
  for (int axis = 0; axis < 3; axis++) {
    description->dimensions[axis] = grid->dimension[axis];
    description->axis[axis][axis] = grid->voxel_size;
  }
  description->type = orbitals ? HL_VOXEL_F32 : HL_VOXEL_U16;
  description->value_scale = orbitals ? 1 : 1.0 / DENSITY_STEPS;
}

hl_status hl_shapes_sample(hl_context *context, const hl_shape_list *list, const hl_shape_grid *grid,
                           int threads, const char *subject, hl_volume **volume, hl_error *error) {
  /* either all shapes of a list are orbitals, or none is */
  bool orbitals = list->shapes[0].type == HL_SHAPE_ORBITAL;
  const size_t *dimension = grid->dimension;
  size_t count = dimension[0] * dimension[1] * dimension[2],
         bytes = orbitals ? sizeof(float) : sizeof(uint16_t);
  void *voxels = hl_allocate(context, count, bytes);
  if (voxels == NULL) return hl_fail_memory(error, count * bytes, subject);
  sampling s = {
      .list = list, .grid = grid, .density = orbitals ? NULL : voxels, .wave = orbitals ? voxels : NULL};
  for (int axis = 0; axis < 3; axis++) s.blocks[axis] = (dimension[axis] + BLOCK - 1) / BLOCK;
  hl_status status = sample(context, &s, threads, subject, error);
  if (status != HL_OK) {
    hl_release(context, voxels);
    return status;
  }
  if (orbitals) scale_to_one(s.wave, count);
  hl_volume_description description;
  describe(grid, orbitals, &description);
  return hl_volume_adopt(context, &description, subject, voxels, volume, error);
}
