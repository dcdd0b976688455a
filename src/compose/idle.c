/* compose/idle.c - logs options that were given but change nothing. */
#include "compose/composer.h"
#include "core/context.h"

/* Options that have no effect in a picture without light. */
static const hl_ask of_light[] = {
    HL_ASK_LIGHT,         HL_ASK_LIGHT_RIG,         HL_ASK_LIGHT_SIZE,    HL_ASK_SHADOWS, HL_ASK_SOFT_METHOD,
    HL_ASK_LIGHT_SAMPLES, HL_ASK_SHADOW_RESOLUTION, HL_ASK_SHADOW_LOOKUP, HL_ASK_AMBIENT, HL_ASK_SHADING};

/* If the picture is made without light, warns of options that concern light, and returns true. */
static bool warn_of_no_light(const hl_composer *composer, const hl_scene_description *description) {
  const hl_asked *asked = composer->asked;
  bool maximum = description->render.compositing == HL_COMPOSITING_MAXIMUM;
  bool flat = asked[HL_ASK_SHADING].given && asked[HL_ASK_SHADING].choice == HL_SHADING_FLAT;
  for (size_t n = 0; n < sizeof of_light / sizeof *of_light && (maximum || flat); n++)
    if (asked[of_light[n]].given && (maximum || of_light[n] != HL_ASK_SHADING))
      hl_log(composer->context, HL_LOG_WARNING, "--%s changes nothing: %s without light",
             hl_option_rows[of_light[n]].name, maximum ? "a maximum projection is" : "flat colours are");
  return maximum || flat;
}

void hl_warn_of_idle_options(const hl_composer *composer, const hl_scene_description *description) {
  const hl_asked *asked = composer->asked;
  const hl_render_settings *settings = &description->render;
  if (warn_of_no_light(composer, description)) return;
  bool soft = settings->shadows == HL_SHADOWS_SOFT;
  for (size_t i = 0; i < description->light_count; i++)
    soft |= description->lights[i].shadows == HL_SHADOWS_SOFT;
  if (asked[HL_ASK_LIGHT_SAMPLES].given && (!soft || settings->soft_method != HL_SOFT_SUBLIGHTS))
    hl_log(composer->context, HL_LOG_WARNING,
           "--light-samples changes nothing without --shadows soft and --soft-method sublights");
  if (asked[HL_ASK_SOFT_METHOD].given && !soft)
    hl_log(composer->context, HL_LOG_WARNING, "--soft-method changes nothing without --shadows soft");
  if (asked[HL_ASK_LIGHT_SIZE].given && asked[HL_ASK_LIGHT_SIZE].number[0] > 0 && !soft)
    hl_log(composer->context, HL_LOG_WARNING, "--light-size changes nothing without --shadows soft");
}
