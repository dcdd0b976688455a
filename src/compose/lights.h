/* compose/lights.h - what the options change of a scene's light. */
#ifndef HL_COMPOSE_LIGHTS_H
#define HL_COMPOSE_LIGHTS_H

#include "compose/composer.h"

/* Gives the description changed lights. *lights: owned by the caller, who releases them after a failure, too.
 */
hl_status hl_compose_lights(const hl_composer *composer, hl_scene_description *description,
                            hl_light **lights);

/* "ambient", in place of the sky that was chosen for a bare volume; "shadows" off wants no shadow of that sky
 * either. */
void hl_compose_ambient(const hl_composer *composer, hl_scene_description *description);

#endif
