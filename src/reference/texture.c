/* reference/texture.c - the image that a light projects; eq. (2).
 *
 * The ray from a point of the light meets the screen's parallelogram or passes beside it; the image is
 * bilinear between the middles of its pixels, and held from there to its borders.
 */
#include "reference/reference.h"

/* Where the ray meets the screen: s along right and t along up, each from -1 to 1 on it. False where it does
 * not run through the screen's plane. */
static bool meet_screen(const hl_light_texture *texture, bool far, vec3 light, vec3 point, double *s, double *t) {
  vec3 right = vec3_of(texture->screen_right), up = vec3_of(texture->screen_up), normal = vec3_cross(right, up);
  vec3 start = far ? point : light, way = far ? light : vec3_subtract(point, light);
  vec3 offset = vec3_subtract(start, vec3_of(texture->screen_center));
  double distance = -vec3_dot(normal, offset) / vec3_dot(normal, way);
  if (!isfinite(distance) || (!far && distance <= 0)) return false;
  vec3 on_screen = vec3_add(offset, vec3_scale(way, distance));
  *s = vec3_dot(vec3_cross(on_screen, up), normal) / vec3_dot(normal, normal);
  *t = vec3_dot(vec3_cross(right, on_screen), normal) / vec3_dot(normal, normal);
  return fabs(*s) <= 1 && fabs(*t) <= 1;
}

/* The two pixels around a place along one axis, and the way from the first to the second. */
static double neighbours(double place, int count, size_t pixel[2]) {
  double at = fmin(fmax(place - 0.5, 0), count - 1);
  pixel[0] = (size_t)at;
  pixel[1] = pixel[0] + 1 < (size_t)count ? pixel[0] + 1 : pixel[0];
  return at - (double)pixel[0];
}

void hl_reference_texture(const hl_light_texture *texture, bool far, vec3 light, vec3 point, double color[3]) {
  double s, t;
  size_t column[2], row[2];
  color[0] = color[1] = color[2] = 0;
  if (!meet_screen(texture, far, light, point, &s, &t)) return;
  double x = neighbours((1 + s) / 2 * texture->width, texture->width, column);
  double y = neighbours((1 - t) / 2 * texture->height, texture->height, row);
  for (int corner = 0; corner < 4; corner++) {
    int right = corner & 1, below = corner >> 1;
    double weight = (right ? x : 1 - x) * (below ? y : 1 - y);
    const float *pixel = texture->pixels + 3 * (row[below] * (size_t)texture->width + column[right]);
    for (int c = 0; c < 3; c++) color[c] += weight * (double)pixel[c];
  }
}
