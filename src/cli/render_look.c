/* cli/render_look.c - the looks that --look names: a table of what each asks of a scene. */
#include "render.h"

enum { LOOK_AUTO, LOOK_MIP };

const cli_choice look_choices[] = {{"auto", LOOK_AUTO}, {"mip", LOOK_MIP}, {NULL, 0}};

typedef struct look {
  const char *preset;   /* the transfer function of every volume; null: chosen from the volume */
  bool keeps_functions; /* those that a scene gives stay; bare volumes have none of their own */
  bool on_black;        /* the background of a bare volume */
  hl_compositing compositing;
} look;

static const look looks[] = {
    [LOOK_AUTO] = {.preset = NULL},
    [LOOK_MIP] = {.preset = "mip",
                  .keeps_functions = true,
                  .on_black = true,
                  .compositing = HL_COMPOSITING_MAXIMUM},
};

static const look *look_of(const cli_value *values) {
  return values[RENDER_LOOK].given ? &looks[values[RENDER_LOOK].choice] : NULL;
}

bool render_look_recolors(const cli_value *values, bool bare) {
  const look *look = look_of(values);
  return look != NULL && (bare || !look->keeps_functions);
}

hl_status render_look_function(cli_host *host, const cli_value *values, const hl_volume *volume,
                               hl_transfer_function *function, hl_error *error) {
  const look *look = look_of(values);
  if (look->preset == NULL) return hl_transfer_function_automatic(host->context, volume, function, error);
  return hl_transfer_function_preset(host->context, look->preset, volume, function, error);
}

void render_change_look(const cli_value *values, bool bare, hl_scene_description *description) {
  const look *look = look_of(values);
  if (look == NULL) return;
  description->render.compositing = look->compositing;
  for (int c = 0; c < 3 && bare && look->on_black; c++) description->background[c] = 0;
}

bool render_is_maximum(const cli_value *values, const hl_scene_description *description) {
  const look *look = look_of(values);
  return (look != NULL ? look->compositing : description->render.compositing) == HL_COMPOSITING_MAXIMUM;
}

/* What light alone changes. */
static const enum render_option of_light[] = {
    RENDER_LIGHT,         RENDER_LIGHT_SIZE,    RENDER_SHADOWS,
    RENDER_SOFT_METHOD,   RENDER_LIGHT_SAMPLES, RENDER_SHADOW_RESOLUTION,
    RENDER_SHADOW_LOOKUP, RENDER_AMBIENT,       RENDER_SHADING};

bool render_warn_of_no_light(const cli_value *values, const hl_scene_description *description) {
  bool maximum = description->render.compositing == HL_COMPOSITING_MAXIMUM;
  bool flat = values[RENDER_SHADING].given && values[RENDER_SHADING].choice == HL_SHADING_FLAT;
  for (size_t n = 0; n < sizeof of_light / sizeof *of_light && (maximum || flat); n++)
    if (values[of_light[n]].given && (maximum || of_light[n] != RENDER_SHADING))
      warn("--%s changes nothing: %s without light", render_options[of_light[n]].name,
           maximum ? "a maximum projection is" : "flat colours are");
  return maximum || flat;
}
