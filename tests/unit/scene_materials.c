/* tests/unit/scene_materials.c - the colours of labels and materials, metal within other matter, and the
 * colours of light. */
#include "guess/looks.h"
#include "image/srgb.h"
#include "looks_volumes.h"
#include "scene_parts.h"

/* A head has one material, also if its values are rounded to so few levels that the histogram has gaps. */
static double rounded_head(int i, int j, int k) { return 4 * floor(head_in_mr(i, j, k) / 4); }

/* Each label has its own colour up to half way to the next label. Matter shows only close to a label's
 * number. */
static void labels_have_colors_of_their_own(void **state) {
  (void)state;
  static const double labels[] = {3, 17, 42, 1001};
  hl_context *context = make_context();
  hl_transfer_function f;
  fill(regions);
  hl_volume *volume = make_volume(context, N, values);
  assert_int_equal(hl_transfer_function_automatic(context, volume, &f, NULL), HL_OK);
  for (int n = 0; n < 4; n++) {
    double before = n > 0 ? labels[n - 1] : 0, here[3], near[3], other[3];
    assert_true(hl_transfer_function_opacity(&f, labels[n]) > 0.9);
    assert_true(hl_transfer_function_opacity(&f, 0.5 * (before + labels[n])) == 0);
    hl_transfer_function_color(&f, labels[n], here);
    hl_transfer_function_color(&f, labels[n] - 0.49 * (labels[n] - before), near);
    assert_memory_equal(here, near, sizeof here);
    hl_transfer_function_color(&f, before, other);
    if (n > 0)
      assert_true(fabs(here[0] - other[0]) + fabs(here[1] - other[1]) + fabs(here[2] - other[2]) > 0.3);
  }
  hl_transfer_function_release(context, &f);
  hl_volume_release(volume);
  hl_context_destroy(context);
}

static void materials_have_colors_of_their_own(void **state) {
  (void)state;
  static const double at[3] = {60, 120, 200};
  hl_context *context = make_context();
  fill(three);
  for (int w = 0; w < COUNT; w++) values[w] = roundf(values[w]);
  hl_volume *volume = make_volume(context, N, values);
  hl_transfer_function f;
  double color[3][3];
  assert_int_equal(hl_transfer_function_automatic(context, volume, &f, NULL), HL_OK);
  for (int m = 0; m < 3; m++) hl_transfer_function_color(&f, at[m], color[m]);
  for (int m = 0; m < 3; m++) {
    const double *a = color[m], *b = color[(m + 1) % 3];
    assert_true(fabs(a[0] - b[0]) + fabs(a[1] - b[1]) + fabs(a[2] - b[2]) > 0.15);
  }
  hl_transfer_function_release(context, &f);
  hl_volume_release(volume);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void levels_are_no_materials(void **state) {
  (void)state;
  hl_context *context = make_context();
  for (int rounded = 0; rounded < 2; rounded++) {
    hl_data_analysis analysis;
    fill(rounded ? rounded_head : head_in_mr);
    hl_volume *volume = make_volume(context, N, values);
    assert_int_equal(hl_data_analyse(volume, &analysis, NULL), HL_OK);
    assert_int_equal(analysis.kind, HL_DATA_SURFACES);
    assert_int_equal(analysis.material_count, 1);
    hl_volume_release(volume);
  }
  hl_context_destroy(context);
}

/* Matter that is several times as bright as the rest is steel, which shows within the rest. */
static void metal_is_seen_within_matter(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_transfer_function f;
  double flesh[3], steel[3];
  fill(beads);
  hl_volume *volume = make_volume(context, N, values);
  assert_int_equal(hl_transfer_function_automatic(context, volume, &f, NULL), HL_OK);
  hl_transfer_function_color(&f, 100, flesh);
  hl_transfer_function_color(&f, 380, steel);
  assert_true(flesh[0] > 2 * flesh[2] && steel[2] > steel[0]);
  const double opacity = hl_transfer_function_opacity(&f, 100);
  assert_true(opacity > 0.1 && opacity < 0.4 && hl_transfer_function_opacity(&f, 380) > 0.85);
  hl_transfer_function_release(context, &f);
  hl_shading shading;
  assert_int_equal(hl_transfer_function_look(context, "vessels", volume, &f, &shading, NULL), HL_OK);
  /* the vessels must not be taken for the metal alone */
  assert_true(hl_transfer_function_opacity(&f, 150) > 0.5);
  hl_transfer_function_release(context, &f);
  hl_volume_release(volume);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void boundaries_are_no_materials(void **state) {
  (void)state;
  hl_context *context = make_context();
  fill(block);
  hl_volume *volume = make_volume(context, N, values);
  hl_data_analysis analysis;
  assert_int_equal(hl_data_analyse(volume, &analysis, NULL), HL_OK);
  assert_int_equal(analysis.kind, HL_DATA_SURFACES);
  assert_int_equal(analysis.material_count, 1);
  fill(three);
  hl_volume *others = make_volume(context, N, values);
  assert_int_equal(hl_data_analyse(others, &analysis, NULL), HL_OK);
  assert_int_equal(analysis.material_count, 3);
  hl_volume_release(volume);
  hl_volume_release(others);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* A bare volume is lit by a warm lamp, and by a cool sky. */
static void light_is_warm_and_shade_is_cool(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_scene *scene = NULL;
  fill(head_in_mr);
  hl_volume *volume = make_volume(context, N, values);
  assert_int_equal(hl_scene_for_volume(context, volume, NULL, &scene, NULL), HL_OK);
  const hl_scene_description *d = hl_scene_describe(scene);
  assert_true(d->lights[0].color[0] > d->lights[0].color[2]);
  assert_true(d->sky.zenith[0] < d->sky.zenith[2] && d->sky.horizon[0] < d->sky.horizon[2]);
  hl_scene_release(scene);
  hl_volume_release(volume);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(labels_have_colors_of_their_own), cmocka_unit_test(materials_have_colors_of_their_own),
      cmocka_unit_test(levels_are_no_materials),         cmocka_unit_test(metal_is_seen_within_matter),
      cmocka_unit_test(boundaries_are_no_materials),     cmocka_unit_test(light_is_warm_and_shade_is_cool),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
