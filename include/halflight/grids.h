/* halflight/grids.h - makes volumes of grids that are not boxes of voxels: meshes of cells, and adaptive
 * grids. */
#ifndef HALFLIGHT_GRIDS_H
#define HALFLIGHT_GRIDS_H

#include "volume.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Returns 1 if a .vtu file is an unstructured grid that hl_volume_load() reads as a volume: if some of its
 * cells enclose a volume, and it has values at points or cells. Other unstructured grids are meshes
 * (hl_mesh_load()). Returns 0 for these, for files of other formats, and for null. */
HL_API int hl_volume_reads_cells(hl_context *context, const char *path);

/* A mesh of cells with values, numbered as in VTK. All arrays are borrowed during the call. */
typedef struct hl_cells_description {
  size_t struct_size;   /* set by hl_cells_description_defaults() */
  const double *points; /* [point_count][3]: world */
  size_t point_count;
  const unsigned char *types; /* [cell_count]; the type of each cell by VTK's numbers: 10 tetrahedra, 12
                               * hexahedra, 13 wedges, 14 pyramids, ...; cells that enclose no volume are left
                               * out, with a warning */
  const int64_t *ends;        /* [cell_count]; for each cell, the index in `corners` that follows the cell's
                               * last corner */
  size_t cell_count;
  const int64_t *corners; /* [corner_count]; the corners of all cells, one cell after the other. A corner is
                           * the index of a point, from 0; each cell has its corners in VTK's order */
  size_t corner_count;
  const double *values; /* [point_count] or [cell_count]; one value for each point, or for each cell; NaN:
                         * there is no value */
  int of_cells;         /* non-zero if `values` belong to cells; a point then gets the mean of the cells
                         * around it. 0, the default, if they belong to points */
} hl_cells_description;

HL_API void hl_cells_description_defaults(hl_cells_description *description);

/* Makes a volume of a mesh of cells. The volume's samples lie about half of a cell's edge apart, and closer
 * where cells are smaller. The volume is transparent outside the cells. A warning tells how much the volume
 * differs from the mesh's values. *volume is owned by the caller, who releases it. */
HL_API HL_WARN_UNUSED hl_status hl_volume_create_cells(hl_context *context,
                                                       const hl_cells_description *description,
                                                       hl_volume **volume, hl_error *error);

/* A patch of an adaptive grid: a box of cells of one level. */
typedef struct hl_patch {
  int level;           /* the level, from 0, which is the coarsest */
  int64_t first[3];    /* the index, along x, y, z, of the patch's first cell in the patch's level */
  size_t count[3];     /* number of cells along x, y, z */
  const float *values; /* [count[2]][count[1]][count[0]]; the patch's values, which are means over its
                        * cells; borrowed during the call */
} hl_patch;

/* An adaptive grid. Cell i of a level covers the cells i ratio to i ratio + ratio - 1 of the next finer
 * level. */
typedef struct hl_amr_description {
  size_t struct_size;      /* set by hl_amr_description_defaults() */
  int levels;              /* 1 to 16 */
  const int *ratios;       /* [levels - 1]; ratios[n] is the number of cells of level n + 1 along the edge of
                            * a cell of level n: 2, 4, 8, ... */
  int64_t first[3];        /* index of the domain's first cell in level 0; default 0 */
  size_t count[3];         /* number of the domain's cells in level 0 along x, y, z */
  double origin[3];        /* the domain's corner with the least coordinates, in the world; default 0 */
  double spacing[3];       /* the lengths of the edges of a cell of level 0, in the world; default 1 */
  const hl_patch *patches; /* [patch_count] */
  size_t patch_count;
} hl_amr_description;

HL_API void hl_amr_description_defaults(hl_amr_description *description);

/* Makes a volume of an adaptive grid. The volume has no seams where the grid's level changes. Its voxels have
 * the size of the finest cells. Where a finer patch covers a coarser patch, the finer values count. *volume
 * is owned by the caller, who releases it. */
HL_API HL_WARN_UNUSED hl_status hl_volume_create_amr(hl_context *context,
                                                     const hl_amr_description *description,
                                                     hl_volume **volume, hl_error *error);

#ifdef __cplusplus
}
#endif
#endif
