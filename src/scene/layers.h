/* scene/layers.h - is what is asked for in layers possible? */
#ifndef HL_SCENE_LAYERS_H
#define HL_SCENE_LAYERS_H

#include <halflight/layers.h>
#include <halflight/scene.h>

#include "core/error.h"

/* layers may be null. */
hl_status hl_layers_check(const hl_layers *layers, const hl_scene_description *scene, hl_error *error);

#endif
