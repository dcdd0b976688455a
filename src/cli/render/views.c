/* cli/render/views.c - implements `halflight render INPUT --views front,left,top`, which renders one scene
 * from several sides. The pictures are on one sheet or, if OUT has a %s, in a file for each side.
 *
 * The input is loaded once. A file's picture is the same that --view makes. The pictures of a sheet have one
 * scale. */
#define _GNU_SOURCE
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "render.h"
#include "text/plain.h"

enum { MOST_VIEWS = 7, NAME_BYTES = 16, WIDTH_BYTES = 40 };

/* The gap between two pictures of a sheet, as a part of a picture's width. */
static const double gap_part = 1.0 / 50;

typedef struct views_job {
  cli_host host;
  cli_value values[RENDER_OPTION_COUNT]; /* the values of the options; --view is set for each side */
  char size_text[RENDER_SIZE_TEXT];
  char width_text[WIDTH_BYTES]; /* the width of one side on the sheet */
  char **inputs;
  const char *output;
  bool files; /* whether there is a file for each side */
  char names[MOST_VIEWS][NAME_BYTES];
  int choices[MOST_VIEWS];
  size_t count;
  bool bare;
  hl_scene *loaded;             /* owned */
  hl_scene *scenes[MOST_VIEWS]; /* owned */
  hl_image *images[MOST_VIEWS]; /* owned */
  cli_overlay overlay;          /* owned */
} views_job;

/* ---- options ---- */

/* Reads "front,left,top". */
static int read_views(views_job *job) {
  const cli_choice *sides = hl_option_choices("view");
  const char *text = job->values[RENDER_VIEWS].text;
  while (*text != '\0') {
    size_t length = strcspn(text, ",");
    const cli_choice *side = sides;
    while (side->name != NULL && (strlen(side->name) != length || strncmp(side->name, text, length) != 0))
      side++;
    if (side->name == NULL)
      return fail(
          EXIT_CODE_USAGE,
          "--views: '%.*s' is no side: give front, back, left, right, top, bottom or iso, joined by commas",
          (int)length, text);
    if (job->count == MOST_VIEWS) return fail(EXIT_CODE_USAGE, "--views: at most %d sides", (int)MOST_VIEWS);
    snprintf(job->names[job->count], NAME_BYTES, "%s", side->name);
    job->choices[job->count++] = side->value;
    text += length;
    if (*text == ',') text++;
  }
  return EXIT_CODE_OK;
}

/* Sets --width to the width of each side, because the option states the width of the whole sheet. */
static int divide_width(views_job *job) {
  cli_value *width = &job->values[RENDER_WIDTH];
  const double sides = (double)job->count;
  if (!width->given || job->files) return EXIT_CODE_OK;
  int exit_code = render_overlay_read(job->values, &job->overlay);
  if (exit_code == EXIT_CODE_OK)
    hl_plain_print(job->width_text, WIDTH_BYTES, "%.17gmm",
                   job->overlay.width / (sides + (sides - 1) * gap_part));
  width->text = job->width_text;
  overlay_release(&job->overlay);
  return exit_code;
}

static int check_options(views_job *job) {
  static const int alone[] = {RENDER_VIEW,        RENDER_LAYERS,     RENDER_REFERENCE,
                              RENDER_PRINT_SCENE, RENDER_PRINT_PLAN, RENDER_JSON,
                              RENDER_FORMAT,      RENDER_STRIPS,     RENDER_VOLUME};
  const cli_value *output = &job->values[RENDER_OUTPUT];
  for (size_t n = 0; n < sizeof alone / sizeof *alone; n++)
    if (job->values[alone[n]].given)
      return fail(EXIT_CODE_USAGE, "--%s is for one picture, not for --views", render_options[alone[n]].name);
  if (!output->given || strcmp(output->text, "-") == 0)
    return fail(EXIT_CODE_USAGE,
                "--views: give --output a name: SHEET.png, or NAME-%%s.png for a file of each side");
  job->output = output->text;
  job->files = output_has_name(job->output);
  if (!job->files && output_is_linear(job->output))
    return fail(EXIT_CODE_USAGE,
                "--views: a sheet is a drawn picture, and '%s' would hold linear light: put %%s into its "
                "name, for a file "
                "of each side",
                job->output);
  int exit_code = read_views(job);
  if (exit_code == EXIT_CODE_OK) exit_code = divide_width(job);
  if (exit_code == EXIT_CODE_OK) exit_code = render_check_options(job->values);
  if (exit_code == EXIT_CODE_OK) exit_code = render_overlay_read(job->values, &job->overlay);
  hl_corner *legend = &job->overlay.overlay.legend_corner;
  if (!job->files && job->count > 1 && *legend == HL_CORNER_FREE) *legend = HL_CORNER_BELOW; /* one for all */
  if (exit_code == EXIT_CODE_OK && job->files) exit_code = output_make_folder_of(job->output);
  int count = 0;
  while (job->inputs[count] != NULL) count++;
  return exit_code == EXIT_CODE_OK ? output_check(job->output, figure_extensions, job->inputs, count)
                                   : exit_code;
}

/* ---- pictures ---- */

/* The height that a camera shows at its target, up to a factor that all views of a scene share. */
static double seen_height(const hl_camera *camera) {
  if (camera->type == HL_CAMERA_ORTHOGRAPHIC) return camera->height;
  double sum = 0;
  for (int n = 0; n < 3; n++) {
    const double way = camera->position[n] - camera->target[n];
    sum += way * way;
  }
  return sqrt(sum);
}

/* Gives a camera another height at its target. A perspective eye moves. */
static void show_height(hl_camera *camera, double height) {
  const double factor = height / seen_height(camera);
  if (camera->type == HL_CAMERA_ORTHOGRAPHIC) camera->height = height;
  else
    for (int n = 0; n < 3; n++)
      camera->position[n] = camera->target[n] + factor * (camera->position[n] - camera->target[n]);
}

/* Gives all views of a sheet one scale, the smallest of theirs. */
static int share_scale(views_job *job) {
  double most = 0;
  for (size_t v = 0; v < job->count; v++)
    most = fmax(most, seen_height(&hl_scene_describe(job->scenes[v])->camera));
  for (size_t v = 0; v < job->count; v++) {
    hl_scene_description description = *hl_scene_describe(job->scenes[v]);
    hl_scene *made = NULL;
    hl_error error = {0};
    if (!(seen_height(&description.camera) < most)) continue;
    show_height(&description.camera, most);
    hl_status status = hl_scene_create(job->host.context, &description, &made, &error);
    if (status != HL_OK) return host_fail(&job->host, PHASE_CHANGE, status, &error);
    hl_scene_release(job->scenes[v]);
    job->scenes[v] = made;
  }
  return EXIT_CODE_OK;
}

/* Puts the volumes of one view in the place of another view's. */
static int take_volumes(views_job *job, const hl_scene *from, hl_scene **scene) {
  const hl_scene_description *finer = hl_scene_describe(from);
  hl_scene_description description = *hl_scene_describe(*scene);
  hl_scene_volume *volumes = malloc(description.volume_count * sizeof *volumes + 1);
  hl_scene *made = NULL;
  hl_error error = {0};
  if (volumes == NULL) return fail(EXIT_CODE_FAILURE, "out of memory for a list of volumes");
  for (size_t n = 0; n < description.volume_count; n++) {
    volumes[n] = description.volumes[n];
    volumes[n].volume = finer->volumes[n].volume;
    volumes[n].labels = finer->volumes[n].labels;
    volumes[n].label_count = finer->volumes[n].label_count;
  }
  description.volumes = volumes;
  hl_status status = hl_scene_create(job->host.context, &description, &made, &error);
  free(volumes);
  if (status != HL_OK) return host_fail(&job->host, PHASE_CHANGE, status, &error);
  hl_scene_release(*scene);
  *scene = made;
  return EXIT_CODE_OK;
}

/* Reads the volumes where any of the views sees them. All views share the volumes. */
static int go_nearer(views_job *job) {
  hl_camera cameras[MOST_VIEWS];
  if (!hl_scene_is_coarse(hl_scene_describe(job->scenes[0]))) return EXIT_CODE_OK;
  for (size_t v = 0; v < job->count; v++) cameras[v] = hl_scene_describe(job->scenes[v])->camera;
  int exit_code = EXIT_CODE_OK;
  for (size_t v = 0; v < job->count && exit_code == EXIT_CODE_OK; v++)
    exit_code = v == 0 ? render_go_nearer(&job->host, cameras, job->count, &job->scenes[0])
                       : take_volumes(job, job->scenes[0], &job->scenes[v]);
  return exit_code;
}

static int load(views_job *job) {
  job->host.preview_pixels = render_first_pixels(job->values);
  render_overlay_set_size(job->values, NULL, job->size_text);
  int exit_code = render_load_inputs(&job->host, job->values, job->inputs, &job->bare, &job->loaded);
  if (exit_code == EXIT_CODE_OK) render_overlay_set_size(job->values, job->loaded, job->size_text);
  for (size_t v = 0; v < job->count && exit_code == EXIT_CODE_OK; v++) {
    cli_value *view = &job->values[RENDER_VIEW];
    *view = (cli_value){
        .given = true, .text = job->names[v], .chosen = true, .choice = job->choices[v], .count = 1};
    view->texts[0] = view->text;
    job->scenes[v] = job->loaded;
    hl_scene_retain(job->loaded);
    exit_code = render_change_scene(&job->host, job->values, job->bare, 0, &job->scenes[v]);
    job->host.quiet = true; /* the warnings were printed for the first side */
  }
  if (exit_code == EXIT_CODE_OK && !job->files) exit_code = share_scale(job);
  if (exit_code == EXIT_CODE_OK) exit_code = go_nearer(job);
  for (size_t v = 0; v < job->count && exit_code == EXIT_CODE_OK; v++) {
    hl_error error = {0};
    job->host.quiet = v > 0 || job->values[RENDER_QUIET].given;
    hl_status status = overlay_check_scene(job->host.context, &job->overlay, job->scenes[v], &error);
    if (status != HL_OK) exit_code = host_fail(&job->host, PHASE_CHANGE, status, &error);
  }
  job->host.quiet = job->values[RENDER_QUIET].given;
  return exit_code;
}

static hl_status render_all(views_job *job, hl_error *error) {
  hl_renderer *renderer = NULL;
  hl_status status = hl_renderer_create(job->host.context, &renderer, error);
  for (size_t v = 0; v < job->count && status == HL_OK; v++) {
    const hl_scene_description *scene = hl_scene_describe(job->scenes[v]);
    host_draw_bar(&job->host, (double)v / (double)job->count, job->names[v]);
    status = hl_image_create(job->host.context, scene->width, scene->height, &job->images[v], error);
    if (status == HL_OK)
      status = hl_renderer_render(renderer, job->scenes[v], hl_image_pixels(job->images[v]),
                                  4 * (size_t)scene->width, NULL, error);
  }
  hl_renderer_destroy(renderer);
  host_clear_bar(&job->host);
  return status == HL_OK && host_interrupted() ? HL_ERROR_CANCELLED : status;
}

/* ---- files ---- */

static hl_status write_file(views_job *job, size_t v, hl_error *error) {
  char *path = output_fill(job->output, (output_words){job->names[v], -1, true}), *text = NULL;
  hl_status status = path != NULL ? HL_OK : HL_ERROR_MEMORY;
  if (path == NULL)
    snprintf(error->message, sizeof error->message, "out of memory for the name of a picture");
  if (status == HL_OK && !job->values[RENDER_NO_METADATA].given)
    status = output_scene_text(job->host.context, job->scenes[v], path, &text, error);
  if (status == HL_OK) {
    hl_image_write_options options;
    hl_scene_write_options(job->scenes[v], &options);
    if (job->values[RENDER_DEPTH].given) options.png_depth = job->values[RENDER_DEPTH].choice;
    options.scene_json = text;
    status = overlay_write(job->host.context, &job->overlay, job->images[v], job->scenes[v], path, &options,
                           error);
  }
  hl_text_release(job->host.context, text);
  free(path);
  return status;
}

/* Copies the pictures side by side, with gaps of whole pixels. */
static hl_status write_sheet(views_job *job, hl_error *error) {
  hl_figure figure;
  hl_figure_panel panels[MOST_VIEWS];
  hl_figure_defaults(&figure);
  panels[0] = (hl_figure_panel){0};
  hl_overlay_defaults(&panels[0].overlay);
  hl_figure_of_picture(job->images[0], job->scenes[0], job->overlay.width, &figure, &panels[0]);
  if (job->overlay.pixels_per_inch > 0) figure.pixels_per_inch = job->overlay.pixels_per_inch;
  const double pixel = MILLIMETRES_PER_INCH / figure.pixels_per_inch, wide = hl_image_width(job->images[0]);
  const double gap = ceil(wide * gap_part);
  for (size_t v = 0; v < job->count; v++) {
    panels[v] = (hl_figure_panel){.image = job->images[v],
                                  .scene = job->scenes[v],
                                  .left = (double)v * (wide + gap) * pixel,
                                  .width = wide * pixel,
                                  .height = hl_image_height(job->images[v]) * pixel,
                                  .overlay = job->overlay.overlay};
    panels[v].overlay.letter = job->names[v];
  }
  figure.panels = panels;
  figure.panel_count = job->count;
  figure.width = ((double)job->count * (wide + gap) - gap) * pixel;
  figure.height = panels[0].height;
  if (job->overlay.font_points > 0) figure.font_points = job->overlay.font_points;
  hl_status status = hl_figure_add_strip(job->host.context, &figure, error);
  if (status != HL_OK) return status;
  hl_image_write_options options;
  hl_image_write_options_defaults(&options);
  options.pixels_per_inch = job->overlay.pixels_per_inch > 0 || job->overlay.width > 0
                                ? figure.pixels_per_inch
                                : 0;
  return hl_figure_write(job->host.context, &figure, job->output, &options, error);
}

static int make_and_write(views_job *job) {
  double started = hl_clock_seconds();
  hl_error error = {0};
  int exit_code = load(job);
  if (exit_code == EXIT_CODE_OK && !job->files)
    exit_code = read_files_protect(&job->host.read, job->output, job->inputs[0]);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  job->host.own_bar = true;
  hl_status status = render_all(job, &error);
  for (size_t v = 0; v < job->count && status == HL_OK && job->files; v++)
    status = write_file(job, v, &error);
  if (status == HL_OK && !job->files) status = write_sheet(job, &error);
  if (status != HL_OK) return host_fail(&job->host, PHASE_RUN, status, &error);
  if (!job->host.quiet) say("%s: %zu sides, %.3g s", job->output, job->count, hl_clock_seconds() - started);
  return EXIT_CODE_OK;
}

int render_views(const cli_value *values, char **operands) {
  views_job *job = calloc(1, sizeof *job);
  if (job == NULL) return fail(EXIT_CODE_FAILURE, "out of memory");
  memcpy(job->values, values, sizeof job->values);
  job->inputs = operands;
  cli_host_options options = {.quiet = values[RENDER_QUIET].given,
                              .progress = true,
                              .subject = base_name(operands[0]),
                              .memory_limit = values[RENDER_MAX_MEMORY].bytes,
                              .data_folder = values[RENDER_DATA].text,
                              .device = values[RENDER_DEVICE].text,
                              .instruction_set = (hl_instruction_set)values[RENDER_INSTRUCTION_SET].choice,
                              .operands = operands};
  int exit_code = check_options(job);
  if (exit_code == EXIT_CODE_OK) {
    exit_code = host_open(&options, &job->host);
    if (exit_code == EXIT_CODE_OK) exit_code = make_and_write(job);
    for (size_t v = 0; v < job->count; v++) {
      hl_image_destroy(job->images[v]);
      hl_scene_release(job->scenes[v]);
    }
    hl_scene_release(job->loaded);
    host_close(&job->host);
  }
  overlay_release(&job->overlay);
  free(job);
  return exit_code;
}
