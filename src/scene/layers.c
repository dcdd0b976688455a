/* scene/layers.c - see layers.h. */
#include "scene/layers.h"

hl_status hl_layers_check(const hl_layers *layers, const hl_scene_description *scene, hl_error *error) {
  size_t light_count = scene->light_count;
  if (layers == NULL) return HL_OK;
  if (scene->render.compositing == HL_COMPOSITING_MAXIMUM)
    return hl_fail(
        error, HL_ERROR_UNSUPPORTED,
        "/render/compositing: a maximum projection has no layers: use \"light\", or ask for no layers");
  if (layers->struct_size != sizeof *layers)
    return hl_fail(error, HL_ERROR_ARGUMENT, "layers->struct_size is %zu, expected %zu", layers->struct_size,
                   sizeof *layers);
  if (layers->light_count != 0 && layers->light_count != light_count)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "layers->light_count is %zu: the scene has %zu lights: give buffers for all "
                   "of them, null where none is wanted, or 0",
                   layers->light_count, light_count);
  if (layers->light_count != 0 && layers->lights == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "layers->lights is null, and light_count is %zu",
                   layers->light_count);
  return HL_OK;
}
