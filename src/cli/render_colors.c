/* cli/render_colors.c - the transfer function that --tf and --colormap ask for. */
#include <string.h>
#include <unistd.h>

#include "render.h"

static const char *preset_name(const void *data, size_t index) {
  (void)data;
  return hl_preset_name(index);
}

static const char *colormap_name(const void *data, size_t index) {
  (void)data;
  return hl_colormap_name(index);
}

static bool is_known(const char *name, const char *(*known)(const void *, size_t)) {
  const char *candidate;
  for (size_t i = 0; (candidate = known(NULL, i)) != NULL; i++)
    if (strcmp(candidate, name) == 0) return true;
  return false;
}

static int refuse_name(const char *option, const char *name, const char *kind, const char *topic,
                       const char *(*known)(const void *, size_t)) {
  const char *meant = nearest_name(name, known, NULL);
  if (meant != NULL)
    return fail(EXIT_CODE_USAGE, "--%s: '%s' is no %s: did you mean %s?", option, name, kind, meant);
  return fail(EXIT_CODE_USAGE, "--%s: '%s' is no %s: see 'halflight help %s'", option, name, kind, topic);
}

static int load_function(cli_host *host, const char *name, const hl_volume *volume,
                         hl_transfer_function *function) {
  hl_error error = {0};
  hl_status status;
  if (is_known(name, preset_name))
    status = hl_transfer_function_preset(host->context, name, volume, function, &error);
  else if (strpbrk(name, "./") != NULL || access(name, F_OK) == 0)
    status = hl_transfer_function_load(host->context, name, function, &error);
  else
    return refuse_name("tf", name, "preset or file", "presets", preset_name);
  return status == HL_OK ? EXIT_CODE_OK : host_fail(host, PHASE_READ, status, &error);
}

/* The values from where opacity first rises to where it last falls to zero, within the volume's. */
static void visible_range(const hl_volume *volume, const hl_transfer_function *function, double range[2]) {
  hl_volume_info info = {.struct_size = sizeof info};
  range[0] = 0;
  range[1] = 1;
  if (hl_volume_get_info(volume, &info) == HL_OK && info.range[0] < info.range[1])
    memcpy(range, info.range, sizeof info.range);
  const hl_opacity_point *points = function->opacity;
  size_t count = function->opacity_count, first = 0, last = count;
  while (first < count && points[first].opacity <= 0) first++;
  while (last > first && points[last - 1].opacity <= 0) last--;
  if (first == last) return; /* nothing is visible */
  double low = first > 0 ? points[first - 1].value : range[0];
  double high = last < count ? points[last].value : range[1];
  if (low > range[0] && low < range[1]) range[0] = low;
  if (high > range[0] && high < range[1]) range[1] = high;
}

int render_transfer_function(cli_host *host, const cli_value *values, const hl_scene_volume *volume,
                             hl_transfer_function *function) {
  memset(function, 0, sizeof *function);
  if (values[RENDER_TF].given) {
    int exit_code = load_function(host, values[RENDER_TF].text, volume->volume, function);
    if (exit_code != EXIT_CODE_OK) return exit_code;
  }
  if (!values[RENDER_COLORMAP].given) return EXIT_CODE_OK;
  const char *name = values[RENDER_COLORMAP].text;
  if (!is_known(name, colormap_name))
    return refuse_name("colormap", name, "colormap", "colormaps", colormap_name);
  double range[2];
  visible_range(volume->volume, function->opacity != NULL ? function : &volume->transfer_function, range);
  hl_error error = {0};
  hl_status status = hl_transfer_function_colormap(host->context, name, range[0], range[1], function, &error);
  return status == HL_OK ? EXIT_CODE_OK : host_fail(host, PHASE_CHANGE, status, &error);
}
