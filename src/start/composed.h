/* start/composed.h - a scene that a page has sent, with the choices that it asks for by name. */
#ifndef HL_START_COMPOSED_H
#define HL_START_COMPOSED_H

#include <halflight/compose.h>

/* What a page has chosen by name for its scene. A null text: no choice. */
typedef struct composed_choices {
  const char *look; /* as the option "look" of hl_scene_compose() */
  const char *rig;  /* as the option "light-rig" */
} composed_choices;

/* Replaces the scene by the scene with the choices. context: a context that opens no file. After an error
 * *scene is unchanged. */
hl_status compose_choices(hl_context *context, const composed_choices *choices, hl_scene **scene,
                          hl_error *error);

#endif
