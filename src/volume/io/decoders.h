/* volume/io/decoders.h - makes streams that decode the bytes of the stream below them.
 *
 * A push function replaces *stream by a decoder, which reads from the old stream and owns it. The caller must
 * close *stream afterwards, even if the push has failed. */
#ifndef HL_VOLUME_DECODERS_H
#define HL_VOLUME_DECODERS_H

#include "volume/io/stream.h"

hl_status hl_stream_push_inflate(hl_stream **stream, hl_error *error); /* decodes gzip members or zlib data */
hl_status hl_stream_push_bzip2(hl_stream **stream, hl_error *error);
hl_status hl_stream_push_xz(hl_stream **stream, hl_error *error);

/* Pushes a decoder that unpacks the whole file, if the bytes that come next are the mark of gzip, bzip2 or
 * xz. */
hl_status hl_stream_unpack(hl_stream **stream, hl_error *error);

/* The packings of VTK's blocks. */
typedef enum hl_vtk_packing { HL_VTK_PLAIN, HL_VTK_ZLIB, HL_VTK_LZ4, HL_VTK_XZ } hl_vtk_packing;

/* Pushes a decoder of VTK's compressed blocks. Before the blocks stands a header of integers with
 * header_bytes bytes each (4 or 8). Fails unless the blocks together unpack to `promised` bytes. */
hl_status hl_stream_push_vtk_blocks(hl_stream **stream, hl_vtk_packing packing, size_t header_bytes,
                                    bool big_endian, uint64_t promised, hl_error *error);

/* hl_stream_push_base64() and hl_stream_push_hex() push a decoder of bytes that are written as text. The text
 * ends at the first character that is neither a digit of the coding nor white space. */
hl_status hl_stream_push_base64(hl_stream **stream, hl_error *error);
hl_status hl_stream_push_hex(hl_stream **stream, hl_error *error);

#endif
