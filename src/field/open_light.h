/* field/open_light.h - gives the cells of the sky's field that surfaces cross the light of the space before
 * the surfaces.
 *
 * A surface that crosses a cell leaves a part of the cell open. The sweep moves the cell's light on by the
 * mean transmittance of the whole cell, so that light that goes along the surface is weakened in each cell
 * that the surface crosses, although the open parts of these cells are one open space. A sample in a corner
 * between two surfaces has only such cells around it. */
#ifndef HL_FIELD_OPEN_LIGHT_H
#define HL_FIELD_OPEN_LIGHT_H

#include "core/pool.h"
#include "field/field.h"

/* Mixes the light of each cell that holds matter, but lets some light pass, with the mean light of the cells
 * without matter around it. The cell's own light counts by the square of its transmittance. In the corner of
 * a cut block, the greatest error is then .028 of the sky's light. With the first power it is .066, and
 * higher powers brighten the floors of slots. Light of cells without matter stays as it is, so that the order
 * of the cells has no effect. step: numbers of floats from one cell to the next along x, y and z. */
void hl_open_light_spread(const field_lattice *lattice, int channels, float *field, const size_t step[3],
                          hl_pool *pool);

#endif
