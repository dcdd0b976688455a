/* halflight/halflight.h - pictures of volumes in which light is attenuated by what it passes.
 *
 * The whole library in one header. A program that turns a volume file into a picture:
 *
 *     #include <halflight/halflight.h>
 *     #include <stdio.h>
 *
 *     int main(int argc, char **argv) {
 *       hl_error error = {0};
 *       hl_context *context = NULL;
 *       hl_volume *volume = NULL;
 *       hl_scene *scene = NULL;
 *       hl_renderer *renderer = NULL;
 *       hl_image *image = NULL;
 *       if (argc == 3 && hl_context_create(NULL, &context, &error) == HL_OK &&
 *           hl_volume_load(context, argv[1], &volume, &error) == HL_OK &&
 *           hl_scene_for_volume(context, volume, argv[1], &scene, &error) == HL_OK &&
 *           hl_renderer_create(context, &renderer, &error) == HL_OK &&
 *           hl_image_create(context, 512, 512, &image, &error) == HL_OK &&
 *           hl_renderer_render(renderer, scene, hl_image_pixels(image), 4 * 512, NULL, &error) == HL_OK &&
 *           hl_image_write(context, image, argv[2], NULL, &error) == HL_OK)
 *         return 0;
 *       fprintf(stderr, "%s\n", argc == 3 ? error.message : "usage: picture VOLUME PICTURE");
 *       return 1;
 *     }
 */
#ifndef HALFLIGHT_HALFLIGHT_H
#define HALFLIGHT_HALFLIGHT_H

#include "context.h"
#include "image.h"
#include "layers.h"
#include "render.h"
#include "scene.h"
#include "shape.h"
#include "volume.h"

#endif
