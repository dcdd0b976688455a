/* gpu/kernels/light.h - looks up shadow buffers at samples, and finds the light's ways through a volume
 * within a slab. The functions serve one pixel and one volume. They compute the same numbers as
 * render/reaching_lanes.h, render/light_depth_lanes.h and shadow/shadow_lookup_lanes.h for sixteen pixels. */
#ifndef HL_GPU_LIGHT_H
#define HL_GPU_LIGHT_H

#include "core/sheet_constants.h"
#include "gpu/kernels/matter.h"

/* Number of planes of one sheet in a light's buffer, and the first of the planes from which samples fade. */
#define PLANES_OF_SHEET (CHANNELS * (1 + OUTSIDE + SOFT))
#define OLDER_PLANE     (CHANNELS * (1 + OUTSIDE))

/* A pixel's way through a slab, and where its matter is seen. */
typedef struct slab_sample {
  vector position, start, step_sheet, towards_eye;
  float path; /* length of the eye's ray through the slab */
  covered_span part;
  float place;         /* the place at which the eye sees the slab's matter, as a fraction of the way through
                        * the slab */
  float before, after; /* coordinates in the tables */
  way_sums sums;
  float extinction, depth, left, opacity;
  float seen, evenly; /* seen: where the matter is seen; evenly: where it would be seen if its extinction were
                       * even; both are fractions of the way through the slab's covered part */
  int sloped;
  vector slope, normal;
  float factor; /* the factor (matter_factor) that has multiplied extinction and the sums */
  float row;    /* as in matter_factor */
  float surface;
  /* the distance, in voxels, between the matter and a face that cuts the matter and is shaded as a surface;
   * FACE_VOXELS if no such face is near */
  float behind;
} slab_sample;

/* The buffers of a light that a slab's samples look up. */
typedef struct light_buffers {
  GLOBAL const float *planes; /* the planes of the sheet before the slab */
  float young;                /* as in plan_rays */
#if SUBLIGHTS
  GLOBAL const plan_sublight *sublights; /* [sublights] */
  GLOBAL const word16 *of_sublights;     /* the sub-lights' planes of the sheet before the slab */
#endif
#if TEXTURES
  GLOBAL const plan_texture *textures; /* [lights]; the images that lights project */
#endif
} light_buffers;

/* ---- the buffer's pixels around a sample ---- */

typedef struct shadow_taps {
  int inside, column, row;
  float fx, fy;
} shadow_taps;

/* map: the map of the light's buffer, or of a sub-light's; width, height: the buffer's size. */
DEVICE shadow_taps taps_in_map(GLOBAL const plan_light *light, GLOBAL const float map[3][4], int width,
                               int height, vector position) {
  float u = row_of_point(map[1], position), v = row_of_point(map[2], position);
  if (!light->parallel) {
    float ahead = row_of_point(map[0], position);
    u = ahead > 0.0f ? divided(u, ahead) : -1.0f;
    v = ahead > 0.0f ? divided(v, ahead) : -1.0f;
  }
  shadow_taps taps;
  taps.inside = u > 0.0f && v > 0.0f && u < (float)width && v < (float)height;
  float x = limited(u - 0.5f, 0.0f, (float)(width - 1)), y = limited(v - 0.5f, 0.0f, (float)(height - 1));
  if (light->nearest) {
    x = (float)(int)(x + 0.5f);
    y = (float)(int)(y + 0.5f);
  }
  taps.column = (int)x;
  taps.row = (int)y;
  taps.fx = x - (float)taps.column;
  taps.fy = y - (float)taps.row;
  return taps;
}

DEVICE shadow_taps taps_of_position(GLOBAL const plan_light *light, vector position) {
  return taps_in_map(light, light->map, light->width, light->height, position);
}

/* Interpolates between four pixels: a and b in one row, c and d below them in the next row. Outside the
 * buffer the result is 1. */
DEVICE float between_taps(const shadow_taps *taps, float a, float b, float c, float d) {
  float top = fused(b - a, taps->fx, a), bottom = fused(d - c, taps->fx, c);
  return taps->inside ? fused(bottom - top, taps->fy, top) : 1.0f;
}

/* The index, in a plane, of the first of the four pixels around a sample. */
DEVICE GLOBAL const float *first_tap(GLOBAL const plan_light *light, const shadow_taps *taps,
                                     GLOBAL const float *plane) {
  return plane + taps->row * light->stride + taps->column;
}

DEVICE float look_up(GLOBAL const plan_light *light, const shadow_taps *taps, GLOBAL const float *plane) {
  GLOBAL const float *at = first_tap(light, taps, plane), *below = at + light->stride;
  return between_taps(taps, at[0], at[1], below[0], below[1]);
}

/* The greatest of the four pixels around a place. */
DEVICE float greatest_tap(GLOBAL const plan_light *light, const shadow_taps *taps,
                          GLOBAL const float *plane) {
  GLOBAL const float *at = first_tap(light, taps, plane), *below = at + light->stride;
  return taps->inside ? greater(greater(at[0], at[1]), greater(below[0], below[1])) : 1.0f;
}

DEVICE void cubic_weights(float way, float weight[4]) {
  float rest = 1.0f - way, both = way * rest * -0.5f;
  weight[0] = both * rest;
  weight[1] = fused(way * way, fused(way, 1.5f, -2.5f), 1.0f);
  weight[2] = fused(rest * rest, fused(rest, 1.5f, -2.5f), 1.0f);
  weight[3] = both * way;
}

DEVICE float look_up_cubic(GLOBAL const plan_light *light, const shadow_taps *taps,
                           GLOBAL const float *plane) {
  float across[4], down[4], sum = 0.0f, least = 1.0f, greatest = 0.0f;
  cubic_weights(taps->fx, across);
  cubic_weights(taps->fy, down);
  GLOBAL const float *at = first_tap(light, taps, plane) - light->stride - 1;
  for (int y = 0; y < 4; y++, at += light->stride) {
    float along = at[0] * across[0];
    for (int x = 1; x < 4; x++) along = fused(at[x], across[x], along);
    sum = fused(along, down[y], sum);
    if (y == 0 || y == 3) continue;
    least = lesser(least, lesser(at[1], at[2]));
    greatest = greater(greatest, greater(at[1], at[2]));
  }
  return taps->inside ? lesser(greater(sum, least), greatest) : 1.0f;
}

DEVICE float interpolated(GLOBAL const plan_light *light, const shadow_taps *taps, int cubic,
                          GLOBAL const float *plane) {
  return cubic ? look_up_cubic(light, taps, plane) : look_up(light, taps, plane);
}

/* Interpolates between the light of two chunks, as between_chunks() in render/reaching_lanes.h does. */
DEVICE float between_chunks(float older, float younger, float young) {
  return fused(younger - older, young, older);
}

/* The transmittance that a sample gets from a light's buffer. plane: the plane of the transmittance. young:
 * as in plan_rays. */
DEVICE float faded(GLOBAL const plan_light *light, const shadow_taps *taps, int cubic,
                   GLOBAL const float *plane, float young) {
  const float younger = interpolated(light, taps, cubic, plane);
#if SOFT
  if (light->soft)
    return between_chunks(interpolated(light, taps, cubic, plane + OLDER_PLANE * light->plane), younger,
                          young);
#endif
  (void)young;
  return younger;
}

#if SUBLIGHTS

/* The mean over a light's sub-lights. kind: 0 for the transmittance, 1 for the light at the outside of
 * surfaces. */
DEVICE void mean_of_sublights(GLOBAL const plan_light *light, const light_buffers *buffers, vector position,
                              int kind, float mean[CHANNELS]) {
  for (int c = 0; c < CHANNELS; c++) mean[c] = 0.0f;
  for (int i = 0; i < light->sublights; i++) {
    GLOBAL const plan_sublight *sublight = buffers->sublights + i;
    const shadow_taps taps = taps_in_map(light, sublight->map, sublight->width, sublight->height, position);
    for (int c = 0; c < CHANNELS; c++) {
      GLOBAL const word16 *at = buffers->of_sublights +
                                ((wide)i * PLANES_OF_SHEET + (wide)(kind * CHANNELS + c)) *
                                    (wide)light->sublight_plane +
                                taps.row * light->sublight_stride + taps.column;
      GLOBAL const word16 *below = at + light->sublight_stride;
      const float between = between_taps(&taps, (float)at[0], (float)at[1], (float)below[0], (float)below[1]);
      const float passing = taps.inside ? between : (float)SUBLIGHT_ONE;
#if EMISSIONS
      mean[c] = fused(passing, sublight->weight[c], mean[c]);
#else
      mean[c] = mean[c] + passing;
#endif
    }
  }
  for (int c = 0; c < CHANNELS; c++)
    mean[c] = divided(mean[c], (float)SUBLIGHT_ONE * (float)light->sublights);
}

#endif

/* ---- the light that the slab's own matter absorbs ---- */

/* exp(-x), also of negative x. */
DEVICE float exp_of_depth(float x) { return exp_negative(greater(x, -40.0f)); }

/* The value of (1 - exp(-x)) / x, given as numerator (over) and denominator (under). left: exp(-x). */
typedef struct mean_transmittance {
  float over, under;
} mean_transmittance;

DEVICE mean_transmittance transmittance_within(float x, float left) {
  mean_transmittance mean;
  int thin = x < 0.01f;
  mean.over = thin ? fused(-x, fused(x, -1.0f / 6, 0.5f), 1.0f) : 1.0f - left;
  mean.under = thin ? 1.0f : x;
  return mean;
}

DEVICE float own_transmittance(float e, float left, float enter, float more) {
  float sum = e + more, both = magnitude(sum);
  mean_transmittance of_both = transmittance_within(both, exp_negative(both)),
                     of_eye = transmittance_within(e, left);
  float seen = divided(of_both.over * of_eye.under, of_both.under * of_eye.over);
  return seen * exp_of_depth(enter + lesser(sum, 0.0f));
}

typedef struct light_ways {
  float first, last;
} light_ways;

/* The lengths of the light's ways from the slab's first sheet to the beginning and to the end of the slab's
 * covered part. Only the parts of the ways count that lie in the volume's box and that no cut removes. path:
 * the lengths of the complete ways. */
DEVICE light_ways ways_in_box(const volume_data *data, GLOBAL const plan_light *light, vector start,
                              vector way, vector towards, light_ways path) {
  GLOBAL const plan_volume *volume = data->plan;
  float leave_first = 1e30f, leave_last = 1e30f, enter_first = 0.0f, enter_last = 0.0f;
  for (int axis = 0; axis < 3; axis++) {
    GLOBAL const float *row = volume->to_index[axis];
    float at = row_of_point(row, start), along = row_of_vector(row, way), speed = row_of_vector(row, towards);
    if (magnitude(speed) < 1e-12f) speed = 1e-12f;
    float slowness = divided(1.0f, speed);
    int rising = speed > 0.0f;
    float ahead = ((rising ? volume->high[axis] : volume->low[axis]) - at) * slowness,
          behind = ((rising ? volume->low[axis] : volume->high[axis]) - at) * slowness;
    leave_first = lesser(leave_first, greater(ahead, 0.0f));
    leave_last = lesser(leave_last, greater(fused(-along, slowness, ahead), 0.0f));
    enter_first = greater(enter_first, behind);
    enter_last = greater(enter_last, fused(-along, slowness, behind));
  }
  light_ways ways;
  leave_first = lesser(path.first, leave_first);
  leave_last = lesser(path.last, leave_last);
#if CUTS
  if (volume->light_cut_count > 0) {
    GLOBAL const plan_cut *cuts = data->cuts + light->first_cut;
    way_left first, last;
    first.enter = enter_first;
    first.leave = leave_first;
    last.enter = enter_last;
    last.leave = leave_last;
    ways.first = length_left(cuts, volume->light_cut_count, start, towards, first);
    ways.last = length_left(cuts, volume->light_cut_count, add(start, way), towards, last);
    return ways;
  }
#else
  (void)light;
#endif
  ways.first = greater(leave_first - enter_first, 0.0f);
  ways.last = greater(leave_last - enter_last, 0.0f);
  return ways;
}

/* The fraction of a sample's matter that belongs to the face: 1 at the face, 0 two voxels behind it, as
 * skin_of_face() in render/slab_lanes.h. */
DEVICE float skin_of_sample(const slab_sample *s) { return limited(FACE_VOXELS - s->behind, 0.0f, 1.0f); }

DEVICE float coordinate_seen(const slab_sample *s) { return fused(s->after - s->before, s->seen, s->before); }

/* The even extinction that gives the light's way through the slab its right optical depth. */
DEVICE float extinction_towards(const volume_data *volume, const slab_sample *s, vector towards, float way) {
  if (!s->sloped) return s->sums.extinction;
  float late = lesser(divided(s->seen, greater(s->evenly, 1e-3f)), 4.0f), seen = coordinate_seen(s);
  float start = fused(dot3(s->slope, towards), way * volume->plan->scale, seen);
  way_sums sums = sums_of_way(volume->tables, split_coordinate(limited(start, 0.0f, PLAN_ENTRIES)),
                              split_coordinate(seen));
#if WEIGHED
  if (is_weighed(volume)) late = late * s->factor;
#endif
  return late * sums.extinction;
}

#endif
