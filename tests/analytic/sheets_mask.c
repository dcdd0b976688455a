/* analytic/sheets_mask.c - a label map as the mask of a volume. The extinction and colour of masked matter
 * are known in closed form far from the labels' borders, and as a mean across borders. Each closed form is
 * tested on the sheets and on the reference. */
#include <stdlib.h>
#include <string.h>

#include "../asserts.h"
#include "label/mask.h"
#include "reference_stage.h"
#include "scene/scene.h"
#include "volume/volume.h"

enum { SIDE = 32, PIXELS = SIDE * SIDE, N = 32, HALF = 16 };

/* Makes a label map of 16^3 voxels around the origin, each two units long. For |y| < 8 the label is 1 where x
 * < 0 and 2 where x > 0; for other y the label is 0. */
static hl_volume *make_map(stage *set) {
  static unsigned char voxels[HALF * HALF * HALF];
  hl_volume_description d;
  hl_volume *map = NULL;
  for (int k = 0; k < HALF; k++)
    for (int j = 0; j < HALF; j++)
      for (int i = 0; i < HALF; i++)
        voxels[(k * HALF + j) * HALF + i] = j < HALF / 4 || j >= HALF - HALF / 4 ? 0 : i < HALF / 2 ? 1 : 2;
  hl_volume_description_defaults(&d);
  for (int a = 0; a < 3; a++) {
    d.dimensions[a] = HALF;
    d.axis[a][a] = 2;
    d.origin[a] = -HALF + 1;
  }
  d.type = HL_VOXEL_U8;
  d.voxels = voxels;
  assert_int_equal(hl_volume_create(set->context, &d, &map, NULL), HL_OK);
  return map;
}

/* Opens a scene of a cube of 32^3 voxels with a mask, seen along -z. The cube's opacity is 0.05 a unit
 * everywhere. The caller releases volume->mask.volume. */
static hl_scene_volume *open_masked(stage *set, const hl_label *labels, size_t count, double rest) {
  stage_open(set);
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.height = N;
  stage_look(set, (vec3){0, 0, 100}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
  hl_scene_volume *cube = stage_add_grid(set, (size_t[3]){N, N, N}, (double[3]){1, 1, 1},
                                         (vec3){-N / 2, -N / 2, -N / 2}, NULL);
  stage_set_opacity(set, cube, 0.05, 1);
  stage_set_color(set, cube, 0.2, 0.4, 0.8);
  cube->shading = HL_SHADING_FLAT;
  cube->mask = (hl_mask){.volume = make_map(set), .labels = labels, .label_count = count, .rest = rest};
  return cube;
}

static void close_masked(stage *set, hl_scene_volume *cube) {
  hl_volume_release(cube->mask.volume);
  stage_close(set);
}

static const float *pixel_at(const float *pixels, double x, double y) {
  int column = (int)((x / N + 0.5) * SIDE), row = (int)((0.5 - y / N) * SIDE);
  return &pixels[4 * (row * SIDE + column)];
}

/* In a part with the factor f, alpha is 1 - 0.95^(32 f). */
static double alpha_of(double factor) { return 1 - pow(0.95, N * factor); }

static const hl_label LABELS[] = {
    {.value = 1, .color = {0.81, 0.09, 0.25}, .opacity = 0.5, .visible = 1, .tint = 1},
    {.value = 2, .color = {0.04, 0.64, 0.16}, .opacity = 1, .visible = 1, .tint = 0}};

/* Far from borders, each label's matter and the rest of the matter have their own factor and colour. */
static void test_factors_and_colors(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  for (int k = 0; k < 4; k++) {
    stage set;
    hl_scene_volume *cube = open_masked(&set, LABELS, 2, k % 2 ? 0.1 : 0);
    stage_render_by(&set, k >= 2, pixels);
    const float *left = pixel_at(pixels, -8, 0), *right = pixel_at(pixels, 8, 0),
                *rest = pixel_at(pixels, 8, 14.5);
    assert_near((double)left[3], alpha_of(0.5), 1e-4);
    assert_near((double)right[3], alpha_of(1), 1e-4);
    assert_near((double)rest[3], k % 2 ? alpha_of(0.1) : 0, 1e-4);
    static const double colors[3] = {0.2, 0.4, 0.8};
    for (int c = 0; c < 3; c++) { /* a channel of a colour is stored with 8 bits */
      assert_near((double)left[c] / (double)left[3], LABELS[0].color[c], 4e-3);
      assert_near((double)right[c] / (double)right[3], colors[c], 1e-4);
    }
    close_masked(&set, cube);
  }
}

/* Across a border, the factor changes smoothly from one label's factor to the other label's. The mean over a
 * line that is symmetric to the border is the mean of the two factors. So the border lies where the labels
 * meet. */
static void test_border_is_smooth_and_in_place(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  for (int reference = 0; reference < 2; reference++) {
    stage set;
    hl_scene_volume *cube = open_masked(&set, LABELS, 2, 0);
    stage_render_by(&set, reference, pixels);
    double sum = 0, before = 0.5;
    for (int x = 4; x < SIDE - 4; x++) {
      double alpha = (double)pixels[4 * (SIDE / 2 * SIDE + x) + 3], factor = log1p(-alpha) / (N * log(0.95));
      assert_true(factor >= before - 1e-3 && factor - before < 0.25);
      sum += factor / (SIDE - 8);
      before = factor;
    }
    assert_near(sum, 0.75, 2e-3);
    close_masked(&set, cube);
  }
}

/* Returns whether all points of a brick of the lattice have the bytes of the brick's first point. */
static bool brick_is_even(const void *values, size_t bytes, const size_t brick[3]) {
  const unsigned char *from = values, *one = NULL;
  for (int n = 0; n < 5 * 5 * 5; n++) {
    size_t i = 4 * brick[0] + (size_t)(n % 5), j = 4 * brick[1] + (size_t)(n / 5 % 5),
           k = 4 * brick[2] + (size_t)(n / 25);
    if (i >= N || j >= N || k >= N) continue;
    const unsigned char *at = from + ((k * N + j) * N + i) * bytes;
    if (one == NULL) one = at;
    if (memcmp(one, at, bytes) != 0) return false;
  }
  return true;
}

/* Makes a label map of 32^3 voxels: label 1 in one half, label 2 in a corner, and 0 elsewhere. */
static hl_volume *make_large_map(stage *set) {
  static unsigned char voxels[N * N * N];
  hl_volume_description d;
  hl_volume *map = NULL;
  for (int n = 0; n < N * N * N; n++)
    voxels[n] = n % N < 16 ? 1 : n % N > 26 && n / N % N > 26 && n / (N * N) > 26 ? 2 : 0;
  hl_volume_description_defaults(&d);
  for (int a = 0; a < 3; a++) {
    d.dimensions[a] = N;
    d.origin[a] = 0.5 - N / 2;
  }
  d.type = HL_VOXEL_U8;
  d.voxels = voxels;
  assert_int_equal(hl_volume_create(set->context, &d, &map, NULL), HL_OK);
  return map;
}

/* Each brick of the lattice that is marked as even has one value, and the mark holds this value. Some bricks
 * are even and some are not. */
static void test_bricks_are_told(void **state) {
  (void)state;
  stage set;
  hl_volume *map, *made = NULL;
  stage_open(&set);
  map = make_large_map(&set);
  const hl_mask mask = {.volume = map, .labels = LABELS, .label_count = 2, .rest = 0.1};
  int even[2] = {0, 0}, count = 0;
  assert_int_equal(hl_label_mask(set.context, 1, &mask, &made, NULL), HL_OK);
  for (size_t k = 0; k < N / 4; k++)
    for (size_t j = 0; j < N / 4; j++)
      for (size_t i = 0; i < N / 4; i++, count++) {
        const size_t brick[3] = {i, j, k}, first = 4 * ((k * N + j) * N + i);
        const uint32_t *words = made->mask_bricks[count];
        uint32_t color;
        memcpy(&color, made->colors + 4 * first, 4);
        bool flat = brick_is_even(made->voxels, 2, brick), level = brick_is_even(made->slopes, 4, brick),
             colored = brick_is_even(made->colors, 4, brick),
             no_slope = made->slopes[4 * first] == 0 && made->slopes[4 * first + 1] == 0 &&
                        made->slopes[4 * first + 2] == 0;
        assert_int_equal((words[0] & HL_MASK_EVEN) != 0, flat && level && no_slope);
        assert_int_equal((words[0] & HL_MASK_EVEN_COLOR) != 0, colored);
        assert_int_equal(words[0] & 0xffff, ((const uint16_t *)made->voxels)[first]);
        if (colored) assert_int_equal(words[1], color);
        even[0] += flat && level && no_slope, even[1] += colored;
      }
  for (int n = 0; n < 2; n++) assert_true(even[n] > 0 && even[n] < count);
  hl_volume_release(made);
  hl_volume_release(map);
  stage_close(&set);
}

/* The voxels of bricks that are marked as even are not read. The marks change the picture only by the
 * rounding of colours.
 */
static void test_bricks_change_nothing(void **state) {
  (void)state;
  static float pixels[2][PIXELS * 4];
  for (int tint = 0; tint < 2; tint++) {
    hl_label labels[2] = {LABELS[0], LABELS[1]};
    labels[0].tint = tint;
    stage set;
    hl_scene_volume *cube = open_masked(&set, labels, 2, 0.1);
    hl_volume *made = NULL;
    size_t even = 0;
    hl_volume_release(cube->mask.volume);
    cube->mask.volume = make_large_map(&set);
    cube->shading = HL_SHADING_PHONG;
    stage_render_by(&set, false, pixels[0]);
    /* the label map keeps the lattice for later scenes */
    assert_int_equal(hl_label_mask(set.context, 1, &cube->mask, &made, NULL), HL_OK);
    for (int n = 0; n < N * N * N / 64; n++) {
      even += (made->mask_bricks[n][0] & HL_MASK_EVEN) != 0;
      made->mask_bricks[n][0] = 0;
    }
    assert_true(even > 64);
    hl_volume_release(made);
    stage_render_by(&set, false, pixels[1]);
    for (int i = 0; i < PIXELS * 4; i++)
      assert_near((double)pixels[1][i], (double)pixels[0][i], tint ? 1e-6 : 0);
    close_masked(&set, cube);
  }
}

/* A label that is set invisible, or is not listed, hides the matter. */
static void test_hidden(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  for (int k = 0; k < 2; k++) {
    hl_label labels[2] = {LABELS[0], LABELS[1]};
    labels[1].visible = 0;
    stage set;
    hl_scene_volume *cube = open_masked(&set, labels, k ? 1 : 2, k ? 0 : 1);
    stage_render_by(&set, false, pixels);
    assert_near((double)pixel_at(pixels, 8, 0)[3], 0, 1e-6);
    assert_near((double)pixel_at(pixels, -8, 0)[3], alpha_of(0.5), 1e-4);
    assert_near((double)pixel_at(pixels, 8, 14.5)[3], k ? 0 : alpha_of(1), 1e-4);
    close_masked(&set, cube);
  }
}

/* The mask moves with the volume. If mask and volume are turned and moved together with the camera, the
 * picture stays the same.
 */
static void test_moves_with_the_volume(void **state) {
  (void)state;
  static float pixels[2][PIXELS * 4];
  for (int moved = 0; moved < 2; moved++) {
    stage set;
    hl_scene_volume *cube = open_masked(&set, LABELS, 2, 0.1);
    if (moved) {
      memcpy(cube->rotate_axis, (double[3]){0, 1, 0}, sizeof cube->rotate_axis);
      cube->rotate_angle_deg = 90; /* z becomes x */
      cube->translate[0] = 500;
      stage_look(&set, (vec3){600, 0, 0}, (vec3){500, 0, 0}, (vec3){0, 1, 0});
    }
    stage_render_by(&set, false, pixels[moved]);
    close_masked(&set, cube);
  }
  for (int i = 0; i < 4 * PIXELS; i++) assert_near((double)pixels[1][i], (double)pixels[0][i], 2e-3);
}

/* Makes a label map of the same size as make_map() does, with label 1 everywhere except between two
 * heights. */
static hl_volume *make_layer(stage *set) {
  static unsigned char voxels[HALF * HALF * HALF];
  hl_volume *map = make_map(set);
  hl_volume_description d = stage_describe_volume(map);
  for (int n = 0; n < HALF * HALF * HALF; n++)
    voxels[n] = n / (HALF * HALF) < 4 || n / (HALF * HALF) > 11 ? 1 : 0;
  d.voxels = voxels;
  hl_volume_release(map);
  assert_int_equal(hl_volume_create(set->context, &d, &map, NULL), HL_OK);
  return map;
}

/* Fills voxels with a ball above a floor. more: adds a sheet of matter between ball and floor, in the layer
 * that the mask hides. The mask's factor is 0 in the sheet, but the sheet's bricks are kept, because the mask
 * does not hide their neighbours. */
static void fill_ball_and_floor(float *voxels, bool more) {
  for (int n = 0; n < N * N * N; n++) {
    const int i = n % N - 16, j = n / N % N - 16, k = n / (N * N) - 16;
    const int floor = k < -11, ball = i * i + j * j + (k - 10) * (k - 10) < 20,
              sheet = more && abs(i) < 9 && abs(j) < 9 && k == -3;
    voxels[n] = floor || ball || sheet ? 1 : 0;
  }
}

/* Matter that a mask hides absorbs no light. So hidden matter does not change the soft shadows of surfaces by
 * a single bit. */
static void test_hidden_matter_leaves_no_trace(void **state) {
  (void)state;
  static float pixels[2][PIXELS * 4], voxels[N * N * N];
  static const hl_opacity_point rising[] = {{0.2, 0}, {0.6, 0.9}};
  const hl_label shown = {.value = 1, .opacity = 1, .visible = 1};
  for (int turn = 0; turn < 6; turn++) {
    for (int more = 0; more < 2; more++) {
      stage set;
      stage_open(&set);
      set.scene.width = set.scene.height = SIDE;
      set.scene.camera.height = N;
      fill_ball_and_floor(voxels, more);
      hl_scene_volume *cube = stage_add_grid(&set, (size_t[3]){N, N, N}, (double[3]){1, 1, 1},
                                             (vec3){-N / 2, -N / 2, -N / 2}, voxels);
      cube->mask = (hl_mask){.volume = make_layer(&set), .labels = &shown, .label_count = 1};
      cube->transfer_function.opacity = rising;
      cube->transfer_function.opacity_count = 2;
      cube->shading = HL_SHADING_PHONG;
      stage_look(&set, (vec3){-60, -50, 70}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
      stage_add_directional(&set, (vec3){0.1 * turn, 0.2, -1})->angular_diameter_deg = 12;
      set.scene.render.shadows = HL_SHADOWS_SOFT;
      stage_render_sheets(&set, pixels[more]);
      close_masked(&set, cube);
    }
    assert_memory_equal(pixels[0], pixels[1], sizeof pixels[0]);
    int seen = 0;
    for (int i = 0; i < PIXELS; i++) seen += pixels[0][4 * i + 3] > 0.5f;
    assert_true(seen > PIXELS / 10);
  }
}

enum { COARSE = 12 };

/* Renders the masked cube as a lit medium, in a picture of 12 x 12 pixels. method: -1: hard shadows. */
static void render_lit(int method, bool reference, float *pixels) {
  stage set;
  hl_scene_volume *cube = open_masked(&set, LABELS, 2, 0.1);
  set.scene.width = set.scene.height = COARSE;
  cube->shading = HL_SHADING_NONE;
  stage_add_directional(&set, (vec3){-1, -0.4, -0.6})->angular_diameter_deg = method < 0 ? 0 : 8;
  set.scene.render.shadows = method < 0 ? HL_SHADOWS_HARD : HL_SHADOWS_SOFT;
  if (method >= 0) set.scene.render.soft_method = (hl_soft_method)method;
  stage_render_by(&set, reference, pixels);
  close_masked(&set, cube);
}

/* Light in masked matter is absorbed according to the labels' factors. By every method of shadows, the
 * picture is near the reference's. */
static void test_shadows_against_the_reference(void **state) {
  (void)state;
  static float expected[COARSE * COARSE * 4], pixels[COARSE * COARSE * 4];
  for (int method = -1; method < 3; method++) {
    if (method <= 0) render_lit(method, true, expected);
    render_lit(method, false, pixels);
    double sum = 0;
    for (int i = 0; i < COARSE * COARSE * 4; i++) {
      double d = (double)pixels[i] - (double)expected[i];
      sum += d * d / (COARSE * COARSE * 4);
    }
    assert_near(sqrt(sum), 0, 6e-3);
  }
}

/* ---- a label as a knife ---- */

static const hl_label KNIFE[] = {{.value = 2, .opacity = 1}};

/* Opens a scene of even, dense matter without shadows. The mask removes the half with x > 0, and the eye
 * looks from the side of the removed half. */
static hl_scene_volume *open_cut(stage *set) {
  hl_scene_volume *cube = open_masked(set, KNIFE, 1, 1);
  stage_set_opacity(set, cube, 0.9, 1);
  stage_set_color(set, cube, 1, 1, 1);
  cube->shading = HL_SHADING_PHONG;
  cube->material = (hl_material){.diffuse = 1};
  set->scene.render.shadows = HL_SHADOWS_OFF;
  stage_look(set, (vec3){100, 0, 0}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
  return cube;
}

/* The matter itself has no gradient. With shading by faces, the matter is lit at the label's border as a
 * surface, by the cosine of the border's normal to the light. With shading by the data's gradient, the matter
 * is a medium, which looks the same from any side. */
static void test_faces_of_a_knife(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  static const vec3 lights[] = {{-1, 0, 0}, {-1, 0, 0.7}, {-0.5, 0, -0.9}};
  for (int by_reference = 0; by_reference < 2; by_reference++)
    for (int l = 0; l < 3; l++)
      for (int by_face = 0; by_face < 2; by_face++) {
        stage set;
        hl_scene_volume *cube = open_cut(&set);
        cube->cut_shading = by_face ? HL_CUT_SHADING_FACE : HL_CUT_SHADING_GRADIENT;
        const vec3 light = vec3_normalise(lights[l]);
        stage_add_directional(&set, light);
        stage_render_by(&set, by_reference, pixels);
        const float *middle = &pixels[4 * (SIDE / 2 * SIDE + SIDE / 2)];
        assert_near((double)middle[0] / (double)middle[3], by_face ? -light.x : 1, 0.01);
        close_masked(&set, cube);
      }
}

/* Bricks that the mask hides are left out unless they are neighbours of visible matter: if the label in the
 * half with x > 0 is hidden, two fifths of this half are left out. If the matter outside of all labels shows,
 * all bricks are kept. */
static void test_hidden_voxels_are_not_kept(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  const hl_label one = {.value = 1, .opacity = 1, .visible = 1};
  for (int shown = 0; shown < 2; shown++) {
    stage set;
    hl_scene_volume *cube = open_masked(&set, &one, 1, shown ? 0.1 : 0);
    uint64_t kept = stage_render_counted(&set, pixels).voxels_kept;
    close_masked(&set, cube);
    if (shown) assert_true(kept == N * N * N);
    else assert_true(kept >= N * N * N * 3 / 5 && kept < N * N * N * 7 / 8);
  }
}

/* Renders waves in 32^3 voxels. If sheets lay elsewhere, the waves' surfaces would look different. The mask
 * shows all waves, or the half with x < 0. */
static void render_waves(bool masked, float *pixels) {
  static float voxels[N * N * N];
  static const hl_opacity_point steep[] = {{0.45, 0}, {0.55, 0.9}};
  static const hl_label one = {.value = 1, .opacity = 1, .visible = 1};
  stage set;
  stage_open(&set);
  for (int n = 0; n < N * N * N; n++)
    voxels[n] = (float)(0.5 + 0.5 * sin(0.5 * (n % N)) * cos(0.4 * (n / N % N)) * sin(0.3 * (n / (N * N))));
  set.scene.width = set.scene.height = SIDE;
  set.scene.camera.height = N;
  set.scene.render.shadows = HL_SHADOWS_OFF;
  stage_look(&set, (vec3){40, 0, 100}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
  hl_scene_volume *cube = stage_add_grid(&set, (size_t[3]){N, N, N}, (double[3]){1, 1, 1},
                                         (vec3){-N / 2, -N / 2, -N / 2}, voxels);
  hl_volume *map = make_large_map(&set);
  cube->transfer_function.opacity = steep;
  cube->transfer_function.opacity_count = 2;
  cube->shading = HL_SHADING_PHONG;
  stage_add_directional(&set, vec3_normalise((vec3){0.3, -0.5, -1}));
  if (masked) cube->mask = (hl_mask){.volume = map, .labels = &one, .label_count = 1};
  stage_render_by(&set, false, pixels);
  hl_volume_release(map);
  stage_close(&set);
}

/* If hidden bricks are left out, the sheets stay in their places. Rays that cross only matter with the factor
 * 1 give the same bytes. */
static void test_no_mask_moves_the_sheets(void **state) {
  (void)state;
  static float pixels[2][PIXELS * 4];
  int seen = 0;
  for (int masked = 0; masked < 2; masked++) render_waves(masked, pixels[masked]);
  for (int row = 0; row < SIDE; row++)
    for (int column = 0; column < 5; column++) {
      const float *all = &pixels[0][4 * (row * SIDE + column)], *half = &pixels[1][4 * (row * SIDE + column)];
      assert_memory_equal(all, half, 4 * sizeof *all);
      seen += all[3] > 0.1f;
    }
  assert_true(seen > 2 * SIDE);
}

/* Renders haze that scatters light repeatedly at x < -4 and nearly transparent matter elsewhere. The mask
 * shows everything, or the half with x < 0. */
static void render_haze(bool masked, float *pixels) {
  static float voxels[N * N * N];
  static const hl_opacity_point faint[] = {{0.3, 1e-7}, {0.4, 1e-7}, {0.5, 0.2}};
  static const hl_label one = {.value = 1, .opacity = 1, .visible = 1};
  stage set;
  stage_open(&set);
  for (int n = 0; n < N * N * N; n++) voxels[n] = n % N < N / 2 - 4 ? 0.5f : 0.3f;
  set.scene.width = set.scene.height = SIDE;
  set.scene.camera.height = N;
  set.scene.render.shadows = HL_SHADOWS_HARD;
  stage_look(&set, (vec3){0, 0, 100}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
  hl_scene_volume *cube = stage_add_grid(&set, (size_t[3]){N, N, N}, (double[3]){1, 1, 1},
                                         (vec3){-N / 2, -N / 2, -N / 2}, voxels);
  hl_volume *map = make_large_map(&set);
  cube->transfer_function.opacity = faint;
  cube->transfer_function.opacity_count = 3;
  cube->shading = HL_SHADING_NONE;
  cube->multiple_scattering = 1;
  stage_add_directional(&set, vec3_normalise((vec3){0.3, -0.5, -1}));
  if (masked) cube->mask = (hl_mask){.volume = map, .labels = &one, .label_count = 1};
  stage_render_by(&set, false, pixels);
  hl_volume_release(map);
  stage_close(&set);
}

/* Bricks that a mask hides do not change the grid of scattered light. */
static void test_no_mask_moves_the_nodes(void **state) {
  (void)state;
  static float pixels[2][PIXELS * 4];
  for (int masked = 0; masked < 2; masked++) render_haze(masked, pixels[masked]);
  for (int i = 0; i < 4 * PIXELS; i++) assert_near((double)pixels[0][i], (double)pixels[1][i], 2e-5);
  assert_true(pixels[1][4 * (SIDE / 2 * SIDE + 4)] > 0.3f);
}

/* A scene with the same map, labels and rest uses the lattice that an earlier scene has made. A scene with a
 * changed label makes a new lattice. */
static void test_lattice_is_kept(void **state) {
  (void)state;
  hl_label labels[2] = {LABELS[0], LABELS[1]};
  stage set;
  hl_scene *scenes[3] = {NULL};
  const hl_volume *lattices[3];
  hl_scene_volume *cube = open_masked(&set, labels, 2, 0.1);
  for (int n = 0; n < 3; n++) {
    labels[1].opacity = n < 2 ? 1 : 0.7;
    const drawn_scene *drawn;
    assert_int_equal(hl_scene_create(set.context, &set.scene, &scenes[n], NULL), HL_OK);
    assert_int_equal(hl_scene_draw(scenes[n], &drawn, NULL), HL_OK);
    lattices[n] = drawn->description.volumes[0].mask.volume;
  }
  assert_ptr_equal(lattices[1], lattices[0]);
  assert_ptr_not_equal(lattices[2], lattices[0]);
  for (int n = 0; n < 3; n++) hl_scene_release(scenes[n]);
  close_masked(&set, cube);
}

static void test_wrong_masks_are_refused(void **state) {
  (void)state;
  stage set;
  hl_scene_volume *cube = open_masked(&set, LABELS, 2, 1.5);
  stage_refused(&set, "/volumes/0/mask/rest: 1.5 is out of range: give a factor from 0 to 1");
  hl_label wrong = LABELS[0];
  wrong.tint = 2;
  cube->mask.rest = 0;
  cube->mask.labels = &wrong;
  cube->mask.label_count = 1;
  stage_refused(&set, "/volumes/0/mask/labels/0/tint: 2 is out of range: give a tint from 0 to 1");
  hl_volume *map = cube->mask.volume;
  cube->mask.volume = NULL;
  stage_refused(&set, "/volumes/0/mask: has no label map: give its file");
  cube->mask.volume = map;
  close_masked(&set, cube);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_factors_and_colors),
      cmocka_unit_test(test_border_is_smooth_and_in_place),
      cmocka_unit_test(test_hidden),
      cmocka_unit_test(test_hidden_matter_leaves_no_trace),
      cmocka_unit_test(test_moves_with_the_volume),
      cmocka_unit_test(test_shadows_against_the_reference),
      cmocka_unit_test(test_faces_of_a_knife),
      cmocka_unit_test(test_hidden_voxels_are_not_kept),
      cmocka_unit_test(test_no_mask_moves_the_sheets),
      cmocka_unit_test(test_no_mask_moves_the_nodes),
      cmocka_unit_test(test_lattice_is_kept),
      cmocka_unit_test(test_bricks_are_told),
      cmocka_unit_test(test_bricks_change_nothing),
      cmocka_unit_test(test_wrong_masks_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
