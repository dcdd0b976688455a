/* compose/lights.c - applies the options "light-rig", "light", "light-size", "shadows" and "ambient", and
 * chooses the strength of a bare volume's light. */
#include "compose/lights.h"

#include <string.h>

#include "compose/looks.h"
#include "core/memory.h"

static const char *light_type_name(hl_light_type type) {
  const hl_setting_choice *choice = hl_setting_find(HL_SETTINGS_LIGHT, "type")->choices;
  while (choice->name != NULL && choice->value != (int)type) choice++;
  return choice->name != NULL ? choice->name : "unknown";
}

static hl_status change_first_light(const hl_composer *composer, hl_scene_description *description,
                                    hl_light *light) {
  const hl_asked *asked = composer->asked;
  if (asked[HL_ASK_LIGHT].given) {
    if (description->light_count == 0) {
      hl_light_defaults(light);
      light->frame = HL_LIGHT_FRAME_CAMERA;
      description->light_count = 1;
    }
    light->type = HL_LIGHT_DIRECTIONAL;
    const double *angles = asked[HL_ASK_LIGHT].number;
    if (light->frame == HL_LIGHT_FRAME_CAMERA)
      hl_light_direction_beside(angles[0], angles[1], light->direction);
    else hl_light_direction(&description->camera, angles[0], angles[1], light->direction);
  }
  if (!asked[HL_ASK_LIGHT_SIZE].given) return HL_OK;
  if (description->light_count == 0)
    return hl_fail(composer->error, HL_ERROR_ARGUMENT,
                   "--light-size: the scene has no light: add --light AZ,EL");
  if (light->type != HL_LIGHT_DIRECTIONAL)
    return hl_fail(composer->error, HL_ERROR_ARGUMENT,
                   "--light-size is the angle of a directional light, and /lights/0 is a %s light: "
                   "change its size in the scene, or add --light AZ,EL",
                   light_type_name(light->type));
  light->angular_diameter_deg = asked[HL_ASK_LIGHT_SIZE].number[0];
  return HL_OK;
}

/* Applies "shadows": sets the kind of the scene's shadows. Every light that casts shadows then follows the
 * scene's setting. */
static void change_shadows(const hl_composer *composer, hl_scene_description *description, hl_light *lights) {
  if (!composer->asked[HL_ASK_SHADOWS].given) return;
  hl_shadows shadows = (hl_shadows)composer->asked[HL_ASK_SHADOWS].choice;
  description->render.shadows = shadows;
  for (size_t i = 0; i < description->light_count; i++)
    if (lights[i].shadows != HL_SHADOWS_OFF) lights[i].shadows = HL_SHADOWS_DEFAULT;
}

/* Chooses the strength of a bare volume's light anew if the volume is cut, has isosurfaces, scatters light
 * more than once, or is lit by a light rig. The first choice was made for the whole volume and its transfer
 * function; the new choice is made for what is visible now. */
static hl_status expose_anew(const hl_composer *composer, hl_scene_description *description,
                             hl_light *lights) {
  double factor = 1;
  if (!composer->bare || description->volume_count != 1 || hl_is_maximum(composer, description) ||
      (composer->flags & HL_COMPOSE_LIGHTS) != 0)
    return HL_OK;
  bool cut = hl_cuts_bare_volume(composer, description) || (composer->flags & HL_COMPOSE_CUT) != 0;
  bool rigged = composer->asked[HL_ASK_LIGHT_RIG].given, glows = composer->asked[HL_ASK_SCATTERING].given;
  if (!cut && !rigged && !glows && description->volumes[0].iso_count == 0) return HL_OK;
  const char *look = hl_asked_look(composer);
  hl_status status = hl_scene_light_factor(description, look != NULL ? look : "auto", &factor,
                                           composer->error);
  if (status != HL_OK) return hl_blame_options(status);
  for (size_t l = 0; l < description->light_count; l++) lights[l].intensity *= factor;
  for (int c = 0; c < 3; c++) description->ambient[c] *= factor;
  if ((composer->flags & HL_COMPOSE_SKY) == 0) description->sky.strength *= factor;
  return HL_OK;
}

hl_status hl_compose_lights(const hl_composer *composer, hl_scene_description *description,
                            hl_light **lights) {
  const hl_asked *rig = &composer->asked[HL_ASK_LIGHT_RIG];
  size_t count = description->light_count, room = count + HL_LIGHT_RIG_MOST;
  hl_status status = HL_OK;
  *lights = hl_allocate_zeroed(composer->context, room, sizeof **lights);
  if (*lights == NULL) return hl_fail_memory(composer->error, room * sizeof **lights, "the scene's lights");
  if (count > 0) memcpy(*lights, description->lights, count * sizeof **lights);
  description->lights = *lights;
  if (rig->given) status = hl_scene_light_rig(rig->text, description, *lights, composer->error);
  if (status != HL_OK) return status;
  change_shadows(composer, description, *lights);
  status = change_first_light(composer, description, *lights);
  return status == HL_OK ? expose_anew(composer, description, *lights) : status;
}

void hl_compose_ambient(const hl_composer *composer, hl_scene_description *description) {
  const hl_asked *asked = composer->asked;
  bool chosen = composer->bare && !asked[HL_ASK_SKY].given && (composer->flags & HL_COMPOSE_SKY) == 0,
       unshadowed = asked[HL_ASK_SHADOWS].given && asked[HL_ASK_SHADOWS].choice == HL_SHADOWS_OFF;
  if (chosen && unshadowed) hl_scene_level_sky(description);
  if (!asked[HL_ASK_AMBIENT].given) return;
  memcpy(description->ambient, asked[HL_ASK_AMBIENT].number, sizeof description->ambient);
  if (chosen) description->sky.type = HL_SKY_NONE;
}
