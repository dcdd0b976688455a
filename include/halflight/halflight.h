/* halflight/halflight.h - the whole library in one header: pictures of volumes that cast shadows.
 *
 * A program that turns a volume file into a picture:
 *
 *     #include <halflight/halflight.h>
 *     #include <stdio.h>
 *
 *     int main(int argc, char **argv) {
 *       hl_error error;
 *       hl_context *context = NULL;
 *       hl_volume *volume = NULL;
 *       hl_scene *scene = NULL;
 *       hl_renderer *renderer = NULL;
 *       hl_image *image = NULL;
 *       hl_image_write_options options;
 *       int done = 0;
 *       if (argc != 3) {
 *         fprintf(stderr, "usage: picture VOLUME PICTURE\n");
 *         return 2;
 *       }
 *       if (hl_context_create(NULL, &context, &error) == HL_OK &&
 *           hl_volume_load(context, argv[1], &volume, &error) == HL_OK &&
 *           hl_scene_for_volume(context, volume, argv[1], &scene, &error) == HL_OK &&
 *           hl_renderer_create(context, &renderer, &error) == HL_OK) {
 *         int width = hl_scene_describe(scene)->width, height = hl_scene_describe(scene)->height;
 *         hl_scene_write_options(scene, &options);
 *         done = hl_image_create(context, width, height, &image, &error) == HL_OK &&
 *                hl_renderer_render(renderer, scene, hl_image_pixels(image), 4 * (size_t)width, NULL,
 *                                   &error) == HL_OK &&
 *                hl_image_write(context, image, argv[2], &options, &error) == HL_OK;
 *       }
 *       if (!done) fprintf(stderr, "%s\n", error.message);
 *       hl_image_destroy(image);
 *       hl_renderer_destroy(renderer);
 *       hl_scene_release(scene);
 *       hl_volume_release(volume);
 *       hl_context_destroy(context);
 *       return done ? 0 : 1;
 *     }
 *
 * Programs that start from arrays in memory, show pictures in windows or ask for layers are installed in
 * share/doc/halflight/examples.
 */
#ifndef HALFLIGHT_HALFLIGHT_H
#define HALFLIGHT_HALFLIGHT_H

#include "compose.h"
#include "context.h"
#include "device.h"
#include "figure.h"
#include "formats.h"
#include "grids.h"
#include "image.h"
#include "layers.h"
#include "light.h"
#include "mesh.h"
#include "page.h"
#include "particles.h"
#include "preview.h"
#include "ranks.h"
#include "render.h"
#include "reslice.h"
#include "scene.h"
#include "settings.h"
#include "shape.h"
#include "transfer_function.h"
#include "volume.h"

#endif
