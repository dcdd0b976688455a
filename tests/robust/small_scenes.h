/* tests/robust/small_scenes.h - scenes of a few voxels and pixels that between them take every way through
 * the renderer. */
#ifndef HL_TESTS_SMALL_SCENES_H
#define HL_TESTS_SMALL_SCENES_H

#include <halflight/halflight.h>

typedef struct small_scene {
  const char *name, *json;
} small_scene;

extern const small_scene small_scenes[]; /* ends with a null name */
extern const size_t small_scene_count;

/* Reads a scene; folder holds the file "slide.png" that one of them projects (null: the current one). */
hl_status small_scene_make(hl_context *context, size_t index, const char *folder, hl_scene **scene,
                           hl_error *error);

/* Writes slide.png. */
hl_status small_slide_write(hl_context *context, const char *folder, hl_error *error);

/* Floats of a scene's picture. */
size_t small_scene_floats(const hl_scene *scene);

#endif
