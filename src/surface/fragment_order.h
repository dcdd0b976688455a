/* surface/fragment_order.h - the fragments of a tile sorted, and what each takes of the light that reaches
 * it.
 */
#ifndef HL_SURFACE_FRAGMENT_ORDER_H
#define HL_SURFACE_FRAGMENT_ORDER_H

#include <stdbool.h>
#include <stddef.h>

#include "surface/fragment.h"
#include "view/view.h"

/* Sorts by pixels, and within a pixel by rising or falling heights. spare: as large as the list. */
void hl_sort_by_pixel(fragment *list, fragment *spare, size_t count, bool falling);

/* Sorts by slabs fragments that are sorted by pixels; within a slab by pixels, then by rising heights.
 * places: [slabs + 2], for use here; slabs: the greatest number that a slab may have. */
void hl_sort_by_slab(fragment *list, fragment *spare, size_t count, uint32_t *places, int slabs);

/* Finds the opacities of fragments, which are sorted by pixels, and keeps those that take anything; returns
 * how many. least: [mesh_count]; the least fraction of their opacity that meshes take of any colour of light.
 * slabs: of a light's view whose buffer is also used for rays of other directions. */
size_t hl_resolve_fragments(fragment *list, size_t count, const float *least, bool slabs);

#endif
