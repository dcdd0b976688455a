/* cli/render/scenes.c - implements `halflight render 'examples/fig*.json'`: makes a picture of each scene
 * that a pattern finds.
 *
 * Each scene is rendered as if it stood alone on the command line, in the order of the numbers in the names.
 * A scene that fails has no picture; the other pictures are made nevertheless. */
#define _GNU_SOURCE
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/frames.h"
#include "cli/host.h"
#include "cli/input.h"
#include "cli/output.h"
#include "render.h"

bool render_are_scenes(char **operands) {
  const char *pattern = operands[0];
  return operands[1] == NULL && strpbrk(pattern, "*?[") != NULL && access(pattern, F_OK) != 0 &&
         has_extension(pattern, ".json");
}

static int check_options(const cli_value *values) {
  const cli_value *output = &values[RENDER_OUTPUT];
  if (output->given && !output_has_name(output->text))
    return fail(
        EXIT_CODE_USAGE,
        "--output: '%s' is one file, and there may be several scenes: put %%s into its name, for each "
        "scene's own, or name a folder",
        output->text);
  return EXIT_CODE_OK;
}

int render_scenes(const cli_value *values, char **operands, render_one_fn *render_one) {
  int exit_code = check_options(values), failed = 0;
  cli_value *own = malloc(RENDER_OPTION_COUNT * sizeof *own);
  glob_t found = {0};
  if (exit_code == EXIT_CODE_OK && own == NULL) exit_code = fail(EXIT_CODE_FAILURE, "out of memory");
  if (exit_code == EXIT_CODE_OK && glob(operands[0], 0, NULL, &found) != 0)
    exit_code = fail(EXIT_CODE_INPUT, "%s: there is no such file", operands[0]);
  if (found.gl_pathc > 0) qsort(found.gl_pathv, found.gl_pathc, sizeof *found.gl_pathv, compare_by_number);
  for (size_t n = 0; n < found.gl_pathc && exit_code == EXIT_CODE_OK; n++) {
    char *one[] = {found.gl_pathv[n], NULL};
    memcpy(own, values, RENDER_OPTION_COUNT * sizeof *own); /* render_one() replaces %s by the scene's name */
    exit_code = render_one(own, one);
    bool goes_on = exit_code == EXIT_CODE_INPUT || exit_code == EXIT_CODE_UNSUPPORTED;
    failed += goes_on;
    if (goes_on) exit_code = EXIT_CODE_OK;
  }
  if (exit_code == EXIT_CODE_OK && failed > 0)
    exit_code = fail(EXIT_CODE_FAILURE, "%d of %zu scenes have no picture", failed, found.gl_pathc);
  globfree(&found);
  free(own);
  return exit_code;
}
