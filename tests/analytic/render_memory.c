/* tests/analytic/render_memory.c - the memory of a frame: the estimate is enough and not much too large, and
 * a frame under a limit below the estimate is refused before the frame begins. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "reference_stage.h"
#include "render/estimate.h"
#include "render/prepare.h"

enum { SIDE = 320, EDGE = 64 };

/* Opens a scene of noise over a plate, with matter everywhere in the picture. */
static void open_stage(stage *set, uint64_t limit) {
  static float voxels[EDGE * EDGE * EDGE];
  hl_context_options options;
  hl_context_options_defaults(&options);
  options.memory_limit = limit;
  stage_open_with(set, &options);
  for (size_t k = 0; k < EDGE; k++)
    for (size_t j = 0; j < EDGE; j++)
      for (size_t i = 0; i < EDGE; i++)
        voxels[(k * EDGE + j) * EDGE + i] = stage_noise((double)i / 5, (double)j / 5, (double)k / 5);
  stage_add_grid(set, (size_t[3]){EDGE, EDGE, EDGE}, (double[3]){1, 1, 1},
                 (vec3){-EDGE / 2, -EDGE / 2, -EDGE / 2}, voxels);
  stage_look(set, (vec3){60, -160, 90}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
  set->scene.camera.type = HL_CAMERA_PERSPECTIVE;
  set->scene.camera.fovy_deg = 32;
  set->scene.width = set->scene.height = SIDE;
  set->scene.render.threads = 2;
}

typedef struct variant {
  const char *name;
  hl_shadows shadows;
  hl_soft_method method;
  int lights;
  bool colored, clipped, layers, maximum, mesh;
} variant;

static const variant variants[] = {
    {"no shadows", HL_SHADOWS_OFF, 0, 1, false, false, false, false, false},
    {"hard", HL_SHADOWS_HARD, 0, 2, false, true, false, false, false},
    {"cascade", HL_SHADOWS_SOFT, HL_SOFT_CASCADE, 1, true, false, false, false, false},
    {"paper", HL_SHADOWS_SOFT, HL_SOFT_PAPER, 1, false, false, false, false, false},
    {"sublights", HL_SHADOWS_SOFT, HL_SOFT_SUBLIGHTS, 1, false, false, false, false, false},
    {"lamp inside", HL_SHADOWS_HARD, 0, 3, false, false, false, false, false},
    {"layers", HL_SHADOWS_HARD, 0, 1, false, false, true, false, false},
    {"maximum", HL_SHADOWS_HARD, 0, 1, false, true, false, true, false},
    {"mesh", HL_SHADOWS_HARD, 0, 1, false, false, false, false, true},
    {"mesh, cascade", HL_SHADOWS_SOFT, HL_SOFT_CASCADE, 1, false, false, false, false, true}};

/* Makes a board of many triangles under the volume. The caller releases the mesh. */
static hl_mesh *make_board(stage *set) {
  enum { N = 240 };
  static float positions[(N + 1) * (N + 1)][3];
  static uint32_t triangles[2 * N * N][3];
  hl_mesh_description d;
  hl_mesh *made = NULL;
  for (int i = 0; i < (N + 1) * (N + 1); i++)
    vec3_store(positions[i],
               (vec3){i % (N + 1) * 0.5 - 60, i / (N + 1) * 0.5 - 60, -34 + 2 * sin(i % (N + 1) * 0.1)});
  for (int i = 0; i < N * N; i++) {
    uint32_t at = (uint32_t)(i / N * (N + 1) + i % N);
    memcpy(triangles[2 * i], (uint32_t[3]){at, at + 1, at + N + 2}, sizeof triangles[0]);
    memcpy(triangles[2 * i + 1], (uint32_t[3]){at, at + N + 2, at + N + 1}, sizeof triangles[0]);
  }
  hl_mesh_description_defaults(&d);
  d.positions = (const float(*)[3])positions, d.vertex_count = (N + 1) * (N + 1);
  d.triangles = (const uint32_t(*)[3])triangles, d.triangle_count = 2 * N * N;
  assert_int_equal(hl_mesh_create(set->context, &d, &made, NULL), HL_OK);
  return made;
}

static void set_up(stage *set, const variant *v) {
  static const vec3 ways[2] = {{0.5, 0.6, -1}, {-1, 0.4, -0.6}};
  for (int l = 0; l < v->lights && l < 2; l++)
    stage_add_directional(set, ways[l])->angular_diameter_deg = v->shadows == HL_SHADOWS_SOFT ? 12 : 0;
  if (v->lights == 3) stage_add_point(set, (vec3){3, 4, 5});
  set->scene.render.shadows = v->shadows;
  set->scene.render.soft_method = v->method;
  set->scene.render.light_samples = 3;
  if (v->maximum) set->scene.render.compositing = HL_COMPOSITING_MAXIMUM;
  if (v->colored) set->volumes[0].attenuation_color[0] = 0.5;
  set->volumes[0].clipped = v->clipped;
  for (int a = 0; a < 3; a++) {
    set->volumes[0].clip_min[a] = -20;
    set->volumes[0].clip_max[a] = 24;
  }
}

/* Renders one frame. estimate: the estimated memory, and peak: the most memory that the frame held, in
 * bytes. */
static hl_status render(const variant *v, uint64_t limit, uint64_t *estimate, uint64_t *peak,
                        hl_error *error) {
  static float pixels[SIDE * SIDE * 4], picture[SIDE * SIDE * 3], shadow[SIDE * SIDE * 3], depth[SIDE * SIDE],
      own[SIDE * SIDE * 3];
  stage set;
  open_stage(&set, limit);
  set_up(&set, v);
  hl_scene *scene = NULL;
  hl_renderer *renderer = NULL;
  hl_scene_mesh mesh;
  hl_scene_mesh_defaults(&mesh);
  if (v->mesh) mesh.mesh = make_board(&set), set.scene.meshes = &mesh, set.scene.mesh_count = 1;
  assert_int_equal(hl_scene_create(set.context, &set.scene, &scene, NULL), HL_OK);
  assert_int_equal(hl_renderer_create(set.context, &renderer, NULL), HL_OK);
  hl_light_layers light = {picture, shadow};
  hl_layers layers = {
      .struct_size = sizeof layers, .depth_mean = depth, .lights = &light, .light_count = 1, .emission = own};
  hl_status status = hl_renderer_render_layers(renderer, scene, pixels, SIDE * 4, v->layers ? &layers : NULL,
                                               NULL, error);
  *estimate = hl_renderer_estimate(renderer);
  *peak = hl_context_memory_peak(set.context);
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
  hl_mesh_release(mesh.mesh);
  stage_close(&set);
  return status;
}

static bool is_tight(const variant *v, uint64_t estimate, uint64_t peak) {
  /* the estimate guesses the number of a mesh's fragments, which is not known before they are made */
  return (double)estimate <= (v->mesh ? 1.5 : 1.25) * (double)peak;
}

/* On a busy machine a thread may wait through a whole frame, so that the thread holds no fragments. So the
 * estimate is compared with the greatest peak of several frames. */
static void estimates_hold(void **state) {
  (void)state;
  for (size_t n = 0; n < sizeof variants / sizeof *variants; n++) {
    const variant *v = &variants[n];
    uint64_t estimate = 0, peak = 0;
    for (int frame = 0; frame < 8 && (frame == 0 || !is_tight(v, estimate, peak)); frame++) {
      uint64_t held;
      assert_int_equal(render(v, 0, &estimate, &held, NULL), HL_OK);
      assert_true(estimate >= held);
      peak = held > peak ? held : peak;
    }
    print_message("# %s: estimate %.2f MiB, peak %.2f MiB\n", v->name, (double)estimate / (1 << 20),
                  (double)peak / (1 << 20));
    assert_true(is_tight(v, estimate, peak));
  }
}

/* The estimate is enough. A frame under a limit below the estimate is refused before a sheet is begun, and
 * the message has both numbers. */
static void frames_are_refused_beforehand(void **state) {
  (void)state;
  const variant *v = &variants[2];
  uint64_t estimate, peak, refused_estimate, refused_peak;
  hl_error error = {0};
  assert_int_equal(render(v, 0, &estimate, &peak, NULL), HL_OK);
  assert_int_equal(render(v, estimate, &refused_estimate, &refused_peak, &error), HL_OK);
  assert_int_equal(render(v, peak - (peak >> 3), &refused_estimate, &refused_peak, &error), HL_ERROR_MEMORY);
  assert_true(refused_estimate == estimate);
  assert_true(refused_peak < peak / 2);
  assert_non_null(strstr(error.message, "this frame needs about "));
  assert_non_null(strstr(error.message, "the memory limit is "));
  assert_non_null(strstr(error.message, "make the picture smaller"));
}

/* Returns the estimate of memory for the volumes of a scene, some of which may have been made ready before.
 * Then the function makes the volumes ready. */
static uint64_t prepare_bytes(stage *set, hl_pool *pool, prepared_volume *prepared) {
  const hot_functions *hot = hl_hot_functions(HL_INSTRUCTION_SET_SCALAR);
  hl_prepared_release_stale(set->context, &set->scene, prepared);
  hl_layout counted = {0};
  hl_prepare_count(&set->scene, prepared, hot->grid, 1, &counted);
  assert_int_equal(hl_prepare_volumes(set->context, pool, hot, &set->scene, (uint64_t[]){0}, prepared, NULL),
                   HL_OK);
  return counted.most;
}

/* If a volume's kernel or clip box changes, the volume is made ready anew. The estimate includes the memory
 * for the new preparation.
 */
static void changed_volumes_count(void **state) {
  (void)state;
  stage set;
  hl_pool *pool = NULL;
  prepared_volume prepared = {0};
  open_stage(&set, 0);
  assert_int_equal(hl_pool_create(set.context, 1, &pool, NULL), HL_OK);
  const uint64_t first = prepare_bytes(&set, pool, &prepared), same = prepare_bytes(&set, pool, &prepared);
  set.scene.render.kernel = HL_KERNEL_LINEAR;
  const uint64_t kernel = prepare_bytes(&set, pool, &prepared);
  set.volumes[0].clipped = 1;
  for (int a = 0; a < 3; a++) set.volumes[0].clip_max[a] = 24;
  const uint64_t clipped = prepare_bytes(&set, pool, &prepared);
  print_message("# first %.2f MiB, the same again %.2f, another kernel %.2f, a clip box %.2f\n",
                (double)first / (1 << 20), (double)same / (1 << 20), (double)kernel / (1 << 20),
                (double)clipped / (1 << 20));
  assert_true(same < first / 4);
  assert_true(kernel > first / 2);
  assert_true(clipped == kernel);
  hl_prepared_release(set.context, &prepared);
  hl_pool_destroy(pool);
  stage_close(&set);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(estimates_hold),
                                     cmocka_unit_test(changed_volumes_count),
                                     cmocka_unit_test(frames_are_refused_beforehand)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
