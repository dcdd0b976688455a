/* isosurface/clip.h - cuts the triangles of an isosurface at the faces of the box and of cuts. */
#ifndef HL_ISOSURFACE_CLIP_H
#define HL_ISOSURFACE_CLIP_H

#include "isosurface/triangles.h"

/* Keeps the parts of an isosurface's triangles that lie in a box; index space. */
hl_status hl_iso_clip_box(hl_context *context, iso_triangles *triangles, const double low[3],
                          const double high[3], hl_error *error);

/* Keeps the parts of an isosurface's triangles that cuts leave; index space. */
hl_status hl_iso_cut(hl_context *context, iso_triangles *triangles, const cut_shape *shapes, size_t count,
                     hl_error *error);

#endif
