/* light/light_source.c - see light_source.h. */
#include "light/light_source.h"

#include "elementary/elementary.h"

/* A light counts as a point if the square of its size is at most this fraction of the square of its distance.
 * The light's penumbrae are then too narrow for any pixel. */
static const double POINT_LIKE = 1e-12;

static double trace(mat3 m) { return m.row[0].x + m.row[1].y + m.row[2].z; }

static light_screen screen_of(const hl_light_texture *texture) {
  return (light_screen){{texture->pixels, texture->width, texture->height},
                        vec3_of(texture->screen_center),
                        vec3_of(texture->screen_right),
                        vec3_of(texture->screen_up)};
}

light_source hl_light_source(const hl_light *light, const hl_render_settings *settings, vec3 content) {
  light_source source = {.parallel = hl_light_kind(light)->parallel,
                         .content = content,
                         .shape = hl_light_shape(light),
                         .screen = screen_of(&light->texture),
                         .emission = {light->emission.pixels, light->emission.width, light->emission.height}};
  source.shadows = light->shadows == HL_SHADOWS_DEFAULT ? settings->shadows : light->shadows;
  source.soft_method = settings->soft_method;
  if (source.parallel) {
    source.direction = vec3_normalise(source.shape.direction);
  } else {
    source.position = source.shape.centre;
    vec3 way = vec3_subtract(source.screen.picture.pixels != NULL ? source.screen.center : content,
                             source.position);
    if (source.shape.kind->cone) way = source.shape.direction;
    source.direction = vec3_length(way) > 0 ? vec3_normalise(way) : (vec3){0, 0, 1};
  }
  source.spread = source.shape.kind->spread(&source.shape, source.direction);
  double distance = source.parallel ? 1 : vec3_length(vec3_subtract(content, source.position));
  if (source.shadows == HL_SHADOWS_SOFT && !(trace(source.spread) > POINT_LIKE * distance * distance))
    source.shadows = HL_SHADOWS_HARD;
  return source;
}

light_source hl_light_in_sector(const light_source *whole, const light_sectors *sectors, int sector) {
  light_source source = *whole;
  source.sectors = sectors;
  source.sector = sector;
  source.direction = sectors->axis[sector];
  double distance = vec3_length(vec3_subtract(whole->content, whole->position));
  source.content = vec3_add(whole->position, vec3_scale(source.direction, distance > 0 ? distance : 1));
  source.spread = whole->shape.kind->spread(&whole->shape, source.direction);
  return source;
}

/* ---- sectors ---- */

/* Finds the axes of the sectors into which the rays of a light within the content are divided: three at the
 * angle phi to the eye's direction, and three at this angle to the opposite direction, turned by 60 degrees.
 * For phi = 54.7 degrees, the sectors' axes are the axes of an octahedron, seen at a right angle to a face.
 * For phi = 45 degrees every direction lies within 59 degrees of an axis. Wide pictures need axes closer to
 * the eye's direction, so that their corners' rays still cross the sheets. */
light_sectors hl_light_sectors(vec3 eye_direction, double widest) {
  const double usual = 45 * HL_PI / 180, flattest = 75 * HL_PI / 180, closest = 15 * HL_PI / 180;
  double phi = fmax(fmin(usual, flattest - widest), closest);
  vec3 u = vec3_perpendicular(eye_direction), v = vec3_cross(eye_direction, u);
  light_sectors sectors;
  for (int i = 0; i < LIGHT_SECTORS; i++) {
    double turn = i * HL_PI / 3, along = i % 2 == 0 ? hl_cos(phi) : -hl_cos(phi);
    vec3 across = vec3_add(vec3_scale(u, hl_cos(turn)), vec3_scale(v, hl_sin(turn)));
    sectors.axis[i] = vec3_add(vec3_scale(eye_direction, along), vec3_scale(across, hl_sin(phi)));
  }
  /* A direction at a right angle to the eye's direction, midway between two axes, has the cosine cos(30
   * degrees) sin(phi) with these axes. For every direction, the cosine of the angle to the nearest axis is at
   * least 0.84 times this number (tested with 200,000 directions, phi from 15 to 45 degrees). A sector ends a
   * little farther from its axis, at 0.7 times this cosine, so that sectors fade into each other. */
  sectors.least = 0.7 * hl_cos(HL_PI / 6) * hl_sin(phi);
  return sectors;
}

sector_fraction hl_sector_fraction(const light_sectors *sectors, int sector) {
  sector_fraction fraction = {.count = sectors == 0 ? 0 : LIGHT_SECTORS, .sector = sector};
  for (int i = 0; i < fraction.count; i++) vec3_store(fraction.axis[i], sectors->axis[i]);
  fraction.least = fraction.count == 0 ? 0 : (float)sectors->least;
  return fraction;
}

/* ---- the cone of a spot light ---- */

light_cone hl_light_cone(const light_source *source, vec3 content, double pixel) {
  const light_shape *shape = &source->shape;
  light_cone cone = {.scale = 0};
  if (!shape->kind->cone) return cone;
  double distance = vec3_length(vec3_subtract(content, source->position));
  double sharpest = distance > pixel ? pixel / distance : 1,
         middle = shape->cone_half_angle - shape->cone_edge / 2, edge = fmax(shape->cone_edge, sharpest);
  double outer = hl_cos(fmin(middle + edge / 2, HL_PI)), full = hl_cos(fmax(middle - edge / 2, 0));
  vec3_store(cone.axis, vec3_normalise(shape->direction));
  cone.outer = (float)outer;
  cone.scale = (float)(1 / (full - outer));
  return cone;
}

/* ---- bounds of what is lit, seen from the light ---- */

static bool bound_screen(const view *view, const light_source *source, double low[2], double high[2]) {
  low[0] = low[1] = INFINITY;
  high[0] = high[1] = -INFINITY;
  for (int corner = 0; corner < 4; corner++) {
    vec3 at = vec3_add(source->screen.center, vec3_scale(source->screen.right, corner & 1 ? 1 : -1));
    double uv[2];
    if (!hl_view_project(view, vec3_add(at, vec3_scale(source->screen.up, corner & 2 ? 1 : -1)), uv))
      return false;
    for (int axis = 0; axis < 2; axis++) {
      low[axis] = fmin(low[axis], uv[axis]);
      high[axis] = fmax(high[axis], uv[axis]);
    }
  }
  return true;
}

/* Finds bounds, along both axes of a view, of the part of the view's picture that a light's cone lights.
 * Derived, for one axis: take the planes through the light that contain the view's other axis, and let phi be
 * the angle between such a plane and the view's normal n. Such a plane touches the light's cone of half angle
 * a where r sin(psi - phi) = +- sin a. Here r and psi are the length and the angle of the cone's axis,
 * projected onto the plane of n and the first axis. The view's corner, du and dv must be n and the two axes,
 * as unit vectors at right angles. */
static bool bound_cone(const view *view, const light_source *source, double low[2], double high[2]) {
  const vec3 axes[2] = {view->du, view->dv};
  vec3 cone = vec3_normalise(source->shape.direction);
  double sine = hl_sin(source->shape.cone_half_angle);
  for (int i = 0; i < 2; i++) {
    double along = vec3_dot(cone, axes[i]), ahead = vec3_dot(cone, view->corner);
    double r = hl_hypot(along, ahead), psi = hl_atan2(along, ahead);
    if (!(r > sine)) return false;
    double reach = hl_asin(sine / r);
    if (psi - reach <= -HL_PI / 2 || psi + reach >= HL_PI / 2) return false;
    low[i] = hl_tan(psi - reach);
    high[i] = hl_tan(psi + reach);
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
    double reach = hl_tan(hl_acos(source->sectors->least));
    cut((double[2]){-reach, -reach}, (double[2]){reach, reach}, low, high);
  }
  if (source->shadows != HL_SHADOWS_HARD)
    /* Matter outside the lit region casts penumbrae into the lit region. So the bounds of soft shadows are
     * not reduced to the light's cone and screen. */
    return;
  if (source->screen.picture.pixels != NULL && bound_screen(view, source, lit_low, lit_high))
    cut(lit_low, lit_high, low, high);
  if (source->shape.kind->cone && bound_cone(view, source, lit_low, lit_high))
    cut(lit_low, lit_high, low, high);
}
