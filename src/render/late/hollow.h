/* render/late/hollow.h - points of hollow surfaces that light almost grazes: whether the surface shades
 * itself there.
 *
 * The more light grazes a surface, the later a shadow buffer takes the surface into account
 * (surface_plane.h: the slope of the surface's heights grows without end). A ray that grazes a hollow
 * surface meets the surface again close by, where the buffer does not hold it yet. Without this correction,
 * the inner wall of a cut ball would get a streak of light where the wall turns away from the light. In:
 * how the normal turns in a triangle or a sphere. Out: how much the surface is bent towards a light.
 *
 * Derived: where the normal turns towards the light by k per length along the light's way (k = 1 / radius
 * within a ball), the surface is a circle of radius 1 / k in the plane of its normal and the light. A ray
 * that leaves it at an angle whose sine is s meets the circle again after a chord of 2 s / k, if cuts leave
 * the surface there. */
#ifndef HL_RENDER_LATE_HOLLOW_H
#define HL_RENDER_LATE_HOLLOW_H

#include "render/surface_batch.h"

/* How far the normal of a batch's sample turns towards the light, per length along the way to the light. It
 * is above 0 where the surface is hollow. It is 0 on flat and on rough surfaces, and on spheres that light
 * passes. towards_light: of any length. */
double hl_hollow_bend(const surfaces *all, const surface_batch *batch, int sample, vec3 towards_light);

#endif
