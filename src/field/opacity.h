/* field/opacity.h - finds how much light the volumes absorb in each cell of a lattice. */
#ifndef HL_FIELD_OPACITY_H
#define HL_FIELD_OPACITY_H

#include "core/pool.h"
#include "field/field.h"
#include "field/field_share.h"
#include "surface/surfaces.h"

/* The content whose opacity is found. */
typedef struct field_content {
  const field_matter *matter; /* [count]; the matter of the volumes */
  int count;
  const surfaces *surfaces; /* the surfaces of meshes; null if there are no meshes */
  double voxel;             /* the smallest edge of a voxel; frame units */
} field_content;

/* FIELD_MARGIN is the width, in cells, of the margin that a lattice has on every side. hl_field_lattice()
 * makes a lattice around points of the content, with at most `most_cells` cells, none of which is smaller
 * than a voxel. */
enum { FIELD_MARGIN = 3 };
field_lattice hl_field_lattice(const vec3 *points, int count, double voxel, double most_cells);

/* Temporary memory for finding the opacity. */
typedef struct opacity_scratch {
  unsigned char *seen; /* [z][y][x]; 1 for each cell in which something may be visible */
} opacity_scratch;

/* Lays out the arrays of a field and of its scratch memory. The field's lattice must have been set. */
void hl_opacity_lay_out(opacity_field *field, opacity_scratch *scratch, hl_layout *layout);

/* Fills the arrays of an opacity field. If processes share a picture, each of them samples the volumes in
 * some of the slabs. */
void hl_opacity_find(const field_content *content, const field_functions *functions,
                     const opacity_scratch *scratch, field_share *share, opacity_field *field, hl_pool *pool);

#endif
