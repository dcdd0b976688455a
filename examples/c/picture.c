/* picture.c - a volume's file becomes a picture, as `halflight render VOLUME -o PICTURE` makes it.
 *
 *     cc picture.c -o picture $(pkg-config --cflags --libs halflight)
 *     ./picture volume.nrrd picture.png
 */
#include <halflight/halflight.h>
#include <stdio.h>

int main(int argc, char **argv) {
  hl_error error;
  hl_context *context = NULL;
  hl_volume *volume = NULL;
  hl_scene *scene = NULL;
  hl_renderer *renderer = NULL;
  hl_image *image = NULL;
  hl_image_write_options options;
  int done = 0;
  if (argc != 3) {
    fprintf(stderr, "usage: picture VOLUME PICTURE\n");
    return 2;
  }
  if (hl_context_create(NULL, &context, &error) == HL_OK &&
      hl_volume_load(context, argv[1], &volume, &error) == HL_OK &&
      hl_scene_for_volume(context, volume, argv[1], &scene, &error) == HL_OK &&
      hl_renderer_create(context, &renderer, &error) == HL_OK) {
    int width = hl_scene_describe(scene)->width, height = hl_scene_describe(scene)->height;
    hl_scene_write_options(scene, &options);
    done = hl_image_create(context, width, height, &image, &error) == HL_OK &&
           hl_renderer_render(renderer, scene, hl_image_pixels(image), 4 * (size_t)width, NULL, &error) ==
               HL_OK &&
           hl_image_write(context, image, argv[2], &options, &error) == HL_OK;
  }
  if (!done) fprintf(stderr, "%s\n", error.message);
  hl_image_destroy(image);
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
  hl_volume_release(volume);
  hl_context_destroy(context);
  return done ? 0 : 1;
}
