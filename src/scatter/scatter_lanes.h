/* scatter/scatter_lanes.h - interpolates scattered light between the nodes, linearly along each axis. */
#ifndef HL_SCATTER_SCATTER_LANES_H
#define HL_SCATTER_SCATTER_LANES_H

#include "scatter/scatter.h"
#include "simd/gathers.h"

/* The index of the last node before a place along an axis, and the distance from this node to the place as a
 * fraction of the spacing. */
LANES_INLINE lanes_int node_before(const scatter_nodes *nodes, int axis, lanes at, lanes *fraction) {
  lanes place = lanes_clamp((at - nodes->origin[axis]) * (1.0f / nodes->spacing), 0,
                            (float)(nodes->count[axis] - 1) - 1e-3f);
  lanes_int before = lanes_truncate(place);
  *fraction = place - lanes_from_int(before);
  return before;
}

/* For each of sixteen samples, the cell of eight nodes around it. */
typedef struct node_cell {
  lanes_int first; /* the index of the cell's first node, which has the least coordinates */
  lanes fraction[3];
} node_cell;

/* Finds the cells of nodes around sixteen positions. position: x, y and z in frame space. */
LANES_INLINE node_cell node_cell_at(const scatter_nodes *nodes, const lanes position[3]) {
  node_cell cell;
  lanes_int x = node_before(nodes, 0, position[0], &cell.fraction[0]),
            y = node_before(nodes, 1, position[1], &cell.fraction[1]),
            z = node_before(nodes, 2, position[2], &cell.fraction[2]);
  cell.first = (z * nodes->count[1] + y) * nodes->count[0] + x;
  return cell;
}

/* Interpolates a table of numbers at the nodes linearly, at the samples of `cell`. table: [nodes]. */
LANES_INLINE lanes between_nodes(const scatter_nodes *nodes, const node_cell *cell, const float *table) {
  const int32_t row = nodes->count[0], slice = nodes->count[1] * row;
  lanes side[2];
  for (int k = 0; k < 2; k++, table += slice) {
    lanes a = lanes_gather(table, cell->first), b = lanes_gather(table + 1, cell->first),
          c = lanes_gather(table + row, cell->first), d = lanes_gather(table + row + 1, cell->first);
    lanes near = lanes_fma(b - a, cell->fraction[0], a), far = lanes_fma(d - c, cell->fraction[0], c);
    side[k] = lanes_fma(far - near, cell->fraction[1], near);
  }
  return lanes_fma(side[1] - side[0], cell->fraction[2], side[0]);
}

/* The light that a medium with anisotropy g scatters towards the eye: the mean over all directions, plus 3 g
 * times the component of the flux in this direction (derived: the phase function's first two moments). The
 * direction is a unit vector. */
LANES_INLINE void scattered_light(const scatter_field *field, const lanes position[3],
                                  const lanes direction[3], float g, lanes light[3]) {
  const scatter_nodes *nodes = &field->nodes;
  const size_t count = hl_scatter_node_count(nodes);
  node_cell cell = node_cell_at(nodes, position);
  for (int c = 0; c < field->channels; c++) {
    light[c] = between_nodes(nodes, &cell, field->light + (size_t)c * count);
    if (field->flux == NULL || g == 0) continue;
    lanes flux = lanes_set(0);
    for (int a = 0; a < 3; a++)
      flux = lanes_fma(between_nodes(nodes, &cell, field->flux + (size_t)(3 * c + a) * count), direction[a],
                       flux);
    light[c] = lanes_max(lanes_add_scaled(light[c], flux, 3 * g), lanes_set(0));
  }
  for (int c = field->channels; c < 3; c++) light[c] = light[0];
}

#endif
