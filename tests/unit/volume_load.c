/* tests/unit/volume_load.c - every format, type, byte order and encoding comes out as it went in. */
#include "volume_files.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/context.h"

typedef struct load_state {
  hl_context *context;
  char folder[FOLDER_BYTES];
  int samples, failures;
} load_state;

static void load_sample(const volume_sample *sample, void *data) {
  load_state *state = data;
  char path[PATH_BYTES];
  hl_error error = {0};
  hl_volume *volume = NULL;
  write_sample(state->folder, sample, path);
  hl_status status = hl_volume_load(state->context, path, &volume, &error);
  if (status != HL_OK || !is_sample(volume, sample, VOXELS)) {
    print_message("# %s: %s\n", sample->name, status == HL_OK ? "other voxels or place" : error.message);
    state->failures++;
  }
  hl_volume_release(volume);
  remove_sample(state->folder, sample);
  state->samples++;
}

static void test_all_samples(void **unused) {
  (void)unused;
  load_state state = {.samples = 0};
  make_folder(state.folder);
  assert_int_equal(hl_context_create(NULL, &state.context, NULL), HL_OK);
  for_each_sample(load_sample, &state);
  assert_int_equal(state.failures, 0);
  assert_true(state.samples > 600);
  assert_int_equal(hl_context_memory_held(state.context), 0);
  hl_context_destroy(state.context);
  remove_folder(state.folder);
}

/* A file that is packed by gzip as a whole is read as the file, whatever its format is. */
static void load_compressed_sample(const volume_sample *sample, void *data) {
  if (sample->other_name[0] != 0 || sample->type != HL_VOXEL_I16 || sample->file.data[0] == 0x1f) return;
  volume_sample packed = *sample;
  packed.file.length = 0;
  add_compressed(&packed.file, sample->file.data, sample->file.length, true);
  load_sample(&packed, data);
}

static void test_formats_under_gzip(void **unused) {
  (void)unused;
  load_state state = {.samples = 0};
  make_folder(state.folder);
  assert_int_equal(hl_context_create(NULL, &state.context, NULL), HL_OK);
  for_each_sample(load_compressed_sample, &state);
  assert_int_equal(state.failures, 0);
  assert_true(state.samples > 40);
  hl_context_destroy(state.context);
  remove_folder(state.folder);
}

/* The peak memory of a large load is one volume, and buffers that do not depend on its size. */
static void check_peak(const char *name, const byte_buffer *header, size_t payload_bytes,
                       size_t volume_bytes) {
  char folder[FOLDER_BYTES], path[PATH_BYTES];
  static const unsigned char zeros[1 << 16];
  hl_context *context = NULL;
  hl_volume *volume = NULL;
  make_folder(folder);
  write_file(folder, name, header, path);
  FILE *file = fopen(path, "ab");
  assert_non_null(file);
  for (size_t n = 0; n < payload_bytes; n += sizeof zeros)
    assert_int_equal(fwrite(zeros, 1, sizeof zeros, file), sizeof zeros);
  fclose(file);
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  assert_int_equal(hl_volume_load(context, path, &volume, NULL), HL_OK);
  assert_true(hl_context_memory_peak(context) < volume_bytes + 700000);
  hl_volume_release(volume);
  hl_context_destroy(context);
  remove_folder(folder);
}

static void test_peak_memory_is_one_volume(void **unused) {
  (void)unused;
  byte_buffer header = {.length = 0};
  check_peak("a_128x128x128_int16.raw", &header, 2 << 21, 2 << 21);
  check_peak("a_128x128x128_float64_be.raw", &header, 8 << 21, 4 << 21);
  add_text(&header, "NRRD0004\ntype: int\nendian: big\ndimension: 3\nsizes: 128 128 128\nencoding: raw\n\n");
  check_peak("a.nrrd", &header, 4 << 21, 4 << 21);
}

typedef struct watcher {
  int calls, cancel_at;
  double last;
  bool ordered;
} watcher;

static void watch(void *user_data, const char *stage, double fraction) {
  watcher *seen = user_data;
  seen->ordered = seen->ordered && strcmp(stage, "load") == 0 && fraction >= seen->last && fraction <= 1;
  seen->last = fraction;
  seen->calls++;
}

static int is_cancelled(void *user_data) {
  watcher *seen = user_data;
  return seen->cancel_at > 0 && seen->calls >= seen->cancel_at;
}

static void test_progress_and_cancelling(void **unused) {
  (void)unused;
  char folder[FOLDER_BYTES], path[PATH_BYTES];
  byte_buffer nothing = {.length = 0};
  make_folder(folder);
  write_file(folder, "a_256x128x128_uint8.raw", &nothing, path);
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  for (int n = 0; n < 256 * 128 * 128; n++) fputc(n & 255, file);
  fclose(file);
  for (int cancel_at = 0; cancel_at < 4; cancel_at++) {
    watcher seen = {.cancel_at = cancel_at, .ordered = true};
    hl_context_options options;
    hl_context_options_defaults(&options);
    options.user_data = &seen;
    options.progress = watch;
    options.cancelled = is_cancelled;
    hl_context *context = NULL;
    hl_volume *volume = NULL;
    assert_int_equal(hl_context_create(&options, &context, NULL), HL_OK);
    hl_status status = hl_volume_load(context, path, &volume, NULL);
    assert_int_equal(status, cancel_at > 0 ? HL_ERROR_CANCELLED : HL_OK);
    assert_true(seen.ordered);
    if (cancel_at == 0) assert_true(seen.calls >= 4 && seen.last == 1);
    else assert_int_equal(seen.calls, cancel_at);
    hl_volume_release(volume);
    assert_int_equal(hl_context_memory_held(context), 0);
    hl_context_destroy(context);
  }
  remove_folder(folder);
}

/* Raw voxels may begin with the mark of gzip or of another format. Their name and exact size tell that they
 * are raw. */
static void test_raw_voxels_that_look_compressed(void **unused) {
  (void)unused;
  char folder[FOLDER_BYTES], path[PATH_BYTES];
  hl_context *context = NULL;
  hl_volume *volume = NULL;
  byte_buffer file = {.data = {0x1f, 0x8b, 8, 0, 0, 0, 0, 0}, .length = 8};
  make_folder(folder);
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  write_file(folder, "2x2x2_uint8.raw", &file, path);
  assert_int_equal(hl_volume_load(context, path, &volume, NULL), HL_OK);
  assert_true(hl_volume_value(volume, 1, 0, 0) == 0x8b);
  hl_volume_release(volume);
  hl_context_destroy(context);
  remove_folder(folder);
}

static void put_bytes(byte_buffer *file, size_t place, const void *from, size_t length) {
  memcpy(file->data + place, from, length);
}

/* A half turn about (1, 1, 0), whose halves of a quaternion are floats: 1 - b b - c c is 5e-8 in place of 0.
 * Below 1e-7 it counts as 0, as in nifti_quatern_to_mat44() of nifti1_io.c; kept, it would turn the volume by
 * .03 degrees. */
static void test_half_turn_of_nifti(void **unused) {
  (void)unused;
  static const int16_t dimensions[] = {3, 2, 2, 2}, u8 = 2, bits = 8, has_qform = 1;
  static const float steps[] = {1, 1, 1, 1}, offset = 352;
  const float quaternion[] = {(float)sqrt(0.5), (float)sqrt(0.5), 0};
  const int32_t header_bytes = 348;
  char folder[FOLDER_BYTES], path[PATH_BYTES];
  hl_context *context = NULL;
  hl_volume *volume = NULL;
  hl_volume_info info = {.struct_size = sizeof info};
  byte_buffer file = {.length = 352 + 8};
  put_bytes(&file, 0, &header_bytes, 4);
  put_bytes(&file, 40, dimensions, sizeof dimensions);
  put_bytes(&file, 70, &u8, 2);
  put_bytes(&file, 72, &bits, 2);
  put_bytes(&file, 76, steps, sizeof steps);
  put_bytes(&file, 108, &offset, 4);
  put_bytes(&file, 252, &has_qform, 2);
  put_bytes(&file, 256, quaternion, sizeof quaternion);
  put_bytes(&file, 344, "n+1", 4);
  make_folder(folder);
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  write_file(folder, "half_turn.nii", &file, path);
  assert_int_equal(hl_volume_load(context, path, &volume, NULL), HL_OK);
  assert_int_equal(hl_volume_get_info(volume, &info), HL_OK);
  static const double expected[3][3] = {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}};
  for (int row = 0; row < 3; row++)
    for (int axis = 0; axis < 3; axis++)
      assert_true(fabs(info.direction[row][axis] - expected[row][axis]) <
                  (expected[row][axis] == 0 ? 1e-300 : 1e-15));
  hl_volume_release(volume);
  hl_context_destroy(context);
  remove_folder(folder);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_all_samples),
      cmocka_unit_test(test_formats_under_gzip),
      cmocka_unit_test(test_peak_memory_is_one_volume),
      cmocka_unit_test(test_progress_and_cancelling),
      cmocka_unit_test(test_raw_voxels_that_look_compressed),
      cmocka_unit_test(test_half_turn_of_nifti),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
