/* compose/looks.h - the option "look": a look of the library's, or a maximum projection. */
#ifndef HL_COMPOSE_LOOKS_H
#define HL_COMPOSE_LOOKS_H

#include <halflight/settings.h>
#include <stdbool.h>

struct hl_composer;

/* The library's look that "look" asks for; null: none, or a maximum projection. */
const char *hl_asked_look(const struct hl_composer *composer);

/* True if "look" replaces the volumes' transfer functions: bare volumes are made with their look, and a
 * scene's transfer functions stay in a maximum projection. */
bool hl_look_replaces_functions(const struct hl_composer *composer);

/* Gives one volume the transfer function (hl_transfer_function_release) and the shading of the look. */
hl_status hl_compose_volume_look(const struct hl_composer *composer, hl_scene_volume *volume);

/* Makes the greys of a bare volume's maximum projection begin at the colour of "background", so that what is
 * hardly there is not seen, and end at black or white, whichever is farther from it. */
void hl_fit_projection(const struct hl_composer *composer, hl_transfer_function *function);

/* Tells the log what "tf" and what "look" gives the picture where both are asked for. */
void hl_tell_of_function(const struct hl_composer *composer);

/* Makes the picture a maximum projection, or one with light. */
void hl_compose_look(const struct hl_composer *composer, hl_scene_description *description);

/* True if the picture is a maximum projection, by "look" or else by the scene. */
bool hl_is_maximum(const struct hl_composer *composer, const hl_scene_description *description);

/* The colour of volume number `index` among several bare ones in a maximum projection, so that channels
 * differ, as "#rrggbb"; false: none, as the volume is alone or has a "tf". */
bool hl_projected_color(const struct hl_composer *composer, const hl_scene_description *description,
                        size_t index, char color[8]);

#endif
