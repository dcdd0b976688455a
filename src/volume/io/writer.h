/* volume/io/writer.h - describes the formats in which volumes are written. A written file has a header,
 * voxels, and at most a few bytes after the voxels. */
#ifndef HL_VOLUME_WRITER_H
#define HL_VOLUME_WRITER_H

#include "volume/volume.h"

enum { HL_WRITER_HEADER_BYTES = 4096, HL_WRITER_SIZE_CHARACTERS = 20 };

typedef enum hl_packing {
  HL_PACKING_NONE,
  HL_PACKING_GZIP_ALL,    /* packs the whole file */
  HL_PACKING_GZIP_VOXELS, /* packs the voxels after the header */
  HL_PACKING_ZLIB_VOXELS
} hl_packing;

/* The bytes before and after the voxels. */
typedef struct hl_written_header {
  unsigned char bytes[HL_WRITER_HEADER_BYTES];
  size_t length;
  const char *end;  /* text after the voxels; null if no text follows the voxels */
  const char *unit; /* set by the caller: the unit of the grid's lengths, one of the writer's `units`; null if
                     * unknown */
  size_t size_at;   /* position in the header at which the length of the packed voxels is to be written, in
                     * HL_WRITER_SIZE_CHARACTERS; 0 if the header does not state it */
} hl_written_header;

typedef struct hl_writer {
  const char *format; /* the name of the format's reader in lists of formats */
  const char *ending; /* end of the file's name */
  hl_packing packing;
  unsigned types; /* bit 1 << hl_voxel_type is set if voxels of this type can be written */
  /* Makes the header. If the format cannot state the grid, fails with an error that names the file. grid:
   * dimensions, type, origin, axes, space. */
  hl_status (*make_header)(const char *path, const hl_volume_description *grid, hl_written_header *header,
                           hl_error *error);
  /* the properties of the grid that the format cannot state: "space"; "origin" (origin, directions and
   * space); "place" (all properties); null if the format states all of them */
  const char *loses;
  const char *units; /* units of length that the format can state, separated by '|'. Lengths in other units
                      * are converted to the first unit. Null if the format states no units; lengths are then
                      * written without conversion */
  /* Makes the n-th piece of bytes that follows the voxels, from 0 on; returns the piece's length, 0 after the
   * last piece. Null if no bytes follow the voxels. */
  size_t (*make_piece)(const hl_volume_description *grid, const hl_written_header *header, size_t n,
                       unsigned char bytes[HL_WRITER_HEADER_BYTES]);
  const char *claims; /* the anatomical space that every file of the format states, such as "RAS", even if the
                       * grid states no space; null if a file of the format need not state a space */
} hl_writer;

/* The unit in which a writer writes lengths that are given in `unit`. *factor: the number by which the
 * lengths are multiplied. If the volume or the format has no unit, the result is null and *factor is 1. */
const char *hl_written_unit(const hl_writer *writer, const char *unit, double *factor);

/* The writer for the ending of a file's name; null if no writer has the ending. */
const hl_writer *hl_writer_for(const char *path);

/* The writer with the number `index`, from 0; null after the last writer. */
const hl_writer *hl_writer_at(size_t index);

#endif
