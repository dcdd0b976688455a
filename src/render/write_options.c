/* render/write_options.c - hl_scene_write_options(). */

#include <string.h>

#include <halflight/render.h>

void hl_scene_write_options(const hl_scene *scene, hl_image_write_options *options) {
  const hl_scene_description *description = hl_scene_describe(scene);
  hl_image_write_options_defaults(options);
  if (options == NULL || description == NULL) return;
  memcpy(options->background, description->background, sizeof options->background);
  options->background_transparent = description->background_transparent;
  options->exposure = description->exposure;
}
