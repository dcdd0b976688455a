/* analytic/moved_stage.h - moves a stage as a whole (turns, mirrors, scales, shifts). The picture stays the
 * same, or becomes its mirror image. */
#ifndef MOVED_STAGE_H
#define MOVED_STAGE_H

#include "reference_stage.h"

/* The motion p -> scale * turn p + shift. turn: orthogonal, a rotation or a reflection. scale: above 0. */
typedef struct motion {
  mat3 turn;
  double scale;
  vec3 shift;
} motion;

motion motion_of_scale(double scale);
motion motion_of_shift(double x, double y, double z);
motion motion_of_turn(vec3 axis, double angle_deg);
motion motion_of_mirror(vec3 normal); /* normal: the unit normal of a mirror through the origin */

/* Moves camera, lights and volumes. The motion changes a volume's axes and origin. If the volume has a clip
 * box, or `by_transform` is set, the motion changes the volume's scene transform in place of axes and origin,
 * unless the motion is a reflection. If a light falls with the square of the distance, its intensity is
 * changed to make up for the scale. vertices: memory for all vertices of polygons; this memory must last
 * until the pictures are made. */
void stage_move(stage *set, const motion *by, int by_transform, double (*vertices)[3]);

#endif
