/* scene/geometry/cut.h - the shapes that cut a volume, in its index space, and meshes, in their world. */
#ifndef HL_SCENE_GEOMETRY_CUT_H
#define HL_SCENE_GEOMETRY_CUT_H

#include <halflight/scene.h>

#include "core/error.h"
#include "core/key.h"
#include "core/vector.h"

/* A shape is a simple one in a space of its own: a plane's inside has x above 0, a box's has x, y and z from
 * -1 to 1, a sphere's is nearer than 1 to the origin. A plane's y and z are 0 everywhere. */
typedef struct cut_shape {
  hl_cut_type type;
  bool keep_inside;
  affine3 to_shape; /* index space to the shape's own */
} cut_shape;

/* The shape of a cut, in the world in which the cut's own numbers are given. */
cut_shape hl_cut_shape_in_world(const hl_cut *cut);

/* The shape of volume->cuts[cut]. */
cut_shape hl_cut_shape(const hl_scene_volume *volume, size_t cut);

/* The shapes of all cuts of a volume. *shapes: [volume->cut_count], which the caller releases; null where the
 * volume has no cuts. Fails for lack of memory alone. */
hl_status hl_cut_shapes(hl_context *context, const hl_scene_volume *volume, cut_shape **shapes,
                        hl_error *error);

/* Gives a copy of a scene's volume the scene's cuts beside its own. cuts: [the volume's and the scene's
 * cut_count], which the volume then borrows. */
void hl_add_scene_cuts(const hl_scene_description *scene, hl_scene_volume *volume, hl_cut *cuts);

/* Copies of a scene's volumes that have the scene's own cuts beside each volume's cuts; all null where the
 * scene has no cuts. */
typedef struct placed_cuts {
  hl_scene_volume *volumes; /* owned; the arrays in them belong to the scene */
  hl_cut *cuts;             /* owned; the cuts of all volumes */
} placed_cuts;

/* Replaces the volumes of a placed description by those of `made`, where the scene has cuts. After a failure,
 * too, call hl_placed_cuts_release(). */
hl_status hl_cuts_place(hl_context *context, hl_scene_description *placed, placed_cuts *made,
                        hl_error *error);
void hl_placed_cuts_release(hl_context *context, placed_cuts *made);

/* Adds the shapes. */
void hl_cuts_key_add(hl_key *key, const cut_shape *cuts, size_t count);

/* Whether two shapes are the same. */
bool hl_cut_same(const cut_shape *a, const cut_shape *b);

/* Whether no cut removes a point of the shapes' space. */
bool hl_cuts_leave(const cut_shape *cuts, size_t count, vec3 point);

/* Whether a box along the axes of the shapes' space is surely cut away: some cut removes all of it. */
bool hl_cuts_remove_box(const cut_shape *cuts, size_t count, const double low[3], const double high[3]);

/* Whether a box along the axes of the shapes' space is surely left: no cut removes any of it. */
bool hl_cuts_leave_box(const cut_shape *cuts, size_t count, const double low[3], const double high[3]);

#endif
