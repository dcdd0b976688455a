/* cli/view/view.c - implements `halflight view INPUT`, which runs the viewer's server and opens its page in a
 * browser. */
#define _GNU_SOURCE
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/commands.h"
#include "cli/input.h"
#include "cli/output.h"
#include "cli/render/render.h"
#ifdef HL_HAS_VIEWER
#include <dlfcn.h>

#include "browser.h"
#include "files.h"
#include "server/module.h"
#include "token.h"
#endif

enum { VIEW_PORT, VIEW_NO_BROWSER, VIEW_OPTION_COUNT };

static const cli_option view_options[VIEW_OPTION_COUNT] = {
    [VIEW_PORT] = {.name = "port",
                   .kind = OPTION_NUMBERS,
                   .argument = "N",
                   .group = "Page",
                   .help = "serve the page at this port of 127.0.0.1 (default: a\nfree one)",
                   .count = 1,
                   .whole = true,
                   .low = 1,
                   .high = 65535},
    [VIEW_NO_BROWSER] =
        {.name = "no-browser",
         .kind = OPTION_SWITCH,
         .help = "print the URL, and open no browser (default: one is\nopened where there is a screen)"},
};

/* Returns whether this command has an option of `render`. It has all options of the content and the look of
 * pictures, except the options that the page sets itself. */
static bool has_render_option(size_t row) {
  switch ((enum render_option)row) {
    case RENDER_SIZE:
    case RENDER_NO_METADATA:
    case RENDER_SCALE_BAR:
    case RENDER_LEGEND:
    case RENDER_AXES:
    case RENDER_MARKS:
    case RENDER_ANNOTATE:
    case RENDER_PLACE:
    case RENDER_FONT_SIZE:
    case RENDER_RANGE_OF_ALL:
    case RENDER_PART:
    case RENDER_RANKS: return false;
    default: return !render_is_of_picture((enum render_option)row);
  }
}

#ifdef HL_HAS_VIEWER

/* One run. */
typedef struct view_job {
  cli_host host;
  const cli_value *values, *render; /* values of the command's own options, and of the options of `render` */
  hl_scene *scene;                  /* owned */
  browser_page page;
} view_job;

/* ---- the scene ---- */

static int load(view_job *job, char **inputs) {
  bool bare;
  int exit_code = render_load_inputs(&job->host, job->render, inputs, &bare, &job->scene);
  if (exit_code == EXIT_CODE_OK)
    exit_code = render_change_scene(&job->host, job->render, bare, 0, &job->scene);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  hl_error error = {0};
  hl_status status = view_name_absolutely(job->host.context, NULL, &job->scene, &error);
  return status == HL_OK ? EXIT_CODE_OK : host_fail(&job->host, PHASE_READ, status, &error);
}

/* ---- the browser ---- */

static void on_ready(void *user_data, const char *url) {
  view_job *job = user_data;
  host_clear_bar(&job->host);
  puts(url);
  fflush(stdout);
  if (!job->values[VIEW_NO_BROWSER].given) browser_open(url, &job->page);
  int port = 0;
  if (sscanf(url, "http://127.0.0.1:%d/", &port) == 1 && !job->host.quiet)
    say("from another machine: ssh -L %d:127.0.0.1:%d THIS-MACHINE, then open the same URL; Ctrl-C ends the "
        "viewer",
        port, port);
}

/* The browser has loaded the page, so the file that led it there can be removed. */
static void on_visit(void *user_data) { browser_forget(&((view_job *)user_data)->page); }

/* ---- the command ---- */

/* Writes the name of the first INPUT, and the number of further INPUTs. */
static void make_title(char **inputs, char *title, size_t size) {
  size_t count = 0;
  while (inputs[count] != NULL) count++;
  const char *name = strcmp(inputs[0], "-") == 0 ? "standard input" : base_name(inputs[0]);
  if (count == 1) snprintf(title, size, "%s", name);
  else snprintf(title, size, "%s and %zu more", name, count - 1);
}

/* Loads the module, which stays loaded. Returns null, after a message, on failure. */
static const server_module *load_module(void) {
  void *module = dlopen(SERVER_MODULE_FILE, RTLD_NOW);
  const server_module *found = module != NULL ? dlsym(module, SERVER_MODULE_NAME) : NULL;
  if (found == NULL) (void)fail(EXIT_CODE_UNSUPPORTED, "the viewer cannot be loaded: %s", dlerror());
  return found;
}

static int run_view(const cli_value *values, char **inputs) {
  const server_module *module = load_module();
  if (module == NULL) return EXIT_CODE_UNSUPPORTED;
  view_job job = {.values = values, .render = values + VIEW_OPTION_COUNT};
  const cli_value *render = job.render;
  char title[300], problem[300], folder[PATH_MAX];
  cli_host_options options = {.quiet = render[RENDER_QUIET].given,
                              .progress = true,
                              .subject = base_name(inputs[0]),
                              .memory_limit = render[RENDER_MAX_MEMORY].bytes,
                              .data_folder = render[RENDER_DATA].text,
                              .device = render[RENDER_DEVICE].text,
                              .instruction_set = (hl_instruction_set)render[RENDER_INSTRUCTION_SET].choice,
                              .cancelled = module->is_outdated,
                              .progressed = module->progress,
                              .warned = module->warned,
                              .keep_unsmoothed = true, /* for slices */
                              .operands = inputs};
  int exit_code = render[RENDER_TIME].chosen
                      ? fail(EXIT_CODE_USAGE,
                             "--time all makes a picture of each time step: view takes one, as --time 0")
                      : render_check_options(render);
  if (exit_code == EXIT_CODE_OK) exit_code = host_open(&options, &job.host);
  job.host.preview_pixels = VIEW_PREVIEW_PIXELS;
  if (exit_code == EXIT_CODE_OK) exit_code = load(&job, inputs);
  if (exit_code == EXIT_CODE_OK) {
    host_clear_bar(&job.host);
    job.host.bar = false; /* frames are rendered by several threads, which share no bar */
    make_title(inputs, title, sizeof title);
    int port = values[VIEW_PORT].given ? (int)values[VIEW_PORT].number[0] : 0;
    server_options server = {.context = job.host.context,
                             .scene = job.scene,
                             .title = title,
                             .unit = render[RENDER_UNIT].text,
                             .folder = getcwd(folder, sizeof folder),
                             .open = view_open_file,
                             .refine = view_refine_scene,
                             .read_seen = view_read_seen,
                             .files_data = job.host.context,
                             .most_upload_bytes = job.host.memory_limit,
                             .port = port,
                             .token = view_token_of_port,
                             .stopped = host_interrupted,
                             .user_data = &job,
                             .ready = on_ready,
                             .visited = on_visit};
    if (!module->run(&server, problem, sizeof problem)) exit_code = fail(EXIT_CODE_FAILURE, "%s", problem);
    browser_forget(&job.page);
  }
  hl_scene_release(job.scene);
  host_close(&job.host);
  return exit_code;
}

#else

static int run_view(const cli_value *values, char **inputs) {
  (void)values, (void)inputs;
  return fail(EXIT_CODE_UNSUPPORTED,
              "this build has no viewer: build it with libmicrohttpd and libjpeg (-Dviewer=enabled)");
}

#endif

const cli_command view_command = {
    .name = "view",
    .operands = "INPUT ...",
    .operand_count = 1,
    .operand_most = MAXIMUM_OPERANDS,
    .summary = "look at a scene or volumes in a browser: turn, light, colour",
    .description =
        "Opens INPUT, which is the same as for render, in a page of the browser, and prints the page's URL\n"
        "on stdout. In the page you turn the volume, drag the light and edit the transfer function, and "
        "save\n"
        "the picture, the scene, or the command that renders it. The options of render set what the page\n"
        "shows first. The page is served to this machine alone. Ctrl-C ends the viewer.",
    .options = view_options,
    .option_count = VIEW_OPTION_COUNT,
    .shared = render_options,
    .shared_count = RENDER_OPTION_COUNT,
    .has_shared = has_render_option,
    .run = run_view,
};
