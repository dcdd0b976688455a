/* cli/render/scene.c - passes the options of `halflight render` that concern a scene to
 * hl_scene_compose(). */
#include <halflight/compose.h>
#include <stdio.h>
#include <string.h>

#include "render.h"

enum { MOST_OPTIONS = RENDER_OPTION_COUNT * MAXIMUM_REPEATS, RANGE_BYTES = 64 };

/* The options that were given, by their names. */
typedef struct option_list {
  hl_option options[MOST_OPTIONS];
  size_t count;
  char range[RANGE_BYTES]; /* the text of the range that was found for --range-of-all */
} option_list;

static bool is_of_scene(const char *name) {
  const char *known;
  for (size_t n = 0; (known = hl_option_name(n)) != NULL; n++)
    if (strcmp(known, name) == 0) return true;
  return false;
}

static void list_options(const cli_value *values, option_list *list) {
  list->count = 0;
  for (int which = 0; which < RENDER_OPTION_COUNT; which++) {
    const cli_value *value = &values[which];
    if (!value->given || !is_of_scene(render_options[which].name)) continue;
    for (int n = 0; n < value->count; n++)
      list->options[list->count++] = (hl_option){render_options[which].name, value->texts[n]};
    if (value->count > 0) continue;
    snprintf(list->range, sizeof list->range, "%.17g,%.17g", value->number[0], value->number[1]);
    list->options[list->count++] = (hl_option){render_options[which].name, list->range};
  }
}

bool render_is_projection(const cli_value *values) {
  return values[RENDER_LOOK].given && strcmp(values[RENDER_LOOK].text, "mip") == 0;
}

bool render_is_label_map(const cli_value *values) {
  return !values[RENDER_LABELS].given && !values[RENDER_MASK].given &&
         (values[RENDER_LABEL_TABLE].given || values[RENDER_SHOW].given);
}

int render_check_scene_options(const cli_value *values) {
  option_list list;
  hl_error error = {0};
  list_options(values, &list);
  hl_status status = hl_options_check(list.options, list.count, &error);
  return status == HL_OK ? EXIT_CODE_OK : fail_with(PHASE_SETUP, status, &error);
}

int render_change_scene(cli_host *host, const cli_value *values, bool bare, unsigned flags,
                        hl_scene **scene) {
  option_list list;
  hl_error error = {0};
  hl_scene *composed = NULL;
  list_options(values, &list);
  if (bare) flags |= HL_COMPOSE_BARE;
  hl_status status = hl_scene_compose(host->context, hl_scene_describe(*scene), flags, list.options,
                                      list.count, &composed, &error);
  if (status != HL_OK)
    return host_fail(host, status == HL_ERROR_ARGUMENT ? PHASE_CHANGE : PHASE_READ, status, &error);
  hl_scene_release(*scene);
  *scene = composed;
  return EXIT_CODE_OK;
}

hl_status render_load_label_map(cli_host *host, const cli_value *values, const char *path,
                                const hl_volume_load_options *reading, hl_scene **scene, hl_error *error) {
  option_list list;
  list_options(values, &list);
  return hl_scene_for_label_map(host->context, path, reading, list.options, list.count, scene, error);
}
