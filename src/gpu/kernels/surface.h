/* gpu/kernels/surface.h - handles surfaces of a volume: finds how much of a sample belongs to a face at which
 * the box or a cut cuts matter, and the light at the outside of surfaces (Y in shadow/attenuate.h).
 *
 * The functions compute for one pixel and one volume the same numbers as render/slab_lanes.h,
 * render/reaching_lanes.h, grid/classifier_lanes.h and shadow/attenuate_lanes.h for sixteen pixels. */
#ifndef HL_GPU_SURFACE_H
#define HL_GPU_SURFACE_H

#include "core/sheet_constants.h"
#include "gpu/kernels/passing.h"

/* ---- the faces of the box ---- */

#define CUT_SHADING_FACE 0 /* as HL_CUT_SHADING_FACE */
#define FACES_OF_AXIS    2

/* The density at the point where a ray crosses a face. crossing: this point, in frame space. */
DEVICE_CALL float density_on_face(const volume_data volume, vector crossing) {
  GLOBAL const plan_volume *plan = volume.plan;
  float at[3];
  for (int a = 0; a < 3; a++)
    at[a] = limited(row_of_point(plan->to_index[a], crossing), -0.5f, (float)plan->dimension[a] - 0.5f);
  return density_at(volume, at[0], at[1], at[2]);
}

/* Returns whether a point lies so near to a face of the box with visible matter that the point may belong to
 * this face. */
DEVICE int is_near_face(GLOBAL const plan_volume *volume, vector point) {
  const float reach = FACE_VOXELS * volume->voxel * 1.001f;
  int close = 0;
  for (int axis = 0; axis < 3; axis++) {
    GLOBAL const float *row = volume->to_index[axis];
    GLOBAL const int *cuts = volume->face_cuts + FACES_OF_AXIS * axis;
    float at = row_of_point(row, point), steps = row_size(row) * reach;
    close = close || (cuts[0] && at - volume->low[axis] < steps) ||
            (cuts[1] && volume->high[axis] - at < steps);
  }
  return close;
}

/* The face through which the eye's ray comes last before it meets a sample. */
typedef struct cut_face {
  float way;      /* the distance from the sample back to the face; frame units */
  vector outward; /* the face's unit normal */
  int cuts;       /* the face cuts matter */
} cut_face;

/* Sets *nearest to the face of a cut through which the eye's ray comes to the sample, if this face is nearer
 * than *nearest. A face that lies behind the sample, as seen by the eye, counts if its distance to the sample
 * is less than `least`; frame units. */
DEVICE void find_cut(GLOBAL const plan_cut *cut, const slab_sample *s, float least, cut_face *nearest) {
  const ray_section section = cross_cut(cut, s->position, s->towards_eye);
  float way = cut->keep_inside ? section.last : section.first;
  const int met = section.first < section.last && way > -least && way < 1e20f;
  way = greater(met ? way : 1e30f, 0.0f);
  if (!(way < nearest->way)) return;
  const vector gradient = gradient_over_cut(cut, add_scaled(s->position, s->towards_eye, met ? way : 0.0f));
  nearest->way = way;
  nearest->outward = scaled(gradient,
                            divided(cut->keep_inside ? 1.0f : -1.0f, root(dot3(gradient, gradient))));
  nearest->cuts = 1;
}

/* The distance of a sample, in voxels, from the face that cuts matter and through which the eye's ray comes
 * last before it meets the sample; FACE_VOXELS if no such face is near. */
DEVICE float find_face(const volume_data *volume, const slab_sample *s, vector *outward) {
  GLOBAL const plan_volume *plan = volume->plan;
  cut_face nearest;
  nearest.way = 1e30f;
  nearest.cuts = 0;
  nearest.outward = *outward = vector_of(0.0f, 0.0f, 0.0f);
  if ((!CUTS || (VOLUMES > 1 && plan->cut_count == 0)) && !is_near_face(plan, s->position))
    return FACE_VOXELS;
  for (int axis = 0; axis < 3; axis++) {
    GLOBAL const float *row = plan->to_index[axis];
    float speed = row_of_vector(row, s->towards_eye);
    if (magnitude(speed) < 1e-12f) speed = 1e-12f;
    int rising = speed > 0.0f;
    float face = rising ? plan->high[axis] : plan->low[axis];
    float way = greater(divided(face - row_of_point(row, s->position), speed), 0.0f);
    if (!(way < nearest.way)) continue;
    nearest.way = way;
    nearest.outward = scaled(vector_at(row), divided(rising ? 1.0f : -1.0f, row_size(row)));
    nearest.cuts = plan->face_cuts[FACES_OF_AXIS * axis + rising];
  }
#if CUTS
  for (int i = 0; i < plan->cut_count; i++) find_cut(&volume->cuts[i], s, 0.5f * plan->voxel, &nearest);
#endif
  *outward = nearest.outward;
  float depth = nearest.way * dot3(nearest.outward, s->towards_eye);
  if (!(nearest.cuts && depth < FACE_VOXELS * plan->voxel)) return FACE_VOXELS;
  vector crossing = add_scaled(s->position, s->towards_eye, lesser(nearest.way, 1e20f));
  table_coordinate there = coordinate_of_density(plan, density_on_face(*volume, crossing));
  if (!may_be_visible(plan, there, there)) return FACE_VOXELS;
  return depth * divided(1.0f, plan->voxel);
}

/* Treats a sample behind a face that cuts matter. Depending on the cut shading, it turns the sample's normal
 * towards the face's normal, or shades the sample less as a surface and more as a medium. The sample's skin
 * says how strong this effect is. */
DEVICE void find_cut_face(const volume_data *volume, slab_sample *s) {
  vector outward;
  s->behind = find_face(volume, s, &outward);
  const float skin = skin_of_sample(s), rest = 1.0f - skin;
  if (volume->plan->cut_shading == CUT_SHADING_FACE) {
    vector sum = add_scaled(scaled(outward, skin), s->normal, s->surface * rest);
    s->normal = scaled(sum, divided(1.0f, greater(root(dot3(sum, sum)), 1e-6f)));
    s->surface = fused(s->surface, rest, skin);
  } else {
    s->surface = s->surface * rest;
  }
}

/* ---- light that passes from one surface into another ---- */

DEVICE float integral_to(GLOBAL const float *tables, float x) {
  float values[4];
  table_values(sums_table(tables), split_coordinate(x), 2, values);
  return values[1];
}

/* kept: of the light that the first surface has absorbed, the fraction that counts as absorbed by the second
 * surface. ahead: the optical depth from `start` to the place where the second surface begins. */
typedef struct second_surface {
  float kept, ahead;
} second_surface;

DEVICE second_surface kept_at_foot(GLOBAL const float *tables, float first, float start, float foot,
                                   float rise, float light, float outside) {
  float at_foot = integral_to(tables, foot), ramp = magnitude(at_foot - integral_to(tables, first)),
        ahead = magnitude(at_foot - integral_to(tables, start));
  float taken = log_of_two(divided(greater(outside, 1e-9f), greater(light, 1e-9f))) * 0.6931472f;
  float ratio = divided(fused(greater(taken, 0.0f), rise, ahead), greater(ramp, 1e-9f));
  second_surface other;
  other.kept = limited((OTHER_LAYER - ratio) * (1.0f / (OTHER_LAYER - SAME_RAMP)), 0.0f, 1.0f);
  other.ahead = divided(ahead, greater(rise, 1e-9f));
  return other;
}

#if VOLUMES > 1

/* A bound of the optical depth of a surface's own matter before a sheet, as in grid/classifier_lanes.h. */
DEVICE float greatest_depth_of_surface(float integral, float rise) {
  return divided(2.0f * integral, greater(rise, 1e-9f));
}

/* Of the light that is missing at a place, matter before the place can have absorbed at most the returned
 * fraction, as in grid/classifier_lanes.h. depth: the optical depth of this matter. light, outside: the light
 * at the place, and the light at the outside of surfaces. beside: the most light that a pixel around the
 * place has. */
DEVICE float part_of_matter(float depth, float light, float outside, float beside) {
  float left = exp_negative(lesser(depth, 20.0f)),
        absorbed = greater(greater(light, 0.0f) * (1.0f - left), (beside - light) * left),
        missing = (outside - light) * left;
  return absorbed < missing ? divided(absorbed, missing) : 1.0f;
}

#endif

/* ---- a light's way through a slab ---- */

/* The fractions of light at the outside of surfaces that a slab lets pass: k and k' of shadow/attenuate.h. */
typedef struct kept_light {
  float before; /* k: the fraction that is kept of the light that matter before the slab has absorbed */
  float within; /* k': the fraction that is kept of the light that the slab absorbs */
} kept_light;

DEVICE float power_of_depth(float h1, float h2) {
  float left = lesser(divided(magnitude(h2), greater(magnitude(h1), 1e-30f)), 1.0f);
  for (int power = 1; power < OUTWARDS_POWER; power *= 2) left = left * left;
  return left;
}

/* Finds k and k' (kept_light) for a volume with several surfaces. light, outside: T and Y before the slab. */
DEVICE kept_light kept_of_several(const volume_data *volume, table_coordinate a, table_coordinate b,
                                  const way_sums *sums, float way, float depth, float even, float light,
                                  float outside) {
  GLOBAL const float *feet = outside_table(volume->tables);
  float foot_a = feet[a.entry], foot_b = feet[b.entry], deep = b.x - foot_b;
  float left = power_of_depth(sums->to_a - beginning_at(volume->tables, a.entry),
                              sums->to_b - beginning_at(volume->tables, b.entry)) *
               even;
  int same = foot_a == foot_b, enters = (b.x - a.x) * deep > 0.0f;
  kept_light kept;
  kept.before = same ? left : 0.0f;
  kept.within = same ? left : enters ? 1.0f : 0.0f;
  if (!(enters && !same && foot_a != (float)a.entry)) return kept;
  float rise = divided(magnitude(b.x - a.x), greater(way, 1e-9f));
  second_surface other = kept_at_foot(volume->tables, foot_a, a.x, foot_b, rise, light, outside);
  float of_first = divided(1.0f - exp_negative(lesser(other.ahead, depth)),
                           greater(1.0f - exp_negative(depth), 1e-6f));
  kept.before = other.kept;
  kept.within = fused(of_first, other.kept - 1.0f, 1.0f);
  return kept;
}

/* The skin of the faces of the box and of cuts on a light's ray in a slab: the fraction of the matter that
 * belongs to these faces. in_index: the rays in index space at the sheet before the slab; the rays at the
 * next sheet follow. */
DEVICE float skin_of_faces(const volume_data *data, GLOBAL const plan_light *light,
                           GLOBAL const plan_rays *in_index, float u, float v) {
  GLOBAL const plan_volume *volume = data->plan;
  const int perspective = !light->parallel;
  const vector from = position_on(in_index, perspective, u, v),
               to = position_on(in_index + 1, perspective, u, v);
  float x = skin_of_axis(from.x, to.x, volume->face_low[0], volume->face_high[0], volume->steps[0]);
  float y = skin_of_axis(from.y, to.y, volume->face_low[1], volume->face_high[1], volume->steps[1]);
  float z = skin_of_axis(from.z, to.z, volume->face_low[2], volume->face_high[2], volume->steps[2]);
  float skin = greater(greater(x, y), z);
#if CUTS
  for (int i = 0; i < volume->light_cut_count; i++)
    skin = greater(skin, skin_of_cut(&data->cuts[light->first_cut + i], from, to));
#endif
  return skin;
}

/* Returns whether a light's ray comes near to an inner corner of matter in a slab. in_index: as for
 * skin_of_faces(). */
DEVICE int nears_inner_corner(const volume_data *data, GLOBAL const plan_light *light,
                              GLOBAL const plan_rays *in_index, float u, float v) {
  int near = 0;
#if CUTS
  const int perspective = !light->parallel;
  const vector from = position_on(in_index, perspective, u, v),
               to = position_on(in_index + 1, perspective, u, v);
  for (int i = 0; i < data->plan->light_cut_count; i++) {
    GLOBAL const plan_cut *cut = &data->cuts[light->first_cut + i];
    near = near || (cut->shape == CUT_BOX && !cut->keep_inside && nears_edge(cut, from, to));
  }
#else
  (void)data, (void)light, (void)in_index, (void)u, (void)v;
#endif
  return near;
}

/* Finds k and k': the fractions of the light that a surface has absorbed which still light the surface after
 * a slab. sums: integrals from a to b. way: the length of the light's way through the slab's matter. depth:
 * the slab's optical depth. skin: how much of the visible matter belongs to a face. light, outside: T and Y
 * before the slab. */
DEVICE kept_light kept_in_slab(const volume_data *volume, table_coordinate a, table_coordinate b,
                               const way_sums *sums, float way, float depth, float skin, float light,
                               float outside) {
  GLOBAL const plan_volume *plan = volume->plan;
  float even = way - magnitude(b.x - a.x) * divided(1.0f, plan->normal_edge);
  even = exp_negative(greater(even, 0.0f) * divided(1.0f, EVEN_VOXELS * plan->voxel));
  kept_light kept;
  if (plan->several_surfaces) {
    kept = kept_of_several(volume, a, b, sums, way, depth, even, light, outside);
  } else {
    float left = power_of_depth(sums->to_a - plan->only_beginning, sums->to_b - plan->only_beginning);
    kept.before = kept.within = left * even;
  }
#if BOXED
  if (skin > 0.0f) {
    float at_end[4];
    table_values(sums_table(volume->tables), b, 2, at_end);
    if (at_end[0] > 0.0f) {
      kept.before = power_of_part(kept.before, 1.0f - skin);
      kept.within = power_of_part(kept.within, 1.0f - skin);
    }
  }
#endif
  return kept;
}

/* The light at the outside of surfaces after a slab (Y in shadow/attenuate.h). outside: this light before the
 * slab. before, after: the transmittance before and after the slab. */
DEVICE float pass_outside(float outside, float before, float after, kept_light kept) {
  float light = greater(before, 0.0f), left = greater(after, 0.0f);
  float taken = greater(outside - light, 0.0f);
  return fused(taken, kept.before, fused(light - left, kept.within, left));
}

/* ---- the light that lights a sample's surface ---- */

/* The beginning of a light's way to a sample, on the slab's first sheet. The members are the same as in
 * way_begin in render/reaching_lanes.h. */
typedef struct way_begin {
  float start, change, first, foot;
  int there;
} way_begin;

DEVICE way_begin find_begin(const volume_data *volume, const slab_sample *s, vector towards, float way) {
  GLOBAL const float *feet = outside_table(volume->tables);
  way_begin begin;
  float seen = limited(coordinate_seen(s), 0.0f, PLAN_ENTRIES);
  begin.change = s->sloped ? dot3(s->slope, towards) * volume->plan->scale : 0.0f;
  begin.start = limited(fused(begin.change, way, seen), 0.0f, PLAN_ENTRIES);
  begin.foot = feet[(int)seen];
  float side = seen >= begin.foot ? 1.0f : -1.0f;
  float below = feet[(int)limited(begin.foot - side * 0.5f, 0.0f, PLAN_ENTRIES)];
  int layer = magnitude(below - begin.foot) > 1.0f;
  int beyond = layer && (begin.start - below) * side < 0.0f;
  if (beyond) begin.start = below;
  int entry = (int)begin.start;
  begin.first = beyond ? below : feet[entry];
  begin.there = begin.first != (float)entry || beyond;
  return begin;
}

/* The fractions of the light at the slab's first sheet that light a sample's own surface, as own_surface in
 * render/reaching_lanes.h. */
typedef struct own_surface {
  float kept, passing;
} own_surface;

/* Finds these fractions. passed, outside: the transmittance and the light at the outside, at the slab's first
 * sheet. */
DEVICE own_surface find_own_surface(const volume_data *volume, const slab_sample *s, const way_begin *begin,
                                    float passed, float outside) {
  own_surface own;
  own.kept = own.passing = 1.0f;
  if (begin->there && begin->first != begin->foot) {
    second_surface other = kept_at_foot(volume->tables, begin->first, begin->start, begin->foot,
                                        magnitude(begin->change), passed, outside);
    own.kept = greater(other.kept, skin_of_sample(s));
    own.passing = greater(exp_of_depth(lesser(other.ahead, DEEPEST)), skin_of_sample(s));
  }
  return own;
}

/* The light that reaches a sample's slab in one channel: the light at the outside of surfaces, and the
 * transmittance, which is found only if it is wanted. */
typedef struct surface_light {
  float outside, passed;
} surface_light;

/* The means over a light's sub-lights. */
typedef struct sublight_means {
  float passed[CHANNELS], outside[CHANNELS];
} sublight_means;

DEVICE sublight_means means_for_surface(GLOBAL const plan_light *light, const slab_sample *s,
                                        const light_buffers *buffers, int wants_passed) {
  sublight_means means;
  for (int c = 0; c < CHANNELS; c++) means.passed[c] = means.outside[c] = 0.0f;
#if SUBLIGHTS
  if (light->sublights > 0) {
    mean_of_sublights(light, buffers, s->position, 1, means.outside);
    if (wants_passed) mean_of_sublights(light, buffers, s->position, 0, means.passed);
  }
#else
  (void)light, (void)s, (void)buffers, (void)wants_passed;
#endif
  return means;
}

/* In the buffer's planes Y follows T. */
DEVICE surface_light light_for_surface(GLOBAL const plan_light *light, const shadow_taps *taps,
                                       const light_buffers *buffers, const sublight_means *means, int c,
                                       int wants_passed) {
  GLOBAL const float *plane = buffers->planes + c * light->plane + light->origin;
  surface_light found;
  found.outside = means->outside[c];
  found.passed = means->passed[c];
#if SUBLIGHTS
  if (light->sublights > 0) return found;
#endif
  found.outside = interpolated(light, taps, light->cubic, plane + CHANNELS * light->plane);
  if (wants_passed || light->soft) found.passed = interpolated(light, taps, light->cubic, plane);
#if SOFT
  if (light->soft) {
    const float taken = found.outside - found.passed;
    found.passed = between_chunks(interpolated(light, taps, light->cubic, plane + OLDER_PLANE * light->plane),
                                  found.passed, buffers->young);
    found.outside = found.passed + greater(taken, 0.0f);
  }
#endif
  return found;
}

/* The light that lights a sample's own surface. */
DEVICE float light_of_own_surface(surface_light light, own_surface own) {
  if (own.kept == 1.0f && own.passing == 1.0f) return light.outside;
  const float passed = light.passed * own.passing;
  return fused(light.outside - passed, own.kept, passed);
}

/* Finds the light at the outside of a sample's surface. way: the light's way from the slab's first sheet to
 * the sample. */
DEVICE void passing_to_surface(const volume_data *volume, GLOBAL const plan_light *light,
                               const slab_sample *s, vector towards, float way, const light_buffers *buffers,
                               float passing[CHANNELS]) {
  const shadow_taps taps = taps_of_position(light, s->position);
  const int several = volume->plan->several_surfaces;
  const sublight_means means = means_for_surface(light, s, buffers, several);
  own_surface own;
  own.kept = own.passing = 1.0f;
  for (int c = 0; c < CHANNELS; c++) {
    const surface_light found = light_for_surface(light, &taps, buffers, &means, c, several);
    if (several && c == 0) {
      const way_begin begin = find_begin(volume, s, towards, way);
      own = find_own_surface(volume, s, &begin, found.passed, found.outside);
    }
    passing[c] = lesser(light_of_own_surface(found, own), 1.0f);
  }
}

#endif
