/* label/occupancy_line.c - see occupancy_line.h. */
#include "label/occupancy_line.h"

#include <math.h>

void hl_occupancy_first(const hl_volume *map, const hl_volume *occupancy, size_t first[3]) {
  affine3 inverse;
  vec3 at = {0, 0, 0};
  if (affine3_invert(map->index_to_world, &inverse))
    at = affine3_apply(inverse, occupancy->index_to_world.offset);
  first[0] = (size_t)llround(at.x);
  first[1] = (size_t)llround(at.y);
  first[2] = (size_t)llround(at.z);
}

static float coefficient(const hl_volume *o, size_t i, size_t j, size_t k) {
  return ((const unsigned char *)hl_volume_row(o, j, k))[i];
}

/* Finds the neighbours of a coordinate. Beyond the grid's ends, the coordinate at the border repeats. */
static void neighbours(size_t at, size_t count, size_t found[3]) {
  found[0] = at > 0 ? at - 1 : 0;
  found[1] = at;
  found[2] = at + 1 < count ? at + 1 : at;
}

/* The B-spline weighs neighbours by 1/6, 2/3, 1/6 along each axis. */
void hl_occupancy_line(const hl_volume *o, size_t j, size_t k, float *line) {
  static const float WEIGHT[3] = {1.0f / 6, 2.0f / 3, 1.0f / 6};
  size_t js[3], ks[3];
  neighbours(j, o->dimension[1], js);
  neighbours(k, o->dimension[2], ks);
  for (size_t i = 0; i < o->dimension[0]; i++) line[i] = 0;
  for (int b = 0; b < 9; b++) {
    const float weight = WEIGHT[b % 3] * WEIGHT[b / 3];
    for (size_t i = 0; i < o->dimension[0]; i++) line[i] += weight * coefficient(o, i, js[b % 3], ks[b / 3]);
  }
  float before = line[0];
  for (size_t i = 0; i < o->dimension[0]; i++) {
    const float after = i + 1 < o->dimension[0] ? line[i + 1] : line[i];
    const float stored = (before + 4 * line[i] + after) / 6;
    before = line[i];
    line[i] = stored * (float)o->value_scale + (float)o->value_offset;
  }
}
