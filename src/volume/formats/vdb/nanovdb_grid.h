/* volume/formats/vdb/nanovdb_grid.h - reads the tree of a NanoVDB grid through PNanoVDB.h into a dense
 * volume.
 *
 * A grid is a block of memory in which offsets lead from a node to its children. PNanoVDB checks the bounds
 * of every access, so that offsets that lead out of the block give zeros. */
#ifndef HL_VOLUME_NANOVDB_GRID_H
#define HL_VOLUME_NANOVDB_GRID_H

#include "volume/exact.h"
#include "volume/formats/format.h"

typedef struct nanovdb_grid {
  hl_context *context;
  const char *path;     /* for error lines */
  unsigned char *bytes; /* borrowed; [size]; aligned to 64 bytes */
  size_t size;
  uint32_t kind;               /* the kind of grid: a constant whose name begins with PNANOVDB_GRID_TYPE_ */
  int component;               /* the index of the component of vectors and colours that is read, or
                                * HL_COMPONENT_MAGNITUDE */
  int64_t low[3], box_size[3]; /* the box of active voxels; set by nanovdb_grid_describe() */
} nanovdb_grid;

/* Finds the type and the number of components of a kind of grid. The type is 0 if grids of this kind cannot
 * be read. */
void nanovdb_kind(uint32_t kind, hl_voxel_type *type, size_t *components);

/* Checks the grid's memory, finds the box of active voxels, and sets the description's dimensions, origin and
 * axes to the dimensions, origin and axes of the box. */
hl_status nanovdb_grid_describe(nanovdb_grid *grid, hl_volume_description *description, hl_error *error);

/* Reads all voxels [k][j][i] of the box of active voxels, in stored form. description: the box's description,
 * with the volume's type. exact: records the voxels' numbers as the file has them. */
hl_status nanovdb_grid_read(const nanovdb_grid *grid, const hl_volume_description *description, void *voxels,
                            hl_exact *exact, hl_error *error);

/* Reads the voxels [k][j][i] of a part of the box of active voxels as 32-bit floats; the grid's values must
 * have this type. first, size: the index of the part's first voxel, counted from the box's first voxel
 * (0,0,0), and the part's size in voxels. */
hl_status nanovdb_grid_read_box(const nanovdb_grid *grid, const size_t first[3], const size_t size[3],
                                float *voxels, hl_error *error);

#endif
