/* volume/decoders.h - streams that decode what the stream below them holds.
 *
 * A push puts a decoder on top of *stream, which the decoder takes over; *stream becomes the decoder. A push
 * that fails leaves *stream something that the caller has to close, as one that succeeds does.
 */
#ifndef HL_VOLUME_DECODERS_H
#define HL_VOLUME_DECODERS_H

#include "volume/stream.h"

hl_status hl_stream_push_inflate(hl_stream **stream, hl_error *error);    /* gzip members or zlib */
hl_status hl_stream_inflate_if_gzip(hl_stream **stream, hl_error *error); /* only if gzip's mark comes next */

/* VTK's compressed blocks: a header of integers of header_bytes (4 or 8) each, then zlib blocks. Fails
 * unless they hold promised bytes. */
hl_status hl_stream_push_vtk_blocks(hl_stream **stream, size_t header_bytes, bool big_endian,
                                    uint64_t promised, hl_error *error);

/* Bytes written as text, which ends at the first character that is neither a digit nor white space. */
hl_status hl_stream_push_base64(hl_stream **stream, hl_error *error);
hl_status hl_stream_push_hex(hl_stream **stream, hl_error *error);

#endif
