/* analytic/layers.c - the layers of a picture (lights, shadows, depth, normals), against closed forms, and
 * their sum. Each closed form is tested on the sheets and on the reference. */
#include <stdlib.h>
#include <string.h>

#include "../asserts.h"
#include "core/context.h"
#include "reference_stage.h"

enum { SIDE = 28, PIXELS = SIDE * SIDE };

/* The buffers of all layers. */
typedef struct layer_set {
  float pixels[PIXELS * 4], ambient[PIXELS * 3], emission[PIXELS * 3], first[PIXELS], mean[PIXELS],
      normal[PIXELS * 3];
  float pictures[STAGE_LIGHTS][PIXELS * 3], shadows[STAGE_LIGHTS][PIXELS * 3];
  hl_light_layers lights[STAGE_LIGHTS];
  hl_layers all;
} layer_set;

static void ask_for_all(const stage *set, layer_set *layers) {
  memset(layers, 0xff, sizeof *layers); /* NaN shows which values were not written */
  for (size_t l = 0; l < STAGE_LIGHTS; l++)
    layers->lights[l] = (hl_light_layers){layers->pictures[l], layers->shadows[l]};
  layers->all = (hl_layers){.struct_size = sizeof layers->all,
                            .ambient = layers->ambient,
                            .depth_first = layers->first,
                            .depth_mean = layers->mean,
                            .normal = layers->normal,
                            .emission = layers->emission,
                            .lights = layers->lights,
                            .light_count = set->scene.light_count};
}

static void render_with(stage *set, bool reference, hl_layers *wanted, float *pixels) {
  hl_reference_options options;
  hl_reference_options_defaults(&options);
  options.light_points = 6;
  stage_render_layers(set, reference ? &options : NULL, pixels, wanted);
}

static void render_all(stage *set, bool reference, layer_set *layers) {
  ask_for_all(set, layers);
  render_with(set, reference, &layers->all, layers->pixels);
}

static void open_square(stage *set) {
  stage_open(set);
  set->scene.width = set->scene.height = SIDE;
}

/* ---- depth: a homogeneous box ---- */

static const vec3 LOW = {-3, -2.5, -6}, HIGH = {4, 5, 2};
static const double SIGMA = 0.13126091261247; /* -ln(1 - 0.2) / 1.7 */

/* The distance at which a ray enters the box. The ray must meet the box. */
static double entry(vec3 origin, vec3 direction) {
  const double l[3] = {LOW.x, LOW.y, LOW.z}, h[3] = {HIGH.x, HIGH.y, HIGH.z};
  const double o[3] = {origin.x, origin.y, origin.z}, d[3] = {direction.x, direction.y, direction.z};
  double enter = -INFINITY;
  for (int a = 0; a < 3; a++)
    if (fabs(d[a]) > 1e-12) enter = fmax(enter, ((d[a] > 0 ? l[a] : h[a]) - o[a]) / d[a]);
  return enter;
}

/* In a box of the length c along the ray, the depth s has the weight exp(-sigma s). The mean depth is 1 /
 * sigma - c * exp(-e) / (1 - exp(-e)), where e = sigma c. Alpha reaches 0.01 at s = -ln(0.99) / sigma. */
static void check_depths(const stage *set, const layer_set *layers) {
  int hits = 0, misses = 0;
  for (int i = 0; i < PIXELS; i++) {
    vec3 origin, direction;
    stage_eye_ray(set, i % SIDE, i / SIDE, &origin, &direction);
    double chord = stage_chord(LOW, HIGH, origin, direction), e = SIGMA * chord;
    double enter = entry(origin, direction), reach = -log(0.99) / SIGMA;
    if (chord > 0 && chord < 0.1) continue; /* the ray passes at the very edge of the box */
    hits += chord > 0;
    misses += chord <= 0;
    if (chord <= 0) {
      assert_true(isinf(layers->mean[i]) && isinf(layers->first[i]));
      for (int c = 0; c < 3; c++)
        assert_true(layers->shadows[0][3 * i + c] == 0 && layers->normal[3 * i + c] == 0);
    } else {
      assert_near(layers->mean[i], enter + 1 / SIGMA - chord * exp(-e) / -expm1(-e), 0.004);
      if (chord > reach) assert_near(layers->first[i], enter + reach, 0.004);
    }
  }
  assert_true(hits > 100 && misses > 50);
}

/* Depths are checked in three settings: under light that travels with the eye's rays; under light that
 * travels against the eye's rays, for which sheets go back to front and one more sweep measures depth; and
 * without light. */
static void check_depths_under_all_lights(stage *set) {
  static const vec3 lights[] = {{0, 0, -1}, {0.3, -0.2, 1}};
  static layer_set layers;
  hl_scene_volume *box = stage_add_grid(set, (size_t[3]){7, 5, 4}, (double[3]){1, 1.5, 2}, LOW, NULL);
  stage_set_opacity(set, box, 0.2, 1.7);
  stage_add_directional(set, lights[0]);
  for (int i = 0; i < 4; i++) {
    set->lights[0].direction[0] = lights[i % 2].x;
    set->lights[0].direction[1] = lights[i % 2].y;
    set->lights[0].direction[2] = lights[i % 2].z;
    render_all(set, i >= 2, &layers);
    check_depths(set, &layers);
  }
}

static void test_depth_of_box(void **state) {
  (void)state;
  stage set;
  open_square(&set);
  set.scene.camera.height = 14;
  stage_look(&set, (vec3){40, -31, 52}, (vec3){0, 1, -2}, (vec3){0.2, 0.3, 1});
  check_depths_under_all_lights(&set);
  stage_close(&set);
}

static void test_depth_of_box_in_perspective(void **state) {
  (void)state;
  stage set;
  open_square(&set);
  set.scene.camera.type = HL_CAMERA_PERSPECTIVE;
  set.scene.camera.fovy_deg = 55;
  stage_look(&set, (vec3){9, -7, 8}, (vec3){0.5, 1.2, -2}, (vec3){0, 1, 0.1});
  check_depths_under_all_lights(&set);
  stage_close(&set);
}

/* ---- shadow: a floor below a plate that is not seen ---- */

static void check_plate(stage *set, bool reference) {
  static layer_set layers;
  int shadowed = 0, lit = 0;
  render_all(set, reference, &layers);
  for (int i = 0; i < PIXELS; i++) {
    vec3 origin, direction;
    stage_eye_ray(set, i % SIDE, i / SIDE, &origin, &direction);
    if (fabs(origin.x) > 6 || fabs(origin.y) > 6) continue;
    bool below = fabs(origin.x) < 3 && fabs(origin.y)<3, beside = fabs(origin.x)> 5 || fabs(origin.y) > 5;
    const float *shadow = layers.shadows[0] + 3 * i, *picture = layers.pictures[0] + 3 * i;
    shadowed += below;
    lit += beside;
    for (int c = 0; c < 3 && (below || beside); c++) {
      /* The plate's optical depth is 2 in green, 100 in red and 0 in blue. The floor's own optical depth is
       * small. */
      double through = beside ? 1 : c == 0 ? 0 : c == 1 ? exp(-2) : 1;
      assert_near(shadow[c], through, 0.006);
      assert_near(picture[c], layers.pixels[4 * i + 3] * shadow[c] * (c == 0 ? 0.25 : 0.75) * 2, 1e-5);
      assert_near(layers.shadows[1][3 * i + c], 1, 1e-6);
    }
  }
  assert_true(shadowed > 40 && lit > 40);
}

static void test_shadow_of_plate(void **state) {
  (void)state;
  stage set;
  open_square(&set);
  stage_set_opacity(&set, stage_add_box(&set, (vec3){-7, -7, -5}, (vec3){7, 7, -4}), 0.01, 1);
  stage_set_color(&set, &set.volumes[0], 0.25, 0.75, 0.75);
  hl_scene_volume *plate = stage_add_box(&set, (vec3){-4, -4, 3}, (vec3){4, 4, 4});
  stage_set_opacity(&set, plate, -expm1(-2), 1);
  plate->attenuation_color[0] = 50;
  plate->attenuation_color[1] = 1;
  plate->attenuation_color[2] = 0;
  plate->visible = 0;
  stage_add_directional(&set, (vec3){0, 0, -1})->intensity = 2;
  stage_add_directional(&set, (vec3){0, 0, -1})->shadows = HL_SHADOWS_OFF;
  check_plate(&set, false);
  check_plate(&set, true);
  stage_close(&set);
}

/* An image that a light projects shows in the light's layer, and not in its shadow's layer. */
static void test_texture_is_no_shadow(void **state) {
  (void)state;
  static const float pixels[2 * 3] = {0, 0, 0, 1, 0.5f, 0.25f};
  static layer_set layers;
  stage set;
  open_square(&set);
  stage_add_box(&set, (vec3){-7, -7, -5}, (vec3){7, 7, -4});
  stage_set_opacity(&set, &set.volumes[0], 0.01, 1);
  hl_light *light = stage_add_directional(&set, (vec3){0, 0, -1});
  stage_set_texture(light, 2, 1, pixels, (vec3){0, 0, 10}, (vec3){8, 0, 0}, (vec3){0, 8, 0});
  for (int reference = 0; reference < 2; reference++) {
    render_all(&set, reference == 1, &layers);
    int dark = 0, bright = 0;
    for (int i = 0; i < PIXELS; i++) {
      vec3 origin, direction;
      stage_eye_ray(&set, i % SIDE, i / SIDE, &origin, &direction);
      if (fabs(origin.x) > 6.5 || fabs(origin.y) > 6.5) continue;
      dark += layers.pictures[0][3 * i] < 1e-6f;
      bright += layers.pictures[0][3 * i] > 0.009f;
      for (int c = 0; c < 3; c++) assert_near(layers.shadows[0][3 * i + c], 1, 0.006);
    }
    assert_true(dark > 50 && bright > 50);
  }
  stage_close(&set);
}

/* ---- normals: a ramp ---- */

static void check_ramp(stage *set, bool reference) {
  static layer_set layers;
  render_all(set, reference, &layers);
  int checked = 0;
  for (int i = 0; i < PIXELS; i++) {
    vec3 origin, direction;
    stage_eye_ray(set, i % SIDE, i / SIDE, &origin, &direction);
    if (stage_chord((vec3){-5, -5, -5}, (vec3){5, 5, 5}, origin, direction) < 4) continue;
    checked++; /* the normal points downhill, along (1, 2, -2) / 3 */
    assert_near(layers.normal[3 * i], -1.0 / 3, 0.003);
    assert_near(layers.normal[3 * i + 1], -2.0 / 3, 0.003);
    assert_near(layers.normal[3 * i + 2], 2.0 / 3, 0.003);
  }
  assert_true(checked > 50);
}

static void test_normal_of_ramp(void **state) {
  (void)state;
  enum { N = 14 };
  static float voxels[N * N * N];
  stage set;
  open_square(&set);
  for (int i = 0; i < N * N * N; i++)
    voxels[i] = (float)((i % N + 2 * (i / N % N) - 2 * (i / N / N)) * 0.1 + 10);
  hl_scene_volume *ramp = stage_add_grid(&set, (size_t[3]){N, N, N}, (double[3]){1, 1, 1}, (vec3){-7, -7, -7},
                                         voxels);
  ramp->shading = HL_SHADING_PHONG;
  ramp->clipped = 1; /* the clip box leaves out the border, where the ramp ends */
  /* the layer has the ramp's normals, also at the clip box's faces */
  ramp->cut_shading = HL_CUT_SHADING_GRADIENT;
  for (int a = 0; a < 3; a++) ramp->clip_min[a] = -5, ramp->clip_max[a] = 5;
  stage_set_opacity(&set, ramp, 0.3, 1);
  stage_look(&set, (vec3){40, -31, 52}, (vec3){0, 0, 0}, (vec3){0.2, 0.3, 1});
  stage_add_directional(&set, (vec3){0.4, 0.3, -1});
  check_ramp(&set, false);
  check_ramp(&set, true);
  stage_close(&set);
}

/* ---- the sum ---- */

static const hl_opacity_point SOFT_EDGE[] = {{0, 0}, {0.35, 0}, {0.6, 0.7}, {1, 0.9}};

/* The scene has two volumes and three lights. One light needs a sweep of its own. */
static void build_scene(stage *set) {
  enum { N = 15 };
  static float voxels[N * N * N];
  for (int i = 0; i < N * N * N; i++) {
    double x = i % N - 7, y = i / N % N - 7, z = i / N / N - 7;
    voxels[i] = (float)fmax(0, 1 - (x * x + y * y + z * z) / 49) *
                (0.5f + 0.5f * stage_noise(x / 3, y / 3, z / 3));
  }
  for (int v = 0; v < 2; v++) {
    double edge = v == 0 ? 1 : 0.6;
    hl_scene_volume *volume = stage_add_grid(set, (size_t[3]){N, N, N}, (double[3]){edge, edge, edge},
                                             (vec3){v * 2 - 8, v * 2 - 7, v * 3 - 8}, voxels);
    volume->transfer_function.opacity = SOFT_EDGE;
    volume->transfer_function.opacity_count = sizeof SOFT_EDGE / sizeof *SOFT_EDGE;
    stage_set_color(set, volume, 0.9, 0.5 + 0.3 * v, 0.3);
    volume->shading = v == 0 ? HL_SHADING_PHONG : HL_SHADING_NONE;
    volume->material.emission = v == 0 ? 0.3 : 0;
  }
  set->scene.render.shadows = HL_SHADOWS_SOFT;
  set->scene.camera.type = HL_CAMERA_PERSPECTIVE;
  set->scene.camera.fovy_deg = 40;
  stage_look(set, (vec3){30, -25, 20}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
  stage_add_directional(set, (vec3){-1, 0.5, -1})->angular_diameter_deg = 12;
  stage_add_directional(set, (vec3){1, 1, 0.2})->color[1] = 0.2;
  hl_light *lamp = stage_add_point(set, (vec3){25, 5, 30});
  lamp->falloff = HL_FALLOFF_INVERSE_SQUARE;
  lamp->intensity = 700;
  lamp->radius = 3;
  set->scene.ambient[0] = 0.1;
  set->scene.ambient[1] = 0.2;
}

static void open_scene(stage *set, int distance) {
  open_square(set);
  build_scene(set);
  for (int a = 0; a < 3; a++) set->scene.camera.position[a] *= distance;
}

static double sum_at(const layer_set *layers, size_t lights, int pixel, int c) {
  double sum = (double)layers->ambient[3 * pixel + c] + (double)layers->emission[3 * pixel + c];
  for (size_t l = 0; l < lights; l++) sum += (double)layers->pictures[l][3 * pixel + c];
  return sum;
}

/* A phase function changes the light that a medium sends to the eye, and not the layer of the light's shadow.
 * The layer stays the same under lights of several types and by every method of shadows. */
static void test_scattering_is_no_shadow(void **state) {
  (void)state;
  static layer_set even, scattered;
  stage set;
  open_scene(&set, 1);
  hl_light *board = stage_add_point(&set, (vec3){-20, 10, 25});
  board->type = HL_LIGHT_RECT;
  board->edge1[0] = board->edge2[1] = 4;
  for (int way = 0; way < 5; way++) {
    /* three methods of soft shadows, then hard shadows, then the reference */
    static const hl_soft_method methods[] = {HL_SOFT_CASCADE, HL_SOFT_PAPER, HL_SOFT_SUBLIGHTS};
    set.scene.render.soft_method = methods[way % 3];
    set.scene.render.shadows = way == 3 ? HL_SHADOWS_HARD : HL_SHADOWS_SOFT;
    set.volumes[0].anisotropy = set.volumes[1].anisotropy = 0;
    render_all(&set, way == 4, &even);
    set.volumes[0].anisotropy = set.volumes[1].anisotropy = 0.8;
    render_all(&set, way == 4, &scattered);
    assert_memory_equal(even.shadows, scattered.shadows, sizeof even.shadows);
    assert_memory_not_equal(even.pictures, scattered.pictures, sizeof even.pictures);
  }
  stage_close(&set);
}

/* The scene is seen from near, and from so far away that a pixel is the mean of several. */
static void test_sum_is_the_picture(void **state) {
  (void)state;
  static layer_set layers;
  for (int i = 0; i < 3; i++) {
    stage set;
    open_scene(&set, i == 1 ? 4 : 1);
    render_all(&set, i == 2, &layers);
    double brightest = 0;
    for (int pixel = 0; pixel < PIXELS; pixel++)
      for (int c = 0; c < 3; c++) {
        double value = (double)layers.pixels[4 * pixel + c];
        assert_near(sum_at(&layers, set.scene.light_count, pixel, c), value, 2e-6);
        brightest = fmax(brightest, value);
      }
    assert_true(brightest > 0.3);
    stage_close(&set);
  }
}

/* If colours and strengths of lights or the ambient light change, the picture is a sum of the same layers
 * with other factors, so that no layer is rendered again. */
static void test_relighting(void **state) {
  (void)state;
  static layer_set layers;
  static float again[PIXELS * 4];
  static const double gain[3] = {0.25, 3, 0.5};
  stage set;
  open_scene(&set, 1);
  render_all(&set, false, &layers);
  for (int l = 0; l < 3; l++) set.lights[l].intensity *= gain[l];
  for (int c = 0; c < 3; c++) set.scene.ambient[c] *= 0.5;
  stage_render_sheets(&set, again);
  for (int pixel = 0; pixel < PIXELS; pixel++)
    for (int c = 0; c < 3; c++) {
      double sum = 0.5 * (double)layers.ambient[3 * pixel + c] + (double)layers.emission[3 * pixel + c];
      for (int l = 0; l < 3; l++) sum += gain[l] * (double)layers.pictures[l][3 * pixel + c];
      assert_near(again[4 * pixel + c], sum, 4e-6);
    }
  stage_close(&set);
}

static void assert_layers_near(const layer_set *a, const layer_set *b, size_t lights) {
  double square[3] = {0, 0, 0}, samples = 0;
  for (int i = 0; i < PIXELS; i++) {
    if (b->pixels[4 * i + 3] < 0.05f) continue;
    samples++;
    square[0] += pow((double)a->first[i] - (double)b->first[i], 2);
    square[1] += pow((double)a->mean[i] - (double)b->mean[i], 2);
    for (int c = 0; c < 3; c++)
      square[2] += pow((double)a->normal[3 * i + c] - (double)b->normal[3 * i + c], 2);
    for (size_t l = 0; l < lights; l++) assert_near(a->shadows[l][3 * i], b->shadows[l][3 * i], 0.12);
  }
  assert_true(samples > 200);
  assert_near(sqrt(square[0] / samples), 0, 0.03);
  assert_near(sqrt(square[1] / samples), 0, 0.03);
  assert_near(sqrt(square[2] / samples), 0, 0.02);
}

static void test_sheets_against_reference(void **state) {
  (void)state;
  static layer_set sheets, reference;
  stage set;
  open_scene(&set, 1);
  /* the pixels are well below a voxel, because slopes are taken from differences between pixels */
  set.scene.camera.fovy_deg = 16;
  render_all(&set, false, &sheets);
  render_all(&set, true, &reference);
  assert_layers_near(&sheets, &reference, set.scene.light_count);
  stage_close(&set);
}

/* ---- changes that must not change the picture ---- */

static void test_picture_stays(void **state) {
  (void)state;
  static layer_set layers;
  static float alone[PIXELS * 4];
  stage set;
  open_scene(&set, 1);
  render_all(&set, false, &layers);
  stage_render_sheets(&set, alone);
  assert_memory_equal(alone, layers.pixels, sizeof alone);
  stage_close(&set);
}

static bool is_same(const layer_set *a, const layer_set *b) {
  return memcmp(a, b, offsetof(layer_set, lights)) == 0;
}

static void render_by(hl_instruction_set instructions, int threads, layer_set *layers) {
  hl_context_options options;
  hl_context_options_defaults(&options);
  options.instruction_set = instructions;
  stage set;
  stage_open_with(&set, &options);
  set.scene.width = set.scene.height = SIDE;
  build_scene(&set);
  set.scene.render.threads = threads;
  render_all(&set, false, layers);
  stage_close(&set);
}

static void test_same_bytes(void **state) {
  (void)state;
  static layer_set first, other;
  render_by(HL_INSTRUCTION_SET_SCALAR, 1, &first);
  render_by(HL_INSTRUCTION_SET_AUTO, 7, &other);
  assert_true(is_same(&first, &other));
  render_by(HL_INSTRUCTION_SET_AUTO, 2, &other);
  assert_true(is_same(&first, &other));
}

/* A layer that is rendered alone has the values that it has when all layers are rendered. */
static void test_some_layers(void **state) {
  (void)state;
  static layer_set all, some;
  stage set;
  open_scene(&set, 1);
  render_all(&set, false, &all);
  for (int reference = 0; reference < 2; reference++) {
    ask_for_all(&set, &some);
    some.lights[0] = (hl_light_layers){NULL, NULL};
    some.lights[1].picture = NULL;
    some.all.ambient = some.all.depth_first = some.all.normal = NULL;
    render_with(&set, reference == 1, &some.all, some.pixels);
    if (reference == 1) render_all(&set, true, &all);
    assert_memory_equal(some.mean, all.mean, sizeof all.mean);
    assert_memory_equal(some.shadows[1], all.shadows[1], sizeof all.shadows[1]);
    assert_memory_equal(some.pictures[2], all.pictures[2], sizeof all.pictures[2]);
    assert_true(isnan(some.first[0]) && isnan(some.ambient[0]) && isnan(some.pictures[0][0]));
  }
  stage_close(&set);
}

static void test_refusals(void **state) {
  (void)state;
  static layer_set layers;
  stage set;
  open_scene(&set, 1);
  hl_error error = {0};
  hl_scene *scene = NULL;
  hl_renderer *renderer = NULL;
  assert_int_equal(hl_scene_create(set.context, &set.scene, &scene, NULL), HL_OK);
  assert_int_equal(hl_renderer_create(set.context, &renderer, NULL), HL_OK);
  for (int wrong = 0; wrong < 3; wrong++) {
    ask_for_all(&set, &layers);
    if (wrong == 0) layers.all.struct_size--;
    if (wrong == 1) layers.all.light_count = 2;
    if (wrong == 2) layers.all.lights = NULL;
    assert_int_equal(
        hl_renderer_render_layers(renderer, scene, layers.pixels, 4 * SIDE, &layers.all, NULL, &error),
        HL_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "layers->"));
    assert_int_equal(
        hl_reference_render_layers(set.context, scene, NULL, layers.pixels, 4 * SIDE, &layers.all, NULL),
        HL_ERROR_ARGUMENT);
  }
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
  stage_close(&set);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_depth_of_box),
      cmocka_unit_test(test_depth_of_box_in_perspective),
      cmocka_unit_test(test_shadow_of_plate),
      cmocka_unit_test(test_texture_is_no_shadow),
      cmocka_unit_test(test_normal_of_ramp),
      cmocka_unit_test(test_sum_is_the_picture),
      cmocka_unit_test(test_relighting),
      cmocka_unit_test(test_sheets_against_reference),
      cmocka_unit_test(test_picture_stays),
      cmocka_unit_test(test_same_bytes),
      cmocka_unit_test(test_some_layers),
      cmocka_unit_test(test_refusals),
      cmocka_unit_test(test_scattering_is_no_shadow),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
