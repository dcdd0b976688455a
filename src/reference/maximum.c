/* reference/maximum.c - finds the greatest value along a ray (maximum projection).
 *
 * Each volume's field is sampled at the march's steps and at the faces of its box. If the transfer function
 * shows the value at only one of two neighbouring samples, the search also finds the place between the two
 * samples where the shown values end. The peak around the greatest sample is found, too. */
#include "reference/reference.h"

enum { HALVINGS = 40 };

/* The state of a search along a ray through one volume. */
typedef struct search {
  const crossing *part;
  double greatest, where; /* the greatest shown value so far, and its distance along the ray; -infinity if no
                           * value is shown yet */
} search;

static vec3 point_at(const crossing *part, double at) {
  return vec3_add(part->origin, vec3_scale(part->direction, at));
}

static double value_at(const crossing *part, double at) {
  return hl_reference_value(part->volume, point_at(part, at));
}

/* The least opacity at which a value counts as shown. Smaller opacities can come from the rounding of voxels
 * and of their weighted sums at the foot of an opacity ramp. */
static const double LEAST_OPACITY = 1e-7;

static bool is_shown(const crossing *part, double value) {
  return value >= part->volume->transparent_below &&
         hl_transfer_function_opacity(&part->volume->described->transfer_function, value) > LEAST_OPACITY;
}

/* Notes the volume's value at this distance along the ray if the transfer function shows the value. Returns
 * whether the value is shown. Where a mask takes more than half of the matter away, as beyond the walls of a
 * mesh of cells, no value is shown. */
static bool ask(search *found, double at) {
  double value = value_at(found->part, at);
  if (!is_shown(found->part, value) ||
      hl_reference_mask_factor(found->part->volume, point_at(found->part, at)) < 0.5)
    return false;
  if (value > found->greatest) {
    found->greatest = value;
    found->where = at;
  }
  return true;
}

/* Searches for the last shown distance between a shown and a hidden distance, to about the precision of
 * doubles. */
static void ask_at_end(search *found, double shown, double other) {
  for (int i = 0; i < HALVINGS; i++) {
    double middle = (shown + other) / 2;
    if (ask(found, middle)) shown = middle;
    else other = middle;
  }
}

/* Searches for the peak of the values within one step before and after the greatest sample (golden-section
 * search, Kiefer 1953). Hidden values guide the search, but never become the result. */
static void ask_at_peak(search *found, double low, double high) {
  static const double golden = 0.6180339887498949;
  for (int i = 0; i < HALVINGS; i++) {
    double a = high - golden * (high - low), b = low + golden * (high - low);
    if (value_at(found->part, a) > value_at(found->part, b)) high = b;
    else low = a;
  }
  (void)ask(found, (low + high) / 2);
}

/* The greatest shown value on the ray between two faces of boxes or cuts; -infinity if no value is shown. */
static double greatest_between(const crossing *part, double step) {
  search found = {part, -INFINITY, 0};
  double steps = fmax(ceil((part->leave - part->enter) / step), 1),
         length = (part->leave - part->enter) / steps;
  bool before = ask(&found, part->enter);
  for (double next = 1; next <= steps; next++) {
    double at = part->enter + next * length;
    double clear = hl_reference_clearance(part->volume, point_at(part, at), part->direction);
    /* skips the samples in bricks without visible values */
    next += floor(fmax(clear / length - 1e-6, 0));
    bool shown = clear <= 0 && ask(&found, at);
    if (shown && !before) ask_at_end(&found, at, at - length);
    if (before && !shown) ask_at_end(&found, at - length, at);
    before = shown;
  }
  if (found.greatest > -INFINITY)
    ask_at_peak(&found, fmax(found.where - length, part->enter), fmin(found.where + length, part->leave));
  return found.greatest;
}

/* The greatest value of one volume along the ray that the transfer function shows; -infinity if no value is
 * shown. */
static double greatest_along(const crossing *whole, double step) {
  double greatest = -INFINITY;
  crossing part = *whole;
  for (; part.enter < whole->leave; part.enter = part.leave) {
    part.leave = whole->leave;
    if (!part.uncut)
      part.leave = fmin(part.leave,
                        hl_reference_next_face(part.volume, part.origin, part.direction, part.enter));
    vec3 middle = vec3_add(part.origin, vec3_scale(part.direction, (part.enter + part.leave) / 2));
    if (part.uncut || hl_reference_left(part.volume, middle))
      greatest = fmax(greatest, greatest_between(&part, step));
  }
  return greatest;
}

/* Returns whether the colours of all visible volumes begin bright. Volumes whose colours all begin bright
 * darken each other; other volumes brighten each other. */
static bool all_begin_bright(const hl_scene_description *scene) {
  bool bright = true;
  for (size_t v = 0; v < scene->volume_count; v++) {
    const hl_scene_volume *volume = &scene->volumes[v];
    double first[3];
    hl_transfer_function_color(&volume->transfer_function, volume->volume->minimum, first);
    if (volume->visible) bright = bright && hl_color_is_bright(first);
  }
  return bright;
}

void hl_reference_maximum(const reference *all, vec3 origin, vec3 direction, reference_worker *worker,
                          float rgba[4]) {
  march walk;
  bool orthographic = all->scene->camera.type == HL_CAMERA_ORTHOGRAPHIC;
  const bool darkens = all_begin_bright(all->scene);
  const reference_ray ray = {origin, direction, orthographic ? -INFINITY : 0, INFINITY};
  for (int c = 0; c < 4; c++) rgba[c] = 0;
  hl_reference_march_begin(all, REFERENCE_SEEN, &ray, worker->eye, &walk);
  for (size_t v = 0; v < walk.count && !hl_pool_stops(all->pool, worker->number); v++) {
    const crossing *part = &walk.crossings[v];
    double greatest = greatest_along(part, all->step), color[3];
    if (!(greatest > -INFINITY)) continue;
    hl_transfer_function_color(&part->volume->described->transfer_function, greatest, color);
    for (int c = 0; c < 3; c++)
      rgba[c] = rgba[3] == 0 ? (float)color[c]
                : darkens    ? fminf(rgba[c], (float)color[c])
                             : fmaxf(rgba[c], (float)color[c]);
    rgba[3] = 1;
  }
}
