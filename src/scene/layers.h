/* scene/layers.h - is what is asked for in layers possible? */
#ifndef HL_SCENE_LAYERS_H
#define HL_SCENE_LAYERS_H

#include <halflight/layers.h>

#include "core/error.h"

/* layers may be null; light_count: the scene's. */
hl_status hl_layers_check(const hl_layers *layers, size_t light_count, hl_error *error);

#endif
