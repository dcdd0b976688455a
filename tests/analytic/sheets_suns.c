/* analytic/sheets_suns.c - a sun in the image of a sky. The sun's light on surfaces and media, the width of
 * its shadow, and its part of the sky's layers are compared with closed forms and the reference. Pictures
 * without a sun stay the same. */
#include <stdlib.h>
#include <string.h>

#include "../asserts.h"
#include "reference_stage.h"

enum { SIDE = 16, PIXELS = SIDE * SIDE, WIDTH = 360, HEIGHT = 180 };

static const double DEGREE = HL_PI / 180, RADIUS = 3; /* degrees, of suns */

static float image[WIDTH * HEIGHT * 3];

/* Paints a sun of a radiance towards a direction, with `up` along z. The sky around it is even. */
static void paint(vec3 towards, double radiance, double around) {
  enum { SUB = 8 };
  vec3 middle = vec3_normalise(towards);
  for (int p = 0; p < WIDTH * HEIGHT; p++) {
    int inside = 0;
    for (int s = 0; s < SUB * SUB; s++) {
      double down = (p / WIDTH + (s / SUB + 0.5) / SUB) * DEGREE,
             turn = (p % WIDTH + (s % SUB + 0.5) / SUB - WIDTH / 2) * DEGREE;
      inside += vec3_dot(middle, (vec3){sin(down) * sin(turn), sin(down) * cos(turn), cos(down)}) >=
                cos(RADIUS * DEGREE);
    }
    double part = inside / (double)(SUB * SUB);
    for (int c = 0; c < 3; c++)
      image[3 * p + c] = (float)(radiance * (1 - 0.2 * c) * part + around * (1 + 0.2 * c) * (1 - part));
  }
}

static void open_sky(stage *set) {
  stage_open(set);
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.height = 24;
  set->scene.render.shadows = HL_SHADOWS_SOFT;
  set->scene.sky.type = HL_SKY_IMAGE;
  set->scene.sky.pixels = image;
  set->scene.sky.width = WIDTH;
  set->scene.sky.height = HEIGHT;
}

static double middle(const float *pixels, int channel) {
  const float *pixel = pixels + 4 * (SIDE / 2 * SIDE + SIDE / 2);
  return (double)pixel[channel] / (double)pixel[3];
}

/* ---- closed forms ---- */

static hl_scene_mesh quad(stage *set, vec3 centre, vec3 u, vec3 v) {
  hl_scene_mesh mesh;
  hl_scene_mesh_defaults(&mesh);
  mesh.mesh = stage_make_quad(set, centre, u, v);
  mesh.material = (hl_material){.diffuse = 1, .specular = 0.7, .shininess = 2};
  for (int c = 0; c < 3; c++) mesh.color[c] = 1;
  return mesh;
}

/* A sun of the half angle a at the angle b from the normal gives a white plane the light radiance / pi times
 * the integral of the cosine over the sun's disk, pi sin^2 a cos b. The plane has no highlight. */
static void test_surface(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  for (int i = 0; i < 4; i++) {
    double b = (10 + 20 * i) * DEGREE, sine = sin(RADIUS * DEGREE);
    stage set;
    open_sky(&set);
    paint((vec3){sin(b), 0.0, cos(b)}, 300, 0);
    hl_scene_mesh mesh = quad(&set, (vec3){0, 0, 0}, (vec3){90, 0, 0}, (vec3){0, 90, 0});
    set.scene.meshes = &mesh;
    set.scene.mesh_count = 1;
    stage_render_sheets(&set, pixels);
    for (int c = 0; c < 3; c++)
      assert_near(middle(pixels, c) / (300 * (1 - 0.2 * c) * sine * sine * cos(b)), 1, 0.006);
    hl_mesh_release(mesh.mesh);
    stage_close(&set);
  }
}

/* Returns the phase function for light from a direction that is scattered into the eye at +z. */
static double phase(double g, vec3 towards) {
  vec3 unit = vec3_normalise(towards);
  return (1 - g * g) / pow(1 + g * g + 2 * g * unit.z, 1.5);
}

/* Thin haze gets 1 / (4 pi) of the integral of the radiance, times the mean of its phase function over the
 * sun's disk. */
static void test_haze(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  static const double anisotropies[] = {0, 0.6, -0.5, 0.85};
  for (int i = 0; i < 4 * 3; i++) {
    double b = (30 + 60 * (i / 4)) * DEGREE, g = anisotropies[i % 4], mean = 0;
    stage set;
    open_sky(&set);
    paint((vec3){sin(b), 0, cos(b)}, 300, 0);
    hl_scene_volume *haze = stage_add_box(&set, (vec3){-8, -8, -8}, (vec3){8, 8, 8});
    stage_set_opacity(&set, haze, 1e-4, 1);
    haze->anisotropy = g;
    stage_render_sheets(&set, pixels);
    for (int k = 0; k < 100 * 100; k++) {
      double a = acos(1 - (1 - cos(RADIUS * DEGREE)) * (k / 100 + 0.5) / 100),
             turn = 2 * HL_PI * (k % 100) / 100;
      vec3 own = {sin(a) * cos(turn), sin(a) * sin(turn), cos(a)};
      mean += phase(g, (vec3){own.x * cos(b) + own.z * sin(b), own.y, own.z * cos(b) - own.x * sin(b)}) / 1e4;
    }
    double expected = 300 * (1 - cos(RADIUS * DEGREE)) / 2 * mean;
    for (int c = 0; c < 3; c++) assert_near(middle(pixels, c) / (expected * (1 - 0.2 * c)), 1, 0.008);
    stage_close(&set);
  }
}

/* A board stands 50 above a floor, below a sun at the zenith. Below the board's edge the floor gets half of
 * the sun's light. Beyond the penumbra, which is 50 tan a wide on either side, the floor gets all of the
 * sun's light or nothing. */
static void test_penumbra(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  const double height = 50, wide = height * tan(RADIUS * DEGREE);
  stage set;
  open_sky(&set);
  paint((vec3){0, 0, 1}, 300, 0);
  hl_scene_mesh meshes[2] = {quad(&set, (vec3){0, 0, -10}, (vec3){60, 0, 0}, (vec3){0, 60, 0}),
                             quad(&set, (vec3){-60, 0, height - 10}, (vec3){60, 0, 0}, (vec3){0, 60, 0})};
  meshes[1].visible = 0;
  set.scene.meshes = meshes;
  set.scene.mesh_count = 2;
  set.scene.camera.height = 16;
  stage_render_sheets(&set, pixels);
  double full = 300 * pow(sin(RADIUS * DEGREE), 2);
  for (int x = 0; x < SIDE; x++) {
    double at = x + 0.5 - SIDE / 2, part = (double)pixels[4 * (SIDE / 2 * SIDE + x)] / full;
    /* the expected light is the fraction of a disk's area on one side of a chord at -t (derived) */
    double t = fmin(fmax(at / wide, -1), 1);
    assert_near(part, 0.5 + (asin(t) + t * sqrt(1 - t * t)) / HL_PI, 0.04);
  }
  for (int m = 0; m < 2; m++) hl_mesh_release(meshes[m].mesh);
  stage_close(&set);
}

/* ---- the reference ---- */

static const hl_opacity_point OPACITY[2] = {{0.3, 0}, {0.7, 0.9}};

/* Opens a scene of a ball above a plate, as surfaces or as media, below a sun from the left. */
static void open_scene(stage *set, hl_shading shading) {
  open_sky(set);
  paint((vec3){-0.8, -0.3, 0.7}, 300, 0.3);
  hl_scene_volume *volume = stage_add_ball_and_plate(set, OPACITY);
  volume->transfer_function.unit_distance = shading == HL_SHADING_NONE ? 12 : 1;
  volume->shading = shading;
  volume->anisotropy = shading == HL_SHADING_NONE ? 0.7 : 0;
  volume->material = (hl_material){.diffuse = 1, .specular = 0.5, .shininess = 8};
  stage_set_color(set, volume, 0.9, 0.6, 0.4);
  stage_look(set, (vec3){30, -80, 50}, (vec3){0, 0, -2}, (vec3){0, 0, 1});
}

typedef struct picture {
  float pixels[PIXELS * 4], sky[PIXELS * 3], shadow[PIXELS * 3];
} picture;

static void render(stage *set, bool reference, picture *made) {
  hl_reference_options options;
  hl_reference_options_defaults(&options);
  options.light_points = 500;
  options.step = 0.5;
  const hl_layers wanted = {.struct_size = sizeof wanted, .sky = made->sky, .sky_shadow = made->shadow};
  stage_render_layers(set, reference ? &options : NULL, made->pixels, &wanted);
}

/* Returns the root mean square difference over the pixels in which the reference shows anything. The compared
 * layers are not divided by alpha. */
static double deviation(const picture *of, const picture *exact, bool shadow) {
  double sum = 0, count = 0;
  for (int i = 0; i < PIXELS * 3; i++) {
    double alpha = exact->pixels[i / 3 * 4 + 3], own = of->pixels[i / 3 * 4 + 3];
    if (alpha < 0.5) continue;
    double d = shadow ? (double)of->shadow[i] - (double)exact->shadow[i]
                      : of->sky[i] / own - exact->sky[i] / alpha;
    sum += d * d;
    count++;
  }
  assert_true(count > 180);
  return sqrt(sum / count);
}

/* The picture with suns is nearer to the reference's picture than the picture without suns. The reference
 * uses the sky's image without finding suns. The sky's layers, which contain the suns' light, are nearer to
 * the reference's layers, too. */
static void test_against_the_reference(void **state) {
  (void)state;
  static picture exact, with, without;
  /* [surfaces, media][light, shadow]; the greatest allowed deviations. At surfaces, the light of the sky and
   * of suns is looked up at the outside of the matter.
   */
  static const double bounds[2][2] = {{0.03, 0.045}, {0.006, 0.021}};
  for (int i = 0; i < 2; i++) {
    stage set;
    open_scene(&set, i == 0 ? HL_SHADING_PHONG : HL_SHADING_NONE);
    render(&set, true, &exact);
    render(&set, false, &with);
    set.scene.sky.suns = 0;
    render(&set, false, &without);
    for (int shadow = 0; shadow < 2; shadow++) {
      double found = deviation(&with, &exact, shadow);
      assert_near(found, 0, bounds[i][shadow]);
      assert_true(found < (i == 0 ? 0.95 : 0.3) * deviation(&without, &exact, shadow));
    }
    stage_close(&set);
  }
}

/* If there is no other light, the layer of the sky is the whole picture. If another light has other sheets,
 * the sum of the sky's layer and the other light's layer is the picture. */
static void test_layers(void **state) {
  (void)state;
  static picture made;
  static float light[PIXELS * 3];
  for (int i = 0; i < 2; i++) {
    stage set;
    open_scene(&set, HL_SHADING_PHONG);
    if (i == 1) stage_add_directional(&set, (vec3){-1, 1, -0.2});
    const hl_light_layers lights[1] = {{.picture = light}};
    const hl_layers wanted = {
        .struct_size = sizeof wanted, .sky = made.sky, .lights = lights, .light_count = (size_t)i};
    memset(light, 0, sizeof light);
    stage_render_layers(&set, NULL, made.pixels, &wanted);
    double brightest = 0;
    for (int k = 0; k < PIXELS * 3; k++) {
      assert_near(made.sky[k] + light[k], made.pixels[k / 3 * 4 + k % 3], 2e-6);
      brightest = fmax(brightest, made.sky[k]);
    }
    assert_true(brightest > 0.5);
    stage_close(&set);
  }
}

/* ---- the same bytes ---- */

static void expect_same(stage *set, hl_sky *sky, bool same) {
  static float with[PIXELS * 4], without[PIXELS * 4];
  sky->suns = 1;
  stage_render_sheets(set, with);
  sky->suns = 0;
  stage_render_sheets(set, without);
  assert_int_equal(memcmp(with, without, sizeof with) == 0, same);
}

/* If the image has no sun, or lights cast no shadows, pictures are the same as with suns off. */
static void test_without(void **state) {
  (void)state;
  stage set;
  open_scene(&set, HL_SHADING_PHONG);
  expect_same(&set, &set.scene.sky, false);
  set.scene.render.shadows = HL_SHADOWS_OFF;
  expect_same(&set, &set.scene.sky, true);
  set.scene.render.shadows = HL_SHADOWS_HARD;
  set.scene.render.slicing = HL_SLICING_IMAGE_ALIGNED;
  expect_same(&set, &set.scene.sky, true);
  set.scene.render.slicing = HL_SLICING_HALF_VECTOR;
  paint((vec3){-0.8, -0.3, 0.7}, 8, 0.3);
  expect_same(&set, &set.scene.sky, true);
  stage_close(&set);
}

static void render_on(int threads, hl_instruction_set instructions, hl_soft_method method, float *pixels) {
  hl_context_options options;
  hl_context_options_defaults(&options);
  options.instruction_set = instructions;
  stage set, own;
  open_scene(&set, HL_SHADING_PHONG);
  stage_open_with(&own, &options);
  set.scene.render.threads = threads;
  set.scene.render.soft_method = method;
  hl_context *of = set.context;
  set.context = own.context;
  stage_render_sheets(&set, pixels);
  set.context = of;
  stage_close(&own);
  stage_close(&set);
}

static void test_same_bytes(void **state) {
  (void)state;
  static float one[PIXELS * 4], other[PIXELS * 4];
  for (int method = 0; method < 3; method++) {
    render_on(1, HL_INSTRUCTION_SET_AUTO, (hl_soft_method)method, one);
    render_on(5, HL_INSTRUCTION_SET_AUTO, (hl_soft_method)method, other);
    assert_memory_equal(one, other, sizeof one);
    render_on(2, HL_INSTRUCTION_SET_SCALAR, (hl_soft_method)method, other);
    assert_memory_equal(one, other, sizeof one);
  }
}

/* A renderer that keeps the sky's light makes the picture of a new renderer when the image is turned,
 * brightened, or cut at the horizon; and when there is no sun any more, because the sky's setting turns suns
 * off or because sheets are aligned with the picture. */
static void test_kept_light(void **state) {
  (void)state;
  static float kept[PIXELS * 4], fresh[PIXELS * 4];
  stage set;
  hl_renderer *renderer = NULL;
  open_scene(&set, HL_SHADING_NONE);
  set.volumes[0].multiple_scattering = 1;
  assert_int_equal(hl_renderer_create(set.context, &renderer, NULL), HL_OK);
  for (int change = 0; change < 6; change++) {
    if (change == 1) set.scene.sky.rotation_deg = 40;
    if (change == 2) set.scene.sky.strength = 0.5;
    if (change == 3) set.scene.sky.suns = 0;
    if (change == 4) set.scene.sky.hemisphere = 1, set.scene.sky.suns = 1;
    if (change == 5) set.scene.render.slicing = HL_SLICING_IMAGE_ALIGNED;
    stage_render_with(&set, renderer, kept);
    stage_render_sheets(&set, fresh);
    assert_memory_equal(kept, fresh, sizeof kept);
  }
  hl_renderer_destroy(renderer);
  stage_close(&set);
}

/* ---- the scene ---- */

/* A sun does not change the scene's own lights, also if the scene has 256 lights, the greatest number.
 */
static void test_description(void **state) {
  (void)state;
  enum { MOST = 256 };
  static hl_light lights[MOST];
  static float pixels[PIXELS * 4];
  stage set;
  hl_scene *scene = NULL;
  open_scene(&set, HL_SHADING_PHONG);
  for (int i = 0; i < MOST; i++) {
    hl_light_defaults(&lights[i]);
    lights[i].type = HL_LIGHT_DIRECTIONAL;
    lights[i].direction[0] = 0.3, lights[i].direction[2] = -1;
    lights[i].intensity = 1.0 / MOST;
    lights[i].shadows = HL_SHADOWS_OFF;
  }
  set.scene.lights = lights;
  set.scene.light_count = MOST;
  assert_int_equal(hl_scene_create(set.context, &set.scene, &scene, NULL), HL_OK);
  const hl_scene_description *kept = hl_scene_describe(scene);
  assert_int_equal(kept->light_count, MOST);
  assert_memory_equal(kept->sky.pixels, image, sizeof image);
  hl_scene_release(scene);
  stage_render_sheets(&set, pixels);
  set.scene.light_count = 0;
  stage_close(&set);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_surface),
      cmocka_unit_test(test_haze),
      cmocka_unit_test(test_penumbra),
      cmocka_unit_test(test_layers),
      cmocka_unit_test(test_without),
      cmocka_unit_test(test_same_bytes),
      cmocka_unit_test(test_kept_light),
      cmocka_unit_test(test_description),
      cmocka_unit_test(test_against_the_reference),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
