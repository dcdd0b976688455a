/* analytic/random_scenes.c - properties that every picture has, on scenes drawn by number.
 *
 *     random_scenes [COUNT [FIRST]]
 *
 * Scene n is the same on every machine: a failure names n, and `random_scenes 1 n` renders scene n alone. The
 * checks: pixels are finite and not negative, and alpha is at most 1; one thread and three threads give the
 * same bytes; without shadows, every pixel is as bright or brighter; if camera, lights and volumes turn
 * together, the picture stays the same.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "moved_stage.h"
#include "random_scene.h"

enum { SIDE = 32, FLOATS = SIDE * SIDE * 4 };

/* The bars for the mean difference, as a fraction of the brightest value. The greatest means in 1100 scenes
 * were 0.0029, and 0.0121 if shadows are coarse or a lamp stands within the content. */
static const double MEAN = 0.004, COARSE_MEAN = 0.02;
enum { SECTOR_SWEEPS = 6 }; /* a lamp within the content has one sweep for each of its sectors */

static uint64_t first_scene = 1, scene_count = 16;

static size_t floats_of(const stage *set) { return (size_t)set->scene.width * (size_t)set->scene.height * 4; }

/* Renders a scene. sweeps: gets the number of sweeps; may be null. */
static hl_status render(stage *set, int threads, float *pixels, int *sweeps, hl_error *error) {
  hl_scene *scene = NULL;
  hl_renderer *renderer = NULL;
  hl_render_statistics statistics = {.struct_size = sizeof statistics};
  set->scene.render.threads = threads;
  hl_status status = hl_scene_create(set->context, &set->scene, &scene, error);
  if (status == HL_OK) status = hl_renderer_create(set->context, &renderer, error);
  if (status == HL_OK)
    status = hl_renderer_render(renderer, scene, pixels, 4 * (size_t)set->scene.width, &statistics, error);
  if (sweeps != NULL) *sweeps = statistics.sweeps;
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
  return status;
}

/* ---- properties; seed names the scene ---- */

static void check_range(uint64_t seed, const float *pixels, size_t floats) {
  for (size_t i = 0; i < floats; i++)
    if (!(isfinite(pixels[i]) && pixels[i] >= 0 && (i % 4 != 3 || pixels[i] <= 1)))
      fail_msg("scene %llu: value %zu is %g", (unsigned long long)seed, i, (double)pixels[i]);
}

/* One thread does the work of the picture and of the lights in turn. Three threads take ranges of slabs. */
static void check_threads(uint64_t seed, stage *set, const float *expected) {
  static float pixels[FLOATS];
  hl_error error = {0};
  set->scene.render.slabs_at_once = 2 + (int)(seed % 12);
  if (render(set, 3, pixels, NULL, &error) != HL_OK)
    fail_msg("scene %llu: %s", (unsigned long long)seed, error.message);
  if (memcmp(pixels, expected, floats_of(set) * sizeof *pixels) != 0)
    fail_msg("scene %llu: three threads give another picture than one", (unsigned long long)seed);
  set->scene.render.slabs_at_once = 0;
}

/* Checks that shadows only darken. With and without shadows the same sheets pass the same matter, so that
 * only rounding may make the shadowed picture brighter. Volumes that the eye does not see keep their shadows,
 * because otherwise the sheets would not reach as far. */
static void check_shadows_darken(uint64_t seed, stage *set, const float *shadowed) {
  static float pixels[FLOATS];
  hl_error error = {0};
  for (size_t v = 0; v < set->scene.volume_count; v++)
    if (set->volumes[v].visible) set->volumes[v].casts_shadow = 0;
  if (render(set, 1, pixels, NULL, &error) != HL_OK)
    fail_msg("scene %llu: %s", (unsigned long long)seed, error.message);
  for (size_t i = 0; i < floats_of(set); i++)
    if (!(shadowed[i] <= pixels[i] * (1 + 1e-5f) + 1e-6f))
      fail_msg("scene %llu: value %zu is %.9g with shadows, %.9g without", (unsigned long long)seed, i,
               (double)shadowed[i], (double)pixels[i]);
}

/* Shadow buffers and sheets turn with the content, but their grids of pixels do not. So the pictures of a
 * turned scene differ by about one pixel's error. If the nearest pixel of a buffer is looked up, or the
 * buffer has few pixels, or a lamp stands within matter, whole pixels differ. */
static void check_turned(uint64_t seed, const float *expected) {
  static float pixels[FLOATS];
  static random_scene turned;
  static double vertices[STAGE_LIGHTS * RANDOM_VERTICES][3];
  random_scene_open(&turned, seed);
  stage *set = &turned.set;
  hl_error error = {0};
  motion by = motion_of_turn((vec3){0.3, -0.5, 0.8}, 37 + (double)(seed % 300));
  stage_move(set, &by, (int)(seed % 2), vertices);
  int sweeps = 0;
  if (render(set, 1, pixels, &sweeps, &error) != HL_OK)
    fail_msg("scene %llu, turned: %s", (unsigned long long)seed, error.message);
  double mean = 0, brightest = 1, greatest = 0;
  for (size_t i = 0; i < floats_of(set); i++) {
    double off = fabs((double)pixels[i] - (double)expected[i]);
    brightest = fmax(brightest, (double)expected[i]);
    greatest = fmax(greatest, off);
    mean += off / (double)floats_of(set);
  }
  bool coarse = sweeps >= SECTOR_SWEEPS || set->scene.render.shadow_resolution > 0 ||
                set->scene.render.shadow_lookup == HL_LOOKUP_NEAREST;
  double tolerance = coarse ? COARSE_MEAN : MEAN;
  if (getenv("RANDOM_SCENES_VERBOSE") != NULL)
    printf("# scene %llu turned: mean %.3g greatest %.3g brightest %.3g%s\n", (unsigned long long)seed, mean,
           greatest, brightest, coarse ? " coarse" : "");
  if (!(mean <= tolerance * brightest))
    fail_msg("scene %llu, turned: differs by %.3g on average", (unsigned long long)seed, mean);
  stage_close(set);
}

/* Returns whether the scene is accepted. Sheets parallel to the image are refused if a light shines along the
 * sheets. Views that are too wide are refused, too. */
static bool check_scene(uint64_t seed) {
  static float pixels[FLOATS];
  static random_scene drawn;
  hl_error error = {0};
  random_scene_open(&drawn, seed);
  hl_status status = render(&drawn.set, 1, pixels, NULL, &error);
  if (status == HL_OK) {
    check_range(seed, pixels, floats_of(&drawn.set));
    check_threads(seed, &drawn.set, pixels);
    check_turned(seed, pixels);
    check_shadows_darken(seed, &drawn.set, pixels);
  } else if (status != HL_ERROR_UNSUPPORTED) {
    fail_msg("scene %llu: %s", (unsigned long long)seed, error.message);
  }
  stage_close(&drawn.set);
  return status == HL_OK;
}

static void test_properties(void **state) {
  (void)state;
  uint64_t rendered = 0;
  for (uint64_t n = first_scene; n < first_scene + scene_count; n++) rendered += check_scene(n);
  printf("# scenes %llu to %llu: %llu rendered, the others refused\n", (unsigned long long)first_scene,
         (unsigned long long)(first_scene + scene_count - 1), (unsigned long long)rendered);
  assert_true(10 * rendered >= 8 * scene_count);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_properties)};
  if (argc > 1) scene_count = strtoull(argv[1], NULL, 10);
  if (argc > 2) first_scene = strtoull(argv[2], NULL, 10);
  return cmocka_run_group_tests_name("random_scenes", tests, NULL, NULL);
}
