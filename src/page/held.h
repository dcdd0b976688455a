/* page/held.h - collects the content of a page: the scene's text, and the files that the text names. */
#ifndef HL_PAGE_HELD_H
#define HL_PAGE_HELD_H

#include <stdio.h>

#include <halflight/scene.h>

#include "core/error.h"

enum { HELD_NAME_BYTES = 64 };

typedef struct held_file {
  char name[HELD_NAME_BYTES]; /* in the scene's text */
  char *path;                 /* owned; where it lies now */
} held_file;

typedef struct held_scene {
  hl_context *context;
  char *folder;     /* owned; the folder for files that are written only for the page; null if it has not been
                     * made yet */
  held_file *files; /* owned; [count] */
  size_t count, room;
  hl_scene_volume *volumes; /* owned; as the text has them */
  hl_light *lights;         /* owned */
  hl_volume **made;         /* owned; [made_count]; the volumes that were written, and were then read again
                             * from their new files */
  size_t made_count;
  char *text; /* owned; hl_text_release() */
} held_scene;

/* Writes the volumes, cut to their visible part, to a folder of their own, and makes the text. Call
 * held_scene_end() even after a failure. */
hl_status held_scene_make(hl_context *context, const hl_scene *scene, held_scene *held, hl_error *error);
/* Removes the folder. */
void held_scene_end(held_scene *held);

#endif
