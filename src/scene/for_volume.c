/* scene/for_volume.c - the scene that shows one volume well with no further choice. */
#include <string.h>

#include "core/error.h"
#include "scene/automatic.h"
#include "scene/check.h"
#include "scene/scene.h"
#include "scene/upright.h"

#define AZIMUTH 30        /* three-quarter view, degrees */
#define ELEVATION 20
#define LIGHT_AZIMUTH -40 /* key light from the upper left, degrees from the line of sight */
#define LIGHT_ELEVATION 45
#define SHEETS 540        /* across the grid's diagonal */

void hl_scene_key_light(const hl_camera *camera, hl_light *light) {
  hl_light_defaults(light);
  hl_light_direction(camera, LIGHT_AZIMUTH, LIGHT_ELEVATION, light->direction);
  light->angular_diameter_deg = 7;
  light->intensity = 1.7;
}

/* The camera of a scene whose only volume was analysed, or (analysis null) of any scene. */
static hl_status frame(const hl_scene_description *description, const hl_data_analysis *analysis,
                       hl_camera *camera, hl_error *error) {
  hl_upright upright = {{0, 0, 1}, {1, 0, 0}, AZIMUTH};
  hl_status status = HL_OK;
  if (analysis != NULL) status = hl_scene_upright(&description->volumes[0], analysis, &upright, error);
  if (status != HL_OK) return status;
  status = hl_camera_frame_upright(description, upright, upright.azimuth_deg, ELEVATION, 1, camera);
  return status == HL_OK ? HL_OK : hl_fail(error, status, "the volume cannot be framed: mend its spacing");
}

hl_status hl_scene_frame(const hl_scene_description *description, hl_camera *camera, hl_error *error) {
  const hl_scene_volume *only = description->volume_count == 1 ? &description->volumes[0] : NULL;
  hl_data_analysis analysis;
  bool asked = only != NULL && only->rotate_angle_deg == 0; /* who turns a volume knows its way up */
  hl_status status = asked ? hl_data_analyse(only->volume, &analysis, error) : HL_OK;
  return status == HL_OK ? frame(description, asked ? &analysis : NULL, camera, error) : status;
}

static void choose_material(hl_data_kind kind, hl_scene_volume *volume) {
  volume->shading = kind == HL_DATA_MEDIUM ? HL_SHADING_NONE : HL_SHADING_PHONG;
  volume->material = (hl_material){.ambient = 1, .diffuse = 0.85, .specular = 0.15, .shininess = 24};
}

/* About as many sheets across any grid: coarse ones show rings on smooth skins where sheets are a voxel
 * apart, and cost little with more; large ones are within 0.4 % of the finest at a voxel. */
static double enough_sheets(const hl_volume *volume) {
  double edge = INFINITY, diagonal = 0;
  for (int a = 0; a < 3; a++) {
    double length = vec3_length(mat3_column(volume->index_to_world.linear, a));
    edge = fmin(edge, length);
    diagonal = hypot(diagonal, length * (double)volume->dimension[a]);
  }
  return fmin(fmax(diagonal / edge / SHEETS, 0.25), 1);
}

hl_status hl_scene_for_volume(hl_context *context, hl_volume *volume, const char *file, hl_scene **scene,
                              hl_error *error) {
  if (context == NULL || volume == NULL || scene == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_scene_for_volume: null context, volume or scene");
  *scene = NULL;
  hl_data_analysis analysis;
  hl_status status = hl_data_analyse(volume, &analysis, error);
  if (status != HL_OK) return status;
  hl_scene_volume scene_volume;
  hl_scene_volume_defaults(&scene_volume);
  scene_volume.volume = volume;
  scene_volume.file = file;
  choose_material(analysis.kind, &scene_volume);
  status =
      hl_transfer_function_from_analysis(context, volume, &analysis, &scene_volume.transfer_function, error);
  if (status != HL_OK) return status;
  hl_light light;
  hl_scene_description description;
  hl_scene_description_defaults(&description);
  description.volumes = &scene_volume;
  description.volume_count = 1;
  status = hl_scene_volume_check(&scene_volume, 0, error);
  if (status == HL_OK) status = frame(&description, &analysis, &description.camera, error);
  if (status == HL_OK) {
    hl_scene_key_light(&description.camera, &light);
    if (scene_volume.shading == HL_SHADING_NONE) light.intensity = 1.25; /* a medium loses nothing to its slope */
    description.lights = &light;
    description.light_count = 1;
    memcpy(description.background, (double[3]){0.022, 0.025, 0.030}, sizeof description.background);
    for (int channel = 0; channel < 3; channel++) description.ambient[channel] = 0.2;
    description.render.sheet_spacing = enough_sheets(volume);
    status = hl_scene_create(context, &description, scene, error);
  }
  hl_transfer_function_release(context, &scene_volume.transfer_function);
  return status;
}
