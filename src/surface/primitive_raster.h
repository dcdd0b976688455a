/* surface/primitive_raster.h - declares the interface by which views see a kind of primitive, and by which
 * its primitives become fragments.
 *
 * Each kind of primitive (primitive.h) has one such table. Files of the folder surface call the functions of
 * the table: to sort primitives into tiles, to rasterise them and to cut crossing fragments. A kind is
 * rasterised in two ways. A small primitive is rasterised together with up to fifteen others of its mesh
 * (collect, cover_small). Any other primitive is rasterised by itself (cover). */
#ifndef HL_SURFACE_PRIMITIVE_RASTER_H
#define HL_SURFACE_PRIMITIVE_RASTER_H

#include "surface/fragment.h"
#include "surface/primitive.h"
#include "surface/seen.h"
#include "surface/small_triangles.h"

typedef struct fragment_work fragment_work;     /* see fragment_work.h */
typedef struct fragment_worker fragment_worker; /* see fragment_work.h */
typedef struct tile_part tile_part;             /* see primitive_fragments.h */
typedef struct small_batch small_batch;         /* see small_batch.h */
typedef struct shown_surface shown_surface;     /* see shown_surface.h */

struct primitive_raster {
  /* Finds a rectangle around the part of a primitive that the view sees. Returns false if the view sees
   * nothing of the primitive. fronts: whether sides that face away from the view are left out. */
  bool (*see)(const seen_surfaces *seen, uint32_t primitive, bool fronts, seen_bounds *bounds);
  /* A lower bound of a primitive's height above the first sheet. */
  float (*lowest)(const surfaces *all, const sheet_stack *sheets, uint32_t primitive);
  /* Adds a primitive to a batch of small primitives. Returns false if it must be rasterised by itself. */
  bool (*collect)(const fragment_work *work, const tile_part *part, small_batch *batch, uint32_t primitive);
  /* Finds the samples that the small primitives of a batch cover. Returns which primitives of the batch are
   * small, one bit each. */
  uint32_t (*cover_small)(const surface_functions *functions, small_batch *batch);
  /* Adds one primitive's fragments in a tile. f: a fragment in which the members are set that all these
   * fragments share. The worker must have room for them. */
  void (*cover)(const fragment_work *work, fragment_worker *worker, tile_part *part, const fragment *f);
  /* Finds the surface that a fragment shows. (u, v): the mean position of the fragment's samples in the view,
   * in pixels. */
  void (*show)(const seen_surfaces *seen, const sheet_stack *sheets, const fragment *f, double u, double v,
               shown_surface *shown);
  /* The height of a shown surface above the first sheet at a continuous pixel. */
  double (*height)(const sheet_stack *sheets, const shown_surface *shown, double u, double v);
};

/* The tables of the kinds of primitives; each table is in a file of its own (primitive_kinds.h). */
#define HL_PRIMITIVE(name) extern const primitive_raster hl_raster_##name;
HL_PRIMITIVES
#undef HL_PRIMITIVE

#endif
