/* gpu/kernels/attenuate.h - lets the matter of a slab absorb the light in a pixel of a light's buffer. The
 * functions compute for one pixel the same numbers as shadow/attenuate_lanes.h for sixteen pixels. */
#ifndef HL_GPU_ATTENUATE_H
#define HL_GPU_ATTENUATE_H

#include "gpu/kernels/slabs.h"

/* A pixel of a light's buffer: T, then Y (shadow/attenuate.h) if there are surfaces, then the light from
 * which samples of soft lights fade. */
typedef struct light_pixel {
  float passing[PLANES_OF_SHEET];
#if SOFT
  float moment[CHANNELS];
#endif
#if SUBLIGHTS
  /* the light of the first channel that is left of all the light of the sub-lights' centre; passing[0] is the
   * transmittance of the slab alone there */
  float left;
#endif
} light_pixel;

/* The light of the first channel that is left of all the light that the lamp sends. */
DEVICE float light_left(GLOBAL const plan_light *light, const light_pixel *pixel) {
#if SUBLIGHTS
  if (light->sublights > 0) return pixel->left;
#endif
  (void)light;
  return pixel->passing[0];
}

/* The factor by which matter_factor multiplies a slab's extinction. It is found at the centre of
 * gravity of the slab's matter. */
DEVICE float factor_in_slab(const sweep_data *sweep, const volume_data *volume,
                            GLOBAL const plan_light *light, GLOBAL const plan_rays *in_frame,
                            const ray_left *ray, covered_span part, float a, float b, const way_sums *sums) {
  const way_means means = means_of_way(a, b, sums);
  const float centre = fused(part.length, divided(means.from_a, means.from_a + means.from_b), part.begin);
  const vector end = position_on(in_frame, !light->parallel, ray->u, ray->v);
  const vector step = light->parallel
                          ? vector_at(light->through)
                          : scaled(direction_of(in_frame, ray->u, ray->v),
                                   divided(sweep->plan->spacing, climb_of(in_frame, ray->u, ray->v)));
  const vector point = add_scaled(end, step, centre - 1.0f);
  return factor_of_matter(volume, point, a, b, sums->extinction).factor;
}

/* The effect of a slab on the light of a pixel. SLAB_TAKES: the slab absorbs light. SLAB_HIDES: the slab
 * absorbs no light, but it ends surfaces, because a factor hides its matter. */
#define SLAB_TAKES 1
#define SLAB_HIDES 2

/* What the matter of a slab does to the light of a pixel. */
typedef struct slab_matter {
  float depth[CHANNELS]; /* extinctions */
  int hidden;            /* whether a factor hides matter */
#if OUTSIDE
  kept_light kept;
#if VOLUMES > 1
  int there;           /* whether the volume has matter where the light enters the slab */
  float entered_depth; /* a bound of the optical depth of the volume's surface up to this place */
#endif
#endif
} slab_matter;

#if OUTSIDE && VOLUMES > 1

/* Finds a volume's matter where the light enters a slab, as find_matter_at_entry() in
 * shadow/attenuate_lanes.h. way: the length of the light's way through the part of the slab that is in the
 * box. */
DEVICE void find_matter_at_entry(const volume_data *data, table_coordinate a, table_coordinate b,
                                 const way_sums *sums, float way, slab_matter *matter) {
  GLOBAL const plan_volume *volume = data->plan;
  float values[4], rise = divided(magnitude(b.x - a.x), greater(way, 1e-9f));
  table_values(sums_table(data->tables), a, 1, values);
  const float beginning = volume->several_surfaces ? beginning_at(data->tables, a.entry)
                                                   : volume->only_beginning;
  matter->there = values[0] > 0.0f;
  matter->entered_depth = greatest_depth_of_surface(magnitude(sums->to_a - beginning) * volume->weight[0],
                                                    rise);
}

#endif

/* Finds what one volume's matter does. Returns its extinction; 0 if it does nothing. number: of the volume.
 */
DEVICE float matter_in_slab(const sweep_data *sweep, int number, GLOBAL const plan_light *light,
                            GLOBAL const plan_rays *in_frame, int sheet, const ray_left *ray,
                            const sheet_way *way, const light_pixel *pixel, float path, slab_matter *matter) {
  GLOBAL const device_sweep *plan = sweep->plan;
  const volume_data data = volume_of_sweep(sweep, number);
  GLOBAL const plan_volume *volume = data.plan;
  table_coordinate a = coordinate_of_density(volume, way->before),
                   b = coordinate_of_density(volume, way->after);
  matter->hidden = 0;
  for (int c = 0; c < CHANNELS; c++) matter->depth[c] = 0.0f;
#if OUTSIDE
  matter->kept.before = matter->kept.within = 0.0f;
#endif
  if (!may_be_visible(volume, a, b)) return 0.0f;
  covered_span part = whole_slab();
  int ends = 0; /* whether light leaves the matter in the slab, or at the slab's end */
#if BOXED
  if (ray->boxed) {
    const heights_in_box left = heights_left_in_slab(ray, in_frame->height, plan->spacing);
    part = covered(left, in_frame->height, plan->spacing);
    ends = left.leave <= in_frame->height;
    cut_way(part, &a, &b);
  }
#else
  (void)plan;
#endif
  const way_sums sums = sums_of_way(data.tables, a, b);
  float extinction = sums.extinction * part.length;
  if (!(extinction > 0.0f)) return 0.0f;
#if WEIGHED
  if (is_weighed(&data)) {
    extinction = extinction * factor_in_slab(sweep, &data, light, in_frame, ray, part, a.x, b.x, &sums);
    matter->hidden = !(extinction > 0.0f);
    if (matter->hidden) return 0.0f;
  }
#endif
  for (int c = 0; c < CHANNELS; c++) matter->depth[c] = extinction * volume->weight[c];
#if OUTSIDE
#if VOLUMES > 1
  find_matter_at_entry(&data, a, b, &sums, path * part.length, matter);
#endif
  if (!HAS(volume, phong)) return extinction;
  GLOBAL const plan_rays *in_index = index_rays(sweep, 1 + light->number, number) + sheet;
  const float skin = BOXED && ray->boxed && volume->faces_take
                         ? skin_of_faces(&data, light, in_index - 1, ray->u, ray->v)
                         : 0.0f;
  matter->kept = kept_in_slab(&data, a, b, &sums, part.length * path, extinction * path, skin,
                              pixel->passing[0], pixel->passing[CHANNELS]);
  if (ends || (CUTS && volume->faces_take && light_left(light, pixel) < DARK &&
               nears_inner_corner(&data, light, in_index - 1, ray->u, ray->v)))
    matter->kept.before = matter->kept.within = 0.0f;
#else
  (void)ends, (void)sheet, (void)pixel, (void)path;
#endif
  return extinction;
}

#if VOLUMES > 1

/* Finds what the matter of all volumes does, as attenuate_block() in shadow/attenuate_lanes.h. */
DEVICE void matter_of_volumes(const sweep_data *sweep, GLOBAL const plan_light *light,
                              GLOBAL const plan_rays *in_frame, int sheet, const ray_left *rays,
                              const ways_of_ray *ways, const light_pixel *pixel, float path,
                              slab_matter *all) {
  all->hidden = 0;
  for (int c = 0; c < CHANNELS; c++) all->depth[c] = 0.0f;
#if OUTSIDE
  float total = 0.0f, newest = 0.0f;
  float all_kept = 0.0f, there = 0.0f, shared = 0.0f, within = 0.0f;
  int count = 0; /* of the volumes that have matter where the light enters the slab */
  kept_light own;
  own.before = own.within = 0.0f;
#endif
  for (int i = 0; i < VOLUMES; i++) {
    GLOBAL const plan_volume *volume = sweep->volume.plan + i;
    slab_matter matter;
    if (!(volume->casts && (ways->of[i].before_shows || ways->of[i].after_shows))) continue;
    const float extinction = matter_in_slab(sweep, i, light, in_frame, sheet, &rays[i], &ways->of[i], pixel,
                                            path, &matter);
    all->hidden = all->hidden || matter.hidden;
    if (!(extinction > 0.0f)) continue;
    for (int c = 0; c < CHANNELS; c++) all->depth[c] = fused(extinction, volume->weight[c], all->depth[c]);
#if OUTSIDE
    all_kept = fused(matter.kept.before, extinction, all_kept);
    if (matter.there) {
      const float part = part_of_matter(matter.entered_depth, pixel->passing[0], pixel->passing[CHANNELS],
                                        pixel->passing[0]);
      there = fused(matter.kept.before, extinction, there);
      shared = fused(lesser(matter.kept.before, part), extinction, shared);
      count++;
    }
    within = fused(matter.kept.within, extinction, within);
    total = total + extinction;
    newest = extinction;
    own = matter.kept;
#endif
  }
#if OUTSIDE
  const float inverse = divided(1.0f, greater(total, 1e-30f));
  const float before = count > 1 ? shared : count == 1 ? there : all_kept;
  all->kept.before = newest == total ? own.before : before * inverse;
  all->kept.within = newest == total ? own.within : within * inverse;
#endif
}

#endif

/* Multiplies the light by the transmittance of a slab. in_frame: the light's rays at the slab's last sheet.
 * rays, ways: of all volumes. Returns 0, SLAB_TAKES or SLAB_HIDES. */
DEVICE int attenuate_slab(const sweep_data *sweep, GLOBAL const plan_light *light,
                          GLOBAL const plan_rays *in_frame, int sheet, const ray_left *rays,
                          const ways_of_ray *ways, light_pixel *pixel) {
  const float path = path_through_sheet(in_frame, !light->parallel, light->slab_path, rays->u, rays->v);
  slab_matter matter;
  float all = 0.0f;
#if VOLUMES > 1
  matter_of_volumes(sweep, light, in_frame, sheet, rays, ways, pixel, path, &matter);
#else
  (void)matter_in_slab(sweep, 0, light, in_frame, sheet, rays, &ways->of[0], pixel, path, &matter);
#endif
  for (int c = 0; c < CHANNELS; c++) all = all + matter.depth[c];
  if (!(all > 0.0f)) return matter.hidden ? SLAB_HIDES : 0;
  for (int c = 0; c < CHANNELS; c++) {
    float light_before = pixel->passing[c];
    const float passing = exp_negative(matter.depth[c] * path);
    pixel->passing[c] = light_before * passing;
#if SUBLIGHTS
    if (c == 0) pixel->left = pixel->left * passing;
#endif
#if SOFT
    pixel->passing[OLDER_PLANE + c] = pixel->passing[OLDER_PLANE + c] * passing;
    pixel->moment[c] = fused(light_before - pixel->passing[c], in_frame->position, pixel->moment[c]);
#endif
#if OUTSIDE
    pixel->passing[CHANNELS + c] = pass_outside(pixel->passing[CHANNELS + c], light_before, pixel->passing[c],
                                                matter.kept);
#endif
  }
  return SLAB_TAKES;
}

/* Ends the surface in a light's pixel: sets the light at the surface's outside to the transmittance. */
DEVICE void leave_surface(light_pixel *pixel) {
  for (int c = 0; c < CHANNELS * OUTSIDE; c++)
    pixel->passing[CHANNELS + c] = greater(pixel->passing[c], 0.0f);
}

DEVICE int is_lit(const light_pixel *pixel) {
  int lit = 0;
  for (int c = 0; c < PLANES_OF_SHEET; c++) lit = lit || pixel->passing[c] >= DARK;
  return lit;
}

/* The number of the light to which a tile belongs. tile: index among the tiles of all lights. */
DEVICE int light_of_tile(GLOBAL const device_sweep *plan, int tile) {
  int light = 0;
  for (int i = 0; i < plan->light_count; i++)
    if (plan->lights[i].tiles > 0 && tile >= plan->lights[i].first_tile) light = i;
  return light;
}

#endif
