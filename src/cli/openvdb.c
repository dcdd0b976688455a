/* cli/openvdb.c - runs a converter in a temporary folder, and reads the converter's file into memory. The
 * converter is openvdb_helper.cpp, or else Debian's nanovdb_convert.
 *
 * The converter gets the input as a link in this folder, so that it sees only names that this file
 * chooses. */
#define _GNU_SOURCE
#include "openvdb.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "platform/program.h"
#include "process/process.h"

typedef struct workplace {
  char folder[PATH_MAX / 2], input[PATH_MAX], output[PATH_MAX], converter[PATH_MAX];
} workplace;

static hl_status fail_io(hl_error *error, const char *what) {
  snprintf(error->message, sizeof error->message, "the converter of OpenVDB: %.900s", what);
  return HL_ERROR_IO;
}

/* Finds the converter: the program that HALFLIGHT_OPENVDB names, else halflight-openvdb beside this
 * program, else nanovdb_convert in the PATH. */
static void find_converter(char path[PATH_MAX]) {
  static const char name[] = "halflight-openvdb";
  const char *named = getenv("HALFLIGHT_OPENVDB");
  if (named != NULL && named[0] != '\0') {
    snprintf(path, PATH_MAX, "%s", named);
    return;
  }
  char *slash = hl_program_path(path, PATH_MAX - sizeof name) ? strrchr(path, '/') : NULL;
  if (slash != NULL) {
    memcpy(slash + 1, name, sizeof name);
    if (access(path, X_OK) == 0) return;
  }
  snprintf(path, PATH_MAX, "nanovdb_convert");
}

bool openvdb_is_there(void) {
  char path[PATH_MAX];
  find_converter(path);
  return strchr(path, '/') != NULL ? access(path, X_OK) == 0 : process_is_there(path);
}

static hl_status make_workplace(const char *path, workplace *w, hl_error *error) {
  const char *temporary = getenv("TMPDIR");
  if (temporary == NULL || temporary[0] == '\0') temporary = "/tmp";
  char whole[PATH_MAX];
  int length = snprintf(w->folder, sizeof w->folder, "%s/halflight-XXXXXX", temporary);
  if (length >= (int)sizeof w->folder || mkdtemp(w->folder) == NULL) {
    w->folder[0] = '\0';
    return fail_io(error, "no folder for temporary files: set TMPDIR");
  }
  snprintf(w->input, sizeof w->input, "%s/in.vdb", w->folder);
  snprintf(w->output, sizeof w->output, "%s/out.nvdb", w->folder);
  if (realpath(path, whole) == NULL || symlink(whole, w->input) != 0) return fail_io(error, strerror(errno));
  return HL_OK;
}

static void remove_workplace(const workplace *w) {
  if (w->folder[0] == '\0') return;
  unlink(w->input);
  unlink(w->output);
  rmdir(w->folder);
}

/* Waits until the process ends, or until the user asks to stop. */
static hl_status await(process *p, int (*cancelled)(void *), void *user_data, hl_error *error) {
  const struct timespec pause = {.tv_nsec = 5000000};
  char said[400];
  bool succeeded;
  while (!process_has_ended(p, &succeeded)) {
    if (cancelled(user_data)) return HL_ERROR_CANCELLED;
    nanosleep(&pause, NULL);
  }
  if (succeeded) return HL_OK;
  process_said(p, "it", said, sizeof said);
  fail_io(error, said);
  return HL_ERROR_INPUT;
}

static hl_status run(const workplace *w, uint64_t limit, int (*cancelled)(void *), void *user_data,
                     hl_error *error) {
  const char *const words[] = {w->converter, w->input, w->output, NULL};
  process converter;
  int problem = process_start(&converter, words, -1);
  hl_status status = problem == 0        ? HL_OK
                     : problem == ENOENT ? HL_ERROR_UNSUPPORTED
                                         : fail_io(error, strerror(problem));
  if (limit > 0) process_limit(&converter, limit, limit);
  if (status == HL_OK) status = await(&converter, cancelled, user_data, error);
  process_end(&converter);
  return status;
}

static hl_status map(const char *path, const void **bytes, size_t *byte_count, hl_error *error) {
  struct stat about;
  int file = open(path, O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  void *memory = MAP_FAILED;
  if (file >= 0 && fstat(file, &about) == 0 && about.st_size > 0)
    memory = mmap(NULL, (size_t)about.st_size, PROT_READ, MAP_PRIVATE, file, 0);
  if (file >= 0) close(file);
  if (memory == MAP_FAILED) return fail_io(error, "it wrote nothing");
  *bytes = memory;
  *byte_count = (size_t)about.st_size;
  return HL_OK;
}

hl_status openvdb_convert(const char *path, uint64_t limit, int (*cancelled)(void *user_data),
                          void *user_data, const void **bytes, size_t *byte_count, hl_error *error) {
  workplace w;
  find_converter(w.converter);
  hl_status status = make_workplace(path, &w, error);
  if (status == HL_OK) status = run(&w, limit, cancelled, user_data, error);
  if (status == HL_OK) status = map(w.output, bytes, byte_count, error);
  remove_workplace(&w);
  return status;
}

void openvdb_release(const void *bytes, size_t byte_count) { munmap((void *)bytes, byte_count); }
