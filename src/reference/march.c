/* reference/march.c - follows a ray through the boxes of several volumes.
 *
 * The ray is divided into stretches. A stretch ends where the ray enters or leaves a box, or crosses the face
 * of a cut. So the volumes that the ray is in do not change within a stretch. A stretch is divided into equal
 * steps, no longer than the requested step, and each step is sampled at its middle. A homogeneous box is
 * therefore integrated exactly, wherever its faces lie. */
#include "reference/reference.h"

/* Finds the distances at which the ray enters and leaves the volume's box in index space, by the slab
 * method. */
static void clip_to_box(crossing *part, double nearest, double farthest) {
  const double o[3] = {part->origin.x, part->origin.y, part->origin.z};
  const double d[3] = {part->direction.x, part->direction.y, part->direction.z};
  part->enter = nearest;
  part->leave = farthest;
  for (int axis = 0; axis < 3; axis++) {
    double low = part->volume->low[axis], high = part->volume->high[axis];
    if (d[axis] == 0) {
      if (o[axis] < low || o[axis] > high) part->leave = -INFINITY;
      continue;
    }
    double a = (low - o[axis]) / d[axis], b = (high - o[axis]) / d[axis];
    part->enter = fmax(part->enter, fmin(a, b));
    part->leave = fmin(part->leave, fmax(a, b));
  }
}

void hl_reference_cross_box(crossing *part, const reference_ray *ray, double nearest, double farthest) {
  part->origin = affine3_apply(part->volume->world_to_index, ray->origin);
  part->direction = mat3_apply(part->volume->world_to_index.linear, ray->direction);
  clip_to_box(part, nearest, farthest);
}

void hl_reference_march_begin(const reference *all, reference_role role, const reference_ray *ray,
                              crossing *crossings, march *walk) {
  *walk = (march){.crossings = crossings, .longest_step = all->step, .end = ray->nearest};
  for (size_t v = 0; v < all->scene->volume_count; v++) {
    const reference_volume *volume = &all->volumes[v];
    if (!(role == REFERENCE_SEEN ? volume->described->visible : volume->described->casts_shadow)) continue;
    crossing *part = &crossings[walk->count];
    *part = (crossing){.volume = volume,
                       .uncut = volume->described->cut_count == 0 ||
                                (role == REFERENCE_CASTS_SHADOW && volume->described->cut_casts_shadow)};
    hl_reference_cross_box(part, ray, ray->nearest, ray->farthest);
    if (part->enter < part->leave) walk->count++;
  }
}

/* Finds the next distance at which the ray crosses a face of one of the volume's cuts. */
static double next_face(const crossing *part, double after) {
  return part->uncut ? INFINITY : hl_reference_next_face(part->volume, part->origin, part->direction, after);
}

/* Marks volumes as inactive if their cuts remove the matter in this stretch. Returns whether any volume stays
 * active. */
static bool leave_uncut(march *walk) {
  double middle = (walk->start + walk->end) / 2;
  bool inside = false;
  for (size_t c = 0; c < walk->count; c++) {
    crossing *part = &walk->crossings[c];
    vec3 here = vec3_add(part->origin, vec3_scale(part->direction, middle));
    part->active = part->active && (part->uncut || hl_reference_left(part->volume, here));
    inside |= part->active;
  }
  return inside;
}

/* Moves to the next stretch of the ray that crosses at least one box. */
static bool next_stretch(march *walk) {
  for (;;) {
    walk->start = walk->end;
    walk->end = INFINITY;
    bool inside = false;
    for (size_t c = 0; c < walk->count; c++) {
      crossing *part = &walk->crossings[c];
      part->active = part->enter <= walk->start && part->leave > walk->start;
      inside |= part->active;
      if (part->active) walk->end = fmin(walk->end, fmin(part->leave, next_face(part, walk->start)));
      if (part->enter > walk->start) walk->end = fmin(walk->end, part->enter);
    }
    if (walk->end == INFINITY) return false;
    if (inside && leave_uncut(walk)) break;
  }
  walk->next = 0;
  walk->steps = fmax(ceil((walk->end - walk->start) / walk->longest_step), 1);
  walk->length = (walk->end - walk->start) / walk->steps;
  return true;
}

double hl_reference_march_place(march *walk, double at) {
  double clear = INFINITY;
  walk->at = at;
  for (size_t c = 0; c < walk->count; c++) {
    crossing *part = &walk->crossings[c];
    part->occupied = false;
    if (!part->active) continue;
    part->here = vec3_add(part->origin, vec3_scale(part->direction, at));
    double clear_here = hl_reference_clearance(part->volume, part->here, part->direction);
    part->occupied = clear_here <= 0;
    clear = fmin(clear, clear_here);
  }
  return clear;
}

bool hl_reference_march_next(march *walk) {
  for (;;) {
    if (walk->next >= walk->steps && !next_stretch(walk)) return false;
    double clear = hl_reference_march_place(walk, walk->start + (walk->next + 0.5) * walk->length);
    walk->next++;
    if (clear <= 0) return true;
    /* Skips the samples that lie strictly inside the stretch without visible bricks. The small margin of 1e-6
     * prevents that rounding skips one sample too many. */
    walk->next += floor(fmax(clear / walk->length - 1e-6, 0));
  }
}
