/* splat/coverage.c - sets up the rays of a view against a volume's box. */
#include "splat/coverage.h"

void hl_box_rays(const view *view, vec3 normal, double first_height, affine3 frame_to_index, const double low[3],
                 const double high[3], box_rays *rays) {
  vec3 first = vec3_add(view->corner, vec3_scale(vec3_add(view->du, view->dv), 0.5));
  vec3 zero = {0, 0, 0}, start = view->perspective ? view->origin : first;
  vec3 start_u = view->perspective ? zero : view->du, start_v = view->perspective ? zero : view->dv;
  vec3 direction = view->perspective ? first : view->direction;
  vec3 direction_u = view->perspective ? view->du : zero, direction_v = view->perspective ? view->dv : zero;
  vec3_store(rays->start, affine3_apply(frame_to_index, start));
  vec3_store(rays->start_u, mat3_apply(frame_to_index.linear, start_u));
  vec3_store(rays->start_v, mat3_apply(frame_to_index.linear, start_v));
  vec3_store(rays->direction, mat3_apply(frame_to_index.linear, direction));
  vec3_store(rays->direction_u, mat3_apply(frame_to_index.linear, direction_u));
  vec3_store(rays->direction_v, mat3_apply(frame_to_index.linear, direction_v));
  rays->start_height = (float)(vec3_dot(normal, start) - first_height);
  rays->start_height_u = (float)vec3_dot(normal, start_u);
  rays->start_height_v = (float)vec3_dot(normal, start_v);
  rays->climb = (float)vec3_dot(normal, direction);
  rays->climb_u = (float)vec3_dot(normal, direction_u);
  rays->climb_v = (float)vec3_dot(normal, direction_v);
  for (int axis = 0; axis < 3; axis++) {
    rays->low[axis] = (float)low[axis];
    rays->high[axis] = (float)high[axis];
  }
  rays->perspective = view->perspective;
}
