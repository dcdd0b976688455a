/* gpu/kernels/passing.h - finds the light that passes everything before a medium's sample, also near a face
 * of the volume's box or of a cut. The functions compute for one pixel the same numbers as
 * render/light_depth_lanes.h, render/before_slab_lanes.h and render/reaching_lanes.h for sixteen pixels. */
#ifndef HL_GPU_PASSING_H
#define HL_GPU_PASSING_H

#include "gpu/kernels/light.h"

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
  for (int i = 0; i < volume->light_cut_count; i++)
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
          reach = bounds_in_light(data, light)->margin[axis] + magnitude(row_of_vector(row, s->step_sheet));
    deep = deep && at - volume->low[axis] > reach && volume->high[axis] - at > reach;
  }
#if CUTS
  deep = deep &&
         is_far_from_cuts(data->cuts + light->first_cut, volume->light_cut_count, s->position, s->step_sheet);
#endif
  return deep;
}

/* Adds the depth of a volume's matter between the face and the slab. length: of the slab's part that the
 * volume covers. before: raised by these depths at the pixels around the sample. */
DEVICE void add_face(const volume_data *data, GLOBAL const plan_light *light, const slab_sample *s,
                     float length, vector towards, float path, const near_pixels *close_pixels,
                     float before[CHANNELS][NEAR_PIXELS], light_depths *depths) {
  GLOBAL const plan_volume *volume = data->plan;
  ways_around around;
  around.cuts = data->cuts + light->first_cut;
  around.cut_count = volume->light_cut_count;
  around.towards = towards;
  around.sample = s;
  around.close_pixels = close_pixels;
  float likely = find_faces(data, light, s, towards, close_pixels, around.faces);
  if (!(likely > 0.0f && s->sums.extinction > 0.0f)) return;
  float begin = s->part.begin, end = begin + s->part.length;
  float first = way_before(&around, 0.0f, 0.0f, begin - s->place, begin * path);
  float last = way_before(&around, 0.0f, 0.0f, end - s->place, end * path);
  depths->face = 1;
  depths->beside = greater(depths->beside, likely);
  float filled = lesser(divided(length, greater(s->part.length, 1e-6f)), 1.0f);
  float extinction = s->sums.extinction * likely * filled;
  float enter = BACK_TO_FRONT ? last : first, leave = BACK_TO_FRONT ? first : last;
  for (int c = 0; c < CHANNELS; c++) {
    float cast = extinction * volume->cast[c];
    float at_enter = lesser(cast * enter, DEEPEST), at_leave = lesser(cast * leave, DEEPEST);
    depths->before_enter[c] = depths->before_enter[c] + at_enter;
    depths->before_more[c] = depths->before_more[c] + at_leave - at_enter;
    for (int i = 0; i < NEAR_PIXELS; i++) {
      float way = way_before(&around, close_pixels->u[i], close_pixels->v[i], 0.0f, s->place * path);
      before[c][i] = before[c][i] + lesser(cast * way, DEEPEST);
    }
  }
}

/* Adds the depths of all volumes between the faces and the slab, as add_before() in
 * render/light_depth_lanes.h.
 */
DEVICE void add_before(float before[CHANNELS][NEAR_PIXELS], light_depths *depths) {
  float spread = 0.0f;
  for (int c = 0; c < CHANNELS; c++) {
    float least = before[c][0], most = before[c][0];
    for (int i = 1; i < NEAR_PIXELS; i++) {
      least = lesser(least, before[c][i]);
      most = greater(most, before[c][i]);
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

/* Depths of 0. */
DEVICE light_depths no_depths(void) {
  light_depths depths;
  for (int c = 0; c < CHANNELS; c++) depths.enter[c] = depths.more[c] = 0.0f;
#if BOXED
  depths.face = 0;
  depths.beside = 0.0f;
  for (int c = 0; c < CHANNELS; c++) {
    depths.before_enter[c] = depths.before_more[c] = 0.0f;
    for (int i = 0; i < NEAR_PIXELS; i++) depths.close[c][i] = 0.0f;
  }
#endif
  return depths;
}

/* The light that passes everything before a sample's slab, and the slab's own matter. depths: within the
 * slab, and between the faces and the slab. */
DEVICE void passing_depths(GLOBAL const plan_light *light, const slab_sample *s, const light_buffers *buffers,
                           const shadow_taps *taps, light_depths *depths, float passing[CHANNELS]) {
#if SUBLIGHTS
  float mean[CHANNELS];
  if (light->sublights > 0) mean_of_sublights(light, buffers, s->position, 0, mean);
#endif
  for (int c = 0; c < CHANNELS; c++) {
    GLOBAL const float *plane = buffers->planes + c * light->plane + light->origin;
    float reached;
#if SUBLIGHTS && BOXED
    if (light->sublights > 0) reached = depths->face ? corrected_at_face(depths, c, mean[c]) : mean[c];
    else
#elif SUBLIGHTS
    if (light->sublights > 0) reached = mean[c];
    else
#endif
#if BOXED
      reached = depths->face ? reaching_face(light, taps, depths, c, plane, buffers->young)
                             : faded(light, taps, light->cubic, plane, buffers->young);
#else
      reached = faded(light, taps, light->cubic, plane, buffers->young);
#endif
    float own = own_transmittance(s->depth, s->left, depths->enter[c], depths->more[c]);
    passing[c] = lesser(reached * own, 1.0f);
  }
}

/* The light's transmittance to the sample in each channel, as a mean over the slab's matter in which matter
 * counts as much as the eye sees of it. */
DEVICE void passing_light(const volume_data *volume, vector normal, GLOBAL const plan_light *light,
                          const slab_sample *s, vector towards, float path, const light_buffers *buffers,
                          float passing[CHANNELS]) {
  shadow_taps taps = taps_of_position(light, s->position);
  light_depths depths = no_depths();
  light_ways ways;
  ways.first = s->part.begin * path;
  ways.last = (s->part.begin + s->part.length) * path;
#if BOXED
  const int deep = is_deep(volume, light, s);
  if (!deep)
    ways = ways_in_box(volume, light, add_scaled(s->start, s->step_sheet, s->part.begin),
                       scaled(s->step_sheet, s->part.length), towards, ways);
#else
  (void)normal;
#endif
  float length = greater(ways.last, ways.first) - ways.first;
  float extinction = extinction_towards(volume, s, towards, fused(length, s->seen, ways.first));
#if BOXED
  if (!light->nearest && !deep) {
    float before[CHANNELS][NEAR_PIXELS];
    for (int i = 0; i < CHANNELS * NEAR_PIXELS; i++) before[i / NEAR_PIXELS][i % NEAR_PIXELS] = 0.0f;
    near_pixels close_pixels = pixels_around(light, buffers, &taps, normal, s->position);
    add_face(volume, light, s, s->part.length, towards, path, &close_pixels, before, &depths);
    if (depths.face) add_before(before, &depths);
  }
#endif
  for (int c = 0; c < CHANNELS; c++) {
    float cast = extinction * volume->plan->cast[c], first = cast * ways.first,
          last = greater(cast * ways.last, first);
    depths.enter[c] = BACK_TO_FRONT ? last : first;
    depths.more[c] = BACK_TO_FRONT ? first - last : last - first;
  }
  passing_depths(light, s, buffers, &taps, &depths, passing);
}

#endif
