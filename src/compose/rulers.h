/* compose/rulers.h - applies the option "ruler", which adds distances between two points to the marks of the
 * scene. */
#ifndef HL_COMPOSE_RULERS_H
#define HL_COMPOSE_RULERS_H

#include "compose/composer.h"

/* The arrays that the option made. The scene's description borrows them. */
typedef struct hl_rulers {
  hl_mark *marks;      /* owned; the scene's marks, followed by the added rulers */
  double (*points)[3]; /* owned; [2 for each ruler]; points of the scene's world */
} hl_rulers;

/* Refuses values that are no ruler. */
hl_status hl_check_rulers(const hl_asked *ruler, hl_error *error);

/* Adds the rulers to the marks of the scene. Does nothing if the option is not given. The caller releases
 * *made by hl_rulers_release(), also after a failure. */
hl_status hl_compose_rulers(const hl_composer *composer, hl_scene_description *description, hl_rulers *made);
void hl_rulers_release(hl_context *context, hl_rulers *made);

#endif
