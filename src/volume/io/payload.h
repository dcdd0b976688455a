/* volume/io/payload.h - makes a volume from a header and a stream of voxels. The readers of most formats use
 * these functions. */
#ifndef HL_VOLUME_PAYLOAD_H
#define HL_VOLUME_PAYLOAD_H

#include "volume/io/stream.h"
#include "volume/volume.h"

typedef enum hl_trailing {
  HL_TRAILING_IGNORED, /* other data may follow the voxels */
  HL_TRAILING_WARNS,
  HL_TRAILING_REFUSED
} hl_trailing;

/* Whether three or four components of a voxel are a colour. */
typedef enum hl_payload_colors {
  HL_COLORS_WHERE_ASKED, /* the file does not say; the components are colours if the caller asks for
                          * colours */
  HL_COLORS_MEANT,       /* the file says that the values are colours */
  HL_COLORS_UNREAD       /* the reader cannot collect colours */
} hl_payload_colors;

/* The description of a file's voxels that the file's header gives. */
typedef struct hl_payload {
  hl_volume_description grid; /* only dimensions, type, origin, axis, value_scale and value_offset are set */
  size_t components;          /* number of values of each voxel */
  size_t block;  /* with several components: number of consecutive values of the same component in the file; a
                  * divisor of the number of voxels */
  int component; /* with several components: the index of the component to read, or an HL_COMPONENT_ value */
  hl_payload_colors colors;
  bool big_endian;
  bool text;             /* whether the voxels are written as decimal numbers, separated by white space or
                          * commas; otherwise the voxels are binary numbers */
  bool text_is_fraction; /* whether the text's numbers are fractions from 0 to 1, which stand for the values 0
                          * to 255 of u8 */
  hl_trailing trailing;
  const char *promiser; /* for error lines: the name of the part of the file that states the size and the
                         * type, such as "the header" */
} hl_payload;

void hl_payload_defaults(hl_payload *payload);

/* The number of bytes of all components of all voxels in the file; UINT64_MAX on overflow. The caller has
 * checked the grid. */
uint64_t hl_payload_bytes(const hl_payload *payload);

/* The grid of the volume that is made of the payload. The values of a magnitude are floats, to which the
 * file's scale and offset have been applied. spacing: the lengths of the steps, which replace the file's
 * lengths unless all are 0. */
hl_volume_description hl_payload_grid(const hl_payload *payload, const double spacing[3]);

/* Checks the grid and, before any allocation, whether the stream can hold the voxels. If the checks pass,
 * reads and converts the voxels, and makes the volume. hl_payload_read() reports progress and can be
 * cancelled. spacing: as for hl_payload_grid(). */
hl_status hl_payload_read(hl_stream *stream, const hl_payload *payload, const double spacing[3],
                          hl_volume **volume, hl_error *error);

#endif
