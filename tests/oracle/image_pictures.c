/* tests/oracle/image_pictures.c - the library's side of images.py, over the public headers.
 *
 *     image_pictures write FOLDER     a known picture in every format and depth
 *     image_pictures convert IN OUT   hl_image_read, then hl_image_write
 */
#include <halflight/halflight.h>

#include <stdio.h>
#include <string.h>

enum { WIDTH = 45, HEIGHT = 37 };

/* The values are fractions of powers of two, so that Python computes the same floats. They are premultiplied,
 * and the first row is empty. */
static void fill(float *pixels) {
  for (int y = 1; y < HEIGHT; y++)
    for (int x = 0; x < WIDTH; x++) {
      float *pixel = pixels + 4 * (y * WIDTH + x), alpha = (float)(x % 33) / 32;
      pixel[0] = alpha * (float)(x + y) / 128;
      pixel[1] = alpha * (float)(y * y) / 2048;
      pixel[2] = alpha * (float)(x * y) / 1024;
      pixel[3] = alpha;
    }
}

static hl_status write_all(hl_context *context, const hl_image *image, const char *folder, hl_error *error) {
  static const struct {
    const char *name;
    int depth, transparent;
  } files[] = {{"rgb8.png", 8, 0},    {"rgb16.png", 16, 0},  {"rgba8.png", 8, 1},
               {"rgba16.png", 16, 1}, {"picture.exr", 8, 0}, {"picture.npy", 8, 0}};
  hl_status status = HL_OK;
  for (size_t i = 0; i < sizeof files / sizeof files[0] && status == HL_OK; i++) {
    hl_image_write_options options;
    hl_image_write_options_defaults(&options);
    options.png_depth = files[i].depth;
    options.background_transparent = files[i].transparent;
    options.background[0] = 0.5;
    options.background[1] = 0.25;
    options.background[2] = 0.125;
    options.scene_json = "{\"halflight\": 1}";
    char path[1000];
    snprintf(path, sizeof path, "%s/%s", folder, files[i].name);
    status = hl_image_write(context, image, path, &options, error);
  }
  return status;
}

int main(int argc, char **argv) {
  hl_error error = {0};
  hl_context *context = NULL;
  hl_image *image = NULL;
  hl_status status = hl_context_create(NULL, &context, &error);
  if (status == HL_OK && argc == 3 && strcmp(argv[1], "write") == 0) {
    status = hl_image_create(context, WIDTH, HEIGHT, &image, &error);
    if (status == HL_OK) fill(hl_image_pixels(image));
    if (status == HL_OK) status = write_all(context, image, argv[2], &error);
  } else if (status == HL_OK && argc == 4 && strcmp(argv[1], "convert") == 0) {
    status = hl_image_read(context, argv[2], &image, &error);
    if (status == HL_OK) status = hl_image_write(context, image, argv[3], NULL, &error);
  } else if (status == HL_OK) {
    fprintf(stderr, "usage: image_pictures write FOLDER | convert IN OUT\n");
    return 2;
  }
  hl_image_destroy(image);
  hl_context_destroy(context);
  if (status != HL_OK) fprintf(stderr, "%s\n", error.message);
  return status == HL_OK ? 0 : 1;
}
