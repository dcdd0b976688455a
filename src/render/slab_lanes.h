/* render/slab_lanes.h - describes the slab between two sheets before it is lit (steps 12 and 13): the
 * volumes' matter on sixteen rays through the slab, the place where this matter is seen, and its gradient at
 * this place.
 *
 * The sixteen pixels are a 4x4 block, or pixels of several blocks packed together (pack_lanes.h). */
#ifndef HL_RENDER_SLAB_LANES_H
#define HL_RENDER_SLAB_LANES_H

#include "core/sheet_constants.h"
#include "fill/steepness_lanes.h"
#include "render/cut_lanes.h"
#include "render/slab.h"
#include "shadow/attenuate_lanes.h"

/* The rays of the eye through sixteen pixels, within a slab. They are the same for all volumes. */
typedef struct block_geometry {
  lanes3 position;    /* the position in the slab for which the slab is lit; frame space */
  lanes3 start;       /* the point at which the ray enters the slab */
  lanes3 step_sheet;  /* the step along the ray from one sheet to the next */
  lanes3 towards_eye; /* unit */
  lanes path;         /* length of the eye's ray through the slab; 0 behind the eye */
} block_geometry;

/* Finds the rays of a block's pixels through a slab. Derived: a ray is E + s W, with s = step / H and H =
 * h.W, where h is the sheets' normal. From one sheet to the next, at the distance ds, the point on the ray
 * moves by W ds / H. */
LANES_INLINE block_geometry geometry_of_block(const shade_job *job, lanes u, lanes v) {
  const sheet_rays *rays = &job->rays;
  block_geometry g;
  g.position = rays_positions(rays, u, v);
  if (!rays->perspective) {
    g.path = lanes_set(job->path);
    g.step_sheet = set3(job->through);
    g.towards_eye = set3(job->towards_eye);
    return g;
  }
  lanes3 w = rays_directions(rays, u, v);
  lanes climb = rays_climb(rays, u, v), inverse = 1.0f / climb, length = lanes_sqrt(dot3(w, w));
  lanes_int ahead = is_ahead(rays, climb, job->spacing * 0.5f); /* the rays' points lie in the slab's
                                                                 * middle */
  g.path = lanes_keep(ahead, length * lanes_abs(inverse) * job->path);
  g.step_sheet = scale3(w, inverse * job->spacing);
  g.towards_eye = scale3(w, -1.0f / length);
  return g;
}

/* Finds the gradient of a volume's density at a point of frame space, in stored units per frame unit (step
 * 12). */
LANES_INLINE lanes3 gradient(const shade_volume *volume, lanes3 point, uint32_t active, uint32_t starts) {
  return gradient_in_frame(volume->grid, volume->kernel, volume->to_index, point, active, starts);
}

/* A ray's way through the slab in one volume: the densities on the two sheets, and the part of the way that
 * lies in the volume's box. */
typedef struct block_way {
  lanes first, last;
  covered_span part;
} block_way;

typedef struct block_density {
  const shade_patch *patch;
  int there;      /* whether the volume may be visible in some of the pixels */
  lanes_int here; /* if several volumes share the slab: the lanes in whose pixels the volume's matter is
                   * visible between the sheets, inside or outside of its box. What the volume does in other
                   * lanes depends on pixels beside them, so it must not count */
  block_way way;
  lanes before, after; /* table coordinates of the densities at the two ends of the slab's covered part */
  way_sums sums;       /* sums of extinction over the table, from one of these two coordinates to the other */
  lanes extinction;    /* the mean extinction over the whole slab; outside of the box the extinction counts as
                        * 0 */
  lanes centre;        /* in joined lanes (block_slab): the centre of gravity of the extinction, as a fraction
                        * of the slab, 0 to 1 */
  lanes factor;        /* for volumes with gradient opacity, a mask or a function of two numbers: the factor
                        * by which extinction and the sums have been multiplied */
  lanes row;           /* for volumes with a function of two numbers: the table's row for the second number
                        * (plane_lanes.h) */
  lanes seen;       /* the place where the matter is seen, as a fraction of the way through the slab's covered
                     * part */
  lanes evenly;     /* the place where the matter would be seen if its extinction were the same on the whole
                     * way */
  lanes_int sloped; /* lanes in which the gradient is known */
  lanes3 slope;     /* the gradient at the place where the matter is seen; 0 in other lanes */
  lanes3 normal;    /* unit, away from the matter */
  lanes surface;    /* the fraction of the matter that is shaded as a surface: 1 for a surface, falling to 0
                     * for a medium, which has no normal */
  lanes behind; /* the distance, in voxels, of the matter from the face of a cut that is shaded as a surface,
                 * along the face's normal; FACE_VOXELS if no such face is near */
  lanes3 outside; /* the position at which the sky's light is looked up; set if volumes hide the sky from each
                   * other */
  lanes light_first, light_last; /* lengths of the light's way within the volume's box, to the start and to
                                  * the end of the slab's covered part */
} block_density;

/* A block's pixels in which a volume may be visible. */
LANES_INLINE lanes_int visible_in_patch(const shade_patch *patch, int block) {
  const classifier *classifier = patch->volume->classifier;
  return may_be_visible(classifier,
                        coordinate_of_density(classifier, lanes_load(patch->before + block * BLOCK_PIXELS)),
                        coordinate_of_density(classifier, lanes_load(patch->current + block * BLOCK_PIXELS)));
}

/* Loads the densities of a block in one volume, and the part of the slab in the volume's box. */
LANES_INLINE block_way way_of_block(const shade_job *job, const shade_patch *patch, int block) {
  block_way way;
  way.first = lanes_load(patch->before + block * BLOCK_PIXELS);
  way.last = lanes_load(patch->current + block * BLOCK_PIXELS);
  way.part = covered_block(patch->enter, patch->leave, patch->uncut, block, job->height, job->spacing);
  return way;
}

/* Finds, for one volume, the sums of extinction (step 13) over a part of the volume's way through the slab.
 * The volume's box is not taken into account. */
LANES_INLINE void classify_way(block_density *d, covered_span part) {
  const classifier *classifier = d->patch->volume->classifier;
  table_coordinate a = coordinate_of_density(classifier, d->way.first),
                   b = coordinate_of_density(classifier, d->way.last);
  if (d->patch->enter != NULL) cut_way(part, &a, &b);
  d->before = a.x;
  d->after = b.x;
  d->sums = sums_of_way(classifier, a, b);
}

/* The centre of gravity of the extinction on the way, as a fraction of the way: 0 at `before`, 1 at `after`.
 */
LANES_INLINE lanes centre_of_way(const block_density *d) {
  way_means m = means_of_way(d->before, d->after, &d->sums);
  return m.from_a / (m.from_a + m.from_b);
}

/* The mean of the fractions s of a slab's optical depth at which matter is seen, weighted by visible light:
 * int e s exp(-e s) ds / (1 - exp(-e)) = 1 / e - exp(-e) / (1 - exp(-e)) = (1 - exp(-e) - e exp(-e)) / (e (1
 * - exp(-e))) (derived); 1/2 - e / 12 for small e. left: exp(-e). Above e = 100, exp(-e) is 0 as a float, so
 * e is limited to 100. */
LANES_INLINE lanes seen_part(lanes e, lanes left) {
  lanes_int thin = e < 0.05f;
  lanes lost = lanes_select(thin, lanes_set(1.0f), 1.0f - left);
  lanes part = lanes_fma(-lanes_min(e, lanes_set(100.0f)), left, lost) /
               (lanes_max(e, lanes_set(0.05f)) * lost);
  return lanes_select(thin, lanes_line(e, -1.0f / 12, 0.5f), part);
}

/* Sixteen pixels in a slab: their rays, the slab's opacity, and the place where the slab is seen. */
typedef struct block_slab {
  lanes u, v;              /* coordinates of the pixels */
  lanes_int open;          /* the pixels that are not opaque yet */
  uint32_t starts;         /* the first lane of each block, one bit each */
  block_geometry geometry; /* the rays, and the mean position at which the slab is seen; the slab is lit at
                            * this position */
  covered_span part;       /* the part of the slab from the beginning of the first visible volume to the end
                            * of the last visible volume */
  lanes place;        /* the position of geometry.position between the two sheets, from 0 (first sheet) to
                       * 1 */
  lanes_int joined;   /* lanes in which several volumes are visible, and one of them fills less than the
                       * member `part` */
  lanes centre;       /* in joined lanes: the centre of gravity of the extinction of all volumes, as a
                       * fraction of the slab, 0 to 1 */
  lanes total, depth; /* total: mean extinction over the slab; depth: optical depth */
  lanes left;         /* exp(-depth) */
  lanes opacity;      /* 0 where nothing is seen */
  lanes_int seen;
} block_slab;

/* The fraction of the way after which the fraction u of the optical depth is reached. If extinction rises
 * along the way, it is u^(b / a); if extinction falls, the formula is mirrored. from_a, from_b: the distances
 * a and b of the extinction's centre of gravity from the ends of the way. */
LANES_INLINE lanes way_of_depth(lanes from_a, lanes from_b, lanes u) {
  lanes_int rising = from_a >= from_b;
  lanes t = lanes_power_of_part(lanes_select(rising, u, 1.0f - u),
                                lanes_min(from_a, from_b) / lanes_max(from_a, from_b));
  return lanes_select(rising, t, 1.0f - t);
}

/* Finds where the matter of a slab is seen if several boxes share the slab: at the place where it would be
 * seen if all of it belonged to one volume. The mean of the parts' centres of gravity, weighted by
 * extinction, is the centre of gravity of the whole. */
LANES_INLINE lanes place_of_joined(block_density *densities, int count, const block_slab *slab, lanes u,
                                   lanes place) {
  lanes length = lanes_max(slab->part.length, lanes_set(1e-6f));
  lanes centre = lanes_clamp((slab->centre - slab->part.begin) / length, 0, 1);
  lanes t = way_of_depth(centre, 1.0f - centre, u);
  for (int i = 0; i < count; i++)
    if (densities[i].there) densities[i].seen = lanes_select(slab->joined, t, densities[i].seen);
  return lanes_select(slab->joined, lanes_fma(slab->part.length, t, slab->part.begin), place);
}

/* Finds the position at which the fraction u of the slab's optical depth is reached. In a dense slab all
 * visible matter may lie at one end. Extinction is taken to rise as t^q along the way. The tables give its
 * centre of gravity m = (q + 1) / (q + 2). Then the fraction u of the depth is reached at t = u^((1 - m) / m)
 * (derived). If extinction falls, the formula is mirrored. Returns the mean of the volumes' positions, 0 to 1
 * through the slab. */
LANES_INLINE lanes place_of_part(block_density *densities, int count, const block_slab *slab, lanes u) {
  lanes sum = lanes_set(0);
  for (int i = 0; i < count; i++) {
    block_density *d = &densities[i];
    if (!d->there) continue;
    d->seen = lanes_set(0.5f);
    d->evenly = u;
    if (!d->patch->volume->visible) continue;
    way_means m = means_of_way(d->before, d->after, &d->sums);
    d->seen = way_of_depth(m.from_a, m.from_b, u);
    lanes place = lanes_fma(slab->part.length, d->seen, slab->part.begin);
    if (count == 1) return place;
    sum = lanes_fma(d->extinction, place, sum);
  }
  lanes place = sum / lanes_max(slab->total, lanes_set(1e-30f));
  for (int i = 0; i < count; i++) /* a volume that has the whole extinction is seen at its own place */
    if (densities[i].there && densities[i].patch->volume->visible)
      place = lanes_select(densities[i].extinction == slab->total,
                           lanes_fma(slab->part.length, densities[i].seen, slab->part.begin), place);
  return lanes_bits(slab->joined) == 0 ? place : place_of_joined(densities, count, slab, u, place);
}

/* A volume's gradient where its matter is seen; 0 for a medium. */
LANES_INLINE lanes3 slope_of_block(const block_density *d) {
  if (d->patch->volume->phong) return d->slope;
  return (lanes3){lanes_set(0), lanes_set(0), lanes_set(0)};
}

/* The position in frame space at which a volume's matter is seen. */
LANES_INLINE lanes3 seen_position(const block_slab *slab, const block_density *d) {
  const block_geometry *g = &slab->geometry;
  return add_scaled3(g->start, g->step_sheet, lanes_fma(slab->part.length, d->seen, slab->part.begin));
}

/* Finds gradients (step 12) where they are needed: for surfaces, and in dense slabs. In a dense slab the
 * light's optical depth, which follows from the gradient, differs from the eye's optical depth. */
LANES_INLINE void find_slopes(const shade_job *job, const block_slab *slab, block_density *densities,
                              int count) {
  const block_geometry *g = &slab->geometry;
  int shadowed = 0;
  for (int i = 0; i < job->light_count; i++) shadowed |= job->lights[i].shadowed;
  for (int i = 0; i < count; i++) {
    block_density *d = &densities[i];
    if (!d->there) continue;
    const shade_volume *volume = d->patch->volume;
    d->sloped = slab->seen & (d->sums.extinction > 0.0f);
    if (hl_classifier_needs_gradient(volume->classifier)) continue; /* weigh_slab() found the slope */
    d->slope = (lanes3){lanes_set(0), lanes_set(0), lanes_set(0)};
    if (!volume->phong) d->sloped &= d->sums.extinction * slab->part.length * g->path > THIN_DEPTH;
    uint32_t active = volume->visible && (volume->phong || (volume->lit && shadowed)) ? lanes_bits(d->sloped)
                                                                                      : 0;
    if (active == 0) d->sloped = lanes_set_int(0);
    else d->slope = gradient(volume, seen_position(slab, d), active, slab->starts);
  }
}

/* Finds a volume's normal. If a mask hides matter, the matter beside the hidden matter gets a face. The
 * visible matter is f m, where m is the mask's factor. Its slope is m grad f + f grad m; the first m is taken
 * as 1 (derived). The slope is measured in steps of the transfer function's table, because floats cannot hold
 * the squares of data values of 1e-27 or 1e30. A normal whose components are still below 1e-19 gets a length
 * below 1. */
LANES_INLINE void find_normal(const block_slab *slab, block_density *d) {
  const shade_volume *volume = d->patch->volume;
  const float scale = fabsf(volume->classifier->scale);
  lanes density = d->way.first + d->way.last;
  lanes3 slope = scale3(slope_of_block(d), lanes_set(scale));
  lanes outward = lanes_select(density < 0.0f, lanes_set(1.0f), lanes_set(-1.0f));
  if (volume->mask_faces)
    slope = add_scaled3(slope,
                        mask_slope(&volume->classifier->mask, seen_position(slab, d), lanes_bits(slab->seen)),
                        -outward * lanes_abs(density) * (scale * 0.5f));
  lanes steepness = lanes_sqrt(dot3(slope, slope));
  d->surface = volume->phong
                   ? lanes_min(steepness * (1.0f / volume->classifier->normal_edge), lanes_set(1.0f))
                   : lanes_set(0);
  d->normal = scale3(slope, outward / lanes_max(steepness, lanes_set(1e-18f)));
}

/* The face of a box or a cut through which the eye's ray passes last before it meets a point of a volume. */
typedef struct cut_face {
  lanes way;      /* the distance from the point back to the face; frame units */
  lanes3 outward; /* the face's unit normal */
  lanes_int cuts; /* lanes in which the face cuts matter: no other volume continues the matter behind it, and
                   * if it is a face of a box, there is visible matter on it */
} cut_face;

LANES_INLINE void take_nearer(cut_face *nearest, lanes way, lanes3 outward, lanes_int cuts) {
  lanes_int nearer = way < nearest->way;
  nearest->way = lanes_select(nearer, way, nearest->way);
  nearest->outward.x = lanes_select(nearer, outward.x, nearest->outward.x);
  nearest->outward.y = lanes_select(nearer, outward.y, nearest->outward.y);
  nearest->outward.z = lanes_select(nearer, outward.z, nearest->outward.z);
  nearest->cuts = lanes_select_int(nearer, cuts, nearest->cuts);
}

LANES_INLINE void find_box_face(const shade_volume *volume, lanes3 point, lanes3 towards_eye,
                                cut_face *nearest) {
  for (int axis = 0; axis < 3; axis++) {
    const float *row = volume->to_index[axis];
    lanes speed = some_speed(row_of_vector(row, towards_eye));
    lanes_int rising = speed > 0.0f;
    lanes face = lanes_select(rising, lanes_set(volume->high[axis]), lanes_set(volume->low[axis]));
    lanes way = lanes_max((face - row_of_point(row, point)) / speed, lanes_set(0));
    lanes unit = lanes_select(rising, lanes_set(1.0f), lanes_set(-1.0f)) / row_size(row);
    take_nearer(nearest, way, scale3(set3(row), unit),
                lanes_select_int(rising, lanes_set_int(volume->face_cuts[axis][1]),
                                 lanes_set_int(volume->face_cuts[axis][0])));
  }
}

LANES_INLINE void find_cut(const shade_cut *cut, lanes3 point, lanes3 towards_eye, lanes least,
                           cut_face *nearest) {
  ray_section section = cross_cut(cut, point, towards_eye);
  lanes way = cut->keep_inside ? section.last : section.first;
  lanes_int met = (section.first < section.last) & (way > -least) & (way < 1e20f);
  way = lanes_max(lanes_select(met, way, lanes_set(1e30f)), lanes_set(0));
  if (lanes_bits(way < nearest->way) == 0) return;
  cut_height over = height_over_cut(cut, add_scaled3(point, towards_eye, lanes_keep(met, way)));
  lanes outward = lanes_set(cut->keep_inside ? 1.0f : -1.0f) / lanes_sqrt(dot3(over.gradient, over.gradient));
  take_nearer(nearest, way, scale3(over.gradient, outward), lanes_set_int(-1));
}

/* Returns whether matter is visible on a face at the points where the eye's rays cross it. */
LANES_INLINE lanes_int shows_on_face(const shade_volume *volume, lanes3 crossing, uint32_t active,
                                     uint32_t starts) {
  const float(*rows)[4] = volume->to_index;
  lanes3 at = {row_of_point(rows[0], crossing), row_of_point(rows[1], crossing),
               row_of_point(rows[2], crossing)};
  lanes density = values_at(volume->grid, volume->kernel, at, active, starts) - volume->grid->empty;
  table_coordinate there = coordinate_of_density(volume->classifier, density);
  return may_be_visible(volume->classifier, there, there);
}

/* Returns whether some points lie so near to a face of the box with visible matter that the points may belong
 * to the face. */
LANES_INLINE int is_near_box_face(const shade_volume *volume, lanes3 point, lanes_int seen) {
  const float reach = FACE_VOXELS * volume->voxel * 1.001f; /* a little is added for rounding */
  lanes_int near = lanes_set_int(0);
  for (int axis = 0; axis < 3; axis++) {
    const float *row = volume->to_index[axis];
    if ((volume->face_cuts[axis][0] | volume->face_cuts[axis][1]) == 0) continue;
    lanes at = row_of_point(row, point), steps = row_size(row) * reach;
    near |= (at - volume->low[axis] < steps) & lanes_set_int(volume->face_cuts[axis][0]);
    near |= (volume->high[axis] - at < steps) & lanes_set_int(volume->face_cuts[axis][1]);
  }
  return lanes_bits(near & seen) != 0;
}

/* The skin of matter that lies `behind` voxels from a face: the fraction of the matter that belongs to the
 * face. It is 1 at the face, and 0 from two voxels behind the face on. Near the face, the gradient of even
 * matter is only noise of the data, so the face's normal replaces it. */
LANES_INLINE lanes skin_of_face(lanes behind) { return lanes_clamp(FACE_VOXELS - behind, 0, 1); }

/* The distance of a slab's matter, in voxels, from the face of a cut, or of the volume's box, through which
 * it is seen; FACE_VOXELS if no such face is near. outward: receives the face's normal. */
LANES_INLINE lanes find_face(const block_slab *slab, const block_density *d, lanes3 *outward) {
  const shade_volume *volume = d->patch->volume;
  const lanes3 point = seen_position(slab, d), towards_eye = slab->geometry.towards_eye;
  const float deepest = FACE_VOXELS * volume->voxel;
  cut_face nearest = {.way = lanes_set(1e30f), .cuts = lanes_set_int(0)};
  nearest.outward = (lanes3){lanes_set(0), lanes_set(0), lanes_set(0)};
  *outward = nearest.outward;
  const lanes none = lanes_set(FACE_VOXELS);
  if (volume->cut_count == 0 && !is_near_box_face(volume, point, slab->seen)) return none;
  find_box_face(volume, point, towards_eye, &nearest);
  for (int i = 0; i < volume->cut_count; i++)
    find_cut(&volume->cuts[i], point, towards_eye, lanes_set(0.5f * volume->voxel), &nearest);
  *outward = nearest.outward;
  lanes depth = nearest.way * dot3(nearest.outward, towards_eye);
  uint32_t active = lanes_bits(slab->seen & nearest.cuts & (depth < deepest));
  if (active == 0) return none;
  lanes3 crossing = add_scaled3(point, towards_eye, lanes_min(nearest.way, lanes_set(1e20f)));
  lanes_int shown = shows_on_face(volume, crossing, active, slab->starts) & lanes_from_bits(active);
  return lanes_select(shown, depth * (1.0f / volume->voxel), none);
}

/* Behind a face that cuts matter, turns a volume's normal to the normal of the face, or makes the surface a
 * medium. */
LANES_INLINE void find_cut_face(const block_slab *slab, block_density *d) {
  const shade_volume *volume = d->patch->volume;
  lanes3 outward;
  d->behind = find_face(slab, d, &outward);
  const lanes skin = skin_of_face(d->behind), rest = 1.0f - skin;
  if (volume->cut_shading == HL_CUT_SHADING_FACE) {
    lanes3 sum = add_scaled3(scale3(outward, skin), d->normal, d->surface * rest);
    d->normal = scale3(sum, 1.0f / lanes_max(lanes_sqrt(dot3(sum, sum)), lanes_set(1e-6f)));
    d->surface = lanes_fma(d->surface, rest, skin);
  } else {
    d->surface = d->surface * rest;
  }
}

LANES_INLINE void find_normals(const block_slab *slab, block_density *densities, int count) {
  for (int i = 0; i < count; i++) {
    if (!densities[i].there || !densities[i].patch->volume->visible) continue;
    find_normal(slab, &densities[i]);
    densities[i].behind = lanes_set(FACE_VOXELS);
    const shade_volume *volume = densities[i].patch->volume;
    bool cut = volume->cut_count > 0 || volume->any_face;
    if (cut && volume->phong && volume->cut_shading != HL_CUT_SHADING_GRADIENT)
      find_cut_face(slab, &densities[i]);
  }
}

/* The pixels of a block in which something may be seen, one bit each. alpha: the alpha of the pixels before
 * the slab. */
LANES_INLINE uint32_t visible_in_block(const shade_job *job, const shade_patch *patches, int patch_count,
                                       int block, const float *alpha) {
  lanes_int open = job->back_to_front ? lanes_set_int(-1) : lanes_load(alpha) < PIXEL_OPAQUE,
            visible = lanes_set_int(0);
  for (int i = 0; i < patch_count; i++)
    if (patches[i].blocks >> block & 1 && patches[i].volume->visible)
      visible |= visible_in_patch(&patches[i], block);
  return lanes_bits(visible & open);
}

/* Sets up a slab for a block of pixels: its volumes and their ways. bits: the pixels in which something may
 * be seen, at least one. patch_count: the tile's number of patches; in some calls the compiler knows that it
 * is 1. */
LANES_INLINE void slab_of_block(const shade_job *job, const tile_slab *tile, int patch_count, int block,
                                uint32_t bits, block_density *densities, block_slab *slab) {
  const shade_patch *patches = tile->patches;
  for (int i = 0; i < patch_count; i++) {
    block_density *d = &densities[i];
    d->patch = &patches[i];
    d->there = patches[i].blocks >> block & 1;
    if (patch_count > 1 && d->there) d->there = lanes_bits(visible_in_patch(&patches[i], block)) != 0;
    if (d->there) d->way = way_of_block(job, &patches[i], block);
  }
  slab->u = block_u(tile->x * TILE + block % 4 * BLOCK);
  slab->v = block_v(tile->y * TILE + block / 4 * BLOCK);
  slab->open = lanes_from_bits(bits);
  slab->starts = 1;
}

/* Finds the part of the slab that the boxes of visible volumes cover together, in each lane by the volumes
 * that may be visible there. If one box covers the whole part, the part has exactly this box's length, so
 * that a volume that is visible alone looks as if there were no other. */
LANES_INLINE void join_parts(const block_density *densities, int count, block_slab *slab) {
  lanes begin = lanes_set(1.0f), end = lanes_set(0), length;
  for (int i = 0; i < count; i++) {
    const covered_span *part = &densities[i].way.part;
    if (!densities[i].there || !densities[i].patch->volume->visible) continue;
    lanes_int some = densities[i].here & (part->length > 0.0f);
    begin = lanes_min(begin, lanes_select(some, part->begin, lanes_set(1.0f)));
    end = lanes_max(end, lanes_keep(some, part->begin + part->length));
  }
  length = end - begin;
  for (int i = 0; i < count; i++) {
    const covered_span *part = &densities[i].way.part;
    if (!densities[i].there || !densities[i].patch->volume->visible) continue;
    lanes_int whole = densities[i].here & (part->length > 0.0f) & (part->begin == begin) &
                      (part->begin + part->length == end);
    length = lanes_select(whole, part->length, length);
  }
  lanes_int some = end > begin;
  slab->part.begin = lanes_keep(some, begin);
  slab->part.length = lanes_select(some, length, lanes_set(1.0f));
  slab->joined = lanes_set_int(0);
  for (int i = 0; i < count; i++)
    if (densities[i].there && densities[i].patch->enter != NULL)
      slab->joined |= densities[i].here & (densities[i].way.part.length < slab->part.length);
}

/* Finds the lanes in which a volume's matter is visible between the sheets. Outside of the volume's box it is
 * not seen, but a light's way to what is seen may lead through the box beside the eye's ray. */
LANES_INLINE lanes_int visible_on_way(const block_density *d) {
  const classifier *classifier = d->patch->volume->classifier;
  return may_be_visible(classifier, coordinate_of_density(classifier, d->way.first),
                        coordinate_of_density(classifier, d->way.last));
}

/* Takes away the matter of a volume in lanes in which it is not visible. */
LANES_INLINE void keep_visible(block_density *d) {
  d->sums.extinction = lanes_keep(d->here, d->sums.extinction);
  d->sums.integral = lanes_keep(d->here, d->sums.integral);
  d->sums.moment = lanes_keep(d->here, d->sums.moment);
}

/* Does step 13 for several volumes in one slab. Each volume's extinction is found over the part of the slab
 * in the volume's own box. The position at which the slab is seen, and the light that the slab absorbs, are
 * found over the part that all boxes cover together. So a volume that is divided into several boxes looks the
 * same as the undivided volume. */
LANES_INLINE void classify_joined(block_density *densities, int count, block_slab *slab) {
  for (int i = 0; i < count; i++)
    if (densities[i].there) densities[i].here = visible_on_way(&densities[i]);
  join_parts(densities, count, slab);
  int joined = lanes_bits(slab->joined) != 0;
  for (int i = 0; i < count; i++) {
    block_density *d = &densities[i];
    if (!d->there) continue;
    classify_way(d, d->way.part);
    keep_visible(d);
    d->extinction = d->sums.extinction * d->way.part.length;
    if (!joined) continue;
    d->centre = lanes_fma(d->way.part.length, centre_of_way(d), d->way.part.begin);
    classify_way(d, (covered_span){lanes_select(slab->joined, slab->part.begin, d->way.part.begin),
                                   lanes_select(slab->joined, slab->part.length, d->way.part.length)});
    keep_visible(d);
  }
}

/* Adds up the visible volumes' extinction, and finds the pixels in which it is above 0. */
LANES_INLINE void total_slab(const block_density *densities, int count, block_slab *slab) {
  int joined = lanes_bits(slab->joined) != 0;
  slab->total = slab->centre = lanes_set(0);
  for (int i = 0; i < count; i++) {
    const block_density *d = &densities[i];
    if (!d->there || !d->patch->volume->visible) continue;
    slab->total = slab->total + d->extinction;
    if (joined) slab->centre = lanes_fma(d->extinction, d->centre, slab->centre);
  }
  slab->centre = slab->centre / lanes_max(slab->total, lanes_set(1e-30f));
  slab->seen = slab->open & (slab->total > 0.0f);
  slab->opacity = lanes_set(0);
}

/* Finds a slab's extinction, and the pixels in which the slab is visible (step 13). */
LANES_INLINE void classify_slab(block_density *densities, int count, block_slab *slab) {
  if (count == 1) {
    slab->part = densities->way.part;
    slab->joined = lanes_set_int(0);
    classify_way(densities, slab->part);
    densities->extinction = densities->sums.extinction * slab->part.length;
  } else {
    classify_joined(densities, count, slab);
  }
  total_slab(densities, count, slab);
}

/* Finds the slab's geometry and opacity, and the place where it is seen. */
LANES_INLINE void place_slab(const shade_job *job, block_density *densities, int count, block_slab *slab) {
  block_geometry *g = &slab->geometry;
  *g = geometry_of_block(job, slab->u, slab->v);
  slab->depth = lanes_keep(slab->seen, slab->total * g->path); /* a lane without a pixel has an arbitrary
                                                                * path, so its depth is set to 0 */
  slab->left = lanes_exp_negative(slab->depth);
  slab->opacity = lanes_keep(slab->seen, 1.0f - slab->left);
  lanes u = seen_part(slab->depth, slab->left);
  if (job->back_to_front) u = 1.0f - u;
  lanes seen_at = place_of_part(densities, count, slab, u);
  g->start = add_scaled3(g->position, g->step_sheet, lanes_set(-0.5f));
  g->position = add_scaled3(g->start, g->step_sheet, seen_at);
  slab->place = seen_at;
}

/* Returns whether weigh_slab() has anything to do: whether the extinction of some volume depends on more than
 * its value. */
LANES_INLINE int is_weighed(const tile_slab *tile) {
  for (int i = 0; i < tile->patch_count; i++)
    if (hl_classifier_is_weighed(tile->patches[i].volume->classifier)) return 1;
  return 0;
}

/* Applies gradient opacity, masks and functions of two numbers, after place_slab(). The factor on a volume's
 * extinction is found at the place where its matter would be seen without this factor. Then the extinction is
 * multiplied by the factor, and the slab is placed again. */
LANES_INLINE void weigh_slab(const shade_job *job, block_density *densities, int count, block_slab *slab) {
  const block_geometry *g = &slab->geometry;
  int changed = 0;
  for (int i = 0; i < count; i++) {
    block_density *d = &densities[i];
    if (!d->there || !hl_classifier_is_weighed(d->patch->volume->classifier)) continue;
    const shade_volume *volume = d->patch->volume;
    lanes place = lanes_fma(slab->part.length, d->seen, slab->part.begin);
    lanes3 point = add_scaled3(g->start, g->step_sheet, place);
    uint32_t active = lanes_bits(slab->seen & (d->sums.extinction > 0.0f));
    matter_factor found = {lanes_set(0), {lanes_set(0), lanes_set(0), lanes_set(0)}, lanes_set(0)};
    if (active != 0)
      found = factor_of_matter(&(matter_way){.grid = volume->grid,
                                             .kernel = volume->kernel,
                                             .classifier = volume->classifier,
                                             .to_index = volume->to_index,
                                             .point = point,
                                             .from = d->before,
                                             .to = d->after,
                                             .extinction = d->sums.extinction,
                                             .active = active,
                                             .starts = slab->starts,
                                             .wants_slope = 1});
    d->slope = found.slope;
    d->row = found.row;
    d->factor = found.factor;
    if ((lanes_bits(found.factor != 1.0f) & active) == 0) continue;
    changed = 1;
    d->extinction = d->extinction * d->factor;
    d->sums.extinction = d->sums.extinction * d->factor;
    d->sums.integral = d->sums.integral * d->factor;
    d->sums.moment = d->sums.moment * d->factor;
  }
  if (!changed) return;
  total_slab(densities, count, slab);
  place_slab(job, densities, count, slab);
}

/* Does steps 12 and 13 for a slab that slab_of_block() has set up. Returns the pixels in which something is
 * visible, one bit each. If there are no such pixels, only the opacity is set, to 0. */
LANES_INLINE uint32_t find_slab(const shade_job *job, const tile_slab *tile, block_density *densities,
                                block_slab *slab) {
  const int count = tile->patch_count;
  classify_slab(densities, count, slab);
  if (lanes_bits(slab->seen) == 0) return 0;
  place_slab(job, densities, count, slab);
  if (is_weighed(tile)) weigh_slab(job, densities, count, slab);
  find_slopes(job, slab, densities, count);
  find_normals(slab, densities, count);
  return lanes_bits(slab->seen);
}

#endif
