/* compose/values.c - draws a bare label map by its values, instead of by its labels, if options ask for its
 * values. */
#include <string.h>

#include "compose/composer.h"
#include "compose/looks.h"
#include "core/memory.h"
#include "guess/looks.h"
#include "scene/function/transfer_function.h"

/* Returns whether options concern the look of values, or ask for a mask, which only volumes of values can
 * have. */
static bool asks_for_values(const hl_composer *composer, const hl_scene_volume *volume, size_t index) {
  static const hl_ask named[] = {HL_ASK_TF, HL_ASK_COLORMAP, HL_ASK_RANGE, HL_ASK_THRESHOLD, HL_ASK_ISO};
  const hl_asked *asked = composer->asked;
  if ((composer->flags & HL_COMPOSE_VALUES) != 0) return true;
  for (size_t n = 0; n < sizeof named / sizeof *named; n++)
    if (hl_text_for(composer, named[n], volume, index) != NULL) return true;
  return asked[HL_ASK_MASK].given || (asked[HL_ASK_LOOK].given && asked[HL_ASK_LOOK].choice == HL_LOOK_MIP);
}

/* Turns the label maps whose values options ask for into volumes of values: removes the labels, and gives
 * each volume the transfer function and material for its values. The scene then has the kernel that suits the
 * first volume's values. functions: [description->volume_count], zeroed; the caller owns their points, also
 * after a failure. */
static hl_status take_labels_off(const hl_composer *composer, hl_scene_volume *volumes,
                                 hl_transfer_function *functions, hl_scene_description *description) {
  for (size_t v = 0; v < description->volume_count; v++) {
    hl_scene_volume *volume = &volumes[v];
    if (volume->label_count == 0 || !asks_for_values(composer, volume, v)) continue;
    hl_data_analysis analysis;
    hl_status status = hl_data_analyse(volume->volume, &analysis, composer->error);
    if (status != HL_OK) return status;
    const hl_look *look = hl_look_for(volume->volume, volume->file, &analysis);
    status = hl_look_write(look, NULL, composer->context, volume->volume, &analysis, &functions[v],
                           composer->error);
    if (status != HL_OK) return status;
    volume->transfer_function = functions[v];
    volume->labels = NULL;
    volume->label_count = 0;
    hl_look_material(look, volume);
    if (v == 0) description->render.kernel = look->kernel;
  }
  return HL_OK;
}

static bool has_any(const hl_composer *composer, const hl_scene_description *description) {
  for (size_t v = 0; v < description->volume_count; v++)
    if (description->volumes[v].label_count > 0 && asks_for_values(composer, &description->volumes[v], v))
      return true;
  return false;
}

hl_status hl_compose_values(const hl_composer *composer, const hl_scene_description *description,
                            hl_scene **scene) {
  *scene = NULL;
  if (!composer->bare || !has_any(composer, description)) return HL_OK;
  hl_context *context = composer->context;
  hl_scene_description changed = *description;
  size_t count = description->volume_count;
  hl_scene_volume *volumes = hl_allocate(context, count, sizeof *volumes);
  hl_transfer_function *functions = hl_allocate_zeroed(context, count, sizeof *functions);
  hl_status status = HL_OK;
  if (volumes == NULL || functions == NULL) {
    status = hl_fail_memory(composer->error, count * sizeof *volumes, "the scene's volumes");
  } else {
    memcpy(volumes, description->volumes, count * sizeof *volumes);
    changed.volumes = volumes;
    status = take_labels_off(composer, volumes, functions, &changed);
  }
  if (status == HL_OK) status = hl_scene_create(context, &changed, scene, composer->error);
  for (size_t v = 0; functions != NULL && v < count; v++)
    hl_transfer_function_release(context, &functions[v]);
  hl_release(context, functions);
  hl_release(context, volumes);
  return status;
}
