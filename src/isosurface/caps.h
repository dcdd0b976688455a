/* isosurface/caps.h - the faces that close an isosurface where the volume's box or cuts end it. */
#ifndef HL_ISOSURFACE_CAPS_H
#define HL_ISOSURFACE_CAPS_H

#include "isosurface/triangles.h"

/* Adds caps to an isosurface whose triangles have been clipped and cut already. A cap lies wherever a face of
 * the box or of a cut runs through the inside of the surface. A face of the box behind which another volume
 * goes on gets no cap; grid->face_low or face_high puts such a face far out. */
hl_status hl_iso_cap(hl_pool *pool, const lattice *lattice, iso_triangles *made, hl_error *error);

/* The faces of the box that get caps. Bit 2 a is the lower face of axis a, bit 2 a + 1 the upper one. */
uint8_t hl_iso_capped_faces(const grid *grid);

/* The bits of hl_iso_capped_faces() if all faces of the box get caps. The surface and its caps then enclose
 * the inside completely. */
enum { ISO_ALL_CAPPED = 63 };

#endif
