/* plan/frame_objects.c - see frame_objects.h. */
#include "plan/frame_objects.h"

#include <string.h>

#include "light/light_emission.h"
#include "mesh/mesh.h"
#include "scene/light/light_kind.h"

frame_volume hl_frame_volume(const framed_scene *framed, size_t index) {
  const hl_scene_volume *scene = &framed->scene.volumes[index];
  frame_volume volume = {.name = scene->name,
                         .volume = scene->volume,
                         .tints = scene->mask.volume,
                         .object = framed->order->volumes[index] + 1,
                         .visible = scene->visible,
                         .casts_shadow = scene->casts_shadow,
                         .receives_shadow = scene->receives_shadow,
                         .is_cut = scene->cut_count > 0,
                         .is_clipped = scene->clipped,
                         .look = {.shading = scene->shading,
                                  .cut_shading = scene->cut_shading,
                                  .material = scene->material,
                                  .anisotropy = scene->anisotropy,
                                  .multiple_scattering = scene->multiple_scattering}};
  memcpy(volume.look.albedo, scene->albedo, sizeof volume.look.albedo);
  memcpy(volume.look.attenuation_color, scene->attenuation_color, sizeof volume.look.attenuation_color);
  return volume;
}

frame_light hl_frame_light(const framed_scene *framed, size_t index) {
  const hl_light *scene = &framed->scene.lights[index];
  frame_light light = {.index = framed->order->lights[index],
                       .sun_part = framed->sun_parts[index],
                       .is_wide = hl_light_shape(scene).is_wide,
                       .is_inverse_square = scene->falloff == HL_FALLOFF_INVERSE_SQUARE,
                       .projects_image = scene->texture.pixels != NULL,
                       .shows_image = scene->emission.pixels != NULL,
                       .has_colored_image = hl_light_emission_colored(scene),
                       .intensity = scene->intensity};
  memcpy(light.color, scene->color, sizeof light.color);
  return light;
}

frame_mesh hl_frame_mesh(const framed_scene *framed, size_t index) {
  const hl_scene_mesh *scene = &framed->scene.meshes[index];
  return (frame_mesh){
      .name = scene->name, .object = framed->mesh_objects[index], .look = hl_surface_look(scene)};
}
