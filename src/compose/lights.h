/* compose/lights.h - the changes that options make to a scene's light. */
#ifndef HL_COMPOSE_LIGHTS_H
#define HL_COMPOSE_LIGHTS_H

#include "compose/composer.h"

/* Gives the description changed lights. *lights: owned by the caller, who must release them after a failure,
 * too. */
hl_status hl_compose_lights(const hl_composer *composer, hl_scene_description *description,
                            hl_light **lights);

/* "ambient": sets the ambient light, which replaces the sky that was chosen for a bare volume. With "shadows"
 * off, this sky casts no shadow, either. */
void hl_compose_ambient(const hl_composer *composer, hl_scene_description *description);

#endif
