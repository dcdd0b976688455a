/* scene/geometry/cut.h - handles the shapes that cut a volume, in the volume's index space, or a mesh, in the
 * mesh's world. */
#ifndef HL_SCENE_GEOMETRY_CUT_H
#define HL_SCENE_GEOMETRY_CUT_H

#include <halflight/scene.h>

#include "core/error.h"
#include "core/key.h"
#include "core/vector.h"

/* The shape of a cut, given by the map to a space of the shape's own, in which the shape is simple. In this
 * space, the inside of a plane has x above 0, the inside of a box has x, y and z from -1 to 1, and the inside
 * of a sphere is nearer than 1 to the origin. For a plane, the map makes y and z 0. */
typedef struct cut_shape {
  hl_cut_type type;
  bool keep_inside;
  affine3 to_shape; /* maps index space, or a mesh's world, to the shape's own space */
} cut_shape;

/* Returns whether a cut removes a box, which leaves inner corners in the matter. */
static inline bool hl_cut_hollows_out(const cut_shape *cut) {
  return cut->type == HL_CUT_BOX && !cut->keep_inside;
}

/* The shape of a cut, in the world in which the cut's own numbers are given. */
cut_shape hl_cut_shape_in_world(const hl_cut *cut);

/* The shape of volume->cuts[cut]. */
cut_shape hl_cut_shape(const hl_scene_volume *volume, size_t cut);

/* Finds the shapes of all cuts of a volume. *shapes: [volume->cut_count]; the caller releases them; null if
 * the volume has no cuts. Fails only for lack of memory. */
hl_status hl_cut_shapes(hl_context *context, const hl_scene_volume *volume, cut_shape **shapes,
                        hl_error *error);

/* Adds the scene's cuts to the cuts of a copy of one of the scene's volumes. cuts: room for the cuts of the
 * volume and of the scene; the volume borrows this array. */
void hl_add_scene_cuts(const hl_scene_description *scene, hl_scene_volume *volume, hl_cut *cuts);

/* Copies of a scene's volumes to whose cuts the scene's own cuts were added; all members are null if the
 * scene has no cuts. */
typedef struct placed_cuts {
  hl_scene_volume *volumes; /* owned; the arrays in them belong to the scene */
  hl_cut *cuts;             /* owned; the cuts of all volumes */
} placed_cuts;

/* If a scene has cuts, replaces the volumes of a placed description by copies, which `made` owns. Call
 * hl_placed_cuts_release() even after a failure. */
hl_status hl_cuts_place(hl_context *context, hl_scene_description *placed, placed_cuts *made,
                        hl_error *error);
void hl_placed_cuts_release(hl_context *context, placed_cuts *made);

/* Adds the shapes of cuts to a key. */
void hl_cuts_key_add(hl_key *key, const cut_shape *cuts, size_t count);

/* Returns whether two shapes are equal. */
bool hl_cut_same(const cut_shape *a, const cut_shape *b);

/* Returns whether no cut removes a point of the space on which the shapes' maps act. */
bool hl_cuts_leave(const cut_shape *cuts, size_t count, vec3 point);

/* Returns whether a box along the axes of the space on which the shapes' maps act is surely removed, because
 * a single cut removes the whole box. */
bool hl_cuts_remove_box(const cut_shape *cuts, size_t count, const double low[3], const double high[3]);

/* Returns whether a box along the axes of the space on which the shapes' maps act is surely left, because no
 * cut removes any part of the box. */
bool hl_cuts_leave_box(const cut_shape *cuts, size_t count, const double low[3], const double high[3]);

#endif
