/* gpu/kernels/sky.h - finds the sky's light that a sample sends on. The functions compute for one pixel and
 * one volume the same numbers as field/lookup_lanes.h and render/sky_lanes.h for sixteen pixels. */
#ifndef HL_GPU_SKY_H
#define HL_GPU_SKY_H

#include "core/sheet_constants.h"
#include "gpu/kernels/light.h"
#include "gpu/kernels/phase.h"

#if SKY

/* The cells of the sky's field (field/sky_field.h), and the field's constants. */
typedef struct sky_data {
  GLOBAL const plan_sky *plan;
  GLOBAL const short *cells;
} sky_data;

/* ---- the cells around a position ---- */

/* The eight cells around a position. Cell `corner` is at the far end of the x axis if bit 0 of `corner` is
 * set, of the y axis if bit 1 is set, and of the z axis if bit 2 is set. */
typedef struct sky_cells {
  GLOBAL const short *first; /* the cell with corner 0 */
  wide row, slice;   /* the distance, in numbers of 16 bits, from a row to the next row, and from a slice to
                      * the next slice */
  float fraction[3]; /* fraction of the way to the next cell along each axis */
} sky_cells;

DEVICE GLOBAL const short *cell_at(const sky_cells *cells, int corner) {
  return cells->first + (corner & 1 ? SKY_CELL : 0) + (corner & 2 ? cells->row : 0) +
         (corner & 4 ? cells->slice : 0);
}

DEVICE sky_cells cells_around(const sky_data *sky, vector position) {
  GLOBAL const plan_sky *plan = sky->plan;
  const float at[3] = {position.x, position.y, position.z};
  float first[3];
  sky_cells cells;
  for (int axis = 0; axis < 3; axis++) {
    const float place = limited(fused(at[axis] - plan->low[axis], plan->inverse_cell, -0.5f), 0.0f,
                                (float)plan->count[axis] - 1.001f);
    first[axis] = (float)(int)place;
    cells.fraction[axis] = place - first[axis];
  }
  cells.row = plan->row_numbers;
  cells.slice = cells.row * (wide)(unsigned)plan->count[1];
  const int row = (int)fused(first[2], (float)plan->count[1], first[1]);
  cells.first = sky->cells + (wide)(unsigned)row * cells.row + (wide)(unsigned)((int)first[0] * SKY_CELL);
  return cells;
}

/* ---- the cells' weights ---- */

/* Finds a cell on the position's side of surfaces, as cell_on_side() in field/lookup_lanes.h does. */
DEVICE int cell_on_side(const sky_cells *cells) {
  const float *fraction = cells->fraction;
  int corner = (fraction[0] >= 0.5f ? 1 : 0) + (fraction[1] >= 0.5f ? 2 : 0) + (fraction[2] >= 0.5f ? 4 : 0);
  for (int step = 0; step < 3; step++) {
    float sum = 0.0f, most = 0.0f;
    int across = 0;
    for (int axis = 0; axis < 3; axis++) {
      const int cut = cell_at(cells, corner & ~(1 << axis))[SKY_CUT(axis)], is_far = corner >> axis & 1;
      if (cut == 0) continue;
      const float place = (float)cut * (1.0f / SKY_MOST), far = is_far ? 1.0f - place : place,
                  way = is_far ? 1.0f - fraction[axis] : fraction[axis];
      const float part = divided(way, far > 1e-3f ? far : 1e-3f);
      sum = sum + part;
      if (part > most) {
        most = part;
        across = axis;
      }
    }
    if (sum <= 1.0f) return corner;
    corner ^= 1 << across;
  }
  return corner;
}

/* The cells that lie first on the ways along an axis, one bit for each cell. */
DEVICE unsigned firsts_along(int axis) { return axis == 0 ? 0x55u : axis == 1 ? 0x33u : 0x0fu; }

/* Sets the weights of cells that surfaces separate from the position to 0, as weigh_parted_cells() in
 * field/lookup_lanes.h. */
DEVICE void weigh_on_one_side(const sky_cells *cells, float weight[8]) {
  unsigned open[3], all = 0;
  for (int axis = 0; axis < 3; axis++) {
    open[axis] = firsts_along(axis);
    for (int corner = 0; corner < 8; corner++)
      if ((firsts_along(axis) >> corner & 1) && cell_at(cells, corner)[SKY_CUT(axis)] != 0) {
        open[axis] &= ~(1u << corner);
        all = 1;
      }
  }
  if (all == 0) return;
  const int own = cell_on_side(cells);
  unsigned reached = 1u << own, before = 0;
  while (reached != before) {
    before = reached;
    for (int axis = 0; axis < 3; axis++)
      reached |= (reached & open[axis]) << (1 << axis) | (reached >> (1 << axis) & open[axis]);
  }
  for (int corner = 0; corner < 8; corner++)
    if (!(reached >> corner & 1)) weight[corner] = 0.0f;
  if (weight[own] < LEAST_COUNTED) weight[own] = LEAST_COUNTED;
}

/* The weight of a cell among the cells around a position, as weight_of_cell() in field/lookup_lanes.h. */
DEVICE float weight_of_cell(float trilinear, int stored, float surface) {
  const float passing = (float)stored * (1.0f / SKY_MOST), squared = passing * passing,
              counted = passing * fused(surface, squared * squared * passing - 1.0f, 1.0f);
  return trilinear * greater(counted, LEAST_COUNTED);
}

/* The weights of the eight cells as whole numbers. Returns 1 over their sum. */
DEVICE float weigh_cells(const sky_data *sky, const sky_cells *cells, float surface, int whole[8]) {
  float weight[8], sum = 0.0f;
  int total = 0;
  for (int pair = 0; pair < 4; pair++) {
    const float across = (pair & 1 ? cells->fraction[1] : 1.0f - cells->fraction[1]) *
                         (pair & 2 ? cells->fraction[2] : 1.0f - cells->fraction[2]);
    weight[2 * pair + 1] = across * cells->fraction[0];
    weight[2 * pair] = across - weight[2 * pair + 1];
  }
  if (sky->plan->cut) weigh_on_one_side(cells, weight);
  for (int pair = 0; pair < 4; pair++) {
    GLOBAL const short *passing = cell_at(cells, 2 * pair) + SKY_PASSING;
    weight[2 * pair] = weight_of_cell(weight[2 * pair], passing[0], surface);
    weight[2 * pair + 1] = weight_of_cell(weight[2 * pair + 1], passing[1], surface);
    sum = sum + (weight[2 * pair] + weight[2 * pair + 1]);
  }
  const float scale = divided((float)SKY_MOST, sum);
  for (int corner = 0; corner < 8; corner++) {
    whole[corner] = (int)fused(weight[corner], scale, 0.5f);
    total += whole[corner];
  }
  return divided(1.0f, (float)total);
}

/* ---- the light at a position ---- */

/* The light that reaches a position: the cells around it and their weights. */
typedef struct sky_place {
  sky_cells cells;
  int weight[8];
  float unit; /* 1 over the sum of the weights */
} sky_place;

/* surface: 1 on surfaces of a volume's matter, 0 in media. */
DEVICE sky_place place_in_sky(const sky_data *sky, vector position, float surface) {
  sky_place place;
  place.cells = cells_around(sky, position);
  place.unit = weigh_cells(sky, &place.cells, surface, place.weight);
  return place;
}

/* One harmonic of the light in one channel, as a sum over the cells. The caller multiplies it by `unit` and
 * by the number's unit. The sum is a sum of whole numbers. */
DEVICE float sum_of_harmonic(const sky_data *sky, const sky_place *place, int channel, int k) {
  const int at = SKY_PLACE(k * sky->plan->channels + channel);
  int sum = 0;
  for (int corner = 0; corner < 8; corner++)
    sum += (int)cell_at(&place->cells, corner)[at] * place->weight[corner];
  return (float)sum;
}

/* Finds the factors of the harmonics for a surface, as factors_of_surface() in field/lookup_lanes.h does. */
DEVICE void factors_of_surface(vector normal, float factors[FIELD_HARMONICS]) {
  const float first = (float)HARMONIC_1 * (2.0f / 3), second = (float)HARMONIC_2 * 0.25f;
  factors[0] = (float)HARMONIC_0;
  factors[1] = normal.x * first;
  factors[2] = normal.y * first;
  factors[3] = normal.z * first;
  factors[4] = normal.x * normal.y * second;
  factors[5] = normal.y * normal.z * second;
  factors[6] = normal.z * normal.x * second;
  factors[7] = fused(normal.z * normal.z, 3.0f, -1.0f) * ((float)HARMONIC_20 * 0.25f);
  factors[8] = (normal.x * normal.x - normal.y * normal.y) * ((float)HARMONIC_22 * 0.25f);
}

/* The light that a surface receives from the sky: 1 / pi times the integral of light and cosine. hidden:
 * whether matter may hide the sky; then `place` is set. */
DEVICE float light_of_surface(const sky_data *sky, const sky_place *place, int hidden, const float *factors,
                              int channel) {
  float sum = 0.0f;
  for (int k = 0; k < FIELD_HARMONICS; k++) {
    if (hidden) sum = sum + sum_of_harmonic(sky, place, channel, k) * factors[k];
    else sum = fused(factors[k], sky->plan->open[channel][k], sum);
  }
  return greater(hidden ? sum * (place->unit * sky->plan->stored_unit[channel]) : sum, 0.0f);
}

DEVICE float harmonic_at(const sky_data *sky, const sky_place *place, int hidden, int channel, int k) {
  return hidden ? sum_of_harmonic(sky, place, channel, k) * (place->unit * sky->plan->stored_unit[channel])
                : sky->plan->open[channel][k];
}

#if PHASES

DEVICE float second_degree(const float light[FIELD_HARMONICS], vector d) {
  return (light[4] * d.x * d.y + light[5] * d.y * d.z + light[6] * d.z * d.x) * (float)HARMONIC_2 +
         light[7] * fused(d.z * d.z, 3.0f, -1.0f) * (float)HARMONIC_20 +
         light[8] * (d.x * d.x - d.y * d.y) * (float)HARMONIC_22;
}

/* As sky_cap in render/sky_phase_lanes.h. */
typedef struct sky_cap {
  float even, more, cosine;
  vector middle;
} sky_cap;

DEVICE sky_cap cap_of_sky(const float light[FIELD_HARMONICS]) {
  const float mean = light[0] * (float)HARMONIC_0, least = 1e-12f;
  const vector flux = scaled(vector_of(light[1], light[2], light[3]), (float)HARMONIC_1 / 3);
  const float size = greater(root(dot3(flux, flux)), least), inverse = divided(1.0f, size);
  sky_cap cap;
  cap.middle = scaled(flux, inverse);
  const float of_all = divided(size * 2.0f, greater(mean, least)) - 1.0f;
  const float ratio = second_degree(light, cap.middle) * 0.2f * inverse;
  cap.cosine = limited(greater(ratio, of_all), -1.0f, 1.0f);
  cap.more = lesser(divided(size * 2.0f, greater(cap.cosine + 1.0f, 1e-6f)), mean);
  cap.even = mean - cap.more;
  return cap;
}

/* The light that a medium receives from the sky and scatters unevenly, as in render/sky_phase_lanes.h.
 * onwards: the direction of the eye's ray. hidden: whether matter may hide the sky; then `place` is set. */
DEVICE float light_of_medium(const sky_data *sky, const sky_place *place, const phase_data *phases, float g,
                             vector onwards, int hidden, int channel) {
  const float size = magnitude(g), most = divided(1.0f, (1 - size) * (1 - size));
  float light[FIELD_HARMONICS];
  for (int k = 0; k < FIELD_HARMONICS; k++) light[k] = harmonic_at(sky, place, hidden, channel, k);
  const sky_cap cap = cap_of_sky(light);
  const float x = dot3(cap.middle, onwards);
  const phase_angle angle = phase_angle_at(g, -x);
  const float row = row_of_ratio(phases, fused(cap.cosine, -2 * size * most, (1 + size * size) * most));
  const float sum = fused(cap.more, mean_in_table(phases, row, &angle), cap.even);
  const float second = cap.more * cap.cosine * (cap.cosine + 1.0f) * fused(x * x, 3.75f, -1.25f);
  return greater(fused(second_degree(light, onwards) - second, g * g, sum), 0.0f);
}

#endif

/* The light that an evenly scattering medium receives from the sky. hidden: whether matter may hide the sky;
 * then `place` is set. */
DEVICE float light_of_even_medium(const sky_data *sky, const sky_place *place, int hidden, int channel) {
  return greater(harmonic_at(sky, place, hidden, channel, 0) * (float)HARMONIC_0, 0.0f);
}

/* ---- the light that a sample scatters ---- */

/* The length of the way along the normal from a sample to the outside of its surface, as way_to_outside() in
 * render/sky_lanes.h. */
DEVICE float way_to_outside(const volume_data *volume, const slab_sample *s) {
  const vector slope = scaled(s->slope, magnitude(volume->plan->scale));
  const float steepness = greater(root(dot3(slope, slope)), 1e-6f),
              seen = limited(coordinate_seen(s), 0.0f, PLAN_ENTRIES),
              outside = outside_table(volume->tables)[(int)seen],
              way = lesser(divided(magnitude(seen - outside), steepness),
                           MOST_TO_OUTSIDE * volume->plan->voxel);
  const float skin = skin_of_sample(s);
  return fused(way, 1.0f - skin, s->behind * skin * volume->plan->voxel);
}

/* The light of the sky that a sample sends to the eye, as a factor for each channel of its colour. It is the
 * same number that sky_of_volume() in render/sky_lanes.h finds. */
DEVICE vector sky_of_sample(const sky_data *sky, const volume_data *volume,
#if PHASES
                            const phase_data *phases,
#endif
                            const slab_sample *s) {
  GLOBAL const plan_volume *matter = volume->plan;
  const int hidden = matter->receives_shadow;
  const float in_cell = s->sums.extinction * (HALF_CELL * sky->plan->cell) * (1.0f - s->surface);
  float haze = 1.0f, factors[FIELD_HARMONICS], sent[3], on_surface = 0.0f, in_medium = 0.0f;
  sky_place place;
  vector position = s->position;
  if (s->surface > 0.0f)
    position = add_scaled(position, s->normal, (way_to_outside(volume, s) + sky->plan->lift) * s->surface);
  if (hidden) place = place_in_sky(sky, position, s->surface);
  factors_of_surface(s->normal, factors);
  for (int c = 0; c < 3; c++) {
    if (c < sky->plan->channels) {
      if (hidden && (c == 0 || matter->cast[c] != matter->cast[c - 1]))
        haze = exp_of_depth(in_cell * matter->cast[c]);
      on_surface = s->surface > 0.0f
                       ? light_of_surface(sky, &place, hidden, factors, c) * (matter->diffuse * s->surface)
                       : 0.0f;
#if PHASES
      const vector onwards = scaled(s->towards_eye, -1.0f);
      in_medium = (VOLUMES == 1 || matter->anisotropy != 0
                       ? light_of_medium(sky, &place, phases, matter->anisotropy, onwards, hidden, c)
                       : light_of_even_medium(sky, &place, hidden, c)) *
                  haze;
      if (!(s->surface < 1.0f)) in_medium = 0.0f;
#else
      in_medium = s->surface < 1.0f ? light_of_even_medium(sky, &place, hidden, c) * haze : 0.0f;
#endif
    }
    const float left = matter->absorbs ? in_medium * matter->albedo[c] : in_medium;
    sent[c] = fused(left, 1.0f - s->surface, on_surface) * sky->plan->color[c];
  }
  return vector_of(sent[0], sent[1], sent[2]);
}

#endif

#endif
