/* tests/fuzz/words.c - fuzz target: the command line. The first byte chooses a command, the rest is its
 * words, one a line. A run is not begun: options are read, and the checks are made that come before any file
 * is opened. */
#include <stdio.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/message.h"
#include "cli/render/render.h"
#include "target.h"

const uint64_t fuzz_memory_limit = 1 << 20;

enum { MOST_WORDS = 64, MOST_TEXT = 4096 };

static const cli_command *const commands[] = {&render_command,  &info_command,    &make_command,
                                              &convert_command, &diff_command,    &bench_command,
                                              &view_command,    &animate_command, &looks_command};

/* The program's messages are discarded. The descriptor of stderr stays, since sanitizers report by it. */
static void be_silent(void) {
  static bool silent;
  if (silent) return;
  FILE *nowhere = fopen("/dev/null", "w");
  REQUIRE(nowhere != NULL);
  stderr = nowhere;
  silent = true;
}

static int words_of(char *text, char *words[MOST_WORDS]) {
  int count = 0;
  for (char *at = text; at != NULL && count < MOST_WORDS; count++) {
    words[count] = at;
    at = strchr(at, '\n');
    if (at != NULL) *at++ = 0;
  }
  return count;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  char text[MOST_TEXT + 1], *words[MOST_WORDS];
  cli_value values[MAXIMUM_OPTIONS] = {0};
  char *operands[MAXIMUM_OPERANDS + 1] = {0};
  bool help;
  if (size == 0 || size > MOST_TEXT) return 0;
  be_silent();
  memcpy(text, data + 1, size - 1);
  text[size - 1] = 0;
  const cli_command *command = commands[data[0] % (sizeof commands / sizeof *commands)];
  int exit_code = options_parse(command, words_of(text, words), words, values, operands, &help);
  REQUIRE(exit_code == EXIT_CODE_OK || exit_code == EXIT_CODE_USAGE || exit_code == EXIT_CODE_UNSUPPORTED);
  if (exit_code != EXIT_CODE_OK || help || command != &render_command) return 0;
  exit_code = render_check_options(values);
  REQUIRE(exit_code == EXIT_CODE_OK || exit_code == EXIT_CODE_USAGE || exit_code == EXIT_CODE_UNSUPPORTED);
  return 0;
}
