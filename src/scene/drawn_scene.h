/* scene/drawn_scene.h - converts a scene to the form that frames draw. The form is made when the first frame
 * asks for it.
 *
 * Label maps and masks are drawn by smooth fields, which take long to make for large maps. Many scenes never
 * need the smooth fields, because such scenes are only composed, written or described, or are shown at a
 * coarser resolution. So the first frame of a scene makes the fields, and the scene keeps them. */
#ifndef HL_SCENE_DRAWN_SCENE_H
#define HL_SCENE_DRAWN_SCENE_H

#include <pthread.h>
#include <stdbool.h>

#include <halflight/scene.h>

#include "core/error.h"
#include "scene/label/draw_labels.h"
#include "scene/order.h"
#include "volume/scraps.h"

typedef struct drawn_scene {
  pthread_mutex_t lock; /* held while the other members are made */
  bool made;
  /* the placed description of the scene, in which volumes of occupancy take the place of label maps, and
   * lattices (label/mask.h) take the place of the masks' label maps */
  hl_scene_description description;
  drawn_labels labels; /* owns the volumes of occupancy and the lattices */
  scene_order order;   /* the order in which frames use the lights, volumes and meshes of the
                        * description */
  /* Owned; [volume_count]. For a volume with a transfer function of two numbers, a number that identifies the
   * function's content in the keys of kept results; for other volumes, 0. */
  uint64_t *plane_marks;
  /* owned; [volume_count]: without_scraps holds the volumes without their scraps, and `volumes` holds copies
   * of the scene's volumes that use without_scraps; null if no volume hides scraps */
  hl_volume **without_scraps;
  hl_scene_volume *volumes;
  size_t volume_count; /* the number of elements of without_scraps and `volumes` */
} drawn_scene;

/* Makes an empty drawn scene, which hl_drawn_scene_make() fills. The caller owns it (hl_drawn_scene_destroy).
 * Returns null if memory is short. */
drawn_scene *hl_drawn_scene_create(hl_context *context);
void hl_drawn_scene_destroy(hl_context *context, drawn_scene *drawn); /* `drawn` may be null */

/* Returns whether frames hide scraps of a volume. Frames do not hide scraps if the volume's function or
 * isosurfaces show values on the other side of `faint`, where hidden matter would leave a trace. */
bool hl_hides_scraps(const hl_scene_volume *volume);

/* Finds the scraps of a volume for which hl_hides_scraps() is true, by hl_scraps_hide() with the volume's own
 * settings. */
hl_status hl_hide_scraps(const hl_scene_volume *volume, hl_scraps *scraps, hl_error *error);

/* Makes the form of a scene that frames draw, unless it was made before. given: the description of the scene
 * as the program gave it. placed: the given description, with lights converted to the world and the scene's
 * cuts in its volumes. Any number of threads may call this function: one thread makes the form, and other
 * threads wait. After a failure the next call tries again. */
hl_status hl_drawn_scene_make(hl_context *context, const hl_scene_description *given,
                              const hl_scene_description *placed, drawn_scene *drawn, hl_error *error);

#endif
