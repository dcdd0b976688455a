/* reference/isosurfaces.c - finds the points at which rays meet isosurfaces. A ray meets an isosurface where
 * the field along the ray has the surface's value. A ray also meets the surface at a face of the volume's box
 * or of a cut that cuts through the inside of the surface. */
#include "reference/reference.h"

/* A part of a ray at whose ends the field lies on different sides of an isosurface's value. */
typedef struct bracket {
  double from, to; /* distances along the ray */
  bool rises;
} bracket;

static double value_at(const crossing *part, double distance) {
  vec3 here = vec3_add(part->origin, vec3_scale(part->direction, distance));
  return hl_reference_value(part->volume, here);
}

static double bisect(const crossing *part, double value, bracket b) {
  enum { HALVINGS = 50 };
  for (int i = 0; i < HALVINGS; i++) {
    double middle = (b.from + b.to) / 2;
    if ((value_at(part, middle) > value) == b.rises) b.to = middle;
    else b.from = middle;
  }
  return (b.from + b.to) / 2;
}

/* Finds the first place between two distances along a ray at which the field has the value of one of the
 * volume's isosurfaces. a, b: the field's values at the two distances. */
static void find_roots(const crossing *part, double from, double to, double a, double b, reference_hit *hit) {
  const hl_scene_volume *described = part->volume->described;
  for (size_t i = 0; i < described->iso_count; i++) {
    double value = described->iso[i].value;
    if ((a > value) == (b > value)) continue;
    double root = bisect(part, value, (bracket){from, to, b > value});
    vec3 at = vec3_add(part->origin, vec3_scale(part->direction, root));
    if (root < hit->distance && hl_reference_left(part->volume, at))
      *hit = (reference_hit){.iso = &described->iso[i],
                             .volume = part->volume,
                             .distance = root,
                             .opacity = described->iso[i].opacity};
  }
}

/* Walks along the ray in steps, and looks for isosurfaces in each step. Bricks whose range of values holds no
 * isosurface's value are skipped. */
static void meet_volume(const reference *all, const crossing *part, reference_hit *hit) {
  double at = part->enter, before = value_at(part, at);
  while (at < part->leave && at < hit->distance) {
    vec3 here = vec3_add(part->origin, vec3_scale(part->direction, at));
    double clear = hl_reference_clearance(part->volume, here, part->direction);
    double next = fmin(at + fmax(all->step, clear), part->leave), value = value_at(part, next);
    if (clear <= all->step) find_roots(part, at, next, before, value, hit);
    at = next;
    before = value;
  }
}

/* Returns whether the ray's point at this distance lies in the volume's box, and no cut removes the point. */
static bool is_there(const crossing *part, double distance) {
  const vec3 here = vec3_add(part->origin, vec3_scale(part->direction, distance));
  const double at[3] = {here.x, here.y, here.z};
  for (int a = 0; a < 3; a++)
    if (at[a] < part->volume->low[a] || at[a] > part->volume->high[a]) return false;
  return hl_reference_left(part->volume, here);
}

/* The outward normal, in the world, of the face of the box on which a point lies. The result is 0 if another
 * volume continues the matter at this face. */
static vec3 normal_of_box(const reference_volume *volume, vec3 point) {
  const double at[3] = {point.x, point.y, point.z};
  double least = INFINITY;
  vec3 normal = {0, 0, 0};
  for (int a = 0; a < 3; a++)
    for (int high = 0; high < 2; high++) {
      const double off = fabs(at[a] - (high ? volume->high[a] : volume->low[a]));
      if (!(off < least)) continue;
      const bool open = isinf(high ? volume->clip_high[a] : volume->clip_low[a]);
      const vec3 rise = mat3_apply(volume->gradient_to_world, (vec3){a == 0, a == 1, a == 2});
      least = off;
      normal = open ? (vec3){0, 0, 0} : vec3_scale(vec3_normalise(rise), high ? 1 : -1);
    }
  return normal;
}

/* Notes a hit where a ray crosses a face of the box or of a cut, if the face closes an isosurface. A face
 * closes an isosurface at a point inside the surface where matter is left on one side of the face only. */
static void meet_face(const reference *all, const crossing *part, double at, vec3 normal,
                      reference_hit *hit) {
  const hl_scene_volume *described = part->volume->described;
  const double aside = 1e-4 * all->step, value = value_at(part, at);
  if (vec3_length(normal) == 0 || is_there(part, at - aside) == is_there(part, at + aside)) return;
  for (size_t i = 0; i < described->iso_count; i++)
    if (value > described->iso[i].value && at < hit->distance)
      *hit = (reference_hit){.iso = &described->iso[i],
                             .volume = part->volume,
                             .distance = at,
                             .face = normal,
                             .opacity = described->iso[i].opacity};
}

/* Notes hits at the faces of the box and of cuts that the ray crosses between two distances. part: the ray
 * between these distances, clipped to the volume's box. */
static void meet_faces(const reference *all, const crossing *part, double first, double last,
                       reference_hit *hit) {
  const vec3 enters = vec3_add(part->origin, vec3_scale(part->direction, part->enter)),
             leaves = vec3_add(part->origin, vec3_scale(part->direction, part->leave));
  if (part->enter > first) meet_face(all, part, part->enter, normal_of_box(part->volume, enters), hit);
  if (part->leave < last) meet_face(all, part, part->leave, normal_of_box(part->volume, leaves), hit);
  for (double at = part->enter;;) {
    at = hl_reference_next_face(part->volume, part->origin, part->direction, at);
    if (!(at < part->leave) || !(at < hit->distance)) return;
    const vec3 crossing = vec3_add(part->origin, vec3_scale(part->direction, at));
    meet_face(all, part, at, hl_reference_cut_normal(part->volume, crossing), hit);
  }
}

void hl_reference_iso_next(const reference *all, reference_role role, const reference_ray *ray, double after,
                           reference_hit *hit) {
  for (size_t v = 0; v < all->scene->volume_count; v++) {
    const reference_volume *volume = &all->volumes[v];
    const hl_scene_volume *described = volume->described;
    if (described->iso_count == 0 || !(role == REFERENCE_SEEN ? described->visible : described->casts_shadow))
      continue;
    crossing part = {.volume = volume};
    const double first = after + all->step * LEAST_GAP, last = hit->distance;
    hl_reference_cross_box(&part, ray, first, last);
    if (!(part.enter < part.leave)) continue;
    meet_volume(all, &part, hit);
    meet_faces(all, &part, first, last, hit);
  }
}

vec3 hl_reference_iso_normal(const reference_hit *hit, vec3 point) {
  if (vec3_length(hit->face) > 0) return hit->face;
  vec3 index = affine3_apply(hit->volume->world_to_index, point);
  return vec3_scale(vec3_normalise(hl_reference_gradient(hit->volume, index)), -1);
}
