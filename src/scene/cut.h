/* scene/cut.h - the shapes that cut a volume, in its index space. */
#ifndef HL_SCENE_CUT_H
#define HL_SCENE_CUT_H

#include <halflight/scene.h>

#include "core/vector.h"

/* A shape is a simple one in a space of its own: a plane's inside has x above 0, a box's has x, y and z from
 * -1 to 1, a sphere's is nearer than 1 to the origin. A plane's y and z are 0 everywhere. */
typedef struct cut_shape {
  hl_cut_type type;
  bool keep_inside;
  affine3 to_shape; /* index space to the shape's own */
} cut_shape;

/* The shape of volume->cuts[cut]. */
cut_shape hl_cut_shape(const hl_scene_volume *volume, size_t cut);

/* Whether two shapes are the same. */
bool hl_cut_same(const cut_shape *a, const cut_shape *b);

/* Whether a point of index space is left by all cuts. */
bool hl_cuts_leave(const cut_shape *cuts, size_t count, vec3 point);

/* Whether a point of index space is left by the cuts of a volume. */
bool hl_scene_volume_left(const hl_scene_volume *volume, vec3 point);

/* Whether a box of index space is surely cut away: some cut removes all of it. */
bool hl_cuts_remove_box(const cut_shape *cuts, size_t count, const double low[3], const double high[3]);

/* The same for the cuts of a volume. */
bool hl_scene_volume_removes_box(const hl_scene_volume *volume, const double low[3], const double high[3]);

#endif
