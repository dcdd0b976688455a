/* isosurface/caps.h - makes the caps of an isosurface: faces that close the surface at the volume's box and
 * at cuts. */
#ifndef HL_ISOSURFACE_CAPS_H
#define HL_ISOSURFACE_CAPS_H

#include "isosurface/triangles.h"

/* Adds caps to an isosurface whose triangles have been clipped and cut already. Wherever a face of the box or
 * of a cut runs through the inside of the surface, it gets a cap. A face of the box gets no cap if another
 * volume continues the matter behind it; grid->face_low or face_high puts such a face far outside. */
hl_status hl_iso_cap(hl_pool *pool, const lattice *lattice, iso_triangles *made, hl_error *error);

/* The faces of the box that get caps, as bits. Bit 2 a stands for the lower face of axis a, and bit 2 a + 1
 * for the upper face of axis a. */
uint8_t hl_iso_capped_faces(const grid *grid);

/* The result of hl_iso_capped_faces() if all faces of the box get caps. The surface and its caps then enclose
 * the inside completely. */
enum { ISO_ALL_CAPPED = 63 };

#endif
