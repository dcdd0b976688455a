/* unit/simd_equal.c - every hot function on every instruction set that the machine has: the scalar table's
 * bits.
 *
 *     simd_equal [--time]
 *
 * Inputs are random, salted with zeros, ones, huge, tiny and non-finite numbers. --time prints nanoseconds of
 * processor time a call, the least of some runs. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/context.h"
#include "simd_trials.h"

int main(int argc, char **argv) {
  simd_timing = argc > 1 && strcmp(argv[1], "--time") == 0;
  if (hl_cpu_best_instruction_set() == HL_INSTRUCTION_SET_SCALAR) {
    puts("1..0 # SKIP this processor has the scalar instruction set alone");
    return 0;
  }
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_bound_rows),   cmocka_unit_test(test_bound_cells),
      cmocka_unit_test(test_brick_bits),   cmocka_unit_test(test_label_rows),
      cmocka_unit_test(test_fill),         cmocka_unit_test(test_coverage),
      cmocka_unit_test(test_brick_ranges), cmocka_unit_test(test_light),
      cmocka_unit_test(test_fields),       cmocka_unit_test(test_shade),
      cmocka_unit_test(test_measure),      cmocka_unit_test(test_maximum),
      cmocka_unit_test(test_surface),      cmocka_unit_test(test_shade_beside_nothing),
  };
  return cmocka_run_group_tests_name("simd_equal", tests, open_classifier, close_classifier);
}
