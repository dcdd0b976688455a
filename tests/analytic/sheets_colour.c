/* analytic/sheets_colour.c - the colours of pictures: flat shading, emission, scattering, and volumes that
 * are stretched along three axes. Each closed form is tested on the sheets and on the reference. */
#include <stdlib.h>
#include <string.h>

#include "../asserts.h"
#include "reference_stage.h"

enum { SIDE = 24, PIXELS = SIDE * SIDE };

/* A homogeneous slab, 4 units thick, fills the picture. Two lights shine from its two sides, in sweeps of
 * their own. */
static hl_scene_volume *open_slab(stage *set, double opacity) {
  stage_open(set);
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.height = 12;
  set->scene.ambient[0] = 0.3;
  set->scene.ambient[1] = 0.5;
  hl_scene_volume *slab = stage_add_grid(set, (size_t[3]){16, 16, 4}, (double[3]){1, 1, 1},
                                         (vec3){-8, -8, -2}, NULL);
  stage_set_opacity(set, slab, opacity, 1);
  stage_set_color(set, slab, 0.2, 0.5, 0.8);
  stage_look(set, (vec3){3, 2, 30}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
  stage_add_directional(set, (vec3){0.3, 0.2, -1});
  stage_add_directional(set, (vec3){0.2, -0.4, 1});
  set->lights[0].intensity = 1.7;
  return slab;
}

/* ---- flat ---- */

static const double ASKED[3] = {0.2, 0.5, 0.8};

/* Every pixel has the asked colour times alpha, whatever the lights, the shadows and the material are. */
static void test_flat_colour_is_the_asked_one(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  static const double opacities[] = {0.05, 0.4, 0.9999};
  for (int k = 0; k < 12; k++) {
    stage set;
    hl_scene_volume *slab = open_slab(&set, opacities[k % 3]);
    slab->shading = HL_SHADING_FLAT;
    slab->material.emission = 3;
    set.scene.render.shadows = k / 3 % 2 ? HL_SHADOWS_SOFT : HL_SHADOWS_HARD;
    set.lights[1].angular_diameter_deg = 20;
    stage_render_by(&set, k >= 6, pixels);
    for (int i = 0; i < PIXELS; i++) {
      const float *pixel = &pixels[4 * i];
      assert_true(pixel[3] > 0.1f);
      for (int c = 0; c < 3; c++) assert_near((double)pixel[c], ASKED[c] * (double)pixel[3], 2e-6);
    }
    if (k % 3 == 2) assert_true(pixels[3] > 0.9995f);
    stage_close(&set);
  }
}

/* A flat plate between a lamp and a slab takes light from the slab, and keeps its own colour. */
static void test_flat_casts_and_receives_no_shadow(void **state) {
  (void)state;
  static float pixels[2][PIXELS * 4];
  for (int reference = 0; reference < 2; reference++) {
    for (int flat = 0; flat < 2; flat++) {
      stage set;
      (void)open_slab(&set, 0.9999);
      hl_scene_volume *plate = stage_add_grid(&set, (size_t[3]){16, 16, 2}, (double[3]){1, 1, 1},
                                              (vec3){-8, -8, 8}, NULL);
      stage_set_opacity(&set, plate, 0.9999, 0.1);
      plate->shading = flat ? HL_SHADING_FLAT : HL_SHADING_NONE;
      plate->visible = 0;
      for (int c = 0; c < 3; c++) set.scene.ambient[c] = 0;
      set.scene.light_count = 1;
      stage_render_by(&set, reference == 1, pixels[flat]);
      stage_close(&set);
    }
    assert_memory_equal(pixels[0], pixels[1], sizeof pixels[0]);
    const float *middle = &pixels[0][4 * (SIDE / 2 * SIDE + SIDE / 2)];
    assert_true(middle[3] > 0.99f && middle[0] < 1e-3f && middle[2] < 1e-3f);
  }
}

/* All of a flat volume's colour is in its emission layer. Lights and ambient light add nothing, and no shadow
 * falls on a flat volume. */
static void test_layers_of_flat_colours(void **state) {
  (void)state;
  static float pixels[PIXELS * 4], ambient[PIXELS * 3], emission[PIXELS * 3], picture[2][PIXELS * 3],
      shadow[2][PIXELS * 3];
  for (int reference = 0; reference < 2; reference++) {
    hl_error error = {0};
    hl_scene *scene = NULL;
    hl_renderer *renderer = NULL;
    stage set;
    open_slab(&set, 0.4)->shading = HL_SHADING_FLAT;
    const hl_light_layers lights[2] = {{picture[0], shadow[0]}, {picture[1], shadow[1]}};
    const hl_layers layers = {.struct_size = sizeof layers,
                              .ambient = ambient,
                              .emission = emission,
                              .lights = lights,
                              .light_count = 2};
    assert_int_equal(hl_scene_create(set.context, &set.scene, &scene, &error), HL_OK);
    assert_int_equal(hl_renderer_create(set.context, &renderer, &error), HL_OK);
    hl_status status =
        reference ? hl_reference_render_layers(set.context, scene, NULL, pixels, 4 * SIDE, &layers, &error)
                  : hl_renderer_render_layers(renderer, scene, pixels, 4 * SIDE, &layers, NULL, &error);
    assert_int_equal(status, HL_OK);
    for (int i = 0; i < PIXELS; i++)
      for (int c = 0; c < 3; c++) {
        assert_near((double)emission[3 * i + c], (double)pixels[4 * i + c], 1e-6);
        assert_true(ambient[3 * i + c] == 0);
        for (int l = 0; l < 2; l++) {
          assert_true(picture[l][3 * i + c] == 0);
          assert_near((double)shadow[l][3 * i + c], 1, 1e-5);
        }
      }
    hl_renderer_destroy(renderer);
    hl_scene_release(scene);
    stage_close(&set);
  }
}

/* ---- emission ---- */

/* No light shines on the medium. The medium's colour is c (ke + ka Ia) (1 - T), also if there are several
 * sweeps. */
static void test_emission_of_a_medium(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  for (int k = 0; k < 8; k++) {
    stage set;
    hl_scene_volume *slab = open_slab(&set, 0.2);
    slab->material.emission = k % 2 ? 2.5 : 0.25;
    slab->material.ambient = 0.6;
    /* the inside of the slab has no surface */
    slab->shading = k / 2 % 2 ? HL_SHADING_PHONG : HL_SHADING_NONE;
    set.lights[0].intensity = set.lights[1].intensity = 0;
    stage_render_by(&set, k >= 4, pixels);
    for (int y = 0; y < SIDE; y++)
      for (int x = 0; x < SIDE; x++) {
        vec3 origin, direction;
        stage_eye_ray(&set, x, y, &origin, &direction);
        double chord = stage_chord((vec3){-8, -8, -2}, (vec3){8, 8, 2}, origin, direction);
        for (int c = 0; c < 3; c++)
          assert_near(
              (double)pixels[4 * (y * SIDE + x) + c],
              ASKED[c] * (slab->material.emission + 0.6 * set.scene.ambient[c]) * (1 - pow(0.8, chord)),
              1e-3);
      }
    stage_close(&set);
  }
}

/* Emission is added to the light that the lights give. */
static void test_emission_adds_to_light(void **state) {
  (void)state;
  static float lit[PIXELS * 4], both[PIXELS * 4];
  for (int reference = 0; reference < 2; reference++) {
    stage set;
    hl_scene_volume *slab = open_slab(&set, 0.3);
    slab->shading = HL_SHADING_PHONG;
    stage_render_by(&set, reference == 1, lit);
    slab->material.emission = 0.7;
    stage_render_by(&set, reference == 1, both);
    for (int i = 0; i < PIXELS; i++)
      for (int c = 0; c < 3; c++)
        assert_near((double)both[4 * i + c], (double)lit[4 * i + c] + 0.7 * ASKED[c] * (double)lit[4 * i + 3],
                    3e-6);
    stage_close(&set);
  }
}

/* ---- three scales ---- */

static const double STRETCH[3] = {1, 1.5, 0.5};

/* Adds a cut ball in a grid whose voxels have the given edges. The clip box is in the coordinates of the
 * volume's file, so that it is multiplied by the voxels' edges. */
static hl_scene_volume *add_ball(stage *set, const double spacing[3]) {
  enum { N = 16 };
  static float voxels[N * N * N];
  static const hl_opacity_point soft[] = {{0, 0}, {0.4, 0}, {0.6, 0.6}};
  for (int i = 0; i < N * N * N; i++) {
    double x = i % N - 7.5, y = i / N % N - 7.5, z = i / N / N - 7.5;
    voxels[i] = (float)(1 / (1 + exp(sqrt(x * x + y * y + z * z) - 5.5)));
  }
  hl_scene_volume *ball = stage_add_grid(set, (size_t[3]){N, N, N}, spacing,
                                         (vec3){-6 * spacing[0], -8 * spacing[1], -9 * spacing[2]}, voxels);
  ball->transfer_function.opacity = soft;
  ball->transfer_function.opacity_count = 3;
  ball->shading = HL_SHADING_PHONG;
  ball->rotate_angle_deg = 35;
  memcpy(ball->rotate_axis, (double[3]){1, 2, 0.5}, sizeof ball->rotate_axis);
  memcpy(ball->translate, (double[3]){0.5, -1, 0.25}, sizeof ball->translate);
  ball->clipped = 1;
  for (int a = 0; a < 3; a++) {
    ball->clip_min[a] = -4.5 * spacing[a];
    ball->clip_max[a] = 5.5 * spacing[a];
  }
  return ball;
}

/* A grid with voxels of edge 1 and three scales is the same, to the last bit, as a grid with voxels of these
 * edges: its place, its clip box, its normals and its shadows. */
static void test_three_scales_are_another_spacing(void **state) {
  (void)state;
  static float pixels[2][PIXELS * 4];
  for (int k = 0; k < 4; k++) {
    for (int scaled = 0; scaled < 2; scaled++) {
      stage set;
      stage_open(&set);
      set.scene.width = set.scene.height = SIDE;
      set.scene.camera.height = 22;
      stage_look(&set, (vec3){12, -20, 26}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
      stage_add_directional(&set, (vec3){-0.5, 0.3, -1})->angular_diameter_deg = 8;
      set.scene.render.shadows = HL_SHADOWS_SOFT;
      set.scene.render.reconstruction = k == 1 ? HL_RECONSTRUCTION_SPLAT : HL_RECONSTRUCTION_GATHER;
      double spacing[3];
      for (int a = 0; a < 3; a++) spacing[a] = scaled ? 1 : (k == 3 ? 2 : 1) * STRETCH[a];
      hl_scene_volume *ball = add_ball(&set, spacing);
      if (scaled) memcpy(ball->axis_scale, STRETCH, sizeof STRETCH);
      if (scaled && k == 3) ball->scale = 2; /* the uniform scale multiplies each of the three scales */
      stage_render_by(&set, k == 2, pixels[scaled]);
      stage_close(&set);
    }
    assert_memory_equal(pixels[0], pixels[1], sizeof pixels[0]);
    int seen = 0;
    for (int i = 0; i < PIXELS; i++) seen += pixels[0][4 * i + 3] > 0.5f;
    assert_true(seen > 40);
  }
}

/* ---- colours that change within a slab ---- */

/* A homogeneous medium has the height z as its values. The medium is green above STEP and red below it, in
 * ambient light alone.
 */
static const double STEP = 0.3, TOP = 5, BOTTOM = -5;

static void open_two_colors(stage *set, double opacity, double from_behind) {
  enum { N = 16 };
  static float voxels[N * N * N];
  static const hl_color_point colors[] = {{STEP, {1, 0, 0}}, {STEP, {0, 1, 0}}};
  for (int i = 0; i < N * N * N; i++) voxels[i] = (float)(i / N / N - 7.5);
  stage_open(set);
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.height = 12;
  set->scene.render.sheet_spacing = 1;
  for (int c = 0; c < 3; c++) set->scene.ambient[c] = 1;
  hl_scene_volume *medium = stage_add_grid(set, (size_t[3]){N, N, N}, (double[3]){1, 1, 1},
                                           (vec3){-8, -8, -8}, voxels);
  stage_set_opacity(set, medium, opacity, 1);
  medium->transfer_function.color = colors;
  medium->transfer_function.color_count = 2;
  medium->clipped = 1; /* the clip box leaves out the border, where the ramp ends */
  for (int a = 0; a < 3; a++) medium->clip_min[a] = BOTTOM, medium->clip_max[a] = TOP;
  stage_look(set, (vec3){9, 4, 30}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
  stage_add_directional(set, (vec3){0.1, 0.2, from_behind});
  set->lights[0].intensity = 1e-6;
}

/* Green shows by the fraction 1 - T of the matter above the step, and red by the rest, wherever the step lies
 * between two sheets, from front to back and from back to front. The tolerances are the errors that follow
 * from equal weights of matter within the slab that contains the step. */
static void test_step_of_colour_within_a_slab(void **state) {
  (void)state;
  static float pixels[PIXELS * 4];
  static const struct { double opacity, tolerance; } media[] = {{0.02, 3e-4}, {0.3, 0.014}, {0.7, 0.045}};
  for (int k = 0; k < 6; k++) {
    stage set;
    const double opacity = media[k % 3].opacity, tolerance = media[k % 3].tolerance;
    open_two_colors(&set, opacity, k < 3 ? -1 : 1);
    stage_render_by(&set, false, pixels);
    for (int i = 0; i < PIXELS; i++) {
      vec3 origin, direction;
      stage_eye_ray(&set, i % SIDE, i / SIDE, &origin, &direction);
      double above = stage_chord((vec3){BOTTOM, BOTTOM, STEP}, (vec3){TOP, TOP, TOP}, origin, direction);
      double below = stage_chord((vec3){BOTTOM, BOTTOM, BOTTOM}, (vec3){TOP, TOP, STEP}, origin, direction);
      double passing = pow(1 - opacity, above);
      assert_near((double)pixels[4 * i], passing * (1 - pow(1 - opacity, below)), tolerance);
      assert_near((double)pixels[4 * i + 1], 1 - passing, tolerance);
    }
    stage_close(&set);
  }
}

/* ---- the phase function ---- */

/* Light and the eye's rays are parallel. The light of a medium is then p = (1 - g^2) / (1 + g^2 - 2 g
 * cos)^1.5 times the light of a medium that scatters evenly, also in shadow. */
static void test_phase_function_of_a_medium(void **state) {
  (void)state;
  static float even[PIXELS * 4], pixels[PIXELS * 4];
  static const vec3 ways[] = {{0.3, 0.2, -1}, {0.2, -0.4, 1}, {1, 0.1, -0.2}};
  static const double anisotropies[] = {0.8, 0.3, -0.6};
  for (int k = 0; k < 18; k++) {
    double g = anisotropies[k / 6], cosine = 0;
    for (int scattered = 0; scattered < 2; scattered++) {
      stage set;
      hl_scene_volume *slab = open_slab(&set, 0.3);
      slab->shading = HL_SHADING_NONE;
      slab->anisotropy = scattered ? g : 0;
      for (int c = 0; c < 3; c++) set.scene.ambient[c] = 0;
      set.scene.light_count = 1;
      const vec3 way = ways[k % 3];
      set.lights[0].direction[0] = way.x;
      set.lights[0].direction[1] = way.y;
      set.lights[0].direction[2] = way.z;
      vec3 towards_eye = vec3_normalise((vec3){3, 2, 30});
      cosine = vec3_dot(vec3_normalise(ways[k % 3]), towards_eye);
      stage_render_by(&set, k / 3 % 2 == 1, scattered ? pixels : even);
      stage_close(&set);
    }
    double phase = (1 - g * g) / pow(1 + g * g - 2 * g * cosine, 1.5);
    for (int i = 0; i < 4 * PIXELS; i++)
      assert_near((double)pixels[i], (double)even[i] * (i % 4 == 3 ? 1 : phase), 1e-5 * (1 + phase));
    assert_true(even[4 * (SIDE / 2 * SIDE + SIDE / 2)] > 0.01f);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_flat_colour_is_the_asked_one),
      cmocka_unit_test(test_flat_casts_and_receives_no_shadow),
      cmocka_unit_test(test_layers_of_flat_colours),
      cmocka_unit_test(test_emission_of_a_medium),
      cmocka_unit_test(test_emission_adds_to_light),
      cmocka_unit_test(test_phase_function_of_a_medium),
      cmocka_unit_test(test_step_of_colour_within_a_slab),
      cmocka_unit_test(test_three_scales_are_another_spacing),
  };
  return cmocka_run_group_tests_name("sheets_colour", tests, NULL, NULL);
}
