/* scene/light/light_kind.h - declares the interface of a type of light.
 *
 * Each type of light is a table, in a file of its own: the rules for its settings, and its shape as geometry.
 * light_kinds.h lists the types. Checks, the reading and writing of scene files, and renderers use the
 * tables, and name no type. Only the reference renderer names types, because the reference shares no code
 * with the renderers whose pictures are compared with the reference's pictures.
 *
 * Arguments named `facing` are unit vectors: the direction from the light to the scene's content, or the
 * direction of parallel light. Offsets are relative to the light's centre. For parallel light, points are
 * directions at distance 1, and offsets are relative to the light's direction. */
#ifndef HL_SCENE_LIGHT_LIGHT_KIND_H
#define HL_SCENE_LIGHT_LIGHT_KIND_H

#include "scene/check/reach.h"
#include "scene/light/light_kinds.h"
#include "scene/light/light_shape.h"

struct light_kind {
  /* ---- the kind ---- */
  bool parallel; /* whether the light is infinitely far away, and has a direction instead of a
                  * position */
  bool sphere;   /* whether the light looks like a disk that faces the observer */
  bool cone;     /* whether the light shines only within a cone around `direction` */
  bool outline;  /* whether `vertices` give the light's shape and its place */
  /* whether points of the light are taken from a unit square, and edge1 and edge2 are the sides of this
   * square on the light */
  bool parallelogram;
  double deviations; /* the extent of the light divided by the standard deviation of its points */

  /* ---- checks; settings are in their ranges already ---- */
  hl_status (*check)(const hl_checker *check,
                     const hl_light *light); /* checks a light's settings beyond their ranges; null if the
                                              * type has no further rules */
  /* Checks that floats hold the light's places and lengths beside the scene's voxels. */
  hl_status (*check_reach)(const hl_checker *check, const hl_light *light, const hl_frame_space *space);

  /* ---- its shape ---- */
  /* Makes the light's shape from its settings. hl_light_shape() sets `kind` and `image_up` afterwards. */
  light_shape (*shape)(const hl_light *light);
  /* The mean of the matrix x x' over all points of the light, where x is a point's offset: a rect has (e1 e1'
   * + e2 e2') / 12, a disk r^2/4 (1 - n n'). A sphere, and the directions of parallel light, count as a disk
   * perpendicular to `facing`. */
  mat3 (*spread)(const light_shape *shape, vec3 facing);
  /* The offset, from the light's centre, of the point of the light that belongs to the point (a, b) of the
   * unit square. Equal areas of the square become equal areas of the light. */
  vec3 (*point)(const light_shape *shape, vec3 facing, double a, double b);
  /* The plane of the emission image on the light's surface. */
  emission_plane (*plane)(const light_shape *shape, vec3 facing);
  /* Finds the apparent lengths of the unit square's two sides on the light, as seen along a unit vector. A
   * length that is not known is infinite. The function is null for parallel types. */
  void (*apparent_lengths)(const light_shape *shape, vec3 along, double length[2]);
};

/* The table of a light's type. */
const light_kind *hl_light_kind(const hl_light *light);

/* Finds the shape of a light. The shape borrows the light's vertices. */
light_shape hl_light_shape(const hl_light *light);

/* ---- for types whose place is `position` and whose shape is a disk or a sphere of `radius` ---- */

hl_status hl_check_round_reach(const hl_checker *check, const hl_light *light, const hl_frame_space *space);
light_shape hl_round_shape(const hl_light *light);
void hl_apparent_diameter(const light_shape *shape, vec3 along, double length[2]);
/* hl_round_spread(), hl_round_point() and hl_round_plane() give the spread, a point and the image's plane of
 * a disk with the shape's radius and the normal `facing`. A sphere counts as the disk that faces the viewer.
 */
mat3 hl_round_spread(const light_shape *shape, vec3 facing);
vec3 hl_round_point(const light_shape *shape, vec3 facing, double a, double b);
emission_plane hl_round_plane(const light_shape *shape, vec3 facing);

/* The tables of the types of light; each table is in a file of its own. */
#define HL_DECLARE(with, value, name, settings) extern const light_kind hl_light_kind_##name;
HL_LIGHT_KINDS(HL_DECLARE, 0)
#undef HL_DECLARE

#endif
