/* splat/coverage.c - sets up the rays of a view against a volume's box. */
#include "splat/coverage.h"

/* s of the rays at which the middle one is nearest to frame space's origin: counted from there, numbers are
 * as small as what is seen, however far the eye is. */
static double way_to_middle(const view *view) {
  vec3 start, way;
  hl_view_ray(view, view->width / 2.0, view->height / 2.0, &start, &way);
  return -vec3_dot(start, way) / vec3_dot(way, way);
}

void hl_box_rays(const view *view, vec3 normal, double first_height, affine3 frame_to_index,
                 const double low[3], const double high[3], box_rays *rays) {
  vec3 first = vec3_add(view->corner, vec3_scale(vec3_add(view->du, view->dv), 0.5));
  vec3 zero = {0, 0, 0}, direction = view->perspective ? first : view->direction;
  vec3 direction_u = view->perspective ? view->du : zero, direction_v = view->perspective ? view->dv : zero;
  double ahead = view->perspective ? fmax(way_to_middle(view), 0) : way_to_middle(view);
  vec3 start = vec3_add(view->perspective ? view->origin : first, vec3_scale(direction, ahead));
  vec3 start_u = view->perspective ? vec3_scale(view->du, ahead) : view->du;
  vec3 start_v = view->perspective ? vec3_scale(view->dv, ahead) : view->dv;
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
  rays->least = view->perspective ? -(float)ahead : -1e30f;
}
