/* unit/core_confined.c - files below a folder: what opens and what is refused, by openat2() and by
 * components; and contexts that are confined to a folder. */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <halflight/image.h>
#include <halflight/scene.h>
#include <halflight/volume.h>

#include "core/file.h"
#include "platform/beneath.h"
#include "small_volume.h"

static const char header[] = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n";

static void write_text(const char *path, const char *text) {
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  assert_true(fputs(text, file) >= 0);
  assert_int_equal(fclose(file), 0);
}

/* A folder "inside" with files and links, a folder "outside" with a secret, and the process in both. */
static int set_up(void **state) {
  static char folder[] = "/tmp/halflight-confined-XXXXXX";
  char path[PATH_MAX], text[400];
  (void)state;
  if (mkdtemp(folder) == NULL || chdir(folder) != 0) return -1;
  bool made = mkdir("inside", 0700) == 0 && mkdir("inside/sub", 0700) == 0 && mkdir("outside", 0700) == 0;
  write_text("outside/secret.raw", "12345678");
  write_text("inside/file.raw", "abcdefgh");
  write_text("inside/sub/deep.raw", "abcdefgh");
  snprintf(path, sizeof path, "%s/outside/secret.raw", folder);
  made = made && symlink("file.raw", "inside/link.raw") == 0 && symlink("sub", "inside/link") == 0 &&
         symlink("../outside/secret.raw", "inside/out.raw") == 0 &&
         symlink(path, "inside/absolute.raw") == 0 && symlink("../outside", "inside/away") == 0 &&
         symlink("loop", "inside/loop") == 0 && mkfifo("inside/pipe.raw", 0600) == 0;
  snprintf(text, sizeof text, "%sdata file: sub/deep.raw\n", header);
  write_text("inside/good.nhdr", text);
  return made ? 0 : -1;
}

static int tear_down(void **state) {
  (void)state;
  char folder[PATH_MAX], command[PATH_MAX + 20];
  if (getcwd(folder, sizeof folder) == NULL || strncmp(folder, "/tmp/halflight-confined-", 24) != 0)
    return -1;
  snprintf(command, sizeof command, "rm -r '%s'", folder);
  return system(command);
}

static const char *const refused[] = {"../outside/secret.raw",
                                      "..",
                                      "sub/../../outside/secret.raw",
                                      "out.raw",
                                      "away/secret.raw",
                                      "/etc/passwd",
                                      "/",
                                      "/proc/self/environ",
                                      "absolute.raw",
                                      "loop",
                                      "none.raw",
                                      "file.raw/x",
                                      "http://localhost/x",
                                      "//etc/passwd",
                                      "sub/none/../../file.raw"};

typedef int opener(int folder, const char *name, int flags);

static void check_opener(opener *open_beneath, bool follows) {
  int folder = open("inside", O_RDONLY | O_DIRECTORY);
  char byte;
  assert_true(folder >= 0);
  for (size_t n = 0; n < sizeof refused / sizeof *refused; n++) {
    errno = 0;
    if (open_beneath(folder, refused[n], O_RDONLY | O_NONBLOCK) >= 0) fail_msg("%s was opened", refused[n]);
    assert_int_not_equal(errno, 0);
  }
  static const char *const good[] = {"file.raw", "sub/deep.raw",  "./sub//deep.raw",
                                     "link.raw", "link/deep.raw", "sub/../file.raw"};
  for (size_t n = 0; n < sizeof good / sizeof *good; n++) {
    int file = open_beneath(folder, good[n], O_RDONLY);
    if ((file >= 0) != (n < 3 || follows)) fail_msg("%s: %d", good[n], file);
    if (file >= 0) assert_int_equal(read(file, &byte, 1), 1);
    if (file >= 0) assert_int_equal(byte, 'a');
    if (file >= 0) assert_int_equal(fcntl(file, F_GETFD) & FD_CLOEXEC, FD_CLOEXEC);
    if (file >= 0) close(file);
  }
  int itself = open_beneath(folder, "", O_RDONLY | O_DIRECTORY),
      pipe = open_beneath(folder, "pipe.raw", O_RDONLY | O_NONBLOCK);
  assert_true(itself >= 0 && pipe >= 0);
  close(itself);
  close(pipe);
  close(folder);
}

static void test_beneath(void **state) {
  (void)state;
  check_opener(hl_beneath_open, true);
}

static void test_by_components(void **state) {
  (void)state;
  check_opener(hl_beneath_open_by_components, false);
}

static hl_context *confine(hl_context *context, const char *folder) {
  hl_context *confined = NULL;
  assert_int_equal(hl_context_confine(context, folder, &confined, NULL), HL_OK);
  return confined;
}

/* All refusals have the same words, whether there is a file or not. */
static void test_words(void **state) {
  (void)state;
  hl_context *context = make_context(), *confined = confine(context, "inside");
  for (size_t n = 0; n < sizeof refused / sizeof *refused; n++) {
    int file;
    char wanted[200];
    hl_error error = {0};
    snprintf(wanted, sizeof wanted, "%s: no such file below the folder of the file that was opened",
             refused[n]);
    assert_int_equal(hl_file_open(confined, refused[n], &file, &error), HL_ERROR_IO);
    assert_string_equal(error.message, wanted);
    if (strcmp(refused[n], "..") != 0) assert_int_equal(hl_file_kind(confined, refused[n]), 0);
  }
  hl_context_destroy(confined);
  hl_context_destroy(context);
}

/* A header may name files below its folder. */
static void test_data_files(void **state) {
  (void)state;
  static const char *const names[] = {"../outside/secret.raw", "out.raw", "away/secret.raw", "absolute.raw"};
  hl_context *context = make_context(), *confined = confine(context, "inside");
  hl_volume *volume = NULL;
  for (size_t n = 0; n < sizeof names / sizeof *names; n++) {
    char text[400];
    snprintf(text, sizeof text, "%sdata file: %s\n", header, names[n]);
    write_text("inside/hostile.nhdr", text);
    assert_int_equal(hl_volume_load(confined, "hostile.nhdr", &volume, NULL), HL_ERROR_IO);
    assert_int_equal(hl_volume_load(context, "inside/hostile.nhdr", &volume, NULL), HL_OK);
    hl_volume_release(volume);
  }
  assert_int_equal(hl_volume_load(confined, "good.nhdr", &volume, NULL), HL_OK);
  hl_volume_release(volume);
  assert_int_equal(hl_volume_load(confined, "inside/good.nhdr", &volume, NULL), HL_ERROR_IO);
  hl_error error = {0};
  assert_int_equal(hl_volume_load(confined, "pipe.raw", &volume, &error),
                   HL_ERROR_IO); /* the open must not wait for a writer */
  assert_string_equal(error.message, "pipe.raw: is not a regular file");
  hl_context_destroy(confined);
  hl_context_destroy(context);
}

static void test_sealed(void **state) {
  (void)state;
  hl_context *context = make_context(), *sealed = confine(context, NULL), *inner = NULL;
  hl_volume *volume = NULL;
  hl_image *image = NULL;
  assert_int_equal(hl_volume_load(sealed, "inside/good.nhdr", &volume, NULL), HL_ERROR_IO);
  assert_int_equal(hl_volume_load(sealed, "", &volume, NULL), HL_ERROR_IO);
  assert_int_equal(hl_image_read(sealed, "/etc/passwd", &image, NULL), HL_ERROR_IO);
  assert_int_equal(hl_context_confine(sealed, "inside", &inner, NULL), HL_ERROR_IO);
  hl_context_destroy(sealed);
  hl_context_destroy(context);
}

/* A confined context of a confined context stays below both folders. */
static void test_nested(void **state) {
  (void)state;
  hl_context *context = make_context(), *outer = confine(context, "inside"), *inner = NULL;
  hl_volume *volume = NULL;
  static const char *const names[] = {"../outside", "away", "none", "file.raw", "/tmp"};
  for (size_t n = 0; n < sizeof names / sizeof *names; n++)
    assert_int_equal(hl_context_confine(outer, names[n], &inner, NULL), HL_ERROR_IO);
  inner = confine(outer, "sub");
  char text[400];
  snprintf(text, sizeof text, "%sdata file: ../file.raw\n", header);
  write_text("inside/sub/up.nhdr", text);
  assert_int_equal(hl_volume_load(inner, "up.nhdr", &volume, NULL), HL_ERROR_IO);
  assert_int_equal(hl_volume_load(outer, "sub/up.nhdr", &volume, NULL), HL_OK);
  hl_volume_release(volume);
  hl_context_destroy(inner);
  hl_context_destroy(outer);
  hl_context_destroy(context);
}

/* The memory counts for the whole context. Objects may be used after the owner of the confined context has
 * released it. */
static void test_memory(void **state) {
  (void)state;
  hl_context_options options;
  hl_context_options_defaults(&options);
  options.memory_limit = 1 << 20;
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(&options, &context, NULL), HL_OK);
  hl_context *confined = confine(context, "inside");
  hl_volume *volume = NULL;
  hl_scene *scene = NULL;
  hl_image *image = NULL;
  assert_int_equal(hl_image_create(confined, 2048, 2048, &image, NULL), HL_ERROR_MEMORY);
  assert_int_equal(hl_volume_load(confined, "good.nhdr", &volume, NULL), HL_OK);
  assert_true(hl_context_memory_held(context) > 0);
  assert_int_equal(hl_context_memory_held(confined), hl_context_memory_held(context));
  assert_int_equal(hl_scene_for_volume(context, volume, "good.nhdr", &scene, NULL), HL_OK);
  hl_volume_release(volume);
  hl_context_destroy(confined);
  assert_int_equal(hl_scene_describe(scene)->volume_count, 1);
  hl_volume_info info = {.struct_size = sizeof info};
  assert_int_equal(hl_volume_get_info(hl_scene_describe(scene)->volumes[0].volume, &info), HL_OK);
  assert_int_equal(info.dimensions[0], 2);
  hl_scene_release(scene);
  assert_int_equal(hl_context_memory_held(context), 0);
  confined = confine(context, NULL);
  assert_int_equal(hl_context_limit_memory(confined, 0, NULL, NULL), HL_ERROR_ARGUMENT);
  hl_context_destroy(confined);
  hl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_beneath), cmocka_unit_test(test_by_components),
                                     cmocka_unit_test(test_words),   cmocka_unit_test(test_data_files),
                                     cmocka_unit_test(test_sealed),  cmocka_unit_test(test_nested),
                                     cmocka_unit_test(test_memory)};
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
