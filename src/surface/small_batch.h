/* surface/small_batch.h - describes a batch: up to sixteen primitives of one kind and one mesh that are
 * rasterised together. */
#ifndef HL_SURFACE_SMALL_BATCH_H
#define HL_SURFACE_SMALL_BATCH_H

#include "surface/primitive_raster.h"

struct small_batch {
  small_triangles triangles;
  small_spheres spheres;
  small_cover cover;
  small_view view;
  uint32_t primitives[SMALL_TRIANGLES];
  float opacity[SMALL_TRIANGLES];
  int count;
  const primitive_kind *kind; /* the kind of the batch's primitives */
  size_t mesh;
  bool may_be_covered; /* only in a light's view: whether some clusters may lie behind fragments that cover
                        * all of their pixels */
};

#endif
