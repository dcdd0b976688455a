/* splat/view.c - rays of pixels, their meeting points with sheets, and projection back. */
#include "splat/view.h"

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
  affine3 whole = affine3_multiply(to_view, to_frame);
  const double offset[3] = {whole.offset.x, whole.offset.y, whole.offset.z};
  for (int row = 0; row < 3; row++) {
    rows[row][0] = whole.linear.row[row].x;
    rows[row][1] = whole.linear.row[row].y;
    rows[row][2] = whole.linear.row[row].z;
    rows[row][3] = offset[row];
  }
  if (!view->perspective) {
    rows[0][0] = rows[0][1] = rows[0][2] = 0;
    rows[0][3] = 1;
  }
}

/* The ray's point on the sheet is start + ((height - h.start) / (h.direction)) direction: linear in the
 * pixel. */
static vec3 on_sheet(vec3 start, vec3 direction, vec3 normal, double height) {
  return vec3_add(start,
                  vec3_scale(direction, (height - vec3_dot(normal, start)) / vec3_dot(normal, direction)));
}

/* A middle ray that runs along the sheet meets it nowhere near: then base is the eye. */
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
    vec3 place = vec3_subtract(vec3_scale(w[i], step), vec3_scale(middle, t * h));
    vec3_store(p[i], mat3_apply(from_frame.linear, place));
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
