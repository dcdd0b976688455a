/* light/light_screen.c - where a light's image stands, and the image averaged to the picture's pixels. */
#include "light/light_screen.h"

#include "core/memory.h"
#include "splat/view.h"

/* The image as a picture plane that the light looks through: its pixels are the view's. Derived: a sample x lies on the
 * ray through c + s R + t U; with the light at P, x - P = w (c - P + s R + t U), and for parallel light along d,
 * x = c + s R + t U + k d: three linear equations, w or k being the third unknown. */
static view view_of_screen(const light_source *source, int width, int height) {
  vec3 corner = vec3_add(vec3_subtract(source->screen_center, source->screen_right), source->screen_up);
  view view = {.perspective = !source->parallel, .width = width, .height = height, .origin = source->position,
               .corner = source->parallel ? corner : vec3_subtract(corner, source->position),
               .du = vec3_scale(source->screen_right, 2.0 / width), .dv = vec3_scale(source->screen_up, -2.0 / height),
               .direction = source->direction};
  hl_view_finish(&view);
  return view;
}

/* Length of a vector of the screen where its shadow falls on the content, across the light's rays; where the content lies
 * before the screen, its own. */
static double length_at_content(const light_source *source, vec3 step, vec3 content) {
  vec3 way = source->parallel ? source->direction
                              : vec3_normalise(vec3_subtract(source->screen_center, source->position));
  vec3 across = vec3_subtract(step, vec3_scale(way, vec3_dot(step, way)));
  double length = vec3_length(across);
  if (source->parallel) return length;
  double to_screen = vec3_dot(way, vec3_subtract(source->screen_center, source->position));
  return length * fmax(vec3_dot(way, vec3_subtract(content, source->position)) / to_screen, 1);
}

/* count pixels of three channels, from_step floats apart, averaged to to_count: each is the mean over its part of the
 * row. */
static void average_row(const float *from, size_t from_step, int count, float *to, size_t to_step, int to_count) {
  double part = (double)count / to_count;
  for (int i = 0; i < to_count; i++) {
    double start = i * part, end = (i + 1) * part, sum[3] = {0, 0, 0};
    for (int at = (int)start; at < count && at < end; at++) {
      double share = fmin(end, at + 1) - fmax(start, at);
      for (int c = 0; c < 3; c++) sum[c] += share * (double)from[(size_t)at * from_step + (size_t)c];
    }
    for (int c = 0; c < 3; c++) to[(size_t)i * to_step + (size_t)c] = (float)(sum[c] / part);
  }
}

static hl_status average_image(hl_context *context, const hl_light_texture *texture, light_screen *screen,
                               float **averaged, hl_error *error) {
  size_t width = (size_t)screen->width, from_width = (size_t)texture->width, from_height = (size_t)texture->height;
  float *narrow = hl_allocate(context, width * from_height, 3 * sizeof *narrow);
  float *small = hl_allocate(context, width * (size_t)screen->height, 3 * sizeof *small);
  for (size_t y = 0; y < from_height && narrow != NULL && small != NULL; y++)
    average_row(texture->pixels + 3 * y * from_width, 3, texture->width, narrow + 3 * y * width, 3, screen->width);
  for (size_t x = 0; x < width && narrow != NULL && small != NULL; x++)
    average_row(narrow + 3 * x, 3 * width, texture->height, small + 3 * x, 3 * width, screen->height);
  hl_release(context, narrow);
  *averaged = small;
  screen->pixels = small;
  return narrow != NULL && small != NULL ? HL_OK : hl_fail_memory(error, width * from_height * 12, "a light's texture");
}

/* As many pixels as the picture has where the image falls, at most the image's own. */
static int resolution(double length, int count, double pixel, float *sharpness) {
  double wanted = ceil(length / pixel);
  int chosen = wanted < 1 ? 1 : wanted < count ? (int)wanted : count;
  *sharpness = (float)fmax(length / chosen / pixel, 1);
  return chosen;
}

hl_status hl_light_screen_create(hl_context *context, const light_source *source, vec3 content, double pixel,
                                 light_screen *screen, float **averaged, hl_error *error) {
  const hl_light_texture *texture = &source->light->texture;
  *screen = (light_screen){.pixels = texture->pixels};
  *averaged = NULL;
  if (texture->pixels == NULL) return HL_OK;
  double right = 2 * length_at_content(source, source->screen_right, content);
  double up = 2 * length_at_content(source, source->screen_up, content);
  screen->width = resolution(right, texture->width, pixel, &screen->sharpness[0]);
  screen->height = resolution(up, texture->height, pixel, &screen->sharpness[1]);
  view view = view_of_screen(source, screen->width, screen->height);
  double rows[3][4];
  hl_view_homogeneous(&view, affine3_identity(), rows);
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 4; column++) screen->map[row][column] = (float)rows[row][column];
  if (screen->width == texture->width && screen->height == texture->height) return HL_OK;
  return average_image(context, texture, screen, averaged, error);
}
