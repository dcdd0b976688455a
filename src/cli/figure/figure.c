/* cli/figure/figure.c - implements `halflight figure FIGURE.json`, which draws pictures side by side on a
 * page. The pictures may share a camera, a light or a range of values.
 *
 * All scenes are made before the first picture, so that a panel which cannot be drawn is refused at once. */
#define _GNU_SOURCE
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/commands.h"
#include "cli/frames.h"
#include "elementary/elementary.h"
#include "panels.h"

enum {
  FIGURE_OUTPUT,
  FIGURE_DPI,
  FIGURE_DATA,
  FIGURE_THREADS,
  FIGURE_DEVICE,
  FIGURE_MAX_MEMORY,
  FIGURE_QUIET,
  FIGURE_OPTION_COUNT
};

static const cli_option figure_options[FIGURE_OPTION_COUNT] = {
    [FIGURE_OUTPUT] = {.name = "output",
                       .letter = 'o',
                       .kind = OPTION_TEXT,
                       .argument = "OUT",
                       .group = "Options",
                       .help =
                           ".pdf, .svg, .png or .tif (default: FIGURE's name with\n.pdf, in this folder)"},
    [FIGURE_DPI] = {.name = "dpi",
                    .kind = OPTION_NUMBERS,
                    .argument = "N",
                    .help = "pixels an inch, in place of the figure's own \"dpi\":\na draft by --dpi 75",
                    .count = 1,
                    .low = FIGURE_LEAST_DPI,
                    .high = FIGURE_MOST_DPI},
    [FIGURE_DATA] = HOST_OPTION_DATA(NULL),
    [FIGURE_THREADS] = HOST_OPTION_THREADS(NULL),
    [FIGURE_DEVICE] = HOST_OPTION_DEVICE,
    [FIGURE_MAX_MEMORY] = HOST_OPTION_MAX_MEMORY(NULL),
    [FIGURE_QUIET] = HOST_OPTION_QUIET,
};

typedef struct figure_job {
  cli_host host;
  const cli_value *values;
  char *input, *output; /* output: owned, absolute */
  char *shown;          /* owned; the output's name as messages show it */
  figure_page page;
} figure_job;

/* ---- scenes ---- */

/* Gives a panel's picture the width of the panel's place, in pixels, and the proportions that the panel asks
 * for. */
static void size_panel(const figure_page *page, figure_panel *panel) {
  int width = (int)fmax(1, round(panel->place.width / MILLIMETRES_PER_INCH * page->pixels_per_inch));
  hl_scene_description shape;
  hl_scene_description_defaults(&shape);
  if (panel->scene != NULL) shape = *hl_scene_describe(panel->scene);
  double aspect = panel->aspect > 0 ? panel->aspect : (double)shape.width / shape.height;
  render_set_size(&panel->values[RENDER_SIZE], width, width / aspect, panel->size_text);
}

/* Copies everything that the first panel shares into the description of another panel. inset: whether that
 * panel is an inset, which has a camera of its own. */
static void take_shared(const figure_page *page, bool inset, hl_scene_description *description,
                        hl_scene_volume *volumes) {
  const hl_scene_description *first = hl_scene_describe(page->panels[0].scene);
  if (page->share_camera && !inset) {
    description->camera = first->camera;
    memcpy(description->sky.up, first->sky.up, sizeof first->sky.up);
  }
  if (page->share_light) {
    description->lights = first->lights;
    description->light_count = first->light_count;
    memcpy(description->ambient, first->ambient, sizeof first->ambient);
    description->sky = first->sky;
    description->exposure = first->exposure;
    description->tone = first->tone;
    memcpy(description->background, first->background, sizeof first->background);
  }
  for (size_t v = 0; page->share_function && v < description->volume_count; v++) {
    size_t from = v < first->volume_count ? v : first->volume_count - 1;
    if (first->volume_count > 0) volumes[v].transfer_function = first->volumes[from].transfer_function;
  }
}

/* Replaces the scene of a panel by a scene of the description. */
static int replace_scene(figure_job *job, figure_panel *panel, const hl_scene_description *description) {
  hl_scene *made = NULL;
  hl_error error = {0};
  hl_status status = hl_scene_create(job->host.context, description, &made, &error);
  if (status != HL_OK) return host_fail(&job->host, PHASE_CHANGE, status, &error);
  hl_scene_release(panel->scene);
  panel->scene = made;
  return EXIT_CODE_OK;
}

static int share(figure_job *job, figure_panel *panel) {
  const figure_page *page = &job->page;
  if (panel == page->panels || (!page->share_camera && !page->share_light && !page->share_function))
    return EXIT_CODE_OK;
  hl_scene_description description = *hl_scene_describe(panel->scene);
  hl_scene_volume *volumes = calloc(description.volume_count + 1, sizeof *volumes);
  if (volumes == NULL) return fail(EXIT_CODE_FAILURE, "out of memory");
  if (description.volume_count > 0)
    memcpy(volumes, description.volumes, description.volume_count * sizeof *volumes);
  description.volumes = volumes;
  take_shared(page, panel->inset.of >= 0, &description, volumes);
  int exit_code = replace_scene(job, panel, &description);
  free(volumes);
  return exit_code;
}

static void cross(const double a[3], const double b[3], double product[3]) {
  for (int n = 0; n < 3; n++) product[n] = a[(n + 1) % 3] * b[(n + 2) % 3] - a[(n + 2) % 3] * b[(n + 1) % 3];
}

static double length_of(const double v[3]) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

/* Aims a camera at the place that it shows at fractions of its picture, from the upper left. A perspective
 * eye turns, and an orthographic one moves. aspect: the picture's width over its height. */
static void aim_at(hl_camera *camera, const double at[2], double aspect) {
  double forward[3], right[3], up[3];
  for (int n = 0; n < 3; n++) forward[n] = camera->target[n] - camera->position[n];
  cross(forward, camera->up, right);
  cross(right, forward, up);
  const bool flat = camera->type == HL_CAMERA_ORTHOGRAPHIC;
  const double height = flat ? camera->height
                             : 2 * length_of(forward) * hl_tan(camera->fovy_deg * HL_PI / 360);
  const double x = (at[0] - 0.5) * aspect * height / length_of(right);
  const double y = (0.5 - at[1]) * height / length_of(up);
  for (int n = 0; n < 3; n++) {
    camera->target[n] += x * right[n] + y * up[n];
    if (flat) camera->position[n] += x * right[n] + y * up[n];
  }
}

/* Gives an inset the camera of its panel, and a picture in which the place that the inset states is larger by
 * the factor that it states. The eye stays where it is, so that the inset shows the panel's perspective. */
static int magnify(figure_job *job, figure_panel *inset) {
  const figure_panel *outer = inset->inset.of >= 0 ? &job->page.panels[inset->inset.of] : NULL;
  if (outer == NULL || inset->inset.zoom == 0 || outer->scene == NULL) return EXIT_CODE_OK;
  hl_scene_description description = *hl_scene_describe(inset->scene);
  const hl_scene_description *shown = hl_scene_describe(outer->scene);
  description.camera = shown->camera;
  aim_at(&description.camera, inset->inset.at, (double)shown->width / shown->height);
  const double degree = HL_PI / 180, half = hl_tan(description.camera.fovy_deg * degree / 2);
  description.camera.fovy_deg = 2 / degree * hl_atan(half / inset->inset.zoom);
  description.camera.height /= inset->inset.zoom;
  return replace_scene(job, inset, &description);
}

static int read_options(figure_job *job, figure_panel *panel) {
  bool help;
  int exit_code = options_parse(&render_command, (int)panel->word_count, panel->words, panel->values,
                                panel->operands, &help);
  if (exit_code == EXIT_CODE_OK && render_is_series(panel->values, panel->operands))
    exit_code = fail(EXIT_CODE_INPUT, "%s: a panel is one picture: '%s' stands for several", job->input,
                     panel->operands[0]);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  panel->values[RENDER_THREADS] = job->values[FIGURE_THREADS];
  panel->values[RENDER_QUIET] = job->values[FIGURE_QUIET];
  exit_code = render_check_options(panel->values);
  if (exit_code == EXIT_CODE_OK) exit_code = render_overlay_read(panel->values, &panel->overlay);
  if (exit_code == EXIT_CODE_OK && panel->overlay.overlay.scale_bar && panel->inset.of >= 0 &&
      panel->values[RENDER_UNIT].given)
    panel->overlay.overlay.world_unit = panel->values[RENDER_UNIT].text;
  return exit_code;
}

/* Places panels row by row. A row has the number of panels that fit into the page's width. Insets are placed
 * with their panels. */
static void place_widths(figure_page *page) {
  int outer = 0;
  for (int p = 0; p < page->count; p++) outer += page->panels[p].inset.of < 0;
  if (page->columns == 0 || page->columns > outer) page->columns = outer;
  for (int p = 0; p < page->count; p++) {
    figure_panel *panel = &page->panels[p];
    if (panel->inset.of >= 0)
      panel->place.width = panel->inset.part * page->panels[panel->inset.of].place.width;
    else panel->place.width = (page->width - (page->columns - 1) * page->gap) / page->columns;
  }
}

/* Returns the page's height. */
static double place_panels(figure_page *page) {
  double top = 0, high = 0;
  int column = 0;
  for (int p = 0; p < page->count; p++) {
    figure_panel *panel = &page->panels[p];
    const hl_scene_description *scene = hl_scene_describe(panel->scene);
    panel->place.height = panel->place.width * (scene != NULL ? (double)scene->height / scene->width
                                                              : (double)hl_image_height(panel->image) /
                                                                    hl_image_width(panel->image));
    if (panel->inset.of >= 0) {
      const figure_panel *outer = &page->panels[panel->inset.of];
      double rim = 0.02 * outer->place.width;
      panel->place.left = panel->inset.right
                              ? outer->place.left + outer->place.width - panel->place.width - rim
                              : outer->place.left + rim;
      panel->place.top = panel->inset.lower
                             ? outer->place.top + outer->place.height - panel->place.height - rim
                             : outer->place.top + rim;
      continue;
    }
    if (column == page->columns) {
      top += high + page->gap;
      high = 0;
      column = 0;
    }
    panel->place.left = column++ * (panel->place.width + page->gap);
    panel->place.top = top;
    high = fmax(high, panel->place.height);
  }
  return top + high;
}

/* Returns whether a file is a picture that need not be rendered: a PNG that carries no scene, OpenEXR,
 * Radiance HDR, or an .npy file of R, G, B and A as `halflight render` writes it. Any other .npy file is a
 * volume. */
static bool is_plain_picture(const char *path) {
  size_t length = 0;
  hl_image_about about = {.struct_size = sizeof about};
  const bool array = has_extension(path, ".npy");
  if (!array && !has_extension(path, ".png") && !has_extension(path, ".exr") && !has_extension(path, ".hdr"))
    return false;
  unsigned char *bytes = frames_read_picture(path, &length);
  bool plain = bytes != NULL && hl_image_get_about(path, bytes, length, &about, NULL) == HL_OK &&
               (!array || about.channels == 4);
  free(bytes);
  return plain && (!about.has_scene || figure_is_in_picture(path));
}

/* Makes the scene of a panel, or reads its picture. */
static int fill_panel(figure_job *job, figure_panel *panel) {
  const figure_page *page = &job->page;
  hl_error error = {0};
  if (panel->operands[1] == NULL && is_plain_picture(panel->operands[0])) {
    if (panel == page->panels && (page->share_camera || page->share_light || page->share_function))
      return fail(EXIT_CODE_INPUT,
                  "%s: \"share\": the first panel, '%s', is a picture without a scene to share", job->input,
                  panel->operands[0]);
    hl_status status = hl_image_read(job->host.context, panel->operands[0], &panel->image, &error);
    return status == HL_OK ? EXIT_CODE_OK : host_fail(&job->host, PHASE_READ, status, &error);
  }
  job->host.preview_pixels = render_first_pixels(panel->values);
  int exit_code = render_load_inputs(&job->host, panel->values, panel->operands, &panel->bare, &panel->scene);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  size_panel(page, panel);
  exit_code = render_change_scene(&job->host, panel->values, panel->bare, 0, &panel->scene);
  if (exit_code == EXIT_CODE_OK) exit_code = share(job, panel);
  if (exit_code == EXIT_CODE_OK) exit_code = magnify(job, panel);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  return render_go_nearer(&job->host, &hl_scene_describe(panel->scene)->camera, 1, &panel->scene);
}

static int make_scenes(figure_job *job) {
  figure_page *page = &job->page;
  int exit_code = EXIT_CODE_OK;
  for (int p = 0; p < page->count && exit_code == EXIT_CODE_OK; p++)
    exit_code = read_options(job, &page->panels[p]);
  if (exit_code == EXIT_CODE_OK) place_widths(page);
  for (int p = 0; p < page->count && exit_code == EXIT_CODE_OK; p++)
    exit_code = fill_panel(job, &page->panels[p]);
  return exit_code;
}

/* ---- the page ---- */

/* height: the height of the panels together. *figure: the page, with the strip of a legend below them. */
static hl_status make_figure(figure_job *job, double height, hl_figure *figure, hl_figure_panel *panels,
                             hl_error *error) {
  const figure_page *page = &job->page;
  hl_figure_defaults(figure);
  figure->width = page->width;
  figure->height = height;
  figure->pixels_per_inch = page->pixels_per_inch;
  figure->font_points = page->font_points;
  memcpy(figure->background, page->background, sizeof figure->background);
  figure->background_transparent = page->transparent;
  figure->panels = panels;
  figure->panel_count = (size_t)page->count;
  for (int p = 0; p < page->count; p++) {
    const figure_panel *from = &page->panels[p];
    panels[p] = (hl_figure_panel){.image = from->image,
                                  .scene = from->scene,
                                  .left = from->place.left,
                                  .top = from->place.top,
                                  .width = from->place.width,
                                  .height = from->place.height,
                                  .frame = from->inset.of >= 0,
                                  .overlay = from->overlay.overlay};
    panels[p].overlay.letter = from->letter;
  }
  return hl_figure_add_strip(job->host.context, figure, error);
}

static hl_status try_out(figure_job *job, double height, hl_error *error) {
  hl_figure figure;
  hl_figure_panel panels[FIGURE_MOST_PANELS];
  hl_status status = make_figure(job, height, &figure, panels, error);
  return status == HL_OK ? hl_figure_check(job->host.context, &figure, error) : status;
}

static hl_status render_panel(figure_job *job, figure_panel *panel, hl_renderer *renderer, hl_error *error) {
  const hl_scene_description *scene = hl_scene_describe(panel->scene);
  float *pixels = hl_image_pixels(panel->image);
  const size_t stride = 4 * (size_t)scene->width;
  job->host.stage.hint = NULL;
  if (!panel->values[RENDER_REFERENCE].given)
    return hl_renderer_render(renderer, panel->scene, pixels, stride, NULL, error);
  const hl_reference_options options = render_reference_options(panel->values, scene);
  job->host.stage.hint =
      "\"reference\" marches every ray: a smaller \"dpi\", fewer \"light-points\" or a greater "
      "\"step\" is faster";
  return hl_reference_render(job->host.context, panel->scene, &options, pixels, stride, error);
}

static hl_status render_panels(figure_job *job, hl_error *error) {
  hl_renderer *renderer = NULL;
  hl_status status = hl_renderer_create(job->host.context, &renderer, error);
  job->host.own_bar = true;
  for (int p = 0; p < job->page.count && status == HL_OK; p++) {
    figure_panel *panel = &job->page.panels[p];
    const hl_scene_description *scene = hl_scene_describe(panel->scene);
    char text[40];
    if (scene == NULL) continue;
    snprintf(text, sizeof text, "panel %d of %d", p + 1, job->page.count);
    host_draw_bar(&job->host, (double)p / job->page.count, text);
    status = hl_image_create(job->host.context, scene->width, scene->height, &panel->image, error);
    if (status == HL_OK) status = render_panel(job, panel, renderer, error);
  }
  hl_renderer_destroy(renderer);
  host_clear_bar(&job->host);
  return status;
}

/* Writes the page. A PNG carries the figure. */
static hl_status write_page(figure_job *job, const hl_figure *figure, hl_error *error) {
  char *text = figure_page_text(&job->page);
  hl_image_write_options options;
  hl_image_write_options_defaults(&options);
  options.pixels_per_inch = figure->pixels_per_inch;
  options.scene_json = text;
  hl_status status = hl_figure_write(job->host.context, figure, job->output, &options, error);
  free(text);
  return status;
}

static int make_and_write(figure_job *job) {
  double started = hl_clock_seconds();
  hl_error error = {0};
  int exit_code = make_scenes(job);
  if (exit_code == EXIT_CODE_OK) exit_code = read_files_protect(&job->host.read, job->output, job->input);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  double height = place_panels(&job->page);
  hl_status status = try_out(job, height, &error);
  if (status != HL_OK) return host_fail(&job->host, PHASE_CHANGE, status, &error);
  status = render_panels(job, &error);
  if (status == HL_OK && host_interrupted()) status = HL_ERROR_CANCELLED;
  if (status == HL_OK) {
    hl_figure figure;
    hl_figure_panel panels[FIGURE_MOST_PANELS];
    status = make_figure(job, height, &figure, panels, &error);
    height = figure.height;
    if (status == HL_OK) status = write_page(job, &figure, &error);
  }
  if (status != HL_OK) return host_fail(&job->host, PHASE_RUN, status, &error);
  if (!job->host.quiet)
    say("%s: %d pictures on %.4g x %.4g mm, %.3g s", job->shown, job->page.count, job->page.width, height,
        hl_clock_seconds() - started);
  return EXIT_CODE_OK;
}

/* ---- the run ---- */

/* Makes the folder of the file FIGURE.json the current folder, because names in this file are relative to it.
 * The output's name was made absolute before. */
static int enter_folder(figure_job *job) {
  static const char *const extensions[] = {".pdf", ".svg", ".png", ".tif", ".tiff", NULL};
  const cli_value *given = &job->values[FIGURE_OUTPUT];
  char *name = given->given ? strdup(given->text) : output_default_name(job->input, ".pdf");
  if (name == NULL) return fail(EXIT_CODE_FAILURE, "out of memory");
  char *inputs[] = {job->input, NULL}, *here = getcwd(NULL, 0), *folder = strdup(job->input);
  int exit_code = output_check(name, extensions, inputs, 1);
  bool good = here != NULL && folder != NULL &&
              (name[0] == '/' ? (job->output = strdup(name)) != NULL
                              : asprintf(&job->output, "%s/%s", here, name) >= 0);
  if (exit_code == EXIT_CODE_OK && !good) exit_code = fail(EXIT_CODE_FAILURE, "out of memory");
  if (exit_code == EXIT_CODE_OK) {
    folder[base_name(folder) - folder] = '\0';
    if (folder[0] != '\0' && chdir(folder) != 0)
      exit_code = fail(EXIT_CODE_INPUT, "%s: its folder cannot be entered", job->input);
  }
  free(folder);
  free(here);
  job->shown = name;
  return exit_code;
}

static int run_figure(const cli_value *values, char **operands) {
  figure_job job = {.values = values, .input = operands[0]};
  char *data = values[FIGURE_DATA].given ? realpath(values[FIGURE_DATA].text, NULL) : NULL;
  int exit_code = figure_page_read(job.input, &job.page);
  if (values[FIGURE_DPI].given) job.page.pixels_per_inch = values[FIGURE_DPI].number[0];
  if (exit_code == EXIT_CODE_OK) exit_code = enter_folder(&job);
  cli_host_options options = {.quiet = values[FIGURE_QUIET].given,
                              .progress = true,
                              .subject = base_name(job.input),
                              .memory_limit = values[FIGURE_MAX_MEMORY].bytes,
                              .device = values[FIGURE_DEVICE].text,
                              .data_folder = data != NULL ? data : values[FIGURE_DATA].text};
  if (exit_code == EXIT_CODE_OK) {
    exit_code = host_open(&options, &job.host);
    if (exit_code == EXIT_CODE_OK) exit_code = make_and_write(&job);
    figure_page_release(&job.page);
    host_close(&job.host);
  } else {
    figure_page_release(&job.page);
  }
  free(data);
  free(job.output);
  free(job.shown);
  return exit_code;
}

const cli_command figure_command = {
    .name = "figure",
    .operands = "FIGURE",
    .operand_count = 1,
    .summary = "pictures side by side on a page, for a paper",
    .description =
        "Renders the panels of FIGURE (.json), and puts them on a page of a stated width, with letters, "
        "scale\n"
        "bars, legends and texts. A panel is \"input\", a file or a list of files, and options of\n"
        "`halflight render` by their names; \"share\" gives all panels the camera, light or range of the "
        "first:\n\n"
        "  {\"width\": \"183mm\", \"columns\": 2, \"share\": [\"camera\", \"light\"], \"options\": "
        "{\"ortho\": true},\n"
        "   \"panels\": [{\"input\": \"a.nrrd\", \"scale-bar\": \"auto\"}, {\"input\": \"b.nrrd\", "
        "\"legend\": \"Dose (Gy)\"}]}",
    .options = figure_options,
    .option_count = FIGURE_OPTION_COUNT,
    .run = run_figure,
};
