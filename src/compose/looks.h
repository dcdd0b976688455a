/* compose/looks.h - the option "look": a look of the library's, or a maximum projection. */
#ifndef HL_COMPOSE_LOOKS_H
#define HL_COMPOSE_LOOKS_H

#include <halflight/settings.h>
#include <stdbool.h>

struct hl_composer;

/* The library's look that "look" asks for; null: "look" is not given, or asks for a maximum projection. */
const char *hl_asked_look(const struct hl_composer *composer);

/* Returns true if "look" replaces the volumes' transfer functions. It does not for bare volumes, which were
 * made with their look already, nor for a maximum projection, in which a scene's transfer functions stay. */
bool hl_look_replaces_functions(const struct hl_composer *composer);

/* Gives one volume the transfer function (hl_transfer_function_release) and the shading of the look. */
hl_status hl_compose_volume_look(const struct hl_composer *composer, hl_scene_volume *volume);

/* Adapts the greys of a bare volume's maximum projection to "background". The greys begin at the background's
 * colour, so that nearly transparent matter is not seen. They end at black or white, whichever differs more
 * from the background. */
void hl_fit_projection(const struct hl_composer *composer, hl_transfer_function *function);

/* Where both "tf" and "look" are given, logs which properties of the picture come from which of them. */
void hl_tell_of_function(const struct hl_composer *composer);

/* Makes the picture a maximum projection, or a picture with light, as "look" asks. */
void hl_compose_look(const struct hl_composer *composer, hl_scene_description *description);

/* Returns true if the picture is a maximum projection, as "look" says; where "look" is not given, as the
 * scene says. */
bool hl_is_maximum(const struct hl_composer *composer, const hl_scene_description *description);

/* The colour, as "#rrggbb", of volume number `index` in a maximum projection of several bare volumes, so that
 * channels differ. False: there is no colour, because the volume is alone or has a "tf". */
bool hl_projected_color(const struct hl_composer *composer, const hl_scene_description *description,
                        size_t index, char color[8]);

#endif
