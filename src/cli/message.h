/* cli/message.h - defines the exit codes, and prints the line on stderr that comes with every exit code
 * except success. */
#ifndef HL_CLI_MESSAGE_H
#define HL_CLI_MESSAGE_H

#include <halflight/halflight.h>

enum {
  EXIT_CODE_OK = 0,
  EXIT_CODE_FAILURE = 1, /* the run failed after it had begun, or a limit of `diff` was exceeded */
  EXIT_CODE_USAGE = 2,
  EXIT_CODE_INPUT = 3, /* a given file is missing or malformed */
  /* the input was understood, but this version or this machine has no support for it */
  EXIT_CODE_UNSUPPORTED = 4,
  EXIT_CODE_INTERRUPTED = 130
};

/* Prints "halflight: ..." on stderr, control characters replaced, and returns exit_code. */
__attribute__((format(printf, 2, 3))) int fail(int exit_code, const char *format, ...);

/* Prints "halflight: warning: ..." on stderr, control characters replaced. */
__attribute__((format(printf, 1, 2))) void warn(const char *format, ...);

/* Prints a line on stderr, control characters replaced. */
__attribute__((format(printf, 1, 2))) void say(const char *format, ...);

/* The phase in which a library call failed. The phase decides whether the user's options, a file or the
 * system caused the failure, and so decides the exit code. */
typedef enum cli_phase {
  PHASE_SETUP,  /* the library is being set up; only the user's options can be the cause */
  PHASE_READ,   /* reading a file that the user named */
  PHASE_CHANGE, /* options are applied to a scene that has no faults */
  PHASE_RUN     /* rendering, writing */
} cli_phase;

/* Prints the library's message and returns the exit code of the status in this phase. */
int fail_with(cli_phase phase, hl_status status, const hl_error *error);

/* Flushes stdout and prints an error if its disk is full or its pipe closed. Returns the exit code. */
int finish_stdout(void);

#endif
