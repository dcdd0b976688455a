/* surface/fragment_work.h - describes the data that the tiles of a view share while their fragments are made,
 * and the data of each thread. */
#ifndef HL_SURFACE_FRAGMENT_WORK_H
#define HL_SURFACE_FRAGMENT_WORK_H

#include "surface/fragment_order.h"
#include "surface/primitive_bins.h"
#include "surface/small_triangles.h"

/* A block of memory for the fragments of many tiles. Blocks form a chain, so that no fragments are copied
 * when memory grows. */
typedef struct fragment_block {
  struct fragment_block *before; /* the block that was filled before this one; owned */
  size_t count, room;
  fragment list[]; /* [room]; only the first `count` fragments are in use */
} fragment_block;

/* The fragments of one tile, sorted by slab, then by pixel, then by height. */
typedef struct tile_list {
  const fragment *list; /* [count]; borrowed from a fragment_block */
  uint32_t count;
  uint32_t reached; /* number of the tile's fragments that lie in the slabs that the sweep has reached */
} tile_list;

/* The input of hl_fragments_create(); borrowed. */
typedef struct fragments_source {
  hl_context *context;
  hl_pool *pool;
  const surface_functions *functions;
  const surfaces *surfaces;
  const view *view;
  const sheet_stack *sheets;
  bool falling;  /* whether the view meets the higher of two sheets first */
  bool of_light; /* if set, the view is a light's, and sees the meshes that cast shadows; other views see the
                  * visible meshes */
  bool unseen;   /* if set, the view is the eye's, and sees only meshes that cast shadows and are not visible.
                  * Then no fragment hides another one, and opacities are fractions of the pixel's light */
  double delay;  /* the delay of fragments, in pixels of the view. A fragment absorbs light only from a
                  * delayed height on: the height of its surface's plane at this distance from the fragment.
                  * So a surface does not darken itself when look-ups interpolate between pixels */
  /* A distance in pixels. In a light's view, a fragment fills all slabs that its surface's plane crosses
   * within this distance from the fragment. So rays of other directions than the view's find no gap between
   * the pixels of a slanted surface. If it is 0, each fragment fills one slab. */
  double rise;
  /* [sheets][tile_words], one bit for each tile; may be null. A bit is set if a surface that is visible or
   * casts shadows lies in the tile, or beside it, in the slab that ends at the sheet */
  uint64_t *marks;
  int tile_words;
  const int32_t *needed; /* [tiles]; if 0, nobody needs the fragments of this tile. If null, the fragments of
                          * all tiles are needed */
} fragments_source;

/* The opaque fragments that were added last to a pixel of a tile in a light's view: one fragment for each of
 * several slabs. */
typedef struct latest_fragments {
  uint32_t end; /* the index, in the worker's array scratch, of the first of these fragments, plus 1; 0 if
                 * there are no such fragments */
  int32_t last; /* the slab of the last of these fragments */
} latest_fragments;

/* The samples of a pixel that opaque fragments of a light's view cover. */
typedef struct covered_so_far {
  float height; /* the greatest height among the fragments that were added until all samples were covered */
  uint32_t samples;
} covered_so_far;

/* One thread's memory; all arrays are owned. */
typedef struct fragment_worker {
  _Alignas(64) fragment *scratch; /* [2][room]; the first half holds the fragments of a tile, the second half
                                   * receives the same fragments in sorted order */
  order_key *keys;                /* [2][room]; the keys by which a tile's fragments are sorted, and memory
                                   * for sorting them */
  size_t count, room;
  latest_fragments latest[TILE_PIXELS];
  covered_so_far covered[TILE_PIXELS];
  order_key *runs; /* [2][run_room]; in a light's view: the runs of a tile, in the order of their least
                    * heights */
  size_t run_room;
  uint32_t *places; /* [sheets + 2]; memory for sorting fragments by slabs */
  /* [sheets]; for each slab, the tiles among the 3x3 tiles around the current tile that must be marked: the
   * tile that lies `across` columns and `down` rows away, -1 to 1, has the bit 3 (1 + down) + 1 + across */
  uint16_t *near;
  int32_t nearest, farthest; /* the first and the last slab for which `near` has a bit */
  fragment_block *out;       /* the fragments of the tiles that the thread has finished; null if there are
                              * none yet */
  bool failed;
} fragment_worker;

/* Data that the tiles of a view share. */
typedef struct fragment_work {
  const fragments_source *source;
  const seen_surfaces *seen;
  const primitive_bins *bins;
  binned *wanted;           /* [mesh_count]; for each mesh, the primitives that are made into fragments: all,
                             * only fronts, or none */
  small_view small;         /* a template for all tiles and meshes: the members that depend on a mesh are not
                             * set */
  fragment_worker *workers; /* [threads]; the memory of each thread */
  /* [mesh_count]; for each mesh, the least of the factors that its opacity has for red, green and blue
   * light */
  float *least;
  bool *dark_backs; /* [mesh_count]; only in a light's view: whether the light does not light the back sides
                     * of the mesh */
  tile_list *tiles; /* [tiles]; the finished fragments of each tile */
  int tiles_x, tiles_y;
  uint16_t near[TILE_PIXELS]; /* for each pixel of a tile, block after block: the tiles that look-ups
                               * around the pixel may read */
} fragment_work;

#endif
