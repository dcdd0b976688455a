/* volume/io/decoders.h - streams that decode the bytes of the stream below them.
 *
 * A push puts a decoder on top of *stream: the decoder owns the old stream, and *stream becomes the decoder.
 * The caller has to close *stream afterwards, whether or not the push succeeded. */
#ifndef HL_VOLUME_DECODERS_H
#define HL_VOLUME_DECODERS_H

#include "volume/io/stream.h"

hl_status hl_stream_push_inflate(hl_stream **stream, hl_error *error); /* gzip members or zlib */
hl_status hl_stream_push_bzip2(hl_stream **stream, hl_error *error);
hl_status hl_stream_push_xz(hl_stream **stream, hl_error *error);

/* Pushes a decoder that unpacks the file, if the mark of gzip, bzip2 or xz comes next. */
hl_status hl_stream_unpack(hl_stream **stream, hl_error *error);

/* How VTK's blocks are packed. */
typedef enum hl_vtk_packing { HL_VTK_PLAIN, HL_VTK_ZLIB, HL_VTK_LZ4, HL_VTK_XZ } hl_vtk_packing;

/* Pushes a decoder of VTK's compressed blocks: a header of integers of header_bytes (4 or 8) each, then the
 * blocks. Fails unless the blocks hold `promised` bytes together. */
hl_status hl_stream_push_vtk_blocks(hl_stream **stream, hl_vtk_packing packing, size_t header_bytes,
                                    bool big_endian, uint64_t promised, hl_error *error);

/* These put a decoder on a stream whose bytes are written as text, in base64 or hexadecimal. The text ends at
 * the first character that is neither a digit of this kind nor white space. */
hl_status hl_stream_push_base64(hl_stream **stream, hl_error *error);
hl_status hl_stream_push_hex(hl_stream **stream, hl_error *error);

#endif
