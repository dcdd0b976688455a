/* tests/robust/small_scenes.h - scenes of a few voxels and pixels, which together use every part of the
 * renderer. */
#ifndef HL_TESTS_SMALL_SCENES_H
#define HL_TESTS_SMALL_SCENES_H

#include <halflight/halflight.h>

typedef struct small_scene {
  const char *name, *json;
} small_scene;

extern const small_scene small_scenes[]; /* ends with a null name */
extern const size_t small_scene_count;

/* The number of the first scenes, which name no files. */
enum { SMALL_SCENES_WITHOUT_FILES = 10 };

/* Reads a scene. folder: holds the files of small_files_write(); null: the current folder. */
hl_status small_scene_make(hl_context *context, size_t index, const char *folder, hl_scene **scene,
                           hl_error *error);

/* Writes the files that the last scenes name. */
hl_status small_files_write(hl_context *context, const char *folder, hl_error *error);

/* The number of floats of a scene's picture. */
size_t small_scene_floats(const hl_scene *scene);

#endif
