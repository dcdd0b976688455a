/* reference/passing.c - computes the fraction of light that passes volumes and surfaces on a ray. The light
 * goes to a point, or to the outside of the volume's surface in which the point lies.
 *
 * A volume's surface is lit by the light that arrives at the surface's outside. So the matter of a surface
 * does not shade deeper parts of this surface. A ray is followed from the point to the light. T is the light
 * that is left on the ray, and A is the light that the surface has taken. Each step changes T and A linearly.
 * So two factors describe the effect of all steps between the ray's current place and the point. */
#include <stdlib.h>

#include "core/memory.h"
#include "elementary/elementary.h"
#include "reference/reference.h"

/* A light counts as hidden if the optical depth on the way to the light is greater than this in all channels:
 * exp(-18) is 2e-8. */
static const double DARK_DEPTH = 18;

void hl_reference_transmittance(const reference *all, const reference_ray *ray, crossing *scratch,
                                double passing[3]) {
  double depth[3] = {0, 0, 0};
  march walk;
  hl_reference_march_begin(all, REFERENCE_CASTS_SHADOW, ray, scratch, &walk);
  while (hl_reference_march_next(&walk)) {
    for (size_t v = 0; v < walk.count; v++) {
      const crossing *part = &walk.crossings[v];
      if (!part->occupied) continue;
      double value = hl_reference_value(part->volume, part->here);
      double extinction = hl_reference_extinction(part->volume, value, part->here);
      for (int c = 0; c < 3; c++)
        depth[c] += extinction * walk.length * part->volume->described->attenuation_color[c];
    }
    if (fmin(depth[0], fmin(depth[1], depth[2])) > DARK_DEPTH) break;
  }
  hl_reference_surfaces_passing(all, ray, passing);
  for (int c = 0; c < 3; c++) passing[c] *= hl_exp(-depth[c]);
}

/* ---- where surfaces begin ---- */

/* The optical depth of matter with this value over one unit distance of the transfer function. For a function
 * of two numbers, the result is the greatest optical depth over all second numbers. */
static double extinction_at(const reference_volume *volume, double value) {
  if (value < volume->transparent_below) return 0;
  double opacity = hl_transfer_function_opacity(&volume->described->transfer_function, value);
  return -hl_log1p(-fmin(opacity, 1 - 1e-12));
}

static double value_of_foot(const reference_volume *volume, int index) {
  return volume->feet_low + (volume->feet_high - volume->feet_low) * (index + 0.5) / HL_REFERENCE_FEET;
}

static int index_of_value(const reference_volume *volume, double value) {
  double place = (value - volume->feet_low) / (volume->feet_high - volume->feet_low) * HL_REFERENCE_FEET;
  return (int)fmin(fmax(place, 0), HL_REFERENCE_FEET - 1);
}

/* Matter with a value belongs to a surface. Returns the value at which this surface begins. */
static double foot_of(const reference_volume *volume, double value) {
  return volume->feet[index_of_value(volume, value)];
}

/* The integral of extinction over the values from feet_low to the given value. The integral is interpolated
 * in a table. */
static double depth_to(const reference_volume *volume, double value) {
  double place = (value - volume->feet_low) / (volume->feet_high - volume->feet_low) * HL_REFERENCE_FEET;
  place = fmin(fmax(place, 0), HL_REFERENCE_FEET);
  const int step = (int)fmin(place, HL_REFERENCE_FEET - 1);
  return volume->depths[step] + (volume->depths[step + 1] - volume->depths[step]) * (place - step);
}

/* Finds the values at which surfaces begin, walking from the empty value outwards. A surface begins at the
 * last value without extinction. A second surface begins where extinction has stopped rising and then rises
 * by half. Extinction has stopped rising if it did not rise over a twentieth of the range of values since the
 * surface's beginning. */
static void find_feet(reference_volume *volume, int first, int step) {
  double foot = volume->empty_value, level = 0;
  int beginning = first, mark = -1;
  for (int at = first; at >= 0 && at < HL_REFERENCE_FEET; at += step) {
    double extinction = extinction_at(volume, value_of_foot(volume, at));
    int span = (int)ceil(abs(at - beginning) / 20.0), back = at - step * (span > 1 ? span : 1);
    bool rose = (back - beginning) * step <= 0 ||
                extinction > extinction_at(volume, value_of_foot(volume, back));
    if (!(extinction > 0)) {
      foot = value_of_foot(volume, at);
      beginning = at;
      mark = -1;
    } else if (!rose && (mark < 0 || extinction <= level)) {
      mark = at;
      level = extinction;
    } else if (mark >= 0 && extinction >= 1.5 * level) {
      foot = value_of_foot(volume, mark);
      for (int of = mark; of != at; of += step) volume->feet[of] = foot;
      beginning = mark;
      mark = -1;
    }
    volume->feet[at] = foot;
  }
}

hl_status hl_reference_feet_create(hl_context *context, reference_volume *volume, hl_error *error) {
  const hl_volume *grid = volume->grid;
  volume->feet = hl_allocate(context, HL_REFERENCE_FEET, sizeof *volume->feet);
  volume->depths = hl_allocate_zeroed(context, HL_REFERENCE_FEET + 1, sizeof *volume->depths);
  if (volume->feet == NULL || volume->depths == NULL)
    return hl_fail_memory(error, HL_REFERENCE_FEET * sizeof *volume->feet, "the reference");
  volume->feet_low = fmin(grid->minimum, volume->empty_value);
  volume->feet_high = fmax(grid->maximum, volume->empty_value);
  if (!(volume->feet_high > volume->feet_low)) volume->feet_high = volume->feet_low + 1;
  int empty = index_of_value(volume, volume->empty_value);
  find_feet(volume, empty, -1);
  find_feet(volume, empty, 1);
  for (int i = 0; i < HL_REFERENCE_FEET; i++)
    volume->depths[i + 1] = volume->depths[i] + extinction_at(volume, value_of_foot(volume, i));
  return HL_OK;
}

/* ---- the light at the outside ---- */

/* The fractions of the surface's light that still count as the surface's after one step of the light. before:
 * the fraction of the light that the surface took before the step. within: the fraction of the light that the
 * surface takes in the step. second: whether the light comes, in this step, from another surface into this
 * surface. A part of the light that the other surface took may then count as taken by this surface. */
typedef struct kept_light {
  double before, within;
  bool second;
} kept_light;

/* Returns the fraction `kept` to the power 1 - skin. The power raises the fraction towards 1 where matter
 * belongs to the skin of a cut face, because the skin's own matter does not shade the skin. Because skin is
 * in the exponent, the product over all steps does not depend on the steps' length. */
static double kept_in_skin(double kept, double skin) { return skin > 0 ? hl_pow(kept, 1 - skin) : kept; }

/* Finds the fractions of the light taken by a surface that still count as taken by this surface after one
 * step. from, to: the volume's values at the step's ends, in the direction of the light. skin: the fraction
 * of the visible matter in the step that belongs to the face of a cut. */
static kept_light kept_of_step(const reference_volume *volume, double from, double to, double length,
                               double skin) {
  double foot_from = foot_of(volume, from), foot_to = foot_of(volume, to), deep = to - foot_to,
         depth_from = fabs(depth_to(volume, from) - depth_to(volume, foot_from)),
         depth_to_here = fabs(depth_to(volume, to) - depth_to(volume, foot_to)),
         left = fmin(depth_to_here / fmax(depth_from, 1e-300), 1);
  double even = length - fabs(to - from) / volume->surface_gradient;
  bool same = foot_from == foot_to, enters = (to - from) * deep > 0;
  left = hl_pow(left, 16) * hl_exp(-fmax(even, 0) / volume->smallest_edge);
  if (!(extinction_at(volume, to) > 0)) skin = 0;
  if (same) return (kept_light){kept_in_skin(left, skin), kept_in_skin(left, skin), false};
  if (skin == 1) return (kept_light){1, 1, false};
  return (kept_light){0, enters ? 1 : 0, enters && extinction_at(volume, from) > 0};
}

/* A layer is another surface that the ray has entered, on its way to the light, after it left the point's own
 * surface. A layer is pending as long as the march has not decided whether the layer counts as part of the
 * point's surface. */
typedef struct pending_layer {
  bool any;
  /* depth: the other surface's optical depth so far. rise: the change of the volume's values per length where
   * the ray left the point's surface. ramp: the optical depth, times `rise`, that the other surface would
   * have if values rose in it along a straight ramp. */
  double depth, rise, ramp;
} pending_layer;

/* The factors by which all steps between the ray's current place and the point multiply the light and the
 * light taken by the surface. kept_light and kept_taken are the factors for the case that the light taken by
 * the pending layer counts as taken by the surface. */
typedef struct light_factors {
  double light[3], kept_light[3], kept_taken;
} light_factors;

static double ramp_depth(const reference_volume *volume, double from, double to) {
  const int steps = 256;
  double sum = 0;
  for (int i = 0; i < steps; i++) sum += extinction_at(volume, from + (to - from) * (i + 0.5) / steps);
  return sum / steps * fabs(to - from) / volume->described->transfer_function.unit_distance;
}

/* Decides whether a pending layer is part of the point's surface. The layer's optical depth is compared with
 * the depth of a straight ramp of values. Up to 1.2 times the ramp's depth, the layer counts fully as part of
 * the surface. From 1.6 times the ramp's depth on, the layer does not count. Between these ratios, the layer
 * counts in part. */
static void settle(light_factors *all, pending_layer *layer) {
  double ratio = layer->depth * layer->rise / fmax(layer->ramp, 1e-300),
         kept = fmin(fmax((1.6 - ratio) / 0.4, 0), 1);
  for (int c = 0; c < 3; c++) all->light[c] += kept * all->kept_light[c], all->kept_light[c] = 0;
  all->kept_taken *= kept;
  layer->any = false;
}

/* Adds a step to the factors. depth: the optical depth of all volumes in the step, in each channel. kept: the
 * mean, weighted by optical depth, of the fractions that the volumes keep. */
static void add_step(light_factors *all, pending_layer *layer, const double depth[3], kept_light kept) {
  if (layer->any && kept.before == 0) settle(all, layer);
  for (int c = 0; c < 3; c++) {
    double passing = hl_exp(-depth[c]), taken = 1 - passing;
    if (layer->any) {
      all->light[c] *= passing;
      all->kept_light[c] = all->kept_light[c] * passing + all->kept_taken * kept.within * taken;
    } else {
      all->light[c] = all->light[c] * passing + all->kept_taken * kept.within * taken;
    }
  }
  if (layer->any) layer->depth += (depth[0] + depth[1] + depth[2]) / 3;
  if (kept.second) layer->any = true;
  else all->kept_taken *= kept.before;
}

void hl_reference_outside(const reference *all, const reference_ray *ray, const reference_receiver *at,
                          crossing *scratch, double passing[3]) {
  light_factors factors = {{1, 1, 1}, {0, 0, 0}, 1};
  pending_layer layer = {.any = false};
  bool has_ended = false; /* whether the ray has left the matter of the point's volume within its grid */
  march walk;
  hl_reference_march_begin(all, REFERENCE_CASTS_SHADOW, ray, scratch, &walk);
  for (size_t v = 0; v < walk.count; v++) {
    walk.crossings[v].last_at = 0;
    walk.crossings[v].last_value = walk.crossings[v].volume == at->surface_of ? at->value : NAN;
  }
  while (hl_reference_march_next(&walk)) {
    double depth[3] = {0, 0, 0}, total = 0;
    kept_light kept = {0, 0, false};
    for (size_t v = 0; v < walk.count; v++) {
      crossing *part = &walk.crossings[v];
      const reference_volume *volume = part->volume;
      if (!part->occupied) continue;
      double value = hl_reference_value(volume, part->here),
             here = hl_reference_extinction(volume, value, part->here) * walk.length,
             nearer = part->last_value;
      bool beside = walk.at - part->last_at < 1.5 * walk.length, known = !isnan(nearer);
      part->last_at = walk.at;
      part->last_value = value;
      if (!(here > 0)) {
        has_ended |= volume == at->surface_of;
        continue;
      }
      for (int c = 0; c < 3; c++) depth[c] += here * volume->described->attenuation_color[c];
      total += here;
      if (volume->described->shading != HL_SHADING_PHONG || !beside) continue;
      const vec3 along = mat3_apply(volume->world_to_index.linear, ray->direction),
                 between = vec3_add(part->here, vec3_scale(along, -0.5 * walk.length)); /* the middle between
                                                                                         * the places of
                                                                                         * `value` and
                                                                                         * `nearer` */
      const double skin = hl_reference_lit_face(volume, between, ray->direction, part->uncut);
      kept_light own = kept_of_step(volume, value, known ? nearer : value, walk.length, skin);
      kept.before += here * own.before;
      kept.within += here * own.within;
      if (!own.second) continue;
      double foot = foot_of(volume, nearer);
      layer.depth = 0;
      layer.rise = fabs(nearer - value) / walk.length;
      layer.ramp = ramp_depth(volume, foot_of(volume, value), foot);
      kept.second = true;
    }
    if (!(total > 0)) {
      kept.before = 0;
    } else if (has_ended) {
      kept = (kept_light){0, 0, false}; /* other volumes' matter in front of the surface shades it */
    } else {
      kept.before /= total;
      kept.within /= total;
    }
    add_step(&factors, &layer, depth, kept);
    if (fmax(factors.light[0], fmax(factors.light[1], factors.light[2])) + factors.kept_taken < 1e-8) break;
  }
  if (layer.any) settle(&factors, &layer);
  hl_reference_surfaces_passing(all, ray, passing);
  for (int c = 0; c < 3; c++) passing[c] *= factors.light[c];
}
