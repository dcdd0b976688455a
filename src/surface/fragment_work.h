/* surface/fragment_work.h - what the tiles of a view share while their fragments are made, and what one
 * thread has. */
#ifndef HL_SURFACE_FRAGMENT_WORK_H
#define HL_SURFACE_FRAGMENT_WORK_H

#include "surface/fragment_order.h"
#include "surface/primitive_bins.h"
#include "surface/small_triangles.h"

/* Memory for the fragments of many tiles: a chain of blocks, none of which is copied when the next one
 * begins. */
typedef struct fragment_block {
  struct fragment_block *before; /* owned */
  size_t count, room;
  fragment list[]; /* [room], of which count are in use */
} fragment_block;

/* The fragments of one tile, by slab, then pixel, then height. */
typedef struct tile_list {
  const fragment *list; /* [count]; in a block */
  uint32_t count;
  uint32_t reached; /* how many lie before the next slab that the sweep asks for */
} tile_list;

/* The input of hl_fragments_create(); borrowed. */
typedef struct fragments_source {
  hl_context *context;
  hl_pool *pool;
  const surface_functions *functions;
  const surfaces *surfaces;
  const view *view;
  const sheet_stack *sheets;
  bool falling;  /* the view meets great heights first */
  bool of_light; /* a light's view: of the meshes that cast shadows; else of those that are visible */
  bool unseen;   /* of the eye's view: of the meshes that are not visible and cast shadows. No fragment hides
                    another, and opacities are parts of a pixel */
  double delay;  /* pixels of the view: a fragment counts from the height that its surface's plane has so far
                    away, so that a surface does not darken itself where buffers are interpolated */
  double rise;   /* pixels of the view: a fragment of a light's view fills all slabs that its surface's plane
                    crosses within so many, so that rays of other directions than the view's find no gap
                    between pixels of a slanted surface; 0: one slab */
  uint64_t *marks; /* [sheets][tile_words], bit = tile; may be null. Bits are set for each sheet that ends a
                      slab with a visible or shadow-casting surface in the tile, and in tiles beside it */
  int tile_words;
  const int32_t *needed; /* [tiles]; 0: nobody asks for the tile's fragments; null: all tiles are needed */
} fragments_source;

/* The last opaque fragments that a tile's pixel got in a light's view: one in each of some slabs. */
typedef struct latest_fragments {
  uint32_t end; /* of the first, in the worker's scratch; 0: none */
  int32_t last; /* slab */
} latest_fragments;

/* What opaque fragments of a light's view cover of a pixel. */
typedef struct covered_so_far {
  float height; /* the greatest of those fragments, up to the one that covered the last sample */
  uint32_t samples;
} covered_so_far;

/* One thread's memory; all arrays are owned. */
typedef struct fragment_worker {
  _Alignas(64) fragment *scratch; /* [2][room]; a tile's fragments, then the same sorted */
  order_key *keys;                /* [2][room]; for sorting */
  size_t count, room;
  latest_fragments latest[TILE_PIXELS];
  covered_so_far covered[TILE_PIXELS];
  order_key *runs; /* [2][run_room]; of a light's view: a tile's runs, from the lowest on */
  size_t run_room;
  uint32_t *places; /* [sheets + 2]; for sorting */
  uint16_t *near;   /* [sheets]; of each slab the tiles to be marked: bit 3 (1 + down) + 1 + across */
  int32_t nearest, farthest; /* slabs of which near is not 0 */
  fragment_block *out;       /* of the tiles that the thread has made; null: none yet */
  bool failed;
} fragment_worker;

/* What the tiles of a view share. */
typedef struct fragment_work {
  const fragments_source *source;
  const seen_surfaces *seen;
  const primitive_bins *bins;
  binned *wanted;           /* [mesh_count]; what of each mesh is seen */
  small_view small;         /* but for the mesh */
  fragment_worker *workers; /* [threads] */
  float *least;             /* [mesh_count]; as in fragment_order */
  bool *dark_backs;         /* [mesh_count]; of a light's view: where the light leaves the mesh it lights
                               nothing */
  tile_list *tiles;         /* [tiles] */
  int tiles_x, tiles_y;
  uint16_t
      near[TILE_PIXELS]; /* of each pixel, block after block: the tiles that look-ups about it may read */
} fragment_work;

#endif
