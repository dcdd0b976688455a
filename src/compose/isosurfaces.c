/* compose/isosurfaces.c - applies the option "iso" [NAME=]VALUE[,VALUE...][:COLOR[:OPACITY]], which shows
 * surfaces on each of which a volume has one value. In a list of values, the colour and the opacity are for
 * the last value. The surfaces replace the matter that the volume's transfer function shows. */
#include <math.h>
#include <string.h>

#include "compose/composer.h"
#include "core/context.h"
#include "core/door.h"
#include "text/color.h"
#include "text/plain.h"

enum { COLOR_BYTES = 64 };

/* Reads the first surface of a text: VALUE[:COLOR[:OPACITY]], or VALUE before a comma. *text moves to the
 * next surface, or to the text's end. Returns false if the text begins with something else. */
static bool read_iso(const char **text, hl_isosurface *surface) {
  char *rest, color[COLOR_BYTES];
  surface->value = hl_plain_number(*text, &rest);
  if (rest == *text || !isfinite(surface->value)) return false;
  *text = *rest == ',' ? rest + 1 : rest + strlen(rest);
  if (*rest == ',') return **text != '\0';
  if (*rest == '\0') return true;
  if (*rest++ != ':') return false;
  size_t length = strcspn(rest, ":");
  if (length >= sizeof color) return false;
  memcpy(color, rest, length);
  color[length] = '\0';
  if (length > 0 && !hl_parse_color(color, 0, 1, surface->color)) return false;
  rest += length;
  if (*rest == '\0') return true;
  const char *opacity = ++rest;
  surface->opacity = hl_plain_number(opacity, &rest);
  return rest != opacity && *rest == '\0' && surface->opacity >= 0 && surface->opacity <= 1;
}

/* The text after "NAME=", or the whole text. A value of "iso" has no '=' of its own. */
static const char *text_of_surface(const char *text) {
  const char *equals = strchr(text, '=');
  return equals != NULL ? equals + 1 : text;
}

hl_status hl_check_isosurfaces(const hl_asked *iso, hl_error *error) {
  hl_isosurface surface;
  hl_isosurface_defaults(&surface);
  for (int n = 0; n < iso->count; n++) {
    const char *text = text_of_surface(iso->texts[n]);
    do {
      if (!read_iso(&text, &surface))
        return hl_fail(error, HL_ERROR_ARGUMENT,
                       "--iso: '%.300s' is not VALUE[:COLOR[:OPACITY]]: a value of the volume, a colour as "
                       "#rrggbb, linear R,G,B or a CSS name, and an opacity from 0 to 1 (120:gold:0.3); "
                       "surfaces of several colours are --iso 30:gold:0.3 --iso 90:skyblue",
                       iso->texts[n]);
    } while (*text != '\0');
  }
  return HL_OK;
}

size_t hl_count_isosurfaces(const hl_asked *iso) {
  size_t count = 0;
  for (int n = 0; n < iso->count; n++) {
    const char *text = text_of_surface(iso->texts[n]);
    const size_t length = strcspn(text, ":"); /* commas behind the colon belong to a colour, not to the list
                                               * of values */
    count++;
    for (size_t at = 0; at < length; at++) count += text[at] == ',';
  }
  return count;
}

static hl_status warn_of_range(const hl_composer *composer, const hl_scene_volume *volume, double value) {
  hl_volume_info info = {.struct_size = sizeof info};
  if (hl_volume_get_info(volume->volume, &info) != HL_OK)
    return hl_fail(composer->error, HL_ERROR_INTERNAL, "--iso: the volume is not known");
  if (!(value > info.range[0] && value < info.range[1]))
    hl_log(composer->context, HL_LOG_WARNING,
           "--iso %.9g: the volume's values go from %.9g to %.9g: no surface is there", value, info.range[0],
           info.range[1]);
  return HL_OK;
}

/* Logs that opaque surfaces hide each other, if a volume has several surfaces and all of them are opaque. */
static void tell_of_hidden(const hl_composer *composer, const hl_isosurface *surfaces, size_t count) {
  bool opaque = count > 1;
  for (size_t n = 0; n < count; n++) opaque &= surfaces[n].opacity == 1;
  if (opaque)
    hl_log(composer->context, HL_LOG_INFO,
           "the outer one of opaque surfaces hides the others: --iso %.9g::0.3 shows them through it",
           surfaces[0].value);
}

/* Hides all matter of a volume, so that only its isosurfaces are seen. */
static void clear_function(hl_transfer_function *function) {
  for (size_t n = 0; n < function->opacity_count; n++) ((hl_opacity_point *)function->opacity)[n].opacity = 0;
}

void hl_surface_color(size_t index, double color[3]) {
  HL_DOOR;
  static const double colors[][3] = {{0.75, 0.71, 0.62}, {0.18, 0.40, 0.70}, {0.75, 0.42, 0.10},
                                     {0.20, 0.50, 0.22}, {0.72, 0.28, 0.32}, {0.38, 0.28, 0.62}};
  if (color != NULL) memcpy(color, colors[index % (sizeof colors / sizeof *colors)], 3 * sizeof *color);
}

hl_status hl_compose_isosurfaces(const hl_composer *composer, size_t index, hl_scene_volume *volume,
                                 hl_isosurface *surfaces) {
  size_t count = 0;
  const hl_asked *iso = &composer->asked[HL_ASK_ISO];
  for (int n = 0; n < iso->count; n++) {
    const char *text;
    if (!hl_text_is_for(composer, iso->texts[n], volume, index, &text)) continue;
    do { /* hl_check_isosurfaces() has checked the text */
      hl_isosurface *surface = &surfaces[count];
      hl_isosurface_defaults(surface);
      hl_surface_color(count, surface->color);
      (void)read_iso(&text, surface);
      hl_status status = warn_of_range(composer, volume, surface->value);
      if (status != HL_OK) return status;
      count++;
    } while (*text != '\0');
  }
  if (count == 0) return HL_OK;
  tell_of_hidden(composer, surfaces, count);
  volume->iso = surfaces;
  volume->iso_count = count;
  if (!composer->asked[HL_ASK_TF].given && !composer->asked[HL_ASK_LOOK].given)
    clear_function(&volume->transfer_function);
  return HL_OK;
}
