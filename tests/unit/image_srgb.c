/* tests/unit/image_srgb.c - the sRGB curve against its closed form, at every step between codes and at every
 * code. */
#include "image_parts.h"

#include "image/srgb.h"

static double closed_form_decode(double c) {
  return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}
static double closed_form_encode(double l) {
  return l <= 0.0031308 ? 12.92 * l : 1.055 * pow(l, 1 / 2.4) - 0.055;
}

static void decode_is_the_closed_form(void **state) {
  (void)state;
  for (int i = 0; i <= 70000; i++) {
    double c = i / 69000.0, expected = closed_form_decode(c);
    assert_true(fabs(hl_srgb_decode(c) - expected) <= 4e-15 * expected);
    assert_true(hl_srgb_decode(-c) == -hl_srgb_decode(c));
  }
  assert_true(fabs(hl_srgb_decode(0.5) - 0.21404114048223255) < 1e-15);
}

/* The exact step between the codes k - 1 and k is decode((k - 0.5) / maximum). The floats on its two sides
 * must get the two codes. Since codes rise with the value, this tests every float. */
static void every_step_is_exact(void **state) {
  (void)state;
  hl_context *context = make_context();
  const int depths[] = {255, 65535};
  for (int d = 0; d < 2; d++) {
    hl_srgb_encoder encoder;
    assert_int_equal(hl_srgb_encoder_create(context, depths[d], &encoder, NULL), HL_OK);
    for (int k = 1; k <= depths[d]; k++) {
      double step = closed_form_decode((k - 0.5) / depths[d]);
      float above = (float)step;
      if (above < step) above = nextafterf(above, 2);
      assert_int_equal(hl_srgb_encode(&encoder, above), k);
      assert_int_equal(hl_srgb_encode(&encoder, nextafterf(above, -1)), k - 1);
    }
    hl_srgb_encoder_destroy(&encoder);
  }
  end_context(context);
}

static void every_code_round_trips(void **state) {
  (void)state;
  hl_context *context = make_context();
  const int depths[] = {255, 65535};
  for (int d = 0; d < 2; d++) {
    hl_srgb_encoder encoder;
    assert_int_equal(hl_srgb_encoder_create(context, depths[d], &encoder, NULL), HL_OK);
    for (int k = 0; k <= depths[d]; k++)
      assert_int_equal(hl_srgb_encode(&encoder, (float)hl_srgb_decode((double)k / depths[d])), k);
    hl_srgb_encoder_destroy(&encoder);
  }
  end_context(context);
}

static void out_of_range_saturates(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_srgb_encoder encoder;
  assert_int_equal(hl_srgb_encoder_create(context, 255, &encoder, NULL), HL_OK);
  const struct {
    float value;
    int code;
  } cases[] = {{0, 0},   {-0.0f, 0},         {-1, 0},     {-INFINITY, 0}, {NAN, 0},       {1e-42f, 0},
               {1, 255}, {0.99999994f, 255}, {1.5f, 255}, {3e38f, 255},   {INFINITY, 255}};
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
    for (float offset = -0.49f; offset < 0.5f; offset += 0.49f)
      assert_int_equal(hl_srgb_encode_offset(&encoder, cases[i].value, offset), cases[i].code);
  hl_srgb_encoder_destroy(&encoder);
  end_context(context);
}

/* Values of whole codes do not change. Between codes, the mean over all dither offsets is the encoded value.
 */
static void offsets_keep_codes_and_means(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_srgb_encoder encoder;
  assert_int_equal(hl_srgb_encoder_create(context, 255, &encoder, NULL), HL_OK);
  for (int k = 0; k <= 255; k++)
    for (int i = 0; i < 64; i++)
      assert_int_equal(
          hl_srgb_encode_offset(&encoder, (float)closed_form_decode(k / 255.0), (float)(2 * i - 63) / 128),
          k);
  for (double value = 1e-5; value < 0.99; value *= 1.01) {
    double sum = 0;
    for (int i = 0; i < 64; i++)
      sum += hl_srgb_encode_offset(&encoder, (float)value, (float)(2 * i - 63) / 128);
    assert_true(fabs(sum / 64 - 255 * closed_form_encode(value)) < 1.0 / 64 + 0.01);
  }
  hl_srgb_encoder_destroy(&encoder);
  end_context(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(decode_is_the_closed_form), cmocka_unit_test(every_step_is_exact),
      cmocka_unit_test(every_code_round_trips), cmocka_unit_test(out_of_range_saturates),
      cmocka_unit_test(offsets_keep_codes_and_means)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
