/* page/held.h - collects the content of a page: the scene's text, and the files that the text names. */
#ifndef HL_PAGE_HELD_H
#define HL_PAGE_HELD_H

#include <stdio.h>

#include <halflight/scene.h>

#include "core/error.h"

enum { HELD_NAME_BYTES = 64 };

typedef struct held_file {
  char name[HELD_NAME_BYTES]; /* the file's name in the scene's text */
  char *path;                 /* owned; the file's path on the disk */
} held_file;

typedef struct held_scene {
  hl_context *context;
  char *folder;     /* owned; the folder for files that are written only for the page; null if it has not been
                     * made yet */
  held_file *files; /* owned; [count] */
  size_t count, room;
  hl_scene_volume *volumes; /* owned; the scene's volumes as the scene's text describes them */
  hl_light *lights;         /* owned */
  hl_volume **made;         /* owned; [made_count]; the volumes that were written, and were then read again
                             * from their new files */
  size_t made_count;
  char *text; /* owned (hl_text_release()); the scene's text */
} held_scene;

/* Writes the volumes, cut to their visible part, to a folder of their own, and makes the scene's text. The
 * caller must call held_scene_end() even after a failure. */
hl_status held_scene_make(hl_context *context, const hl_scene *scene, held_scene *held, hl_error *error);
/* Releases the content of the page, and removes the folder with the files that were written for the page. */
void held_scene_end(held_scene *held);

#endif
