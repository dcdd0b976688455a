/* compose/looks.c - see looks.h. */
#include "compose/looks.h"

#include <math.h>
#include <stdio.h>

#include "compose/composer.h"
#include "compose/slice.h"
#include "core/context.h"
#include "core/door.h"
#include "elementary/elementary.h"
#include "image/srgb.h"
#include "scene/function/transfer_function.h"

static bool is_maximum(const hl_asked *asked) {
  return asked[HL_ASK_LOOK].given && asked[HL_ASK_LOOK].choice == HL_LOOK_MIP;
}

bool hl_projected_color(const hl_composer *composer, const hl_scene_description *description, size_t index,
                        char color[8]) {
  double srgb[3];
  const hl_scene_volume *volume = &description->volumes[index];
  const bool slice = composer->asked[HL_ASK_SLICE].given;
  bool alone = slice ? hl_count_values(description) < 2 : description->volume_count < 2,
       named = hl_text_for(composer, HL_ASK_TF, volume, index) != NULL;
  if (alone || named || (slice && hl_slice_layer(composer, description, index) == 1) ||
      !(slice || is_maximum(composer->asked)) || hl_scene_channel_color(description, index, srgb) != HL_OK)
    return false;
  snprintf(color, 8, "#%02x%02x%02x", (unsigned)lround(255 * srgb[0]) & 255U,
           (unsigned)lround(255 * srgb[1]) & 255U, (unsigned)lround(255 * srgb[2]) & 255U);
  return true;
}

const char *hl_asked_look(const hl_composer *composer) {
  const hl_asked *look = &composer->asked[HL_ASK_LOOK];
  return look->given && !is_maximum(composer->asked) ? look->text : NULL;
}

bool hl_look_replaces_functions(const hl_composer *composer) {
  if (composer->asked[HL_ASK_SLICE].given) return true;
  return composer->asked[HL_ASK_LOOK].given && is_maximum(composer->asked) == composer->bare;
}

hl_status hl_compose_volume_look(const hl_composer *composer, hl_scene_volume *volume) {
  hl_transfer_function function = {0};
  const char *name = hl_asked_look(composer);
  hl_shading shading = volume->shading;
  hl_status status = name == NULL ? hl_transfer_function_preset(composer->context, "mip", volume->volume,
                                                                &function, composer->error)
                                  : hl_transfer_function_look(composer->context, name, volume->volume,
                                                              &function, &shading, composer->error);
  if (status != HL_OK) return status;
  volume->transfer_function = function;
  volume->transfer_function.unit_distance *= fabs(volume->scale);
  if (!composer->asked[HL_ASK_SHADING].given && composer->asked[HL_ASK_LOOK].choice != HL_LOOK_AUTO)
    volume->shading = shading;
  return HL_OK;
}

/* Finds the background's colour, in linear RGB, to which a maximum projection is fitted. Returns false if the
 * background has no single colour. */
static bool find_background(const hl_composer *composer, double color[3]) {
  const hl_asked *background = &composer->asked[HL_ASK_BACKGROUND];
  for (int c = 0; c < 3; c++) color[c] = background->given ? background->number[c] : 0;
  return !background->chosen;
}

/* The colour at the fraction t of the way between two colours, mixed in sRGB-encoded values. Colours are
 * linear RGB. */
static void mix_encoded(const double from[3], const double to[3], double t, double mixed[3]) {
  for (int c = 0; c < 3; c++) {
    const double begin = hl_srgb_encode_number(from[c]), end = hl_srgb_encode_number(to[c]);
    mixed[c] = hl_srgb_decode(begin + (end - begin) * t);
  }
}

/* Derived: a grey of the preset, when encoded, lies at the fraction t of the way from black to white. The new
 * colour lies at the fraction t of the way from the background's colour to the end colour, also in encoded
 * values. For a black background and a white end, the new colour is the grey itself. */
void hl_fit_projection(const hl_composer *composer, hl_transfer_function *function) {
  double from[3];
  if (!composer->asked[HL_ASK_BACKGROUND].given || !find_background(composer, from)) return;
  const double end = hl_color_is_bright(from) ? 0 : 1;
  for (size_t n = 0; n < function->color_count; n++) {
    double *color = ((hl_color_point *)function->color)[n].color;
    mix_encoded(from, (double[3]){end, end, end}, hl_srgb_encode_number(color[0]), color);
  }
}

bool hl_is_film(const hl_composer *composer, const hl_scene_description *description, size_t index) {
  const hl_asked *look = &composer->asked[HL_ASK_LOOK], *background = &composer->asked[HL_ASK_BACKGROUND];
  const bool keyed = background->given ? background->chosen
                                       : description->background_transparent || description->background_sky;
  const hl_scene_volume *volume = &description->volumes[index];
  return look->given && look->choice == HL_LOOK_XRAY && !keyed && volume->label_count == 0 &&
         hl_color_is_bright(background->given ? background->number : description->background) &&
         hl_text_for(composer, HL_ASK_COLORMAP, volume, index) == NULL &&
         hl_text_for(composer, HL_ASK_TF, volume, index) == NULL;
}

/* Derived: a path of the transmittance T shows 1 - T before black. With its extinction multiplied by f, the
 * path shows T^f on the film. The two are the middle grey g if T = 1 - g and f = ln g / ln(1 - g). */
void hl_make_film(hl_transfer_function *function) {
  for (size_t n = 0; n < function->color_count; n++)
    for (int c = 0; c < 3; c++)
      if (function->color[n].color[c] != 1) return;
  for (size_t n = 0; n < function->color_count; n++)
    for (int c = 0; c < 3; c++) ((hl_color_point *)function->color)[n].color[c] = 0;
  function->unit_distance *= hl_log2(1 - HL_MIDDLE_GREY) / hl_log2(HL_MIDDLE_GREY);
}

/* Returns whether a colour is nearly the background's, so that a map that begins with it fades by itself. */
static bool is_nearly(const double color[3], const double background[3]) {
  static const double nearly = 1.0 / 16; /* as a fraction of the encoded values from black to white */
  for (int c = 0; c < 3; c++)
    if (fabs(hl_srgb_encode_number(color[c]) - hl_srgb_encode_number(background[c])) > nearly) return false;
  return true;
}

/* Fades the colours of values below `begin` into the background. The fading of a point depends on the point's
 * number, and points are evenly spaced on the scale of the function's range, so that decades of a logarithmic
 * scale fade evenly, too. */
static void fade_below(double begin, const double background[3], hl_transfer_function *function) {
  if (begin >= function->color[function->color_count - 1].value) return;
  size_t count = 0;
  while (function->color[count].value < begin) count++;
  for (size_t n = 0; n < count; n++) {
    double *color = ((hl_color_point *)function->color)[n].color;
    mix_encoded(background, color, (double)n / (double)count, color);
  }
}

hl_status hl_transfer_function_fade(hl_context *context, const hl_volume *volume, const double background[3],
                                    const hl_transfer_function *from, hl_transfer_function *to,
                                    hl_error *error) {
  HL_DOOR;
  double seen[2];
  hl_transfer_function objects = {0}, faded = {0};
  if (context == NULL || volume == NULL || background == NULL || from == NULL || to == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_transfer_function_fade: null argument");
  hl_status status = hl_transfer_function_automatic(context, volume, &objects, error);
  if (status == HL_OK) status = hl_transfer_function_visible_range(volume, &objects, seen, error);
  if (status == HL_OK) status = hl_transfer_function_copy(context, from, &faded, error);
  hl_transfer_function_release(context, &objects);
  if (status != HL_OK) return status;
  if (faded.color_count > 1 && !is_nearly(faded.color[0].color, background))
    fade_below(seen[0], background, &faded);
  *to = faded;
  return HL_OK;
}

hl_status hl_fade_projection(const hl_composer *composer, const hl_volume *volume,
                             hl_transfer_function *function) {
  double background[3];
  hl_transfer_function faded = {0};
  if (!find_background(composer, background)) return HL_OK;
  hl_status status = hl_transfer_function_fade(composer->context, volume, background, function, &faded,
                                               composer->error);
  if (status != HL_OK) return hl_blame_options(status);
  hl_transfer_function_release(composer->context, function);
  *function = faded;
  return HL_OK;
}

void hl_tell_of_function(const hl_composer *composer) {
  const hl_asked *look = &composer->asked[HL_ASK_LOOK];
  if (!look->given || look->choice == HL_LOOK_AUTO || !composer->asked[HL_ASK_TF].given) return;
  hl_log(composer->context, HL_LOG_INFO,
         "--tf beside --look %s: the transfer function is the one of --tf, %s", look->text,
         is_maximum(composer->asked) ? "and the picture a maximum projection of it"
                                     : "the shading and the light are those of the look");
}

/* On a background, the ramp goes from the background's colour to the volume's colour, evenly in encoded
 * values, like the greys of a single volume. */
size_t hl_projection_ramp(const hl_composer *composer, const double color[3], const double range[2],
                          bool on_background, hl_color_point ramp[HL_RAMP_POINTS]) {
  double from[3];
  const bool lies = on_background && !composer->asked[HL_ASK_SLICE].given &&
                    find_background(composer, from) && from[0] + from[1] + from[2] > 0;
  const size_t count = lies ? HL_RAMP_POINTS : 2;
  for (size_t n = 0; n < count; n++) {
    const double t = (double)n / (double)(count - 1);
    ramp[n].value = range[0] + t * (range[1] - range[0]);
    for (int c = 0; c < 3; c++) ramp[n].color[c] = t * color[c];
    if (lies) mix_encoded(from, color, hl_srgb_encode_number(t), ramp[n].color);
  }
  return count;
}

void hl_tell_of_background(const hl_composer *composer, const hl_scene_description *description) {
  double color[3];
  bool mapped = false;
  if (!composer->bare || description->volume_count < 2 || !hl_is_maximum(composer, description) ||
      !find_background(composer, color) || color[0] + color[1] + color[2] == 0)
    return;
  for (size_t v = 0; v < description->volume_count; v++) mapped |= hl_has_colormap(composer, description, v);
  if (mapped)
    hl_log(composer->context, HL_LOG_INFO,
           "the colormaps of several maximum projections add up as light, and do not begin with this "
           "background: "
           "give colours, as --colormap green,magenta, or --background black");
  else if (hl_color_is_bright(color))
    hl_log(composer->context, HL_LOG_INFO,
           "before a bright background the projections darken each other like inks: --background black lets "
           "them "
           "shine");
}

void hl_compose_look(const hl_composer *composer, hl_scene_description *description) {
  const bool maximum = is_maximum(composer->asked);
  if (!composer->asked[HL_ASK_LOOK].given) return;
  description->render.compositing = maximum ? HL_COMPOSITING_MAXIMUM : HL_COMPOSITING_LIGHT;
  for (int c = 0; c < 3 && composer->bare && maximum; c++) description->background[c] = 0;
}

bool hl_is_maximum(const hl_composer *composer, const hl_scene_description *description) {
  if (composer->asked[HL_ASK_LOOK].given) return is_maximum(composer->asked);
  return description->render.compositing == HL_COMPOSITING_MAXIMUM;
}
