/* start/composed.h - applies the choices that a page has made by name to the scene that the page has sent. */
#ifndef HL_START_COMPOSED_H
#define HL_START_COMPOSED_H

#include <halflight/compose.h>

/* Choices that a page makes by name for its scene. A text is null if the page has made no choice. */
typedef struct composed_choices {
  const char *look; /* a value of the option "look" of hl_scene_compose() */
  const char *rig;  /* a value of the option "light-rig" */
} composed_choices;

/* Replaces *scene by a copy in which the choices are applied. context: a context that opens no file. After an
 * error *scene is unchanged. */
hl_status compose_choices(hl_context *context, const composed_choices *choices, hl_scene **scene,
                          hl_error *error);

#endif
