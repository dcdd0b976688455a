/* start/composed.c - see composed.h. */
#include "composed.h"

hl_status compose_choices(hl_context *context, const composed_choices *choices, hl_scene **scene,
                          hl_error *error) {
  hl_option options[2];
  size_t count = 0;
  if (choices->look != NULL) options[count++] = (hl_option){"look", choices->look};
  if (choices->rig != NULL) options[count++] = (hl_option){"light-rig", choices->rig};
  if (count == 0) return HL_OK;
  hl_scene *composed = NULL;
  hl_status status = hl_scene_compose(context, hl_scene_describe(*scene), 0, options, count, &composed,
                                      error);
  if (status != HL_OK) return status;
  hl_scene_release(*scene);
  *scene = composed;
  return HL_OK;
}
