/* server/queries.c - see queries.h. */
#define _GNU_SOURCE
#include "queries.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <microhttpd.h>

const char *query_text(struct MHD_Connection *connection, const char *name) {
  return MHD_lookup_connection_value(connection, MHD_GET_ARGUMENT_KIND, name);
}

long long query_number(struct MHD_Connection *connection, const char *name, long long low, long long high,
                       long long standard) {
  const char *text = query_text(connection, name);
  if (text == NULL) return standard;
  size_t digits = strspn(text, "0123456789");
  if (digits < 1 || digits > 18 || text[digits] != '\0') return -1;
  long long number = atoll(text);
  return number >= low && number <= high ? number : -1;
}

bool is_page_name(const char *name) {
  static const char allowed[] = "abcdefghijklmnopqrstuvwxyz0123456789-";
  size_t length = name != NULL ? strspn(name, allowed) : 0;
  return length >= 1 && length <= PAGE_NAME_LENGTH && name[length] == '\0';
}

bool is_picture_format(const char *format) {
  return format != NULL && (strcmp(format, "jpeg") == 0 || strcmp(format, "png") == 0 ||
                            strcmp(format, "exr") == 0 || strcmp(format, "npy") == 0);
}

bool is_film_format(const char *format) {
  return format != NULL && (strcmp(format, "mp4") == 0 || strcmp(format, "webm") == 0 ||
                            strcmp(format, "gif") == 0 || strcmp(format, "zip") == 0);
}

/* The index of the query's text in a list that ends with null; `standard` if the text is absent, -1 if the
 * list does not hold it. */
static int query_choice(struct MHD_Connection *connection, const char *name, const char *const *choices,
                        int standard) {
  const char *text = query_text(connection, name);
  if (text == NULL) return standard;
  for (int c = 0; choices[c] != NULL; c++)
    if (strcmp(text, choices[c]) == 0) return c;
  return -1;
}

frame_request query_frame(struct MHD_Connection *connection, const char *text, size_t length) {
  static const char *const axes[] = {"none", "arrows", "letters", NULL}; /* the names of the axes, in the
                                                                          * order of hl_axes */
  return (frame_request){.page = query_text(connection, "page"),
                         .number = (unsigned long long)query_number(connection, "number", 1, MOST_NUMBER, 0),
                         .opened = query_number(connection, "opened", 0, MOST_NUMBER, 0),
                         .format = query_text(connection, "format"),
                         .quality = (int)query_number(connection, "quality", LEAST_QUALITY, MOST_QUALITY, 85),
                         .depth = (int)query_number(connection, "depth", 8, 16, 8),
                         .metadata = (int)query_number(connection, "metadata", 0, 1, 1),
                         .scale_bar = (int)query_number(connection, "scale_bar", 0, 1, 0),
                         .legend = (int)query_number(connection, "legend", 0, 1, 0),
                         .marks = (int)query_number(connection, "marks", 0, 1, 0),
                         .axes = query_choice(connection, "axes", axes, 0),
                         .unit = query_text(connection, "unit"),
                         .moving = (int)query_number(connection, "moving", 0, 1, 0),
                         .coarse = (int)query_number(connection, "coarse", 0, 1, 0),
                         .seen = (int)query_number(connection, "seen", 0, 1, 0),
                         .base = query_number(connection, "base", 1, MOST_NUMBER, 0),
                         .text = text,
                         .length = length};
}

bool names_page(const frame_request *wanted) {
  return is_page_name(wanted->page) && wanted->number > 0 && wanted->number <= MOST_NUMBER;
}

bool names_overlay(const frame_request *wanted) {
  return wanted->scale_bar >= 0 && wanted->legend >= 0 && wanted->marks >= 0 && wanted->axes >= 0;
}

bool overlay_fits(const frame_request *wanted) {
  bool plain = wanted->scale_bar == 0 && wanted->legend == 0 && wanted->marks == 0 && wanted->axes == 0;
  return plain || (names_overlay(wanted) && strcmp(wanted->format, "png") == 0 && wanted->depth == 8);
}

bool query_slice(struct MHD_Connection *connection, slice_request *wanted) {
  static const char *const blends[] = {"maximum", "minimum", "mean", NULL};
  static const char *const sources[] = {"voxels", "mask", "picture", NULL}; /* by slice_source */
  static const char *const ways[] = {"nearest", "linear", NULL};
  hl_reslice_options *plane = &wanted->plane;
  hl_reslice_options_defaults(plane);
  wanted->opened = query_number(connection, "opened", 0, MOST_NUMBER, 0);
  wanted->volume = query_number(connection, "volume", 0, MOST_NUMBER, 0);
  wanted->refined = query_number(connection, "refined", 0, MOST_NUMBER, -1);
  long long sides[] = {query_number(connection, "width", 1, MOST_SLICE_SIDE, -1),
                       query_number(connection, "height", 1, MOST_SLICE_SIDE, -1),
                       query_number(connection, "depth", 1, MOST_SLICE_SIDE, 1)};
  int blend = query_choice(connection, "blend", blends, 0),
      source = query_choice(connection, "of", sources, 0);
  int way = query_choice(connection, "between", ways, 0);
  bool good = wanted->opened >= 0 && wanted->volume >= 0 && sides[0] > 0 && sides[1] > 0 && sides[2] > 0 &&
              blend >= 0 && source >= 0 && way >= 0 && sides[0] * sides[1] <= MOST_SLICE_SAMPLES &&
              sides[0] * sides[1] * sides[2] <= MOST_LAYERED_SAMPLES &&
              read_triple(query_text(connection, "origin"), plane->origin) &&
              read_triple(query_text(connection, "across"), plane->across) &&
              read_triple(query_text(connection, "down"), plane->down) &&
              read_triple(query_text(connection, "through"), plane->through);
  if (!good) return false;
  plane->width = (size_t)sides[0];
  plane->height = (size_t)sides[1];
  plane->depth = (size_t)sides[2];
  plane->blend = (hl_blend)(HL_BLEND_MAXIMUM + blend);
  plane->interpolate = way;
  wanted->source = (slice_source)source;
  return true;
}

/* Returns whether the query has more keys than a film may have. */
static bool has_too_many_keys(struct MHD_Connection *connection) {
  char name[16];
  snprintf(name, sizeof name, "key%d", MOST_FILM_KEYS);
  return query_text(connection, name) != NULL;
}

film_request query_film(struct MHD_Connection *connection, const char *format) {
  film_request film = {.format = format};
  for (char name[8]; film.key_count < MOST_FILM_KEYS; film.key_count++) {
    snprintf(name, sizeof name, "key%zu", film.key_count);
    if ((film.keys[film.key_count] = query_text(connection, name)) == NULL) break;
  }
  film.turntable = (int)query_number(connection, "turntable", 0, MOST_FILM_FRAMES, 0);
  film.frames = has_too_many_keys(connection)
                    ? -1
                    : (int)query_number(connection, "frames", 0, MOST_FILM_FRAMES, 0);
  film.frames_per_second = (double)query_number(connection, "fps", 1, 240, 30);
  return film;
}
