/* render/surface_point.h - finds the point of a surface that a fragment of the eye's view shows. */
#ifndef HL_RENDER_SURFACE_POINT_H
#define HL_RENDER_SURFACE_POINT_H

#include "render/sweep.h"

/* A point of a surface that will be lit, with the normal and the colour at this point. A ray of the eye meets
 * a fragment at this point. */
typedef struct surface_point {
  vec3 position, normal, towards_eye; /* frame space; the normal is turned towards the eye, and is 0 on the
                                       * back of a one-sided mesh */
  double color[3];                    /* linear RGB */
} surface_point;

/* Finds the point of the eye's ray, through a fragment's pixel, at a height above the first sheet; frame
 * space. */
vec3 hl_surface_place(const sweep *sweep, const tile_slab *slab, const fragment *f, double height);

surface_point hl_surface_point_of(const sweep *sweep, const tile_slab *slab, const fragment *f);

#endif
