/* compose/lights.h - the changes that options make to a scene's light. */
#ifndef HL_COMPOSE_LIGHTS_H
#define HL_COMPOSE_LIGHTS_H

#include "compose/composer.h"

/* Changes the description's lights by the options. *lights: the changed lights, owned by the caller, who must
 * release them also after a failure. */
hl_status hl_compose_lights(const hl_composer *composer, hl_scene_description *description,
                            hl_light **lights);

/* "ambient": sets the ambient light. It takes the place of the sky that was chosen for a bare volume. If
 * "shadows" is off, constant light without shadows takes the place of that sky. */
void hl_compose_ambient(const hl_composer *composer, hl_scene_description *description);

#endif
