/* isosurface/cubes.h - finds how a surface cuts a cube, for each set of corners of the cube that lie inside
 * the surface (Lorensen and Cline, "Marching Cubes", 1987).
 *
 * Corner i of a cube lies at (i & 1, i >> 1 & 1, i >> 2). Edge 4 a + n runs along axis a; the bits of n are
 * its coordinates along the two other axes, the lower axis in bit 0. */
#ifndef HL_ISOSURFACE_CUBES_H
#define HL_ISOSURFACE_CUBES_H

#include <stdint.h>

enum { CUBE_EDGES = 12, CUBE_PATTERNS = 256, CUBE_TRIANGLES = 10 };

/* The corner at which an edge begins. */
int hl_cube_edge_corner(int edge);

/* The triangles by which a surface cuts a cube, for one pattern of corners. A triangle is given by the three
 * edges on which its vertices lie, counter-clockwise as seen from outside. */
typedef struct cube_triangles {
  uint8_t count;
  uint8_t edge[CUBE_TRIANGLES][3];
} cube_triangles;

/* Fills the table of patterns, [CUBE_PATTERNS]. Bit i of a pattern's index is set if corner i of the cube
 * lies inside. */
void hl_cube_patterns(cube_triangles *patterns);

#endif
