/* hot/grid.c - compiles the hot functions of grids, which find bounds of cells and the cells that show
 * something. */
#include "hot/tables.h"

#include "fill/windows_lanes.h"
#include "grid/bounds_lanes.h"
#include "grid/cell_bits_lanes.h"

#ifdef HL_WINDOWS
#define HL_READS_COLUMNS true
#else
#define HL_READS_COLUMNS false
#endif

const grid_functions HL_HOT(grid) = {
    {bound_rows_u8, bound_rows_u16, bound_rows_f32}, bound_along, bound_across, brick_bits, HL_READS_COLUMNS};
