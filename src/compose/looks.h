/* compose/looks.h - applies the option "look", which names one of the library's looks, or a maximum
 * projection. */
#ifndef HL_COMPOSE_LOOKS_H
#define HL_COMPOSE_LOOKS_H

#include <halflight/settings.h>
#include <stdbool.h>

struct hl_composer;

/* The library's look that "look" asks for; null if "look" is not given, or asks for a maximum projection. */
const char *hl_asked_look(const struct hl_composer *composer);

/* Returns true if "look" replaces the volumes' transfer functions. The transfer functions of bare volumes
 * were made for the look already, so that only a maximum projection replaces them. The transfer functions of
 * a scene's file are replaced by any look except a maximum projection. The option "slice" replaces all
 * transfer functions. */
bool hl_look_replaces_functions(const struct hl_composer *composer);

/* Gives a volume the transfer function and the shading of the look. The caller releases the function by
 * hl_transfer_function_release(). */
hl_status hl_compose_volume_look(const struct hl_composer *composer, hl_scene_volume *volume);

/* Adapts the greys of a bare volume's maximum projection to "background". The greys begin at the background's
 * colour, so that nearly transparent matter does not show. The greys end at black or at white, whichever
 * differs more from the background. */
void hl_fit_projection(const struct hl_composer *composer, hl_transfer_function *function);

/* Returns whether volume number `index` is shown as on a printed film, because white matter would not be seen
 * before a white background. A volume is shown as on a film if the look is xray, the background is bright,
 * and no option gives the volume other colours. */
bool hl_is_film(const struct hl_composer *composer, const hl_scene_description *description, size_t index);

/* Makes the look's white matter black, so that it only absorbs the light of the background. The density of
 * the matter is changed so that matter which is middle grey before black stays middle grey before white. A
 * function with any colour but white, as channels have, does not change. */
void hl_make_film(hl_transfer_function *function);

/* Fits a colormap in a bare volume's maximum projection to the background, if the background has one colour
 * (hl_transfer_function_fade()). */
hl_status hl_fade_projection(const struct hl_composer *composer, const hl_volume *volume,
                             hl_transfer_function *function);

/* If "tf" and "look" are given together, logs which properties of the picture come from "tf", and which ones
 * from "look". */
void hl_tell_of_function(const struct hl_composer *composer);

enum { HL_RAMP_POINTS = 33 };

/* Makes the colours of a volume's maximum projection from a single colour: a ramp from black at range[0] to
 * the colour at range[1]. color: linear RGB. on_background: whether the ramp begins with the colour of
 * "background", if this option is given, in place of black. Returns the number of points. */
size_t hl_projection_ramp(const struct hl_composer *composer, const double color[3], const double range[2],
                          bool on_background, hl_color_point ramp[HL_RAMP_POINTS]);

/* Logs how maximum projections of several bare volumes look before a background that is not black. */
void hl_tell_of_background(const struct hl_composer *composer, const hl_scene_description *description);

/* Makes the picture a maximum projection, or a picture with light, as "look" asks. */
void hl_compose_look(const struct hl_composer *composer, hl_scene_description *description);

/* Returns whether the picture is a maximum projection. The option "look" decides; if "look" is not given, the
 * scene's setting decides. */
bool hl_is_maximum(const struct hl_composer *composer, const hl_scene_description *description);

/* Finds the colour, as "#rrggbb", that volume number `index` gets in a maximum projection or on a slice of
 * several volumes, so that channels differ. Returns false if the volume gets no such colour, for example
 * because it is the only volume or has a "tf". */
bool hl_projected_color(const struct hl_composer *composer, const hl_scene_description *description,
                        size_t index, char color[8]);

#endif
