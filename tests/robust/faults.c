/* tests/robust/faults.c - every allocation fails in turn, and every question whether to stop is answered with
 * yes, in all calls of the library except rendering (faults_rendering.c). Each time there is a clean status
 * and a message of one line, and no memory is held. */
#include "faulty.h"
#include "small_scenes.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "volume_files.h"

static char folder[FOLDER_BYTES];

static int open_folder(void **state) {
  (void)state;
  make_folder(folder);
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  assert_int_equal(small_files_write(context, folder, NULL), HL_OK);
  hl_context_destroy(context);
  return 0;
}

static int close_folder(void **state) {
  (void)state;
  remove_folder(folder);
  return 0;
}

static char *path_of(const char *name, char path[PATH_BYTES]) {
  snprintf(path, PATH_BYTES, "%s/%s", folder, name);
  return path;
}

/* ---- volumes ---- */

static hl_status load_path(faulty *f, void *path, hl_error *error) {
  hl_volume *volume = NULL;
  hl_status status = hl_volume_load(f->context, path, &volume, error);
  hl_volume_release(volume);
  return status;
}

static void load_sample(const volume_sample *sample, void *data) {
  faulty *f = data;
  char path[PATH_BYTES];
  write_sample(folder, sample, path);
  assert_true(faulty_fail_each(f, load_path, NULL, path) >= 3);
  assert_true(faulty_stop_each(f, load_path, NULL, path) >= 1);
  remove_sample(folder, sample);
}

static void test_loading_volumes(void **state) {
  (void)state;
  faulty f;
  faulty_open(&f);
  for_each_sample(load_sample, &f);
  faulty_close(&f);
}

static hl_status save_path(faulty *f, void *path, hl_error *error) {
  hl_volume_description description;
  hl_volume *volume = NULL;
  float voxels[8] = {1, 2, 3, 4, 5, 6, 7, NAN};
  hl_volume_description_defaults(&description);
  for (int axis = 0; axis < 3; axis++) description.dimensions[axis] = 2;
  description.type = HL_VOXEL_F32;
  description.voxels = voxels;
  description.stride_bytes[0] = 4, description.stride_bytes[1] = 8, description.stride_bytes[2] = 16;
  hl_status status = hl_volume_create(f->context, &description, &volume, error);
  if (status == HL_OK) status = hl_volume_save(f->context, volume, path, error);
  hl_volume_release(volume);
  if (status == HL_OK) assert_int_equal(unlink(path), 0);
  assert_int_not_equal(access(path, F_OK), 0); /* the file is whole, or there is no file */
  return status;
}

static void test_saving_volumes(void **state) {
  (void)state;
  static const char *const names[] = {"saved.nrrd", "saved_2x2x2_float32.raw", "saved_2x2x2_float32.raw.gz"};
  char path[PATH_BYTES];
  faulty f;
  faulty_open(&f);
  for (int n = 0; n < 3; n++) {
    assert_true(faulty_fail_each(&f, save_path, NULL, path_of(names[n], path)) >= 5);
    assert_true(faulty_stop_each(&f, save_path, NULL, path) >= 2);
  }
  faulty_close(&f);
}

static hl_status make_shapes(faulty *f, void *data, hl_error *error) {
  const char *text = hl_shape_preset_text(data);
  hl_shapes_options options;
  hl_volume *volume = NULL;
  hl_shapes_options_defaults(&options);
  options.size = 16;
  options.threads = 1;
  hl_status status = hl_volume_from_shapes(f->context, text, strlen(text), "shapes", &options, &volume,
                                           error);
  hl_volume_release(volume);
  return status;
}

static void test_making_volumes(void **state) {
  (void)state;
  faulty f;
  faulty_open(&f);
  for (size_t n = 0; hl_shape_preset_name(n) != NULL; n++) {
    assert_true(faulty_fail_each(&f, make_shapes, NULL, (void *)hl_shape_preset_name(n)) >= 5);
    assert_true(faulty_stop_each(&f, make_shapes, NULL, (void *)hl_shape_preset_name(n)) >= 1);
  }
  faulty_close(&f);
}

/* ---- scenes ---- */

typedef struct scene_work {
  size_t index;
  char *text; /* the text of the scene that was written */
} scene_work;

/* If a text of shapes finds no equal text, that costs only time: the scene must be the same. */
static hl_status read_scene(faulty *f, void *data, hl_error *error) {
  const scene_work *work = data;
  hl_scene *scene = NULL;
  hl_status status = small_scene_make(f->context, work->index, folder, &scene, error);
  if (status == HL_OK) {
    char *text = NULL;
    long left = atomic_exchange(&f->allocations_left, -1);
    assert_int_equal(hl_scene_to_json(f->context, scene, &text, error), HL_OK);
    assert_string_equal(text, work->text);
    hl_text_release(f->context, text);
    atomic_store(&f->allocations_left, left);
  }
  hl_scene_release(scene);
  return status;
}

static hl_status write_scene(faulty *f, void *data, hl_error *error) {
  char *text = NULL;
  hl_status status = hl_scene_to_json(f->context, data, &text, error);
  hl_text_release(f->context, text);
  return status;
}

static hl_status copy_scene(faulty *f, void *data, hl_error *error) {
  hl_scene *scene = NULL;
  hl_status status = hl_scene_create(f->context, hl_scene_describe(data), &scene, error);
  hl_scene_release(scene);
  return status;
}

static void test_scenes(void **state) {
  (void)state;
  faulty f;
  faulty_open(&f);
  for (size_t n = 0; n < small_scene_count; n++) {
    hl_scene *scene = NULL;
    scene_work work = {.index = n};
    assert_int_equal(small_scene_make(f.context, n, folder, &scene, NULL), HL_OK);
    assert_int_equal(hl_scene_to_json(f.context, scene, &work.text, NULL), HL_OK);
    f.may_recover = true;
    assert_true(faulty_fail_each(&f, read_scene, NULL, &work) >= 5);
    f.may_recover = false;
    assert_true(faulty_stop_each(&f, read_scene, NULL, &work) >= 1);
    hl_text_release(f.context, work.text);
    assert_true(faulty_fail_each(&f, write_scene, NULL, scene) >= 1);
    assert_true(faulty_fail_each(&f, copy_scene, NULL, scene) >= 3);
    hl_scene_release(scene);
  }
  faulty_close(&f);
}

/* A ball that fades out, with noise or without: a volume of things with surfaces, and a volume that is a
 * field. */
static hl_status make_ball(hl_context *context, bool noise, hl_volume **volume, hl_error *error) {
  enum { SIDE = 20 };
  static unsigned char voxels[SIDE * SIDE * SIDE];
  unsigned state = 1;
  for (int n = 0; n < SIDE * SIDE * SIDE; n++) {
    double x = n % SIDE - 9.5, y = n / SIDE % SIDE - 9.5, z = n / SIDE / SIDE - 9.5;
    state = state * 1103515245u + 12345u;
    double value = 200 * exp(-(x * x + y * y + z * z) / 30) + (noise ? (state >> 16) % 40 : 0);
    voxels[n] = (unsigned char)value;
  }
  hl_volume_description description;
  hl_volume_description_defaults(&description);
  for (int axis = 0; axis < 3; axis++) description.dimensions[axis] = SIDE;
  description.type = HL_VOXEL_U8;
  description.voxels = voxels;
  return hl_volume_create(context, &description, volume, error);
}

/* Results about a volume are kept with the volume, so that each run makes a volume of its own. data: a bool,
 * whether there is noise. */
static hl_status show_volume(faulty *f, void *data, hl_error *error) {
  hl_volume *volume = NULL;
  hl_scene *scene = NULL;
  hl_status status = make_ball(f->context, *(const bool *)data, &volume, error);
  if (status == HL_OK) status = hl_scene_for_volume(f->context, volume, NULL, &scene, error);
  hl_scene_release(scene);
  hl_volume_release(volume);
  return status;
}

static hl_status read_function(faulty *f, void *data, hl_error *error) {
  hl_transfer_function function = {0};
  hl_status status = hl_transfer_function_load(f->context, data, &function, error);
  if (status == HL_OK) hl_transfer_function_release(f->context, &function);
  return status;
}

static hl_status fit_functions(faulty *f, void *data, hl_error *error) {
  hl_volume *volume = NULL;
  hl_status status = make_ball(f->context, *(const bool *)data, &volume, error);
  for (size_t n = 0; status == HL_OK && hl_preset_name(n) != NULL; n++) {
    hl_transfer_function function = {0};
    status = hl_transfer_function_preset(f->context, hl_preset_name(n), volume, &function, error);
    if (status == HL_OK) status = hl_transfer_function_colormap(f->context, "turbo", 0, 1, &function, error);
    hl_transfer_function_release(f->context, &function);
  }
  hl_volume_release(volume);
  return status;
}

static void test_automatic_scenes(void **state) {
  (void)state;
  static const char function[] =
      "{\"opacity\": [[0, 0], [255, 1]], \"colormap\": \"bone\", \"range\": [0, 255]}";
  static const char foreign[] =
      "[{\"ColorSpace\": \"Lab\", \"Name\": \"x\", \"Points\": [0, 0, 0.5, 0, 1, 1, 0.5, 0],"
      " \"RGBPoints\": [0, 0, 0, 0, 1, 1, 1, 1]}]";
  char path[PATH_BYTES];
  byte_buffer content = {.length = 0};
  faulty f;
  faulty_open(&f);
  for (int n = 0; n < 2; n++) {
    bool noise = n == 1;
    assert_true(faulty_fail_each(&f, show_volume, NULL, &noise) >= 5);
    assert_true(faulty_stop_each(&f, show_volume, NULL, &noise) >= 1);
    assert_true(faulty_fail_each(&f, fit_functions, NULL, &noise) >= 5);
  }
  add_text(&content, "%s", function);
  write_file(folder, "own.json", &content, path);
  assert_true(faulty_fail_each(&f, read_function, NULL, path) >= 2);
  content.length = 0;
  add_text(&content, "%s", foreign);
  write_file(folder, "paraview.json", &content, path);
  assert_true(faulty_fail_each(&f, read_function, NULL, path) >= 2);
  faulty_close(&f);
}

/* ---- pictures ---- */

typedef struct picture_work {
  const hl_image *image;
  char path[PATH_BYTES];
} picture_work;

static hl_status write_picture(faulty *f, void *data, hl_error *error) {
  picture_work *work = data;
  hl_image_write_options options;
  hl_image_write_options_defaults(&options);
  options.scene_json = "{\"halflight\": 1}";
  return hl_image_write(f->context, work->image, work->path, &options, error);
}

static hl_status read_picture(faulty *f, void *data, hl_error *error) {
  picture_work *work = data;
  hl_image *image = NULL;
  hl_status status = hl_image_read(f->context, work->path, &image, error);
  hl_image_destroy(image);
  return status;
}

static hl_status make_picture(faulty *f, void *data, hl_error *error) {
  hl_image *image = NULL;
  float *values;
  (void)data;
  hl_status status = hl_image_create(f->context, 30, 200, &image, error);
  if (status == HL_OK) status = hl_image_add_layer(image, "depth", "Z", &values, error);
  if (status == HL_OK) status = hl_image_add_layer(image, "key", "RGB", &values, error);
  hl_image_destroy(image);
  return status;
}

static void test_pictures(void **state) {
  (void)state;
  static const char *const names[] = {"picture.png", "picture.exr", "picture.npy"};
  faulty f;
  faulty_open(&f);
  assert_true(faulty_fail_each(&f, make_picture, NULL, NULL) >= 4);
  assert_true(faulty_stop_each(&f, make_picture, NULL, NULL) >= 1);
  for (int n = 0; n < 3; n++) {
    hl_image *image = NULL;
    float *values;
    assert_int_equal(hl_image_create(f.context, 21, 40, &image, NULL), HL_OK);
    for (int i = 0; i < 21 * 40 * 4; i++) hl_image_pixels(image)[i] = (float)(i % 97) / 97;
    picture_work work = {.image = image};
    path_of(names[n], work.path);
    if (n > 0) assert_int_equal(hl_image_add_layer(image, "key", "RGB", &values, NULL), HL_OK);
    assert_true(faulty_fail_each(&f, write_picture, NULL, &work) >= 2);
    assert_true(faulty_stop_each(&f, write_picture, NULL, &work) >= 2);
    assert_true(faulty_fail_each(&f, read_picture, NULL, &work) >= 2);
    assert_true(faulty_stop_each(&f, read_picture, NULL, &work) >= 1);
    hl_image_destroy(image);
  }
  faulty_close(&f);
}

static void test_the_context_itself(void **state) {
  (void)state;
  faulty f;
  faulty_open(&f);
  hl_context_options options = {.struct_size = sizeof options};
  hl_context *context = NULL;
  hl_error error = {0};
  options.memory_limit = 100000;
  assert_int_equal(hl_context_create(&options, &context, &error), HL_OK);
  hl_image *image = NULL;
  assert_int_equal(hl_image_create(context, 100, 100, &image, &error), HL_ERROR_MEMORY);
  assert_null(image);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
  faulty_close(&f);
}

/* The system's allocator fails, too, while volumes are read and written. zlib survives that, and the JSON
 * parser does not. */
#ifdef FAULTY_SYSTEM
enum { TESTS = 2 };
#else
enum { TESTS = 7 };
#endif

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_loading_volumes),    cmocka_unit_test(test_saving_volumes),
      cmocka_unit_test(test_making_volumes),     cmocka_unit_test(test_scenes),
      cmocka_unit_test(test_automatic_scenes),   cmocka_unit_test(test_pictures),
      cmocka_unit_test(test_the_context_itself),
  };
  return _cmocka_run_group_tests("faults", tests, TESTS, open_folder, close_folder);
}
