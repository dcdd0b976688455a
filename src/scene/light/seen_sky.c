/* scene/light/seen_sky.c - puts the sky, as the eye sees it, behind a picture.
 *
 * In: linear premultiplied pixels of everything before the sky. Out: these pixels over the sky, with alpha
 * 1. */
#include <halflight/render.h>
#include <math.h>

#include "core/door.h"
#include "core/error.h"
#include "core/vector.h"
#include "elementary/elementary.h"
#include "scene/geometry/camera.h"
#include "scene/light/sky.h"
#include "scene/scene.h"

/* A camera's axes, and half of the picture's width (across) and height (down) at distance 1 along
 * `forward`. */
typedef struct eye {
  vec3 right, up, forward;
  double across, down;
} eye;

/* Makes the eye of a scene's camera. An orthographic camera sees the whole sky from one direction. */
static eye eye_of(const hl_scene_description *scene) {
  eye e = {.across = 0, .down = 0};
  hl_camera_basis(&scene->camera, &e.right, &e.up, &e.forward);
  if (scene->camera.type == HL_CAMERA_PERSPECTIVE) e.down = hl_tan(scene->camera.fovy_deg * HL_PI / 360);
  e.across = e.down * scene->width / scene->height;
  return e;
}

hl_status hl_scene_show_sky(const hl_scene *scene, float *pixels, size_t row_stride, hl_error *error) {
  HL_DOOR;
  const hl_scene_description *of = hl_scene_describe(scene);
  if (of == NULL || pixels == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_scene_show_sky: null scene or pixels");
  if (!of->background_sky) return HL_OK;
  const eye e = eye_of(of);
  const sky_axes axes = hl_sky_axes(&of->sky);
  for (int y = 0; y < of->height; y++)
    for (int x = 0; x < of->width; x++) {
      float *pixel = pixels + (size_t)y * row_stride + 4 * (size_t)x;
      vec3 aside = vec3_add(vec3_scale(e.right, e.across * ((2 * x + 1.0) / of->width - 1)),
                            vec3_scale(e.up, e.down * (1 - (2 * y + 1.0) / of->height)));
      double light[3];
      hl_sky_radiance(&of->sky, &axes, vec3_normalise(vec3_add(e.forward, aside)), light);
      for (int c = 0; c < 3; c++) pixel[c] += (float)((1 - (double)pixel[3]) * light[c]);
      pixel[3] = 1;
    }
  return HL_OK;
}
