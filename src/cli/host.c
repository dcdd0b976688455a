/* cli/host.c - implements the callbacks of the context: progress bar, warnings, interruption. */
#define _GNU_SOURCE
#include "host.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fetch/asking.h"
#include "openvdb.h"
#include "platform/memory.h"
#include "platform/paths.h"

/* A flag that the signal handler sets, and that the library's cancel callback reads. */
static volatile sig_atomic_t interrupted = 0;

static void on_signal(int signal_number) {
  (void)signal_number;
  interrupted = 1;
}

bool host_interrupted(void) { return interrupted != 0; }

static int on_cancelled(void *user_data) {
  const cli_host *host = user_data;
  return interrupted != 0 || (host->cancelled != NULL && host->cancelled());
}

void host_clear_bar(cli_host *host) {
  if (!host->drawn) return;
  fputs("\r\033[K", stderr);
  host->drawn = false;
}

void host_draw_bar(cli_host *host, double fraction, const char *text) {
  enum { WIDTH = 32 };
  double now = hl_clock_seconds();
  if (!host->bar || (host->drawn && now - host->drawn_at < 0.1)) return;
  if (!(fraction > 0)) fraction = 0;
  if (fraction > 1) fraction = 1;
  char full[WIDTH + 1], rest[WIDTH + 1];
  int filled = (int)(fraction * WIDTH);
  memset(full, '#', sizeof full);
  memset(rest, '.', sizeof rest);
  fprintf(stderr, "\r\033[K%s%.*s%s%.*s %3d %%  %s", host->color ? "\033[36m" : "", filled, full,
          host->color ? "\033[0m" : "", WIDTH - filled, rest, (int)(100 * fraction), text);
  fflush(stderr);
  host->drawn = true;
  host->drawn_at = now;
}

void host_describe_time(double seconds, char *text, size_t size) {
  long whole = (long)(seconds + 0.5);
  if (whole >= 3600) snprintf(text, size, "%ld h %ld min", whole / 3600, whole % 3600 / 60);
  else if (whole >= 60) snprintf(text, size, "%ld min %ld s", whole / 60, whole % 60);
  else snprintf(text, size, "%ld s", whole);
}

/* Estimates the seconds that the stage of a library call still takes, if it continues at the same speed. */
static double seconds_left(cli_host *host, const char *stage, double fraction, double *past) {
  host_stage *now = &host->stage;
  if (strcmp(now->name, stage) != 0 || fraction < now->fraction) {
    snprintf(now->name, sizeof now->name, "%s", stage);
    now->began = hl_clock_seconds();
  }
  now->fraction = fraction;
  *past = hl_clock_seconds() - now->began;
  return fraction > 0 ? *past * (1 - fraction) / fraction : 0;
}

/* Prints once, after `PATIENCE` seconds, the time that a slow stage still takes, and advice on how to make it
 * faster. If there is a progress bar, it shows this time anew again and again. */
static void tell_of_slowness(cli_host *host, double past, double left) {
  enum { PATIENCE = 10, LONG = 60 };
  char text[40];
  if (host->stage.hint == NULL || host->quiet || past < PATIENCE || left < LONG) return;
  host_describe_time(left, text, sizeof text);
  host_clear_bar(host);
  say("%s: about %s left: %s", host->subject, text, host->stage.hint);
  host->stage.hint = NULL;
}

static void on_progress(void *user_data, const char *stage, double fraction) {
  enum { SHORT = 3 }; /* the number of seconds for which nobody needs an estimate */
  cli_host *host = user_data;
  char text[80], time[40];
  double past, left = seconds_left(host, stage, fraction, &past);
  tell_of_slowness(host, past, left);
  host_describe_time(left, time, sizeof time);
  snprintf(text, sizeof text, "%s %s%s%s%s", stage, host->subject, past > SHORT ? ", " : "",
           past > SHORT ? time : "", past > SHORT ? " left" : "");
  if (host->progressed != NULL) host->progressed(stage, fraction);
  if (!host->own_bar) host_draw_bar(host, fraction, text);
}

static void on_log(void *user_data, hl_log_level level, const char *message) {
  cli_host *host = user_data;
  if (level == HL_LOG_WARNING && host->warned != NULL) host->warned(message);
  if (host->quiet || strcmp(host->said, message) == 0) return;
  snprintf(host->said, sizeof host->said, "%s", message);
  host_clear_bar(host);
  if (level == HL_LOG_WARNING) warn("%s", message);
  else say("%s", message);
}

static void on_reads(void *user_data, const char *path) {
  read_files_add(&((cli_host *)user_data)->read, path);
}

static hl_status on_convert(void *user_data, const char *format, const char *path, const void **bytes,
                            size_t *byte_count, hl_error *error) {
  const cli_host *host = user_data;
  if (strcmp(format, "OpenVDB") != 0) return HL_ERROR_UNSUPPORTED;
  return openvdb_convert(path, host->memory_limit, on_cancelled, user_data, bytes, byte_count, error);
}

/* Fetches files of a store that the command line names. */
static hl_status on_fetch(void *user_data, const char *url, const char *const *names,
                          const hl_fetch_range *ranges, size_t count, uint64_t most, hl_fetched_file *files,
                          hl_error *error) {
  const cli_host *host = user_data;
  fetch_permission permission = {.instead = "INPUTs of the command line alone: give it there",
                                 .cancelled = on_cancelled,
                                 .user_data = user_data};
  for (char *const *operand = host->operands; operand != NULL && *operand != NULL; operand++)
    permission.named = permission.named || strcmp(*operand, url) == 0;
  return fetch_if_named(&permission, url, names, ranges, count, most, files, error);
}

static void on_converted(void *user_data, const void *bytes, size_t byte_count) {
  (void)user_data;
  openvdb_release(bytes, byte_count);
}

static bool terminal_can_redraw(void) {
  const char *terminal = getenv("TERM");
  return isatty(STDERR_FILENO) && terminal != NULL && strcmp(terminal, "dumb") != 0;
}

static bool color_wanted(void) {
  const char *no_color = getenv("NO_COLOR");
  return no_color == NULL || no_color[0] == '\0';
}

static void listen_to_signals(void) {
  struct sigaction action, before;
  memset(&action, 0, sizeof action);
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART; /* SA_RESTART lets interrupted system calls continue; the cancel callback ends
                                 * the work */
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, NULL);
  sigaction(SIGTERM, &action, NULL);
  /* nohup makes a program ignore SIGHUP */
  if (sigaction(SIGHUP, NULL, &before) == 0 && before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, NULL);
}

/* The folder of the files that scenes call "data:...". */
static const char *choose_data_folder(const char *asked) {
  const char *named = getenv("HALFLIGHT_DATA");
  return asked != NULL ? asked : named != NULL && named[0] != '\0' ? named : "../shared/data";
}

/* The folder of scratch files. */
static const char *choose_scratch_folder(void) {
  const char *named = getenv("TMPDIR");
  return named != NULL && named[0] != '\0' ? named : hl_temporary_folder();
}

int host_open(const cli_host_options *options, cli_host *host) {
  memset(host, 0, sizeof *host);
  host->quiet = options->quiet;
  host->cancelled = options->cancelled;
  /* The default limit is the machine's memory. A run that needs more fails with a message instead of being
   * killed by the system. */
  host->memory_limit = options->memory_limit > 0 ? options->memory_limit : hl_machine_memory();
  host->progressed = options->progressed;
  host->warned = options->warned;
  host->bar = options->progress && !options->quiet && terminal_can_redraw();
  host->color = color_wanted();
  snprintf(host->subject, sizeof host->subject, "%s", options->subject);
  for (char *c = host->subject; *c != '\0'; c++)
    if ((unsigned char)*c < 0x20 || *c == 0x7f) *c = '?';
  listen_to_signals();
  hl_context_options context_options;
  hl_context_options_defaults(&context_options);
  context_options.user_data = host;
  context_options.log = on_log;
  context_options.progress = on_progress;
  context_options.cancelled = on_cancelled;
  context_options.reads = on_reads;
  context_options.fetch = on_fetch;
  context_options.convert = on_convert;
  context_options.converted = on_converted;
  context_options.memory_limit = host->memory_limit;
  context_options.instruction_set = options->instruction_set;
  context_options.mpi = options->mpi;
  context_options.keep_unsmoothed = options->keep_unsmoothed;
  context_options.scratch_folder = choose_scratch_folder();
  context_options.data_folder = choose_data_folder(options->data_folder);
  char cache_folder[1024];
  fetch_choose_cache_folder(cache_folder, sizeof cache_folder);
  host->operands = options->operands;
  context_options.device = options->device;
  context_options.cache_folder = cache_folder[0] != '\0' ? cache_folder : NULL;
  hl_error error = {0};
  hl_status status = hl_context_create(&context_options, &host->context, &error);
  return status == HL_OK ? EXIT_CODE_OK : fail_with(PHASE_SETUP, status, &error);
}

void host_close(cli_host *host) {
  host_clear_bar(host);
  hl_context_destroy(host->context);
  host->context = NULL;
  read_files_release(&host->read);
}

int host_fail(cli_host *host, cli_phase phase, hl_status status, const hl_error *error) {
  host_clear_bar(host);
  return fail_with(phase, status, error);
}
