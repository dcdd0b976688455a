/* cli/message.c - prints messages on stderr. Each message is one line, for file names of any content. */
#include "message.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void print_line(const char *prefix, const char *format, va_list arguments) {
  char line[2000];
  vsnprintf(line, sizeof line, format, arguments);
  for (char *c = line; *c != '\0'; c++)
    if ((unsigned char)*c < 0x20 || *c == 0x7f) *c = '?';
  fprintf(stderr, "%s%s\n", prefix, line);
}

int fail(int exit_code, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  print_line("halflight: ", format, arguments);
  va_end(arguments);
  return exit_code;
}

void warn(const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  print_line("halflight: warning: ", format, arguments);
  va_end(arguments);
}

void say(const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  print_line("", format, arguments);
  va_end(arguments);
}

static int exit_code_of(cli_phase phase, hl_status status) {
  switch (status) {
    case HL_OK: return EXIT_CODE_OK;
    case HL_ERROR_UNSUPPORTED: return EXIT_CODE_UNSUPPORTED;
    case HL_ERROR_CANCELLED: return EXIT_CODE_INTERRUPTED;
    case HL_ERROR_ARGUMENT:
    case HL_ERROR_INPUT:
      if (phase == PHASE_READ) return EXIT_CODE_INPUT;
      return phase == PHASE_RUN ? EXIT_CODE_FAILURE : EXIT_CODE_USAGE;
    case HL_ERROR_IO: return phase == PHASE_READ ? EXIT_CODE_INPUT : EXIT_CODE_FAILURE;
    case HL_ERROR_MEMORY:
    case HL_ERROR_INTERNAL: break;
  }
  return EXIT_CODE_FAILURE;
}

int fail_with(cli_phase phase, hl_status status, const hl_error *error) {
  int exit_code = exit_code_of(phase, status);
  if (exit_code == EXIT_CODE_INTERRUPTED) return fail(exit_code, "interrupted; nothing was written");
  return fail(exit_code, "%s", error->message[0] != '\0' ? error->message : hl_status_name(status));
}

int finish_stdout(void) {
  if (fflush(stdout) == 0 && !ferror(stdout)) return EXIT_CODE_OK;
  return fail(EXIT_CODE_FAILURE, "standard output: %s: its reader or disk must take the whole output",
              strerror(errno));
}
