/* analytic/sheets_phase.c - media under wide lights and skies: the mean of Henyey and Greenstein's phase
 * function over the light, by the renderer and the reference. */
#include <stdlib.h>

#include "../asserts.h"
#include "reference_stage.h"

enum { SIDE = 4, PIXELS = SIDE * SIDE, MIDDLE = SIDE / 2 * SIDE + SIDE / 2, ANGLES = 20, STEPS = 100 };

/* Opens a scene of a small cube of thin even matter around the origin, seen along -z without ambient light.
 * The scene's one light casts no shadows. */
static hl_scene_volume *open_stage(stage *set, double anisotropy) {
  stage_open(set);
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.height = 0.2;
  set->scene.render.shadows = HL_SHADOWS_OFF;
  for (int c = 0; c < 3; c++) set->scene.ambient[c] = 0;
  hl_scene_volume *volume = stage_add_grid(set, (size_t[3]){4, 4, 4}, (double[3]){0.5, 0.5, 0.5},
                                           (vec3){-1, -1, -1}, NULL);
  stage_set_opacity(set, volume, 0.1, 1);
  volume->shading = HL_SHADING_NONE;
  volume->anisotropy = anisotropy;
  stage_look(set, (vec3){0, 0, 30}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
  return volume;
}

/* Returns the direction to light number k. The angle counts from the direction in which the light would shine
 * straight into the eye. */
static vec3 at_angle(int k) {
  double angle = (k < ANGLES / 2 ? 5.0 * k : 50 + 13 * (k - ANGLES / 2)) * HL_PI / 180;
  return (vec3){0.6 * sin(angle), 0.8 * sin(angle), -cos(angle)};
}

/* Returns the phase function for light from a direction that is scattered into the eye at +z. */
static double phase(double g, vec3 towards) {
  vec3 unit = vec3_normalise(towards);
  return (1 - g * g) / pow(1 + g * g + 2 * g * unit.z, 1.5);
}

/* Returns the light from the middle of the cube, divided by the light of a cube that scatters evenly. */
static double measure(void (*add_light)(stage *set, int k), int k, double g, bool reference) {
  static float pixels[PIXELS * 4];
  double sent[2];
  for (int scattered = 0; scattered < 2; scattered++) {
    stage set;
    (void)open_stage(&set, scattered ? g : 0);
    add_light(&set, k);
    stage_render_by(&set, reference, pixels);
    sent[scattered] = (double)pixels[4 * MIDDLE];
    stage_close(&set);
  }
  assert_true(sent[0] > 0.01);
  return sent[1] / sent[0];
}

/* ---- parallel lights ---- */

static double diameter; /* the diameter of the lights of add_sun(), in degrees */

static void add_sun(stage *set, int k) {
  stage_add_directional(set, vec3_scale(at_angle(k), -1))->angular_diameter_deg = diameter;
}

/* Returns the mean of the phase function p over a cone, from rings around the cone's axis that are weighted
 * by their solid angles. Rings are narrower near the axis, where p may be sharp. */
static double mean_over_cone(double g, vec3 axis, double half) {
  vec3 u = vec3_perpendicular(axis), v = vec3_cross(axis, u);
  double sum = 0;
  for (int i = 0; i < STEPS; i++)
    for (int j = 0; j < STEPS; j++) {
      double part = (i + 0.5) / STEPS, cosine = 1 - (1 - cos(half)) * part * part;
      double turn = 2 * HL_PI * (j + 0.5) / STEPS;
      vec3 across = vec3_add(vec3_scale(u, cos(turn)), vec3_scale(v, sin(turn)));
      sum += 2 * part *
             phase(g, vec3_add(vec3_scale(axis, cosine), vec3_scale(across, sqrt(1 - cosine * cosine))));
    }
  return sum / (STEPS * STEPS);
}

/* At twenty angles, the picture has the mean of the phase function over the light's cone. */
static void test_mean_over_a_cone(void **state) {
  (void)state;
  static const double diameters[] = {0.5, 20, 60, 120}, anisotropies[] = {0.5, 0.8, 0.95, -0.6};
  for (int k = 0; k < 4 * 4 * ANGLES; k++) {
    double g = anisotropies[k % 4];
    vec3 towards = at_angle(k / 16);
    diameter = diameters[k / 4 % 4];
    double mean = mean_over_cone(g, towards, diameter * HL_PI / 360);
    assert_near(measure(add_sun, k / 16, g, false) / mean, 1, 0.002);
    if (k / 16 % 3 == 0) assert_near(measure(add_sun, k / 16, g, true) / mean, 1, 0.002);
  }
}

/* ---- near lights ---- */

typedef enum near_shape { SPHERE, DISK, SQUARE, LONG_RECT, TILTED_RECT, POLYGON, SHAPES } near_shape;

static near_shape shape;
static double size; /* the size of the lights of add_near() */
static const double DISTANCE = 200;

/* Finds the axes of the light's plane. The axes have the length `size`, and lie across the way to the light.
 * Some shapes are tilted.
 */
static void axes_at(int k, vec3 *u, vec3 *v) {
  vec3 way = at_angle(k);
  *u = vec3_scale(vec3_perpendicular(way), size);
  *v = vec3_cross(way, *u);
  if (shape == TILTED_RECT || shape == POLYGON)
    *v = vec3_add(vec3_scale(*v, cos(0.7)), vec3_scale(way, size * sin(0.7)));
  if (shape == LONG_RECT) *v = vec3_scale(*v, 0.3);
}

static void store(double to[3], vec3 v) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }

static void add_near(stage *set, int k) {
  static double corners[4][3];
  vec3 u, v, place = vec3_scale(at_angle(k), DISTANCE);
  axes_at(k, &u, &v);
  hl_light *light = stage_add_point(set, place);
  light->radius = size / 2;
  if (shape == SPHERE) return;
  light->type = shape == DISK ? HL_LIGHT_DISK : shape == POLYGON ? HL_LIGHT_POLYGON : HL_LIGHT_RECT;
  store(light->edge1, u);
  store(light->edge2, v);
  store(light->normal, vec3_cross(u, v));
  for (int i = 0; i < 4; i++) {
    double s = i == 0 || i == 3 ? -0.5 : 0.5, t = i < 2 ? -0.5 : 0.5;
    store(corners[i], vec3_add(place, vec3_add(vec3_scale(u, s), vec3_scale(v, t))));
  }
  light->vertices = (const double(*)[3])corners;
  light->vertex_count = 4;
}

/* Returns the mean of the phase function over points that cover the light evenly. */
static double mean_over_shape(double g, int k) {
  vec3 u, v, place = vec3_scale(at_angle(k), DISTANCE);
  double sum = 0;
  axes_at(k, &u, &v);
  for (int i = 0; i < STEPS; i++)
    for (int j = 0; j < STEPS; j++) {
      double s = (i + 0.5) / STEPS, t = (j + 0.5) / STEPS, x = s - 0.5, y = t - 0.5;
      if (shape == SPHERE || shape == DISK) {
        x = 0.5 * sqrt(s) * cos(2 * HL_PI * t);
        y = 0.5 * sqrt(s) * sin(2 * HL_PI * t);
      }
      sum += phase(g, vec3_add(place, vec3_add(vec3_scale(u, x), vec3_scale(v, y))));
    }
  return sum / (STEPS * STEPS);
}

/* The renderer takes parts of a light as round caps, so that the phase function deviates by up to the
 * fractions `bars` (for g = 0.5 and 0.8). The lights' widths are half and a third of their distance. The
 * reference uses points on the light itself. */
static void test_mean_over_near_lights(void **state) {
  (void)state;
  static const double bars[SHAPES][2] = {{0.002, 0.004}, {0.002, 0.022}, {0.002, 0.006},
                                         {0.002, 0.004}, {0.004, 0.01},  {0.003, 0.01}};
  double most[SHAPES][2] = {{0}}, most_reference = 0;
  for (int k = 0; k < SHAPES * ANGLES; k++) {
    size = k % 4 < 2 ? 100 : 65;
    double g = k % 2 ? 0.8 : 0.5;
    int angle = k % ANGLES / 2 * 2;
    shape = (near_shape)(k / ANGLES);
    double mean = mean_over_shape(g, angle), *at = &most[shape][k % 2];
    *at = fmax(*at, fabs(measure(add_near, angle, g, false) / mean - 1));
    if (angle % 4 == 0)
      most_reference = fmax(most_reference, fabs(measure(add_near, angle, g, true) / mean - 1));
  }
  for (int i = 0; i < 2 * SHAPES; i++) assert_true(most[i / 2][i % 2] < bars[i / 2][i % 2]);
  assert_true(most_reference < 0.01);
}

/* A point light has no extent, so that the picture has the phase function's value for the light's
 * direction. */
static void test_points_stay_points(void **state) {
  (void)state;
  static float pixels[2][PIXELS * 4];
  for (int wide = 0; wide < 2; wide++) {
    stage set;
    (void)open_stage(&set, 0.8);
    stage_add_directional(&set, (vec3){0.1, 0.2, 1});
    if (wide) stage_add_directional(&set, (vec3){0, 0, 1})->angular_diameter_deg = 30;
    if (wide) set.lights[1].intensity = 0;
    stage_render_sheets(&set, pixels[wide]);
    stage_close(&set);
  }
  assert_memory_equal(pixels[0], pixels[1], sizeof pixels[0]);
}

/* ---- the sky ---- */

static void add_half_sky(stage *set, int k) {
  set->scene.sky.type = HL_SKY_UNIFORM;
  set->scene.sky.hemisphere = 1;
  store(set->scene.sky.up, at_angle(k));
}

/* Under half of an even sky, the picture has the mean of the phase function p over this half, even if the
 * lobe points away from the bright half and p is small there. The sky is cut into squares, so that p deviates
 * by up to the fractions `bars`. */
static void test_mean_over_half_a_sky(void **state) {
  (void)state;
  static const double anisotropies[] = {0.5, 0.8, -0.6}, bars[] = {0.015, 0.045, 0.02};
  for (int k = 0; k < 3 * ANGLES; k++) {
    double g = anisotropies[k % 3], mean = mean_over_cone(g, at_angle(k / 3), HL_PI / 2);
    assert_near(measure(add_half_sky, k / 3, g, false) / mean, 1, bars[k % 3]);
  }
}

/* ---- scattered again ---- */

enum { NARROW = 48 };

/* A wide light before a thin cube gives the mean of narrow lights over its cone. The mean is the same for
 * light that is scattered more than once, for which the first phase function has g^2 in place of g. */
static void test_scattered_again(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  double whole = 0, parts = 0;
  for (int i = -1; i < NARROW; i++) {
    stage set;
    hl_scene_volume *volume = open_stage(&set, 0.8);
    set.scene.render.shadows = HL_SHADOWS_HARD;
    stage_set_opacity(&set, volume, 0.5, 1);
    volume->multiple_scattering = 1;
    double cosine = 1 - (1 - cos(HL_PI / 6)) * (i + 0.5) / NARROW, turn = i * HL_PI * (3 - sqrt(5)),
           sine = sqrt(1 - cosine * cosine);
    vec3 way = i < 0 ? (vec3){0, 0, 1} : (vec3){sine * cos(turn), sine * sin(turn), cosine};
    stage_add_directional(&set, way)->angular_diameter_deg = i < 0 ? 60 : 0;
    stage_render_sheets(&set, pixels);
    *(i < 0 ? &whole : &parts) += (double)pixels[4 * MIDDLE];
    stage_close(&set);
  }
  assert_near(whole / (parts / NARROW), 1, 0.02);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_mean_over_a_cone),   cmocka_unit_test(test_mean_over_near_lights),
      cmocka_unit_test(test_points_stay_points), cmocka_unit_test(test_mean_over_half_a_sky),
      cmocka_unit_test(test_scattered_again),
  };
  return cmocka_run_group_tests_name("sheets_phase", tests, NULL, NULL);
}
