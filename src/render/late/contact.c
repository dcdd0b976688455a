/* render/late/contact.c - finds the surfaces that hide a light from points of surfaces close behind them: see
 * late_surfaces.h. */
#include "render/late/late_surfaces.h"

#include "light/light_extent.h"
#include "mesh/mesh.h"
#include "render/surface_point.h"
#include "surface/late/lateness.h"
#include "surface/primitive.h"
#include "surface/triangle.h"

/* Bounds the distance at which surfaces count as close. A buffer is late with surfaces by at most CLOSE times
 * the sum of the edge of its pixels and the distance of sheets. The edge of its pixels is at most three
 * quarters of a voxel's edge. The factor of two allows for slanted rays. */
double hl_contact_distance(const frame *frame) {
  return 2 * CLOSE * (0.75 * frame->content.voxel + frame->spacing);
}

_Static_assert(LIGHT_POINTS_SIDE *LIGHT_POINTS_SIDE <= MOST_BUNDLED, "rays of a sample are one bundle");

void hl_contact_points(const light_source *source, light_points *points) {
  const int side = source->shadows == HL_SHADOWS_SOFT ? LIGHT_POINTS_SIDE : 1;
  *points = (light_points){.count = side * side};
  for (int k = 0; k < points->count && side > 1; k++) {
    double square[2];
    hl_sublight_point(source, side, k % side, k / side, square);
    points->offset[k] = hl_light_point(source, square[0], square[1]);
    points->reach = fmax(points->reach, vec3_length(points->offset[k]));
  }
}

/* ---- one ray ---- */

/* A sample from which rays are cast towards the points of a light, and the fraction of the light that passes
 * along each ray. */
typedef struct contact_ray {
  const surfaces *all;
  const surface_mesh *mesh; /* the sample's mesh */
  uint32_t primitive;       /* the sample's primitive */
  vec3 point, normal;       /* the sample's position, and the normal of its primitive on the eye's side */
  vec3 plane;               /* a point of the primitive's plane */
  vec3 smooth;              /* the sample's normal */
  double close; /* a surface counts as close if the distance of its plane from the sample is less than this;
                 * frame units */
  double (*passing)[HL_CHANNELS]; /* [points of the light] */
} contact_ray;

/* Returns whether two triangles share a vertex. */
static bool are_neighbours(const surfaces *all, uint32_t a, uint32_t b) {
  if (!hl_has_corners(all, a) || !hl_has_corners(all, b)) return false;
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++)
      if (all->triangles[a][i] == all->triangles[b][k]) return true;
  return false;
}

/* Lowers the fraction of light that passes along the ray by the light that a surface absorbs, if the surface
 * is close to the sample. A neighbouring triangle that continues the sample's own rounded surface absorbs
 * nothing. */
static void meet(void *data, const surface_hit *hit) {
  contact_ray *ray = data;
  double distance;
  if (hit->primitive == ray->primitive) return;
  vec3 normal = hl_primitive_kind(ray->all, hit->primitive)
                    ->normal(ray->all, hit->primitive, hit->at, ray->point, &distance);
  if (!(fabs(distance) <= ray->close)) return;
  if (hit->mesh == ray->mesh && ray->mesh->look.smooth &&
      fabs(vec3_dot(normal, ray->normal)) > HL_MESH_ROUNDED &&
      are_neighbours(ray->all, hit->primitive, ray->primitive))
    return;
  const double *color = hit->mesh->look.attenuation_color;
  for (int c = 0; c < HL_CHANNELS; c++) ray->passing[hit->ray][c] *= 1 - hit->opacity * color[c];
}

/* ---- one light ---- */

/* A light, with the data for the search for surfaces that hide it from samples. */
typedef struct contact_light {
  const light_source *source;
  const light_shadow *shadow;
  const light_points *points;
} contact_light;

/* The edge of a buffer's pixel at a point (derived: the column of a point p in the buffer is (r1.p) / (r0.p);
 * a way d at a right angle to the light moves it by about |r1| d / (r0.p)); frame units. */
static double pixel_at(const contact_light *light, vec3 point) {
  const light_shadow *shadow = light->shadow;
  const shadow_map *map = shadow->sublight_count > 0 ? &shadow->sublights[0].map : &shadow->lookups[0].map;
  const float *ahead = map->rows[0], *row = map->rows[1];
  double length = sqrt((double)(row[0] * row[0] + row[1] * row[1] + row[2] * row[2])),
         depth = ahead[0] * point.x + ahead[1] * point.y + ahead[2] * point.z + (double)ahead[3];
  return (light->source->parallel ? 1 : fmax(depth, 0)) / length;
}

/* The vector from a point to a point of the light. offset: the offset of the light's point from the light's
 * centre. */
static vec3 way_to(const light_source *source, vec3 from, vec3 offset) {
  return source->parallel ? vec3_scale(vec3_add(source->direction, offset), -1)
                          : vec3_subtract(vec3_add(source->position, offset), from);
}

/* A ball that holds the ends of the rays from a sample to all points of the light. */
static hull_ball ends_of_rays(const contact_light *light, vec3 point, double late) {
  vec3 way = way_to(light->source, point, (vec3){0, 0, 0});
  double length = fmax(vec3_length(way), 1e-30), part = FARTHEST_CLOSE * late / length;
  if (!light->source->parallel) part = fmin(part, 1);
  return (hull_ball){vec3_add(point, vec3_scale(way, part)), 2 * part * light->points->reach};
}

/* Returns whether there may be a surface close before some sample. Samples that face away from the light
 * count only where a layer asks for both sides. */
static bool may_find(const sweep *sweep, const contact_light *light, const contact_ray *rays, int count) {
  hull_ball balls[2 * SURFACE_SAMPLES];
  int balls_count = 0;
  double least = INFINITY;
  for (int i = 0; i < count; i++) {
    vec3 way = way_to(light->source, rays[i].point, (vec3){0, 0, 0});
    double facing = vec3_dot(way, rays[i].smooth), pixel = pixel_at(light, rays[i].point);
    /* Whether the sample's normal and its triangle disagree: one faces the light, and the other does not. */
    if (vec3_dot(way, rays[i].normal) * facing <= 0) continue;
    /* The sample faces away from the light, and no layer needs the light there. */
    if (facing < 0 && sweep->layers.pass_count == 0) continue;
    least = fmin(least, RAY_START * pixel);
    balls[balls_count++] = (hull_ball){rays[i].point, 0};
    balls[balls_count++] = ends_of_rays(light, rays[i].point, pixel + sweep->geometry->sheets.spacing);
  }
  return balls_count > 0 && hl_surface_tree_reaches(sweep->frame->contact, balls, balls_count, least);
}

/* Finds the fractions of a light that pass the surfaces close before a sample. Returns false if all light
 * passes. */
static bool look(const sweep *sweep, const contact_light *light, contact_ray *ray,
                 double passing[HL_CHANNELS]) {
  const light_points *points = light->points;
  double pixel = pixel_at(light, ray->point), late = pixel + sweep->geometry->sheets.spacing;
  bool any = false;
  surface_ray rays[LIGHT_POINTS_SIDE * LIGHT_POINTS_SIDE];
  double parts[LIGHT_POINTS_SIDE * LIGHT_POINTS_SIDE][HL_CHANNELS];
  if (!may_find(sweep, light, ray, 1)) return false;
  ray->close = CLOSE * late;
  ray->passing = parts;
  for (int k = 0; k < points->count; k++) {
    vec3 way = way_to(light->source, ray->point, points->offset[k]);
    double length = vec3_length(way), last = FARTHEST_CLOSE * late / length;
    if (!light->source->parallel) last = fmin(last, 1);
    rays[k] = (surface_ray){ray->point, way, RAY_START * pixel / length, last};
    for (int c = 0; c < HL_CHANNELS; c++) parts[k][c] = 1;
  }
  hl_surface_tree_cast_bundle(sweep->frame->contact, rays, points->count, meet, ray);
  for (int c = 0; c < HL_CHANNELS; c++) {
    passing[c] = 0;
    for (int k = 0; k < points->count; k++) {
      any = any || parts[k][c] < 1;
      passing[c] += parts[k][c] / points->count;
    }
  }
  return any;
}

/* ---- points of hollow surfaces that light almost grazes ---- */

/* The flatter light falls on a surface, the later a shadow buffer takes the surface into account
 * (surface_plane.h: the slope of the surface's heights grows without bound). A ray that grazes a hollow
 * surface meets the surface again close by; the buffer does not hold the surface there yet. Without this
 * correction, the inner wall of a cut ball would get a streak of light where the wall turns away from the
 * light.
 *
 * Derived: where the normal turns towards the light by k per length along the light's way (k = 1 / radius
 * within a ball), the surface is a circle of radius 1 / k in the plane of its normal and the light. A ray
 * that leaves it at an angle whose sine is s meets the circle again after a chord of 2 s / k, if cuts leave
 * the surface there. */

/* The turn of the normal at a batch's sample towards the light, per length along the way to the light. It is
 * above 0 where the surface is hollow. It is 0 on flat and on rough surfaces, and on spheres that let light
 * pass. towards_light: a vector of any length. */
static double hollow_bend(const surfaces *all, const surface_batch *batch, int sample, vec3 towards_light) {
  const uint32_t primitive = batch->fragments[sample]->primitive;
  const surface_samples *samples = &batch->samples;
  vec3 point = {samples->position[0][sample], samples->position[1][sample], samples->position[2][sample]},
       normal = {samples->normal[0][sample], samples->normal[1][sample], samples->normal[2][sample]};
  vec3 above = vec3_scale(normal, vec3_dot(towards_light, normal)),
       along = vec3_normalise(vec3_subtract(towards_light, above));
  return hl_primitive_kind(all, primitive)->bend(all, batch->mesh, primitive, point, normal, along);
}

/* ---- all lights of a batch ---- */

/* A point of a hollow surface. */
typedef struct hollow {
  vec3 point, normal;
  double bend; /* hollow_bend() */
  double late; /* the length by which a buffer is late with surfaces; frame units */
} hollow;

static vec3 vector_of(const float v[3][SURFACE_SAMPLES], int i) { return (vec3){v[0][i], v[1][i], v[2][i]}; }

/* A point of a triangle: the middle of that part of a pixel in which the eye sees the triangle. The middle of
 * the whole pixel may lie behind a wall that hides a part of the pixel. point: any point of the triangle's
 * plane. */
static vec3 seen_point(const sweep *sweep, const tile_slab *slab, const fragment *f, vec3 normal,
                       vec3 point) {
  double u, v;
  vec3 start, way;
  hl_fragment_middle(f->seen, &u, &v);
  hl_view_ray(&sweep->frame->eye, u + slab->x * TILE + hl_pixel_column(f->pixel),
              v + slab->y * TILE + hl_pixel_row(f->pixel), &start, &way);
  double along = vec3_dot(normal, vec3_subtract(point, start)) / vec3_dot(normal, way);
  vec3 seen = vec3_add(start, vec3_scale(way, along));
  return vec3_length(vec3_subtract(seen, point)) < MOST_PIXELS_ASIDE * sweep->frame->pixel ? seen : point;
}

/* Sets the ray of sample i. last: the ray of the sample before it; if null, sample i is the first. */
static void place_ray(const sweep *sweep, const tile_slab *slab, const surface_batch *batch, int i,
                      const contact_ray *last, contact_ray *ray) {
  const surfaces *all = sweep->frame->surfaces;
  const fragment *f = batch->fragments[i];
  *ray = (contact_ray){.all = all,
                       .mesh = batch->mesh,
                       .primitive = f->primitive,
                       .point = vector_of(batch->samples.position, i),
                       .smooth = vector_of(batch->samples.normal, i)};
  ray->normal = ray->smooth;
  if (!hl_has_corners(all, f->primitive)) return;
  double height;
  if (last != NULL && last->primitive == f->primitive) {
    ray->normal = last->normal;
    height = vec3_dot(ray->normal, vec3_subtract(ray->point, last->plane));
  } else {
    ray->normal = hl_triangle_normal(all, f->primitive, ray->point, &height);
    double side = vec3_dot(ray->normal, vector_of(batch->samples.towards_eye, i)) < 0 ? -1 : 1;
    ray->normal = vec3_scale(ray->normal, side);
    height *= side;
  }
  ray->plane = ray->point = vec3_subtract(ray->point, vec3_scale(ray->normal, height));
  if (f->seen != f->samples) ray->point = seen_point(sweep, slab, f, ray->normal, ray->point);
}

/* Finds the box around the batch's samples. */
static void find_bounds(const surface_batch *batch, vec3 *low, vec3 *high) {
  float least[3], greatest[3];
  for (int a = 0; a < 3; a++) {
    const float *at = batch->samples.position[a];
    least[a] = greatest[a] = at[0];
    for (int i = 1; i < batch->count; i++) {
      least[a] = at[i] < least[a] ? at[i] : least[a];
      greatest[a] = at[i] > greatest[a] ? at[i] : greatest[a];
    }
  }
  *low = hl_surface_vector(least), *high = hl_surface_vector(greatest);
}

/* Extends a box to hold all rays that are cast from a point. The rays begin a little away from the point. So
 * the box does not hold a flat surface on which the point lies. */
static void hold_rays(const sweep *sweep, const contact_light *light, vec3 point, double aside, double low[3],
                      double high[3]) {
  double pixel = pixel_at(light, point);
  hull_ball ends = ends_of_rays(light, point, pixel + sweep->geometry->sheets.spacing);
  vec3 way = vec3_subtract(ends.at, point);
  double length = vec3_length(way), start = length > 0 ? RAY_START * pixel / length : 0;
  vec3_bound_ball(vec3_add(point, vec3_scale(way, start)), aside, low, high);
  vec3_bound_ball(ends.at, aside + ends.radius, low, high);
}

/* Returns whether the light on any sample of the batch is needed. The picture needs it on samples that face
 * the light; layers need it on all samples. */
static bool is_asked(const sweep *sweep, const contact_light *light, const surface_batch *batch) {
  if (sweep->layers.pass_count > 0) return true;
  for (int i = 0; i < batch->count; i++) {
    vec3 way = way_to(light->source, vector_of(batch->samples.position, i), (vec3){0, 0, 0});
    if (vec3_dot(way, vector_of(batch->samples.normal, i)) > 0) return true;
  }
  return false;
}

/* Returns whether some surface may be close before the batch's samples. The test is quick, and the answer is
 * nearly always no. The rays of parallel light are all alike, so the rays from two opposite corners of the
 * samples' box bound them all; for other lights, the rays from all eight corners are taken. */
static bool is_close(const sweep *sweep, const contact_light *light, const surface_batch *batch) {
  vec3 least, greatest;
  double aside = 0, low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  find_bounds(batch, &least, &greatest);
  for (int i = 0; i < batch->count; i++)
    if (batch->fragments[i]->seen != batch->fragments[i]->samples)
      aside = MOST_PIXELS_ASIDE * sweep->frame->pixel;
  for (int corner = 0; corner < 8; corner += light->source->parallel ? 7 : 1) {
    vec3 at = {corner & 1 ? greatest.x : least.x, corner & 2 ? greatest.y : least.y,
               corner & 4 ? greatest.z : least.z};
    hold_rays(sweep, light, at, aside, low, high);
  }
  return hl_surface_tree_overlaps(sweep->frame->contact, low, high);
}

/* Returns whether all of a light is outside of a mesh. `reach` is the greatest distance, from the light's
 * centre, of the points that stand for the light. The light itself extends to less than 1.5 times this
 * distance. */
static bool is_outside(const contact_light *light, const surface_mesh *mesh) {
  const light_source *source = light->source;
  return source->parallel || hl_surface_is_outside(mesh, source->position, 1.5 * light->points->reach);
}

/* The samples that the eye sees from within a closed part of their mesh, one bit each. The result is 0 for
 * meshes that let light through. */
static uint32_t samples_within(const sweep *sweep, const surface_batch *batch) {
  const surfaces *all = sweep->frame->surfaces;
  const view *eye = &sweep->frame->eye;
  uint32_t within = 0;
  if (!hl_surface_is_opaque(batch->mesh) || !eye->perspective ||
      hl_surface_is_outside(batch->mesh, eye->origin, 0))
    return 0;
  for (int i = 0; i < batch->count; i++) {
    uint32_t primitive = batch->fragments[i]->primitive;
    if (!hl_has_corners(all, primitive)) continue;
    int inside = batch->mesh->mesh->insides[primitive - batch->mesh->primitives[PRIMITIVE_triangle].first];
    vec3 normal = hl_surface_normal(all, primitive);
    double side = inside * vec3_dot(normal, vector_of(batch->samples.towards_eye, i));
    within |= (uint32_t)(side > 0) << i;
  }
  return within;
}

/* A search for the fractions of all lights that pass the surfaces close before a batch's samples. */
typedef struct contact_search {
  const sweep *sweep;
  float (*passing)[SURFACE_SAMPLES]; /* [lights][channels] */
  bool found;                        /* whether some surface absorbs light, so that `passing` is set */
} contact_search;

/* Lowers the fraction of one light that reaches a sample. parts: the factor for each channel. */
static void set_passing(contact_search *search, int light, int sample, const double parts[HL_CHANNELS]) {
  const int channels = search->sweep->frame_plan->channels;
  for (int row = 0; row < search->sweep->geometry->light_count * channels && !search->found; row++)
    for (int k = 0; k < SURFACE_SAMPLES; k++) search->passing[row][k] = 1;
  search->found = true;
  for (int c = 0; c < channels; c++) {
    float *passing = &search->passing[light * channels + c][sample];
    *passing = fminf(*passing, (float)parts[c]);
  }
}

/* Returns whether a ray towards a point of a light, which begins on a hollow surface, meets this surface
 * again close by. */
static bool returns(const contact_search *search, const surface_batch *batch, const hollow *at, vec3 way) {
  double sine = vec3_dot(way, at->normal), chord = 2 * sine / at->bend;
  if (sine <= 0) return true;
  return chord < FARTHEST_CLOSE * at->late && chord * sine < CLOSE * at->late &&
         hl_surface_left(search->sweep->frame->surfaces, batch->mesh,
                         vec3_add(at->point, vec3_scale(way, chord)));
}

/* Removes the light that a hollow surface hides from its own points, where the light almost grazes the
 * surface. */
static void shade_hollows(contact_search *search, int l, const contact_light *light,
                          const surface_batch *batch) {
  const light_points *points = light->points;
  for (int i = 0; i < batch->count; i++) {
    hollow at = {.point = vector_of(batch->samples.position, i),
                 .normal = vector_of(batch->samples.normal, i)};
    vec3 way = way_to(light->source, at.point, (vec3){0, 0, 0});
    double facing = vec3_dot(way, at.normal);
    if (facing <= 0 || facing > GRAZING * vec3_length(way)) continue;
    at.late = pixel_at(light, at.point) + search->sweep->geometry->sheets.spacing;
    at.bend = hollow_bend(search->sweep->frame->surfaces, batch, i, way);
    if (at.bend <= 0 || at.bend * at.late > SHARPEST_BEND) continue;
    double passing = 0, parts[HL_CHANNELS];
    for (int k = 0; k < points->count; k++) {
      vec3 to = vec3_normalise(way_to(light->source, at.point, points->offset[k]));
      passing += returns(search, batch, &at, to) ? 0 : 1.0 / points->count;
    }
    for (int c = 0; c < HL_CHANNELS; c++) parts[c] = passing;
    set_passing(search, l, i, parts);
  }
}

/* Returns whether the eye may see a mesh from within: cuts open it, or it has open edges. */
static bool may_be_hollow(const surface_mesh *mesh) {
  return (mesh->is_cut || !mesh->mesh->closed) && hl_surface_takes_all(mesh);
}

/* Darkens the samples within a closed part of a mesh, because light from outside does not reach them. */
static void darken_within(contact_search *search, int light, uint32_t within) {
  const double nothing[HL_CHANNELS] = {0, 0, 0};
  for (; within != 0; within &= within - 1) set_passing(search, light, __builtin_ctz(within), nothing);
}

bool hl_contact_find(const sweep *sweep, const tile_slab *slab, const surface_batch *batch,
                     float (*passing)[SURFACE_SAMPLES]) {
  contact_search search = {sweep, passing, false};
  contact_ray rays[SURFACE_SAMPLES];
  bool placed = false;
  if (!batch->mesh->look.receives_shadow) return false;
  const uint32_t within = samples_within(sweep, batch), all = (1u << batch->count) - 1;
  const bool hollow = may_be_hollow(batch->mesh);
  if (sweep->frame->contact->box_count == 0 && within == 0 && !hollow) return false;
  for (int l = 0; l < sweep->geometry->light_count; l++) {
    const contact_light light = {sweep->lights[l].source, &sweep->lights[l].shadow,
                                 &sweep->surfaces.points[l]};
    if (light.shadow->method == NULL) continue;
    const uint32_t dark = within != 0 && is_outside(&light, batch->mesh) ? within : 0;
    darken_within(&search, l, dark);
    if (hollow && dark != all) shade_hollows(&search, l, &light, batch);
    if (dark == all || sweep->frame->contact->box_count == 0 || !is_asked(sweep, &light, batch) ||
        !is_close(sweep, &light, batch))
      continue;
    for (int i = 0; i < batch->count && !placed; i++)
      place_ray(sweep, slab, batch, i, i > 0 ? &rays[i - 1] : NULL, &rays[i]);
    placed = true;
    if (!may_find(sweep, &light, rays, batch->count)) continue;
    for (int i = 0; i < batch->count; i++) {
      double parts[HL_CHANNELS];
      if ((dark >> i & 1) == 0 && look(sweep, &light, &rays[i], parts)) set_passing(&search, l, i, parts);
    }
  }
  return search.found;
}
