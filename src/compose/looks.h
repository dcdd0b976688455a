/* compose/looks.h - applies the option "look", which names one of the library's looks, or a maximum
 * projection. */
#ifndef HL_COMPOSE_LOOKS_H
#define HL_COMPOSE_LOOKS_H

#include <halflight/settings.h>
#include <stdbool.h>

struct hl_composer;

/* The library's look that "look" asks for; null if "look" is not given, or asks for a maximum projection. */
const char *hl_asked_look(const struct hl_composer *composer);

/* Returns true if "look" replaces the volumes' transfer functions. The transfer functions of bare volumes are
 * not replaced, because they were made for the look already. In a maximum projection, a scene's transfer
 * functions are not replaced either. */
bool hl_look_replaces_functions(const struct hl_composer *composer);

/* Gives one volume the transfer function (hl_transfer_function_release) and the shading of the look. */
hl_status hl_compose_volume_look(const struct hl_composer *composer, hl_scene_volume *volume);

/* Adapts the greys of a bare volume's maximum projection to "background". The greys begin at the background's
 * colour, so that nearly transparent matter does not show. They end at black or at white, whichever differs
 * more from the background. */
void hl_fit_projection(const struct hl_composer *composer, hl_transfer_function *function);

/* Returns whether volume number `index` is shown as on a printed film: the look is xray, the background is
 * bright, and no option gives the volume other colours. White matter before a white background would not be
 * seen. */
bool hl_is_film(const struct hl_composer *composer, const hl_scene_description *description, size_t index);

/* Makes the look's white matter black, so that it only absorbs the light of the background. Its density is
 * chosen so that the grey that is middle grey before black stays middle grey before white. Matter of other
 * colours, as in channels, stays the same. */
void hl_make_film(hl_transfer_function *function);

/* Fits a colormap in a bare volume's maximum projection to the background, if the background has one colour
 * (hl_transfer_function_fade()). */
hl_status hl_fade_projection(const struct hl_composer *composer, const hl_volume *volume,
                             hl_transfer_function *function);

/* If both "tf" and "look" are given, logs which properties of the picture come from "tf", and which ones from
 * "look". */
void hl_tell_of_function(const struct hl_composer *composer);

enum { HL_RAMP_POINTS = 33 };

/* Makes the colours of a volume's maximum projection from a colour: they go from black at range[0] to the
 * colour at range[1]. color: linear RGB. on_background: they go from the background, if it is given, in place
 * of black. Returns the number of points. */
size_t hl_projection_ramp(const struct hl_composer *composer, const double color[3], const double range[2],
                          bool on_background, hl_color_point ramp[HL_RAMP_POINTS]);

/* Logs how maximum projections of several bare volumes lie before a background that is not black. */
void hl_tell_of_background(const struct hl_composer *composer, const hl_scene_description *description);

/* Makes the picture a maximum projection, or a picture with light, as "look" asks. */
void hl_compose_look(const struct hl_composer *composer, hl_scene_description *description);

/* Returns whether the picture is a maximum projection. The option "look" decides it; if "look" is not given,
 * the scene decides it. */
bool hl_is_maximum(const struct hl_composer *composer, const hl_scene_description *description);

/* The colour, as "#rrggbb", of volume number `index` in a maximum projection of several bare volumes, so that
 * channels differ. Returns false if there is no colour, because the volume is alone or has a "tf". */
bool hl_projected_color(const struct hl_composer *composer, const hl_scene_description *description,
                        size_t index, char color[8]);

#endif
