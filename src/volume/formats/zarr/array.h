/* volume/formats/zarr/array.h - describes the metadata of a Zarr array, version 2 or 3: shape, chunks, type,
 * codecs.
 *
 * Sources: the Zarr storage specification version 2 (`.zarray`), the Zarr core specification version 3
 * (`zarr.json`) with its codecs `bytes`, `transpose`, `gzip`, `zstd`, `blosc`, `crc32c` and
 * `sharding_indexed`. */
#ifndef HL_VOLUME_ZARR_ARRAY_H
#define HL_VOLUME_ZARR_ARRAY_H

#include "volume/formats/zarr/metadata.h"

enum { HL_ZARR_AXES_MOST = 8, HL_ZARR_NAME_BYTES = 32, HL_ZARR_CHUNK_BYTES_MOST = 0x7fffffff };

typedef enum hl_zarr_compressor {
  HL_ZARR_RAW,
  HL_ZARR_DEFLATE, /* zlib or gzip */
  HL_ZARR_ZSTD,
  HL_ZARR_BLOSC,
  HL_ZARR_LZ4, /* four bytes with the size of the unpacked block, and then a block of LZ4 */
  HL_ZARR_BZIP2,
  HL_ZARR_XZ
} hl_zarr_compressor;

/* The kinds of filters. Filters change the values or the bytes of a chunk before the chunk is packed. */
typedef enum hl_zarr_filter_kind {
  HL_ZARR_SHUFFLE, /* the chunk holds the first bytes of all elements, then the second bytes of all elements,
                    * and so on */
  HL_ZARR_DELTA,   /* the chunk holds the differences of neighbouring values */
  HL_ZARR_OFFSET   /* FixedScaleOffset: the chunk holds the rounded (value - offset) * scale */
} hl_zarr_filter_kind;

typedef struct hl_zarr_filter {
  hl_zarr_filter_kind kind;
  size_t element;         /* bytes of an element, for shuffling */
  hl_voxel_type from, to; /* from: the type of the stored values; to: the type of the values after the filter
                           * is undone */
  double scale, offset;
} hl_zarr_filter;

enum { HL_ZARR_FILTERS_MOST = 4 };

/* The way in which the voxels of a chunk are coded as bytes. */
typedef struct hl_zarr_codecs {
  int order[HL_ZARR_AXES_MOST]; /* the array's axes in the order of a chunk's voxels, the slowest axis
                                 * first */
  bool big_endian;
  hl_zarr_compressor compressor;
  hl_zarr_filter filters[HL_ZARR_FILTERS_MOST]; /* the filters in the order in which they were applied */
  int filter_count;
  int inner_checks,
      outer_checks; /* number of CRC32C sums, of 4 bytes each: after the voxels, and after the packed bytes */
} hl_zarr_codecs;

typedef struct hl_zarr_array {
  char folder[HL_ZARR_PATH_BYTES]; /* folder of the array in the bundle; "" or ending with '/' */
  int version;                     /* 2 or 3 */
  int rank;
  uint64_t shape[HL_ZARR_AXES_MOST], chunk[HL_ZARR_AXES_MOST]; /* [rank]; size of the array and of a chunk in
                                                                * voxels */
  char axis_name[HL_ZARR_AXES_MOST][HL_ZARR_NAME_BYTES];       /* [rank]; names of the axes; "" if absent */
  hl_voxel_type type;
  size_t chunk_bytes;    /* bytes of a chunk's voxels */
  unsigned char fill[8]; /* the value of voxels in missing chunks, native byte order */
  hl_zarr_codecs codecs;
  char separator;        /* separator of the numbers in the names of chunks: '.' or '/' */
  bool separator_untold; /* in version 2: whether the metadata do not state the separator, so that a chunk
                          * that is not found under its name with '.' is searched under its name with '/' */
  bool has_prefix;       /* whether names of chunks begin with "c" */
  struct {
    bool are_used;                    /* whether files are shards, which hold several chunks */
    uint64_t size[HL_ZARR_AXES_MOST]; /* size of a shard in chunks; 1 without shards */
    uint64_t chunks;                  /* number of chunks in a shard */
    bool index_at_start;
    int index_checks;
  } shards;
} hl_zarr_array;

#endif
