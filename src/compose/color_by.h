/* compose/color_by.h - applies the options "color-by" and "color-by-threshold": give matter the colours of
 * another volume's values. */
#ifndef HL_COMPOSE_COLOR_BY_H
#define HL_COMPOSE_COLOR_BY_H

#include "compose/composer.h"

/* The arrays and volumes that the option made. The scene's description borrows them. */
typedef struct hl_coloring {
  hl_scene_volume *volumes; /* owned; the scene's volumes, followed by the volume whose values give the
                             * colours */
  hl_volume *other;         /* owned */
  char *text;               /* owned; the names of the file and the array */
  char name[64];
  hl_isosurface *surfaces;     /* owned; the isosurfaces of all volumes, in the colours of the other volume */
  hl_transfer_function colors; /* owned; the colours of the other volume's values */
} hl_coloring;

/* Adds the other volume to the scene, and gives the scene's volumes of values the colours of the other
 * volume. Does nothing if the option is not given. The caller releases *made by hl_coloring_release(), also
 * after a failure. */
hl_status hl_compose_color_by(const hl_composer *composer, hl_scene_description *description,
                              hl_coloring *made);
void hl_coloring_release(hl_context *context, hl_coloring *made);

#endif
