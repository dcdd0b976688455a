/* surface/fragment_order.h - the fragments of a tile sorted, and what each takes of the light that reaches
 * it.
 */
#ifndef HL_SURFACE_FRAGMENT_ORDER_H
#define HL_SURFACE_FRAGMENT_ORDER_H

#include <stdbool.h>
#include <stddef.h>

#include "surface/fragment.h"
#include "view/view.h"

/* Which of two fragments comes first: below 0 for a. */
typedef int fragment_order(const fragment *a, const fragment *b);

fragment_order hl_by_pixel_rising, hl_by_pixel_falling, hl_by_slab;

/* Sorts by merging, which takes no other memory than `spare`, as large as the list. */
void hl_sort_fragments(fragment *list, fragment *spare, size_t count, fragment_order *order);

/* Finds the opacities of fragments, which are sorted by pixels, and keeps those that take anything; returns
 * how many. least: [mesh_count]; the least fraction of their opacity that meshes take of any colour of light.
 * slabs: of a light's view whose buffer is also used for rays of other directions. */
size_t hl_resolve_fragments(fragment *list, size_t count, const float *least, bool slabs);

#endif
