/* gpu/kernels/light.h - finds the light that reaches a sample. The shadow buffer is read at the sample's
 * position, and the slab's own matter absorbs a part of the light. The functions serve one pixel and one
 * volume that is a medium. They compute the same numbers as render/reaching_lanes.h,
 * render/light_depth_lanes.h, render/before_slab_lanes.h and shadow/shadow_lookup_lanes.h for sixteen pixels
 * and several volumes. */
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
  if (light->cut_count > 0) {
    GLOBAL const plan_cut *cuts = data->cuts + light->first_cut;
    way_left first, last;
    first.enter = enter_first;
    first.leave = leave_first;
    last.enter = enter_last;
    last.leave = leave_last;
    ways.first = length_left(cuts, light->cut_count, start, towards, first);
    ways.last = length_left(cuts, light->cut_count, add(start, way), towards, last);
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
  late = late * s->factor;
#endif
  return late * sums.extinction;
}

typedef struct light_depths {
  float enter[CHANNELS], more[CHANNELS];
#if BOXED
  float close[CHANNELS][NEAR_PIXELS]; /* the optical depths from the face to each of the pixels around the
                                       * sample */
  int face;                           /* whether the sample is near a face of the box */
  float beside;                       /* the face's weight in the light at the sample, 0 to 1 */
  float before_enter[CHANNELS], before_more[CHANNELS];
#endif
} light_depths;

#if BOXED

/* ---- near a face of the box ---- */

typedef struct near_pixels {
  float u[NEAR_PIXELS], v[NEAR_PIXELS];
  vector along_u, along_v;
} near_pixels;

/* Finds the pixels around a sample and the steps to them. Four pixels stand for those of all sub-lights, as
 * in render/before_slab_lanes.h. */
DEVICE near_pixels pixels_around(GLOBAL const plan_light *light, const light_buffers *buffers,
                                 const shadow_taps *taps, vector normal, vector position) {
  GLOBAL const float(*map)[4] = light->map;
  near_pixels close;
  for (int i = 0; i < NEAR_PIXELS; i++) {
    close.u[i] = (float)(i % 2) - taps->fx;
    close.v[i] = (float)(i / 2) - taps->fy;
  }
#if SUBLIGHTS
  if (light->sublights > 0) {
    map = buffers->sublights[0].map;
    for (int i = 0; i < NEAR_PIXELS; i++) {
      close.u[i] = i % 2 ? SUBLIGHT_SPREAD : -SUBLIGHT_SPREAD;
      close.v[i] = i / 2 ? SUBLIGHT_SPREAD : -SUBLIGHT_SPREAD;
    }
  }
#else
  (void)buffers;
#endif
  vector gradient_u = vector_at(map[1]), gradient_v = vector_at(map[2]);
  if (!light->parallel) {
    float ahead = row_of_point(map[0], position), inverse = divided(1.0f, ahead > 0.0f ? ahead : 1.0f);
    float u = row_of_point(map[1], position) * inverse, v = row_of_point(map[2], position) * inverse;
    gradient_u = scaled(add_scaled(gradient_u, vector_at(map[0]), -u), inverse);
    gradient_v = scaled(add_scaled(gradient_v, vector_at(map[0]), -v), inverse);
  }
  vector along_u = cross3(gradient_v, normal), along_v = cross3(normal, gradient_u);
  float rise = dot3(gradient_u, along_u), inverse = divided(1.0f, rise == 0.0f ? 1.0f : rise);
  close.along_u = scaled(along_u, inverse);
  close.along_v = scaled(along_v, inverse);
  return close;
}

typedef struct faces_of_axis {
  float ahead, behind, u, v, along;
} faces_of_axis;

/* Finds the distances of a face of a cut, as find_faces() does for the faces of the box. The cut's face
 * counts as flat: as the plane that touches it where the light's ray meets it. */
DEVICE float face_of_cut(GLOBAL const plan_cut *cut, vector position, vector towards,
                         const near_pixels *close_pixels, float through) {
  const ray_section way = cross_cut(cut, position, towards);
  float ahead = cut->keep_inside ? way.last : way.first;
  if (!(way.first < way.last && way.last > 0.0f && ahead < 1e20f)) return 0.0f;
  ahead = greater(ahead, 0.0f);
  const vector gradient = gradient_over_cut(cut, add_scaled(position, towards, ahead));
  const float slowness = divided(1.0f, some_speed(dot3(gradient, towards)));
  const float reach = (magnitude(dot3(gradient, close_pixels->along_u)) +
                       magnitude(dot3(gradient, close_pixels->along_v))) *
                      magnitude(slowness);
  const float close = limited(2.0f - divided(ahead, greater(reach, 1e-30f)), 0.0f, 1.0f);
  return close * limited(2.0f - divided(reach, through), 0.0f, 1.0f);
}

DEVICE float find_faces(const volume_data *data, GLOBAL const plan_light *light, const slab_sample *s,
                        vector towards, const near_pixels *close_pixels, faces_of_axis faces[3]) {
  GLOBAL const plan_volume *volume = data->plan;
  float close[3], reach[3], longest = 1e30f, likely = 0.0f;
  for (int axis = 0; axis < 3; axis++) {
    GLOBAL const float *row = volume->to_index[axis];
    float speed = row_of_vector(row, towards);
    if (magnitude(speed) < 1e-12f) speed = 1e-12f;
    float slowness = divided(1.0f, speed), at = row_of_point(row, s->position);
    int rising = speed > 0.0f;
    float low = volume->face_low[axis], high = volume->face_high[axis];
    faces[axis].ahead = ((rising ? high : low) - at) * slowness;
    faces[axis].behind = ((rising ? low : high) - at) * slowness;
    faces[axis].u = row_of_vector(row, close_pixels->along_u) * slowness;
    faces[axis].v = row_of_vector(row, close_pixels->along_v) * slowness;
    faces[axis].along = row_of_vector(row, s->step_sheet) * slowness;
    reach[axis] = magnitude(faces[axis].u) + magnitude(faces[axis].v);
    close[axis] = limited(2.0f - divided(faces[axis].ahead, greater(reach[axis], 1e-30f)), 0.0f, 1.0f);
    likely = greater(likely, close[axis]);
    longest = lesser(longest, (volume->high[axis] - volume->low[axis]) * magnitude(slowness));
  }
  float through = longest * ALONG_FACE;
  if (likely > 0.0f) {
    likely = 0.0f;
    for (int axis = 0; axis < 3; axis++)
      likely = greater(likely, close[axis] * limited(2.0f - divided(reach[axis], through), 0.0f, 1.0f));
  }
#if CUTS
  for (int i = 0; i < light->cut_count; i++)
    likely = greater(
        likely, face_of_cut(&data->cuts[light->first_cut + i], s->position, towards, close_pixels, through));
#else
  (void)light;
#endif
  return likely;
}

/* A light's ways before the slab, to points around a sample. */
typedef struct ways_around {
  faces_of_axis faces[3];
  GLOBAL const plan_cut *cuts; /* [cut_count] */
  int cut_count;
  vector towards;
  const slab_sample *sample;
  const near_pixels *close_pixels;
} ways_around;

/* The length of that part of the light's way, before the slab, to a point that the box and cuts leave. The
 * point lies u and v pixels of the buffer and `along` sheets away from the sample. within: the length of the
 * light's way from the slab's first sheet to the point. */
DEVICE float way_before(const ways_around *around, float u, float v, float along, float within) {
  way_left left;
  left.leave = 1e30f;
  left.enter = within;
  for (int axis = 0; axis < 3; axis++) {
    const faces_of_axis *f = &around->faces[axis];
    float less = fused(f->u, u, fused(f->v, v, f->along * along));
    left.leave = lesser(left.leave, f->ahead - less);
    left.enter = greater(left.enter, f->behind - less);
  }
#if CUTS
  vector at = add_scaled(around->sample->position, around->close_pixels->along_u, u);
  at = add_scaled(add_scaled(at, around->close_pixels->along_v, v), around->sample->step_sheet, along);
  shorten_way(around->cuts, around->cut_count, at, around->towards, &left);
#endif
  return greater(left.leave - left.enter, 0.0f);
}

/* Returns whether a sample is so far from the faces of the box and of cuts that no face changes the light's
 * ways to it and to the pixels around it. */
DEVICE int is_deep(const volume_data *data, GLOBAL const plan_light *light, const slab_sample *s) {
  GLOBAL const plan_volume *volume = data->plan;
  int deep = 1;
  for (int axis = 0; axis < 3; axis++) {
    GLOBAL const float *row = volume->to_index[axis];
    float at = row_of_point(row, s->position),
          reach = light->margin[axis] + magnitude(row_of_vector(row, s->step_sheet));
    deep = deep && at - volume->low[axis] > reach && volume->high[axis] - at > reach;
  }
#if CUTS
  deep = deep &&
         is_far_from_cuts(data->cuts + light->first_cut, light->cut_count, s->position, s->step_sheet);
#endif
  return deep;
}

/* Adds the depth of the volume's matter between the face and the slab. */
DEVICE void add_face(const volume_data *data, GLOBAL const plan_light *light, const slab_sample *s,
                     vector towards, float path, const near_pixels *close_pixels, light_depths *depths) {
  GLOBAL const plan_volume *volume = data->plan;
  ways_around around;
  around.cuts = data->cuts + light->first_cut;
  around.cut_count = light->cut_count;
  around.towards = towards;
  around.sample = s;
  around.close_pixels = close_pixels;
  float likely = find_faces(data, light, s, towards, close_pixels, around.faces);
  if (!(likely > 0.0f && s->sums.extinction > 0.0f)) return;
  float begin = s->part.begin, end = begin + s->part.length, before[CHANNELS][NEAR_PIXELS];
  float first = way_before(&around, 0.0f, 0.0f, begin - s->place, begin * path);
  float last = way_before(&around, 0.0f, 0.0f, end - s->place, end * path);
  depths->face = 1;
  depths->beside = greater(depths->beside, likely);
  float filled = lesser(divided(s->part.length, greater(s->part.length, 1e-6f)), 1.0f);
  float extinction = s->sums.extinction * likely * filled, spread = 0.0f;
  float enter = BACK_TO_FRONT ? last : first, leave = BACK_TO_FRONT ? first : last;
  for (int c = 0; c < CHANNELS; c++) {
    float cast = extinction * volume->cast[c];
    float at_enter = lesser(cast * enter, DEEPEST), at_leave = lesser(cast * leave, DEEPEST);
    depths->before_enter[c] = at_enter;
    depths->before_more[c] = at_leave - at_enter;
    float least = 0.0f, most = 0.0f;
    for (int i = 0; i < NEAR_PIXELS; i++) {
      float way = way_before(&around, close_pixels->u[i], close_pixels->v[i], 0.0f, s->place * path);
      before[c][i] = lesser(cast * way, DEEPEST);
      least = i == 0 ? before[c][i] : lesser(least, before[c][i]);
      most = i == 0 ? before[c][i] : greater(most, before[c][i]);
    }
    spread = greater(spread, most - least);
  }
  float counts = limited((spread - EVEN_LIGHT) * (1.0f / EVEN_LIGHT), 0.0f, 1.0f);
  depths->face = counts > 0.0f;
  depths->beside = depths->beside * counts;
  for (int c = 0; c < CHANNELS; c++) {
    depths->before_enter[c] = depths->before_enter[c] * counts;
    depths->before_more[c] = depths->before_more[c] * counts;
    for (int i = 0; i < NEAR_PIXELS; i++)
      depths->close[c][i] = fused(before[c][i], counts, depths->close[c][i]);
  }
}

/* Adds the optical depth from the face to the slab to the depths within the slab. found: the transmittance in
 * the buffer. own: the transmittance as it would be if the matter behind the face were even and nothing else
 * were in the light's way. The depth is scaled by log(found) / log(own). */
DEVICE void pass_face(light_depths *depths, int channel, float found, float own) {
  float ratio = 1.0f;
  if (own < 0.999f)
    ratio = lesser(divided(log_of_two(limited(found, 1e-6f, 1.0f)), log_of_two(limited(own, 1e-36f, 0.999f))),
                   1.0f);
  depths->enter[channel] = fused(ratio, depths->before_enter[channel], depths->enter[channel]);
  depths->more[channel] = fused(ratio, depths->before_more[channel], depths->more[channel]);
}

/* The light that reaches the slab near a face. */
DEVICE float reaching_face(GLOBAL const plan_light *light, const shadow_taps *taps, light_depths *depths,
                           int channel, GLOBAL const float *plane, float young) {
  GLOBAL const float *at = first_tap(light, taps, plane);
  float own[NEAR_PIXELS], found[NEAR_PIXELS];
  for (int i = 0; i < NEAR_PIXELS; i++) {
    own[i] = exp_of_depth(depths->close[channel][i]);
    found[i] = at[i / 2 * light->stride + i % 2];
#if SOFT
    if (light->soft)
      found[i] = between_chunks(at[OLDER_PLANE * light->plane + i / 2 * light->stride + i % 2], found[i],
                                young);
#endif
  }
  float sum = between_taps(taps, found[0], found[1], found[2], found[3]);
  float of_own = between_taps(taps, own[0], own[1], own[2], own[3]);
  pass_face(depths, channel, sum, of_own);
  of_own = greater(of_own, DARK);
  float reached = lesser(divided(sum, greater(of_own, 1e-6f)), 1.0f);
  reached = taps->inside ? reached : 1.0f;
  if (light->cubic && depths->beside < 1.0f) {
    float differ = faded(light, taps, 1, plane, young) - faded(light, taps, 0, plane, young);
    reached = greater(reached + differ * (1.0f - depths->beside), 0.0f);
  }
  return reached;
}

#if SUBLIGHTS

/* Corrects the mean of sub-lights near a face, as correct_faces() in render/reaching_lanes.h. */
DEVICE float corrected_at_face(light_depths *depths, int channel, float reached) {
  float own = 0.0f;
  for (int i = 0; i < NEAR_PIXELS; i++) own = own + exp_of_depth(depths->close[channel][i]);
  own = own * (1.0f / NEAR_PIXELS);
  pass_face(depths, channel, reached, own);
  return lesser(divided(reached, greater(own, 1e-6f)), 1.0f);
}

#endif

#endif

/* The light's transmittance to the sample in each channel, as a mean over the slab's matter in which matter
 * counts as much as the eye sees of it. */
DEVICE void passing_light(const volume_data *volume, vector normal, GLOBAL const plan_light *light,
                          const slab_sample *s, vector towards, float path, const light_buffers *buffers,
                          float passing[CHANNELS]) {
  shadow_taps taps = taps_of_position(light, s->position);
  light_depths depths;
  light_ways ways;
  ways.first = s->part.begin * path;
  ways.last = (s->part.begin + s->part.length) * path;
#if BOXED
  const int deep = is_deep(volume, light, s);
  if (!deep)
    ways = ways_in_box(volume, light, add_scaled(s->start, s->step_sheet, s->part.begin),
                       scaled(s->step_sheet, s->part.length), towards, ways);
  depths.face = 0;
  depths.beside = 0.0f;
  for (int c = 0; c < CHANNELS; c++) {
    depths.before_enter[c] = depths.before_more[c] = depths.enter[c] = depths.more[c] = 0.0f;
    for (int i = 0; i < NEAR_PIXELS; i++) depths.close[c][i] = 0.0f;
  }
#else
  (void)normal;
#endif
  float length = greater(ways.last, ways.first) - ways.first;
  float extinction = extinction_towards(volume, s, towards, fused(length, s->seen, ways.first));
#if BOXED
  if (!light->nearest && !deep) {
    near_pixels close_pixels = pixels_around(light, buffers, &taps, normal, s->position);
    add_face(volume, light, s, towards, path, &close_pixels, &depths);
  }
#endif
  for (int c = 0; c < CHANNELS; c++) {
    float cast = extinction * volume->plan->cast[c], first = cast * ways.first,
          last = greater(cast * ways.last, first);
    depths.enter[c] = BACK_TO_FRONT ? last : first;
    depths.more[c] = BACK_TO_FRONT ? first - last : last - first;
  }
#if SUBLIGHTS
  float mean[CHANNELS];
  if (light->sublights > 0) mean_of_sublights(light, buffers, s->position, 0, mean);
#endif
  for (int c = 0; c < CHANNELS; c++) {
    GLOBAL const float *plane = buffers->planes + c * light->plane + light->origin;
    float reached;
#if SUBLIGHTS && BOXED
    if (light->sublights > 0) reached = depths.face ? corrected_at_face(&depths, c, mean[c]) : mean[c];
    else
#elif SUBLIGHTS
    if (light->sublights > 0) reached = mean[c];
    else
#endif
#if BOXED
      reached = depths.face ? reaching_face(light, &taps, &depths, c, plane, buffers->young)
                            : faded(light, &taps, light->cubic, plane, buffers->young);
#else
      reached = faded(light, &taps, light->cubic, plane, buffers->young);
#endif
    float own = own_transmittance(s->depth, s->left, depths.enter[c], depths.more[c]);
    passing[c] = lesser(reached * own, 1.0f);
  }
}

#endif
