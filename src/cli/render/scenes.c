/* cli/render/scenes.c - `halflight render 'examples/fig*.json'`: makes a picture of each scene that a pattern
 * finds.
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

enum { PATH_BYTES = 4096 };

bool render_are_scenes(char **operands) {
  const char *pattern = operands[0];
  return operands[1] == NULL && strpbrk(pattern, "*?[") != NULL && access(pattern, F_OK) != 0 &&
         has_extension(pattern, ".json");
}

/* Writes the picture's name: -o 'folder/%s.png' with the scene's name in place of %s. */
static int name_picture(const char *output, const char *scene, char path[PATH_BYTES]) {
  const char *slash = strrchr(scene, '/'), *name = slash != NULL ? slash + 1 : scene,
             *mark = strstr(output, "%s");
  int stem = (int)(strlen(name) - strlen(".json"));
  int length = snprintf(path, PATH_BYTES, "%.*s%.*s%s", (int)(mark - output), output, stem, name, mark + 2);
  return length < PATH_BYTES ? EXIT_CODE_OK
                             : fail(EXIT_CODE_USAGE, "%s: the picture's name is too long", scene);
}

static int check_options(const cli_value *values) {
  const cli_value *output = &values[RENDER_OUTPUT];
  if (output->given && strstr(output->text, "%s") == NULL)
    return fail(
        EXIT_CODE_USAGE,
        "--output: '%s' is one file, and there may be several scenes: put %%s into its name, for each "
        "scene's own",
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
    char path[PATH_BYTES], *one[] = {found.gl_pathv[n], NULL};
    memcpy(own, values, RENDER_OPTION_COUNT * sizeof *own);
    if (values[RENDER_OUTPUT].given) {
      exit_code = name_picture(values[RENDER_OUTPUT].text, one[0], path);
      own[RENDER_OUTPUT].text = path;
    }
    if (exit_code == EXIT_CODE_OK) exit_code = render_one(own, one);
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
