/* render/prepare.h - volumes made ready for sheets, and kept while they stay the same. */
#ifndef HL_RENDER_PREPARE_H
#define HL_RENDER_PREPARE_H

#include "render/sweep.h"

/* Brings prepared[0 .. count) up to date with the scene's volumes; reuses what has not changed. scene: in
 * frame space (framed_scene.h). */
hl_status hl_prepare_volumes(hl_context *context, hl_pool *pool, const hot_functions *hot,
                             const hl_scene_description *scene, prepared_volume *prepared, hl_error *error);
void hl_prepared_release(hl_context *context, prepared_volume *prepared);

#endif
