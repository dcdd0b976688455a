/* cli/render_iso.c - `--iso [NAME=]VALUE[:COLOR[:OPACITY]]`: surfaces on which a volume has one value, in
 * place of what its transfer function shows. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render.h"
#include "text/plain.h"

enum { COLOR_BYTES = 64 };

/* Reads VALUE[:COLOR[:OPACITY]]; false: it is something else. */
static bool read_iso(const char *text, hl_isosurface *surface) {
  char *rest, color[COLOR_BYTES];
  surface->value = hl_plain_number(text, &rest);
  if (rest == text || !isfinite(surface->value)) return false;
  if (*rest == '\0') return true;
  if (*rest++ != ':') return false;
  size_t length = strcspn(rest, ":");
  if (length >= sizeof color) return false;
  memcpy(color, rest, length);
  color[length] = '\0';
  if (length > 0 && !parse_color(color, 0, 1, surface->color)) return false;
  rest += length;
  if (*rest == '\0') return true;
  const char *opacity = ++rest;
  surface->opacity = hl_plain_number(opacity, &rest);
  return rest != opacity && *rest == '\0' && surface->opacity >= 0 && surface->opacity <= 1;
}

/* The text after "NAME=", or all where there is no name. */
static const char *text_of_surface(const char *text) {
  const char *rest = render_after_name(text);
  return rest != NULL ? rest : text;
}

int render_check_iso(const cli_value *iso) {
  hl_isosurface surface;
  hl_isosurface_defaults(&surface);
  for (int n = 0; n < iso->count; n++)
    if (!read_iso(text_of_surface(iso->texts[n]), &surface))
      return fail(
          EXIT_CODE_USAGE,
          "--iso: '%s' is not VALUE[:COLOR[:OPACITY]]: a value of the volume, a colour as #rrggbb, linear "
          "R,G,B or a CSS name, and an opacity from 0 to 1 (120:gold:0.3)",
          iso->texts[n]);
  return EXIT_CODE_OK;
}

static int warn_of_range(const cli_host *host, const hl_scene_volume *volume, double value) {
  hl_volume_info info = {.struct_size = sizeof info};
  if (hl_volume_get_info(volume->volume, &info) != HL_OK)
    return fail(EXIT_CODE_FAILURE, "--iso: the volume is not known");
  if (!host->quiet && !(value > info.range[0] && value < info.range[1]))
    warn("--iso %.9g: the volume's values go from %.9g to %.9g: no surface is there", value, info.range[0],
         info.range[1]);
  return EXIT_CODE_OK;
}

/* Shows nothing of a volume but its surfaces. */
static void clear_function(hl_transfer_function *function) {
  for (size_t n = 0; n < function->opacity_count; n++) ((hl_opacity_point *)function->opacity)[n].opacity = 0;
}

int render_iso(const cli_host *host, const cli_value *values, size_t index, hl_scene_volume *volume,
               hl_isosurface *surfaces) {
  char name[256];
  size_t count = 0;
  const cli_value *iso = &values[RENDER_ISO];
  render_volume_name(volume, index, name, sizeof name);
  for (int n = 0; n < iso->count; n++) {
    if (!render_is_for(iso->texts[n], name)) continue;
    hl_isosurface *surface = &surfaces[count];
    hl_isosurface_defaults(surface);
    memcpy(surface->color, render_surface_color(count), sizeof surface->color);
    (void)read_iso(text_of_surface(iso->texts[n]), surface); /* checked by render_check_iso() */
    if (warn_of_range(host, volume, surface->value) != EXIT_CODE_OK) return EXIT_CODE_FAILURE;
    count++;
  }
  if (count == 0) return EXIT_CODE_OK;
  volume->iso = surfaces;
  volume->iso_count = count;
  if (!values[RENDER_TF].given && !values[RENDER_LOOK].given) clear_function(&volume->transfer_function);
  return EXIT_CODE_OK;
}
