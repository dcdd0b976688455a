/* cli/figures.c - implements `halflight figures`, which makes the figures of Zhang and Crawfis's paper from
 * the scenes that are installed with the program. */
#define _GNU_SOURCE
#include <glob.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cli/render/render.h"
#include "commands.h"
#include "input.h"
#include "message.h"
#include "output.h"

/* The folders of the installed scenes, relative to the program's folder: for an installed program, and for a
 * program in a build folder. */
static const char *const places[] = {"/../share/halflight/examples", "/../../../examples", NULL};

/* The options of render that suit pictures of many scenes. */
static bool has_render_option(size_t row) {
  return row == RENDER_OUTPUT || row == RENDER_SIZE || row == RENDER_DATA || row == RENDER_THREADS ||
         row == RENDER_DEVICE || row == RENDER_MAX_MEMORY || row == RENDER_QUIET;
}

enum figures_option { FIGURES_LIST, FIGURES_OPTION_COUNT };

static const cli_option figures_options[FIGURES_OPTION_COUNT] = {
    [FIGURES_LIST] = {.name = "list",
                      .kind = OPTION_SWITCH,
                      .group = "Options",
                      .help = "the figures' names, and no pictures"},
};

/* Prints the names of the scenes of a pattern. Returns the exit code. */
static int list_names(const glob_t *found) {
  for (size_t n = 0; n < found->gl_pathc; n++) {
    const char *name = base_name(found->gl_pathv[n]);
    printf("%.*s\n", (int)(strlen(name) - strlen(".json")), name);
  }
  return finish_stdout();
}

static int run_figures(const cli_value *values, char **operands) {
  enum { NAME_BYTES = 100 };
  char pattern[PATH_MAX + NAME_BYTES];
  if (!find_installed(places, pattern))
    return fail(EXIT_CODE_INPUT,
                "the scenes of the figures are not installed beside the program: halflight render "
                "'FOLDER/fig*.json' makes the pictures of scenes in a folder");
  const size_t length = strlen(pattern);
  const char *only = operands[0] != NULL ? operands[0] : "";
  if (strlen(only) >= NAME_BYTES - sizeof "/fig**.json" || strchr(only, '/') != NULL)
    return fail(EXIT_CODE_USAGE, "'%.80s' is no part of a figure's name", only);
  /* All names begin with "fig". The text may begin with "fig", too. */
  const bool begins = strncmp(only, "fig", 3) == 0;
  snprintf(pattern + length, NAME_BYTES, begins ? "/%s*.json" : "/fig*%s*.json", only);
  glob_t found = {0};
  int exit_code = glob(pattern, 0, NULL, &found) != 0
                      ? fail(EXIT_CODE_INPUT,
                             "no figure's name contains '%s': 'halflight figures --list' lists them", only)
                  : values[FIGURES_LIST].given
                      ? list_names(&found)
                      : render_command.run(values + FIGURES_OPTION_COUNT, (char *[]){pattern, NULL});
  globfree(&found);
  return exit_code;
}

const cli_command figures_command = {
    .name = "figures",
    .operands = "[TEXT]",
    .operand_most = 1,
    .summary = "the figures of the paper, from the scenes that come with this",
    .description =
        "Makes a picture of each figure of the paper (Zhang and Crawfis 2003), or of those whose names\n"
        "contain TEXT, as 12 or rings. For data that are not found, a scene shows\n"
        "shapes that stand in for them.",
    .options = figures_options,
    .option_count = FIGURES_OPTION_COUNT,
    .shared = render_options,
    .shared_count = RENDER_OPTION_COUNT,
    .has_shared = has_render_option,
    .run = run_figures,
};
