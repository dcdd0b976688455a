/* gpu/kernels/sweep.h - does the work of the kernels on a run of a few successive slabs.
 *
 * In a light's buffer, a member composites all slabs of the run into its pixel. The picture takes three
 * steps. First each pixel lists the slabs in which it may see something. Then each listed slab is lit, by any
 * member. Last, each pixel composites its own slabs, in order. The list gives all members equal work:
 * lighting a slab takes long, and some pixels see many slabs and others none. If a ray can see nothing on
 * both sheets of a slab, the densities on these sheets are not computed. */
#ifndef HL_GPU_SWEEP_H
#define HL_GPU_SWEEP_H

#include "core/sheet_constants.h"
#include "gpu/kernels/maximum.h"
#include "gpu/kernels/shade.h"

/* The state of a pixel's ray on its way from sheet to sheet: the densities on the last two sheets, as far as
 * they are known. */
typedef struct sheet_way {
  int before_known, after_known;
  int before_shows, after_shows; /* whether the density on the sheet is known, and greater than all densities
                                  * before the first visible density */
  float before, after;
} sheet_way;

DEVICE sheet_way no_sheets(void) {
  sheet_way way;
  way.before_known = way.before_shows = way.after_known = way.after_shows = 0;
  way.before = way.after = 0.0f;
  return way;
}

/* Finds the densities of a pixel on a sheet and on the sheet before, if they are needed. The density on this
 * sheet is needed if the point's cell may show something. If one of the two densities shows something, the
 * other one is needed, too. If one member of a pack needs a density, all members of the pack compute theirs.
 * When the function is called, way->after must be the density on the sheet before. starts: whether the ray
 * starts at this sheet: nothing is known of the sheet before, and only this sheet's density is wanted. rays:
 * the rays at the sheet. speed: the number of voxels by which the ray advances from sheet to sheet, along the
 * axis where it is fastest. Returns the number of sheets from this sheet to the next sheet at which the ray
 * may meet anything. The sums are computed in a loop of two passes, so that their code exists once. */
DEVICE int fill_way(const volume_data *volume, GLOBAL const plan_rays *rays, int perspective, float u,
                    float v, float speed, int starts, sheet_way *way) {
  GLOBAL const plan_volume *plan = volume->plan;
  grid_point point = point_in_grid(plan, position_on(rays, perspective, u, v));
  float voxels;
  way->before = way->after;
  way->before_known = way->after_known;
  way->before_shows = way->after_shows;
  way->after_shows = 0;
  way->after = 0.0f;
  const int may_show = cell_may_show(volume, &point, &voxels);
  int wanted = way->after_known = any_of_pack(may_show);
  for (int pass = 0; pass < 2; pass++) {
    if (wanted) {
      float found = point.inside ? density_at(*volume, point.at[0], point.at[1], point.at[2]) : 0.0f;
      if (pass == 0) {
        way->after = found;
        way->after_shows = may_show && shown_coordinate(plan, found) > plan->first_visible;
      } else if (way->after_shows) {
        way->before = found;
      } else {
        way->after = found;
        way->after_known = 1;
      }
    }
    if (pass == 1 || starts) break;
    wanted = (way->after_shows && !way->before_known) || (way->before_shows && !way->after_known);
    if (way->after_shows && !way->before_known)
      point = point_in_grid(plan, position_on(rays - 1, perspective, u, v));
  }
  return 1 + (int)lesser(divided(voxels, speed), 1000.0f);
}

/* Slabs of a run. */
typedef struct slab_range {
  int first, end;
} slab_range;

/* The slabs of a run in which a ray may meet anything. */
DEVICE slab_range slabs_with_content(GLOBAL const plan_box *content, float u, float v, float spacing,
                                     int first, int end) {
  heights_in_box heights = heights_of(content, u, v);
  slab_range range;
  range.first = first;
  range.end = heights.enter > heights.leave ? first : end;
  float low = divided(heights.enter, spacing) - 1.0f, high = divided(heights.leave, spacing) + 3.0f;
  if (low > (float)first) range.first = low < (float)end ? (int)low : end;
  if (high < (float)end) range.end = high > (float)first ? (int)high : first;
  return range;
}

/* The number of voxels by which a ray advances from sheet to sheet, and a little more for rounding. */
DEVICE float speed_of_ray(GLOBAL const plan_rays *rays, int perspective, float u, float v) {
  vector a = position_on(rays, perspective, u, v), b = position_on(rays + 1, perspective, u, v);
  float x = magnitude(b.x - a.x), y = magnitude(b.y - a.y), z = magnitude(b.z - a.z);
  return greater(greater(x, greater(y, z)) * 1.01f, 1e-3f);
}

/* The data that all members of a kernel read and write. */
typedef struct sweep_data {
  GLOBAL const device_sweep *plan;
  /* [2 + 2 lights][sheets]: the eye's rays in index space at each sheet; the eye's rays in frame space in the
   * middle of the slab before each sheet; then for each light its rays in index space and in frame space at
   * each sheet. */
  GLOBAL const plan_rays *rays;
  volume_data volume;
  GLOBAL float *pixels; /* [tiles][16 blocks][R G B A][16]; in a maximum projection the four numbers are
                         * those of ray_maximum, and one more that is not used */
  GLOBAL float *planes; /* planes of all lights */
  GLOBAL float *light;  /* [light tiles][planes of a sheet][256 pixels]; the light at the last sheet of the
                         * run before */
  GLOBAL float *soft; /* [light tiles][channels][2][256 pixels]; of soft lights: the sum of the light that the
                       * chunk's slabs absorbed, each times the slab's position, and 1 - the light at the
                       * chunk's beginning */
  GLOBAL const plan_sublight *sublights; /* [sub-lights of all lights] */
  GLOBAL const word16 *of_sublights;     /* the planes of all sub-lights */
  GLOBAL const plan_texture *textures;   /* [lights]; read only if some light projects an image */
  GLOBAL int *touched;                   /* [light tiles]; the last chunk whose slabs absorbed light there */
  GLOBAL const short *sky; /* the cells of the sky's field; read only if the variant has a sky */
  GLOBAL int *changed;     /* [light tiles][256 pixels]; the last sheet at which the pixel's light changed */
  GLOBAL const int *shown_from; /* [tiles][16] */
  GLOBAL unsigned *counts;      /* [256], then [runs]. The first 256 numbers count composited samples; tile t
                                 * adds its samples to number t % 256. The others are the lengths of the
                                 * lists */
  /* [slabs of a run][256 * tiles pixels][4]; a slot for each pixel and slab. At first a slot holds the
   * densities on the slab's two sheets. Later it holds the light that the slab sends to the eye (R, G, B),
   * and the slab's opacity, which is -1 if nothing is seen. Of this array and of the next two there are two
   * copies: one for even runs, one for odd runs. */
  GLOBAL float *slots;
  GLOBAL unsigned *list;  /* [slabs of a run * 256 * tiles]; the numbers of the slots that are in use */
  GLOBAL unsigned *masks; /* [256 * tiles]; bit k of a pixel's mask is set if the pixel uses its slot for the
                           * run's k-th slab */
} sweep_data;

DEVICE int column_of(int member) { return (member >> 4 & 3) * 4 + (member & 3); }
DEVICE int row_of(int member) { return (member >> 6) * 4 + (member >> 2 & 3); }

/* The part of a pixel's ray that the volume's box and cuts leave. */
typedef struct ray_left {
  float u, v;
  GLOBAL const plan_cut *cuts; /* [cut_count]; the cuts of the pixel's view */
  int cut_count;
  heights_in_box in_box; /* of heights_left() */
} ray_left;

DEVICE ray_left left_of_ray(GLOBAL const plan_box *box, GLOBAL const plan_cut *cuts, int cut_count, float u,
                            float v) {
  ray_left ray;
  ray.u = u;
  ray.v = v;
  ray.cuts = cuts;
  ray.cut_count = cut_count;
#if BOXED
  ray.in_box = heights_left(box, cuts, CUTS ? cut_count : 0, u, v);
#else
  (void)box;
  ray.in_box.enter = ray.in_box.leave = 0.0f;
#endif
  return ray;
}

/* The heights between which the volume's box and cuts leave matter in the slab that ends at a sheet. */
DEVICE heights_in_box heights_left_in_slab(const ray_left *ray, float height, float spacing) {
#if CUTS
  return heights_in_slab(ray->in_box, ray->cuts, ray->cut_count, ray->u, ray->v, height, spacing);
#else
  (void)height;
  (void)spacing;
  return ray->in_box;
#endif
}

/* The part that the volume's box and cuts leave of the slab that ends at a sheet. */
DEVICE covered_span part_of_slab(const ray_left *ray, float height, float spacing) {
#if BOXED
  return covered(heights_left_in_slab(ray, height, spacing), height, spacing);
#else
  (void)ray;
  (void)height;
  (void)spacing;
  return whole_slab();
#endif
}

/* ---- the picture ---- */

/* A member's pixel. */
typedef struct tile_pixel {
  int tile, member, inside; /* inside: whether some pixel of this pixel's block lies in the picture */
  float u, v;
} tile_pixel;

DEVICE tile_pixel pixel_of(GLOBAL const device_sweep *plan, int number) {
  tile_pixel pixel;
  pixel.tile = number / 256;
  pixel.member = number % 256;
  int x = pixel.tile % plan->tiles_x * 16, y = pixel.tile / plan->tiles_x * 16, block = pixel.member >> 4;
  pixel.inside = x + (block & 3) * 4 < plan->width && y + (block >> 2) * 4 < plan->height;
  pixel.u = (float)(x + column_of(pixel.member));
  pixel.v = (float)(y + row_of(pixel.member));
  return pixel;
}

DEVICE GLOBAL float *values_of(GLOBAL float *pixels, const tile_pixel *pixel) {
  return pixels + (wide)pixel->tile * 1024 + (pixel->member >> 4) * 64 + (pixel->member & 15);
}

/* Takes the values of a slab into account in a maximum projection. before, after: the densities on the slab's
 * two sheets. Returns whether the slab shows any value. */
DEVICE int take_values(const sweep_data *sweep, const tile_pixel *pixel, int sheet, float before,
                       float after) {
  GLOBAL const device_sweep *plan = sweep->plan;
  const volume_data *volume = &sweep->volume;
  GLOBAL const plan_rays *rays = sweep->rays + plan->sheets + sheet;
  table_coordinate a = coordinate_of_density(volume->plan, before),
                   b = coordinate_of_density(volume->plan, after);
  const ray_left left = left_of_ray(&plan->box, volume->cuts, volume->plan->cut_count, pixel->u, pixel->v);
  covered_span part = part_of_slab(&left, rays->height, plan->spacing);
  slab_sample s;
  find_geometry(plan, rays, pixel->u, pixel->v, &s);
#if MASKED
  const mask_data walls = mask_of_volume(volume);
  part = part_within_walls(depth_behind_walls(&walls, add_scaled(s.position, s.step_sheet, -0.5f)),
                           depth_behind_walls(&walls, add_scaled(s.position, s.step_sheet, 0.5f)), part);
#endif
#if BOXED || MASKED
  cut_way(part, &a, &b);
#endif
  GLOBAL float *values = values_of(sweep->pixels, pixel);
  ray_maximum ray;
  ray.greatest = values[0];
  ray.before = values[16];
  ray.sheet = values[32];
  const int shows = take_slab(shown_values_table(volume->tables), sheet, a.x, b.x,
                              s.path > 0.0f ? part.length : 0.0f, &ray);
  values[0] = ray.greatest;
  values[16] = ray.before;
  values[32] = ray.sheet;
  return shows;
}

/* Lists the slabs of a run that a pixel may see, or finds the greatest value in them. Returns a bit for each
 * of these slabs that is listed. count: the counter of the list's entries. */
DEVICE unsigned find_slabs(const sweep_data *sweep, int number, int run_first, int end,
                           GLOBAL unsigned *count) {
  GLOBAL const device_sweep *plan = sweep->plan;
  GLOBAL const plan_volume *volume = sweep->volume.plan;
  const tile_pixel pixel = pixel_of(plan, number);
  if (!pixel.inside) return 0;
  int first = run_first;
#if BACK_TO_FRONT
  const int shown_from = sweep->shown_from[pixel.tile * 16 + (pixel.member >> 4)];
  if (first < shown_from) first = shown_from;
#else
  if (!(values_of(sweep->pixels, &pixel)[48] < PIXEL_OPAQUE)) return 0;
#endif
  slab_range slabs = slabs_with_content(&plan->content, pixel.u, pixel.v, plan->spacing, first, end);
  if (slabs.first >= slabs.end) return 0;
  slabs.first = least_of_pack(slabs.first); /* all members of a pack work on the same sheet at a time; each
                                             * member leaves out the slabs before its own `first` */
  const float speed = speed_of_ray(sweep->rays + slabs.first - 1, EYE_PERSPECTIVE, pixel.u, pixel.v);
  sheet_way way = no_sheets();
  unsigned mask = 0, samples = 0;
  for (int sheet = slabs.first - 1, step; sheet < slabs.end; sheet += step) {
    step = fill_way(&sweep->volume, sweep->rays + sheet, EYE_PERSPECTIVE, pixel.u, pixel.v, speed,
                    sheet == slabs.first - 1, &way);
    if ((way.before_shows || way.after_shows) && sheet >= first &&
        may_be_visible(volume, coordinate_of_density(volume, way.before),
                       coordinate_of_density(volume, way.after))) {
#if MAXIMUM
      samples += (unsigned)take_values(sweep, &pixel, sheet, way.before, way.after);
#else
      unsigned slot = (unsigned)(sheet - run_first) * (unsigned)(plan->tiles * 256) + (unsigned)number;
      sweep->slots[(wide)slot * 4] = way.before;
      sweep->slots[(wide)slot * 4 + 1] = way.after;
      sweep->list[add_to(count, 1u)] = slot;
      mask |= 1u << (sheet - run_first);
#endif
    }
    step = least_of_pack(step);
    if (step > 1) way.after_known = way.after_shows = 0;
  }
#if MAXIMUM
  add_to(sweep->counts + (pixel.tile & 255), samples);
  (void)count;
#else
  (void)samples;
#endif
  return mask;
}

/* Classifies and lights the slab of a slot. */
DEVICE void shade_slot(const sweep_data *sweep, unsigned slot, int run_first) {
  GLOBAL const device_sweep *plan = sweep->plan;
  const volume_data *volume = &sweep->volume;
  const int sheet = run_first + (int)(slot / (unsigned)(plan->tiles * 256));
  const tile_pixel pixel = pixel_of(plan, (int)(slot % (unsigned)(plan->tiles * 256)));
  GLOBAL float *at = sweep->slots + (wide)slot * 4;
  GLOBAL const plan_rays *rays = sweep->rays + plan->sheets + sheet;
  const float before = at[0], after = at[1];
  table_coordinate a = coordinate_of_density(volume->plan, before),
                   b = coordinate_of_density(volume->plan, after);
  const ray_left ray = left_of_ray(&plan->box, volume->cuts, volume->plan->cut_count, pixel.u, pixel.v);
  slab_sample s;
  s.part = part_of_slab(&ray, rays->height, plan->spacing);
#if BOXED
  cut_way(s.part, &a, &b);
#endif
  s.before = a.x;
  s.after = b.x;
  s.sums = sums_of_way(volume->tables, a, b);
  s.extinction = s.sums.extinction * s.part.length;
  at[3] = -1.0f;
  if (!(s.extinction > 0.0f)) return;
  place_slab(plan, rays, pixel.u, pixel.v, &s);
#if WEIGHED
  weigh_slab(plan, rays, pixel.u, pixel.v, volume, &s);
  if (!(s.extinction > 0.0f)) return;
#endif
  find_normal(volume, before + after, &s);
  light_buffers buffers;
  buffers.planes = sweep->planes;
  buffers.young = 0.0f;
#if SUBLIGHTS
  buffers.sublights = sweep->sublights;
  buffers.of_sublights = sweep->of_sublights;
#endif
#if TEXTURES
  buffers.textures = sweep->textures;
#endif
  vector lit = color_of_slab(plan, volume, sweep->sky, &buffers, rays - plan->sheets,
                             (sheet - 1) % plan->ring, &s);
  at[0] = lit.x;
  at[1] = lit.y;
  at[2] = lit.z;
  at[3] = s.opacity;
}

/* Composites a pixel's slabs of a run, in order. */
DEVICE void composite_slabs(const sweep_data *sweep, int number) {
  GLOBAL const device_sweep *plan = sweep->plan;
  unsigned mask = sweep->masks[number], samples = 0;
  if (mask == 0) return;
  const tile_pixel place = pixel_of(plan, number);
  GLOBAL float *values = values_of(sweep->pixels, &place);
  float pixel[4];
  for (int c = 0; c < 4; c++) pixel[c] = values[c * 16];
  for (unsigned k = 0; mask != 0 && (BACK_TO_FRONT || pixel[3] < PIXEL_OPAQUE); k++, mask >>= 1) {
    if ((mask & 1) == 0) continue;
    GLOBAL const float *at = sweep->slots + ((wide)k * (wide)(plan->tiles * 256) + (wide)number) * 4;
    const float opacity = at[3];
    if (opacity < 0.0f) continue;
    float weight = BACK_TO_FRONT ? opacity : opacity * (1.0f - pixel[3]);
    float keep = BACK_TO_FRONT ? 1.0f - opacity : 1.0f;
    for (int c = 0; c < 3; c++) pixel[c] = fused(at[c], weight, pixel[c] * keep);
    pixel[3] = fused(pixel[3], keep, weight);
    samples++;
  }
  if (samples == 0) return;
  for (int c = 0; c < 4; c++) values[c * 16] = pixel[c];
  add_to(sweep->counts + (place.tile & 255), samples);
}

/* ---- the lights ---- */

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
DEVICE float factor_in_slab(const sweep_data *sweep, GLOBAL const plan_light *light,
                            GLOBAL const plan_rays *in_frame, const ray_left *ray, covered_span part, float a,
                            float b, const way_sums *sums) {
  const way_means means = means_of_way(a, b, sums);
  const float centre = fused(part.length, divided(means.from_a, means.from_a + means.from_b), part.begin);
  const vector end = position_on(in_frame, !light->parallel, ray->u, ray->v);
  const vector step = light->parallel
                          ? vector_at(light->through)
                          : scaled(direction_of(in_frame, ray->u, ray->v),
                                   divided(sweep->plan->spacing, climb_of(in_frame, ray->u, ray->v)));
  const vector point = add_scaled(end, step, centre - 1.0f);
  return factor_of_matter(&sweep->volume, point, a, b, sums->extinction).factor;
}

/* The effect of a slab on the light of a pixel. SLAB_TAKES: the slab absorbs light. SLAB_HIDES: the slab
 * absorbs no light, but it ends surfaces, because a factor hides its matter. */
#define SLAB_TAKES 1
#define SLAB_HIDES 2

/* Multiplies the light by the transmittance of a slab. Returns 0, SLAB_TAKES or SLAB_HIDES. */
DEVICE int attenuate_slab(const sweep_data *sweep, GLOBAL const plan_light *light,
                          GLOBAL const plan_rays *in_index, GLOBAL const plan_rays *in_frame,
                          const ray_left *ray, float before, float after, light_pixel *pixel) {
  GLOBAL const device_sweep *plan = sweep->plan;
  GLOBAL const plan_volume *volume = sweep->volume.plan;
  table_coordinate a = coordinate_of_density(volume, before), b = coordinate_of_density(volume, after);
  if (!may_be_visible(volume, a, b)) return 0;
#if BOXED
  const heights_in_box left = heights_left_in_slab(ray, in_frame->height, plan->spacing);
  const covered_span part = covered(left, in_frame->height, plan->spacing);
  /* whether light leaves the matter in the slab, or at the slab's end */
  const int ends = left.leave <= in_frame->height;
  cut_way(part, &a, &b);
#else
  const covered_span part = whole_slab();
  const int ends = 0;
#endif
  (void)ends;
  const way_sums sums = sums_of_way(sweep->volume.tables, a, b);
  float extinction = sums.extinction * part.length, all = 0.0f;
  if (!(extinction > 0.0f)) return 0;
#if WEIGHED
  extinction = extinction * factor_in_slab(sweep, light, in_frame, ray, part, a.x, b.x, &sums);
  if (!(extinction > 0.0f)) return SLAB_HIDES;
#endif
  for (int c = 0; c < CHANNELS; c++) all = all + fused(extinction, volume->weight[c], 0.0f);
  if (!(all > 0.0f)) return 0;
  float path = path_through_sheet(in_frame, !light->parallel, light->slab_path, ray->u, ray->v);
#if OUTSIDE
  const float skin = BOXED && volume->faces_take
                         ? skin_of_faces(&sweep->volume, light, in_index - 1, ray->u, ray->v)
                         : 0.0f;
  kept_light kept = kept_in_slab(&sweep->volume, a, b, &sums, part.length * path, extinction * path, skin,
                                 pixel->passing[0], pixel->passing[CHANNELS]);
  if (ends || (CUTS && volume->faces_take && light_left(light, pixel) < DARK &&
               nears_inner_corner(&sweep->volume, light, in_index - 1, ray->u, ray->v)))
    kept.before = kept.within = 0.0f;
#endif
  for (int c = 0; c < CHANNELS; c++) {
    float depth = fused(extinction, volume->weight[c], 0.0f), light_before = pixel->passing[c];
    const float passing = exp_negative(depth * path);
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
                                                kept);
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
