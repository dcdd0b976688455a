/* compose/volumes.h - changes a scene's volumes by options, and makes the arrays that the changed volumes
 * need. */
#ifndef HL_COMPOSE_VOLUMES_H
#define HL_COMPOSE_VOLUMES_H

#include "compose/composer.h"

/* The arrays of changed volumes. The struct owns all arrays. An array is null if no option needs it. */
typedef struct hl_changed_volumes {
  hl_scene_volume *volumes;        /* [count] */
  hl_transfer_function *functions; /* [count]; transfer functions, which own their points */
  hl_isosurface *surfaces;         /* [count][values of "iso"] */
  hl_cut *cuts; /* all cuts, including the options' cuts: first the cuts of a scene of several volumes, then
                 * the cuts of each volume */
  size_t cuts_used;
  size_t count;
  bool seen; /* whether the visible part of the volumes has changed */
} hl_changed_volumes;

/* Changes the description's volumes and cuts. The description then borrows the arrays. Release the arrays
 * even after a failure. */
hl_status hl_compose_volumes(const hl_composer *composer, hl_scene_description *description,
                             hl_changed_volumes *changed);
void hl_changed_volumes_release(hl_context *context, hl_changed_volumes *changed);

#endif
