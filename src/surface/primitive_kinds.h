/* surface/primitive_kinds.h - gives the list of the kinds of primitives. The numbers of primitives follow the
 * order of this list.
 *
 * A kind "sphere" has the table hl_primitive_sphere (primitive.h) in sphere.c, and the table hl_raster_sphere
 * (primitive_raster.h) in sphere_raster.c. The kinds that have corners come first. */
#ifndef HL_SURFACE_PRIMITIVE_KINDS_H
#define HL_SURFACE_PRIMITIVE_KINDS_H

#include <stdint.h>

/* The build reads the names of the kinds in this list. */
/* clang-format off */
#define HL_PRIMITIVES     \
  HL_PRIMITIVE(triangle)  \
  HL_PRIMITIVE(sphere)
/* clang-format on */

#define HL_PRIMITIVE(name) PRIMITIVE_##name,
enum primitive_number { HL_PRIMITIVES PRIMITIVE_KINDS };
#undef HL_PRIMITIVE

/* The primitives of one kind in a mesh, as a range of numbers. */
typedef struct primitive_range {
  uint32_t first, count;
} primitive_range;

#endif
