/* volume/nrrd.h - a NRRD header as it is read, shared by its reader and by the choice of its axes. */
#ifndef HL_VOLUME_NRRD_H
#define HL_VOLUME_NRRD_H

#include "volume/payload.h"

enum { NRRD_MOST_AXES = 16, NRRD_KIND_BYTES = 32, NRRD_NAME_BYTES = 1024 };

typedef enum nrrd_encoding { NRRD_RAW, NRRD_GZIP, NRRD_TEXT, NRRD_HEX } nrrd_encoding;

typedef struct nrrd_axis {
  size_t size;
  double spacing, minimum, maximum; /* NaN: not stated */
  bool is_node;                     /* samples at cell corners; else at cell centres, as Teem assumes */
  bool has_direction;
  double direction[3];
  char kind[NRRD_KIND_BYTES];
} nrrd_axis;

typedef struct nrrd_header {
  const hl_stream *stream; /* for error lines */
  int line;                /* the current one, from 1 */
  int dimension;           /* 0: not yet stated */
  nrrd_axis axis[NRRD_MOST_AXES];
  hl_voxel_type type; /* 0: not yet stated */
  nrrd_encoding encoding;
  bool has_encoding, has_endian, big_endian, has_sizes, has_directions, has_space_origin;
  double space_origin[3];
  hl_space space;
  char data_file[NRRD_NAME_BYTES]; /* "" if attached */
  size_t line_skip, byte_skip;
  bool skip_to_last; /* byte skip -1: the voxels are the last bytes of the file */
} nrrd_header;

/* Fills the payload's grid, components and block. *is_series: components are volumes of a series. */
hl_status hl_nrrd_place(const nrrd_header *header, hl_payload *payload, bool *is_series, hl_error *error);

#endif
