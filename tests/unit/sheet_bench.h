/* unit/sheet_bench.h - a grid, a view and a stack of sheets, on which the filling of tiles is tried. */
#ifndef SHEET_BENCH_H
#define SHEET_BENCH_H

#include "fill/voxel_lists.h"
#include "grid/bounds.h"
#include "grid/make_grid.h"
#include "grid/relevant.h"
#include "render/hot.h"

typedef struct bench {
  hl_context *context;
  hl_pool *pool;
  hl_scene_volume scene;
  hl_opacity_point opacity;
  hl_color_point color;
  grid grid;
  classifier classifier;
  view view;
  sheet_stack sheets;
  voxel_lists lists;
} bench;

/* A repeatable random number in [0, 1); state: any non-zero start. */
double bench_random(uint32_t *state);
vec3 bench_random_direction(uint32_t *state);
/* A random normal of sheets, at most about 50 degrees from the direction. */
vec3 bench_random_normal(vec3 direction, uint32_t *state);
/* Random axes of a grid: oblique and of different lengths, but not degenerate. */
mat3 bench_oblique_axes(void);

/* A grid of stored values, opaque everywhere, its middle at the origin; voxel (i, j, k) steps by the columns
 * of `axes`. voxels: [k][j][i] of the storage's type. */
void bench_open(bench *bench, const size_t dimensions[3], hl_storage storage, const void *voxels, mat3 axes);
/* Gives the volume other opacities. They must last longer than the bench. */
void bench_show(bench *bench, const hl_opacity_point *opacity, size_t count);
/* 48 x 48 pixels of edge `pixel` that look along `direction` at the origin, from `distance` (0: in parallel),
 * and five sheets a third of a world unit apart around it, perpendicular to normal. Sorts the voxels for
 * them. */
void bench_look(bench *bench, vec3 direction, vec3 normal, double pixel, double distance, hl_kernel which);
fill_source bench_source(const bench *bench, hl_kernel which, int sheet);
/* The slabs between the sheets. beside: the number of voxels by which a box must reach beyond the slabs to
 * leave them whole. */
slab_run bench_run(const bench *bench, double beside);
void bench_close(bench *bench);

/* Index-space position of a pixel's centre on the source's sheet, in double precision. */
vec3 bench_position(const bench *bench, int sheet, int x, int y);

#endif
