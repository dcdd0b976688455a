/* field/surface_cover.h - how much light the surfaces of meshes take in the cells of a lattice. */
#ifndef HL_FIELD_SURFACE_COVER_H
#define HL_FIELD_SURFACE_COVER_H

#include "field/field.h"

/* Adds, for each axis, the fraction of light along it that the surface takes in each cell to cover[axis],
 * [z][y][x], and marks the cells of visible surfaces in field->seen. */
void hl_surface_cover(const field_surface *surface, opacity_field *field, float *const cover[3]);

#endif
