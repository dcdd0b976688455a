/* compose/volumes.h - what the options change of a scene's volumes, and the arrays that the changed volumes
 * need.
 */
#ifndef HL_COMPOSE_VOLUMES_H
#define HL_COMPOSE_VOLUMES_H

#include "compose/composer.h"

/* All arrays are owned; null where nothing asks for them. */
typedef struct hl_changed_volumes {
  hl_scene_volume *volumes;        /* [count] */
  hl_transfer_function *functions; /* with their points; [count] */
  hl_isosurface *surfaces;         /* [count][values of "iso"] */
  hl_cut *cuts; /* of the one volume, or of a scene with several, with those of the options */
  size_t count;
  bool seen; /* what is seen of the volumes has changed */
} hl_changed_volumes;

/* Changes the description's volumes and cuts, which borrow the arrays. Release them even after a failure. */
hl_status hl_compose_volumes(const hl_composer *composer, hl_scene_description *description,
                             hl_changed_volumes *changed);
void hl_changed_volumes_release(hl_context *context, hl_changed_volumes *changed);

#endif
