/* tests/unit/image_failure.c - failures of pictures' files: bad arguments, files that cannot be written,
 * cancellation, memory that runs out. Each time the old file stays, and no other file is left. */
#include "image_parts.h"

#include <signal.h>
#include <sys/resource.h>

static const char *const extensions[] = {"png", "exr", "npy"};

static void arguments_are_checked(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_image *image = make_image(context, 2, 2), *none = NULL;
  hl_image_write_options options;
  hl_error error = {0};
  hl_image_write_options_defaults(&options);
  options.png_depth = 12;
  assert_int_equal(hl_image_write(context, image, "/tmp/x.png", &options, &error), HL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "8 or 16"));
  hl_image_write_options_defaults(&options);
  options.background[1] = NAN;
  assert_int_equal(hl_image_write(context, image, "/tmp/x.png", &options, &error), HL_ERROR_ARGUMENT);
  options = (hl_image_write_options){0};
  assert_int_equal(hl_image_write(context, image, "/tmp/x.png", &options, &error), HL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "defaults"));
  assert_int_equal(hl_image_write(context, NULL, "/tmp/x.png", NULL, &error), HL_ERROR_ARGUMENT);
  assert_int_equal(hl_image_write(context, image, NULL, NULL, NULL), HL_ERROR_ARGUMENT);
  assert_int_equal(hl_image_read(context, NULL, &none, &error), HL_ERROR_ARGUMENT);
  const char *unknown[] = {"/tmp/x.jpg", "/tmp/x", "/tmp/x.png.txt", "/tmp/.png/x", ""};
  for (size_t i = 0; i < 5; i++) {
    assert_int_equal(hl_image_write(context, image, unknown[i], NULL, &error), HL_ERROR_UNSUPPORTED);
    assert_non_null(strstr(error.message, ".png, .tif, .exr or .npy"));
  }
  hl_image_destroy(image);
  end_context(context);
}

static void layers_are_checked(void **state) {
  (void)state;
  static const char *const names[] = {"", "a b", "a.b", "a/b", "far_more_letters_than_channels_may_have"};
  static const char *const channels[] = {"", "r", "RR", "R G", "RGBAZ"};
  hl_context *context = make_context();
  hl_image *image = make_image(context, 2, 2);
  hl_error error = {0};
  float *values = NULL;
  for (int i = 0; i < 5; i++) {
    assert_int_equal(hl_image_add_layer(image, names[i], "RGB", &values, &error), HL_ERROR_ARGUMENT);
    assert_int_equal(hl_image_add_layer(image, "key", channels[i], &values, &error), HL_ERROR_ARGUMENT);
  }
  assert_int_equal(hl_image_add_layer(NULL, "key", "RGB", &values, &error), HL_ERROR_ARGUMENT);
  assert_int_equal(hl_image_add_layer(image, "key", "RGB", &values, &error), HL_OK);
  assert_int_equal(hl_image_add_layer(image, "key", "Z", &values, &error), HL_ERROR_ARGUMENT);
  assert_null(values);
  assert_int_equal(hl_image_write(context, image, "/tmp/x.png", NULL, &error), HL_ERROR_UNSUPPORTED);
  assert_non_null(strstr(error.message, ".exr or .npy"));
  hl_image_destroy(image);
  end_context(context);
}

static void reading_goes_by_content(void **state) {
  (void)state;
  hl_context *context = make_context();
  char folder[64], path[100], other[100];
  make_folder(folder);
  hl_image *image = make_structured(context, 5, 4), *back = NULL;
  hl_error error = {0};
  snprintf(path, sizeof path, "%s/a.npy", folder);
  snprintf(other, sizeof other, "%s/a.png", folder);
  assert_int_equal(hl_image_write(context, image, path, NULL, NULL), HL_OK);
  assert_int_equal(rename(path, other), 0);
  assert_int_equal(hl_image_read(context, other, &back, &error), HL_OK);
  assert_memory_equal(back->pixels, image->pixels, 5 * 4 * 16);
  hl_image_destroy(back);
  assert_int_equal(hl_image_read(context, path, &back, &error), HL_ERROR_IO);
  assert_null(back);
  assert_int_equal(hl_image_read(context, folder, &back, &error), HL_ERROR_IO);
  write_bytes(other, "hello", 5);
  assert_int_equal(hl_image_read(context, other, &back, &error), HL_ERROR_INPUT);
  assert_non_null(strstr(error.message, "not a PNG"));
  write_bytes(other, "", 0);
  assert_int_equal(hl_image_read(context, other, &back, &error), HL_ERROR_INPUT);
  snprintf(other, sizeof other, "%s/a.txt", folder);
  write_bytes(other, "hello", 5);
  assert_int_equal(hl_image_read(context, other, &back, &error), HL_ERROR_UNSUPPORTED);
  assert_non_null(strstr(error.message, "PNG, OpenEXR, Radiance HDR, NPY or TIFF"));
  hl_image_destroy(image);
  remove_folder(folder);
  end_context(context);
}

/* Each way in which writing a file can fail, for each format. */
static void bad_places_are_named(void **state) {
  (void)state;
  hl_context *context = make_context();
  char folder[64], path[120];
  make_folder(folder);
  hl_image *image = make_image(context, 3, 3);
  for (int e = 0; e < 3; e++) {
    hl_error error = {0};
    snprintf(path, sizeof path, "%s/missing/a.%s", folder, extensions[e]);
    assert_int_equal(hl_image_write(context, image, path, NULL, &error), HL_ERROR_IO);
    assert_non_null(strstr(error.message, "missing/a."));
    assert_non_null(strstr(error.message, "No such file"));
    snprintf(path, sizeof path, "%s/folder.%s", folder, extensions[e]);
    assert_int_equal(mkdir(path, 0777), 0);
    assert_int_equal(hl_image_write(context, image, path, NULL, &error), HL_ERROR_IO);
    assert_int_equal(count_files(path), 0);
    assert_int_equal(rmdir(path), 0);
    assert_int_equal(count_files(folder), 0);
  }
  hl_image_destroy(image);
  remove_folder(folder);
  end_context(context);
}

/* Writes each format to a device that is always full, as a disk may be from the first byte on. */
static void full_device_is_reported(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_image *image = make_structured(context, 200, 200);
  hl_image_write_options options;
  hl_image_write_options_defaults(&options);
  hl_status (*encode[])(const hl_image *, const hl_image_write_options *, hl_output *, hl_error *) = {
      hl_png_format.encode, hl_exr_format.encode, hl_npy_format.encode};
  for (int e = 0; e < 3; e++) {
    char name[] = "full.xyz";
    hl_output output = {.context = context, .path = name, .file = fopen("/dev/full", "wb")};
    if (output.file == NULL) skip();
    hl_error error = {0};
    assert_int_equal(encode[e](image, &options, &output, &error), HL_ERROR_IO);
    assert_non_null(strstr(error.message, "full.xyz: cannot write: No space left on device"));
    fclose(output.file);
  }
  hl_image_destroy(image);
  end_context(context);
}

/* A disk that is full after a number of bytes (by the limit on file sizes). No part of a file is left, and an
 * older file stays. */
static void disk_that_fills_up_keeps_the_old_file(void **state) {
  (void)state;
  hl_context *context = make_context();
  char folder[64], path[100];
  make_folder(folder);
  hl_image *old = make_image(context, 3, 3), *image = make_structured(context, 90, 70);
  signal(SIGXFSZ, SIG_IGN);
  struct rlimit unlimited, limit;
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &unlimited), 0);
  for (int e = 0; e < 3; e++) {
    snprintf(path, sizeof path, "%s/a.%s", folder, extensions[e]);
    assert_int_equal(hl_image_write(context, old, path, NULL, NULL), HL_OK);
    size_t before_length, after_length;
    unsigned char *before = read_bytes(context, path, &before_length);
    const rlim_t sizes[] = {0, 1, 100, 2000, 4096, 5000};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
      hl_error error = {0};
      limit = unlimited;
      limit.rlim_cur = sizes[i];
      assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
      hl_status status = hl_image_write(context, image, path, NULL, &error);
      assert_int_equal(setrlimit(RLIMIT_FSIZE, &unlimited), 0);
      assert_int_equal(status, HL_ERROR_IO);
      assert_non_null(strstr(error.message, "File too large"));
      unsigned char *after = read_bytes(context, path, &after_length);
      assert_int_equal(before_length, after_length);
      assert_memory_equal(before, after, before_length);
      hl_release(context, after);
    }
    hl_release(context, before);
  }
  assert_int_equal(count_files(folder), 3);
  signal(SIGXFSZ, SIG_DFL);
  hl_image_destroy(old);
  hl_image_destroy(image);
  remove_folder(folder);
  end_context(context);
}

/* ---- callbacks that misbehave on purpose ---- */

typedef struct callbacks {
  int asked, cancel_at, allocations, fail_at;
  double last_fraction;
} callbacks;

static int on_cancelled(void *user_data) {
  callbacks *c = user_data;
  return ++c->asked == c->cancel_at;
}

static void on_progress(void *user_data, const char *stage, double fraction) {
  callbacks *c = user_data;
  assert_string_equal(stage, "write");
  assert_true(fraction >= c->last_fraction && fraction <= 1);
  c->last_fraction = fraction;
}

static void *on_allocate(void *user_data, size_t size, size_t alignment) {
  callbacks *c = user_data;
  if (++c->allocations == c->fail_at) return NULL;
  return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void on_release(void *user_data, void *memory) {
  (void)user_data;
  free(memory);
}

static hl_context *make_callback_context(callbacks *c) {
  hl_context_options options;
  hl_context_options_defaults(&options);
  options.user_data = c;
  options.cancelled = on_cancelled;
  options.progress = on_progress;
  options.allocate = on_allocate;
  options.release = on_release;
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(&options, &context, NULL), HL_OK);
  return context;
}

static void cancelling_leaves_nothing(void **state) {
  (void)state;
  char folder[64], path[100];
  make_folder(folder);
  for (int e = 0; e < 3; e++) {
    callbacks c = {0};
    hl_context *context = make_callback_context(&c);
    hl_image *image = make_structured(context, 40, 100);
    snprintf(path, sizeof path, "%s/a.%s", folder, extensions[e]);
    c.cancel_at = 3;
    assert_int_equal(hl_image_write(context, image, path, NULL, NULL), HL_ERROR_CANCELLED);
    assert_int_equal(count_files(folder), e);
    c = (callbacks){0};
    assert_int_equal(hl_image_write(context, image, path, NULL, NULL), HL_OK);
    assert_true(c.asked >= 6 && c.last_fraction == 1);
    hl_image_destroy(image);
    end_context(context);
  }
  remove_folder(folder);
}

/* Each allocation in turn fails. The call reports it, and no memory leaks. */
static void every_allocation_may_fail(void **state) {
  (void)state;
  char folder[64], path[100];
  make_folder(folder);
  callbacks c = {0};
  hl_context *context = make_callback_context(&c);
  hl_image *image = make_structured(context, 20, 20);
  for (int e = 0; e < 3; e++) {
    snprintf(path, sizeof path, "%s/a.%s", folder, extensions[e]);
    for (int reading = 0; reading < 2; reading++) {
      hl_status status = HL_ERROR_MEMORY;
      int tries = 0;
      while (status == HL_ERROR_MEMORY) {
        assert_true(tries < 100);
        c = (callbacks){.fail_at = ++tries};
        hl_error error = {0};
        hl_image *back = NULL;
        uint64_t held = hl_context_memory_held(context);
        status = reading ? hl_image_read(context, path, &back, &error)
                         : hl_image_write(context, image, path, NULL, &error);
        if (status != HL_OK) assert_non_null(strstr(error.message, "memory"));
        hl_image_destroy(back);
        assert_int_equal(hl_context_memory_held(context), held);
        assert_int_equal(count_files(folder), status == HL_OK || reading ? e + 1 : e);
      }
      assert_int_equal(status, HL_OK);
      assert_true(tries > 2);
    }
  }
  hl_image_destroy(image);
  end_context(context);
  remove_folder(folder);
}

static void comparing_may_run_out_of_memory(void **state) {
  (void)state;
  callbacks c = {0};
  hl_context *context = make_callback_context(&c);
  hl_image *image = make_structured(context, 20, 20);
  c = (callbacks){.fail_at = 1};
  hl_image_difference difference = {.struct_size = sizeof difference};
  assert_int_equal(hl_image_compare(image, image, &difference, NULL), HL_ERROR_MEMORY);
  hl_image_destroy(image);
  end_context(context);
}

/* Each allocation of a picture that is encoded in memory fails in turn. The error is reported, and no memory
 * is left. */
static void encoding_may_run_out_of_memory(void **state) {
  (void)state;
  static const char *const formats[] = {"png", "exr", "npy"};
  callbacks c = {0};
  hl_context *context = make_callback_context(&c);
  hl_image *image = make_structured(context, 20, 20);
  for (int n = 0; n < 3; n++) {
    hl_status status = HL_ERROR_MEMORY;
    for (int at = 1; status != HL_OK && at < 100; at++) {
      unsigned char *bytes = NULL;
      size_t length = 0;
      c = (callbacks){.fail_at = at};
      status = hl_image_encode(context, image, formats[n], NULL, &bytes, &length, NULL);
      assert_true(status == HL_OK || status == HL_ERROR_MEMORY);
      assert_true((bytes != NULL) == (status == HL_OK));
      hl_bytes_release(context, bytes);
    }
    assert_int_equal(status, HL_OK);
  }
  hl_image_destroy(image);
  end_context(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(arguments_are_checked),
                                     cmocka_unit_test(layers_are_checked),
                                     cmocka_unit_test(reading_goes_by_content),
                                     cmocka_unit_test(bad_places_are_named),
                                     cmocka_unit_test(full_device_is_reported),
                                     cmocka_unit_test(disk_that_fills_up_keeps_the_old_file),
                                     cmocka_unit_test(cancelling_leaves_nothing),
                                     cmocka_unit_test(every_allocation_may_fail),
                                     cmocka_unit_test(comparing_may_run_out_of_memory),
                                     cmocka_unit_test(encoding_may_run_out_of_memory)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
