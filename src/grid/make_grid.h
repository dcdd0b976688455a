/* grid/make_grid.h - makes a grid of a volume, once for each volume and kernel. */
#ifndef HL_GRID_MAKE_GRID_H
#define HL_GRID_MAKE_GRID_H

#include "core/memory.h"
#include "grid/grid.h"

typedef struct grid_source {
  const hl_scene_volume *volume; /* the volume; the caller keeps it alive as long as the grid */
  const kernel *kernel;          /* the kernel with which the volume is reconstructed, and for which bounds of
                                  * cells are found */
  affine3 index_to_frame;        /* maps the volume's index space to frame space */
  double empty;                  /* the data value of empty space */
} grid_source;

hl_status hl_grid_create(hl_context *context, hl_pool *pool, const grid_functions *functions,
                         const grid_source *source, grid *grid, hl_error *error);
/* Counts the memory that hl_grid_create() takes: the grid's own memory, and scratch memory that is released
 * once the grid is made. */
void hl_grid_count(const hl_volume *volume, const kernel *kernel, const grid_functions *functions,
                   int threads, hl_layout *layout);
void hl_grid_release(hl_context *context, grid *grid);

#endif
