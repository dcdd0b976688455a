/* tests/unit/scene_preview.c - coarser copies of volumes, and which copies a preview uses for a scene's
 * sheets. */
#include <halflight/preview.h>

#include "scene_parts.h"
#include "volume/coarser.h"

static hl_context *context;

/* A volume of floats with the value i + 10 j + 100 k in the voxel (i, j, k). thick: the edge of voxels along
 * k. */
static hl_volume *make(const size_t size[3], double thick) {
  size_t count = size[0] * size[1] * size[2];
  float *values = malloc(count * sizeof *values);
  for (size_t n = 0; n < count; n++)
    values[n] = (float)(n % size[0]) + 10 * (float)(n / size[0] % size[1]) +
                100 * (float)(n / size[0] / size[1]);
  hl_volume_description d = describe_voxels(size[0], size[1], size[2], HL_VOXEL_F32, values);
  d.axis[2][2] = thick;
  d.origin[0] = 5;
  hl_volume *volume = create_volume(context, &d);
  free(values);
  return volume;
}

static void voxels_are_means(void **state) {
  (void)state;
  hl_volume *fine = make((const size_t[3]){5, 4, 6}, 1), *coarse = NULL;
  assert_int_equal(hl_volume_make_coarser(fine, HL_COARSER_MEANS, &coarse, NULL), HL_OK);
  hl_volume_info info = {.struct_size = sizeof info};
  assert_int_equal(hl_volume_get_info(coarse, &info), HL_OK);
  assert_int_equal(info.dimensions[0], 3);
  assert_int_equal(info.dimensions[1], 2);
  assert_int_equal(info.dimensions[2], 3);
  assert_float_equal(info.spacing[0], 2, 0);
  assert_float_equal(info.origin[0], 5.5, 0);
  assert_float_equal(info.origin[2], 0.5, 0);
  assert_float_equal(hl_volume_value(coarse, 1, 1, 2), 2.5 + 25 + 450, 0);
  assert_float_equal(hl_volume_value(coarse, 2, 0, 0), 4 + 5 + 50, 0); /* the last column is of one voxel */
  hl_volume_release(coarse);
  hl_volume_release(fine);
}

static void long_axes_stay(void **state) {
  (void)state;
  hl_volume *fine = make((const size_t[3]){8, 8, 4}, 3), *coarse = NULL, *coarser = NULL;
  assert_int_equal(hl_volume_make_coarser(fine, HL_COARSER_MEANS, &coarse, NULL), HL_OK);
  assert_int_equal(hl_volume_make_coarser(coarse, HL_COARSER_MEANS, &coarser, NULL), HL_OK);
  assert_int_equal(coarse->dimension[2], 4);  /* voxels of 2 x 2 x 3 */
  assert_int_equal(coarser->dimension[2], 4); /* voxels of 4 x 4 x 3, whose third edge is the short one now */
  assert_int_equal(coarse->dimension[0], 4);
  assert_int_equal(coarser->dimension[0], 2);
  hl_volume_release(coarser);
  hl_volume_release(coarse);
  hl_volume_release(fine);
}

static void numbers_that_are_none_are_left_out(void **state) {
  (void)state;
  float values[16] = {1, NAN, NAN, NAN};
  /* along i: 1 in the first pair of voxels and in no other */
  for (int n = 4; n < 16; n++) values[n] = n < 8 ? NAN : 3;
  hl_volume *fine = volume_of_voxels(context, 4, 2, 2, HL_VOXEL_F32, values), *coarse = NULL;
  assert_int_equal(hl_volume_make_coarser(fine, HL_COARSER_MEANS, &coarse, NULL), HL_OK);
  assert_float_equal(hl_volume_value(coarse, 0, 0, 0), (1 + 4 * 3) / 5.0, 1e-6);
  assert_float_equal(hl_volume_value(coarse, 1, 0, 0), 3, 0);
  hl_volume_release(coarse);
  hl_volume_release(fine);
}

static hl_scene *scene_of(hl_volume *volume, double spacing) {
  hl_scene *chosen = NULL, *scene = NULL;
  assert_int_equal(hl_scene_for_volume(context, volume, NULL, &chosen, NULL), HL_OK);
  hl_scene_description d = *hl_scene_describe(chosen);
  d.render.sheet_spacing = spacing;
  d.width = d.height = 64;
  assert_int_equal(hl_scene_create(context, &d, &scene, NULL), HL_OK);
  hl_scene_release(chosen);
  return scene;
}

static void copies_suit_the_sheets(void **state) {
  (void)state;
  static const struct {
    double spacing, quick;
    size_t side;
  } rows[] = {{0.5, 0.5, 128}, {1.4, 1.4, 128}, {1.5, 0.75, 64}, {2, 1, 64}, {4, 1, 32}, {16, 4, 32}};
  hl_volume *volume = make((const size_t[3]){128, 128, 128}, 1);
  hl_scene *first = scene_of(volume, 1);
  hl_preview *preview = NULL;
  assert_int_equal(hl_preview_create(context, first, &preview, NULL), HL_OK);
  for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
    hl_scene *scene = scene_of(volume, rows[r].spacing), *quick = NULL;
    assert_int_equal(hl_preview_scene(preview, scene, &quick, NULL), HL_OK);
    const hl_scene_description *d = hl_scene_describe(quick);
    assert_float_equal(d->render.sheet_spacing, rows[r].quick, 1e-12);
    assert_int_equal(d->volumes[0].volume->dimension[1], rows[r].side);
    assert_true((quick == scene) == (rows[r].side == 128));
    hl_scene_release(quick);
    hl_scene_release(scene);
  }
  hl_preview_destroy(preview);
  hl_scene_release(first);
  hl_volume_release(volume);
}

/* A box of label 1 beside a box of label 5. */
static hl_volume *two_boxes(void) {
  uint8_t *values = calloc(1, 64 * 64 * 64);
  for (int n = 0; n < 64 * 64 * 64; n++) {
    const int x = n % 64, y = n / 64 % 64, z = n / 64 / 64;
    if (x >= 8 && x < 56 && y >= 8 && y < 56 && z >= 8 && z < 56) values[n] = x < 32 ? 1 : 5;
  }
  hl_volume *map = volume_of_voxels(context, 64, 64, 64, HL_VOXEL_U8, values);
  free(values);
  return map;
}

/* The copy of the first volume with which a scene is shown. The preview holds it. */
static const hl_volume *copy_in(hl_preview *preview, hl_scene *scene) {
  hl_scene *quick = NULL;
  assert_int_equal(hl_preview_scene(preview, scene, &quick, NULL), HL_OK);
  assert_ptr_not_equal(quick, scene);
  const hl_volume *copy = hl_scene_describe(quick)->volumes[0].volume;
  hl_scene_release(quick);
  return copy;
}

/* If a volume is shown by its labels after it was shown by its values, it gets copies of the other kind,
 * once. A volume that the preview does not know gets no copies. */
static void copies_follow_the_use(void **state) {
  (void)state;
  static const hl_label labels[] = {{.value = 1, .color = {1, 0, 0}, .opacity = 1, .visible = 1}};
  hl_volume *volume = make((const size_t[3]){128, 64, 64}, 1),
            *other = make((const size_t[3]){128, 64, 64}, 2);
  hl_scene *plain = scene_of(volume, 4), *stranger = scene_of(other, 4), *scene = NULL, *quick = NULL;
  hl_scene_description d = *hl_scene_describe(plain);
  hl_scene_volume of_labels = d.volumes[0];
  of_labels.labels = labels;
  of_labels.label_count = 1;
  d.volumes = &of_labels;
  assert_int_equal(hl_scene_create(context, &d, &scene, NULL), HL_OK);
  hl_preview *preview = NULL;
  assert_int_equal(hl_preview_create(context, plain, &preview, NULL), HL_OK);
  const hl_volume *means = copy_in(preview, plain), *commonest = copy_in(preview, scene);
  assert_ptr_not_equal(means, commonest);
  assert_ptr_equal(copy_in(preview, scene), commonest);
  assert_ptr_equal(copy_in(preview, plain), means);
  assert_int_equal(hl_preview_scene(preview, stranger, &quick, NULL), HL_OK);
  assert_ptr_equal(quick, stranger);
  hl_scene_release(quick);
  hl_scene_release(scene);
  hl_scene_release(stranger);
  hl_scene_release(plain);
  hl_preview_destroy(preview);
  hl_volume_release(other);
  hl_volume_release(volume);
}

/* A voxel of the copy has the label that most of its eight voxels have, and of equally common labels the
 * first. It has no mean, which would be another label. */
static void labels_are_the_commonest(void **state) {
  (void)state;
  const uint8_t values[16] = {0, 9, 9, 9, 9, 0, 2, 2, 9, 2, 2, 9, 7, 7, 2, 2};
  hl_volume *fine = volume_of_voxels(context, 4, 2, 2, HL_VOXEL_U8, values), *coarse = NULL;
  assert_int_equal(hl_volume_make_coarser(fine, HL_COARSER_LABELS, &coarse, NULL), HL_OK);
  assert_float_equal(hl_volume_value(coarse, 0, 0, 0), 9, 0); /* 0 9 9 0 9 2 7 7 */
  assert_float_equal(hl_volume_value(coarse, 1, 0, 0), 2, 0); /* 9 9 2 2 2 9 2 2 */
  hl_volume_release(coarse);
  hl_volume_release(fine);
}

static void maps_and_masks_have_copies(void **state) {
  (void)state;
  static const hl_label labels[] = {{.value = 1, .color = {1, 0, 0}, .opacity = 1, .visible = 1}};
  for (int masked = 0; masked < 2; masked++) {
    hl_volume *map = two_boxes(), *small = make((const size_t[3]){32, 32, 32}, 2);
    hl_scene *first = scene_of(masked ? small : map, 4), *scene = NULL, *quick = NULL;
    hl_scene_description d = *hl_scene_describe(first);
    hl_scene_volume volume = d.volumes[0];
    volume.labels = masked ? NULL : labels;
    volume.label_count = masked ? 0 : 1;
    if (masked) volume.mask = (hl_mask){.volume = map, .labels = labels, .label_count = 1};
    d.volumes = &volume;
    assert_int_equal(hl_scene_create(context, &d, &scene, NULL), HL_OK);
    hl_preview *preview = NULL;
    assert_int_equal(hl_preview_create(context, scene, &preview, NULL), HL_OK);
    assert_int_equal(hl_preview_scene(preview, scene, &quick, NULL), HL_OK);
    const hl_scene_volume *copied = &hl_scene_describe(quick)->volumes[0];
    const hl_volume *copy = masked ? copied->mask.volume : copied->volume;
    assert_int_equal(copy->dimension[0], 32);
    assert_float_equal(hl_volume_value(copy, 15, 15, 15), 1, 0);
    assert_float_equal(hl_volume_value(copy, 16, 15, 15), 5, 0);
    assert_true(!masked || copied->volume == small); /* the volume is too small for copies */
    hl_scene_release(quick);
    hl_scene_release(scene);
    hl_scene_release(first);
    hl_preview_destroy(preview);
    hl_volume_release(small);
    hl_volume_release(map);
  }
}

static void null_is_refused(void **state) {
  (void)state;
  hl_error error = {0};
  hl_preview *preview = NULL;
  assert_int_equal(hl_preview_create(context, NULL, &preview, &error), HL_ERROR_ARGUMENT);
  assert_int_equal(hl_preview_scene(NULL, NULL, NULL, &error), HL_ERROR_ARGUMENT);
  hl_preview_destroy(NULL);
}

static int begin(void **state) {
  (void)state;
  context = make_context();
  return 0;
}

static int end(void **state) {
  (void)state;
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
  return 0;
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(voxels_are_means),
      cmocka_unit_test(long_axes_stay),
      cmocka_unit_test(numbers_that_are_none_are_left_out),
      cmocka_unit_test(copies_suit_the_sheets),
      cmocka_unit_test(copies_follow_the_use),
      cmocka_unit_test(labels_are_the_commonest),
      cmocka_unit_test(maps_and_masks_have_copies),
      cmocka_unit_test(null_is_refused),
  };
  return cmocka_run_group_tests(tests, begin, end);
}
