/* analytic/reference_sky.c - the reference's light from all directions, against closed forms. The receiver is
 * a small square that faces the eye at (0, 0, 100) or is turned away from the eye, or a cloud of haze that
 * casts no shadow. */
#include <stdlib.h>
#include <string.h>

#include "../asserts.h"
#include "reference_stage.h"

typedef struct sky_stage {
  stage set;
  hl_scene_mesh meshes[3];
  double lit[4]; /* RGB and alpha of the middle pixel; the colour is divided by alpha */
} sky_stage;

/* Opens a scene with a uniform sky and without lights. A transparent volume sets the size of voxels. */
static void open_sky(sky_stage *all) {
  stage_open(&all->set);
  all->set.scene.width = all->set.scene.height = 1;
  all->set.scene.camera.height = 0.5;
  all->set.scene.meshes = all->meshes;
  all->set.scene.sky.type = HL_SKY_UNIFORM;
}

static void close_sky(sky_stage *all) {
  for (size_t m = 0; m < all->set.scene.mesh_count; m++) hl_mesh_release(all->meshes[m].mesh);
  stage_close(&all->set);
}

/* Adds a rectangle around a centre. u, v: the vectors from the centre to the middles of two edges. */
static hl_scene_mesh *add_quad(sky_stage *all, vec3 centre, vec3 u, vec3 v) {
  hl_scene_mesh *mesh = &all->meshes[all->set.scene.mesh_count++];
  hl_scene_mesh_defaults(mesh);
  mesh->mesh = stage_make_quad(&all->set, centre, u, v);
  mesh->material = (hl_material){.diffuse = 1};
  for (int c = 0; c < 3; c++) mesh->color[c] = 1;
  return mesh;
}

/* Adds the receiver of most tests, a square at the origin that faces the eye. */
static hl_scene_mesh *add_square(sky_stage *all) {
  stage_set_opacity(&all->set, stage_add_box(&all->set, (vec3){-1, -1, 40}, (vec3){1, 1, 42}), 0, 1);
  return add_quad(all, (vec3){0, 0, 0}, (vec3){1, 0, 0}, (vec3){0, 1, 0});
}

/* Adds the receiver of the other tests, haze that hides nothing. */
static hl_scene_volume *add_haze(sky_stage *all) {
  hl_scene_volume *haze = stage_add_box(&all->set, (vec3){-1, -1, -0.1}, (vec3){1, 1, 0.1});
  stage_set_opacity(&all->set, haze, 0.01, 1);
  haze->casts_shadow = 0;
  return haze;
}

static void light(sky_stage *all) {
  float pixel[4];
  stage_render(&all->set, NULL, pixel);
  all->lit[3] = (double)pixel[3];
  for (int c = 0; c < 3; c++) all->lit[c] = (double)pixel[c] / (double)pixel[3];
}

static void set_color(double color[3], double r, double g, double b) {
  color[0] = r, color[1] = g, color[2] = b;
}

/* If nothing hides the sky, the square gets diffuse x radiance, and haze gets the radiance, whatever its
 * phase function is. */
static void test_open(void **state) {
  (void)state;
  for (int haze = 0; haze < 2; haze++) {
    sky_stage all;
    open_sky(&all);
    if (haze) add_haze(&all)->anisotropy = 0.4;
    else add_square(&all)->material.diffuse = 0.6;
    set_color(all.set.scene.sky.color, 0.5, 1, 2);
    all.set.scene.sky.strength = 1.5;
    light(&all);
    for (int c = 0; c < 3; c++)
      assert_near(all.lit[c], (haze ? 1 : 0.6) * 1.5 * all.set.scene.sky.color[c], 2e-3);
    close_sky(&all);
  }
}

/* A great plane below haze hides half of the sky, and a half plane hides a quarter. A half plane above the
 * square hides half of the square's light. A pane hides only the light that it absorbs. Surfaces that receive
 * no shadow get all light. */
static void test_planes(void **state) {
  (void)state;
  const struct {
    int haze;
    /* side: half of the plane's side; middle: the x of the plane's centre */
    double side, middle, opacity, expected;
  } cases[] = {{1, 1e5, 0, 1, 0.5}, {1, 1e5, 1e5, 1, 0.75}, {0, 1e5, 1e5, 1, 0.5}, {0, 1e5, 1e5, 0.4, 0.8}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    sky_stage all;
    open_sky(&all);
    if (cases[k].haze) add_haze(&all);
    else add_square(&all);
    hl_scene_mesh *plane = add_quad(&all, (vec3){cases[k].middle, 0, cases[k].haze ? -3 : 3},
                                    (vec3){cases[k].side, 0, 0}, (vec3){0, cases[k].side, 0});
    plane->visible = 0;
    plane->opacity = cases[k].opacity;
    light(&all);
    assert_near(all.lit[0], cases[k].expected, 0.012);
    if (!cases[k].haze) {
      all.meshes[0].receives_shadow = 0;
      light(&all);
      assert_near(all.lit[0], 1, 2e-3);
    }
    close_sky(&all);
  }
}

/* Returns E2(x), the integral of exp(-x / mu) over mu from 0 to 1, by the midpoint rule with 2000 steps. */
static double exponential_integral_2(double x) {
  double sum = 0;
  for (int i = 0; i < 2000; i++) sum += exp(-x / ((i + 0.5) / 2000)) / 2000;
  return sum;
}

/* In the middle of a wide slab of haze, the light is E2(tau) in each colour, where tau is the optical depth
 * of half of the slab in that colour. */
static void test_slab(void **state) {
  (void)state;
  sky_stage all;
  open_sky(&all);
  add_haze(&all);
  hl_scene_volume *slab = stage_add_box(&all.set, (vec3){-300, -300, -2}, (vec3){300, 300, 2});
  stage_set_opacity(&all.set, slab, 1 - exp(-0.4), 1);
  slab->visible = 0;
  set_color(slab->attenuation_color, 1, 0.5, 0);
  light(&all);
  for (int c = 0; c < 3; c++)
    assert_near(all.lit[c], exponential_integral_2(0.8 * slab->attenuation_color[c]), 3e-3);
  close_sky(&all);
}

/* In a closed box of panes, all light has passed one pane. */
static void test_inside(void **state) {
  (void)state;
  static const float corners[8][3] = {{-5, -5, -5}, {5, -5, -5}, {-5, 5, -5}, {5, 5, -5},
                                      {-5, -5, 5},  {5, -5, 5},  {-5, 5, 5},  {5, 5, 5}};
  static const uint32_t faces[12][3] = {{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                        {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 3, 7}, {1, 7, 5}};
  sky_stage all;
  open_sky(&all);
  add_haze(&all);
  hl_mesh_description d;
  hl_error error = {0};
  hl_mesh_description_defaults(&d);
  d.positions = corners, d.vertex_count = 8, d.triangles = faces, d.triangle_count = 12;
  hl_scene_mesh_defaults(&all.meshes[0]);
  assert_int_equal(hl_mesh_create(all.set.context, &d, &all.meshes[0].mesh, &error), HL_OK);
  all.set.scene.mesh_count = 1;
  all.meshes[0].opacity = 0.7;
  all.meshes[0].visible = 0;
  light(&all);
  assert_near(all.lit[1], 0.3, 1e-6);
  close_sky(&all);
}

/* The sky's radiance is h + (z - h) s above the horizon and h - (g - h) s below it, where s is the sine of
 * the elevation. By integration, a surface that faces the zenith gets h + 2/3 (z - h), a surface that faces
 * the ground h + 2/3 (g - h), and an upright surface h + 2 / (3 pi) (z + g - 2 h). Haze gets h + (z + g - 2
 * h) / 4. */
static void test_gradient(void **state) {
  (void)state;
  const double h = 0.4, z = 1, g = 0.1;
  const double expected[4] = {h + 2 * (z - h) / 3, h + 2 * (g - h) / 3, h + 2 / (3 * HL_PI) * (z + g - 2 * h),
                              h + (z + g - 2 * h) / 4};
  for (int k = 0; k < 4; k++) {
    sky_stage all;
    open_sky(&all);
    if (k < 3) add_square(&all);
    else add_haze(&all);
    hl_sky *sky = &all.set.scene.sky;
    sky->type = HL_SKY_GRADIENT;
    set_color(sky->zenith, z, z, z);
    set_color(sky->horizon, h, h, h);
    set_color(sky->ground, g, g, g);
    set_color(sky->up, k == 2 ? 7 : 0, 0, k == 1 ? -0.1 : k == 2 ? 0 : 3);
    light(&all);
    assert_near(all.lit[0], expected[k], 2e-3);
    close_sky(&all);
  }
}

/* The sky shines above the horizon alone. A surface that faces the zenith gets all light, an upright surface
 * and haze get half, and a surface that faces the ground gets nothing. Haze with a phase function, seen from
 * the zenith, gets (1 - g^2) / (2 g) ((1 + g^2)^-1/2 - 1 / (1 + g)). Derived: half the integral over mu from
 * 0 to 1 of the phase function at the cosine -mu. */
static void test_hemisphere(void **state) {
  (void)state;
  const double g = 0.6, back = (1 - g * g) / (2 * g) * (1 / sqrt(1 + g * g) - 1 / (1 + g));
  const double expected[5] = {1, 0.5, 0, 0.5, back};
  for (int k = 0; k < 5; k++) {
    sky_stage all;
    open_sky(&all);
    if (k < 3) add_square(&all);
    else add_haze(&all)->anisotropy = k == 4 ? g : 0;
    all.set.scene.sky.hemisphere = 1;
    set_color(all.set.scene.sky.up, k == 1 ? 1 : 0, 0, k == 2 ? -1 : k == 1 ? 0 : 1);
    light(&all);
    assert_near(all.lit[0], expected[k], 3e-3);
    close_sky(&all);
  }
}

enum { COLUMNS = 64, ROWS = 32 };

/* An image of the sky that is red right of its middle and green in its upper half. The image is blue up to an
 * eighth of its width from its middle column. The square faces +z; `up` and `rotation` turn the sky around
 * the square. */
static void test_image(void **state) {
  (void)state;
  static float pixels[ROWS][COLUMNS][3];
  for (int y = 0; y < ROWS; y++)
    for (int x = 0; x < COLUMNS; x++) {
      pixels[y][x][0] = x >= COLUMNS / 2;
      pixels[y][x][1] = y < ROWS / 2;
      pixels[y][x][2] = abs(2 * x + 1 - COLUMNS) < COLUMNS / 4;
    }
  /* The blue part is a lune of 45 degrees to either side of the image's middle. With the image's middle at
   * +z, the blue part gives the square the light sin 45 degrees. With the image's middle on the square's
   * horizon, the square gets the part of the lune above the horizon. */
  const double lune = sqrt(0.5), half = (1 - lune) / 2;
  /* In the first case the zenith is +z, and in the second case the ground is +z. In the third case the
   * image's middle is +z and its right is +x; in the fourth case the image is turned by half, so that its
   * middle is -z. In the last two cases the image is turned by 90 degrees to either side, so that its right
   * and then its left stands at +z. */
  const struct {
    double up[3], rotation, expected[3];
  } cases[] = {{{0, 0, 1}, 0, {0.5, 1, 0.25}},    {{0, 0, -1}, 90, {0.5, 0, 0.25}},
               {{0, -1, 0}, 0, {0.5, 0.5, lune}}, {{0, -1, 0}, 180, {0.5, 0.5, 0}},
               {{0, -1, 0}, 90, {1, 0.5, half}},  {{0, -1, 0}, -90, {0, 0.5, half}}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    sky_stage all;
    open_sky(&all);
    add_square(&all);
    hl_sky *sky = &all.set.scene.sky;
    sky->type = HL_SKY_IMAGE;
    sky->pixels = &pixels[0][0][0];
    sky->width = COLUMNS;
    sky->height = ROWS;
    memcpy(sky->up, cases[k].up, sizeof sky->up);
    sky->rotation_deg = cases[k].rotation;
    light(&all);
    for (int c = 0; c < 3; c++) assert_near(all.lit[c], cases[k].expected[c], 0.01);
    close_sky(&all);
  }
}

static void test_refused(void **state) {
  (void)state;
  sky_stage all;
  open_sky(&all);
  add_haze(&all);
  all.set.scene.sky.type = HL_SKY_IMAGE;
  stage_refused(&all.set, "/sky/file: is missing: name an image of the surroundings");
  all.set.scene.sky.type = HL_SKY_UNIFORM;
  all.set.scene.sky.color[1] = -1;
  stage_refused(&all.set, "/sky/color/1: -1 is negative: give linear RGB, each from 0 to 1e6");
  close_sky(&all);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_open),   cmocka_unit_test(test_planes),   cmocka_unit_test(test_slab),
      cmocka_unit_test(test_inside), cmocka_unit_test(test_gradient), cmocka_unit_test(test_hemisphere),
      cmocka_unit_test(test_image),  cmocka_unit_test(test_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
