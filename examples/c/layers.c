/* layers.c - a picture's lights kept apart, so that they can be turned up and down, and coloured, without
 * rendering again.
 *
 *     cc layers.c -o layers $(pkg-config --cflags --libs halflight)
 *     ./layers head.nii.gz head        writes head.png, head-evening.png and head.exr, which holds all
 * layers */
#include <halflight/halflight.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct picture {
  hl_image *image;         /* owns the layers' values */
  hl_light_layers *lights; /* one of each of the scene's lights */
  hl_layers layers;
} picture;

/* An image with layers for ambient light, each light and depth. */
static hl_status picture_create(hl_context *context, const hl_scene_description *scene, picture *made,
                                hl_error *error) {
  hl_status status = hl_image_create(context, scene->width, scene->height, &made->image, error);
  size_t i;
  made->lights = (hl_light_layers *)calloc(scene->light_count + 1, sizeof *made->lights);
  if (status == HL_OK && made->lights == NULL) {
    snprintf(error->message, sizeof error->message, "out of memory");
    status = HL_ERROR_MEMORY;
  }
  made->layers.struct_size = sizeof made->layers;
  made->layers.lights = made->lights;
  made->layers.light_count = scene->light_count;
  if (status == HL_OK)
    status = hl_image_add_layer(made->image, "ambient", "RGB", &made->layers.ambient, error);
  if (status == HL_OK)
    status = hl_image_add_layer(made->image, "depth", "Z", &made->layers.depth_first, error);
  for (i = 0; i < scene->light_count && status == HL_OK; i++) {
    char name[24];
    snprintf(name, sizeof name, "light%u", (unsigned)i);
    status = hl_image_add_layer(made->image, name, "RGB", &made->lights[i].picture, error);
  }
  return status;
}

/* RGB is the sum of ambient light and of each light: here each times a colour. Alpha stays. */
static void relight(picture *p, const double ambient[3], const double light[3]) {
  size_t count = (size_t)hl_image_width(p->image) * (size_t)hl_image_height(p->image), i, l;
  float *pixels = hl_image_pixels(p->image);
  int c;
  for (i = 0; i < count; i++)
    for (c = 0; c < 3; c++) {
      double sum = ambient[c] * p->layers.ambient[3 * i + c];
      for (l = 0; l < p->layers.light_count; l++) sum += light[c] * p->lights[l].picture[3 * i + c];
      pixels[4 * i + c] = (float)sum;
    }
}

/* A PNG holds no layers, and would be refused: its pixels are written from an image without any. */
static hl_status write_png(hl_context *context, const hl_scene *scene, const hl_image *from, const char *path,
                           hl_error *error) {
  int width = hl_image_width(from), height = hl_image_height(from);
  hl_image *plain = NULL;
  hl_image_write_options options;
  hl_status status = hl_image_create(context, width, height, &plain, error);
  if (status != HL_OK) return status;
  memcpy(hl_image_pixels(plain), hl_image_pixels_const(from),
         (size_t)width * (size_t)height * 4 * sizeof(float));
  hl_scene_write_options(scene, &options);
  status = hl_image_write(context, plain, path, &options, error);
  hl_image_destroy(plain);
  return status;
}

static hl_status write_all(hl_context *context, const hl_scene *scene, picture *p, const char *name,
                           hl_error *error) {
  static const double dim[3] = {0.3, 0.4, 0.8}, warm[3] = {1.2, 0.7, 0.3};
  char path[1000];
  hl_status status;
  snprintf(path, sizeof path, "%.900s.exr", name);
  status = hl_image_write(context, p->image, path, NULL, error); /* channels light0.R, depth.Z, ... */
  snprintf(path, sizeof path, "%.900s.png", name);
  if (status == HL_OK) status = write_png(context, scene, p->image, path, error);
  relight(p, dim, warm);
  snprintf(path, sizeof path, "%.900s-evening.png", name);
  return status == HL_OK ? write_png(context, scene, p->image, path, error) : status;
}

static hl_status draw(hl_context *context, hl_scene *scene, const char *name, hl_error *error) {
  const hl_scene_description *description = hl_scene_describe(scene);
  hl_renderer *renderer = NULL;
  picture p;
  hl_status status;
  memset(&p, 0, sizeof p);
  status = picture_create(context, description, &p, error);
  if (status == HL_OK) status = hl_renderer_create(context, &renderer, error);
  if (status == HL_OK)
    status = hl_renderer_render_layers(renderer, scene, hl_image_pixels(p.image),
                                       4 * (size_t)description->width, &p.layers, NULL, error);
  if (status == HL_OK) status = write_all(context, scene, &p, name, error);
  hl_renderer_destroy(renderer);
  hl_image_destroy(p.image);
  free(p.lights);
  return status;
}

int main(int argc, char **argv) {
  hl_error error;
  hl_context *context = NULL;
  hl_volume *volume = NULL;
  hl_scene *scene = NULL;
  int done;
  if (argc != 3) {
    fprintf(stderr, "usage: layers VOLUME NAME\n");
    return 2;
  }
  done = hl_context_create(NULL, &context, &error) == HL_OK &&
         hl_volume_load(context, argv[1], &volume, &error) == HL_OK &&
         hl_scene_for_volume(context, volume, argv[1], &scene, &error) == HL_OK &&
         draw(context, scene, argv[2], &error) == HL_OK;
  if (!done) fprintf(stderr, "layers: %s\n", error.message);
  hl_scene_release(scene);
  hl_volume_release(volume);
  hl_context_destroy(context);
  return done ? 0 : 1;
}
