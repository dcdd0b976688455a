/* volume/legacy_arrays.h - the part of legacy .vtk files that all of their data sets share: the opening lines
 * and the arrays of POINT_DATA and CELL_DATA. */
#ifndef HL_VOLUME_LEGACY_ARRAYS_H
#define HL_VOLUME_LEGACY_ARRAYS_H

#include "volume/stream.h"
#include "volume/volume.h"

enum { HL_LEGACY_WORD_BYTES = 256 };

typedef struct hl_legacy_array {
  const char *kind, *name; /* kind: the keyword: SCALARS, COLOR_SCALARS, NORMALS, ... or FIELD */
  hl_voxel_type type;
  size_t components, tuples;
  bool of_points;   /* under POINT_DATA, not CELL_DATA */
  bool of_neither;  /* before both: an array of the file itself */
  bool is_fraction; /* as text, 0 to 1 stand for 0 to 255 */
} hl_legacy_array;

typedef struct hl_legacy_vtk hl_legacy_vtk;

/* A file that is being read. */
struct hl_legacy_vtk {
  hl_stream *stream;               /* borrowed */
  int line;                        /* the last one that was read; binary values are not counted */
  bool text;                       /* ASCII; else BINARY, big-endian */
  bool in_point_data, has_section; /* has_section: POINT_DATA or CELL_DATA came */
  size_t tuples;                   /* values per array of the POINT_DATA or CELL_DATA section */
  bool found;                      /* reading stops: the stream is at the values that were looked for */
  /* The values of an array come next: reads them, skips them by hl_legacy_vtk_skip(), or sets file->found. */
  hl_status (*meet)(hl_legacy_vtk *file, const hl_legacy_array *array, hl_error *error);
  /* Reads any other keyword: of a data set's geometry. */
  hl_status (*keyword)(hl_legacy_vtk *file, const char *keyword, const char *arguments, hl_error *error);
};

bool hl_legacy_vtk_has_content(const unsigned char *bytes, size_t length);

/* Reads the file up to its end, or until file->found. */
hl_status hl_legacy_vtk_read(hl_legacy_vtk *file, hl_error *error);

/* The next line. *ended: there are no more. */
hl_status hl_legacy_vtk_line(hl_legacy_vtk *file, char line[HL_LINE_BYTES], bool *ended, hl_error *error);

/* Fails with `message "text"` and the line's number. */
hl_status hl_legacy_vtk_fail(const hl_legacy_vtk *file, const char *message, const char *text,
                             hl_error *error);

/* Finds a type by its name in the file; fails where it is none of numbers. */
hl_status hl_legacy_vtk_type(const hl_legacy_vtk *file, const char *name, hl_voxel_type *type,
                             hl_error *error);

/* Passes over an array's values. */
hl_status hl_legacy_vtk_skip_array(hl_legacy_vtk *file, const hl_legacy_array *array, hl_error *error);

#endif
