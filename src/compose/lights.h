/* compose/lights.h - changes a scene's light by options. */
#ifndef HL_COMPOSE_LIGHTS_H
#define HL_COMPOSE_LIGHTS_H

#include "compose/composer.h"

/* Changes the description's lights by the options. *lights: the changed lights, owned by the caller, who must
 * release them also after a failure. */
hl_status hl_compose_lights(const hl_composer *composer, hl_scene_description *description,
                            hl_light **lights);

/* Applies "ambient": sets the ambient light, which replaces the sky that was chosen for a bare volume. If
 * "shadows" is off, constant light without shadows replaces the sky of a bare volume. */
void hl_compose_ambient(const hl_composer *composer, hl_scene_description *description);

#endif
