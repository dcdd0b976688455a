/* light/lit_region.c - bounds of a light screen, of a spot light's cone and of a light's sector, seen from
 * the light. */
#include "light/lit_region.h"

static bool bound_screen(const view *view, const light_source *source, double low[2], double high[2]) {
  low[0] = low[1] = INFINITY;
  high[0] = high[1] = -INFINITY;
  for (int corner = 0; corner < 4; corner++) {
    vec3 at = vec3_add(source->screen_center, vec3_scale(source->screen_right, corner & 1 ? 1 : -1));
    double uv[2];
    if (!hl_view_project(view, vec3_add(at, vec3_scale(source->screen_up, corner & 2 ? 1 : -1)), uv))
      return false;
    for (int axis = 0; axis < 2; axis++) {
      low[axis] = fmin(low[axis], uv[axis]);
      high[axis] = fmax(high[axis], uv[axis]);
    }
  }
  return true;
}

/* Derived: planes through the light that contain the view's other axis touch the cone of half angle a where
 * their angle phi from the view's normal n has r sin(psi - phi) = +- sin a, r and psi being the length and
 * angle of the cone's axis in the plane of n and this axis. corner, du and dv of the view are n and its axes,
 * unit and perpendicular. */
static bool bound_cone(const view *view, const light_source *source, double low[2], double high[2]) {
  const vec3 axes[2] = {view->du, view->dv};
  vec3 cone = vec3_normalise(vec3_of(source->light->direction));
  double sine = sin(source->light->opening_angle_deg * HL_PI / 360);
  for (int i = 0; i < 2; i++) {
    double along = vec3_dot(cone, axes[i]), ahead = vec3_dot(cone, view->corner);
    double r = hypot(along, ahead), psi = atan2(along, ahead);
    if (!(r > sine)) return false;
    double reach = asin(sine / r);
    if (psi - reach <= -HL_PI / 2 || psi + reach >= HL_PI / 2) return false;
    low[i] = tan(psi - reach);
    high[i] = tan(psi + reach);
  }
  return true;
}

static void cut(const double by_low[2], const double by_high[2], double low[2], double high[2]) {
  for (int axis = 0; axis < 2; axis++) {
    low[axis] = fmin(fmax(low[axis], by_low[axis]), high[axis]);
    high[axis] = fmax(fmin(high[axis], by_high[axis]), low[axis]);
  }
}

void hl_lit_region(const view *view, const light_source *source, double low[2], double high[2]) {
  double lit_low[2], lit_high[2];
  if (source->sectors != NULL) {
    double reach = tan(acos(source->sectors->least));
    cut((double[2]){-reach, -reach}, (double[2]){reach, reach}, low, high);
  }
  if (source->shadows != HL_SHADOWS_HARD) return; /* penumbrae come from beside what is lit */
  if (source->light->texture.pixels != NULL && bound_screen(view, source, lit_low, lit_high))
    cut(lit_low, lit_high, low, high);
  if (source->light->type == HL_LIGHT_SPOT && bound_cone(view, source, lit_low, lit_high))
    cut(lit_low, lit_high, low, high);
}
