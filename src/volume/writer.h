/* volume/writer.h - the formats that volumes are written in: each is a header, then voxels, then at most a
 * few bytes. */
#ifndef HL_VOLUME_WRITER_H
#define HL_VOLUME_WRITER_H

#include "volume/volume.h"

enum { HL_WRITER_HEADER_BYTES = 4096, HL_WRITER_SIZE_CHARACTERS = 20 };

typedef enum hl_packing {
  HL_PACKING_NONE,
  HL_PACKING_GZIP_ALL,    /* the whole file */
  HL_PACKING_GZIP_VOXELS, /* the voxels after the header */
  HL_PACKING_ZLIB_VOXELS
} hl_packing;

/* The bytes before and after the voxels. */
typedef struct hl_written_header {
  unsigned char bytes[HL_WRITER_HEADER_BYTES];
  size_t length;
  const char *end;  /* text after the voxels; null: none */
  const char *unit; /* given: of the grid's lengths, one of the writer's; null: unknown */
  size_t
      size_at; /* where the voxels' packed bytes are to be stated, in HL_WRITER_SIZE_CHARACTERS; 0: nowhere */
} hl_written_header;

typedef struct hl_writer {
  const char *ending; /* of the file's name */
  hl_packing packing;
  unsigned types; /* bit 1 << hl_voxel_type: voxels of this type can be written */
  /* Where the grid cannot be told, fails and names the file. grid: dimensions, type, origin, axes, space. */
  hl_status (*make_header)(const char *path, const hl_volume_description *grid, hl_written_header *header,
                           hl_error *error);
  const char *loses; /* parts of the placement that the format has no words for: "the space"; null: none */
  const char *units; /* of lengths that the format can tell, between '|': lengths in another one are written
                        in the first; null: it tells none, and lengths stay as they are */
} hl_writer;

/* The unit in which a writer writes lengths of this unit, and the factor that they are multiplied by; null
 * and 1: they stay as they are, as the volume or the format knows no unit. */
const char *hl_written_unit(const hl_writer *writer, const char *unit, double *factor);

/* The writer for a file's name; null if there is none. */
const hl_writer *hl_writer_for(const char *path);

#endif
