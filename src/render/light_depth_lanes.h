/* render/light_depth_lanes.h - the light that a slab's own matter absorbs before it reaches the lit position
 * (step 15, derived).
 *
 * The shadow buffer holds the light that reaches the slab's first sheet. From there on, the sample's own
 * densities and gradient tell how much is absorbed. Matter near a surface is taken to be a plane's: its
 * density f, in entries of the transfer function's table, falls by k per frame unit towards the light. Light
 * that has come to density f has passed the optical depth P(f) / k, P the integral of extinction over
 * entries. The depths at two positions in the plane's matter differ by (P(f1) - P(f2)) / k. */
#ifndef HL_RENDER_LIGHT_DEPTH_LANES_H
#define HL_RENDER_LIGHT_DEPTH_LANES_H

#include "render/before_slab_lanes.h"

typedef struct color_lanes {
  lanes c[3];
} color_lanes;

/* exp(-x), also of negative x: those below -40 are as -40. */
LANES_INLINE lanes exp_of_depth(lanes x) { return lanes_exp_negative(lanes_max(x, lanes_set(-40.0f))); }

/* phi(x) = (1 - exp(-x)) / x, the mean of exp(-x s) over s in [0,1], as numerator (over) and denominator
 * (under). left: exp(-x). */
typedef struct mean_transmittance {
  lanes over, under;
} mean_transmittance;

LANES_INLINE mean_transmittance transmittance_within(lanes x, lanes left) {
  lanes near = lanes_fma(-x, lanes_line(x, -1.0f / 6, 0.5f), lanes_set(1.0f));
  lanes_int thin = x < 0.01f;
  return (mean_transmittance){lanes_select(thin, near, 1.0f - left), lanes_select(thin, lanes_set(1.0f), x)};
}

/* The light's transmittance within the slab, averaged as the eye sees it. e: the slab's optical depth for the
 * eye; left: exp(-e). enter: the light's optical depth where the eye's ray enters the matter; more: what the
 * depth gains until the ray leaves. Derived; exact for extinction that varies along one direction only: int e
 * exp(-e s) exp(-enter - more s) ds / (1 - exp(-e)) = exp(-enter) phi(e + more) / phi(e), with phi(-x) =
 * exp(x) phi(x). */
LANES_INLINE lanes own_transmittance(lanes e, lanes left, lanes enter, lanes more) {
  lanes sum = e + more, both = lanes_abs(sum);
  mean_transmittance of_both = transmittance_within(both, lanes_exp_negative(both)),
                     of_eye = transmittance_within(e, left);
  lanes seen = of_both.over * of_eye.under / (of_both.under * of_eye.over);
  return seen * exp_of_depth(enter + lanes_min(sum, lanes_set(0)));
}

/* Lengths of the light's way within a volume's box, to where a section of the eye's ray begins and ends. In
 * ways_of_light(), path holds the two lengths from the slab's first sheet on, without a box. */
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

/* The density, as a coordinate in the table, where a volume's matter is seen. */
LANES_INLINE lanes coordinate_seen(const block_density *d) {
  return lanes_fma(d->after - d->before, d->seen, d->before);
}

/* The even extinction with which the light's way through the slab has the right optical depth down to where a
 * volume's matter is seen (derived). Needed because the eye's ray may run along a surface that the light's
 * ray crosses. At a distance s towards the light from the point seen, the density is f - s g.l to first
 * order, g the gradient; its mean extinction is the result, before a correction: with even extinction the eye
 * would see the slab at another position (`evenly`), and a factor makes the depths agree there. */
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

/* The light's ways through all volumes to where the slab's covered part starts and ends. Where several
 * volumes share a slab, each absorbs light on the part of its way that lies in the slab and in the volume's
 * own box, wherever the eye's ray passes. */
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
    sum = (ways_in_box){sum.first + own.first, sum.last + own.last};
  }
  return (ways_in_box){lanes_min(sum.first, all.first), lanes_min(sum.last, all.last)};
}

/* Optical depths of the slab for one light, from its first sheet on. */
typedef struct light_depths {
  lanes enter[HL_CHANNELS], more[HL_CHANNELS]; /* where the eye's rays enter the matter, and what the depth
                                                  gains until they leave it */
  lanes near[HL_CHANNELS][NEAR_PIXELS]; /* at the near pixels on the first sheet, minus the depth at the point
                                           through which the sample's own light comes */
  lanes_int plane;                      /* lanes where a plane's matter gives `near`; elsewhere it is 0 */
  lanes_int face; /* lanes near a face of a box; `near` then holds the whole depth from the face on */
  lanes beside;   /* near a face: how much the face counts, 0 to 1 */
  lanes before_enter[HL_CHANNELS], before_more[HL_CHANNELS]; /* near a face: like enter and more, but for the
                                                                light's way before the slab */
} light_depths;

/* A coordinate of the table, with the extinction and the integral there. */
typedef struct table_origin {
  lanes x, extinction, integral;
} table_origin;

LANES_INLINE table_origin origin_at(const classifier *classifier, lanes x) {
  table_coordinate place = split_coordinate(lanes_clamp(x, 0, CLASSIFIER_ENTRIES));
  lanes values[3];
  table_values(classifier->sums, place, values);
  return (table_origin){place.x, values[0], values[1]};
}

/* P(to) - P(from). */
LANES_INLINE lanes integral_between(const table_origin *from, const table_origin *to) {
  lanes distance = to->x - from->x;
  return lanes_select(lanes_abs(distance) > CLOSE_ENTRIES, to->integral - from->integral,
                      (to->extinction + from->extinction) * 0.5f * distance);
}

/* The plane's matter at the lit position. likely: how surely there is one, 0 to 1. */
typedef struct plane_matter {
  lanes likely;
  lanes3 slope;        /* entries per frame unit */
  lanes fall, inverse; /* k, entries per frame unit, and 1 / k */
  table_origin below;  /* where the light to the lit position enters the slab, or the box */
} plane_matter;

/* How deep below a surface, in voxels, matter counts fully as a plane's; at twice the depth it does not
 * count. The depth is measured by the gradient, from where visible values begin. Where light grazes the
 * surface it counts less: fully from a cosine of 0.2 on, not at all below 0.1. */
static const float SKIN_VOXELS = 2;

LANES_INLINE plane_matter plane_of(const block_density *d, lanes3 towards, lanes way) {
  const shade_volume *volume = d->patch->volume;
  const classifier *classifier = volume->classifier;
  plane_matter plane = {.likely = lanes_set(0)};
  lanes_int facing = d->sloped & (dot3(d->normal, towards) > 0.0f);
  if (!volume->phong || lanes_bits(facing) == 0) return plane;
  lanes seen = coordinate_seen(d), sense = lanes_set(1.0f);
  plane.slope = scale3(d->slope, lanes_set(classifier->scale));
  plane.fall = -dot3(plane.slope, towards);
  lanes a_voxel = lanes_sqrt(dot3(plane.slope, plane.slope)) * volume->voxel,
        least = lanes_abs(plane.fall) * volume->voxel;
  plane.inverse = lanes_select(plane.fall > 0.0f, sense, -sense) * volume->voxel /
                  lanes_max(least, lanes_set(1e-4f));
  lanes edge = lanes_select(plane.fall > 0.0f, lanes_set(classifier->first_visible),
                            lanes_set(classifier->last_visible));
  lanes deep = lanes_abs(seen - edge) / lanes_max(a_voxel, lanes_set(1e-6f));
  plane.likely = lanes_keep(facing, lanes_clamp(lanes_line(deep, -1.0f / SKIN_VOXELS, 2.0f), 0, 1));
  if (volume->cut_count > 0 || volume->clip_faces) plane.likely = plane.likely * (1.0f - d->skin);
  plane.likely = plane.likely * lanes_clamp((dot3(d->normal, towards) - 0.1f) * (1.0f / (0.2f - 0.1f)), 0, 1);
  plane.below = origin_at(classifier, lanes_fma(-plane.fall, way, seen));
  return plane;
}

/* The light's ways through all boxes to the ends of the eye's way. cut: lanes where a box's face makes a way
 * shorter than it is through the slab. */
typedef struct light_ways {
  ways_in_box all;
  lanes_int cut;
} light_ways;

/* Adds a plane's depths: from a box's face on where one cuts the way, else from the slab's first sheet on.
 * share: the fraction of the way that lies in this volume. */
LANES_INLINE void add_plane(const shade_job *job, const block_density *d, const plane_matter *plane,
                            const light_ways *ways, lanes share, const near_pixels *near,
                            light_depths *depths) {
  const int back_to_front = job->back_to_front, channels = job->channels;
  const shade_volume *volume = d->patch->volume;
  const classifier *classifier = volume->classifier;
  lanes depth = plane->inverse * plane->likely * share;
  if (hl_classifier_is_weighed(classifier)) depth = depth * d->factor;
  const lanes end[2] = {back_to_front ? d->after : d->before, back_to_front ? d->before : d->after};
  const lanes way[2] = {back_to_front ? ways->all.last : ways->all.first,
                        back_to_front ? ways->all.first : ways->all.last};
  lanes at[2];
  for (int i = 0; i < 2; i++) {
    table_origin from = plane->below, to = origin_at(classifier, end[i]);
    if (lanes_bits(ways->cut) != 0) {
      table_origin face = origin_at(classifier, lanes_fma(-plane->fall, way[i], end[i]));
      from = (table_origin){lanes_select(ways->cut, face.x, from.x),
                            lanes_select(ways->cut, face.extinction, from.extinction),
                            lanes_select(ways->cut, face.integral, from.integral)};
    }
    at[i] = integral_between(&from, &to) * depth;
  }
  lanes rise_u = dot3(plane->slope, near->along_u), rise_v = dot3(plane->slope, near->along_v);
  lanes there[NEAR_PIXELS];
  for (int i = 0; i < NEAR_PIXELS; i++) {
    table_origin pixel = origin_at(
        classifier, lanes_fma(rise_u, near->u[i], lanes_fma(rise_v, near->v[i], plane->below.x)));
    there[i] = lanes_keep(~ways->cut, integral_between(&plane->below, &pixel) * depth);
  }
  for (int c = 0; c < channels; c++) {
    lanes cast = lanes_set(volume->cast[c]);
    depths->enter[c] = lanes_fma(cast, at[0], depths->enter[c]);
    depths->more[c] = lanes_fma(cast, at[1] - at[0], depths->more[c]);
    for (int i = 0; i < NEAR_PIXELS; i++) depths->near[c][i] = lanes_fma(cast, there[i], depths->near[c][i]);
  }
}

/* Adds what a plane's matter absorbs too much in sub-lights' buffers because slabs are shifted. Derived: the
 * light passes the m-th slab before this one between the densities f_m and f_(m+1) = f_m - k path; a shift
 * that raises the density by d adds the optical depth (E(f_m) - E(f_(m+1))) d / k to first order, E the
 * extinction, P's slope. The mean over the sub-lights has the mean of their d. share: as in add_plane(). */
LANES_INLINE void add_shifts(const shade_job *job, const block_density *d, const plane_matter *plane,
                             const seen_light *light, lanes share, light_depths *depths) {
  const shade_volume *volume = d->patch->volume;
  const near_pixels *near = light->near;
  lanes rise_u = dot3(plane->slope, near->along_u), rise_v = dot3(plane->slope, near->along_v);
  lanes fall = plane->fall * light->path, extinction = plane->below.extinction, sum = lanes_set(0);
  for (int m = 0; m < SHIFTED_SLABS && lanes_bits(extinction > 0.0f) != 0; m++) {
    const float *shift = near->shifts->mean[m];
    table_origin before = origin_at(volume->classifier, plane->below.x - fall * (float)(m + 1));
    sum = lanes_fma(extinction - before.extinction, lanes_fma(rise_u, lanes_set(shift[0]), rise_v * shift[1]),
                    sum);
    extinction = before.extinction;
  }
  sum = sum * plane->inverse * plane->likely * share;
  for (int c = 0; c < job->channels; c++)
    for (int i = 0; i < NEAR_PIXELS; i++)
      depths->near[c][i] = lanes_fma(lanes_set(volume->cast[c]), sum, depths->near[c][i]);
}

/* A way at least this fraction of the slab's counts as the whole slab's: the rest is rounding. */
static const float WHOLE_WAY = 0.999f;

/* Finds the light's ways, and the lanes where a box makes them shorter than the slab. */
LANES_INLINE light_ways find_light_ways(const block_slab *slab, block_density *densities, int count,
                                        lanes3 towards, lanes path) {
  light_ways ways = {.all = find_ways(slab, densities, count, towards, path)};
  lanes first = slab->part.begin * path, last = (slab->part.begin + slab->part.length) * path;
  lanes_int shorter = (ways.all.first < first * WHOLE_WAY) | (ways.all.last < last * WHOLE_WAY);
  ways.cut = shorter | (slab->part.begin > 1.0f - WHOLE_WAY) | (slab->part.length < WHOLE_WAY);
  return ways;
}

/* The greatest optical depth: hardly any light is left, and floats still hold exp(-depth). */
static const float DEEPEST = 80;

/* Where the optical depths of the near pixels, from the faces to the slab, differ by less than this, the
 * buffer is read as if there were no face; where they differ by twice as much, the face counts fully. */
static const float EVEN_LIGHT = 0.1f;

/* Near a box's face: adds the optical depth of a volume's matter between the face and the slab. `before`
 * receives the depths at the near pixels. share: the fraction of the volume's matter that counts. */
LANES_INLINE void add_face(const shade_job *job, const block_slab *slab, const block_density *d,
                           const seen_light *light, lanes share, lanes before[HL_CHANNELS][NEAR_PIXELS],
                           light_depths *depths) {
  const shade_volume *volume = d->patch->volume;
  faces_of_axis faces[3];
  lanes likely = find_faces(volume, &slab->geometry, light->towards, light->near, faces) * share;
  lanes_int there = (likely > 0.0f) & slab->seen & (d->sums.extinction > 0.0f);
  if (lanes_bits(there) == 0) return;
  ways_before ways = find_ways_before(volume, faces, slab, light);
  depths->face |= there;
  depths->beside = lanes_max(depths->beside, lanes_keep(there, likely));
  /* where several boxes meet in the slab, each volume fills a part of it */
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

/* Adds to `near` the depths between the faces and the slab, weakened where they hardly differ from pixel to
 * pixel. before: these depths at the near pixels, all volumes together. */
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

LANES_INLINE light_depths depths_of_light(const shade_job *job, const block_slab *slab,
                                          block_density *densities, int count, const seen_light *light) {
  const lanes3 towards = light->towards;
  const lanes path = light->path;
  const near_pixels *near = light->near;
  light_depths depths = {.plane = lanes_set_int(0), .face = lanes_set_int(0), .beside = lanes_set(0)};
  light_ways ways = find_light_ways(slab, densities, count, towards, path);
  lanes length = lanes_max(ways.all.last, ways.all.first) - ways.all.first;
  lanes first[HL_CHANNELS], last[HL_CHANNELS], before[HL_CHANNELS][NEAR_PIXELS];
  for (int c = 0; c < HL_CHANNELS; c++) {
    first[c] = last[c] = depths.enter[c] = depths.more[c] = lanes_set(0);
    depths.before_enter[c] = depths.before_more[c] = lanes_set(0);
    for (int i = 0; i < NEAR_PIXELS; i++) depths.near[c][i] = before[c][i] = lanes_set(0);
  }
  for (int i = 0; i < count; i++) {
    const block_density *d = &densities[i];
    if (!d->there) continue;
    lanes way = lanes_fma(length, d->seen, ways.all.first), extinction = extinction_towards(d, towards, way);
    plane_matter plane = {.likely = lanes_set(0)};
    if (near != NULL) plane = plane_of(d, towards, way);
    lanes_int likely = plane.likely > 0.0f;
    if (lanes_bits(likely) != 0) {
      lanes share = count == 1 ? lanes_set(1.0f)
                               : (d->light_first + d->light_last) /
                                     lanes_max(ways.all.first + ways.all.last, lanes_set(1e-30f));
      add_plane(job, d, &plane, &ways, lanes_min(share, lanes_set(1.0f)), near, &depths);
      if (near->shifts != NULL)
        add_shifts(job, d, &plane, light, lanes_keep(~ways.cut, lanes_min(share, lanes_set(1.0f))), &depths);
      depths.plane |= likely;
      extinction = extinction * (1.0f - plane.likely);
    }
    if (near != NULL && d->patch->enter != NULL)
      add_face(job, slab, d, light, 1.0f - plane.likely, before, &depths);
    for (int c = 0; c < job->channels; c++) {
      lanes cast = extinction * d->patch->volume->cast[c];
      first[c] = lanes_fma(cast, d->light_first, first[c]);
      last[c] = lanes_fma(cast, d->light_last, last[c]);
    }
  }
  if (lanes_bits(depths.face) != 0) add_before(job->channels, before, &depths);
  for (int c = 0; c < job->channels; c++) {
    last[c] = lanes_max(last[c], first[c]);
    depths.enter[c] = depths.enter[c] + (job->back_to_front ? last[c] : first[c]);
    depths.more[c] = depths.more[c] + (job->back_to_front ? first[c] - last[c] : last[c] - first[c]);
  }
  return depths;
}

#endif
