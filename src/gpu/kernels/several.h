/* gpu/kernels/several.h - lights the samples of a slab that several volumes share, and lets these volumes
 * absorb the light in a pixel of a light's buffer. The functions compute for one pixel the same numbers as
 * render/slab_lanes.h, render/light_depth_lanes.h, render/reaching_lanes.h, render/shade_lanes.h and
 * shadow/attenuate_lanes.h for sixteen pixels. A single volume does without this file. */
#ifndef HL_GPU_SEVERAL_H
#define HL_GPU_SEVERAL_H

#include "core/sheet_constants.h"
#include "gpu/kernels/shade.h"

#if VOLUMES > 1

/* One of several volumes on the device. first: the data of the first volume, whose pointers are the
 * beginnings of all volumes' data. */
DEVICE volume_data volume_of(const volume_data *first, int number) {
  volume_data volume = *first;
  GLOBAL const plan_volume *plan = first->plan + number;
  volume.plan = plan;
  volume.voxels = first->voxels + (wide)plan->voxels_begin * 16;
  volume.directory = first->directory + plan->directory_begin;
  volume.distances = first->distances + plan->bricks_begin;
  volume.cell_bits = first->cell_bits + plan->bricks_begin;
  volume.tables = first->tables + plan->tables_begin;
  volume.colors = first->colors + (wide)plan->colors_begin * 16;
  volume.mask = first->mask + (wide)plan->mask_begin * 16;
  volume.phases = first->phases + plan->phases_begin;
  volume.cuts = first->cuts + plan->first_cut;
  volume.bounds = first->bounds + number;
  return volume;
}

/* A slab that several volumes share. */
typedef struct shared_slab {
  slab_sample all; /* of all volumes together: the slab's rays, the part of it that the boxes of visible
                    * volumes cover, the total extinction, and where the slab is seen */
  slab_sample of[VOLUMES];   /* what belongs to one volume. The member `extinction` is over the volume's own
                              * part of the slab. The member `part` is the part of all volumes */
  covered_span own[VOLUMES]; /* the part of the slab that each volume covers */
  float first[VOLUMES], last[VOLUMES];             /* the densities on the two sheets */
  float centre_of[VOLUMES], centre;                /* `centre` of block_density and of block_slab */
  int here[VOLUMES], joined;                       /* members of block_density and of block_slab */
  float light_first[VOLUMES], light_last[VOLUMES]; /* members of block_density */
} shared_slab;

/* ---- where the slab is seen ---- */

/* Finds the sums of extinction of a volume over a part of the slab. */
DEVICE void classify_way(const volume_data *volume, covered_span part, shared_slab *slab, int v) {
  table_coordinate a = coordinate_of_density(volume->plan, slab->first[v]),
                   b = coordinate_of_density(volume->plan, slab->last[v]);
  slab_sample *s = &slab->of[v];
#if BOXED
  if (volume->plan->boxed) cut_way(part, &a, &b);
#else
  (void)part;
#endif
  s->before = a.x;
  s->after = b.x;
  s->sums = sums_of_way(volume->tables, a, b);
}

/* Finds the part of the slab that the boxes of visible volumes cover together. */
DEVICE void join_parts(const volume_data *first, shared_slab *slab) {
  float begin = 1.0f, end = 0.0f, length;
  for (int v = 0; v < VOLUMES; v++)
    if (slab->here[v] && slab->own[v].length > 0.0f && first->plan[v].visible) {
      begin = lesser(begin, slab->own[v].begin);
      end = greater(end, slab->own[v].begin + slab->own[v].length);
    }
  length = end - begin;
  for (int v = 0; v < VOLUMES; v++)
    if (slab->here[v] && slab->own[v].length > 0.0f && first->plan[v].visible &&
        slab->own[v].begin == begin && slab->own[v].begin + slab->own[v].length == end)
      length = slab->own[v].length;
  slab->all.part.begin = end > begin ? begin : 0.0f;
  slab->all.part.length = end > begin ? length : 1.0f;
  slab->joined = 0;
  for (int v = 0; v < VOLUMES; v++)
    slab->joined = slab->joined ||
                   (slab->here[v] && first->plan[v].boxed && slab->own[v].length < slab->all.part.length);
}

DEVICE void total_slab(const volume_data *first, shared_slab *slab) {
  float total = 0.0f, centre = 0.0f;
  for (int v = 0; v < VOLUMES; v++) {
    if (!(slab->here[v] && first->plan[v].visible)) continue;
    total = total + slab->of[v].extinction;
    if (slab->joined) centre = fused(slab->of[v].extinction, slab->centre_of[v], centre);
  }
  slab->all.extinction = total;
  slab->centre = divided(centre, greater(total, 1e-30f));
}

/* Finds the extinction of all volumes in the slab. The densities, the parts and `here` must be set. */
DEVICE void classify_slab(const volume_data *first, shared_slab *slab) {
  join_parts(first, slab);
  for (int v = 0; v < VOLUMES; v++) {
    if (!slab->here[v]) continue;
    const volume_data volume = volume_of(first, v);
    slab_sample *s = &slab->of[v];
    classify_way(&volume, slab->own[v], slab, v);
    s->extinction = s->sums.extinction * slab->own[v].length;
    slab->centre_of[v] = 0.0f;
    if (!slab->joined) continue;
    const way_means means = means_of_way(s->before, s->after, &s->sums);
    slab->centre_of[v] = fused(slab->own[v].length, divided(means.from_a, means.from_a + means.from_b),
                               slab->own[v].begin);
    classify_way(&volume, slab->all.part, slab, v);
  }
  total_slab(first, slab);
}

/* Finds the place where the slab is seen: the mean of the volumes' places. part: the fraction of the optical
 * depth before this place. */
DEVICE float place_of_part(const volume_data *first, shared_slab *slab, float part) {
  const covered_span span = slab->all.part;
  float sum = 0.0f, place;
  for (int v = 0; v < VOLUMES; v++) {
    slab_sample *s = &slab->of[v];
    if (!slab->here[v]) continue;
    s->seen = 0.5f;
    s->evenly = part;
    if (!first->plan[v].visible) continue;
    const way_means means = means_of_way(s->before, s->after, &s->sums);
    s->seen = way_of_depth(means.from_a, means.from_b, part);
    sum = fused(s->extinction, fused(span.length, s->seen, span.begin), sum);
  }
  place = divided(sum, greater(slab->all.extinction, 1e-30f));
  for (int v = 0; v < VOLUMES; v++)
    if (slab->here[v] && first->plan[v].visible && slab->of[v].extinction == slab->all.extinction)
      place = fused(span.length, slab->of[v].seen, span.begin);
  if (!slab->joined) return place;
  const float centre = limited(divided(slab->centre - span.begin, greater(span.length, 1e-6f)), 0.0f, 1.0f);
  const float t = way_of_depth(centre, 1.0f - centre, part);
  for (int v = 0; v < VOLUMES; v++) slab->of[v].seen = t;
  return fused(span.length, t, span.begin);
}

/* The position at which a volume's matter is seen. */
DEVICE vector seen_position(const shared_slab *slab, int v) {
  const slab_sample *all = &slab->all;
  return add_scaled(all->start, all->step_sheet, fused(all->part.length, slab->of[v].seen, all->part.begin));
}

DEVICE void place_shared(GLOBAL const device_sweep *plan, GLOBAL const plan_rays *rays, float u, float v,
                         const volume_data *first, shared_slab *slab) {
  slab_sample *all = &slab->all;
  find_geometry(plan, rays, u, v, all);
  all->depth = all->extinction * all->path;
  all->left = exp_negative(all->depth);
  all->opacity = 1.0f - all->left;
  float part = seen_part(all->depth, all->left);
  if (BACK_TO_FRONT) part = 1.0f - part;
  all->place = place_of_part(first, slab, part);
  all->start = add_scaled(all->position, all->step_sheet, -0.5f);
  all->position = add_scaled(all->start, all->step_sheet, all->place);
}

#if WEIGHED

/* Applies the factors on extinction of all volumes after place_shared(). Returns whether they changed
 * anything. */
DEVICE int weigh_volumes(const volume_data *first, shared_slab *slab) {
  int changed = 0;
  for (int v = 0; v < VOLUMES; v++) {
    const volume_data volume = volume_of(first, v);
    slab_sample *s = &slab->of[v];
    s->slope = vector_of(0.0f, 0.0f, 0.0f);
    s->row = s->factor = 0.0f;
    if (!slab->here[v] || !is_weighed(&volume) || !(s->sums.extinction > 0.0f)) continue;
    const matter_factor found = factor_of_matter(&volume, seen_position(slab, v), s->before, s->after,
                                                 s->sums.extinction);
    s->slope = found.slope;
    s->row = found.row;
    s->factor = found.factor;
    if (s->factor == 1.0f) continue;
    changed = 1;
    s->extinction = s->extinction * s->factor;
    s->sums.extinction = s->sums.extinction * s->factor;
    s->sums.integral = s->sums.integral * s->factor;
    s->sums.moment = s->sums.moment * s->factor;
  }
  return changed;
}

#endif

/* Finds the normals of all volumes, and gives their samples what belongs to the whole slab. */
DEVICE void find_normals(const volume_data *first, shared_slab *slab) {
  const slab_sample *all = &slab->all;
  for (int v = 0; v < VOLUMES; v++) {
    slab_sample *s = &slab->of[v];
    if (!slab->here[v]) continue;
    const volume_data volume = volume_of(first, v);
    s->position = seen_position(slab, v);
    s->start = all->start;
    s->step_sheet = all->step_sheet;
    s->towards_eye = all->towards_eye;
    s->path = all->path;
    s->part = all->part;
    s->place = all->place;
    s->depth = all->depth;
    s->left = all->left;
    find_normal(&volume, slab->first[v] + slab->last[v], s);
    s->position = all->position;
  }
}

/* ---- lights ---- */

#if LIT && SHADOWED

/* The lengths of the light's ways through all volumes, as find_ways() in render/light_depth_lanes.h. deep:
 * receives whether the sample is far from the faces of each volume. */
DEVICE light_ways ways_through_volumes(const volume_data *first, GLOBAL const plan_light *light,
                                       shared_slab *slab, vector towards, float path, int deep[VOLUMES]) {
  const slab_sample *all = &slab->all;
  light_ways whole, sum;
  whole.first = all->part.begin * path;
  whole.last = (all->part.begin + all->part.length) * path;
  sum.first = sum.last = 0.0f;
  for (int v = 0; v < VOLUMES; v++) {
    if (!slab->here[v]) continue;
    light_ways own = whole;
    deep[v] = 1;
#if BOXED
    const volume_data volume = volume_of(first, v);
    if (volume.plan->boxed) deep[v] = is_deep(&volume, light, &slab->of[v]);
    if (!deep[v])
      own = ways_in_box(&volume, light, add_scaled(all->start, all->step_sheet, all->part.begin),
                        scaled(all->step_sheet, all->part.length), towards, whole);
#else
    (void)first, (void)light, (void)towards;
#endif
    slab->light_first[v] = own.first;
    slab->light_last[v] = own.last;
    sum.first = sum.first + own.first;
    sum.last = sum.last + own.last;
  }
  sum.first = lesser(sum.first, whole.first);
  sum.last = lesser(sum.last, whole.last);
  return sum;
}

/* The light's transmittance to the media of a slab, as passing_to_media() in render/reaching_lanes.h. */
DEVICE void passing_to_media(const volume_data *first, vector normal, GLOBAL const plan_light *light,
                             shared_slab *slab, vector towards, float path, const light_buffers *buffers,
                             float passing[CHANNELS]) {
  const shadow_taps taps = taps_of_position(light, slab->all.position);
  light_depths depths = no_depths();
  float at_first[CHANNELS], at_last[CHANNELS];
  int deep[VOLUMES];
  const light_ways ways = ways_through_volumes(first, light, slab, towards, path, deep);
  const float length = greater(ways.last, ways.first) - ways.first;
  for (int c = 0; c < CHANNELS; c++) at_first[c] = at_last[c] = 0.0f;
#if BOXED
  float before[CHANNELS][NEAR_PIXELS];
  for (int i = 0; i < CHANNELS * NEAR_PIXELS; i++) before[i / NEAR_PIXELS][i % NEAR_PIXELS] = 0.0f;
  const near_pixels close_pixels = pixels_around(light, buffers, &taps, normal, slab->all.position);
#else
  (void)normal;
#endif
  for (int v = 0; v < VOLUMES; v++) {
    if (!slab->here[v]) continue;
    const volume_data volume = volume_of(first, v);
    const slab_sample *s = &slab->of[v];
    const float extinction = extinction_towards(&volume, s, towards, fused(length, s->seen, ways.first));
#if BOXED
    if (!light->nearest && !deep[v])
      add_face(&volume, light, s, slab->own[v].length, towards, path, &close_pixels, before, &depths);
#endif
    for (int c = 0; c < CHANNELS; c++) {
      const float cast = extinction * volume.plan->cast[c];
      at_first[c] = fused(cast, slab->light_first[v], at_first[c]);
      at_last[c] = fused(cast, slab->light_last[v], at_last[c]);
    }
  }
#if BOXED
  if (depths.face) add_before(before, &depths);
#endif
  for (int c = 0; c < CHANNELS; c++) {
    at_last[c] = greater(at_last[c], at_first[c]);
    depths.enter[c] = BACK_TO_FRONT ? at_last[c] : at_first[c];
    depths.more[c] = BACK_TO_FRONT ? at_first[c] - at_last[c] : at_last[c] - at_first[c];
  }
  passing_depths(light, &slab->all, buffers, &taps, &depths, passing);
}

#if OUTSIDE

/* The fraction of the light absorbed before the slab that still lights a sample's surface, as
 * kept_among_several() in render/reaching_lanes.h. there: the number of volumes with matter where the light's
 * way begins. */
DEVICE float kept_among_several(const volume_data *volume, const slab_sample *s, const way_begin *begin,
                                float kept, int there, surface_light light, float beside) {
  if (there == 0 || (there == 1 && begin->there)) return kept;
  const float integral = magnitude(integral_to(volume->tables, begin->start) -
                                   integral_to(volume->tables, begin->first));
  const float depth = begin->there ? greatest_depth_of_surface(integral * volume->plan->cast[0],
                                                               magnitude(begin->change))
                                   : 0.0f;
  const float part = part_of_matter(depth, light.passed, light.outside, beside);
  return lesser(kept, greater(part, skin_of_sample(s)));
}

/* The mean of the volumes' own surfaces, as find_own_surfaces() in render/reaching_lanes.h. */
DEVICE own_surface find_own_surfaces(const volume_data *first, const shared_slab *slab, vector towards,
                                     float way, surface_light light, float beside) {
  float total = 0.0f;
  int there = 0;
  own_surface sum;
  sum.kept = sum.passing = 0.0f;
  for (int v = 0; v < VOLUMES; v++) {
    if (!slab->here[v]) continue;
    const volume_data volume = volume_of(first, v);
    if (volume.plan->visible && volume.plan->phong) total = total + slab->of[v].extinction;
    there += find_begin(&volume, &slab->of[v], towards, way).there != 0;
  }
  const float inverse = divided(1.0f, greater(total, 1e-30f));
  for (int v = 0; v < VOLUMES; v++) {
    const volume_data volume = volume_of(first, v);
    const slab_sample *s = &slab->of[v];
    if (!(slab->here[v] && volume.plan->visible && volume.plan->phong)) continue;
    const way_begin begin = find_begin(&volume, s, towards, way);
    const own_surface own = find_own_surface(&volume, s, &begin, light.passed, light.outside);
    const float weight = s->extinction == total ? 1.0f : s->extinction * inverse;
    sum.kept = fused(kept_among_several(&volume, s, &begin, own.kept, there, light, beside), weight,
                     sum.kept);
    sum.passing = fused(own.passing, weight, sum.passing);
  }
  return sum;
}

/* The greatest transmittance of the first channel in the pixels around a place, as light_beside() in
 * render/reaching_lanes.h. passed: the transmittance at the place. */
DEVICE float light_beside(GLOBAL const plan_light *light, const shadow_taps *taps,
                          const light_buffers *buffers, float passed) {
#if SUBLIGHTS
  if (light->sublights > 0) return passed;
#endif
  (void)passed;
  GLOBAL const float *plane = buffers->planes + light->origin;
  const float younger = greatest_tap(light, taps, plane);
#if SOFT
  if (light->soft)
    return between_chunks(greatest_tap(light, taps, plane + OLDER_PLANE * light->plane), younger,
                          buffers->young);
#endif
  return younger;
}

/* The light at the outside of the surfaces in a slab. */
DEVICE void passing_to_surfaces(const volume_data *first, GLOBAL const plan_light *light,
                                const shared_slab *slab, vector towards, float way,
                                const light_buffers *buffers, float passing[CHANNELS]) {
  const shadow_taps taps = taps_of_position(light, slab->all.position);
  const sublight_means means = means_for_surface(light, &slab->all, buffers, 1);
  own_surface own;
  own.kept = own.passing = 1.0f;
  for (int c = 0; c < CHANNELS; c++) {
    const surface_light found = light_for_surface(light, &taps, buffers, &means, c, 1);
    if (c == 0)
      own = find_own_surfaces(first, slab, towards, way, found,
                              light_beside(light, &taps, buffers, found.passed));
    passing[c] = lesser(light_of_own_surface(found, own), 1.0f);
  }
}

#endif

/* Multiplies a light's `arriving` light by the transmittance of the matter on the light's way to a slab. */
DEVICE void shadow_slab(GLOBAL const device_sweep *plan, const volume_data *first,
                        GLOBAL const plan_light *light, const light_buffers *buffers, shared_slab *slab,
                        const full_light *full, arriving_light *arriving) {
  float passing[CHANNELS], transmittance = 1.0f;
  int media = 0, surfaces = 0;
  for (int v = 0; v < VOLUMES; v++) {
    if (!(slab->here[v] && first->plan[v].visible && first->plan[v].receives_shadow)) continue;
    media = media || slab->of[v].surface < 1.0f;
    surfaces = surfaces || slab->of[v].surface > 0.0f;
  }
  if (media) {
    passing_to_media(first, vector_at(plan->normal), light, slab, full->towards, full->path, buffers,
                     passing);
    for (int c = 0; c < 3; c++) {
      if (c < CHANNELS) transmittance = passing[c];
      arriving->on_medium[c] = arriving->on_medium[c] * transmittance;
    }
  }
#if OUTSIDE
  if (!surfaces) return;
  passing_to_surfaces(first, light, slab, full->towards, slab->all.place * full->path, buffers, passing);
  for (int c = 0; c < 3; c++) {
    if (c < CHANNELS) transmittance = passing[c];
    arriving->on_surface[c] = arriving->on_surface[c] * transmittance;
  }
#else
  (void)surfaces;
#endif
}

#endif

/* Returns whether light from a direction lights anything of a slab. */
DEVICE int is_faced(const volume_data *first, const shared_slab *slab, vector towards) {
  int faced = 0;
  for (int v = 0; v < VOLUMES; v++)
    faced = faced || (slab->here[v] && first->plan[v].visible && first->plan[v].lit &&
                      (slab->of[v].surface < 1.0f || dot3(slab->of[v].normal, towards) > 0.0f));
  return faced;
}

/* Returns whether a volume is seen in a slab. */
DEVICE int shows_in_slab(const volume_data *first, const shared_slab *slab, int v) {
  return slab->here[v] && first->plan[v].visible && slab->of[v].extinction > 0.0f;
}

#if LIT

/* Adds the light from one light source that each volume sends to the eye. */
DEVICE void add_light_of_slab(GLOBAL const device_sweep *plan, const volume_data *first,
                              GLOBAL const plan_light *light, const light_buffers *buffers, shared_slab *slab,
                              const vector color[VOLUMES], vector lit[VOLUMES]) {
  const full_light full = light_at_sample(plan, light, buffers, &slab->all);
  arriving_light arriving = full.arriving;
  if (!is_faced(first, slab, full.towards)) return;
#if SHADOWED
  if (light->shadowed && is_bright(&full.arriving))
    shadow_slab(plan, first, light, buffers, slab, &full, &arriving);
#endif
  for (int v = 0; v < VOLUMES; v++) {
    if (!(shows_in_slab(first, slab, v) && first->plan[v].lit)) continue;
    const volume_data volume = volume_of(first, v);
    const arriving_light own = volume.plan->receives_shadow ? arriving : full.arriving;
    add_arriving(plan, &volume, light, &own, &slab->of[v], full.towards, color[v], &lit[v]);
  }
}

#endif

/* The light that a slab sends to the eye: the mean of the volumes' lit colours, weighted by their
 * extinctions. The arguments are those of color_of_slab(). */
DEVICE vector color_of_shared(GLOBAL const device_sweep *plan, const volume_data *first,
                              GLOBAL const short *sky, const light_buffers *buffers,
                              GLOBAL const plan_rays *rays, int slot, shared_slab *slab) {
  vector color[VOLUMES], lit[VOLUMES], sum = vector_of(0.0f, 0.0f, 0.0f);
  const float inverse = divided(1.0f, greater(slab->all.extinction, 1e-30f));
  for (int v = 0; v < VOLUMES; v++) {
    if (!shows_in_slab(first, slab, v)) continue;
    const volume_data volume = volume_of(first, v);
    color[v] = color_of_matter(&volume, &slab->of[v]);
    lit[v] = even_light(plan, &volume, color[v]);
  }
#if LIT
  for (int i = 0; i < plan->light_count; i++) {
    GLOBAL const plan_light *light = &plan->lights[i];
    const light_buffers own = buffers_of_light(light, buffers, slot,
                                               SOFT ? rays[(3 + 2 * i) * plan->sheets].young : 0.0f);
    add_light_of_slab(plan, first, light, &own, slab, color, lit);
  }
#else
  (void)buffers, (void)slot;
#endif
  (void)rays, (void)sky;
  for (int v = 0; v < VOLUMES; v++) {
    if (!shows_in_slab(first, slab, v)) continue;
#if SKY
    const volume_data volume = volume_of(first, v);
    if (volume.plan->lit) lit[v] = with_sky(plan, &volume, sky, &slab->of[v], color[v], lit[v]);
#endif
    const float own = slab->of[v].extinction, weight = own == slab->all.extinction ? 1.0f : own * inverse;
    sum = vector_of(fused(lit[v].x, weight, sum.x), fused(lit[v].y, weight, sum.y),
                    fused(lit[v].z, weight, sum.z));
  }
  return sum;
}

#endif

#endif
