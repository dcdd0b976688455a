/* reference/isosurfaces.c - where rays meet surfaces on which a volume has one value: roots of the kernel's
 * field along the ray. */
#include "reference/reference.h"

/* A stretch of a ray in which the field passes from one side of the value to the other. */
typedef struct bracket {
  double from, to; /* distances */
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

/* The first root of any of the volume's values between two distances, where the field is a and b. */
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

/* Walks along the ray in steps, jumping over bricks without the values. */
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

void hl_reference_iso_next(const reference *all, reference_role role, const reference_ray *ray, double after,
                           reference_hit *hit) {
  for (size_t v = 0; v < all->scene->volume_count; v++) {
    const reference_volume *volume = &all->volumes[v];
    const hl_scene_volume *described = volume->described;
    if (described->iso_count == 0 || !(role == REFERENCE_SEEN ? described->visible : described->casts_shadow))
      continue;
    crossing part = {.volume = volume};
    hl_reference_cross_box(&part, ray, after + all->step * LEAST_GAP, hit->distance);
    if (part.enter < part.leave) meet_volume(all, &part, hit);
  }
}

vec3 hl_reference_iso_normal(const reference_hit *hit, vec3 point) {
  vec3 index = affine3_apply(hit->volume->world_to_index, point);
  return vec3_scale(vec3_normalise(hl_reference_gradient(hit->volume, index)), -1);
}
