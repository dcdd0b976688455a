/* volume/formats/vtk/legacy_arrays.h - reads the part of legacy .vtk files that all of their data sets share:
 * the opening lines and the arrays of POINT_DATA and CELL_DATA. */
#ifndef HL_VOLUME_LEGACY_ARRAYS_H
#define HL_VOLUME_LEGACY_ARRAYS_H

#include "volume/io/stream.h"
#include "volume/volume.h"

enum { HL_LEGACY_WORD_BYTES = 256 };

typedef struct hl_legacy_array {
  const char *kind, *name; /* kind: the keyword that begins the array, such as SCALARS, COLOR_SCALARS, NORMALS
                            * or FIELD */
  hl_voxel_type type;
  size_t components, tuples;
  bool of_points;   /* whether the array belongs to POINT_DATA */
  bool of_neither;  /* whether the array stands before POINT_DATA and CELL_DATA, so that it belongs to the
                     * file itself */
  bool is_fraction; /* whether the values in a text file are fractions from 0 to 1, which stand for 0 to
                     * 255 */
} hl_legacy_array;

typedef struct hl_legacy_vtk hl_legacy_vtk;

/* A file that is being read. */
struct hl_legacy_vtk {
  hl_stream *stream;               /* borrowed */
  int line;                        /* number of the last line that was read; lines within binary values do not
                                    * count */
  bool text;                       /* whether the file is ASCII; otherwise it is BINARY, big-endian */
  bool in_point_data, has_section; /* has_section: whether a line POINT_DATA or CELL_DATA has been read */
  size_t tuples;                   /* number of tuples of each array in the current section, POINT_DATA or
                                    * CELL_DATA */
  bool found;                      /* set by `meet` to end reading; the stream then stands at the values of
                                    * the array */
  /* The reader calls meet() for each array, when the stream stands at the array's values. meet() reads the
   * values, skips the values by hl_legacy_vtk_skip(), or sets file->found. */
  hl_status (*meet)(hl_legacy_vtk *file, const hl_legacy_array *array, hl_error *error);
  /* The reader calls keyword() for all keywords that do not begin arrays, such as keywords of a data set's
   * geometry. */
  hl_status (*keyword)(hl_legacy_vtk *file, const char *keyword, const char *arguments, hl_error *error);
};

bool hl_legacy_vtk_has_content(const unsigned char *bytes, size_t length);

/* Reads the file up to its end, or until file->found. */
hl_status hl_legacy_vtk_read(hl_legacy_vtk *file, hl_error *error);

/* Reads the next line. *ended: set to whether the file has no further line. */
hl_status hl_legacy_vtk_line(hl_legacy_vtk *file, char line[HL_LINE_BYTES], bool *ended, hl_error *error);

/* Fails with `message "text"` and the line's number. */
hl_status hl_legacy_vtk_fail(const hl_legacy_vtk *file, const char *message, const char *text,
                             hl_error *error);

/* Finds a type by its name in the file. Fails if the name is not the name of a type of numbers. */
hl_status hl_legacy_vtk_type(const hl_legacy_vtk *file, const char *name, hl_voxel_type *type,
                             hl_error *error);

/* Skips an array's values. */
hl_status hl_legacy_vtk_skip_array(hl_legacy_vtk *file, const hl_legacy_array *array, hl_error *error);

#endif
