/* unit/sky_suns.c - the suns in images of skies: disks that are painted are found again, no light is lost,
 * and images without suns are not changed. */
#include <stdlib.h>
#include <string.h>

#include "../asserts.h"
#include "scene/light/sky.h"
#include "scene/scene.h"

enum { WIDTH = 512, HEIGHT = 256, PIXELS = WIDTH * HEIGHT };

static const double DEGREE = HL_PI / 180;

static float pixels[PIXELS * 3];

typedef struct disk {
  double elevation, turn, radius; /* degrees. turn: from the image's middle column to the right. */
  double radiance[3];
} disk;

static vec3 direction_at(double elevation, double turn) {
  return (vec3){cos(elevation * DEGREE) * sin(turn * DEGREE), cos(elevation * DEGREE) * cos(turn * DEGREE),
                sin(elevation * DEGREE)};
}

static vec3 direction_of_pixel(double row, double column) {
  return direction_at(90 - row * 180 / HEIGHT, (column / WIDTH - 0.5) * 360);
}

static void paint_even(double r, double g, double b) {
  const double color[3] = {r, g, b};
  for (int i = 0; i < 3 * PIXELS; i++) pixels[i] = (float)color[i % 3];
}

/* Paints an even disk. A pixel's colour changes by the fraction of it that the disk covers. */
static void paint(const disk *of) {
  enum { SUB = 24 };
  vec3 middle = direction_at(of->elevation, of->turn);
  for (int p = 0; p < PIXELS; p++) {
    int inside = 0;
    double cosine = vec3_dot(middle, direction_of_pixel(p / WIDTH + 0.5, p % WIDTH + 0.5));
    if (cosine < cos((of->radius + 2) * DEGREE)) continue;
    for (int s = 0; s < SUB * SUB; s++)
      inside += vec3_dot(middle, direction_of_pixel(p / WIDTH + (s / SUB + 0.5) / SUB,
                                                    p % WIDTH + (s % SUB + 0.5) / SUB)) >=
                cos(of->radius * DEGREE);
    double part = inside / (double)(SUB * SUB);
    for (int c = 0; c < 3; c++)
      pixels[3 * p + c] = (float)(of->radiance[c] * part + (double)pixels[3 * p + c] * (1 - part));
  }
}

static hl_sky image_of(const float *from) {
  hl_scene_description scene;
  hl_scene_description_defaults(&scene);
  scene.sky.type = HL_SKY_IMAGE;
  scene.sky.pixels = from;
  scene.sky.width = WIDTH;
  scene.sky.height = HEIGHT;
  return scene.sky;
}

static sky_suns find(hl_context *context, const hl_sky *sky) {
  sky_suns found;
  assert_int_equal(hl_suns_find(context, sky, &found, NULL), HL_OK);
  return found;
}

static double angle_between(vec3 a, vec3 b) {
  return 2 * asin(fmin(vec3_length(vec3_subtract(a, b)) / 2, 1));
}

static void check_disk(const sky_sun *sun, const disk *of, const double around[3]) {
  double solid_angle = 2 * HL_PI * (1 - cos(of->radius * DEGREE)), pixel = HL_PI / HEIGHT;
  assert_near(angle_between(sun->towards, direction_at(of->elevation, of->turn)), 0, 0.05 * pixel);
  /* derived: the box and the tent of a pixel have the variances 1/12 and 1/6 along its sides; the variances
   * of a disk along two axes add up to half of the square of its radius */
  double side = pixel * cos(of->elevation * DEGREE), own = of->radius * DEGREE;
  double radius = sqrt(own * own + (pixel * pixel + side * side) / 2);
  assert_near(sun->half_angle / radius, 1, 0.012);
  for (int c = 0; c < 3; c++)
    assert_near(sun->irradiance[c] / ((of->radiance[c] - around[c]) * solid_angle), 1, 0.004);
}

static const disk DISKS[] = {{35, 20, 4, {300, 280, 250}},  {-20, 179.7, 2, {2000, 1500, 900}},
                             {84, 120, 7, {500, 500, 500}}, {-62, -100, 8, {150, 200, 100}},
                             {-35, 60, 11, {60, 90, 60}},   {10.1, -0.2, 1, {9e4, 8e4, 7e4}},
                             {0.3, 90, 6, {200, 200, 300}}};
enum { DISK_COUNT = sizeof DISKS / sizeof *DISKS };

/* One disk on an even sky, at poles and across the image's edge: its direction, width and light are found.
 * The rest of the image is the even sky to the last bit. */
static void test_disk(void **state) {
  static const double around[3] = {0.25, 0.5, 1};
  hl_context *context = *state;
  for (int i = 0; i < DISK_COUNT; i++) {
    paint_even(around[0], around[1], around[2]);
    paint(&DISKS[i]);
    hl_sky sky = image_of(pixels);
    sky_suns found = find(context, &sky);
    assert_int_equal(found.count, 1);
    check_disk(&found.suns[0], &DISKS[i], around);
    for (int p = 0; p < 3 * PIXELS; p++) assert_true((double)found.rest[p] == around[p % 3]);
    hl_suns_release(context, &found);
  }
}

/* Three disks, one of them close to another. The brightest is found first, however often they are searched
 * for. */
static void test_several(void **state) {
  static const disk disks[] = {
      {40, 30, 2, {900, 900, 900}}, {40, 40, 2, {800, 800, 800}}, {-10, -120, 5, {200, 100, 50}}};
  static const double around[3] = {0, 0, 0};
  hl_context *context = *state;
  paint_even(0, 0, 0);
  for (int i = 2; i >= 0; i--) paint(&disks[i]);
  hl_sky sky = image_of(pixels);
  for (int round = 0; round < 2; round++) {
    sky_suns found = find(context, &sky);
    assert_int_equal(found.count, 3);
    for (int i = 0; i < 3; i++) check_disk(&found.suns[i], &disks[i], around);
    hl_suns_release(context, &found);
  }
}

/* ---- bright spots that are no suns ---- */

static void expect_none(hl_context *context, const hl_sky *sky) {
  sky_suns found = find(context, sky);
  assert_int_equal(found.count, 0);
  assert_null(found.rest);
}

static void test_none(void **state) {
  static const disk wide = {20, 50, 17, {40, 40, 40}}, faint = {20, 50, 3, {12, 12, 12}},
                    below = {-30, 0, 4, {200, 200, 200}};
  hl_context *context = *state;
  hl_sky sky = image_of(pixels);
  paint_even(1, 1, 1);
  expect_none(context, &sky);
  paint(&faint); /* a hundredth of the sky's light */
  expect_none(context, &sky);
  paint(&wide);
  expect_none(context, &sky);
  paint_even(0, 0, 0);
  expect_none(context, &sky);
  for (int p = 0; p < PIXELS; p++) { /* a bright glow, as wide as a quarter of the sky */
    double cosine = vec3_dot(direction_at(30, -70), direction_of_pixel(p / WIDTH + 0.5, p % WIDTH + 0.5));
    for (int c = 0; c < 3; c++) pixels[3 * p + c] = (float)(0.1 + 30 * exp(8 * (cosine - 1)));
  }
  expect_none(context, &sky);
  paint_even(1, 1, 1);
  for (int p = 7; p < PIXELS; p += 1301) /* single bright pixels, as in a noisy picture */
    for (int c = 0; c < 3; c++) pixels[3 * p + c] = 400;
  expect_none(context, &sky);
  paint_even(1, 1, 1);
  paint(&below);
  sky.hemisphere = 1;
  expect_none(context, &sky);
  sky.type = HL_SKY_GRADIENT;
  expect_none(context, &sky);
}

/* ---- conservation ---- */

/* The integral of the radiance over all directions. */
static void integrate(const hl_sky *sky, double sum[3]) {
  enum { SUB = 4 };
  const sky_axes axes = hl_sky_axes(sky);
  for (int c = 0; c < 3; c++) sum[c] = 0;
  for (int i = 0; i < SUB * HEIGHT; i++)
    for (int j = 0; j < SUB * WIDTH; j++) {
      double elevation = 90 - (i + 0.5) * 180 / (SUB * HEIGHT),
             turn = ((j + 0.5) / (SUB * WIDTH) - 0.5) * 360, radiance[3];
      vec3 own = direction_at(elevation, turn);
      vec3 world = vec3_add(vec3_add(vec3_scale(axes.right, own.x), vec3_scale(axes.middle, own.y)),
                            vec3_scale(axes.up, own.z));
      hl_sky_radiance(sky, &axes, world, radiance);
      double angle = HL_PI / (SUB * HEIGHT);
      for (int c = 0; c < 3; c++) sum[c] += radiance[c] * cos(elevation * DEGREE) * angle * angle;
    }
}

/* An uneven sky with a glow around one sun, and another sun half below the horizon. The rest of the image and
 * the suns' lights together send a medium the light of the image, 4 pi times their colour, in each channel.
 */
static void test_nothing_is_lost(void **state) {
  static const disk high = {35, 20, 1, {4e4, 3e4, 2e4}}, low = {0.4, -100, 5, {100, 200, 300}};
  hl_context *context = *state;
  for (int p = 0; p < PIXELS; p++) {
    double cosine = vec3_dot(direction_at(35, 20), direction_of_pixel(p / WIDTH + 0.5, p % WIDTH + 0.5));
    unsigned noise = (unsigned)p * 2654435761u;
    for (int c = 0; c < 3; c++)
      pixels[3 * p + c] = (float)(0.5 + (noise >> 16) / 65536.0 + (c + 1) * 40 * exp(600 * (cosine - 1)));
  }
  paint(&high);
  paint(&low);
  for (int hemisphere = 0; hemisphere < 2; hemisphere++) {
    hl_sky sky = image_of(pixels);
    double whole[3], rest[3];
    sky.hemisphere = hemisphere;
    sky.rotation_deg = 77;
    sky.strength = 0.7;
    sky.up[0] = 0.4, sky.up[1] = -0.5;
    sky_suns found = find(context, &sky);
    assert_true(found.count >= 2);
    integrate(&sky, whole);
    sky.pixels = found.rest;
    integrate(&sky, rest);
    for (int c = 0; c < 3; c++) {
      double sum = rest[c];
      for (int i = 0; i < found.count; i++) {
        hl_light light = hl_sun_light(&sky, &found.suns[i]);
        sum += light.color[c] * light.intensity * hl_sun_part_of_media(&found.suns[i]) * 4 * HL_PI;
      }
      assert_true(rest[c] < 0.7 * whole[c]);
      assert_near(sum / whole[c], 1, 1e-4);
    }
    hl_suns_release(context, &found);
  }
}

/* ---- lights ---- */

/* The light comes from where the turned image is bright. A surface that faces it gets the disk's radiance /
 * pi times the integral of the cosine, pi sin^2 a. */
static void test_light(void **state) {
  hl_context *context = *state;
  for (int i = 0; i < DISK_COUNT; i++) {
    paint_even(0, 0, 0);
    paint(&DISKS[i]);
    hl_sky sky = image_of(pixels);
    double radiance[3], sine = sin(DISKS[i].radius * DEGREE);
    sky.rotation_deg = 50 * i;
    sky.strength = 1.5;
    sky.up[i % 3] = -0.8;
    sky_suns found = find(context, &sky);
    assert_int_equal(found.count, 1);
    hl_light light = hl_sun_light(&sky, &found.suns[0]);
    const sky_axes axes = hl_sky_axes(&sky);
    hl_sky_radiance(&sky, &axes, vec3_scale(vec3_of(light.direction), -1), radiance);
    for (int c = 0; c < 3; c++) {
      assert_near(radiance[c] / (1.5 * DISKS[i].radiance[c]), 1, 0.01);
      assert_near(light.color[c] * light.intensity / (1.5 * DISKS[i].radiance[c] * sine * sine), 1, 0.005);
    }
    hl_suns_release(context, &found);
  }
}

/* Images of very few pixels are accepted. */
static void test_small_images(void **state) {
  static const int sizes[][2] = {{1, 1}, {2, 1}, {1, 2}, {3, 2}, {5, 4}, {16, 8}, {64, 1}, {1, 64}};
  hl_context *context = *state;
  for (size_t i = 0; i < 2 * sizeof sizes / sizeof *sizes; i++) {
    hl_sky sky = image_of(pixels);
    sky.width = sizes[i / 2][0];
    sky.height = sizes[i / 2][1];
    sky.hemisphere = i % 2;
    memset(pixels, 0, sizeof pixels);
    pixels[1] = 1e6f;
    sky_suns found = find(context, &sky);
    hl_suns_release(context, &found);
  }
}

static int open_context(void **state) {
  hl_context *context = NULL;
  int status = hl_context_create(NULL, &context, NULL) == HL_OK ? 0 : -1;
  *state = context;
  return status;
}

static int close_context(void **state) {
  hl_context_destroy(*state);
  return 0;
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_disk),
      cmocka_unit_test(test_several),
      cmocka_unit_test(test_none),
      cmocka_unit_test(test_light),
      cmocka_unit_test(test_nothing_is_lost),
      cmocka_unit_test(test_small_images),
  };
  return cmocka_run_group_tests(tests, open_context, close_context);
}
