/* render/light_depth_lanes.h - finds how much light the matter of a slab absorbs before the light reaches a
 * medium in the same slab (step 15, derived).
 *
 * The shadow buffer holds the light that reaches the slab's first sheet. From this sheet on, the absorbed
 * light follows from the sample's own densities and gradient. */
#ifndef HL_RENDER_LIGHT_DEPTH_LANES_H
#define HL_RENDER_LIGHT_DEPTH_LANES_H

#include "core/sheet_constants.h"
#include "render/before_slab_lanes.h"

typedef struct color_lanes {
  lanes c[3];
} color_lanes;

/* exp(-x). x may be negative; below -40 it counts as -40. */
LANES_INLINE lanes exp_of_depth(lanes x) { return lanes_exp_negative(lanes_max(x, lanes_set(-40.0f))); }

/* phi(x) = (1 - exp(-x)) / x: the mean of exp(-x s) over s in [0,1]. It is given as numerator (over) and
 * denominator (under). left: exp(-x). */
typedef struct mean_transmittance {
  lanes over, under;
} mean_transmittance;

LANES_INLINE mean_transmittance transmittance_within(lanes x, lanes left) {
  lanes near = lanes_fma(-x, lanes_line(x, -1.0f / 6, 0.5f), lanes_set(1.0f));
  lanes_int thin = x < 0.01f;
  return (mean_transmittance){lanes_select(thin, near, 1.0f - left), lanes_select(thin, lanes_set(1.0f), x)};
}

/* The light's transmittance within the slab, averaged over the slab's matter with the weights with which the
 * eye sees it. e: the slab's optical depth for the eye. left: exp(-e). enter: the light's optical depth where
 * the eye's ray enters the matter; more: the increase of this depth until the eye's ray leaves the matter.
 * Derived; exact for extinction that varies along one direction only: int e exp(-e s) exp(-enter - more s) ds
 * / (1 - exp(-e)) = exp(-enter) phi(e + more) / phi(e), with phi(-x) = exp(x) phi(x). */
LANES_INLINE lanes own_transmittance(lanes e, lanes left, lanes enter, lanes more) {
  lanes sum = e + more, both = lanes_abs(sum);
  mean_transmittance of_both = transmittance_within(both, lanes_exp_negative(both)),
                     of_eye = transmittance_within(e, left);
  lanes seen = of_both.over * of_eye.under / (of_both.under * of_eye.over);
  return seen * exp_of_depth(enter + lanes_min(sum, lanes_set(0)));
}

/* Lengths of the light's ways, within a volume's box, to the two points where a section of the eye's ray
 * begins and ends. path, in ways_of_light(): the lengths of the complete ways to these points from the slab's
 * first sheet, in the box and outside of it. */
typedef struct ways_in_box {
  lanes first, last;
} ways_in_box;

LANES_INLINE ways_in_box ways_of_light(const shade_volume *volume, lanes3 start, lanes3 way, lanes3 towards,
                                       ways_in_box path) {
  ways_in_box leave = {lanes_set(1e30f), lanes_set(1e30f)}, enter = {lanes_set(0), lanes_set(0)};
  for (int axis = 0; axis < 3; axis++) {
    const float *row = volume->to_index[axis];
    lanes at = row_of_point(row, start), step = row_of_vector(row, way), speed = row_of_vector(row, towards);
    speed = lanes_select(lanes_abs(speed) < 1e-12f, lanes_set(1e-12f), speed);
    lanes slowness = 1.0f / speed, low = lanes_set(volume->low[axis]), high = lanes_set(volume->high[axis]);
    lanes_int rising = speed > 0.0f;
    lanes far = (lanes_select(rising, high, low) - at) * slowness,
          near = (lanes_select(rising, low, high) - at) * slowness;
    leave.first = lanes_min(leave.first, lanes_max(far, lanes_set(0)));
    leave.last = lanes_min(leave.last, lanes_max(lanes_fma(-step, slowness, far), lanes_set(0)));
    enter.first = lanes_max(enter.first, near);
    enter.last = lanes_max(enter.last, lanes_fma(-step, slowness, near));
  }
  leave = (ways_in_box){lanes_min(path.first, leave.first), lanes_min(path.last, leave.last)};
  if (volume->light_cut_count > 0)
    return (ways_in_box){way_left(volume, start, towards, enter.first, leave.first),
                         way_left(volume, add3(start, way), towards, enter.last, leave.last)};
  return (ways_in_box){lanes_max(leave.first - enter.first, lanes_set(0)),
                       lanes_max(leave.last - enter.last, lanes_set(0))};
}

/* The coordinate, in the classifier's tables, of the density at the place where a volume's matter is seen. */
LANES_INLINE lanes coordinate_seen(const block_density *d) {
  return lanes_fma(d->after - d->before, d->seen, d->before);
}

/* Finds an even extinction for the light's way through the slab, as far as the point where a volume's matter
 * is seen: the extinction that gives this way the right optical depth (derived). The extinction along the
 * eye's ray would be wrong: the eye's ray may run along a surface that the light's ray crosses. Let f be the
 * density at the point, g the gradient, and l the direction to the light. At the distance s towards the
 * light, the density is then f - s g.l to first order. The mean extinction of these densities is the result
 * but for a factor. Even extinction would let the eye see the slab at another position (`evenly`); the factor
 * makes the optical depths of both positions equal. */
LANES_INLINE lanes extinction_towards(const block_density *d, lanes3 towards, lanes way) {
  const classifier *classifier = d->patch->volume->classifier;
  if (lanes_bits(d->sloped) == 0) return d->sums.extinction;
  lanes late = lanes_min(d->seen / lanes_max(d->evenly, lanes_set(1e-3f)), lanes_set(4.0f));
  lanes seen = coordinate_seen(d);
  lanes start = lanes_fma(dot3(d->slope, towards), way * classifier->scale, seen);
  way_sums sums = sums_of_way(classifier, split_coordinate(lanes_clamp(start, 0, CLASSIFIER_ENTRIES)),
                              split_coordinate(seen));
  if (hl_classifier_is_weighed(classifier)) late = late * d->factor;
  return lanes_select(d->sloped, late * sums.extinction, d->sums.extinction);
}

/* The lengths of the light's ways through all volumes, to the places where the slab's covered part begins and
 * ends. If several volumes share a slab, each volume absorbs light on the part of the way that lies in the
 * slab and in the volume's box, wherever the eye's ray passes. */
LANES_INLINE ways_in_box find_ways(const block_slab *slab, block_density *densities, int count,
                                   lanes3 towards, lanes path) {
  const block_geometry *g = &slab->geometry;
  ways_in_box all = {slab->part.begin * path, (slab->part.begin + slab->part.length) * path},
              sum = {lanes_set(0), lanes_set(0)};
  lanes3 start = add_scaled3(g->start, g->step_sheet, slab->part.begin),
         way = scale3(g->step_sheet, slab->part.length);
  for (int i = 0; i < count; i++) {
    block_density *d = &densities[i];
    if (!d->there) continue;
    int cut = d->patch->enter != NULL && !d->patch->uncut;
    ways_in_box own = cut ? ways_of_light(d->patch->volume, start, way, towards, all) : all;
    d->light_first = own.first;
    d->light_last = own.last;
    if (count == 1) return own;
    sum = (ways_in_box){sum.first + lanes_keep(d->here, own.first), sum.last + lanes_keep(d->here, own.last)};
  }
  return (ways_in_box){lanes_min(sum.first, all.first), lanes_min(sum.last, all.last)};
}

/* Optical depths for one light within a slab, counted from the slab's first sheet. */
typedef struct light_depths {
  /* enter: the optical depth to the point where the eye's ray enters the matter. more: the increase of the
   * depth until the eye's ray leaves the matter. */
  lanes enter[HL_CHANNELS], more[HL_CHANNELS];
  /* near a face: the optical depths of the light's ways from the face to each near pixel on the first
   * sheet */
  lanes near[HL_CHANNELS][NEAR_PIXELS];
  lanes_int face; /* the lanes that are near a face of a box */
  lanes beside;   /* near a face, the weight of the correction for the face, from 0 to 1 */
  /* near a face: the depths `enter` and `more` for the light's way before the slab; the other members are for
   * its way within the slab */
  lanes before_enter[HL_CHANNELS], before_more[HL_CHANNELS];
} light_depths;

/* Near a face of a volume's box: adds the optical depth of the volume's matter between the face and the slab.
 * before: raised by these depths at the near pixels. */
LANES_INLINE void add_face(const shade_job *job, const block_slab *slab, const block_density *d,
                           const seen_light *light, lanes before[HL_CHANNELS][NEAR_PIXELS],
                           light_depths *depths) {
  const shade_volume *volume = d->patch->volume;
  faces_of_axis faces[3];
  lanes likely = find_faces(volume, &slab->geometry, light->towards, light->near, faces);
  lanes_int there = (likely > 0.0f) & slab->seen & (d->sums.extinction > 0.0f);
  if (lanes_bits(there) == 0) return;
  ways_before ways = find_ways_before(volume, faces, slab, light);
  depths->face |= there;
  depths->beside = lanes_max(depths->beside, lanes_keep(there, likely));
  /* if several boxes meet in the slab, each volume fills only a part of it */
  lanes filled = lanes_min(d->way.part.length / lanes_max(slab->part.length, lanes_set(1e-6f)),
                           lanes_set(1.0f));
  lanes extinction = lanes_keep(there, d->sums.extinction * likely * filled);
  lanes enter = job->back_to_front ? ways.last : ways.first,
        leave = job->back_to_front ? ways.first : ways.last;
  for (int c = 0; c < job->channels; c++) {
    lanes cast = extinction * volume->cast[c], deepest = lanes_set(DEEPEST);
    lanes at_enter = lanes_min(cast * enter, deepest), at_leave = lanes_min(cast * leave, deepest);
    depths->before_enter[c] = depths->before_enter[c] + at_enter;
    depths->before_more[c] = depths->before_more[c] + at_leave - at_enter;
    for (int i = 0; i < NEAR_PIXELS; i++)
      before[c][i] = before[c][i] + lanes_min(cast * ways.near[i], deepest);
  }
}

/* Adds to depths->near the optical depths of the matter between the boxes' faces and the slab. Where these
 * depths hardly differ from pixel to pixel, the function adds only a part of them. before: the sums of these
 * depths over all volumes, at each near pixel. */
LANES_INLINE void add_before(int channels, lanes before[HL_CHANNELS][NEAR_PIXELS], light_depths *depths) {
  lanes spread = lanes_set(0);
  for (int c = 0; c < channels; c++) {
    lanes least = before[c][0], most = least;
    for (int i = 1; i < NEAR_PIXELS; i++) {
      least = lanes_min(least, before[c][i]);
      most = lanes_max(most, before[c][i]);
    }
    spread = lanes_max(spread, most - least);
  }
  lanes counts = lanes_clamp((spread - EVEN_LIGHT) * (1.0f / EVEN_LIGHT), 0, 1);
  depths->face = depths->face & (counts > 0.0f);
  depths->beside = depths->beside * counts;
  for (int c = 0; c < channels; c++) {
    depths->before_enter[c] = depths->before_enter[c] * counts;
    depths->before_more[c] = depths->before_more[c] * counts;
    for (int i = 0; i < NEAR_PIXELS; i++)
      depths->near[c][i] = lanes_fma(before[c][i], counts, depths->near[c][i]);
  }
}

/* Finds the optical depths of a slab for one light. light->near is null if no face of a volume's box can be
 * near the slab. */
LANES_INLINE light_depths depths_of_light(const shade_job *job, const block_slab *slab,
                                          block_density *densities, int count, const seen_light *light) {
  const lanes3 towards = light->towards;
  light_depths depths = {.face = lanes_set_int(0), .beside = lanes_set(0)};
  ways_in_box all = find_ways(slab, densities, count, towards, light->path);
  lanes length = lanes_max(all.last, all.first) - all.first;
  lanes first[HL_CHANNELS], last[HL_CHANNELS], before[HL_CHANNELS][NEAR_PIXELS];
  for (int c = 0; c < HL_CHANNELS; c++) {
    first[c] = last[c] = depths.before_enter[c] = depths.before_more[c] = lanes_set(0);
    for (int i = 0; i < NEAR_PIXELS; i++) depths.near[c][i] = before[c][i] = lanes_set(0);
  }
  for (int i = 0; i < count; i++) {
    const block_density *d = &densities[i];
    if (!d->there) continue;
    lanes way = lanes_fma(length, d->seen, all.first), extinction = extinction_towards(d, towards, way);
    if (light->near != NULL && d->patch->enter != NULL) add_face(job, slab, d, light, before, &depths);
    for (int c = 0; c < job->channels; c++) {
      lanes cast = extinction * d->patch->volume->cast[c];
      first[c] = lanes_fma(cast, d->light_first, first[c]);
      last[c] = lanes_fma(cast, d->light_last, last[c]);
    }
  }
  if (lanes_bits(depths.face) != 0) add_before(job->channels, before, &depths);
  for (int c = 0; c < job->channels; c++) {
    last[c] = lanes_max(last[c], first[c]);
    depths.enter[c] = job->back_to_front ? last[c] : first[c];
    depths.more[c] = job->back_to_front ? first[c] - last[c] : last[c] - first[c];
  }
  return depths;
}

#endif
