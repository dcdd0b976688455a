/* guess/for_meshes.c - hl_scene_for_meshes: makes a scene of meshes without a volume. */
#include "core/context.h"
#include "core/door.h"
#include "guess/for_volume.h"

/* The intensities of the key light, of the fill light and of the sky. The three intensities have the ratios
 * of the light for scanned matter (looks.c). A white face that looks at the key light and at the sky sends
 * out about 1.6, the sum of the two intensities. */
#define KEY  1.18
#define FILL 0.04
#define SKY  0.41

static void choose_light(hl_context *context, hl_light lights[2], hl_scene_description *description) {
  hl_scene_warm_key_light(KEY, &lights[0]);
  hl_scene_fill_light(&lights[1]);
  lights[1].intensity = FILL;
  description->lights = lights;
  description->light_count = 2;
  hl_scene_choose_background(description);
  hl_scene_choose_sky(SKY, description);
  const uint64_t limit = context->options.memory_limit;
  if (limit > 0 && limit < HL_ROOM_FOR_SKY) hl_scene_level_sky(description);
}

hl_status hl_scene_for_meshes(hl_context *context, const hl_scene_mesh *meshes, size_t count,
                              hl_scene **scene, hl_error *error) {
  HL_DOOR;
  if (scene != NULL) *scene = NULL;
  if (context == NULL || meshes == NULL || count == 0 || scene == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_scene_for_meshes: null context, meshes or scene, or no mesh");
  for (size_t m = 0; m < count; m++)
    if (meshes[m].mesh == NULL)
      return hl_fail(error, HL_ERROR_ARGUMENT, "hl_scene_for_meshes: mesh %zu is null", m);
  hl_light lights[2];
  hl_scene_description description;
  hl_scene_description_defaults(&description);
  description.meshes = meshes;
  description.mesh_count = count;
  hl_status status = hl_scene_frame(&description, &description.camera, error);
  if (status != HL_OK) return status;
  choose_light(context, lights, &description);
  return hl_scene_create(context, &description, scene, error);
}
