/* tests/unit/image_compare.c - the measures of difference between two pictures, on pairs that are made for
 * them, and thresholds that tell a wrong picture from a rounded one. */
#include "image_parts.h"

static hl_image_difference compare(const hl_image *a, const hl_image *b) {
  hl_image_difference difference = {.struct_size = sizeof difference};
  assert_int_equal(hl_image_compare(a, b, &difference, NULL), HL_OK);
  return difference;
}

static void closed_forms(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_image *a = make_image(context, 50, 40), *b = make_image(context, 50, 40);
  for (int i = 0; i < 50 * 40 * 4; i++) a->pixels[i] = b->pixels[i] = 0.25f * (float)(i % 7);
  hl_image_difference none = compare(a, b);
  assert_true(none.rmse == 0 && none.maximum == 0 && none.percentile_99_9 == 0 && none.differing_pixels == 0);
  pixel_at(b, 31, 17)[1] += 0.5f;
  pixel_at(b, 3, 4)[2] -= 0.25f;
  pixel_at(b, 3, 4)[3] += 0.125f;
  hl_image_difference d = compare(a, b);
  assert_true(d.maximum == 0.5 && d.maximum_x == 31 && d.maximum_y == 17);
  assert_int_equal(d.differing_pixels, 2);
  assert_true(d.mean_signed[0] == 0 && d.mean_signed[1] == 0.5 / 2000);
  assert_true(d.mean_signed[2] == -0.25 / 2000 && d.mean_signed[3] == 0.125 / 2000);
  assert_true(fabs(d.rmse_channel[1] - sqrt(0.25 / 2000)) < 1e-15);
  assert_true(fabs(d.rmse - sqrt((0.25 + 0.0625 + 0.015625) / 8000)) < 1e-15);
  assert_true(d.percentile_99_9 == 0); /* 2 of 2000 pixels are exactly the greatest 0.1 % */
  pixel_at(b, 49, 39)[0] += 0.0625f;
  assert_true(compare(a, b).percentile_99_9 == 0.0625);
  hl_image_difference swapped = compare(b, a);
  assert_true(swapped.mean_signed[1] == -0.5 / 2000 && swapped.maximum == 0.5);
  hl_image_destroy(a);
  hl_image_destroy(b);
  end_context(context);
}

static int compare_doubles(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Compares with sorting, for sizes around the multiples of 1000. */
static void percentile_is_the_nearest_rank(void **state) {
  (void)state;
  hl_context *context = make_context();
  const int widths[] = {1, 2, 10, 999, 1000, 1001, 3000, 4711};
  for (size_t w = 0; w < sizeof widths / sizeof widths[0]; w++) {
    hl_image *a = make_image(context, widths[w], 1), *b = make_image(context, widths[w], 1);
    double *sorted = malloc(sizeof *sorted * (size_t)widths[w]);
    uint32_t random = 12345;
    for (int x = 0; x < widths[w]; x++) {
      random = random * 1664525u + 1013904223u;
      pixel_at(b, x, 0)[x % 4] = (float)(random >> 8) * 1e-7f * (x % 3 == 0 ? -1.0f : 1e-4f);
      sorted[x] = fabs((double)pixel_at(b, x, 0)[x % 4]);
    }
    qsort(sorted, (size_t)widths[w], sizeof *sorted, compare_doubles);
    int rank = (widths[w] * 999 + 999) / 1000;
    assert_true(compare(a, b).percentile_99_9 == sorted[rank - 1]);
    free(sorted);
    hl_image_destroy(a);
    hl_image_destroy(b);
  }
  end_context(context);
}

/* A NaN, also if it is in both pictures, fails every threshold "value <= limit" and "fabs(mean) <= limit". */
static void nan_is_an_infinite_difference(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_image *a = make_image(context, 4, 3), *b = make_image(context, 4, 3);
  pixel_at(a, 2, 1)[1] = pixel_at(b, 2, 1)[1] = INFINITY;
  assert_int_equal(compare(a, b).differing_pixels, 0);
  pixel_at(a, 2, 1)[1] = pixel_at(b, 2, 1)[1] = NAN;
  pixel_at(b, 0, 0)[1] = -INFINITY;
  hl_image_difference d = compare(a, b);
  assert_int_equal(d.differing_pixels, 2);
  assert_true(isinf(d.maximum) && isinf(d.rmse) && isinf(d.rmse_channel[1]) && isinf(d.mean_signed[1]));
  assert_true(isinf(d.percentile_99_9));
  assert_true(d.mean_signed[0] == 0 && d.rmse_channel[0] == 0);
  hl_image_destroy(a);
  hl_image_destroy(b);
  end_context(context);
}

static void refuses_what_cannot_be_compared(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_image *a = make_image(context, 4, 3), *b = make_image(context, 3, 4);
  hl_image_difference d = {.struct_size = sizeof d};
  hl_error error = {0};
  assert_int_equal(hl_image_compare(a, b, &d, &error), HL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "4 x 3"));
  assert_non_null(strstr(error.message, "3 x 4"));
  d.struct_size = 3;
  assert_int_equal(hl_image_compare(a, a, &d, &error), HL_ERROR_ARGUMENT);
  assert_int_equal(hl_image_compare(NULL, a, &d, &error), HL_ERROR_ARGUMENT);
  hl_image_destroy(a);
  hl_image_destroy(b);
  end_context(context);
}

/* The thresholds of golden pictures. */
static bool accepts(const hl_image *a, const hl_image *b) {
  hl_image_difference d = compare(a, b);
  bool means = true;
  for (int c = 0; c < 4; c++) means = means && fabs(d.mean_signed[c]) <= 1e-4;
  return d.rmse <= 1e-3 && d.maximum <= 4e-3 && means;
}

static void thresholds_reject_wrong_pictures(void **state) {
  (void)state;
  enum { W = 64, H = 48 };
  hl_context *context = make_context();
  hl_image *truth = make_structured(context, W, H), *other = make_image(context, W, H);
  for (int i = 0; i < W * H * 4; i++) /* values rounded up and down to 9 bits */
    other->pixels[i] = truth->pixels[i] + ((i / 4 + i) % 2 ? 1.0f : -1.0f) / 1024;
  assert_true(accepts(truth, other));
  for (int i = 0; i < W * H; i++) /* 2 % brighter */
    for (int c = 0; c < 4; c++) other->pixels[4 * i + c] = truth->pixels[4 * i + c] * (c < 3 ? 1.02f : 1);
  assert_false(accepts(truth, other));
  for (int y = 0; y < H; y++) /* a shift of half a pixel to the right */
    for (int x = 0; x < W; x++)
      for (int c = 0; c < 4; c++)
        pixel_at(other, x, y)[c] = (pixel_at(truth, x, y)[c] + pixel_at(truth, x > 0 ? x - 1 : 0, y)[c]) / 2;
  assert_false(accepts(truth, other));
  for (int i = 0; i < W * H; i++) /* red and blue exchanged */
    for (int c = 0; c < 4; c++)
      other->pixels[4 * i + c] = truth->pixels[4 * i + (c == 0 ? 2 : c == 2 ? 0 : c)];
  assert_false(accepts(truth, other));
  hl_image_destroy(truth);
  hl_image_destroy(other);
  end_context(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(closed_forms), cmocka_unit_test(percentile_is_the_nearest_rank),
      cmocka_unit_test(nan_is_an_infinite_difference), cmocka_unit_test(refuses_what_cannot_be_compared),
      cmocka_unit_test(thresholds_reject_wrong_pictures)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
