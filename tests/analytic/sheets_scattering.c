/* analytic/sheets_scattering.c - light that media scatter repeatedly, compared with closed forms, with the
 * reference's random paths, and between numbers of threads. */
#include <stdlib.h>
#include <string.h>

#include "../asserts.h"
#include "core/memory.h"
#include "reference_stage.h"
#include "scatter/parts.h"

enum { SIDE = 16, PIXELS = SIDE * SIDE, DEEP = 24 };

/* ---- the transport on the grid ---- */

/* A block of nodes with the same matter everywhere, and the arrays of a solution of the transport
 * equations. */
typedef struct block {
  hl_context *context;
  hl_pool *pool;
  scatter_nodes nodes;
  size_t count;
  scatter_work work;
  float *extinction, *scattering, *direct, *light, *flux;
  void *memory;
} block;

static float *take(hl_layout *layout, size_t count) { return hl_layout_take(layout, count, sizeof(float)); }

static void lay_out(block *b, hl_layout *layout) {
  for (int line = 0; line < SCATTER_LINES; line++) {
    b->work.pass[line] = take(layout, b->count);
    b->work.along[line] = take(layout, b->count);
    b->work.flux[line] = take(layout, b->count);
    b->work.before[line] = take(layout, b->count);
  }
  for (int v = 0; v < 5; v++) b->work.vectors[v] = take(layout, b->count);
  b->extinction = take(layout, b->count);
  b->scattering = take(layout, b->count);
  b->direct = take(layout, b->count);
  b->light = take(layout, b->count);
  b->flux = take(layout, 3 * b->count);
}

/* Makes a block of side^3 nodes, of which the outermost are empty. */
static void open_block(block *b, int side, float extinction, float albedo) {
  *b = (block){.nodes = {{side, side, side}, {0, 0, 0}, 0.5f}, .count = (size_t)(side * side * side)};
  hl_context_options options;
  hl_context_options_defaults(&options);
  assert_int_equal(hl_context_create(&options, &b->context, NULL), HL_OK);
  assert_int_equal(hl_pool_create(b->context, 2, &b->pool, NULL), HL_OK);
  hl_layout counted = {0};
  lay_out(b, &counted);
  hl_layout handed = {.base = b->memory = hl_allocate(b->context, counted.bytes, 1)};
  assert_non_null(b->memory);
  lay_out(b, &handed);
  for (size_t n = 0; n < b->count; n++) {
    int x = (int)n % side, y = (int)n / side % side, z = (int)n / side / side;
    bool inside = x > 0 && y > 0 && z > 0 && x < side - 1 && y < side - 1 && z < side - 1;
    b->extinction[n] = inside ? extinction : 0;
    b->scattering[n] = inside ? albedo * extinction : 0;
    b->direct[n] = 1;
  }
  hl_scatter_begin_lines(b->pool, &b->nodes, b->extinction, &b->work);
}

static void close_block(block *b) {
  hl_release(b->context, b->memory);
  hl_pool_destroy(b->pool);
  hl_context_destroy(b->context);
}

static void solve(block *b) {
  hl_scatter_solve(b->pool, &b->nodes, b->extinction, b->scattering, b->direct, NULL, &b->work, b->light,
                   b->flux);
}

/* Deep inside a block, the same light b arrives everywhere, and each collision scatters the fraction w of the
 * light. So the scattered light is w b + w^2 b + ... */
static void test_deep_inside(void **state) {
  (void)state;
  static const float albedos[] = {0.3f, 0.6f, 0.8f};
  for (int k = 0; k < 3; k++) {
    block b;
    open_block(&b, DEEP, 4, albedos[k]);
    solve(&b);
    size_t middle = (DEEP / 2 * DEEP + DEEP / 2) * DEEP + DEEP / 2;
    double w = (double)albedos[k];
    assert_near((double)b.light[middle], w / (1 - w), 0.01 * w / (1 - w));
    close_block(&b);
  }
}

/* White furnace: in light of radiance 1 from everywhere and matter that absorbs no light, scattered and
 * unscattered light add up to 1 everywhere. For the unscattered light b, the scattered light is therefore 1 -
 * b. */
static void test_white_furnace(void **state) {
  (void)state;
  static const float extinctions[] = {0.05f, 0.5f, 3};
  for (int k = 0; k < 3; k++) {
    block b;
    const float little = 1e-6f;
    open_block(&b, DEEP, extinctions[k], little);
    for (size_t n = 0; n < b.count; n++) b.direct[n] = 1 / little;
    solve(&b);
    for (size_t n = 0; n < b.count; n++) b.direct[n] = 1 - b.light[n], b.scattering[n] = b.extinction[n];
    solve(&b);
    for (size_t n = 0; n < b.count; n++) assert_near((double)(b.light[n] + b.direct[n]), 1, 0.01);
    close_block(&b);
  }
}

/* Beside a block that shines evenly, the flux points away from the block and is at most the light. In the
 * block's middle the flux is 0. */
static void test_flux_leads_out(void **state) {
  (void)state;
  block b;
  open_block(&b, DEEP + 1, 0.5f, 0.9f);
  solve(&b);
  size_t row = DEEP + 1, slice = row * row, middle = DEEP / 2 * (slice + row + 1);
  assert_near((double)b.flux[middle], 0, 1e-3 * (double)b.light[middle]);
  for (int a = 0; a < 3; a++) {
    size_t step = a == 0 ? 1 : a == 1 ? row : slice, face = middle + DEEP / 2 * step;
    const float *flux = b.flux + (size_t)a * b.count;
    assert_true(flux[face] > 0.4f * b.light[face] && flux[face] <= b.light[face]);
    assert_near((double)flux[face], -(double)flux[middle - DEEP / 2 * step], 2e-3 * (double)b.light[face]);
  }
  close_block(&b);
}

/* ---- pictures ---- */

/* Opens a scene of a block, 48 x 48 x 24, with the opacity 1/2 for one unit, lit and seen from above. */
static hl_scene_volume *open_stage(stage *set, double albedo, bool multiple) {
  stage_open(set);
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.height = 6;
  set->scene.render.shadows = HL_SHADOWS_HARD;
  for (int c = 0; c < 3; c++) set->scene.ambient[c] = 0;
  hl_scene_volume *volume = stage_add_grid(set, (size_t[3]){48, 48, 24}, (double[3]){1, 1, 1},
                                           (vec3){-24, -24, -12}, NULL);
  stage_set_opacity(set, volume, 0.4, 1);
  stage_set_color(set, volume, 1, 1, 1);
  volume->shading = HL_SHADING_NONE;
  for (int c = 0; c < 3; c++) volume->albedo[c] = albedo;
  volume->multiple_scattering = multiple;
  stage_look(set, (vec3){0, 0, 40}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
  stage_add_directional(set, (vec3){0, 0, -1});
  return volume;
}

/* Chandrasekhar's function H of even scattering ("Radiative transfer", 1950, chapter V), by iteration: 1 /
 * H(m) = sqrt(1 - w) + w/2 times the integral of n H(n) / (m + n) over n from 0 to 1. */
static double chandrasekhar(double albedo, double cosine) {
  enum { N = 400 };
  static double h[N];
  double sum = 0;
  for (int i = 0; i < N; i++) h[i] = 1;
  for (int turn = 0; turn < 200; turn++)
    for (int i = 0; i < N; i++) {
      double m = (i + 0.5) / N;
      sum = 0;
      for (int k = 0; k < N; k++) sum += (k + 0.5) / N * h[k] / (m + (k + 0.5) / N) / N;
      h[i] = 1 / (sqrt(1 - albedo) + albedo / 2 * sum);
    }
  sum = 0;
  for (int k = 0; k < N; k++) sum += (k + 0.5) / N * h[k] / (cosine + (k + 0.5) / N) / N;
  return 1 / (sqrt(1 - albedo) + albedo / 2 * sum);
}

/* The light that a half space returns is H(m) H(m0) times the light that is scattered once. */
static void test_half_space(void **state) {
  (void)state;
  static const double albedos[] = {0.5, 0.9};
  static float pixels[2][4 * PIXELS];
  for (int k = 0; k < 2; k++) {
    for (int multiple = 0; multiple < 2; multiple++) {
      stage set;
      (void)open_stage(&set, albedos[k], multiple == 1);
      stage_render_sheets(&set, pixels[multiple]);
      stage_close(&set);
    }
    double h = chandrasekhar(albedos[k], 1), once = albedos[k] / 2;
    size_t middle = 4 * (SIDE / 2 * SIDE + SIDE / 2);
    assert_near((double)pixels[0][middle], once, 0.01 * once); /* the expected light is w m0 / (m + m0) */
    assert_near((double)pixels[1][middle], once * h * h, 0.06 * once * h * h);
  }
}

/* The reference's random paths find the light that a half space returns, within four standard errors of the
 * paths. Every run gives the same numbers, and more paths have smaller errors. */
static void test_paths_of_the_reference(void **state) {
  (void)state;
  static float pixels[3][4 * PIXELS], errors[3 * PIXELS];
  static const int paths[] = {6, 24, 6};
  double h = chandrasekhar(0.9, 1), mean[3] = {0, 0, 0}, square[3] = {0, 0, 0};
  for (int k = 0; k < 3; k++) {
    stage set;
    hl_reference_options options;
    hl_reference_options_defaults(&options);
    options.paths = paths[k];
    options.threads = 1 + k;
    options.step = 1;
    options.error = errors;
    (void)open_stage(&set, 0.9, true);
    stage_render(&set, &options, pixels[k]);
    stage_close(&set);
    for (int i = 0; i < PIXELS; i++) {
      mean[k] += (double)pixels[k][4 * i] / PIXELS;
      square[k] += (double)errors[3 * i] * (double)errors[3 * i] / PIXELS / PIXELS;
    }
    /* the tolerance for the step of the reference's ray march is 0.02 */
    assert_near(mean[k], 0.45 * h * h, 4 * sqrt(square[k]) + 0.02);
  }
  assert_memory_equal(pixels[0], pixels[2], sizeof pixels[0]);
  assert_near(sqrt(square[0] / square[1]), 2, 0.4);
}

/* If light is scattered once only, the picture is proportional to the albedo. */
static void test_albedo_scales_one_scattering(void **state) {
  (void)state;
  static float full[4 * PIXELS], half[4 * PIXELS];
  stage set;
  (void)open_stage(&set, 1, false);
  stage_render_sheets(&set, full);
  stage_close(&set);
  (void)open_stage(&set, 0.5, false);
  stage_render_sheets(&set, half);
  stage_close(&set);
  for (int i = 0; i < 4 * PIXELS; i++)
    assert_near((double)half[i], (double)full[i] * (i % 4 == 3 ? 1 : 0.5), 1e-6);
}

/* The picture has the same bytes with any number of threads, and by a renderer that has made other pictures
 * before. */
static void test_same_bytes(void **state) {
  (void)state;
  static float first[4 * PIXELS], pixels[4 * PIXELS];
  static const int threads[] = {1, 2, 7};
  hl_renderer *renderer = NULL;
  stage set;
  hl_scene_volume *volume = open_stage(&set, 0.9, true);
  volume->anisotropy = 0.6;
  stage_set_color(&set, volume, 1, 0.8, 0.5);
  assert_int_equal(hl_renderer_create(set.context, &renderer, NULL), HL_OK);
  for (int k = 0; k < 6; k++) {
    hl_scene *scene = NULL;
    set.scene.render.threads = threads[k % 3];
    volume->albedo[1] = k % 2 == 1 ? 0.3 : 0.9;
    if (k == 5) volume->albedo[1] = 0.9;
    assert_int_equal(hl_scene_create(set.context, &set.scene, &scene, NULL), HL_OK);
    assert_int_equal(hl_renderer_render(renderer, scene, k == 0 ? first : pixels, 4 * SIDE, NULL, NULL),
                     HL_OK);
    hl_scene_release(scene);
    if (k == 2 || k == 4 || k == 5) assert_memory_equal(first, pixels, sizeof first);
    if (k == 1 || k == 3) assert_memory_not_equal(first, pixels, sizeof first);
  }
  hl_renderer_destroy(renderer);
  stage_close(&set);
}

/* The layers of one light and of ambient light add up to the picture. The layer of ambient light contains the
 * light that is scattered more than once. */
static void test_layers_are_the_picture(void **state) {
  (void)state;
  static float pixels[4 * PIXELS], picture[3 * PIXELS], ambient[3 * PIXELS];
  hl_scene *scene = NULL;
  hl_renderer *renderer = NULL;
  stage set;
  open_stage(&set, 0.9, true)->anisotropy = 0.5;
  const hl_light_layers light = {picture, NULL};
  const hl_layers layers = {
      .struct_size = sizeof layers, .lights = &light, .light_count = 1, .ambient = ambient};
  assert_int_equal(hl_renderer_create(set.context, &renderer, NULL), HL_OK);
  assert_int_equal(hl_scene_create(set.context, &set.scene, &scene, NULL), HL_OK);
  assert_int_equal(hl_renderer_render_layers(renderer, scene, pixels, 4 * SIDE, &layers, NULL, NULL), HL_OK);
  for (int i = 0; i < PIXELS; i++)
    for (int c = 0; c < 3; c++)
      assert_near((double)(picture[3 * i + c] + ambient[3 * i + c]), (double)pixels[4 * i + c], 1e-5);
  assert_true(ambient[3 * PIXELS / 2] > 0.1f);
  hl_scene_release(scene);
  hl_renderer_destroy(renderer);
  stage_close(&set);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_deep_inside),
      cmocka_unit_test(test_white_furnace),
      cmocka_unit_test(test_flux_leads_out),
      cmocka_unit_test(test_half_space),
      cmocka_unit_test(test_paths_of_the_reference),
      cmocka_unit_test(test_albedo_scales_one_scattering),
      cmocka_unit_test(test_same_bytes),
      cmocka_unit_test(test_layers_are_the_picture),
  };
  return cmocka_run_group_tests_name("sheets_scattering", tests, NULL, NULL);
}
