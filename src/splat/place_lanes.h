/* splat/place_lanes.h - what splat and gather share: kernels, and the places of a block's pixels in a
 * grid. */
#ifndef HL_SPLAT_PLACE_LANES_H
#define HL_SPLAT_PLACE_LANES_H

#include "splat/classify.h"
#include "splat/fill.h"
#include "splat/rays_lanes.h"

LANES_INLINE lanes kernel_piece(const float *piece, int degree, lanes a) {
  lanes sum = lanes_set(piece[degree]);
  for (int power = degree - 1; power >= 0; power--) sum = lanes_fma(sum, a, lanes_set(piece[power]));
  return sum;
}

/* The cubic B-spline at distances up to 1, and at two less a rest up to 1, in fewer steps. */
LANES_INLINE lanes bspline_inner(lanes distance) {
  return lanes_fma(distance * distance, lanes_line(distance, 0.5f, -1.0f), lanes_set(2.0f / 3));
}
LANES_INLINE lanes bspline_outer(lanes rest) { return rest * rest * (rest * (1.0f / 6)); }

/* A stored value; beyond the grid's faces they continue. */
static inline float stored_value(const grid *grid, int64_t x, int64_t y, int64_t z) {
  int64_t at[3] = {x, y, z};
  for (int a = 0; a < 3; a++)
    at[a] = at[a] < 0 ? 0 : at[a] >= grid->dimension[a] ? grid->dimension[a] - 1 : at[a];
  size_t index = ((size_t)at[2] * (size_t)grid->dimension[1] + (size_t)at[1]) * (size_t)grid->dimension[0] +
                 (size_t)at[0];
  if (grid->storage == HL_STORAGE_U8) return ((const uint8_t *)grid->voxels)[index];
  if (grid->storage == HL_STORAGE_U16) return ((const uint16_t *)grid->voxels)[index];
  return ((const float *)grid->voxels)[index];
}

/* The point of a block's pixels in index space, clamped to the grid, and which of them matter. */
typedef struct block_place {
  lanes3 point;      /* index space, clamped to [-1, n) */
  lanes_int cell[3]; /* floor(point): -1 .. n-1 */
  int32_t low[3];    /* the least cell along each axis, where something asks for it (lowest_of_block) */
  lanes_int inside;  /* within the grid or a little outside */
} block_place;

/* Lanes whose density is not below all that is shown. */
LANES_INLINE lanes_int may_show(const fill_source *source, lanes density) {
  const classifier *classifier = source->classifier;
  if (classifier == NULL) return lanes_set_int(-1);
  return lanes_line(density, classifier->scale, classifier->offset) > classifier->first_visible;
}

LANES_INLINE block_place place_block(const fill_source *source, int x, int y) {
  const grid *grid = source->grid;
  lanes3 p = rays_positions(&source->rays, block_u(x), block_v(y));
  block_place place;
  lanes axis[3] = {p.x, p.y, p.z};
  place.inside = lanes_set_int(-1);
  for (int a = 0; a < 3; a++) {
    float count = (float)grid->dimension[a];
    place.inside &= (axis[a] > -0.5f - GRID_MARGIN) & (axis[a] < count - 0.5f + GRID_MARGIN);
    /* the border's values continue outside the box, smoothly, and are constant from -1 and n on */
    axis[a] = lanes_clamp(axis[a], -1.0f, count * (1 - 1e-6f));
    place.cell[a] = lanes_floor(axis[a]);
  }
  place.point = (lanes3){axis[0], axis[1], axis[2]};
  return place;
}

/* The least cell of a block along each axis. Along a row or a column of its pixels places rise or fall
 * throughout, so that the least is at a corner, rounding apart. */
LANES_INLINE void lowest_of_block(const lanes_int cell[3], int32_t low[3]) {
#if defined(__AVX512BW__)
  const __m512i of_two = _mm512_set_epi32(0, 0, 0, 0, 15, 12, 3, 0, 31, 28, 19, 16, 15, 12, 3, 0);
  __m512i corners = _mm512_permutex2var_epi32((__m512i)cell[0], of_two, (__m512i)cell[1]);
  corners = _mm512_mask_permutexvar_epi32(corners, 0x0f00, of_two, (__m512i)cell[2]);
  corners = _mm512_min_epi32(corners, _mm512_shuffle_epi32(corners, _MM_PERM_CDAB));
  corners = _mm512_min_epi32(corners, _mm512_shuffle_epi32(corners, _MM_PERM_BADC));
  low[0] = _mm_cvtsi128_si32(_mm512_castsi512_si128(corners));
  low[1] = _mm_cvtsi128_si32(_mm512_extracti32x4_epi32(corners, 1));
  low[2] = _mm_cvtsi128_si32(_mm512_extracti32x4_epi32(corners, 2));
#elif defined(__AVX2__)
  const lanes_int axes[4] = {cell[0], cell[1], cell[2], cell[2]};
  int32_t least[4];
  _mm_storeu_si128((__m128i *)(void *)least, lanes_least_of_each(axes));
  for (int axis = 0; axis < 3; axis++) low[axis] = least[axis];
#else
  for (int axis = 0; axis < 3; axis++) {
    low[axis] = cell[axis][0];
    for (int corner = 1; corner < 4; corner++) {
      int32_t other = cell[axis][corner % 2 * 3 + corner / 2 * 12];
      if (other < low[axis]) low[axis] = other;
    }
  }
#endif
}

/* Whether the taps of all pixels of a tile lie in the grid, with room for rounding. A sheet's part that a
 * tile's pixels cover has straight edges: the pixels lie among those at its corners, unless some of them lie
 * behind the view. */
LANES_INLINE int tile_is_inside(const fill_source *source, int x, int y) {
  const sheet_rays *rays = &source->rays;
  const float spare = 1.0f / 64;
  lanes u = lanes_load(block_column) * 5.0f + (float)x, v = lanes_load(block_row) * 5.0f + (float)y;
  lanes3 p = rays_positions(rays, u, v);
  lanes axis[3] = {p.x, p.y, p.z};
  lanes_int inside = lanes_set_int(-1);
  if (rays->perspective) inside = rays_climb(rays, u, v) > 0.0f;
  for (int a = 0; a < 3; a++)
    inside &= (axis[a] > 1.0f + spare) & (axis[a] < (float)source->grid->dimension[a] - 2.0f - spare);
  return lanes_bits(inside) == 0xffff;
}

/* As place_block() in such a tile. */
LANES_INLINE block_place place_block_inside(const fill_source *source, int x, int y) {
  block_place place;
  place.point = rays_positions(&source->rays, block_u(x), block_v(y));
  place.cell[0] = lanes_truncate(place.point.x);
  place.cell[1] = lanes_truncate(place.point.y);
  place.cell[2] = lanes_truncate(place.point.z);
  place.inside = lanes_set_int(-1);
  return place;
}

#endif
