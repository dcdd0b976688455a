/* splat/columns.h - u8 voxels once more, in columns eight wide: eight rows of one are 64 bytes in a line, so
 * that a window of 8x8 voxels comes from two columns in two loads (of 512 bits), and neighbouring windows
 * from the same lines of the cache whichever way the sheets lie. They are kept less 128, as numbers with a
 * sign, as they are multiplied. */
#ifndef HL_SPLAT_COLUMNS_H
#define HL_SPLAT_COLUMNS_H

#include "splat/grid.h"

/* Copies one slice into its place in every column. rows: [count_y][count_x]; columns: the slice's place in
 * the first. */
typedef void column_slice_function(const unsigned char *rows, int32_t count_x, int32_t count_y,
                                   unsigned char *columns, size_t column_bytes);

/* Whether something reads a grid's columns, and windows fit them at all. slice: null where nothing does. */
bool hl_columns_wanted(column_slice_function *slice, const int32_t dimension[3], hl_storage storage);
/* The bytes that they take. */
uint64_t hl_columns_bytes(const int32_t dimension[3]);
hl_status hl_columns_build(hl_context *context, hl_pool *pool, column_slice_function *slice, grid *grid,
                           hl_error *error);

#endif
