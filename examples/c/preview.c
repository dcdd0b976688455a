/* preview.c - a volume that turns at an interactive rate, and comes to rest as its exact picture.
 *
 *     cc preview.c -o preview $(pkg-config --cflags --libs halflight) -lm
 *     ./preview head.nii.gz 960 640 turn        writes turn-00.png to turn-23.png, and turn-rest.png
 */
#include <halflight/halflight.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 24, COPIES = 3 };

static const double LEAST_PIXELS = 160 * 100;
static const double BUDGET = 0.05; /* seconds of a frame: 20 frames a second */
static const double WIDEST = 8;    /* voxels between sheets */

/* What a window keeps. A renderer for the volume itself, and one for each coarser copy of it: a renderer
 * prepares a volume anew when the volume changes. */
typedef struct window {
  hl_context *context;
  hl_volume *volume;
  hl_scene *first; /* as it was chosen for the volume */
  hl_preview *preview;
  hl_renderer *moving[COPIES], *resting;
  const hl_volume *copies[COPIES]; /* which copy each of the moving renderers has rendered */
  double work; /* pixels, divided by the voxels between two sheets, that take as long as the budget */
} window;

static hl_status window_open(window *w, const char *path, hl_error *error) {
  hl_status status = hl_context_create(NULL, &w->context, error);
  if (status == HL_OK) status = hl_volume_load(w->context, path, &w->volume, error);
  if (status == HL_OK) status = hl_scene_for_volume(w->context, w->volume, path, &w->first, error);
  if (status == HL_OK) status = hl_preview_create(w->context, w->first, &w->preview, error);
  for (int c = 0; c < COPIES && status == HL_OK; c++)
    status = hl_renderer_create(w->context, &w->moving[c], error);
  if (status == HL_OK) status = hl_renderer_create(w->context, &w->resting, error);
  w->work = LEAST_PIXELS;
  return status;
}

static void window_close(window *w) {
  for (int c = 0; c < COPIES; c++) hl_renderer_destroy(w->moving[c]);
  hl_renderer_destroy(w->resting);
  hl_preview_destroy(w->preview);
  hl_scene_release(w->first);
  hl_volume_release(w->volume);
  hl_context_destroy(w->context);
}

/* Renders the scene and writes it. *seconds: how long the picture took, without what is prepared once. */
static hl_status draw(window *w, hl_renderer *renderer, const hl_scene *scene, const char *path,
                      double *seconds, hl_error *error) {
  hl_render_statistics statistics;
  const hl_scene_description *d = hl_scene_describe(scene);
  hl_image *image = NULL;
  hl_image_write_options options;
  memset(&statistics, 0, sizeof statistics);
  statistics.struct_size = sizeof statistics;
  hl_scene_write_options(scene, &options);
  hl_status status = hl_image_create(w->context, d->width, d->height, &image, error);
  if (status == HL_OK)
    status = hl_renderer_render(renderer, scene, hl_image_pixels(image), 4 * (size_t)d->width, &statistics,
                                error);
  if (status == HL_OK) status = hl_image_write(w->context, image, path, &options, error);
  hl_image_destroy(image);
  *seconds = statistics.seconds_render;
  return status;
}

/* The length of a pixel at the camera's target, in voxels of the volume. */
static double voxels_in_pixel(const hl_scene_description *d, const hl_volume *volume) {
  hl_volume_info info;
  double edge = INFINITY, distance = 0;
  memset(&info, 0, sizeof info);
  info.struct_size = sizeof info;
  if (hl_volume_get_info(volume, &info) != HL_OK) return 1;
  for (int axis = 0; axis < 3; axis++) {
    distance += pow(d->camera.position[axis] - d->camera.target[axis], 2);
    edge = fmin(edge, info.spacing[axis]);
  }
  double height = d->camera.type == HL_CAMERA_ORTHOGRAPHIC
                      ? d->camera.height
                      : 2 * sqrt(distance) * tan(d->camera.fovy_deg * acos(-1) / 360);
  return height / d->height / edge;
}

/* The renderer for this scene. */
static hl_renderer *renderer_of(window *w, const hl_scene *quick) {
  const hl_volume *volume = hl_scene_describe(quick)->volumes[0].volume;
  int c = 0;
  if (volume == w->volume) return w->resting;
  while (c < COPIES - 1 && w->copies[c] != NULL && w->copies[c] != volume) c++;
  w->copies[c] = volume;
  return w->moving[c];
}

/* A frame of the moving camera. Of all frames that take as long, the one whose sheets are as far apart as its
 * pixels are long is nearest to the picture at rest. For sheets that are more than a voxel apart, the preview
 * takes coarser volumes. */
static hl_status draw_moving(window *w, const hl_scene_description *wanted, const char *path,
                             hl_error *error) {
  hl_scene_description d = *wanted;
  hl_scene *scene = NULL, *quick = NULL;
  double full = (double)d.width * d.height, took = 0;
  /* Pixels that are a voxel long; others are sqrt(single / pixels) voxels long. */
  double single = full * pow(voxels_in_pixel(&d, w->volume), 2);
  double pixels = w->work >= single ? w->work : cbrt(w->work * w->work * single);
  pixels = fmin(fmax(pixels, LEAST_PIXELS), full);
  double factor = sqrt(pixels / full);
  d.width = (int)fmax(16, 16 * round(d.width * factor / 16)); /* such sides render without a copy */
  d.height = (int)fmax(16, 16 * round(d.height * factor / 16));
  d.render.sheet_spacing = fmin(fmax(fmax(pixels / w->work, sqrt(single / pixels)), 1), WIDEST);
  hl_status status = hl_scene_create(w->context, &d, &scene, error);
  if (status == HL_OK) status = hl_preview_scene(w->preview, scene, &quick, error);
  if (status == HL_OK) status = draw(w, renderer_of(w, quick), quick, path, &took, error);

  printf("%s: %d x %d, sheets %.2g voxels apart, %.0f ms\n", path, d.width, d.height, d.render.sheet_spacing,
         1e3 * took);
  if (took > 0) w->work *= pow(fmin(fmax(BUDGET / took, 0.25), 2), 0.6); /* a part of the error: times vary */
  w->work = fmin(fmax(w->work, LEAST_PIXELS / WIDEST), full);
  hl_scene_release(quick);
  hl_scene_release(scene);
  return status;
}

static hl_status turn(window *w, int width, int height, const char *stem, hl_error *error) {
  hl_status status;
  hl_scene_description d = *hl_scene_describe(w->first);
  hl_view view;
  char path[1000];
  d.width = width;
  d.height = height;
  status = hl_view_of_camera(&d, &view);
  for (int frame = 0; frame < FRAMES && status == HL_OK; frame++) {
    view.azimuth_deg += 360.0 / FRAMES;
    status = hl_camera_turn(&view, &d.camera);
    snprintf(path, sizeof path, "%s-%02d.png", stem, frame);
    if (status == HL_OK) status = draw_moving(w, &d, path, error);
  }
  hl_scene *rest = NULL;
  double took;
  snprintf(path, sizeof path, "%s-rest.png", stem);
  if (status == HL_OK) status = hl_scene_create(w->context, &d, &rest, error);
  if (status == HL_OK) status = draw(w, w->resting, rest, path, &took, error);
  hl_scene_release(rest);
  return status;
}

int main(int count, char **words) {
  window w;
  hl_error error;
  memset(&w, 0, sizeof w);
  if (count != 5) {
    fprintf(stderr, "usage: preview VOLUME WIDTH HEIGHT STEM\n");
    return 2;
  }
  hl_status status = window_open(&w, words[1], &error);
  if (status == HL_OK) status = turn(&w, atoi(words[2]), atoi(words[3]), words[4], &error);
  if (status != HL_OK) fprintf(stderr, "preview: %s\n", error.message);
  window_close(&w);
  return status == HL_OK ? 0 : 1;
}
