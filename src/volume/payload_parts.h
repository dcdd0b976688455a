/* volume/payload_parts.h - shared by the readers of one and of several components. */
#ifndef HL_VOLUME_PAYLOAD_PARTS_H
#define HL_VOLUME_PAYLOAD_PARTS_H

#include "volume/payload.h"

/* Voxels of the grid. */
size_t hl_payload_voxels(const hl_payload *payload);

/* Reads count values in stored form; done: values before them, for error lines. stage: [count]. */
hl_status hl_payload_stage(hl_stream *stream, const hl_payload *payload, uint64_t done, size_t count,
                           void *stage, hl_error *error);

/* Progress, and whether to go on. */
hl_status hl_payload_report(const hl_stream *stream, size_t done, size_t count, hl_error *error);

/* Reads all values of a payload of several components; voxels: [voxels of the grid], stored values, or f32 of
 * a magnitude. */
hl_status hl_components_read(hl_stream *stream, const hl_payload *payload, void *voxels, hl_error *error);

#endif
