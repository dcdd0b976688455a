/* scene/scene.h - declares struct hl_scene, a checked deep copy of a description. */
#ifndef HL_SCENE_SCENE_H
#define HL_SCENE_SCENE_H

#include <stdatomic.h>

#include <halflight/scene.h>

#include "scene/drawn_scene.h"
#include "scene/function/transfer_function.h"
#include "scene/geometry/camera.h"
#include "scene/geometry/cut.h"
#include "scene/geometry/placement.h"
#include "scene/light/suns.h"
#include "volume/volume.h"

struct hl_scene {
  hl_context *context;
  atomic_int references;
  hl_scene_description description; /* the description as the program gave it; the scene owns its arrays and
                                     * texts */
  /* the description with all lights in the world, and with the scene's cuts in its volumes. The suns of the
   * sky follow the lights, and the sky's image lacks the suns' light. The array of lights is owned */
  hl_scene_description placed;
  sky_suns suns;      /* the suns of the sky; if placed.sky.suns is set, the suns are lights of `placed` */
  placed_cuts cut;    /* the volumes of `placed`, if the scene has cuts of its own */
  drawn_scene *drawn; /* owned; the form of the scene that frames draw; empty until a frame asks for it */
  char *field_errors; /* owned; JSON that says how much the volumes' fields differ from their files
                       * (field_errors.c); null if no difference is known */
  uint64_t sky_mark;  /* a number that identifies the pixels of the sky's image, for the keys of kept
                       * results */
};

/* Makes the form of the scene that frames draw, unless it was made before (hl_drawn_scene_make()). *drawn is
 * owned by the scene. */
hl_status hl_scene_draw(const hl_scene *scene, const drawn_scene **drawn, hl_error *error);

/* Writes how much the volumes' fields differ from their files, as a JSON array with an object for each
 * volume whose difference is known. *text is owned by the caller (hl_release); null if no difference is
 * known. */
hl_status hl_field_errors_write(hl_context *context, const hl_scene_description *description, char **text,
                                hl_error *error);

/* Frees the pixels and file names of a light's texture and emission, which the light must own. */
void hl_light_images_release(hl_context *context, hl_light *light);

/* Copies labels with their names into one block (hl_release). The copy is null if `count` is 0. */
hl_status hl_labels_copy(hl_context *context, const hl_label *labels, size_t count, const hl_label **copy,
                         hl_error *error);

#endif
