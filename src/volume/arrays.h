/* volume/arrays.h - which of a file's arrays and components become the volume, and what else there is.
 *
 * Formats list what they meet, then ask for a choice. What is taken without having been named is told by a
 * warning, once the volume is there.
 */
#ifndef HL_VOLUME_ARRAYS_H
#define HL_VOLUME_ARRAYS_H

#include "volume/payload.h"

enum { HL_ARRAYS_MOST = 256 }; /* that are listed of one file */

/* What the caller of a loader wants, and what its format found. */
typedef struct hl_load_request {
  hl_context *context;
  const char *array;      /* null: choose */
  int component;          /* HL_COMPONENT_DEFAULT, HL_COMPONENT_MAGNITUDE, or an index */
  double spacing[3];      /* world units; all 0: as in the file */
  hl_array_entry *arrays; /* owned; [array_count]; in the file's order */
  size_t array_count;
  size_t chosen; /* the array that is read */
  int chosen_component;
  bool more;                                  /* the file has arrays beyond HL_ARRAYS_MOST */
  char array_told[1000], component_told[400]; /* warnings about what was taken by default; "": none */
} hl_load_request;

/* Adds an array to the list. name: "" if the format has none; type: 0 if its values are not read. */
hl_status hl_arrays_add(hl_load_request *request, const char *name, size_t components, hl_voxel_type type,
                        bool of_cells, hl_error *error);

/* Releases the list. */
void hl_arrays_release(hl_context *context, hl_array_entry *arrays, size_t count);

/* Sets request->chosen: the array of the wanted name; else `active` (an index, or -1); else the first of one
 * component of the points, of the cells; else the first of all. There must be one. */
hl_status hl_arrays_choose(hl_load_request *request, const char *path, int active, hl_error *error);

/* Says which component the payload, whose components and block are known, is read for: the wanted one; else
 * the only one; else the magnitude of vectors of two or three (is_series: of steps of a series the first). */
hl_status hl_component_choose(hl_load_request *request, const char *path, bool is_series, hl_payload *payload,
                              hl_error *error);

/* For formats of one array without a name: lists it and chooses the component. */
hl_status hl_component_only(hl_load_request *request, const char *path, bool is_series, hl_payload *payload,
                            hl_error *error);

#endif
