/* tests/robust/host.c - the library as a guest in a host program that has another locale, other rounding,
 * flushing and traps of floats, and a umask, that calls the library from its callbacks, and that changes
 * voxels which the library has borrowed. */
#define _GNU_SOURCE
#include "small_scenes.h"

#include <fenv.h>
#include <locale.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

static char folder[] = "/tmp/halflight-host-XXXXXX";

static hl_context *make_context(void) {
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  return context;
}

/* Everything that the tests compare: texts, files and pictures, one after the other. */
typedef struct results {
  unsigned char *bytes; /* owned; [length] */
  size_t length;
} results;

static void add(results *all, const void *bytes, size_t length) {
  all->bytes = realloc(all->bytes, all->length + length);
  assert_non_null(all->bytes);
  memcpy(all->bytes + all->length, bytes, length);
  all->length += length;
}

static void add_file(results *all, const char *path) {
  FILE *file = fopen(path, "rb");
  unsigned char bytes[4096];
  assert_non_null(file);
  for (size_t got; (got = fread(bytes, 1, sizeof bytes, file)) > 0;) add(all, bytes, got);
  fclose(file);
}

/* ---- a day's work ---- */

static void render_all(hl_context *context, results *all) {
  for (size_t n = 0; n < small_scene_count; n++) {
    hl_scene *scene = NULL;
    hl_renderer *renderer = NULL;
    char *text = NULL;
    hl_error error = {0};
    if (small_scene_make(context, n, folder, &scene, &error) != HL_OK) fail_msg("%s", error.message);
    hl_scene_description description = *hl_scene_describe(scene);
    hl_scene *threaded = NULL;
    description.render.threads = 2;
    assert_int_equal(hl_scene_create(context, &description, &threaded, &error), HL_OK);
    size_t floats = small_scene_floats(scene);
    float *pixels = calloc(floats, sizeof *pixels);
    assert_int_equal(hl_renderer_create(context, &renderer, &error), HL_OK);
    if (hl_renderer_render(renderer, threaded, pixels, 4 * (size_t)description.width, NULL, &error) != HL_OK)
      fail_msg("%s: %s", small_scenes[n].name, error.message);
    add(all, pixels, floats * sizeof *pixels);
    assert_int_equal(hl_scene_to_json(context, scene, &text, &error), HL_OK);
    add(all, text, strlen(text));
    hl_text_release(context, text);
    free(pixels);
    hl_renderer_destroy(renderer);
    hl_scene_release(threaded);
    hl_scene_release(scene);
  }
}

enum { SIDE = 12, VOXELS = SIDE * SIDE * SIDE };

static float voxels[VOXELS];
static double percents[3], axis_lengths[3];

/* The host's numbers are made before its environment changes, because with DAZ set 1e-41 would be 0. */
static void make_numbers(void) {
  static const double given_percents[] = {1, 33.3, 99.5};
  for (int n = 0; n < VOXELS; n++) {
    int i = n % SIDE, j = n / SIDE % SIDE, k = n / SIDE / SIDE;
    voxels[n] = 1e-3f * (float)(i * i + 3 * j + k * j) + 1e-41f * (float)(n % 7);
  }
  for (int a = 0; a < 3; a++) percents[a] = given_percents[a], axis_lengths[a] = 0.1 * (a + 7);
}

/* The kind that a bare volume is taken for, its statistics, and its files. */
static void look_at_volume(hl_context *context, results *all) {
  static const char *const endings[] = {".nrrd", ".mha", ".vti", ".nii", ".mrc"};
  hl_volume_description description;
  hl_volume *volume = NULL;
  hl_volume_info info = {.struct_size = sizeof info};
  hl_scene *scene = NULL;
  hl_error error = {0};
  double values[3];
  char *text = NULL, path[200];
  hl_volume_description_defaults(&description);
  for (int a = 0; a < 3; a++) description.dimensions[a] = SIDE, description.axis[a][a] = axis_lengths[a];
  description.type = HL_VOXEL_F32;
  description.voxels = voxels;
  description.value_scale = 1.7;
  assert_int_equal(hl_volume_create(context, &description, &volume, &error), HL_OK);
  assert_int_equal(hl_volume_get_info(volume, &info), HL_OK);
  add(all, &info.mean, sizeof info.mean);
  add(all, info.histogram, sizeof info.histogram);
  assert_int_equal(hl_volume_percentiles(volume, percents, 3, values, &error), HL_OK);
  add(all, values, sizeof values);
  for (size_t n = 0; n < sizeof endings / sizeof *endings; n++) {
    hl_volume *again = NULL;
    snprintf(path, sizeof path, "%s/volume%s", folder, endings[n]);
    if (hl_volume_save(context, volume, path, &error) != HL_OK) fail_msg("%s", error.message);
    add_file(all, path);
    if (hl_volume_load(context, path, &again, &error) != HL_OK) fail_msg("%s", error.message);
    assert_int_equal(hl_volume_get_info(again, &info), HL_OK);
    add(all, &info.mean, sizeof info.mean);
    add(all, info.spacing, sizeof info.spacing);
    hl_volume_release(again);
  }
  if (hl_scene_for_volume(context, volume, "volume.nrrd", &scene, &error) != HL_OK)
    fail_msg("%s", error.message);
  assert_int_equal(hl_scene_to_json(context, scene, &text, &error), HL_OK);
  add(all, text, strlen(text));
  hl_text_release(context, text);
  hl_scene_release(scene);
  hl_volume_release(volume);
}

/* Percentiles in a scene, a mesh in text, and the numbers of an error line. */
static void read_texts(hl_context *context, results *all) {
  static const char of_file[] =
      "{\"halflight\": 1, \"volumes\": [{\"file\": \"volume.nrrd\", \"transfer_function\": {\"opacity\": "
      "[[0, 0], "
      "[0.25, 0.5]], \"colormap\": \"grays\", \"range\": [\"1.5%\", \"99.5%\"]}}]}";
  static const char wrong[] = "{\"halflight\": 1, \"image\": {\"exposure\": 1234.5}, \"volumes\": []}";
  hl_scene *scene = NULL;
  hl_mesh *mesh = NULL;
  hl_error error = {0};
  char *text = NULL, path[200];
  if (hl_scene_from_json(context, of_file, sizeof of_file - 1, folder, "of file", &scene, &error) != HL_OK)
    fail_msg("%s", error.message);
  assert_int_equal(hl_scene_to_json(context, scene, &text, &error), HL_OK);
  add(all, text, strlen(text));
  hl_text_release(context, text);
  hl_scene_release(scene);
  assert_int_equal(hl_scene_from_json(context, wrong, sizeof wrong - 1, NULL, "wrong", &scene, &error),
                   HL_ERROR_INPUT);
  add(all, error.message, strlen(error.message));
  snprintf(path, sizeof path, "%s/MESH.OBJ", folder);
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  fputs("v 0.5 0 0\nv 1.25 0.125 0\nv 0 1.5e-1 2.75\nf 1 2 3\n", file);
  fclose(file);
  if (hl_mesh_load(context, path, &mesh, &error) != HL_OK) fail_msg("%s", error.message);
  const hl_mesh_description *d = hl_mesh_describe(mesh);
  add(all, d->positions, d->vertex_count * sizeof *d->positions);
  hl_mesh_release(mesh);
}

static results work(void) {
  results all = {0};
  hl_context *context = make_context();
  render_all(context, &all);
  look_at_volume(context, &all);
  read_texts(context, &all);
  hl_context_destroy(context);
  return all;
}

static results expected;

static void assert_same(const char *host) {
  results found = work();
  if (found.length != expected.length || memcmp(found.bytes, expected.bytes, found.length) != 0) {
    size_t at = 0;
    while (at < found.length && at < expected.length && found.bytes[at] == expected.bytes[at]) at++;
    fail_msg("%s: other results, from byte %zu of %zu on", host, at, expected.length);
  }
  free(found.bytes);
}

/* ---- locales ---- */

/* Makes a locale from Debian's sources. Returns false if they are not installed. */
static bool make_locale(const char *source) {
  char command[400];
  snprintf(command, sizeof command, "localedef -i %s -f UTF-8 %s/%s.UTF-8 >/dev/null 2>&1", source, folder,
           source);
  (void)!system(command);
  snprintf(command, sizeof command, "%s/%s.UTF-8/LC_NUMERIC", folder, source);
  return access(command, R_OK) == 0;
}

static void test_locale(void **state) {
  /* one and a half is 1,5 in the first and 1٫5 in the second; in the third, a small i is no I when it is made
   * large */
  static const char *const sources[] = {"de_DE", "ps_AF", "tr_TR"};
  (void)state;
  setenv("LOCPATH", folder, 1);
  for (size_t n = 0; n < sizeof sources / sizeof *sources; n++) {
    char name[40];
    if (!make_locale(sources[n])) skip();
    snprintf(name, sizeof name, "%s.UTF-8", sources[n]);
    assert_non_null(setlocale(LC_ALL, name));
    assert_string_not_equal(localeconv()->decimal_point, ".");
    assert_same(name);
    assert_string_equal(setlocale(LC_ALL, NULL), name);
    setlocale(LC_ALL, "C");
  }
}

/* ---- floating-point environments ---- */

static void assert_same_environment(const char *host) {
  fenv_t before, after;
  fegetenv(&before);
  assert_same(host);
  fegetenv(&after);
  fesetenv(FE_DFL_ENV);
#if defined(__x86_64__)
  assert_int_equal(before.__mxcsr, after.__mxcsr);
  assert_int_equal(before.__control_word, after.__control_word);
#endif
}

static void test_rounding(void **state) {
  static const int modes[] = {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
  (void)state;
  for (size_t n = 0; n < sizeof modes / sizeof *modes; n++) {
    fesetround(modes[n]);
    assert_same_environment("rounding");
  }
}

static void test_flushing(void **state) {
  (void)state;
#if defined(__x86_64__)
  __builtin_ia32_ldmxcsr(__builtin_ia32_stmxcsr() | 0x8040);
  assert_same_environment("FTZ and DAZ");
#else
  skip();
#endif
}

static void test_traps(void **state) {
  (void)state;
  feclearexcept(FE_ALL_EXCEPT);
  if (feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW | FE_UNDERFLOW) < 0) skip();
  assert_same_environment("traps");
}

/* A flag of floats that the host has set stays set, too. */
static void test_flags(void **state) {
  (void)state;
  feclearexcept(FE_ALL_EXCEPT);
  results found = work();
  free(found.bytes);
  assert_int_equal(fetestexcept(FE_ALL_EXCEPT), 0);
}

/* ---- files ---- */

static void test_umask(void **state) {
  (void)state;
  static const mode_t masks[] = {0027, 0077, 0002};
  hl_context *context = make_context();
  char path[200];
  snprintf(path, sizeof path, "%s/slide.png", folder);
  for (size_t n = 0; n < sizeof masks / sizeof *masks; n++) {
    struct stat about;
    mode_t before = umask(masks[n]);
    assert_int_equal(small_files_write(context, folder, NULL), HL_OK);
    assert_int_equal(umask(before), masks[n]);
    assert_int_equal(stat(path, &about), 0);
    assert_int_equal(about.st_mode & 0777, 0666 & ~masks[n]);
  }
  hl_context_destroy(context);
}

/* ---- callbacks ---- */

typedef struct calling_host {
  hl_renderer *renderer, *other;
  hl_scene *scene;
  int told;
  bool destroys;
} calling_host;

static void on_progress(void *user_data, const char *stage, double fraction) {
  calling_host *host = user_data;
  (void)stage, (void)fraction;
  if (host->renderer == NULL || host->told++ > 0) return;
  size_t floats = small_scene_floats(host->scene);
  float *pixels = calloc(floats, sizeof *pixels);
  hl_error error = {0};
  assert_int_equal(hl_renderer_render(host->renderer, host->scene, pixels, 4 * 24, NULL, &error),
                   HL_ERROR_ARGUMENT);
  assert_string_equal(error.message,
                      "hl_renderer_render: the renderer makes a frame: callbacks and other threads "
                      "need renderers of their own");
  assert_int_equal(hl_renderer_share(host->renderer, 0, 2, &error), HL_ERROR_ARGUMENT);
  calling_host quiet = *host;
  host->renderer = NULL; /* the other renderer's frame tells its progress, too */
  assert_int_equal(hl_renderer_render(host->other, host->scene, pixels, 4 * 24, NULL, &error), HL_OK);
  host->renderer = quiet.renderer;
  if (host->destroys) hl_renderer_destroy(host->renderer);
  free(pixels);
}

static void test_callbacks(void **state) {
  (void)state;
  static float pixels[2][24 * 20 * 4];
  for (int destroys = 0; destroys < 2; destroys++) {
    calling_host host = {.destroys = destroys};
    hl_context_options options;
    hl_context *context = NULL;
    hl_renderer *renderer = NULL;
    hl_context_options_defaults(&options);
    options.user_data = &host;
    options.progress = on_progress;
    assert_int_equal(hl_context_create(&options, &context, NULL), HL_OK);
    assert_int_equal(small_scene_make(context, 0, NULL, &host.scene, NULL), HL_OK);
    assert_int_equal(hl_renderer_create(context, &renderer, NULL), HL_OK);
    assert_int_equal(hl_renderer_create(context, &host.other, NULL), HL_OK);
    assert_int_equal(hl_renderer_render(host.other, host.scene, pixels[0], 4 * 24, NULL, NULL), HL_OK);
    host.renderer = renderer;
    assert_int_equal(hl_renderer_render(renderer, host.scene, pixels[1], 4 * 24, NULL, NULL), HL_OK);
    assert_true(host.told > 0);
    assert_memory_equal(pixels[0], pixels[1], sizeof pixels[0]);
    host.renderer = NULL;
    if (!destroys) hl_renderer_destroy(renderer);
    hl_renderer_destroy(host.other);
    hl_scene_release(host.scene);
    assert_int_equal(hl_context_memory_held(context), 0);
    hl_context_destroy(context);
  }
}

/* ---- borrowed voxels ---- */

typedef union lent_voxels {
  uint8_t bytes[4 * VOXELS];
  uint16_t shorts[VOXELS];
  float floats[VOXELS];
} lent_voxels;

static lent_voxels lent;

/* Fills the voxels with a pattern. 0: a ball; 1: all bits; 2: zeros; others: random bits, which as floats are
 * also NaN, infinite and huge numbers. */
static void scribble(hl_voxel_type type, unsigned pattern) {
  for (int n = 0; n < VOXELS; n++) {
    int i = n % SIDE - 6, j = n / SIDE % SIDE - 6, k = n / SIDE / SIDE - 6, away = i * i + j * j + k * k;
    uint32_t any = pattern == 1 ? UINT32_MAX : pattern == 2 ? 0 : 2654435761u * ((unsigned)n + 977 * pattern);
    any ^= any >> 15;
    if (type == HL_VOXEL_U8) lent.bytes[n] = pattern == 0 ? (uint8_t)(away < 20 ? 200 : 20) : (uint8_t)any;
    else if (type == HL_VOXEL_U16)
      lent.shorts[n] = pattern == 0 ? (uint16_t)(away < 20 ? 900 : 70) : (uint16_t)any;
    else if (pattern == 0) lent.floats[n] = away < 20 ? 1.5f : -0.5f;
    else memcpy(&lent.floats[n], &any, sizeof any);
  }
}

static hl_volume *lend(hl_context *context, hl_voxel_type type) {
  hl_volume_description description;
  hl_volume *volume = NULL;
  hl_volume_description_defaults(&description);
  for (int a = 0; a < 3; a++) description.dimensions[a] = SIDE;
  description.type = type;
  description.voxels = &lent;
  description.borrow = 1;
  assert_int_equal(hl_volume_create(context, &description, &volume, NULL), HL_OK);
  return volume;
}

/* Uses the voxels in every way. The results are not known. A call that fails must have a message, and the
 * sanitizers see whether memory is misused. */
static void use_voxels(hl_context *context, hl_volume *volume, hl_renderer *const renderers[4],
                       hl_scene *const scenes[4]) {
  static float pixels[24 * 20 * 4];
  static const double places[] = {0, 50, 100};
  double values[3];
  hl_error error = {0};
  hl_label *labels = NULL;
  size_t count;
  char path[200];
  for (int s = 0; s < 4; s++)
    if (scenes[s] != NULL &&
        hl_renderer_render(renderers[s], scenes[s], pixels, 4 * 24, NULL, &error) != HL_OK)
      assert_true(error.message[0] != 0);
  assert_int_equal(hl_volume_percentiles(volume, places, 3, values, &error), HL_OK);
  if (hl_labels_of_volume(context, volume, NULL, &labels, &count, &error) == HL_OK)
    hl_labels_release(context, labels);
  snprintf(path, sizeof path, "%s/lent.nrrd", folder);
  if (hl_volume_save(context, volume, path, &error) != HL_OK) assert_true(error.message[0] != 0);
  hl_scene *bare = NULL;
  if (hl_scene_for_volume(context, volume, "lent", &bare, &error) == HL_OK) hl_scene_release(bare);
}

/* Makes scenes of the volume: a look of its values; isosurfaces with splatting; hard shadows; a label map, if
 * its values are few and whole. */
static void make_scenes(hl_context *context, hl_volume *volume, hl_scene *scenes[4]) {
  hl_error error = {0};
  hl_volume_info info = {.struct_size = sizeof info};
  hl_scene *bare = NULL;
  hl_isosurface surface;
  hl_label *labels = NULL;
  size_t count = 0;
  if (hl_scene_for_volume_look(context, volume, NULL, "surface", &bare, &error) != HL_OK)
    fail_msg("%s", error.message);
  hl_scene_description description = *hl_scene_describe(bare);
  hl_scene_volume one = description.volumes[0];
  description.width = 24, description.height = 20;
  description.render.threads = 2;
  description.volumes = &one;
  assert_int_equal(hl_scene_create(context, &description, &scenes[0], &error), HL_OK);
  assert_int_equal(hl_volume_get_info(volume, &info), HL_OK);
  hl_isosurface_defaults(&surface);
  surface.value = 0.5 * (info.range[0] + info.range[1]);
  one.iso = &surface, one.iso_count = 1;
  description.render.reconstruction = HL_RECONSTRUCTION_SPLAT;
  assert_int_equal(hl_scene_create(context, &description, &scenes[1], &error), HL_OK);
  one.iso_count = 0;
  description.render.reconstruction = HL_RECONSTRUCTION_AUTO;
  description.render.shadows = HL_SHADOWS_HARD;
  description.render.kernel = HL_KERNEL_INTERPOLATING;
  assert_int_equal(hl_scene_create(context, &description, &scenes[2], &error), HL_OK);
  description.render.kernel = HL_KERNEL_BSPLINE;
  scenes[3] = NULL;
  if (hl_labels_of_volume(context, volume, NULL, &labels, &count, &error) == HL_OK) {
    one.labels = labels, one.label_count = count;
    assert_int_equal(hl_scene_create(context, &description, &scenes[3], &error), HL_OK);
    hl_labels_release(context, labels);
  }
  hl_scene_release(bare);
}

static atomic_bool scribbling;

static void *scribble_on(void *data) {
  for (unsigned pattern = 0; atomic_load(&scribbling); pattern++) scribble(*(hl_voxel_type *)data, pattern);
  return NULL;
}

static void change_voxels(hl_voxel_type type, bool meanwhile) {
  enum { PATTERNS = 5 }; /* each of the four renderers is made anew once */
  hl_context *context = make_context();
  hl_renderer *renderers[4];
  hl_scene *scenes[4];
  pthread_t thread;
  scribble(type, 0);
  hl_volume *volume = lend(context, type);
  make_scenes(context, volume, scenes);
  for (int s = 0; s < 4; s++) assert_int_equal(hl_renderer_create(context, &renderers[s], NULL), HL_OK);
  use_voxels(context, volume, renderers, scenes);
  atomic_store(&scribbling, true);
  if (meanwhile) assert_int_equal(pthread_create(&thread, NULL, scribble_on, &type), 0);
  for (unsigned pattern = 1; pattern < PATTERNS; pattern++) {
    if (!meanwhile) scribble(type, pattern);
    use_voxels(context, volume, renderers, scenes);
    hl_renderer_destroy(renderers[pattern % 4]); /* one renderer is made anew, so that it keeps nothing */
    assert_int_equal(hl_renderer_create(context, &renderers[pattern % 4], NULL), HL_OK);
  }
  atomic_store(&scribbling, false);
  if (meanwhile) pthread_join(thread, NULL);
  for (int s = 0; s < 4; s++) hl_renderer_destroy(renderers[s]), hl_scene_release(scenes[s]);
  hl_volume_release(volume);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void test_voxels_change_between_calls(void **state) {
  (void)state;
  change_voxels(HL_VOXEL_U8, false);
  change_voxels(HL_VOXEL_U16, false);
  change_voxels(HL_VOXEL_F32, false);
}

static void test_voxels_change_meanwhile(void **state) {
  (void)state;
  change_voxels(HL_VOXEL_U8, true);
  change_voxels(HL_VOXEL_U16, true);
  change_voxels(HL_VOXEL_F32, true);
}

/* The statistics of a volume are computed in several passes. The voxels change while the volume is made. */
static void test_voxels_change_while_a_volume_is_made(void **state) {
  (void)state;
  static hl_voxel_type types[] = {HL_VOXEL_U8, HL_VOXEL_U16, HL_VOXEL_F32};
  for (int t = 0; t < 3; t++) {
    hl_context *context = make_context();
    pthread_t thread;
    scribble(types[t], 0);
    atomic_store(&scribbling, true);
    assert_int_equal(pthread_create(&thread, NULL, scribble_on, &types[t]), 0);
    for (int n = 0; n < 200; n++) {
      hl_volume_description description;
      hl_volume *volume = NULL;
      hl_error error = {0};
      hl_volume_description_defaults(&description);
      for (int a = 0; a < 3; a++) description.dimensions[a] = SIDE;
      description.type = types[t];
      description.voxels = &lent;
      description.borrow = 1;
      if (hl_volume_create(context, &description, &volume, &error) == HL_OK) hl_volume_release(volume);
      else assert_true(error.message[0] != 0);
    }
    atomic_store(&scribbling, false);
    pthread_join(thread, NULL);
    hl_context_destroy(context);
  }
}

static int open_folder(void **state) {
  (void)state;
  if (mkdtemp(folder) == NULL) return -1;
  hl_context *context = make_context();
  if (small_files_write(context, folder, NULL) != HL_OK) return -1;
  hl_context_destroy(context);
  make_numbers();
  expected = work();
  return 0;
}

static int close_folder(void **state) {
  (void)state;
  char command[100];
  free(expected.bytes);
  snprintf(command, sizeof command, "rm -rf %s", folder);
  return system(command);
}

/* usage: host [TESTS]: runs the tests whose names match. */
int main(int count, char **arguments) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_locale),
      cmocka_unit_test(test_rounding),
      cmocka_unit_test(test_flushing),
      cmocka_unit_test(test_traps),
      cmocka_unit_test(test_flags),
      cmocka_unit_test(test_umask),
      cmocka_unit_test(test_callbacks),
      cmocka_unit_test(test_voxels_change_between_calls),
      cmocka_unit_test(test_voxels_change_meanwhile),
      cmocka_unit_test(test_voxels_change_while_a_volume_is_made),
  };
  if (count > 1) cmocka_set_test_filter(arguments[1]);
  return cmocka_run_group_tests(tests, open_folder, close_folder);
}
