/* gpu/phase_kernels.c - the kernels' means of phase functions over lights, compiled as C17, give the bytes of
 * the processors' functions (render/phase_lanes.h). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "render/phase_lanes.h"

/* The kernels' names are those of the processors' functions in places. */
#define phase_angle          device_phase_angle
#define phase_angle_at       device_phase_angle_at
#define row_of_ratio         device_row_of_ratio
#define mean_in_table        device_mean_in_table
#define row_of_cap           device_row_of_cap
#define phase_of_cap         device_phase_of_cap
#define phase_of_light       device_phase_of_light
#define LEAST_LIGHT_DISTANCE 1e-3f
#define dot3                 device_dot3
#define cross3               device_cross3
#define row_of_vector        device_row_of_vector
#define row_of_point         device_row_of_point
#define linear_in_view       device_linear_in_view
#define PHASES               1
#include "gpu/kernels/phase.h"
#undef phase_of_light
#undef dot3

enum { LIGHTS = 3, ROUNDS = 3000 };

static float numbers[(LIGHTS + 2 * PHASE_CAPS) * PHASE_COLUMNS];

static uint32_t next_bits(uint64_t *state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (uint32_t)(*state >> 32);
}
static float next_between(uint64_t *state, float low, float high) {
  return low + (high - low) * ((float)(next_bits(state) >> 8) * 0x1p-24f);
}
static vector next_direction(uint64_t *seed) {
  const vector v = {next_between(seed, -1, 1), next_between(seed, -1, 1), next_between(seed, -1, 1)};
  const float length = sqrtf(v.x * v.x + v.y * v.y + v.z * v.z) + 1e-6f;
  return (vector){v.x / length, v.y / length, v.z / length};
}

static void test_lights(void **state) {
  (void)state;
  uint64_t seed = 3;
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) numbers[i] = next_between(&seed, 0, 3);
  for (int round = 0; round < ROUNDS; round++) {
    const float g = next_between(&seed, 0.05f, 0.95f) * (round % 2 ? 1.0f : -1.0f);
    const int number = round % LIGHTS, caps = round % 3 == 0 ? 0 : 1 + round % MOST_CAPS;
    const phase_table table = {.rows_per_log2 = next_between(&seed, 2, 60),
                               .caps = (float(*)[PHASE_COLUMNS][2])(numbers + LIGHTS * PHASE_COLUMNS),
                               .parallel = (float(*)[PHASE_COLUMNS])numbers};
    const phase_data phases = {numbers, LIGHTS, table.rows_per_log2};
    shade_light shade = {.caps.count = caps, .parallel_row = round % 2 ? number : -1};
    plan_light light = {.cap_count = caps, .wide_parallel = round % 2};
    for (int c = 0; c < caps; c++)
      for (int i = 0; i < 9; i++) {
        const float value = i < 3 ? next_between(&seed, -9, 9) : next_between(&seed, i < 6 ? 0 : -3, 20);
        float *own = i < 3 ? &shade.caps.cap[c].middle[i] : &shade.caps.cap[c].spread[i - 3];
        float *other = i < 3 ? &light.caps[c].middle[i] : &light.caps[c].spread[i - 3];
        *own = *other = value;
      }
    const vector towards = next_direction(&seed), eye = next_direction(&seed),
                 at = {next_between(&seed, -9, 9), next_between(&seed, -9, 9), next_between(&seed, -9, 9)};
    const block_geometry geometry = {.position = {lanes_set(at.x), lanes_set(at.y), lanes_set(at.z)},
                                     .towards_eye = {lanes_set(eye.x), lanes_set(eye.y), lanes_set(eye.z)}};
    const lanes own = phase_of_light(
        &table, g, &shade, (lanes3){lanes_set(towards.x), lanes_set(towards.y), lanes_set(towards.z)},
        &geometry);
    const float found = device_phase_of_light(&phases, g, &light, number, towards, at, eye), first = own[0];
    assert_memory_equal(&found, &first, sizeof found);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_lights)};
  cmocka_set_message_output(CM_OUTPUT_TAP);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
