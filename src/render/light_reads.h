/* render/light_reads.h - which tiles of a light's shadow buffer a part of a picture needs, and for how long.
 */
#ifndef HL_RENDER_LIGHT_READS_H
#define HL_RENDER_LIGHT_READS_H

#include "render/sweep.h"

/* Finds each light's needed_until, where the picture is shared and the light's method allows it. After the
 * sweep's views, lights and surfaces have begun. What is left out is never read: pixels do not change. */
hl_status hl_light_reads_find(sweep *sweep, hl_error *error);

/* The bytes that it allocates for a light whose shadows are planned. */
uint64_t hl_light_reads_bytes(const sweep *sweep, const light_shadow *shadow);

#endif
