/* volume/formats/vtk/legacy_arrays.h - the part of legacy .vtk files that all of their data sets share: the
 * opening lines and the arrays of POINT_DATA and CELL_DATA. */
#ifndef HL_VOLUME_LEGACY_ARRAYS_H
#define HL_VOLUME_LEGACY_ARRAYS_H

#include "volume/io/stream.h"
#include "volume/volume.h"

enum { HL_LEGACY_WORD_BYTES = 256 };

typedef struct hl_legacy_array {
  const char *kind, *name; /* kind: the keyword, such as SCALARS, COLOR_SCALARS or NORMALS, or FIELD */
  hl_voxel_type type;
  size_t components, tuples;
  bool of_points;   /* whether the array stands under POINT_DATA, not CELL_DATA */
  bool of_neither;  /* whether the array stands before POINT_DATA and CELL_DATA: it belongs to the file */
  bool is_fraction; /* whether 0 to 1 in a text stand for 0 to 255 */
} hl_legacy_array;

typedef struct hl_legacy_vtk hl_legacy_vtk;

/* A file that is being read. */
struct hl_legacy_vtk {
  hl_stream *stream;               /* borrowed */
  int line;                        /* number of the line that was read last; binary values do not count */
  bool text;                       /* whether the file is ASCII; otherwise it is BINARY, big-endian */
  bool in_point_data, has_section; /* has_section: POINT_DATA or CELL_DATA has come */
  size_t tuples;                   /* number of values in each array of the POINT_DATA or CELL_DATA section */
  bool found;                      /* set by `meet` to stop reading: the stream is then at the values that
                                    * were looked for */
  /* Called when the values of an array come next. Reads the values, skips them by hl_legacy_vtk_skip(), or
   * sets file->found. */
  hl_status (*meet)(hl_legacy_vtk *file, const hl_legacy_array *array, hl_error *error);
  /* Reads any other keyword, which describes a data set's geometry. */
  hl_status (*keyword)(hl_legacy_vtk *file, const char *keyword, const char *arguments, hl_error *error);
};

bool hl_legacy_vtk_has_content(const unsigned char *bytes, size_t length);

/* Reads the file up to its end, or until file->found. */
hl_status hl_legacy_vtk_read(hl_legacy_vtk *file, hl_error *error);

/* Reads the next line. *ended: whether there are no more lines. */
hl_status hl_legacy_vtk_line(hl_legacy_vtk *file, char line[HL_LINE_BYTES], bool *ended, hl_error *error);

/* Fails with `message "text"` and the line's number. */
hl_status hl_legacy_vtk_fail(const hl_legacy_vtk *file, const char *message, const char *text,
                             hl_error *error);

/* Finds a type by its name in the file. Fails if it is no type of numbers. */
hl_status hl_legacy_vtk_type(const hl_legacy_vtk *file, const char *name, hl_voxel_type *type,
                             hl_error *error);

/* Skips an array's values. */
hl_status hl_legacy_vtk_skip_array(hl_legacy_vtk *file, const hl_legacy_array *array, hl_error *error);

#endif
