/* reference/paths.c - estimates the light that media scatter more than once, by following random paths from
 * the eye.
 *
 * A path flies until it has passed a random optical depth. At this place, which is called a collision, the
 * medium's phase function turns the path, and the path flies on. At its second and every later collision the
 * path collects the unscattered light that the lights and the sky send to the collision. The sum is an
 * unbiased estimate of the light that was scattered at least twice. Light that was scattered once is
 * integrated in shade.c. Meshes and isosurfaces on a path absorb a fraction of the light and scatter none.
 * Random numbers depend on the pixel and the path alone. Paths treat the volumes' extinction as equal in all
 * channels. */
#include "elementary/elementary.h"
#include "reference/reference.h"

/* A path has at least SURE_TURNS turns. After SURE_TURNS turns, a path ends with some probability at each
 * collision, and at the latest after MOST_TURNS turns. */
enum { SURE_TURNS = 8, MOST_TURNS = 100000 };

/* Returns a random number from 0 to 1 (Steele, Lea and Flood, "Fast splittable pseudorandom number
 * generators", 2014). */
static double uniform(uint64_t *state) {
  uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

/* A point at which the light of a path is scattered. */
typedef struct collision {
  const reference_volume *volume;
  vec3 point, index_point;
  double value, distance; /* distance along the ray */
} collision;

static double extinction_of(const crossing *part) {
  if (!part->occupied) return 0;
  return hl_reference_extinction(part->volume, hl_reference_value(part->volume, part->here), part->here);
}

/* Chooses one of the volumes at the march's position, with probabilities in proportion to their
 * extinctions. */
static void choose_volume(const march *walk, double total, uint64_t *random, collision *met) {
  double pick = uniform(random) * total;
  for (size_t v = 0; v < walk->count; v++) {
    const crossing *part = &walk->crossings[v];
    double extinction = extinction_of(part);
    if (extinction <= 0) continue;
    met->volume = part->volume;
    met->index_point = part->here;
    pick -= extinction;
    if (pick < 0) return;
  }
}

/* Follows the path along a ray to the path's next collision. Returns false if the path leaves all volumes
 * without a collision. */
static bool fly(const reference *all, reference_role role, const reference_ray *ray, reference_worker *worker,
                uint64_t *random, collision *met) {
  march walk;
  double left = -hl_log1p(-uniform(random));
  hl_reference_march_begin(all, role, ray, worker->eye, &walk);
  while (hl_reference_march_next(&walk)) {
    double total = 0;
    for (size_t v = 0; v < walk.count; v++) total += extinction_of(&walk.crossings[v]);
    if (total * walk.length <= left) {
      left -= total * walk.length;
      continue;
    }
    choose_volume(&walk, total, random, met);
    met->distance = walk.at - walk.length / 2 + left / total;
    met->point = vec3_add(ray->origin, vec3_scale(ray->direction, met->distance));
    met->value = hl_reference_value(met->volume, met->index_point);
    return true;
  }
  return false;
}

/* Multiplies the path's light by the fraction of light that surfaces let through between the way's beginning
 * and a collision. */
static void take_surfaces(const reference *all, reference_role role, reference_ray way, double distance,
                          double weight[3]) {
  double passing[3] = {1, 1, 1}, after = way.nearest;
  reference_hit hit;
  way.farthest = distance;
  if (role == REFERENCE_CASTS_SHADOW) hl_reference_surfaces_passing(all, &way, passing);
  else
    for (; hl_reference_surface_next(all, role, &way, after, &hit); after = hit.distance)
      for (int c = 0; c < 3; c++) passing[c] *= 1 - hit.opacity;
  for (int c = 0; c < 3; c++) weight[c] *= passing[c];
}

/* Chooses a random direction. The angle between the new and the previous direction is distributed by Henyey
 * and Greenstein's phase function. */
static vec3 turn(vec3 way, double g, uint64_t *random) {
  double a = uniform(random), angle = 2 * HL_PI * uniform(random), cosine = 2 * a - 1;
  if (fabs(g) > 1e-6) {
    double part = (1 - g * g) / (1 - g + 2 * g * a); /* derived: the integral of the phase function p, solved
                                                      * for the cosine */
    cosine = (1 + g * g - part * part) / (2 * g);
  }
  double sine = sqrt(fmax(1 - cosine * cosine, 0));
  vec3 u = vec3_perpendicular(way), v = vec3_cross(way, u);
  return vec3_normalise(vec3_add(vec3_scale(way, cosine), vec3_add(vec3_scale(u, sine * hl_cos(angle)),
                                                                   vec3_scale(v, sine * hl_sin(angle)))));
}

/* Adds the light that goes from the scene's lights to a collision, at which it is scattered into the path. A
 * single random point represents each light. way: the path's direction, away from the eye; a unit vector. */
static void add_lights(const reference *all, const collision *met, vec3 way, const double weight[3],
                       reference_worker *worker, uint64_t *random, double sum[3]) {
  for (size_t l = 0; l < all->scene->light_count; l++) {
    reference_light one = all->lights[l];
    /* A light without shadows counts only for light that is scattered once. */
    if (one.points == NULL) continue;
    vec3 point = one.points[(size_t)(uniform(random) * (double)one.point_count)];
    if (!one.sphere) one.points = &point, one.point_count = 1;
    arrival arrived;
    double reach[3];
    hl_reference_light_arrive(&one, met->point, &arrived);
    hl_reference_light_reach(all, &one, &(reference_receiver){.point = met->point}, true, worker, reach);
    double turned = hl_reference_light_phase(&one, met->volume->described->anisotropy, vec3_scale(way, -1),
                                             met->point);
    for (int c = 0; c < 3; c++) sum[c] += weight[c] * turned * arrived.incoming[c] * reach[c];
  }
}

/* Adds the light that the sky sends to a collision. One random cell represents the whole sky. */
static void add_sky(const reference *all, const collision *met, vec3 way, const double weight[3],
                    reference_worker *worker, uint64_t *random, double sum[3]) {
  if (all->sky.count == 0) return;
  const reference_sky_cell *cell = &all->sky.cells[(size_t)(uniform(random) * (double)all->sky.count)];
  const reference_ray ray = {.origin = met->point, .direction = cell->direction, .farthest = INFINITY};
  double passing[3],
      turned = hl_reference_phase(met->volume->described->anisotropy, vec3_scale(way, -1), cell->direction),
      part = all->sky.solid_angle * (double)all->sky.count / (4 * HL_PI);
  hl_reference_transmittance(all, &ray, worker->shadow, passing);
  for (int c = 0; c < 3; c++) sum[c] += weight[c] * turned * part * cell->radiance[c] * passing[c];
}

static bool goes_on(double weight[3], int turns, uint64_t *random) {
  double greatest = fmax(weight[0], fmax(weight[1], weight[2]));
  if (!(greatest > 0)) return false;
  if (turns < SURE_TURNS || greatest >= 1) return true;
  if (uniform(random) >= greatest) return false;
  for (int c = 0; c < 3; c++) weight[c] /= greatest;
  return true;
}

void hl_reference_path(const reference *all, vec3 origin, vec3 direction, uint64_t seed,
                       reference_worker *worker, double sum[3]) {
  bool orthographic = all->scene->camera.type == HL_CAMERA_ORTHOGRAPHIC;
  reference_ray ray = {origin, direction, orthographic ? -INFINITY : 0, INFINITY};
  double weight[3] = {1, 1, 1};
  uint64_t random = seed;
  for (int turns = 0; turns < MOST_TURNS && goes_on(weight, turns, &random); turns++) {
    collision met = {0};
    double color[3];
    const reference_role role = turns == 0 ? REFERENCE_SEEN : REFERENCE_CASTS_SHADOW;
    if (!fly(all, role, &ray, worker, &random, &met)) return;
    take_surfaces(all, role, ray, met.distance, weight);
    const hl_scene_volume *volume = met.volume->described;
    if (!volume->multiple_scattering || !volume->casts_shadow || volume->shading == HL_SHADING_FLAT) return;
    hl_reference_color(met.volume, met.value, met.index_point, color);
    hl_reference_tint(met.volume, met.index_point, color);
    for (int c = 0; c < 3; c++) weight[c] *= color[c] * volume->albedo[c];
    if (turns > 0) add_lights(all, &met, ray.direction, weight, worker, &random, sum);
    if (turns > 0) add_sky(all, &met, ray.direction, weight, worker, &random, sum);
    ray = (reference_ray){met.point, turn(ray.direction, volume->anisotropy, &random), 0, INFINITY};
  }
}
