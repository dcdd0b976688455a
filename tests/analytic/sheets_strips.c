/* analytic/sheets_strips.c - several renderers make a part of a picture each, and the parts together are the
 * picture, bit for bit: with every method of shadows, several sweeps, hidden matter, oversampling and
 * surfaces. A part computes only the light that its own pixels need. The renderers are threads of one process
 * and exchange light as ranks do. A renderer's next frame uses the memory of the frame before. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "light_meeting.h"
#include "reference_stage.h"
#include "render/renderer_state.h"

enum { WIDTH = 36, HEIGHT = 83, ROW_FLOATS = WIDTH * 4, FLOATS = HEIGHT * ROW_FLOATS };

static void render_part(stage *set, int part, int parts, float *pixels) {
  hl_scene *scene = NULL;
  hl_renderer *renderer = NULL;
  assert_int_equal(hl_scene_create(set->context, &set->scene, &scene, NULL), HL_OK);
  assert_int_equal(hl_renderer_create(set->context, &renderer, NULL), HL_OK);
  assert_int_equal(hl_renderer_share(renderer, part, parts, NULL), HL_OK);
  assert_int_equal(hl_renderer_render(renderer, scene, pixels, ROW_FLOATS, NULL, NULL), HL_OK);
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
}

/* Returns whether the part's picture shows a cell. The test fails if the cell's pixels are neither the whole
 * picture's pixels nor all empty. */
static bool shows_cell(const float *whole, const float *shared, int x, int y, const char *what) {
  bool all = true, none = true;
  for (int row = y * HL_STRIP_ROWS; row < (y + 1) * HL_STRIP_ROWS && row < HEIGHT; row++)
    for (int i = 4 * x * HL_STRIP_ROWS; i < 4 * (x + 1) * HL_STRIP_ROWS && i < ROW_FLOATS; i++) {
      float expected = whole[row * ROW_FLOATS + i], found = shared[row * ROW_FLOATS + i];
      all = all && found == expected;
      none = none && found == 0;
    }
  if (!all && !none) fail_msg("%s: cell %d, %d is neither the picture's nor empty", what, x, y);
  return all && !none;
}

/* Each cell of the picture that shows anything is in one part's picture, with the same pixels as in the whole
 * picture. */
static void assert_parts(stage *set, const float *whole, int parts, const char *what) {
  enum { CELLS_X = (WIDTH + HL_STRIP_ROWS - 1) / HL_STRIP_ROWS, CELLS_Y = (HEIGHT + 15) / HL_STRIP_ROWS };
  static float shared[FLOATS], sum[FLOATS];
  int shown[CELLS_X * CELLS_Y] = {0};
  memset(sum, 0, sizeof sum);
  for (int part = 0; part < parts; part++) {
    render_part(set, part, parts, shared);
    for (int cell = 0; cell < CELLS_X * CELLS_Y; cell++)
      shown[cell] += shows_cell(whole, shared, cell % CELLS_X, cell / CELLS_X, what);
    for (int i = 0; i < FLOATS; i++) sum[i] += shared[i];
  }
  for (int cell = 0; cell < CELLS_X * CELLS_Y; cell++)
    if (shown[cell] > 1) fail_msg("%s: %d of %d parts show a cell", what, shown[cell], parts);
  if (memcmp(sum, whole, sizeof sum) != 0) fail_msg("%s: %d parts do not add up", what, parts);
}

/* Asserts that the parts of a scene's picture add up to the whole picture. count: how many numbers of parts
 * are tried, at most 6. */
static void assert_shared(stage *set, const char *what, size_t count) {
  static float whole[FLOATS];
  static const int numbers[] = {7, 2, 4, 8, 3, 1};
  set->scene.width = WIDTH;
  set->scene.height = HEIGHT;
  stage_render_sheets(set, whole);
  float sum = 0;
  for (int i = 0; i < FLOATS; i++) sum += whole[i];
  assert_true(sum > 100);
  for (size_t n = 0; n < count; n++) assert_parts(set, whole, numbers[n], what);
}

static const size_t noise_size[3] = {30, 28, 33};
static float noise[30 * 28 * 33];

/* threads read the noise, so that it is made before the first test */
static void make_noise(void) {
  const size_t *n = noise_size;
  for (size_t v = 0; v < sizeof noise / sizeof *noise; v++)
    noise[v] = stage_noise((double)(v % n[0]) * 0.5, (double)(v / n[0] % n[1]) * 0.6,
                           (double)(v / n[0] / n[1]) * 0.4);
}

static void add_noise(stage *set, double opacity) {
  const double spacing[3] = {0.7, 0.7, 0.7};
  hl_scene_volume *made = stage_add_grid(set, noise_size, spacing, (vec3){-10, -10, -11}, noise);
  made->shading = HL_SHADING_PHONG;
  stage_set_opacity(set, made, opacity, 6);
  stage_look(set, (vec3){31, 17, 23}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
}

static void soften(stage *set, hl_soft_method method) {
  set->scene.render.shadows = HL_SHADOWS_SOFT;
  set->scene.render.soft_method = method;
}

static void draw_hard(stage *set) { set->scene.render.shadows = HL_SHADOWS_HARD; }
static void draw_paper(stage *set) { soften(set, HL_SOFT_PAPER); }
static void draw_cascade(stage *set) { soften(set, HL_SOFT_CASCADE); }
static void draw_sublights(stage *set) { soften(set, HL_SOFT_SUBLIGHTS); }
/* Little light is left behind opaque matter: most blocks of the sub-lights become dark. */
static void draw_opaque(stage *set) {
  stage_set_opacity(set, &set->volumes[0], 0.9, 1);
  set->scene.light_count = 0;
  stage_add_directional(set, (vec3){1, 1, 1})->angular_diameter_deg = 4;
  set->scene.render.light_samples = 2;
  draw_sublights(set);
}
/* A corner is cut away. The light that comes to the inner corner has passed opaque matter. */
static void draw_hollow(stage *set) {
  static const hl_cut corner = {
      .type = HL_CUT_BOX, .min = {3, 3, 3}, .max = {40, 40, 40}, .keep = HL_CUT_KEEP_OUTSIDE};
  draw_opaque(set);
  set->volumes[0].cuts = &corner;
  set->volumes[0].cut_count = 1;
}
static void draw_maximum(stage *set) { set->scene.render.compositing = HL_COMPOSITING_MAXIMUM; }
static void draw_sky(stage *set) {
  set->scene.sky.type = HL_SKY_UNIFORM;
  for (int c = 0; c < 3; c++) set->scene.sky.color[c] = 0.7;
}
static void draw_isosurface(stage *set) {
  static const hl_isosurface surface = {.value = 0.6, .opacity = 0.8, .color = {0.9, 0.5, 0.3}};
  set->volumes[0].iso = &surface;
  set->volumes[0].iso_count = 1;
}
/* Light comes from behind, so that sheets go from back to front, and a search finds the matter that opaque
 * matter hides. */
static void draw_hidden(stage *set) {
  stage_set_opacity(set, &set->volumes[0], 0.95, 1);
  stage_add_directional(set, (vec3){31, 17, 23});
}
/* Point lights within the volume and beside it have rays in all directions. */
static void draw_within(stage *set) {
  stage_add_point(set, (vec3){1.5, -2.5, 3.5})->radius = 0;
  stage_add_point(set, (vec3){-9, 12, -4})->radius = 0;
}
/* The light shines along the picture's middle ray, so that the light's vanishing point lies within the
 * picture. */
static void draw_ahead(stage *set) {
  set->scene.light_count = 0;
  stage_add_directional(set, (vec3){-31, -17, -23});
  set->scene.camera.type = HL_CAMERA_PERSPECTIVE;
  set->scene.camera.fovy_deg = 60;
}
static void draw_orthographic(stage *set) {
  set->scene.camera.type = HL_CAMERA_ORTHOGRAPHIC;
  set->scene.camera.height = 30;
}
/* The eye is in the volume. */
static void draw_eye_within(stage *set) {
  stage_look(set, (vec3){2, 1, 1.5}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
  set->scene.camera.type = HL_CAMERA_PERSPECTIVE;
  set->scene.camera.fovy_deg = 70;
}
/* Voxels are smaller than pixels, so that each pixel is the mean of several rendered pixels. */
static void draw_small(stage *set) { stage_look(set, (vec3){93, 51, 69}, (vec3){0, 0, 0}, (vec3){0, 0, 1}); }

typedef struct way {
  const char *name;
  void (*draw)(stage *set);
} way;

static void test_ways(void **state) {
  (void)state;
  static const way ways[] = {{"hard", draw_hard},
                             {"paper", draw_paper},
                             {"cascade", draw_cascade},
                             {"sublights", draw_sublights},
                             {"maximum", draw_maximum},
                             {"sky", draw_sky},
                             {"hidden", draw_hidden},
                             {"isosurface", draw_isosurface},
                             {"small pixels", draw_small},
                             {"lights within", draw_within},
                             {"light ahead", draw_ahead},
                             {"orthographic", draw_orthographic},
                             {"eye within", draw_eye_within},
                             {"opaque", draw_opaque},
                             {"hollow", draw_hollow}};
  for (size_t n = 0; n < sizeof ways / sizeof *ways; n++) {
    stage set;
    stage_open(&set);
    add_noise(&set, 0.4);
    stage_add_directional(&set, (vec3){-1, 0.5, -1})->angular_diameter_deg = 10;
    stage_add_point(&set, (vec3){14, 25, 30})->radius = 3;
    set.scene.render.sheet_spacing = 1;
    ways[n].draw(&set);
    assert_shared(&set, ways[n].name, n < 4 ? 6 : 3);
    stage_close(&set);
  }
}

/* Asserts how much light a part of a picture computes. An even cube is seen along z by parallel rays, under
 * light at 45 degrees from the upper left. Parts are bands of rows, and the light of a part is a band of the
 * shadow buffer of the same height. So each of 4 parts needs a fourth of the whole picture's light, and a
 * tile and some pixels on either side. */
static void assert_light_of_part(const char *what, int side, void (*soften_light)(stage *set)) {
  enum { SIDE = 40, PARTS = 4 };
  static float voxels[SIDE * SIDE * SIDE];
  for (size_t v = 0; v < sizeof voxels / sizeof *voxels; v++) voxels[v] = 1;
  uint64_t filled[PARTS + 1];
  float *pixels = malloc((size_t)side * (size_t)side * 4 * sizeof *pixels);
  for (int part = 0; part <= PARTS; part++) {
    stage set;
    stage_open(&set);
    stage_add_grid(&set, (const size_t[3]){SIDE, SIDE, SIDE}, (const double[3]){1, 1, 1},
                   (vec3){-19.5, -19.5, -19.5}, voxels);
    stage_set_opacity(&set, &set.volumes[0], 0.001, 1);
    stage_look(&set, (vec3){0, 0, 90}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
    set.scene.camera.type = HL_CAMERA_ORTHOGRAPHIC;
    set.scene.camera.height = 40;
    stage_add_directional(&set, (vec3){1, 0, -1})->angular_diameter_deg = 1;
    set.scene.width = set.scene.height = side;
    soften_light(&set);
    hl_scene *scene = NULL;
    hl_renderer *renderer = NULL;
    hl_render_statistics statistics = {.struct_size = sizeof statistics};
    assert_int_equal(hl_scene_create(set.context, &set.scene, &scene, NULL), HL_OK);
    assert_int_equal(hl_renderer_create(set.context, &renderer, NULL), HL_OK);
    if (part < PARTS) assert_int_equal(hl_renderer_share(renderer, part, PARTS, NULL), HL_OK);
    assert_int_equal(hl_renderer_render(renderer, scene, pixels, 4 * (size_t)side, &statistics, NULL), HL_OK);
    filled[part] = statistics.pixels_filled_light;
    hl_renderer_destroy(renderer);
    hl_scene_release(scene);
    stage_close(&set);
  }
  free(pixels);
  for (int part = 0; part < PARTS; part++) {
    assert_true(filled[part] > filled[PARTS] / 8);
    if (filled[part] > filled[PARTS] / 2)
      fail_msg("%s: part %d fills %llu of %llu pixels of the light", what, part,
               (unsigned long long)filled[part], (unsigned long long)filled[PARTS]);
  }
}

static void test_light_of_part(void **state) {
  (void)state;
  assert_light_of_part("hard", 512, draw_hard);
  assert_light_of_part("sublights", 256, draw_sublights);
  assert_light_of_part("paper", 512, draw_paper);
}

/* ---- renderers that exchange light ---- */

static void add_soft_noise(stage *set) {
  add_noise(set, 0.4);
  stage_add_directional(set, (vec3){-1, 0.5, -1})->angular_diameter_deg = 10;
  soften(set, HL_SOFT_CASCADE);
}
static void exchange_lamps(stage *set) {
  add_soft_noise(set);
  stage_add_point(set, (vec3){14, 25, 30})->radius = 3;
  stage_add_point(set, (vec3){1.5, -2.5, 3.5})->radius = 0.2; /* within a brick */
}
static void exchange_colors(stage *set) {
  exchange_lamps(set);
  set->volumes[0].attenuation_color[1] = 0.6;
  set->volumes[0].attenuation_color[2] = 0.3;
}
/* Lights shine along the volume's faces and from behind, and one light is wide. */
static void exchange_along(stage *set) {
  add_noise(set, 0.4);
  stage_add_directional(set, (vec3){1, 0, 0})->angular_diameter_deg = 20;
  stage_add_directional(set, (vec3){30, 18, 22})->angular_diameter_deg = 60;
  soften(set, HL_SOFT_CASCADE);
}
/* Most of the matter lies beside the picture. Parts that need no light of it compute its light for the other
 * parts. */
static void exchange_near(stage *set) {
  add_soft_noise(set);
  stage_look(set, (vec3){31, 17, 23}, (vec3){2, 3, -4}, (vec3){0, 0, 1});
  set->scene.camera.fovy_deg = 6;
}
/* The scene has two slabs far apart. The cascade's chunks between the slabs are empty, as are the first
 * chunks of most parts. */
static void exchange_apart(stage *set) {
  add_soft_noise(set);
  const size_t n[3] = {24, 24, 6};
  const double spacing[3] = {0.5, 0.5, 0.5};
  float voxels[24 * 24 * 6];
  for (size_t v = 0; v < sizeof voxels / sizeof *voxels; v++) voxels[v] = 0.8f;
  hl_scene_volume *made = stage_add_grid(set, n, spacing, (vec3){8, -20, 14}, voxels);
  stage_set_opacity(set, made, 0.6, 1);
}
static void exchange_isosurface(stage *set) {
  exchange_lamps(set);
  draw_isosurface(set);
}
static void exchange_mixed(stage *set) {
  add_soft_noise(set);
  stage_add_point(set, (vec3){-9, 12, -4})->radius = 0;
  set->scene.render.soft_method = HL_SOFT_CASCADE;
}

static const way soft_ways[] = {
    {"one light", add_soft_noise},       {"lamps", exchange_lamps}, {"colours", exchange_colors},
    {"along faces", exchange_along},     {"near", exchange_near},   {"apart", exchange_apart},
    {"isosurface", exchange_isosurface}, {"mixed", exchange_mixed}};
enum { SOFT_WAYS = sizeof soft_ways / sizeof *soft_ways };

/* The sum of the parts has the bytes of the whole picture. In the way POSTING, a part goes on with its work
 * until it needs the other parts' light, a chunk later. */
static void test_exchange(void **state) {
  (void)state;
  static const int numbers[] = {7, 2, 8, 3, 4, 1};
  enum { SIDE_X = 100, SIDE_Y = 75 };
  static float whole[SIDE_X * SIDE_Y * 4], sum[SIDE_X * SIDE_Y * 4];
  for (size_t n = 0; n < SOFT_WAYS; n++) {
    stage set;
    part_thread threads[MOST_BANDS];
    stage_open(&set);
    soft_ways[n].draw(&set);
    set.scene.width = SIDE_X;
    set.scene.height = SIDE_Y;
    set.scene.render.sheet_spacing = 1;
    stage_render_sheets(&set, whole);
    stage_close(&set);
    for (size_t i = 0; i < (n == 0 ? sizeof numbers / sizeof *numbers : n == 1 ? 3 : 1); i++) {
      int frames = numbers[i] == 4 ? 2 : 1;
      exchange_way how = (n + i) % 3 == 0 ? POSTING : (n + i) % 3 == 1 ? WAITING : LITTLE_POSTS;
      render_together(threads, numbers[i], how, SIDE_X, SIDE_Y, frames, soft_ways[n].draw, sum);
      if (memcmp(sum, whole, sizeof sum) != 0) fail_msg("%s: %d parts differ", soft_ways[n].name, numbers[i]);
      for (int part = 0; part < numbers[i] && numbers[i] > 1; part++) {
        assert_true(threads[part].gathered > 0);
        if (how != WAITING) assert_true(threads[part].looks > 0);
      }
    }
  }
}

/* Opaque matter hides much of the matter behind it. One light shines from behind, with hard shadows. */
static void exchange_hidden(stage *set) {
  add_noise(set, 0.4);
  draw_hidden(set);
  draw_hard(set);
}

/* Each part searches its own tiles for hidden matter. All parts decide by the sums of two counts over the
 * parts. */
static void test_exchanged_search(void **state) {
  (void)state;
  enum { PARTS = 4, SIDE_X = 100, SIDE_Y = 75, COUNTS = 2 };
  static float whole[SIDE_X * SIDE_Y * 4], sum[SIDE_X * SIDE_Y * 4];
  part_thread alone[1], threads[PARTS];
  render_together(alone, 1, WAITING, SIDE_X, SIDE_Y, 1, exchange_hidden, whole);
  render_together(threads, PARTS, WAITING, SIDE_X, SIDE_Y, 1, exchange_hidden, sum);
  assert_memory_equal(sum, whole, sizeof sum);
  for (int part = 0; part < PARTS; part++)
    assert_int_equal(threads[part].gathered, COUNTS * sizeof(uint64_t));
}

/* The sky has another colour in each direction, over matter of which much stands alone. */
static void exchange_sky(stage *set) {
  exchange_hidden(set);
  set->scene.sky.type = HL_SKY_GRADIENT;
  for (int c = 0; c < 3; c++) {
    set->scene.sky.zenith[c] = 0.9 - 0.2 * c;
    set->scene.sky.horizon[c] = 0.3 + 0.2 * c;
    set->scene.sky.ground[c] = 0.1;
  }
}
static void exchange_sky_colors(stage *set) {
  exchange_sky(set);
  set->volumes[0].attenuation_color[1] = 0.6;
}
/* scenes with surfaces have a sky of more directions */
static void exchange_sky_surface(stage *set) {
  exchange_sky(set);
  draw_isosurface(set);
}
static void exchange_even_sky(stage *set) {
  exchange_hidden(set);
  draw_sky(set);
}

/* Each part finds the sky's light in some slabs of cells and gets the rest from the other parts, once. The
 * next frame keeps the sky's light. */
static void test_exchanged_sky(void **state) {
  (void)state;
  static const way skies[] = {{"sky", exchange_sky},
                              {"colours", exchange_sky_colors},
                              {"surface", exchange_sky_surface},
                              {"even", exchange_even_sky}};
  static const int numbers[] = {7, 2, 4, 3};
  enum { SIDE_X = 50, SIDE_Y = 40, PARTS = 8 };
  static float whole[SIDE_X * SIDE_Y * 4], sum[SIDE_X * SIDE_Y * 4];
  part_thread threads[MOST_BANDS];
  for (size_t n = 0; n < sizeof skies / sizeof *skies; n++) {
    uint64_t gathered[2];
    render_together(threads, 1, WAITING, SIDE_X, SIDE_Y, 1, skies[n].draw, whole);
    assert_true(threads[0].gathered <
                100); /* only the search for hidden matter exchanges bytes, and these are few */
    render_together(threads, numbers[n], WAITING, SIDE_X, SIDE_Y, 1, skies[n].draw, sum);
    if (memcmp(sum, whole, sizeof sum) != 0) fail_msg("%s: %d parts differ", skies[n].name, numbers[n]);
    for (int frames = 1; frames <= 2; frames++) {
      render_together(threads, PARTS, WAITING, SIDE_X, SIDE_Y, frames, skies[n].draw, sum);
      if (memcmp(sum, whole, sizeof sum) != 0) fail_msg("%s: %d frames differ", skies[n].name, frames);
      gathered[frames - 1] = threads[PARTS - 1].gathered;
    }
    assert_true(gathered[0] > 10000);
    assert_true(gathered[1] - gathered[0] < 100);
  }
}

/* Sets a parallel view of 40 units, lit by a wide sun from the side. */
static void look_under_a_sun(stage *set) {
  stage_look(set, (vec3){0, 0, 90}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
  set->scene.camera.type = HL_CAMERA_ORTHOGRAPHIC;
  set->scene.camera.height = 40;
  stage_add_directional(set, (vec3){1, 0, -1})->angular_diameter_deg = 10;
  soften(set, HL_SOFT_CASCADE);
}

/* Adds the cube of test_light_of_part(), under soft light. */
static void exchange_cube(stage *set) {
  enum { SIDE = 40 };
  float *voxels = malloc(SIDE * SIDE * SIDE * sizeof *voxels);
  for (size_t v = 0; v < SIDE * SIDE * SIDE; v++) voxels[v] = 1;
  stage_add_grid(set, (const size_t[3]){SIDE, SIDE, SIDE}, (const double[3]){1, 1, 1},
                 (vec3){-19.5, -19.5, -19.5}, voxels);
  free(voxels);
  stage_set_opacity(set, &set->volumes[0], 0.001, 1);
  look_under_a_sun(set);
}

/* Each of 4 parts fills a fourth of the shadow buffer, and a tile and some pixels on either side. Messages
 * bring the light that matter of the other parts absorbs. */
static void test_exchanged_light(void **state) {
  (void)state;
  enum { PARTS = 4 };
  static float pixels[TOGETHER_SIDE * TOGETHER_SIDE * 4];
  part_thread alone[1], threads[PARTS];
  render_together(alone, 1, WAITING, TOGETHER_SIDE, TOGETHER_SIDE, 1, exchange_cube, pixels);
  render_together(threads, PARTS, POSTING, TOGETHER_SIDE, TOGETHER_SIDE, 1, exchange_cube, pixels);
  assert_true(alone[0].gathered == 0 && alone[0].filled > 100000);
  for (int part = 0; part < PARTS; part++) {
    assert_true(threads[part].filled > alone[0].filled / 8);
    if (threads[part].filled > alone[0].filled / 2)
      fail_msg("part %d fills %llu of %llu pixels of the light", part,
               (unsigned long long)threads[part].filled, (unsigned long long)alone[0].filled);
  }
}

/* The matter before the picture's upper half is near the light, and the matter before its lower half is far
 * from the light. */
static void exchange_two_depths(stage *set) {
  enum { WIDE = 40, HIGH = 20, DEEP = 4 };
  float voxels[WIDE * HIGH * DEEP]; /* each part's thread has voxels of its own */
  const size_t n[3] = {WIDE, HIGH, DEEP};
  const double spacing[3] = {1, 1, 1};
  for (size_t v = 0; v < sizeof voxels / sizeof *voxels; v++) voxels[v] = 1;
  for (int half = 0; half < 2; half++) {
    hl_scene_volume *made = stage_add_grid(
        set, n, spacing, half == 0 ? (vec3){-19.5, 0.5, 14} : (vec3){-19.5, -19.5, -18}, voxels);
    stage_set_opacity(set, made, 0.001, 1);
  }
  look_under_a_sun(set);
}

/* If two parts had a band of rows each, one part would wait for the other at all depths. So each part has
 * bands in both halves of the picture, with about as many rows in either half. */
static void test_bands_at_depths(void **state) {
  (void)state;
  enum { PARTS = 2, HALF = TOGETHER_SIDE / 2 };
  static float pixels[TOGETHER_SIDE * TOGETHER_SIDE * 4];
  part_thread threads[PARTS];
  render_together(threads, PARTS, POSTING, TOGETHER_SIDE, TOGETHER_SIDE, 1, exchange_two_depths, pixels);
  for (int part = 0; part < PARTS; part++)
    for (int half = 0; half < 2; half++) {
      int rows = 0;
      for (int y = half * HALF; y < (half + 1) * HALF; y++)
        rows += threads[part].pixels[((size_t)y * TOGETHER_SIDE + HALF) * 4 + 3] > 0;
      if (rows < HALF * 3 / 8 || rows > HALF * 5 / 8)
        fail_msg("part %d has %d of %d rows of half %d", part, rows, HALF, half);
    }
}

/* A mesh of balls stands in the noise, so that there is matter in their shadow. */
static hl_mesh *add_balls(stage *set, hl_scene_mesh *balls) {
  static const float spheres[3][4] = {{0, 0, 0, 3}, {4, -5, 2, 2}, {-5, 3, -3, 2.5f}};
  hl_mesh_description d;
  hl_mesh *made = NULL;
  hl_mesh_description_defaults(&d);
  d.spheres = spheres, d.sphere_count = sizeof spheres / sizeof *spheres;
  assert_int_equal(hl_mesh_create(set->context, &d, &made, NULL), HL_OK);
  hl_scene_mesh_defaults(balls);
  balls->mesh = made;
  balls->material = (hl_material){.diffuse = 1};
  for (int c = 0; c < 3; c++) balls->color[c] = 1;
  set->scene.meshes = balls, set->scene.mesh_count = 1;
  return made;
}

/* Parts with soft shadows by sub-lights and by the paper's method need not exchange light. The scenes have
 * balls in the noise, or no balls. */
static void test_divided(void **state) {
  (void)state;
  static const hl_soft_method methods[] = {HL_SOFT_SUBLIGHTS, HL_SOFT_PAPER};
  for (size_t n = 0; n < 2 * SOFT_WAYS; n++)
    for (size_t method = 0; method < sizeof methods / sizeof *methods; method++) {
      if (n % 2 == 0 && n / 2 != 1) continue; /* only one of the ways is drawn without balls */
      stage set;
      hl_scene_mesh balls;
      hl_mesh *made = NULL;
      stage_open(&set);
      soft_ways[n / 2].draw(&set);
      soften(&set, methods[method]);
      set.scene.render.sheet_spacing = 1;
      if (n % 2 == 1) made = add_balls(&set, &balls);
      assert_shared(&set, soft_ways[n / 2].name, n / 2 == 1 ? 3 : 1);
      hl_mesh_release(made);
      stage_close(&set);
    }
}

/* Lights use the cascade's memory in turn, and so does the next frame. Each light leaves the memory filled
 * with zeros. */
static void test_next_frame(void **state) {
  (void)state;
  static const struct {
    int width, height;
    double spacing;
  } cases[] = {{53, 39, 1}, {92, 69, 0.75}};
  static float first[92 * 69 * 4], next[92 * 69 * 4];
  for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
    stage set;
    hl_scene_mesh balls;
    hl_renderer *renderer = NULL;
    stage_open(&set);
    exchange_lamps(&set);
    hl_mesh *made = add_balls(&set, &balls);
    set.scene.width = cases[n].width;
    set.scene.height = cases[n].height;
    set.scene.render.sheet_spacing = cases[n].spacing;
    assert_int_equal(hl_renderer_create(set.context, &renderer, NULL), HL_OK);
    stage_render_with(&set, renderer, first);
    stage_render_with(&set, renderer, next);
    assert_memory_equal(next, first, sizeof *first * 4 * (size_t)(cases[n].width * cases[n].height));
    hl_renderer_destroy(renderer);
    hl_mesh_release(made);
    stage_close(&set);
  }
}

static void test_refused(void **state) {
  (void)state;
  static float pixels[FLOATS], ambient[FLOATS];
  static const int wrong[][2] = {{0, 0}, {-1, 3}, {3, 3}, {0, -2}};
  stage set;
  hl_scene *scene = NULL;
  hl_renderer *renderer = NULL;
  hl_error error = {0};
  stage_open(&set);
  add_noise(&set, 0.4);
  set.scene.width = WIDTH;
  set.scene.height = HEIGHT;
  assert_int_equal(hl_scene_create(set.context, &set.scene, &scene, NULL), HL_OK);
  assert_int_equal(hl_renderer_create(set.context, &renderer, NULL), HL_OK);
  for (size_t n = 0; n < sizeof wrong / sizeof *wrong; n++)
    assert_int_equal(hl_renderer_share(renderer, wrong[n][0], wrong[n][1], &error), HL_ERROR_ARGUMENT);
  assert_string_equal(error.message, "hl_renderer_share: part 0 of -2: give 0 to parts - 1 of at least 1");
  assert_int_equal(hl_renderer_share(NULL, 0, 1, &error), HL_ERROR_ARGUMENT);
  assert_int_equal(hl_renderer_share(renderer, 1, 2, &error), HL_OK);
  hl_layers layers = {.struct_size = sizeof layers, .ambient = ambient};
  assert_int_equal(hl_renderer_render_layers(renderer, scene, pixels, ROW_FLOATS, &layers, NULL, &error),
                   HL_ERROR_UNSUPPORTED);
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
  stage_close(&set);
}

/* usage: sheets_strips [TESTS]: runs the tests whose names match. */
int main(int count, char **arguments) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_ways),
                                     cmocka_unit_test(test_light_of_part),
                                     cmocka_unit_test(test_exchange),
                                     cmocka_unit_test(test_exchanged_light),
                                     cmocka_unit_test(test_bands_at_depths),
                                     cmocka_unit_test(test_exchanged_search),
                                     cmocka_unit_test(test_exchanged_sky),
                                     cmocka_unit_test(test_divided),
                                     cmocka_unit_test(test_next_frame),
                                     cmocka_unit_test(test_refused)};
  make_noise();
  if (count > 1) cmocka_set_test_filter(arguments[1]);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
