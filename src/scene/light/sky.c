/* scene/light/sky.c - checks skies, and finds their radiance from a direction. */
#include "scene/light/sky.h"

#include "elementary/elementary.h"

hl_status hl_sky_check(const hl_sky *sky, hl_error *error) {
  hl_checker check = {error, "/sky"};
  hl_status status = hl_check_key(&check, HL_SETTINGS_SKY, "type", sky);
  if (status == HL_OK) status = hl_check_settings(&check, HL_SETTINGS_SKY, sky, (int)sky->type);
  if (status != HL_OK || sky->type != HL_SKY_IMAGE) return status;
  if (sky->pixels == NULL)
    return hl_check_refuse(&check, "file", "is missing: name an image of the surroundings");
  return hl_check_pixels(&check, sky->pixels, sky->width, sky->height);
}

/* If the angle between up and the world's x axis is below 8 degrees, x cannot serve as the direction from
 * which angles are measured. */
static const double ALONG_X = 0.99;

sky_axes hl_sky_axes(const hl_sky *sky) {
  vec3 up = vec3_normalise(vec3_of(sky->up));
  vec3 from = fabs(up.x) < ALONG_X ? (vec3){1, 0, 0} : (vec3){0, 1, 0};
  vec3 right = vec3_normalise(vec3_subtract(from, vec3_scale(up, vec3_dot(from, up))));
  vec3 middle = vec3_cross(up, right);
  double angle = sky->rotation_deg * HL_PI / 180, c = hl_cos(angle), s = hl_sin(angle);
  return (sky_axes){.right = vec3_add(vec3_scale(right, c), vec3_scale(middle, s)),
                    .middle = vec3_subtract(vec3_scale(middle, c), vec3_scale(right, s)),
                    .up = up};
}

/* Finds the two pixels of the sky's image around a position along one axis, and returns the fraction of the
 * way from the first to the second. around: whether the first pixel follows the last pixel; if not, positions
 * beyond the ends count as the ends. */
static double neighbours(double position, int count, bool around, size_t pixel[2]) {
  double at = position - 0.5;
  if (around && at < 0) at += count;
  if (!around) at = fmin(fmax(at, 0), count - 1);
  double first = fmin(floor(at), count - 1);
  pixel[0] = (size_t)first;
  pixel[1] = pixel[0] + 1;
  if (pixel[1] == (size_t)count) pixel[1] = around ? 0 : pixel[0];
  return at - first;
}

static void image_radiance(const hl_sky *sky, double right, double middle, double up, double radiance[3]) {
  size_t column[2], row[2];
  double u = 0.5 + hl_atan2(right, middle) / (2 * HL_PI), v = hl_acos(fmin(fmax(up, -1), 1)) / HL_PI;
  double x = neighbours(u * sky->width, sky->width, true, column),
         y = neighbours(v * sky->height, sky->height, false, row);
  for (int c = 0; c < 3; c++) radiance[c] = 0;
  for (int corner = 0; corner < 4; corner++) {
    double weight = (corner & 1 ? x : 1 - x) * (corner >> 1 ? y : 1 - y);
    const float *pixel = sky->pixels + 3 * (row[corner >> 1] * (size_t)sky->width + column[corner & 1]);
    for (int c = 0; c < 3; c++) radiance[c] += weight * (double)pixel[c];
  }
}

void hl_sky_radiance(const hl_sky *sky, const sky_axes *axes, vec3 direction, double radiance[3]) {
  double up = vec3_dot(direction, axes->up);
  for (int c = 0; c < 3; c++) radiance[c] = 0;
  if (sky->type == HL_SKY_NONE || (sky->hemisphere && up < 0)) return;
  if (sky->type == HL_SKY_IMAGE)
    image_radiance(sky, vec3_dot(direction, axes->right), vec3_dot(direction, axes->middle), up, radiance);
  const double *end = up < 0 ? sky->ground : sky->zenith;
  for (int c = 0; c < 3; c++) {
    if (sky->type == HL_SKY_UNIFORM) radiance[c] = sky->color[c];
    if (sky->type == HL_SKY_GRADIENT)
      radiance[c] = sky->horizon[c] + (end[c] - sky->horizon[c]) * fmin(fabs(up), 1);
    radiance[c] *= sky->strength;
  }
}

void hl_sky_key_add(hl_key *key, const hl_sky *sky, uint64_t mark) {
  hl_key_add_whole(key, (int64_t)sky->type);
  hl_key_add_whole(key, sky->hemisphere);
  hl_key_add_numbers(key, sky->color, 3);
  hl_key_add_numbers(key, sky->zenith, 3);
  hl_key_add_numbers(key, sky->horizon, 3);
  hl_key_add_numbers(key, sky->ground, 3);
  hl_key_add_numbers(key, sky->up, 3);
  hl_key_add_numbers(key, &sky->rotation_deg, 1);
  hl_key_add_numbers(key, &sky->strength, 1);
  hl_key_add_whole(key, sky->suns);
  if (sky->type != HL_SKY_IMAGE) return;
  hl_key_add_whole(key, sky->width);
  hl_key_add_whole(key, sky->height);
  hl_key_add(key, &mark, sizeof mark);
}
