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

enum { FRAMES = 24 };

static const double LEAST_PIXELS = 480 * 320;

static const double BUDGET = 0.05; /* seconds of a frame: 20 frames a second */
static const double WIDEST = 8;    /* voxels between sheets */

/* What a window keeps. Two renderers: one for coarser volumes while the camera moves, one for the volume
 * itself. */
typedef struct window {
  hl_context *context;
  hl_volume *volume;
  hl_scene *first; /* as it was chosen for the volume */
  hl_preview *preview;
  hl_renderer *moving, *resting;
  double work; /* pixels, for sheets a voxel apart, that take as long as the budget */
} window;

static hl_status window_open(window *w, const char *path, hl_error *error) {
  hl_status status = hl_context_create(NULL, &w->context, error);
  if (status == HL_OK) status = hl_volume_load(w->context, path, &w->volume, error);
  if (status == HL_OK) status = hl_scene_for_volume(w->context, w->volume, path, &w->first, error);
  if (status == HL_OK) status = hl_preview_create(w->context, w->first, &w->preview, error);
  if (status == HL_OK) status = hl_renderer_create(w->context, &w->moving, error);
  if (status == HL_OK) status = hl_renderer_create(w->context, &w->resting, error);
  w->work = LEAST_PIXELS;
  return status;
}

static void window_close(window *w) {
  hl_renderer_destroy(w->moving);
  hl_renderer_destroy(w->resting);
  hl_preview_destroy(w->preview);
  hl_scene_release(w->first);
  hl_volume_release(w->volume);
  hl_context_destroy(w->context);
}

/* Renders the scene and writes it. *seconds: how long the picture took. */
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
  *seconds = statistics.seconds_prepare + statistics.seconds_render;
  return status;
}

/* A frame of the moving camera: smaller than the window, down to LEAST_PIXELS; where that takes longer than
 * the budget, with wider sheets, for which the preview takes coarser volumes. */
static hl_status draw_moving(window *w, const hl_scene_description *wanted, const char *path,
                             hl_error *error) {
  hl_scene_description d = *wanted;
  hl_scene *scene = NULL, *quick = NULL;
  double full = (double)d.width * d.height, pixels = fmin(fmax(w->work, LEAST_PIXELS), full);
  double factor = sqrt(pixels / full), took = 0;
  d.width = (int)fmax(16, 16 * round(d.width * factor / 16)); /* such sides render without a copy */
  d.height = (int)fmax(16, 16 * round(d.height * factor / 16));
  d.render.sheet_spacing = fmin(fmax(pixels / w->work, 1), WIDEST);
  hl_status status = hl_scene_create(w->context, &d, &scene, error);
  if (status == HL_OK) status = hl_preview_scene(w->preview, scene, &quick, error);
  if (status == HL_OK) status = draw(w, quick == scene ? w->resting : w->moving, quick, path, &took, error);

  printf("%s: %d x %d, sheets %.2g voxels apart, %.0f ms\n", path, d.width, d.height, d.render.sheet_spacing,
         1e3 * took);
  if (took > 0) w->work *= fmin(fmax(BUDGET / took, 0.25), 2);
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
