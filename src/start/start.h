/* start/start.h - writes the first message to the viewer's page as JSON. The message has the scene, the
 * ranges and histograms of its volumes, and all presets and colormaps. The viewer's server and the page
 * without a server (src/web) send the same text. */
#ifndef HL_START_START_H
#define HL_START_START_H

#include <stdbool.h>
#include <stdio.h>

#include <halflight/halflight.h>

/* The facts about an open scene that a page gets in addition to the scene. */
typedef struct start_about {
  const char *title;
  long long number; /* the number by which the page names the open scene */
  bool folder;      /* whether the page may list and open other files */
  int refined;      /* number of times that volumes were replaced by their finer resolutions */
  bool refining;    /* whether finer resolutions will still be read */
  const char *unit; /* the unit of lengths with which the page begins, where the scene's files tell none; null
                     * if there is no such unit */
} start_about;

/* Writes start.json of an open scene. The caller frees the text by free(). Returns null if memory is
 * short. */
char *describe_start(hl_context *context, const hl_scene *scene, const start_about *about);

/* Writes a text in quotes. */
void put_json_text(FILE *out, const char *text);

#endif
