/* python/native.c - implements the callbacks of the Python package's context. They call Python only if they
 * must (python/native.h). */
#include <stdbool.h>
#include <string.h>
#include <time.h>

#include <halflight/halflight.h>

#include "fetch/asking.h"
#include "native.h"
#include "text/color.h"

/* Python functions that cffi defines (halflight/_library.py). */
static int python_wants_stop(void);
static int python_progress(const char *stage, double fraction);
static void python_log(int level, const char *message);
static void python_array_released(uintptr_t key);
static hl_status python_convert(const char *path, const void **bytes, size_t *byte_count, hl_error *error);
static void python_converted(const void *bytes);

/* The time between two calls of Python. It is so short that a person notices no delay after Ctrl-C. */
static const double SECONDS_BETWEEN_QUESTIONS = 0.05;

/* The call of the library that the current thread is making. */
typedef struct native_call {
  double asked, told; /* the times, in seconds, at which Python was last asked whether to stop, and at which
                       * it was last told the progress */
  int listening, stopped;
  const char *const *urls; /* the URLs of the stores whose files the call may fetch from a server; null if
                            * there is none */
} native_call;
static _Thread_local native_call call;

static double now(void) {
  struct timespec time;
  clock_gettime(CLOCK_MONOTONIC, &time);
  return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

int python_color(const char *text, double color[3]) {
  const bool is_number = strchr("+-.0123456789 ", text[0]) != NULL; /* the end of an empty text, too */
  return !is_number && hl_parse_color(text, 0, 1, color);
}

void python_call_begin(int listening) { call = (native_call){.asked = now(), .listening = listening}; }

void python_call_end(void) { call = (native_call){.asked = now()}; }

void python_call_may_ask(const char *const *urls) { call.urls = urls; }

/* Returns whether the call may ask for the store at a URL. */
static bool may_ask(const char *url) {
  for (const char *const *one = call.urls; one != NULL && *one != NULL; one++)
    if (strcmp(*one, url) == 0) return true;
  return false;
}

static int on_cancelled(void *user_data) {
  (void)user_data;
  double time = now();
  if (call.stopped || time - call.asked < SECONDS_BETWEEN_QUESTIONS) return call.stopped;
  call.asked = time;
  call.stopped = python_wants_stop();
  return call.stopped;
}

static void on_progress(void *user_data, const char *stage, double fraction) {
  (void)user_data;
  double time = now();
  if (!call.listening || call.stopped || (fraction < 1 && time - call.told < SECONDS_BETWEEN_QUESTIONS))
    return;
  call.told = time;
  call.stopped = python_progress(stage, fraction);
}

static void on_log(void *user_data, hl_log_level level, const char *message) {
  (void)user_data;
  python_log((int)level, message);
}

static hl_status on_convert(void *user_data, const char *format, const char *path, const void **bytes,
                            size_t *byte_count, hl_error *error) {
  (void)user_data;
  if (strcmp(format, "OpenVDB") != 0) return HL_ERROR_UNSUPPORTED;
  return python_convert(path, bytes, byte_count, error);
}

static void on_converted(void *user_data, const void *bytes, size_t byte_count) {
  (void)user_data, (void)byte_count;
  python_converted(bytes);
}

/* Fetches files of the store that the Python caller has named. */
static hl_status on_fetch(void *user_data, const char *url, const char *const *names,
                          const hl_fetch_range *ranges, size_t count, uint64_t most, hl_fetched_file *files,
                          hl_error *error) {
  const fetch_permission permission = {.named = may_ask(url),
                                       .instead = "stores that a program names: give it to Volume()",
                                       .cancelled = on_cancelled,
                                       .user_data = user_data};
  return fetch_if_named(&permission, url, names, ranges, count, most, files, error);
}

hl_status python_context_create(hl_context **context, hl_error *error) {
  hl_context_options options;
  hl_context_options_defaults(&options);
  options.cancelled = on_cancelled;
  options.progress = on_progress;
  options.log = on_log;
  options.fetch = on_fetch;
  options.convert = on_convert;
  options.converted = on_converted;
  return hl_context_create(&options, context, error);
}

static void on_released(void *user_data, const void *voxels) {
  (void)voxels;
  python_array_released((uintptr_t)user_data);
}

void python_lend(hl_volume_description *description, uintptr_t key) {
  description->borrow = 1;
  description->release = on_released;
  description->release_data = (void *)key;
}
