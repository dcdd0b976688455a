/* gpu/kernels/slabs.h - does the work of the kernels on a run of a few successive slabs.
 *
 * In a light's buffer, a member composites all slabs of the run into its pixel (kernels/attenuate.h). The
 * picture takes three steps. First each pixel lists the slabs in which it may see something. Then each listed
 * slab is lit, by any member. Last, each pixel composites its own slabs, in order. The list gives all members
 * equal work: lighting a slab takes long, and some pixels see many slabs and others none. If a ray can see
 * nothing on both sheets of a slab, the densities on these sheets are not computed. */
#ifndef HL_GPU_SLABS_H
#define HL_GPU_SLABS_H

#include "core/sheet_constants.h"
#include "gpu/kernels/maximum.h"
#include "gpu/kernels/several.h"
#include "gpu/kernels/shade.h"

/* The number of floats of a slot: four, or two for each volume. */
#define SLOT_FLOATS (VOLUMES > 2 ? 2 * VOLUMES : 4)

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
   * each sheet. Index space is the first volume's. The rays in the index spaces of the other volumes follow:
   * [volumes - 1][1 + lights][sheets]. */
  GLOBAL const plan_rays *rays;
  volume_data volume;   /* of several volumes, the first one */
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
  /* [slabs of a run][256 * tiles pixels][SLOT_FLOATS]; a slot for each pixel and slab. At first a slot holds
   * the densities of each volume on the slab's two sheets. Later it holds the light that the slab sends to
   * the eye (R, G, B), and the slab's opacity, which is -1 if nothing is seen. Of this array and of the next
   * two there are two copies: one for even runs, one for odd runs. */
  GLOBAL float *slots;
  GLOBAL unsigned *list;  /* [slabs of a run * 256 * tiles]; the numbers of the slots that are in use */
  GLOBAL unsigned *masks; /* [256 * tiles]; bit k of a pixel's mask is set if the pixel uses its slot for the
                           * run's k-th slab */
} sweep_data;

/* ---- the ways of a pixel's ray through all volumes ---- */

DEVICE volume_data volume_of_sweep(const sweep_data *sweep, int number) {
#if VOLUMES > 1
  return volume_of(&sweep->volume, number);
#else
  (void)number;
  return sweep->volume;
#endif
}

/* The rays of a view in a volume's index space. view: 0 for the eye, then the lights. */
DEVICE GLOBAL const plan_rays *index_rays(const sweep_data *sweep, int view, int volume) {
  const int views = 1 + sweep->plan->light_count;
  return sweep->rays + (volume == 0 ? 2 * view : (1 + volume) * views + view) * sweep->plan->sheets;
}

/* The state of a pixel's ray in all volumes. */
typedef struct ways_of_ray {
  sheet_way of[VOLUMES];
  float speed[VOLUMES];
} ways_of_ray;

/* The slabs of a run in which a ray may meet anything of a volume that counts: of a visible volume, or of one
 * that casts shadows. view: as for index_rays(). */
DEVICE slab_range slabs_of_ray(const sweep_data *sweep, int view, float u, float v, int first, int end) {
#if VOLUMES > 1
  slab_range range;
  range.first = end;
  range.end = first;
  for (int i = 0; i < VOLUMES; i++) {
    GLOBAL const plan_volume *volume = sweep->volume.plan + i;
    if (!(view == 0 ? volume->visible : volume->casts)) continue;
    const slab_range own = slabs_with_content(&sweep->volume.bounds[view * VOLUMES + i].content, u, v,
                                              sweep->plan->spacing, first, end);
    if (own.first >= own.end) continue;
    range.first = own.first < range.first ? own.first : range.first;
    range.end = own.end > range.end ? own.end : range.end;
  }
  return range;
#else
  return slabs_with_content(&sweep->volume.bounds[view].content, u, v, sweep->plan->spacing, first, end);
#endif
}

/* Begins a ray's ways at a sheet. */
DEVICE void begin_ways(const sweep_data *sweep, int view, int perspective, int sheet, float u, float v,
                       ways_of_ray *ways) {
  for (int i = 0; i < VOLUMES; i++) {
    ways->of[i] = no_sheets();
    ways->speed[i] = speed_of_ray(index_rays(sweep, view, i) + sheet, perspective, u, v);
  }
}

/* Does fill_way() for all volumes. Returns the number of sheets from this sheet to the next sheet at which
 * the ray may meet anything. */
DEVICE int fill_ways(const sweep_data *sweep, int view, int perspective, int sheet, float u, float v,
                     int starts, ways_of_ray *ways) {
  int step = 1;
  for (int i = 0; i < VOLUMES; i++) {
    const volume_data volume = volume_of_sweep(sweep, i);
    if (VOLUMES > 1 && view > 0 && !HAS(volume.plan, casts)) continue;
    const int own = fill_way(&volume, index_rays(sweep, view, i) + sheet, perspective, u, v, ways->speed[i],
                             starts, &ways->of[i]);
    step = i == 0 || own < step ? own : step;
  }
  return step;
}

/* Returns whether some volume shows anything in a slab. */
DEVICE int ways_show(const ways_of_ray *ways) {
  int shows = 0;
  for (int i = 0; i < VOLUMES; i++) shows = shows || ways->of[i].before_shows || ways->of[i].after_shows;
  return shows;
}

/* Forgets the densities on the last sheet, because the ray skips sheets. */
DEVICE void forget_ways(ways_of_ray *ways) {
  for (int i = 0; i < VOLUMES; i++) ways->of[i].after_known = ways->of[i].after_shows = 0;
}

DEVICE int column_of(int member) { return (member >> 4 & 3) * 4 + (member & 3); }
DEVICE int row_of(int member) { return (member >> 6) * 4 + (member >> 2 & 3); }

/* The part of a pixel's ray that the volume's box and cuts leave. */
typedef struct ray_left {
  float u, v;
  GLOBAL const plan_cut *cuts; /* [cut_count]; the cuts of the pixel's view */
  int cut_count, boxed;        /* boxed: whether the volume's box or a cut cuts visible matter */
  heights_in_box in_box;       /* of heights_left() */
} ray_left;

DEVICE ray_left left_of_ray(GLOBAL const plan_volume *volume, GLOBAL const plan_box *box,
                            GLOBAL const plan_cut *cuts, int cut_count, float u, float v) {
  ray_left ray;
  (void)volume;
  ray.boxed = BOXED && HAS(volume, boxed);
  ray.u = u;
  ray.v = v;
  ray.cuts = cuts;
  ray.cut_count = cut_count;
  ray.in_box.enter = ray.in_box.leave = 0.0f;
#if BOXED
  if (ray.boxed) ray.in_box = heights_left(box, cuts, CUTS ? cut_count : 0, u, v);
#else
  (void)box;
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
  if (ray->boxed) return covered(heights_left_in_slab(ray, height, spacing), height, spacing);
#else
  (void)ray;
  (void)height;
  (void)spacing;
#endif
  return whole_slab();
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
  const ray_left left = left_of_ray(volume->plan, &volume->bounds->box, volume->cuts, volume->plan->cut_count,
                                    pixel->u, pixel->v);
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

/* Returns whether the eye may see some volume in a slab. */
DEVICE int may_be_seen(const sweep_data *sweep, const ways_of_ray *ways) {
  int seen = 0;
  for (int i = 0; i < VOLUMES; i++) {
    GLOBAL const plan_volume *volume = sweep->volume.plan + i;
    const sheet_way *way = &ways->of[i];
    if (VOLUMES > 1 && !(HAS(volume, visible) && (way->before_shows || way->after_shows))) continue;
    seen = seen || may_be_visible(volume, coordinate_of_density(volume, way->before),
                                  coordinate_of_density(volume, way->after));
  }
  return seen;
}

/* Lists the slabs of a run that a pixel may see, or finds the greatest value in them. Returns a bit for each
 * of these slabs that is listed. count: the counter of the list's entries. */
DEVICE unsigned find_slabs(const sweep_data *sweep, int number, int run_first, int end,
                           GLOBAL unsigned *count) {
  GLOBAL const device_sweep *plan = sweep->plan;
  const tile_pixel pixel = pixel_of(plan, number);
  if (!pixel.inside) return 0;
  int first = run_first;
#if BACK_TO_FRONT
  const int shown_from = sweep->shown_from[pixel.tile * 16 + (pixel.member >> 4)];
  if (first < shown_from) first = shown_from;
#else
  if (!(values_of(sweep->pixels, &pixel)[48] < PIXEL_OPAQUE)) return 0;
#endif
  slab_range slabs = slabs_of_ray(sweep, 0, pixel.u, pixel.v, first, end);
  if (slabs.first >= slabs.end) return 0;
  slabs.first = least_of_pack(slabs.first); /* all members of a pack work on the same sheet at a time; each
                                             * member leaves out the slabs before its own `first` */
  ways_of_ray ways;
  begin_ways(sweep, 0, EYE_PERSPECTIVE, slabs.first - 1, pixel.u, pixel.v, &ways);
  unsigned mask = 0, samples = 0;
  for (int sheet = slabs.first - 1, step; sheet < slabs.end; sheet += step) {
    step = fill_ways(sweep, 0, EYE_PERSPECTIVE, sheet, pixel.u, pixel.v, sheet == slabs.first - 1, &ways);
    if (ways_show(&ways) && sheet >= first && may_be_seen(sweep, &ways)) {
#if MAXIMUM
      samples += (unsigned)take_values(sweep, &pixel, sheet, ways.of[0].before, ways.of[0].after);
#else
      unsigned slot = (unsigned)(sheet - run_first) * (unsigned)(plan->tiles * 256) + (unsigned)number;
      for (int i = 0; i < VOLUMES; i++) {
        GLOBAL float *at = sweep->slots + (wide)slot * SLOT_FLOATS + 2 * i;
        const int shows = VOLUMES == 1 || ways.of[i].before_shows || ways.of[i].after_shows;
        at[0] = shows ? ways.of[i].before : 0.0f;
        at[1] = shows ? ways.of[i].after : 0.0f;
      }
      sweep->list[add_to(count, 1u)] = slot;
      mask |= 1u << (sheet - run_first);
#endif
    }
    step = least_of_pack(step);
    if (step > 1) forget_ways(&ways);
  }
#if MAXIMUM
  add_to(sweep->counts + (pixel.tile & 255), samples);
  (void)count;
#else
  (void)samples;
#endif
  return mask;
}

/* The buffers of all lights, as color_of_slab() takes them. */
DEVICE light_buffers buffers_of_sweep(const sweep_data *sweep) {
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
  return buffers;
}

#if VOLUMES > 1

/* Classifies and lights the slab of a slot. */
DEVICE void shade_slot(const sweep_data *sweep, unsigned slot, int run_first) {
  GLOBAL const device_sweep *plan = sweep->plan;
  const volume_data *first = &sweep->volume;
  const int sheet = run_first + (int)(slot / (unsigned)(plan->tiles * 256));
  const tile_pixel pixel = pixel_of(plan, (int)(slot % (unsigned)(plan->tiles * 256)));
  GLOBAL float *at = sweep->slots + (wide)slot * SLOT_FLOATS;
  GLOBAL const plan_rays *rays = sweep->rays + plan->sheets + sheet;
  shared_slab slab;
  for (int i = 0; i < VOLUMES; i++) {
    const volume_data volume = volume_of(first, i);
    const float before = at[2 * i], after = at[2 * i + 1];
    slab.first[i] = before;
    slab.last[i] = after;
    slab.here[i] = may_be_visible(volume.plan, coordinate_of_density(volume.plan, before),
                                  coordinate_of_density(volume.plan, after));
    if (!slab.here[i]) continue;
    const ray_left ray = left_of_ray(volume.plan, &volume.bounds->box, volume.cuts, volume.plan->cut_count,
                                     pixel.u, pixel.v);
    slab.own[i] = part_of_slab(&ray, rays->height, plan->spacing);
  }
  classify_slab(first, &slab);
  at[3] = -1.0f;
  if (!(slab.all.extinction > 0.0f)) return;
  place_shared(plan, rays, pixel.u, pixel.v, first, &slab);
#if WEIGHED
  if (weigh_volumes(first, &slab)) {
    total_slab(first, &slab);
    if (!(slab.all.extinction > 0.0f)) return;
    place_shared(plan, rays, pixel.u, pixel.v, first, &slab);
  }
#endif
  find_normals(first, &slab);
  const light_buffers buffers = buffers_of_sweep(sweep);
  const vector lit = color_of_shared(plan, first, sweep->sky, &buffers, rays - plan->sheets,
                                     (sheet - 1) % plan->ring, &slab);
  at[0] = lit.x;
  at[1] = lit.y;
  at[2] = lit.z;
  at[3] = slab.all.opacity;
}

#else

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
  const ray_left ray = left_of_ray(volume->plan, &volume->bounds->box, volume->cuts, volume->plan->cut_count,
                                   pixel.u, pixel.v);
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
  const light_buffers buffers = buffers_of_sweep(sweep);
  vector lit = color_of_slab(plan, volume, sweep->sky, &buffers, rays - plan->sheets,
                             (sheet - 1) % plan->ring, &s);
  at[0] = lit.x;
  at[1] = lit.y;
  at[2] = lit.z;
  at[3] = s.opacity;
}

#endif

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
    GLOBAL const float *at = sweep->slots +
                             ((wide)k * (wide)(plan->tiles * 256) + (wide)number) * SLOT_FLOATS;
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

#endif
