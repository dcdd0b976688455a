/* cli/export.c - implements `halflight export SCENE.json -o PAGE.html`, which writes a scene with its data as
 * one page for browsers. */
#define _GNU_SOURCE
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "commands.h"
#include "host.h"
#include "input.h"
#include "output.h"

enum {
  EXPORT_OUTPUT,
  EXPORT_TITLE,
  EXPORT_PAGE,
  EXPORT_DATA,
  EXPORT_MAX_MEMORY,
  EXPORT_QUIET,
  EXPORT_OPTION_COUNT
};

static const cli_option export_options[EXPORT_OPTION_COUNT] = {
    [EXPORT_OUTPUT] = {.name = "output",
                       .letter = 'o',
                       .kind = OPTION_TEXT,
                       .argument = "PAGE",
                       .group = "Options",
                       .help = "file to write, .html (default: INPUT's name with\n.html, in this folder)"},
    [EXPORT_TITLE] = {.name = "title",
                      .kind = OPTION_TEXT,
                      .argument = "TEXT",
                      .help = "what the page is called (default: INPUT's name)"},
    [EXPORT_PAGE] = {.name = "page",
                     .kind = OPTION_TEXT,
                     .argument = "FILE",
                     .help = "the viewer's page without a scene, halflight.html of\nscripts/web (default: "
                             "$HALFLIGHT_PAGE, or the\ninstalled one)"},
    [EXPORT_DATA] = HOST_OPTION_DATA("How it runs"),
    [EXPORT_MAX_MEMORY] = HOST_OPTION_MAX_MEMORY(NULL),
    [EXPORT_QUIET] = HOST_OPTION_QUIET,
};

static const char *const page_extensions[] = {".html", NULL};

/* The path of the page without a scene that is installed with the program: in share/halflight beside bin, in
 * the Python package, or beside the program, as on Windows. */
static const char *const installed_pages[] = {"/../share/halflight/halflight.html", "/../page/halflight.html",
                                              "/halflight.html", NULL};

/* The page without a scene; null if it is not installed. */
static const char *viewer_page(const cli_value *values, char path[PATH_MAX]) {
  if (values[EXPORT_PAGE].given) return values[EXPORT_PAGE].text;
  const char *named = getenv("HALFLIGHT_PAGE");
  if (named != NULL && *named != '\0') return named;
  return find_installed(installed_pages, path) ? path : NULL;
}

/* The input's name without its ending; owned by the caller (free). */
static char *title_of(const cli_value *title, const char *input) {
  char *text = strdup(title->given ? title->text : base_name(input));
  char *dot = text != NULL && !title->given ? strchr(text + 1, '.') : NULL;
  if (dot != NULL) *dot = '\0';
  return text;
}

typedef struct export_job {
  cli_host host;
  const cli_value *values;
  const char *input, *page;
  char *output, *title; /* owned */
} export_job;

static int export_scene(export_job *job) {
  double started = hl_clock_seconds();
  cli_input input = {0};
  hl_scene *scene = NULL;
  hl_error error = {0};
  int exit_code = input_open(job->input, job->values[EXPORT_MAX_MEMORY].bytes, &input);
  if (exit_code == EXIT_CODE_OK) {
    hl_status status = input_load(job->host.context, &input, NULL, &scene, &error);
    if (status != HL_OK) exit_code = host_fail(&job->host, PHASE_READ, status, &error);
  }
  if (exit_code == EXIT_CODE_OK) exit_code = read_files_protect(&job->host.read, job->output, job->input);
  if (exit_code == EXIT_CODE_OK) {
    hl_status status = hl_scene_write_page(job->host.context, scene, job->page, job->title, job->output,
                                           &error);
    host_clear_bar(&job->host);
    struct stat written;
    if (status != HL_OK) {
      cli_phase phase = status == HL_ERROR_INPUT ? PHASE_READ : PHASE_RUN;
      exit_code = host_fail(&job->host, phase, status, &error);
    } else if (!job->host.quiet && stat(job->output, &written) == 0)
      say("%s: %.1f MB in %.1f s", job->output, (double)written.st_size / 1e6, hl_clock_seconds() - started);
  }
  hl_scene_release(scene);
  input_close(&input);
  return exit_code;
}

static int run_export(const cli_value *values, char **operands) {
  char place[PATH_MAX];
  export_job job = {.values = values, .input = operands[0], .page = viewer_page(values, place)};
  if (job.page == NULL)
    return fail(
        EXIT_CODE_INPUT,
        "the viewer's page is not installed: scripts/web in Halflight's sources makes it, and "
        "`meson setup --reconfigure build` and `meson install -C build` install it; or name it by --page, "
        "as --page build-web/halflight.html");
  const cli_value *output = &values[EXPORT_OUTPUT];
  job.output = output->given ? strdup(output->text) : output_default_name(operands[0], ".html");
  job.title = title_of(&values[EXPORT_TITLE], operands[0]);
  int exit_code = job.output == NULL || job.title == NULL
                      ? fail(EXIT_CODE_FAILURE, "out of memory")
                      : output_check(job.output, page_extensions, operands, 1);
  cli_host_options host_options = {.quiet = values[EXPORT_QUIET].given,
                                   .progress = true,
                                   .subject = base_name(operands[0]),
                                   .memory_limit = values[EXPORT_MAX_MEMORY].bytes,
                                   .data_folder = values[EXPORT_DATA].text,
                                   .operands = operands};
  if (exit_code == EXIT_CODE_OK) {
    exit_code = host_open(&host_options, &job.host);
    if (exit_code == EXIT_CODE_OK) exit_code = export_scene(&job);
    host_close(&job.host);
  }
  free(job.output);
  free(job.title);
  return exit_code;
}

const cli_command export_command = {
    .name = "export",
    .operands = "INPUT",
    .operand_count = 1,
    .summary = "a scene with its data as one page for browsers",
    .description =
        "Writes INPUT, a scene, a picture that carries one, or a volume, into one HTML file that browsers "
        "open\n"
        "from a disk, with camera and light alive. Volumes are cut to the box that shows anything, and lie "
        "in\n"
        "8 bits where these hold all values.",
    .options = export_options,
    .option_count = EXPORT_OPTION_COUNT,
    .run = run_export,
};
