/* shape/shape.h - describes solids by signed distances, hypertexture and orbitals, and samples them into a
 * volume.
 *
 * A list of shapes is a tree in one array: a group is followed by its members. Each shape has its own frame.
 * The shape is scaled, then turned, and then moved into the frame of its group, or into the frame of the
 * volume. Solids have a density: 1 inside, 0 outside and 0.5 on the surface. Across the surface the density
 * is linear in the distance, over HL_SHAPE_EDGE voxels. So kernels that reproduce linear functions
 * reconstruct a flat surface exactly. */
#ifndef HL_SHAPE_SHAPE_H
#define HL_SHAPE_SHAPE_H

#include <stddef.h>

#include "shape/noise.h"
#include "volume/volume.h"

#define HL_SHAPE_EDGE   4.0 /* the number of voxels over which the density falls from 1 to 0 */
#define HL_SHAPE_MARGIN 2   /* number of empty voxels around the shapes on each side of a grid */
#define HL_SHAPE_VOXELS ((size_t)1 << 30) /* the greatest number of voxels of a grid */
#define HL_SHAPE_COUNT \
  4096 /* greatest number of shapes in a list; the members of a group count each time the group is used */

typedef enum hl_shape_type {
  HL_SHAPE_BOX = 0,
  HL_SHAPE_SPHERE = 1,
  HL_SHAPE_CYLINDER = 2,
  HL_SHAPE_CAPSULE = 3,
  HL_SHAPE_CONE = 4,
  HL_SHAPE_TORUS = 5,
  HL_SHAPE_PLANE = 6,
  HL_SHAPE_ORBITAL = 7,
  HL_SHAPE_GROUP = 8
} hl_shape_type;

/* The operation that joins a shape to the shapes before it in its list. */
typedef enum hl_shape_operation {
  HL_SHAPE_ADD = 0,
  HL_SHAPE_SUBTRACT = 1,
  HL_SHAPE_INTERSECT = 2
} hl_shape_operation;

typedef enum hl_shape_pattern {
  HL_PATTERN_NONE = 0,
  HL_PATTERN_NOISE = 1,
  HL_PATTERN_TURBULENCE = 2
} hl_shape_pattern;

/* Noise that changes the density near a shape's surface (Perlin and Hoffert, 1989). Lengths are in the
 * shape's own frame. */
typedef struct hl_hypertexture {
  hl_shape_pattern pattern;
  double frequency; /* number of cells of the noise per unit of length */
  int octaves;
  double bias, gain; /* bias and gain of the pattern's value, 0 to 1 */
  double amplitude;  /* depth by which the surface recedes at places where the pattern's value is 1; a
                      * negative depth moves the surface outwards */
  double soft;       /* length over which the density falls from 1 to 0; 0 stands for HL_SHAPE_EDGE voxels */
  int strands;       /* whether the texture is fur: the pattern then has the same value along the whole of a
                      * normal, which is its value at the point where the normal meets the surface */
  hl_noise noise;
} hl_hypertexture;

typedef struct hl_shape {
  hl_shape_type type;
  hl_shape_operation operation;
  double blend; /* length over which the joint with the earlier shapes is rounded; 0 for a sharp joint */
  double position[3];
  double rotate_axis[3];
  double rotate_angle_deg;
  double scale;
  double size[3];        /* for a box: its full edges; for a plane: x, y and thickness */
  double from[3], to[3]; /* for a cylinder, a capsule and a cone: the ends of the axis */
  double radius;         /* the radius of a sphere; for a torus, the radius of the circle in the tube's
                          * middle; for an orbital, the radius at which it is cut off; for a cone, the radius
                          * at `from` */
  double end_radius;     /* for a cone: the radius at `to` */
  double tube_radius;    /* for a torus: the radius of the tube */
  double rounding;       /* for a box, a plane and a cylinder: the radius of the rounded edges; the size
                          * stays as given */
  int quantum[3];        /* for an orbital: the quantum numbers n, l and m */
  hl_hypertexture texture;
  size_t end;       /* index of the first shape after this shape and its members */
  affine3 to_local; /* the map from the parent's frame to the shape's own frame; hl_shapes_place() sets it,
                     * and sets `edge` */
  double edge;      /* length of HL_SHAPE_EDGE voxels in the shape's own frame */
} hl_shape;

typedef struct hl_shape_list {
  hl_shape *shapes; /* owned; [count]; the shapes in reading order: each group stands before its members */
  size_t count, capacity;
} hl_shape_list;

void hl_shape_defaults(hl_shape *shape);

/* The grid that holds all shapes and an empty margin. The centres of its voxels lie at whole multiples of
 * voxel_size. */
typedef struct hl_shape_grid {
  double voxel_size;
  int64_t first[3]; /* the first voxel's centre, in voxels */
  size_t dimension[3];
} hl_shape_grid;

/* Fills the members to_local and edge of all shapes, for a size of voxels. */
void hl_shapes_place(hl_shape_list *list, double voxel_size);

/* The longest edge of the box around all shapes, without margin; 0 if the box is empty. */
double hl_shapes_extent(const hl_shape_list *list);

/* Finds the grid that holds all shapes. Returns false if the grid would need more than HL_SHAPE_VOXELS
 * voxels, or would lie more than a trillion voxels from the origin. */
bool hl_shapes_grid(const hl_shape_list *list, double voxel_size, hl_shape_grid *grid);

/* Bounds of a distance: the least and the greatest value that it may have. */
typedef struct hl_interval {
  double low, high;
} hl_interval;

/* The signed distance of p, a point of the volume's frame, from the surface of all shapes: negative inside,
 * clamped to half of `edge` both ways. live: [count], from hl_shapes_bounds(): for each shape, whether it can
 * affect the distance; if null, all shapes are used. */
double hl_shapes_distance(const hl_shape_list *list, const unsigned char *live, vec3 p);

/* Finds bounds of hl_shapes_distance() for all points within `radius` of p. live: [count]; receives whether
 * each shape can affect the distance there. */
hl_interval hl_shapes_bounds(const hl_shape_list *list, vec3 p, double radius, unsigned char *live);

/* The distance from the surface of a shape with its texture. distance: the distance without the texture. p: a
 * point of the shape's own frame. foot: the point of the surface that is nearest to p. */
double hl_hypertexture_distance(const hl_shape *shape, double distance, vec3 p, vec3 foot);
hl_interval hl_hypertexture_bounds(const hl_shape *shape, hl_interval distance);
/* Returns whether a texture can change the density at a point with a given distance from the surface of its
 * shape. */
bool hl_hypertexture_matters(const hl_shape *shape, double distance);

/* The value of the real hydrogen-like wave function at a point; it is not normalised. p: a point of the
 * shape's own frame. */
double hl_orbital_at(const hl_shape *shape, vec3 p);

/* Makes a volume of a list of shapes, which hl_shapes_place() has placed for the grid's voxels. Orbitals are
 * scaled so that their greatest magnitude is 1. threads: 0 for one per processor. subject: the beginning of
 * error lines. */
hl_status hl_shapes_sample(hl_context *context, const hl_shape_list *list, const hl_shape_grid *grid,
                           int threads, const char *subject, hl_volume **volume, hl_error *error);

#endif
