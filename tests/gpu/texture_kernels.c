/* gpu/texture_kernels.c - the kernels' look-ups of images that lights project, compiled as C17, give the
 * bytes of the processors' functions (light/light_texture_lanes.h). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "light/light_texture_lanes.h"

/* The kernels' names are those of the processors' functions in places. */
#define dot3           device_dot3
#define cross3         device_cross3
#define row_of_vector  device_row_of_vector
#define row_of_point   device_row_of_point
#define linear_in_view device_linear_in_view
#define TEXTURES       1
#include "gpu/kernels/texture.h"
#undef row_of_point

enum { LEVELS = 3, SIDE = 24, FLOATS = SIDE * SIDE * 3, ROUNDS = 4000 };

/* The descriptions of two lights' images, and the pixels of the second one and of its levels. */
static struct {
  plan_texture list[2];
  float pixels[(1 + LEVELS) * FLOATS];
} device;

static float next_between(uint64_t *state, float low, float high) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return low + (high - low) * ((float)(*state >> 40) * 0x1p-24f);
}
static int next_side(uint64_t *seed) { return 1 + (int)next_between(seed, 0, SIDE - 0.01f); }

/* Draws a light's image for the processors, and describes it for the device. */
static light_texture draw_texture(uint64_t *seed, int levels) {
  plan_texture *to = &device.list[1];
  light_texture made = {.pixels = device.pixels, .width = next_side(seed), .height = next_side(seed)};
  made.parallel = next_between(seed, 0, 1) < 0.5f;
  made.first = next_between(seed, 0.001f, 4);
  made.level_count = levels;
  for (int row = 0; row < 3; row++)
    for (int i = 0; i < 4; i++) made.map[row][i] = next_between(seed, -2, row == 0 && i == 3 ? 9 : 4);
  for (int i = 0; i < 4; i++) made.beyond[i] = next_between(seed, -2, 2);
  for (int i = 0; i < 2; i++) {
    made.sharpness[i] = next_between(seed, 1, 5);
    made.edge[i] = next_between(seed, 0, 3);
  }
  *to = (plan_texture){.image = {.width = made.width, .height = made.height},
                       .parallel = made.parallel,
                       .first = made.first,
                       .level_count = levels};
  memcpy(to->map, made.map, sizeof to->map);
  memcpy(to->beyond, made.beyond, sizeof to->beyond);
  memcpy(to->sharpness, made.sharpness, sizeof to->sharpness);
  memcpy(to->edge, made.edge, sizeof to->edge);
  for (int l = 0; l < levels; l++) {
    texture_level *level = &made.level[l];
    *level = (texture_level){device.pixels + (1 + l) * FLOATS, next_side(seed), next_side(seed), {0}, {0}};
    for (int i = 0; i < 2; i++) {
      level->scale[i] = next_between(seed, 0.1f, 1);
      level->shift[i] = next_between(seed, -2, 2);
    }
    to->level[l] = (plan_texture_level){(unsigned)((1 + l) * FLOATS),
                                        level->width,
                                        level->height,
                                        {level->scale[0], level->scale[1]},
                                        {level->shift[0], level->shift[1]}};
  }
  return made;
}

static void test_patterns(void **state) {
  (void)state;
  uint64_t seed = 5;
  int seen = 0;
  for (size_t i = 0; i < sizeof device.pixels / sizeof *device.pixels; i++)
    device.pixels[i] = next_between(&seed, 0, 2);
  for (int round = 0; round < ROUNDS; round++) {
    const light_texture made = draw_texture(&seed, round % (LEVELS + 1));
    const vector at = {next_between(&seed, -3, 3), next_between(&seed, -3, 3), next_between(&seed, -3, 3)};
    lanes own[3];
    float found[3];
    texture_pattern(&made, (lanes3){lanes_set(at.x), lanes_set(at.y), lanes_set(at.z)}, own);
    assert_int_equal(pattern_of_texture(device.list, 2, 1, at, found), 1);
    for (int c = 0; c < 3; c++) {
      const float first = own[c][0];
      assert_memory_equal(&found[c], &first, sizeof first);
      seen += first > 0;
    }
  }
  assert_true(seen > ROUNDS / 2);
}

static void test_lights_without_images(void **state) {
  (void)state;
  float found[3];
  assert_int_equal(pattern_of_texture(device.list, 2, 0, (vector){1, 2, 3}, found), 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_patterns),
                                     cmocka_unit_test(test_lights_without_images)};
  cmocka_set_message_output(CM_OUTPUT_TAP);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
