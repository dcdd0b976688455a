/* view/view.c - finds the rays of pixels and the points at which the rays meet sheets and boxes, and projects
 * points to pixels. */
#include "view/view.h"

bool hl_view_finish(view *view) {
  mat3 forward = view->perspective ? mat3_from_columns(view->corner, view->du, view->dv)
                                   : mat3_from_columns(view->direction, view->du, view->dv);
  return mat3_invert(forward, &view->inverse);
}

bool hl_view_project(const view *view, vec3 point, double uv[2]) {
  vec3 p = mat3_apply(view->inverse, vec3_subtract(point, view->perspective ? view->origin : view->corner));
  double w = view->perspective ? p.x : 1;
  if (w <= 0) return false;
  uv[0] = p.y / w;
  uv[1] = p.z / w;
  return true;
}

void hl_view_ray(const view *view, double u, double v, vec3 *start, vec3 *direction) {
  vec3 at = vec3_add(view->corner, vec3_add(vec3_scale(view->du, u), vec3_scale(view->dv, v)));
  *start = view->perspective ? view->origin : at;
  *direction = view->perspective ? at : view->direction;
}

void hl_view_homogeneous(const view *view, affine3 to_frame, double rows[3][4]) {
  affine3 to_view = {
      view->inverse,
      vec3_scale(mat3_apply(view->inverse, view->perspective ? view->origin : view->corner), -1)};
  affine3 both = affine3_multiply(to_view, to_frame);
  const double offset[3] = {both.offset.x, both.offset.y, both.offset.z};
  for (int row = 0; row < 3; row++) {
    rows[row][0] = both.linear.row[row].x;
    rows[row][1] = both.linear.row[row].y;
    rows[row][2] = both.linear.row[row].z;
    rows[row][3] = offset[row];
  }
  if (!view->perspective) {
    rows[0][0] = rows[0][1] = rows[0][2] = 0;
    rows[0][3] = 1;
  }
}

/* The point where a ray meets a sheet at a given height: start + ((height - h.start) / (h.direction))
 * direction. It is a linear function of the pixel. */
static vec3 on_sheet(vec3 start, vec3 direction, vec3 normal, double height) {
  return vec3_add(start,
                  vec3_scale(direction, (height - vec3_dot(normal, start)) / vec3_dot(normal, direction)));
}

/* The least sine of the angle between a view's middle ray and the sheets for which `base` is the point where
 * this ray meets the sheet. A flatter middle ray meets the sheet too far away, and `base` is then the eye. */
static const double FLATTEST_MIDDLE = 0.01;

static void perspective_rays(const view *view, vec3 normal, double height, affine3 from_frame,
                             sheet_rays *rays) {
  vec3 first = vec3_add(view->corner, vec3_scale(vec3_add(view->du, view->dv), 0.5)), middle, start;
  hl_view_ray(view, view->width / 2.0, view->height / 2.0, &start, &middle);
  const vec3 w[3] = {first, view->du, view->dv};
  double step = height - vec3_dot(normal, view->origin), climb = vec3_dot(normal, middle);
  double t = fabs(climb) > FLATTEST_MIDDLE * vec3_length(middle) ? step / climb : 0;
  float *p[3] = {rays->p0, rays->pu, rays->pv}, *directions[3] = {rays->w0, rays->wu, rays->wv};
  float *climbs[3] = {&rays->h0, &rays->hu, &rays->hv};
  for (int i = 0; i < 3; i++) {
    double h = vec3_dot(normal, w[i]);
    vec3 at = vec3_subtract(vec3_scale(w[i], step), vec3_scale(middle, t * h));
    vec3_store(p[i], mat3_apply(from_frame.linear, at));
    vec3_store(directions[i], mat3_apply(from_frame.linear, w[i]));
    *climbs[i] = (float)h;
  }
  vec3_store(rays->base, affine3_apply(from_frame, vec3_add(view->origin, vec3_scale(middle, t))));
  rays->step = (float)step;
}

static void parallel_rays(const view *view, vec3 normal, double height, affine3 from_frame,
                          sheet_rays *rays) {
  vec3 first = vec3_add(view->corner, vec3_scale(vec3_add(view->du, view->dv), 0.5));
  vec3 start = on_sheet(first, view->direction, normal, height);
  vec3 along_u = vec3_subtract(on_sheet(vec3_add(first, view->du), view->direction, normal, height), start);
  vec3 along_v = vec3_subtract(on_sheet(vec3_add(first, view->dv), view->direction, normal, height), start);
  vec3_store(rays->p0, affine3_apply(from_frame, start));
  vec3_store(rays->pu, mat3_apply(from_frame.linear, along_u));
  vec3_store(rays->pv, mat3_apply(from_frame.linear, along_v));
}

void hl_view_sheet_rays(const view *view, vec3 normal, double height, affine3 from_frame, sheet_rays *rays) {
  *rays = (sheet_rays){.perspective = view->perspective, .h0 = 1, .step = 1};
  if (view->perspective) perspective_rays(view, normal, height, from_frame, rays);
  else parallel_rays(view, normal, height, from_frame, rays);
}

/* ---- where rays enter and leave a box ---- */

/* The parameter s of the point at which the middle ray is closest to the origin of frame space. Coordinates
 * that are counted from this point are never larger than the visible scene, however far away the eye is. */
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
  rays->sphere = 0;
}

/* ---- bounds of boxes in a view ---- */

void hl_footprint_map(const view *view, vec3 normal, affine3 index_to_frame, footprint_map *map) {
  hl_view_homogeneous(view, index_to_frame, map->view);
  const mat3 *m = &index_to_frame.linear;
  map->height[0] = vec3_dot(normal, mat3_column(*m, 0));
  map->height[1] = vec3_dot(normal, mat3_column(*m, 1));
  map->height[2] = vec3_dot(normal, mat3_column(*m, 2));
  map->height[3] = vec3_dot(normal, index_to_frame.offset);
}

static double at(const double row[4], const double p[3]) {
  return row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3];
}
static double spread(const double row[4], const double half[3]) {
  return fabs(row[0]) * half[0] + fabs(row[1]) * half[1] + fabs(row[2]) * half[2];
}

bool hl_footprint_bounds(const footprint_map *map, const double centre[3], const double half[3],
                         footprint_bounds *bounds) {
  double height = at(map->height, centre), reach = spread(map->height, half);
  bounds->low_height = height - reach;
  bounds->high_height = height + reach;
  double w = at(map->view[0], centre), w_reach = spread(map->view[0], half);
  if (w + w_reach <= 0) return false;
  double nearest = w - w_reach, farthest = w + w_reach;
  for (int axis = 0; axis < 2; axis++) {
    double middle = at(map->view[1 + axis], centre), extent = spread(map->view[1 + axis], half);
    double low = middle - extent, high = middle + extent;
    if (nearest <= 1e-9 * farthest) { /* the box reaches behind the eye: its projection has no bounds */
      bounds->low[axis] = -INFINITY;
      bounds->high[axis] = INFINITY;
    } else {
      bounds->low[axis] = low / (low < 0 ? nearest : farthest);
      bounds->high[axis] = high / (high < 0 ? farthest : nearest);
    }
  }
  return true;
}
