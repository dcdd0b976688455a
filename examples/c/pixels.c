/* pixels.c - a picture as 8-bit pixels in memory, as windows and toolkits take them.
 *
 *     cc pixels.c -o pixels $(pkg-config --cflags --libs halflight)
 *     ./pixels head.nii.gz picture.ppm
 *
 * The bytes are R, G, B, A, rows from top to bottom, a stride apart. Who takes them so:
 *
 *     Qt      QImage(bytes, width, height, stride, QImage::Format_RGBA8888)
 *     GTK 4   gdk_memory_texture_new(width, height, GDK_MEMORY_R8G8B8A8, ..., stride)
 *     SDL     SDL_CreateRGBSurfaceWithFormatFrom(bytes, width, height, 32, stride, SDL_PIXELFORMAT_RGBA32)
 *     OpenGL  glTexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8_ALPHA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
 * bytes)
 *
 * Cairo and Windows' bitmaps want B, G, R, A: swap_red_and_blue(). This program, without a toolkit, writes a
 * PPM file.
 */
#include <halflight/halflight.h>
#include <stdio.h>
#include <stdlib.h>

void swap_red_and_blue(uint8_t *bytes, size_t count) {
  size_t i;
  for (i = 0; i < count; i += 4) {
    uint8_t red = bytes[i];
    bytes[i] = bytes[i + 2];
    bytes[i + 2] = red;
  }
}

/* A picture of the volume over its background. *bytes: [height][stride], to be freed by the caller; null on
 * failure. */
static hl_status draw(hl_context *context, const char *path, uint8_t **bytes, int *width, int *height,
                      size_t *stride, hl_error *error) {
  hl_volume *volume = NULL;
  hl_scene *scene = NULL;
  hl_renderer *renderer = NULL;
  hl_image *image = NULL;
  hl_image_write_options options;
  hl_status status = hl_volume_load(context, path, &volume, error);
  *bytes = NULL;
  if (status == HL_OK) status = hl_scene_for_volume(context, volume, path, &scene, error);
  if (status == HL_OK) {
    const hl_scene_description *description = hl_scene_describe(scene);
    *width = description->width;
    *height = description->height;
    *stride = 4 * (size_t)*width;            /* or more, as the toolkit says */
    hl_scene_write_options(scene, &options); /* its background lies under the volume */
    status = hl_renderer_create(context, &renderer, error);
  }
  if (status == HL_OK) status = hl_image_create(context, *width, *height, &image, error);
  if (status == HL_OK)
    status = hl_renderer_render(renderer, scene, hl_image_pixels(image), 4 * (size_t)*width, NULL, error);
  if (status == HL_OK) {
    *bytes = (uint8_t *)malloc(*stride * (size_t)*height);
    if (*bytes == NULL) {
      snprintf(error->message, sizeof error->message, "out of memory");
      status = HL_ERROR_MEMORY;
    }
  }
  if (status == HL_OK) status = hl_image_to_srgb8(image, &options, *bytes, *stride, error);
  hl_image_destroy(image);
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
  hl_volume_release(volume);
  return status;
}

static int write_ppm(const char *path, const uint8_t *bytes, int width, int height, size_t stride) {
  FILE *file = fopen(path, "wb");
  int x, y, failed;
  if (file == NULL) return 0;
  fprintf(file, "P6\n%d %d\n255\n", width, height);
  for (y = 0; y < height; y++)
    for (x = 0; x < width; x++) fwrite(bytes + (size_t)y * stride + 4 * (size_t)x, 1, 3, file);
  failed = ferror(file);
  return fclose(file) == 0 && !failed;
}

int main(int argc, char **argv) {
  hl_error error;
  hl_context *context = NULL;
  uint8_t *bytes = NULL;
  size_t stride = 0;
  int width = 0, height = 0, done;
  if (argc != 3) {
    fprintf(stderr, "usage: pixels VOLUME PICTURE.ppm\n");
    return 2;
  }
  done = hl_context_create(NULL, &context, &error) == HL_OK &&
         draw(context, argv[1], &bytes, &width, &height, &stride, &error) == HL_OK;
  if (!done) {
    fprintf(stderr, "pixels: %s\n", error.message);
  } else if (!write_ppm(argv[2], bytes, width, height, stride)) {
    fprintf(stderr, "pixels: %s: cannot be written\n", argv[2]);
    done = 0;
  }
  free(bytes);
  hl_context_destroy(context);
  return done ? 0 : 1;
}
