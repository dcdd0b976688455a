/* animation.c - the frames of a turning camera, at the size of a window: one renderer for all of them.
 *
 *     cc animation.c -o animation $(pkg-config --cflags --libs halflight) -lm
 *     ./animation head.nii.gz 640 480 frames        writes frames-00.png to frames-23.png
 */
#include <halflight/halflight.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 24 };

/* What a window keeps from frame to frame. The renderer keeps its buffers and what it prepared of the volume:
 * the first frame takes longer than the others. */
typedef struct window {
  hl_context *context;
  hl_volume *volume;
  hl_scene *first; /* the scene as it was chosen for the volume */
  hl_renderer *renderer;
  hl_image *image; /* of the size of the last frame */
} window;

static hl_status window_open(window *w, const char *path, hl_error *error) {
  hl_status status = hl_context_create(NULL, &w->context, error);
  if (status == HL_OK) status = hl_volume_load(w->context, path, &w->volume, error);
  if (status == HL_OK) status = hl_scene_for_volume(w->context, w->volume, path, &w->first, error);
  if (status == HL_OK) status = hl_renderer_create(w->context, &w->renderer, error);
  return status;
}

static void window_close(window *w) {
  hl_image_destroy(w->image);
  hl_renderer_destroy(w->renderer);
  hl_scene_release(w->first);
  hl_volume_release(w->volume);
  hl_context_destroy(w->context);
}

/* Turns the camera about its target and the axis of the world that its picture is level with. */
static void turn(hl_camera *camera, double degrees) {
  double cosine = cos(degrees * 3.14159265358979323846 / 180),
         sine = sin(degrees * 3.14159265358979323846 / 180);
  double eye[3], up[3];
  int a, b, c, axis = 0;
  for (a = 0; a < 3; a++) {
    eye[a] = camera->position[a] - camera->target[a];
    up[a] = camera->up[a];
    if (fabs(up[a]) > fabs(up[axis])) axis = a;
  }
  b = (axis + 1) % 3;
  c = (axis + 2) % 3;
  camera->position[b] = camera->target[b] + cosine * eye[b] - sine * eye[c];
  camera->position[c] = camera->target[c] + sine * eye[b] + cosine * eye[c];
  camera->up[b] = cosine * up[b] - sine * up[c];
  camera->up[c] = sine * up[b] + cosine * up[c];
}

/* The frame at an angle into w->image, which follows the window's size. A scene does not change: another
 * angle is another scene, which shares the volume and costs next to nothing. */
static hl_status draw(window *w, int width, int height, double degrees, hl_error *error) {
  hl_scene_description description = *hl_scene_describe(w->first);
  hl_scene *scene = NULL;
  hl_status status = HL_OK;
  description.width = width;
  description.height = height;
  turn(&description.camera, degrees);
  if (hl_image_width(w->image) != width || hl_image_height(w->image) != height) {
    hl_image_destroy(w->image);
    status = hl_image_create(w->context, width, height, &w->image, error);
  }
  if (status == HL_OK) status = hl_scene_create(w->context, &description, &scene, error);
  if (status == HL_OK)
    status = hl_renderer_render(w->renderer, scene, hl_image_pixels(w->image), 4 * (size_t)width, NULL,
                                error);
  hl_scene_release(scene);
  return status;
}

/* A program with a window shows the picture here: see pixels.c. */
static hl_status show(window *w, const char *name, int frame, hl_error *error) {
  hl_image_write_options options;
  char path[1000];
  hl_scene_write_options(w->first, &options);
  snprintf(path, sizeof path, "%.900s-%02d.png", name, frame);
  return hl_image_write(w->context, w->image, path, &options, error);
}

int main(int argc, char **argv) {
  hl_error error;
  window w;
  hl_status status;
  int frame, width = argc == 5 ? atoi(argv[2]) : 0, height = argc == 5 ? atoi(argv[3]) : 0;
  if (width < 1 || height < 1) {
    fprintf(stderr, "usage: animation VOLUME WIDTH HEIGHT NAME\n");
    return 2;
  }
  memset(&w, 0, sizeof w);
  status = window_open(&w, argv[1], &error);
  for (frame = 0; frame < FRAMES && status == HL_OK; frame++) {
    status = draw(&w, width, height, frame * 360.0 / FRAMES, &error);
    if (status == HL_OK) status = show(&w, argv[4], frame, &error);
  }
  if (status != HL_OK) fprintf(stderr, "animation: %s\n", error.message);
  window_close(&w);
  return status == HL_OK ? 0 : 1;
}
