/* analytic/moved_stage.h - a stage turned, mirrored, scaled and shifted as a whole: the same picture, or its
 * mirror image. */
#ifndef MOVED_STAGE_H
#define MOVED_STAGE_H

#include "reference_stage.h"

/* p -> scale * turn p + shift. turn is orthogonal, a rotation or a reflection; scale is above 0. */
typedef struct motion {
  mat3 turn;
  double scale;
  vec3 shift;
} motion;

motion motion_of_scale(double scale);
motion motion_of_shift(double x, double y, double z);
motion motion_of_turn(vec3 axis, double angle_deg);
motion motion_of_mirror(vec3 normal); /* unit normal of the mirror through the origin */

/* Moves camera, lights and volumes. A volume's axes and origin take the motion, unless it has a clip box or
 * `by_transform` is set and the motion is no reflection: then its scene transform does. Where light falls
 * with the square of the distance its intensity makes up for the scale. vertices: room for all vertices of
 * polygons, kept until the pictures are made. */
void stage_move(stage *set, const motion *by, int by_transform, double (*vertices)[3]);

#endif
