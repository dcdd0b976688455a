/* volume/formats/nrrd_header.h - reads the header of an NRRD file. */
#ifndef HL_VOLUME_NRRD_HEADER_H
#define HL_VOLUME_NRRD_HEADER_H

#include "volume/io/file_list.h"
#include "volume/io/stream.h"
#include "volume/volume.h"

enum { NRRD_MOST_AXES = 16, NRRD_KIND_BYTES = 32, NRRD_NAME_BYTES = 1024 };

typedef enum nrrd_encoding { NRRD_RAW, NRRD_GZIP, NRRD_BZIP2, NRRD_TEXT, NRRD_HEX } nrrd_encoding;

typedef struct nrrd_axis {
  size_t size;
  double spacing, minimum, maximum; /* NaN if not stated */
  bool is_node;                     /* whether samples lie at cell corners; otherwise they lie at cell
                                     * centres, as Teem assumes */
  bool has_direction;
  double direction[3];
  char kind[NRRD_KIND_BYTES];
} nrrd_axis;

typedef struct nrrd_header {
  const hl_stream *stream; /* for error lines */
  int line;                /* number of the current line, from 1 */
  int dimension;           /* 0 if not yet stated */
  nrrd_axis axis[NRRD_MOST_AXES];
  hl_voxel_type type; /* 0 if not yet stated */
  nrrd_encoding encoding;
  bool has_encoding, has_endian, big_endian, has_sizes;
  struct {
    hl_space kind;
    double origin[3];
    bool has_origin, has_directions;
    bool has_units;   /* whether the field "space units" was read, which has priority over "units" */
    const char *unit; /* unit of the axes, static; null if the unit is absent, unknown, or not the same for
                       * all axes */
  } space;
  /* The file names and positions at which the voxels are found. */
  struct {
    char file[NRRD_NAME_BYTES]; /* "" if the voxels are attached, or in several files */
    hl_file_list files;         /* owned; the list of several data files */
    bool is_list;               /* whether the header ends with a list of names of files */
    size_t line_skip, byte_skip;
    bool skip_to_last; /* whether "byte skip" is -1, which means that the voxels are the last bytes of the
                        * file */
  } data;
  hl_segment *segments; /* owned; [segment_count]; the segments of a segmentation that 3D Slicer has
                         * written */
  size_t segment_count;
} nrrd_header;

/* Reads the header from a stream's beginning, and stops at the first voxel if voxels follow the header. The
 * header's lists must be empty and have their context; the caller owns the lists, also on failure. */
hl_status hl_nrrd_read_header(hl_stream *stream, nrrd_header *header, hl_error *error);

#endif
