/* start/start.h - the first message to the viewer's page, as JSON: the scene, the ranges and histograms of
 * its volumes, and all presets and colormaps. The viewer's server and the page without a server (src/web)
 * send the same text. */
#ifndef HL_START_START_H
#define HL_START_START_H

#include <stdbool.h>
#include <stdio.h>

#include <halflight/halflight.h>

/* Writes start.json of an open scene. number: the number by which the page names the open scene. folder:
 * whether the page may list and open other files. The text is the caller's, from malloc; null: out of
 * memory. */
char *describe_start(hl_context *context, const hl_scene *scene, const char *title, long long number,
                     bool folder);

/* Writes a text in quotes. */
void put_json_text(FILE *out, const char *text);

#endif
