/* render/late/hollow.h - points of hollow surfaces that light almost grazes: whether the surface shades
 * itself there.
 *
 * Where light grazes a surface, a shadow buffer takes the surface into account ever later (surface_plane.h:
 * the slope of its heights grows without end), and a hollow one meets the light's ray again close by: the
 * wall within a cut ball would get a streak of light where it turns away from the light. In: how the normal
 * turns in a triangle or a sphere. Out: how much it is bent towards a light.
 *
 * Derived: where the normal turns towards the light by k per length along the light's way (k = 1 / radius
 * within a ball), the surface is a circle of radius 1 / k in the plane of its normal and the light. A ray
 * that leaves it at an angle whose sine is s meets the circle again after a chord of 2 s / k, if cuts leave
 * the surface there. */
#ifndef HL_RENDER_LATE_HOLLOW_H
#define HL_RENDER_LATE_HOLLOW_H

#include "render/surface_batch.h"

/* The turn of the normal of a batch's sample, towards its own side, per length along the way to a light:
 * above 0 in a hollow; 0 on flat and on rough ones, and on spheres that light passes. towards_light: of any
 * length. */
double hl_hollow_bend(const surfaces *all, const surface_batch *batch, int sample, vec3 towards_light);

#endif
