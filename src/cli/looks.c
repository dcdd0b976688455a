/* cli/looks.c - implements `halflight looks VOLUME -o sheet.png`, which makes a contact sheet of the looks of
 * --look. The option of each look stands under its picture. */
#include <halflight/compose.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/render/render.h"
#include "commands.h"
#include "elementary/elementary.h"
#include "host.h"
#include "input.h"
#include "output.h"
#include "sheet_font.h"

enum looks_option {
  LOOKS_OUTPUT,
  LOOKS_SIZE,
  LOOKS_LOOK,
  LOOKS_ARRAY,
  LOOKS_COMPONENT,
  LOOKS_SERIES,
  LOOKS_TIME,
  LOOKS_CHANNEL,
  LOOKS_LEVEL,
  LOOKS_SPACING,
  LOOKS_SPACE,
  LOOKS_THREADS,
  LOOKS_MAX_MEMORY,
  LOOKS_DEVICE,
  LOOKS_QUIET,
  LOOKS_OPTION_COUNT
};

static const cli_option looks_options[LOOKS_OPTION_COUNT] = {
    [LOOKS_OUTPUT] =
        {.name = "output",
         .letter = 'o',
         .kind = OPTION_TEXT,
         .argument = "OUT",
         .group = "Options",
         .help = "file to write: .png, .exr or .npy\n(default: VOLUME's name with -looks.png, in this "
                 "folder)"},
    [LOOKS_SIZE] = {.name = "size",
                    .kind = OPTION_NUMBERS,
                    .argument = "N",
                    .help = "pixels of each picture's side (default 256)",
                    .count = 1,
                    .whole = true,
                    .low = 16,
                    .high = 2048},
    [LOOKS_LOOK] = {.name = "look",
                    .kind = OPTION_TEXT,
                    .argument = "NAME,...",
                    .help = "only these looks, side by side: surface,translucent\n(default: all)"},
    INPUT_OPTIONS(LOOKS_ARRAY, "What of VOLUME"),
    [LOOKS_CHANNEL] = INPUT_OPTION_CHANNELS,
    [LOOKS_SPACING] = INPUT_OPTION_SPACING,
    [LOOKS_SPACE] = INPUT_OPTION_SPACE,
    [LOOKS_THREADS] = HOST_OPTION_THREADS("How it runs"),
    [LOOKS_MAX_MEMORY] = HOST_OPTION_MAX_MEMORY(NULL),
    [LOOKS_DEVICE] = HOST_OPTION_DEVICE,
    [LOOKS_QUIET] = HOST_OPTION_QUIET,
};

/* ---- the sheet ---- */

enum { COLUMNS = 4, CAPTION = 20, LETTER_TOP = 1, LETTER_LEFT = 4, MOST_LOOKS = 32 };

typedef struct looks_job {
  cli_host host;
  const cli_value *values;
  const char *input; /* as given */
  char *output;      /* owned */
  cli_input opened;
  hl_volume_load_options load;
  hl_volume *volume; /* null if several channels share each picture */
  hl_renderer *renderer;
  hl_image *sheet;
  int side;                 /* pixels of a picture */
  size_t shown[MOST_LOOKS]; /* [shown_count]; the looks of the sheet, as indices of the choices of --look */
  size_t shown_count;
} looks_job;

static void put_pixel(hl_image *sheet, int x, int y, const float color[3]) {
  float *to = hl_image_pixels(sheet) + 4 * ((size_t)y * (size_t)hl_image_width(sheet) + (size_t)x);
  for (int c = 0; c < 3; c++) to[c] = color[c];
  to[3] = 1;
}

static void put_letter(hl_image *sheet, int x, int y, int scale, char letter) {
  static const float white[3] = {0.7f, 0.7f, 0.7f};
  unsigned char rows[LETTER_HEIGHT];
  letter_rows(letter, rows);
  for (int row = 0; row < LETTER_HEIGHT * scale; row++)
    for (int column = 0; column < LETTER_WIDTH * scale; column++)
      if (rows[row / scale] >> (column / scale) & 1) put_pixel(sheet, x + column, y + row, white);
}

/* Writes "--look NAME", cut to the room under the picture. */
static void put_caption(const looks_job *job, int left, int top, const char *name) {
  char text[64];
  snprintf(text, sizeof text, "--look %s", name);
  int longest = (int)strlen("--look translucent") * LETTER_STEP;
  int scale = 2 * longest + LETTER_LEFT <= job->side ? 2 : 1, x = LETTER_LEFT, step = LETTER_STEP * scale;
  for (const char *letter = text; *letter != '\0' && x + step <= job->side; letter++, x += step)
    put_letter(job->sheet, left + x, top + LETTER_TOP, scale, *letter);
}

/* Copies a picture over its scene's background into the sheet. */
static void put_picture(const looks_job *job, const hl_scene_description *scene, const hl_image *picture,
                        int left, int top) {
  float factor = (float)hl_exp2(scene->exposure);
  const float *from = hl_image_pixels_const(picture);
  for (int y = 0; y < job->side; y++)
    for (int x = 0; x < job->side; x++, from += 4) {
      float color[3];
      for (int c = 0; c < 3; c++) color[c] = from[c] * factor + (1 - from[3]) * (float)scene->background[c];
      put_pixel(job->sheet, left + x, top + y, color);
    }
}

/* ---- the looks ---- */

/* Reads the names of the looks that are shown. Without names, all looks are shown. */
static int choose_looks(looks_job *job, const cli_value *names) {
  const hl_setting_choice *all = hl_option_choices("look");
  for (size_t n = 0; !names->given && all[n].name != NULL && n < MOST_LOOKS; n++)
    job->shown[job->shown_count++] = n;
  for (const char *name = names->given ? names->text : NULL; name != NULL;) {
    const char *comma = strchr(name, ',');
    const size_t length = comma != NULL ? (size_t)(comma - name) : strlen(name);
    size_t n = 0;
    while (all[n].name != NULL && (strlen(all[n].name) != length || strncmp(all[n].name, name, length) != 0))
      n++;
    if (all[n].name == NULL || job->shown_count == MOST_LOOKS)
      return fail(EXIT_CODE_USAGE, "--look: '%.*s' is no look: see 'halflight help render'", (int)length,
                  name);
    job->shown[job->shown_count++] = n;
    name = comma != NULL ? comma + 1 : NULL;
  }
  return EXIT_CODE_OK;
}

static size_t columns_of(const looks_job *job) {
  return job->shown_count < COLUMNS ? job->shown_count : COLUMNS;
}

/* Makes *scene the scene that `render` would make of it with the option --look. */
static hl_status compose(hl_context *context, const char *look, hl_scene **scene, hl_error *error) {
  const hl_option option = {"look", look};
  hl_scene *composed = NULL;
  hl_status status = hl_scene_compose(context, hl_scene_describe(*scene), HL_COMPOSE_BARE, &option, 1,
                                      &composed, error);
  if (status != HL_OK) return status;
  hl_scene_release(*scene);
  *scene = composed;
  return HL_OK;
}

static hl_status scene_of(const looks_job *job, size_t index, hl_scene **scene, hl_error *error) {
  hl_context *context = job->host.context;
  const char *name = hl_option_choices("look")[index].name;
  hl_scene *made = NULL;
  bool projected = strcmp(name, "mip") == 0;
  hl_status status = job->volume != NULL
                         ? hl_scene_for_volume_look(context, job->volume, NULL, name, &made, error)
                         : hl_scene_for_channels(context, job->opened.title, &job->load,
                                                 job->values[LOOKS_CHANNEL].text, NULL, name, &made, error);
  if (status == HL_OK && (projected || job->volume == NULL)) status = compose(context, name, &made, error);
  if (status == HL_OK) {
    hl_scene_description description = *hl_scene_describe(made);
    description.width = description.height = job->side;
    if (job->values[LOOKS_THREADS].given)
      description.render.threads = (int)job->values[LOOKS_THREADS].number[0];
    status = hl_scene_create(context, &description, scene, error);
  }
  hl_scene_release(made);
  return status;
}

/* place: the index of the look in the sheet. */
static hl_status add_look(looks_job *job, size_t place, hl_error *error) {
  const size_t index = job->shown[place];
  hl_scene *scene = NULL;
  hl_image *picture = NULL;
  int left = (int)(place % columns_of(job)) * job->side,
      top = (int)(place / columns_of(job)) * (job->side + CAPTION);
  hl_status status = scene_of(job, index, &scene, error);
  if (status == HL_OK) status = hl_image_create(job->host.context, job->side, job->side, &picture, error);
  if (status == HL_OK)
    status = hl_renderer_render(job->renderer, scene, hl_image_pixels(picture), 4 * (size_t)job->side, NULL,
                                error);
  if (status == HL_OK) {
    put_picture(job, hl_scene_describe(scene), picture, left, top);
    put_caption(job, left, top + job->side, hl_option_choices("look")[index].name);
  }
  hl_image_destroy(picture);
  hl_scene_release(scene);
  return status;
}

/* Makes the sheet, on a ground as dark as a bare volume's. */
static hl_status make_sheet(looks_job *job, hl_error *error) {
  static const float ground[3] = {0.01f, 0.011f, 0.013f};
  const size_t count = job->shown_count, columns = columns_of(job), rows = (count + columns - 1) / columns;
  const int width = (int)columns * job->side, height = (int)rows * (job->side + CAPTION);
  hl_status status = hl_image_create(job->host.context, width, height, &job->sheet, error);
  if (status == HL_OK) status = hl_renderer_create(job->host.context, &job->renderer, error);
  for (int y = 0; y < height && status == HL_OK; y++)
    for (int x = 0; x < width; x++) put_pixel(job->sheet, x, y, ground);
  for (size_t n = 0; n < count && status == HL_OK; n++) status = add_look(job, n, error);
  return status;
}

/* Loads the volume. Several channels are loaded with each look. */
static int load_volume(looks_job *job) {
  cli_input *input = &job->opened;
  hl_error error = {0};
  const cli_value *said = &job->values[LOOKS_CHANNEL];
  input_load_options(&job->values[LOOKS_ARRAY], &job->values[LOOKS_SPACING], &job->load);
  int exit_code = input_check_channels(said);
  if (exit_code == EXIT_CODE_OK) exit_code = input_check_place(&job->values[LOOKS_SPACING]);
  if (exit_code == EXIT_CODE_OK)
    exit_code = input_open(job->input, job->values[LOOKS_MAX_MEMORY].bytes, input);
  if (exit_code == EXIT_CODE_OK && input->kind != INPUT_VOLUME)
    exit_code = fail(EXIT_CODE_USAGE, "'%s' is a scene, which has its look: give a volume", job->input);
  job->load.bytes = input->bytes;
  job->load.byte_count = input->length;
  if (exit_code != EXIT_CODE_OK || input_has_channels(said)) return exit_code;
  hl_status status = input_load_volume(job->host.context, input, &job->load, &job->volume, &error);
  return status == HL_OK ? EXIT_CODE_OK : host_fail(&job->host, PHASE_READ, status, &error);
}

static int make_and_write(looks_job *job) {
  double started = hl_clock_seconds();
  hl_error error = {0};
  int exit_code = load_volume(job);
  if (exit_code == EXIT_CODE_OK) exit_code = read_files_protect(&job->host.read, job->output, job->input);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  hl_status status = make_sheet(job, &error);
  if (status == HL_OK) status = hl_image_write(job->host.context, job->sheet, job->output, NULL, &error);
  host_clear_bar(&job->host);
  if (status != HL_OK) return host_fail(&job->host, PHASE_RUN, status, &error);
  if (!job->host.quiet)
    say("%s: %zu looks in %.1f s", job->output, job->shown_count, hl_clock_seconds() - started);
  return EXIT_CODE_OK;
}

static char *output_of(const cli_value *output, const char *input) {
  if (!output->given) return output_default_name(input, "-looks.png");
  char *copy = malloc(strlen(output->text) + 1);
  return copy != NULL ? strcpy(copy, output->text) : NULL;
}

static int run_looks(const cli_value *values, char **operands) {
  looks_job job = {
      .values = values, .input = operands[0], .output = output_of(&values[LOOKS_OUTPUT], operands[0])};
  job.side = values[LOOKS_SIZE].given ? (int)values[LOOKS_SIZE].number[0] : 256;
  if (job.output == NULL) return fail(EXIT_CODE_FAILURE, "out of memory");
  int exit_code = output_check(job.output, picture_extensions, operands, 1);
  if (exit_code == EXIT_CODE_OK) exit_code = choose_looks(&job, &values[LOOKS_LOOK]);
  cli_host_options host_options = {.quiet = values[LOOKS_QUIET].given,
                                   .progress = true,
                                   .subject = base_name(operands[0]),
                                   .memory_limit = values[LOOKS_MAX_MEMORY].bytes,
                                   .device = values[LOOKS_DEVICE].text,
                                   .operands = operands};
  if (exit_code == EXIT_CODE_OK) {
    exit_code = host_open(&host_options, &job.host);
    if (exit_code == EXIT_CODE_OK) exit_code = make_and_write(&job);
    hl_renderer_destroy(job.renderer);
    hl_image_destroy(job.sheet);
    hl_volume_release(job.volume);
    input_close(&job.opened);
    host_close(&job.host);
  }
  free(job.output);
  return exit_code;
}

const cli_command looks_command = {
    .name = "looks",
    .operands = "VOLUME",
    .operand_count = 1,
    .summary = "a contact sheet of the looks that a volume can have",
    .description =
        "Renders VOLUME (any that render reads) with each look of `halflight render --look`, side by side,\n"
        "with the option under each picture.",
    .options = looks_options,
    .option_count = LOOKS_OPTION_COUNT,
    .run = run_looks,
};
