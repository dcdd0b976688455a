/* volume/io/payload.h - makes a volume from a header and a stream of voxels. Used by every format. */
#ifndef HL_VOLUME_PAYLOAD_H
#define HL_VOLUME_PAYLOAD_H

#include "volume/io/stream.h"
#include "volume/volume.h"

typedef enum hl_trailing {
  HL_TRAILING_IGNORED, /* something else may follow the voxels */
  HL_TRAILING_WARNS,
  HL_TRAILING_REFUSED
} hl_trailing;

/* Whether three or four components are colours. */
typedef enum hl_payload_colors {
  HL_COLORS_WHERE_ASKED, /* the file does not say whether its components are colours */
  HL_COLORS_MEANT,       /* the file says that its components are colours */
  HL_COLORS_UNREAD       /* the reader cannot collect colours */
} hl_payload_colors;

/* A file's header, as a description of its voxels. */
typedef struct hl_payload {
  hl_volume_description grid; /* only dimensions, type, origin, axis, value_scale and value_offset are set */
  size_t components;          /* number of values of each voxel */
  size_t block;  /* with several components: number of consecutive values of one component in the file; it
                  * divides the number of voxels */
  int component; /* with several components: the index of the component that is read, or an HL_COMPONENT_
                  * value */
  hl_payload_colors colors;
  bool big_endian;
  bool text;             /* whether the voxels are decimal numbers separated by white space or commas, not
                          * binary */
  bool text_is_fraction; /* whether the numbers 0 to 1 of the text stand for the values 0 to 255 of u8 */
  hl_trailing trailing;
  const char *promiser; /* for error lines: what states the size and the type, such as "the header" */
} hl_payload;

void hl_payload_defaults(hl_payload *payload);

/* The size in bytes of all voxels and components in the file, at most UINT64_MAX. The grid must have been
 * checked. */
uint64_t hl_payload_bytes(const hl_payload *payload);

/* The grid of the volume that the payload gives. A magnitude has floats, to which scale and offset of the
 * file have been applied. spacing: the lengths of the steps, in place of the file's; all 0: the file's. */
hl_volume_description hl_payload_grid(const hl_payload *payload, const double spacing[3]);

/* Checks the grid and, before any allocation, whether the stream can hold the voxels. Then reads and converts
 * the voxels and makes the volume. Reports progress and can be cancelled. spacing: replaces the grid's
 * spacing unless 0. */
hl_status hl_payload_read(hl_stream *stream, const hl_payload *payload, const double spacing[3],
                          hl_volume **volume, hl_error *error);

#endif
