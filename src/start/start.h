/* start/start.h - the first message to the viewer's page, as JSON: the scene, the ranges and histograms of
 * its volumes, and all presets and colormaps. The viewer's server and the page without a server (src/web)
 * send the same text. */
#ifndef HL_START_START_H
#define HL_START_START_H

#include <stdbool.h>
#include <stdio.h>

#include <halflight/halflight.h>

/* What a page is told of an open scene besides the scene. */
typedef struct start_about {
  const char *title;
  long long number; /* the number by which the page names the open scene */
  bool folder;      /* whether the page may list and open other files */
  int refined;      /* how often volumes were replaced by finer resolutions of themselves */
  bool refining;    /* whether finer ones are still to be read */
} start_about;

/* Writes start.json of an open scene. The text is the caller's, from malloc; null: out of memory. */
char *describe_start(hl_context *context, const hl_scene *scene, const start_about *about);

/* Writes a text in quotes. */
void put_json_text(FILE *out, const char *text);

#endif
