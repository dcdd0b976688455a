/* render/late/hollow.c - see hollow.h. */
#include "render/late/hollow.h"

#include "surface/primitive.h"

double hl_hollow_bend(const surfaces *all, const surface_batch *batch, int sample, vec3 towards_light) {
  const uint32_t primitive = batch->fragments[sample]->primitive;
  const surface_samples *samples = &batch->samples;
  vec3 point = {samples->position[0][sample], samples->position[1][sample], samples->position[2][sample]},
       normal = {samples->normal[0][sample], samples->normal[1][sample], samples->normal[2][sample]};
  vec3 above = vec3_scale(normal, vec3_dot(towards_light, normal)),
       along = vec3_normalise(vec3_subtract(towards_light, above));
  return hl_primitive_kind(all, primitive)->bend(all, batch->mesh, primitive, point, normal, along);
}
