/* reference/texture.c - the image that a light projects, eq. (2), and the one on its own surface.
 *
 * The ray from a point of the light meets the screen's parallelogram or passes beside it; images are
 * bilinear between the middles of their pixels, and held from there to their borders.
 */
#include "reference/reference.h"

/* Where the ray meets the screen: s along right and t along up, each from -1 to 1 on it. False where it does
 * not run through the screen's plane. */
static bool meet_screen(const hl_light_texture *texture, bool far, vec3 light, vec3 point, double *s,
                        double *t) {
  vec3 right = vec3_of(texture->screen_right), up = vec3_of(texture->screen_up),
       normal = vec3_cross(right, up);
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

/* s to the right and t upwards, each from -1 to 1. */
static void look_up(const float *pixels, int width, int height, double s, double t, double color[3]) {
  size_t column[2], row[2];
  double x = neighbours((1 + s) / 2 * width, width, column),
         y = neighbours((1 - t) / 2 * height, height, row);
  color[0] = color[1] = color[2] = 0;
  for (int corner = 0; corner < 4; corner++) {
    int right = corner & 1, below = corner >> 1;
    double weight = (right ? x : 1 - x) * (below ? y : 1 - y);
    const float *pixel = pixels + 3 * (row[below] * (size_t)width + column[right]);
    for (int c = 0; c < 3; c++) color[c] += weight * (double)pixel[c];
  }
}

void hl_reference_texture(const hl_light_texture *texture, bool far, vec3 light, vec3 point,
                          double color[3]) {
  double s, t;
  color[0] = color[1] = color[2] = 0;
  if (meet_screen(texture, far, light, point, &s, &t))
    look_up(texture->pixels, texture->width, texture->height, s, t, color);
}

void hl_reference_emission(const hl_light_emission *emission, const emission_plane *plane, vec3 offset,
                           double color[3]) {
  double s, t;
  hl_emission_place(plane, offset, &s, &t);
  look_up(emission->pixels, emission->width, emission->height, s, t, color);
}
