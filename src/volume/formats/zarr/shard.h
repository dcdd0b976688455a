/* volume/formats/zarr/shard.h - reads the index of a shard, which states the positions of the shard's chunks,
 * and finds the parts of the file that hold the wanted chunks.
 *
 * Source: the Zarr codec `sharding_indexed`. The index has 16 bytes for each chunk: its position in the file
 * and its length, two numbers of 64 bits, least significant byte first. For a missing chunk, position and
 * length are 2^64 - 1. */
#ifndef HL_VOLUME_ZARR_SHARD_H
#define HL_VOLUME_ZARR_SHARD_H

#include "volume/formats/zarr/array.h"

/* The number of bytes of a shard's index, including the checksum. */
size_t hl_zarr_index_bytes(const hl_zarr_array *array);

/* The range of bytes of a shard's file in which the index lies. */
hl_fetch_range hl_zarr_index_range(const hl_zarr_array *array);

/* Finds a chunk by its number along each of the array's axes within the shard. index: [16 * chunks of a
 * shard]. *length is 0 if the chunk is missing. Returns false if the chunk lies outside of the file of `size`
 * bytes. */
bool hl_zarr_index_find(const hl_zarr_array *array, const unsigned char *index, const uint64_t *inner,
                        uint64_t size, uint64_t *offset, uint64_t *length);

enum { HL_ZARR_SPANS_MOST = 512 };

/* Joins the ranges of chunks, in any order, to at most HL_ZARR_SPANS_MOST ranges that contain all given
 * ranges, in rising order. Two ranges are not joined if more bytes lie between them than arrive in the time
 * of a further request. Returns the number of joined ranges. */
size_t hl_zarr_spans_join(hl_fetch_range *ranges, size_t count);

#endif
