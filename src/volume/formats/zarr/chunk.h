/* volume/formats/zarr/chunk.h - reads and unpacks chunks of a Zarr array. */
#ifndef HL_VOLUME_ZARR_CHUNK_H
#define HL_VOLUME_ZARR_CHUNK_H

#include "volume/formats/zarr/array.h"

/* The memory in which one thread reads and unpacks chunks. Before the first use the first three members must
 * be set, and all others must be zero. */
typedef struct hl_zarr_unpacker {
  hl_context *context;
  const char *path; /* for error lines */
  const hl_zarr_array *array;
  unsigned char *packed; /* owned; [capacity] */
  size_t capacity;
  size_t unpacked;         /* number of bytes of an unpacked chunk */
  unsigned char *filtered; /* owned; room for two states of a chunk, before and after a filter is undone; null
                            * if the array has no filters */
  unsigned char *voxels;   /* owned; [array->chunk_bytes], followed by a checksum */
  void *zstd;              /* owned; zstd's own memory */
} hl_zarr_unpacker;

/* The greatest number of bytes that a chunk of an array may have in a file; longer chunks are refused. */
uint64_t hl_zarr_chunk_most(const hl_zarr_array *array);

void hl_zarr_unpacker_release(hl_zarr_unpacker *unpacker);

/* Reads and unpacks the chunk of `length` bytes at `offset` of the source. *voxels: [array->chunk_bytes],
 * valid until the next call. */
hl_status hl_zarr_chunk_read(hl_zarr_unpacker *unpacker, hl_source *source, uint64_t offset, uint64_t length,
                             const unsigned char **voxels, hl_error *error);

/* The CRC32C checksum of RFC 3720, section 12.1. */
uint32_t hl_zarr_crc32c(const unsigned char *bytes, size_t length);
/* Returns whether the last four bytes are the CRC32C of all bytes before them, least significant byte
 * first. */
bool hl_zarr_check_sum(const unsigned char *bytes, size_t length);

#endif
