/* cli/input.c - reads INPUT: finds its kind, and loads its scene or volume. */
#define _GNU_SOURCE
#include "input.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <halflight/grids.h>
#include <halflight/particles.h>
#include <halflight/resolutions.h>
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "output.h"
#include "platform/memory.h"
#include "platform/program.h"
#include "text/body_axes.h"
#include "text/plain.h"
#include "text/units.h"

#define STANDARD_INPUT "/dev/stdin" /* the volume's file in a scene made from standard input */

const cli_choice input_components[] = {{"magnitude", HL_COMPONENT_MAGNITUDE},
                                       {"color", HL_COMPONENT_COLOR},
                                       {"luminance", HL_COMPONENT_LUMINANCE},
                                       {NULL, 0}};

/* ---- reading pipes ---- */

static input_kind kind_by_content(const unsigned char *bytes, size_t length) {
  static const unsigned char png[4] = {0x89, 'P', 'N', 'G'}, byte_order_mark[3] = {0xef, 0xbb, 0xbf};
  if (length >= sizeof png && memcmp(bytes, png, sizeof png) == 0) return INPUT_PICTURE;
  size_t at = length >= 3 && memcmp(bytes, byte_order_mark, 3) == 0 ? 3 : 0;
  while (at < length && isspace(bytes[at])) at++;
  if (at >= length || bytes[at] != '{') return INPUT_VOLUME;
  size_t word = at + 1; /* a .vgi header begins with a word in braces, which JSON cannot */
  while (word < length && isalnum(bytes[word])) word++;
  return word > at + 1 && word < length && bytes[word] == '}' ? INPUT_VOLUME : INPUT_SCENE;
}

/* Waits until there are bytes to read. Returns false if the user has asked to stop. */
static bool await_bytes(int descriptor) {
  enum { MILLISECONDS_BETWEEN_QUESTIONS = 20 };
  struct pollfd wanted = {.fd = descriptor, .events = POLLIN};
  int ready;
  while ((ready = poll(&wanted, 1, MILLISECONDS_BETWEEN_QUESTIONS)) == 0 || (ready < 0 && errno == EINTR))
    if (host_interrupted()) return false;
  return !host_interrupted();
}

/* Appends the bytes that can be read now. *ended: set to whether there are no more bytes. Returns the exit
 * code. */
static int read_piece(cli_input *input, int descriptor, size_t *capacity, uint64_t limit, bool *ended) {
  enum { LEAST_ROOM = 65536 };
  if (!await_bytes(descriptor)) return fail(EXIT_CODE_INTERRUPTED, "interrupted; nothing was written");
  if (*capacity - input->length < LEAST_ROOM) {
    unsigned char *larger = *capacity > SIZE_MAX / 4 ? NULL
                                                     : realloc(input->bytes, 2 * *capacity + LEAST_ROOM);
    if (larger == NULL)
      return fail(EXIT_CODE_FAILURE, "out of memory: %s has more than %zu bytes", input->title,
                  input->length);
    input->bytes = larger;
    *capacity = 2 * *capacity + LEAST_ROOM;
  }
  ssize_t got = read(descriptor, input->bytes + input->length, *capacity - input->length);
  if (got < 0 && errno != EINTR && errno != EAGAIN)
    return fail(EXIT_CODE_INPUT, "%s: cannot read: %s", input->title, strerror(errno));
  *ended = got == 0;
  if (got > 0) input->length += (size_t)got;
  if (limit > 0 && input->length > limit)
    return fail(EXIT_CODE_FAILURE,
                "out of memory: %s has more than the %llu bytes that may be held of it: raise --max-memory",
                input->title, (unsigned long long)limit);
  return EXIT_CODE_OK;
}

static int read_whole(cli_input *input, int descriptor, uint64_t limit) {
  size_t capacity = 0;
  if (limit == 0) limit = hl_machine_memory() / 2;
  enum { LONGEST_SCENE = 16 << 20 }; /* the library refuses a scene's text with more bytes than this */
  enum { TELLING = 65536 };          /* the first bytes of an input, which suffice to find its kind */
  bool ended = false, scene = false;
  int exit_code = EXIT_CODE_OK;
  while (exit_code == EXIT_CODE_OK && !ended) {
    exit_code = read_piece(input, descriptor, &capacity, limit, &ended);
    if (input->length <= TELLING) scene = kind_by_content(input->bytes, input->length) == INPUT_SCENE;
    if (exit_code == EXIT_CODE_OK && scene && input->length > LONGEST_SCENE)
      exit_code = fail(EXIT_CODE_INPUT, "%s: more than %d bytes, too large for a scene", input->title,
                       (int)LONGEST_SCENE);
  }
  return exit_code;
}

/* ---- kinds of input ---- */

/* Finds the kind of an input by the ending of its name. Returns false if the name does not tell the kind. */
static bool kind_by_name(const char *path, input_kind *kind) {
  static const char *const volumes[] = {".raw",  ".gz",  ".nrrd", ".nhdr", ".mha",  ".mhd", ".vgi",
                                        ".slc",  ".nii", ".vti",  ".vtk",  ".npy",  ".mrc", ".map",
                                        ".ccp4", ".tif", ".tiff", ".rec",  ".nvdb", ".vdb"};
  *kind = has_extension(path, ".json")  ? INPUT_SCENE
          : has_extension(path, ".png") ? INPUT_PICTURE
                                        : INPUT_VOLUME;
  if (*kind != INPUT_VOLUME) return true;
  for (size_t i = 0; i < sizeof volumes / sizeof volumes[0]; i++)
    if (has_extension(path, volumes[i])) return true;
  return false;
}

static int open_pipe(cli_input *input, int descriptor, uint64_t limit) {
  int exit_code = read_whole(input, descriptor, limit);
  input->kind = kind_by_content(input->bytes, input->length);
  return exit_code;
}

static int open_standard_input(cli_input *input, uint64_t limit) {
  input->title = "standard input";
  if (isatty(STDIN_FILENO))
    return fail(EXIT_CODE_USAGE, "'-': standard input is a terminal: give a file, or a pipe");
  return open_pipe(input, STDIN_FILENO, limit);
}

/* Opens an input that is an ordinary file: finds out its kind. Reads the file into memory if it is a picture,
 * or a scene whose path is the name of a stream, because such a path does not tell the folder to which names
 * in the scene are relative. If the file is missing (descriptor < 0), a later reader reports the error. */
static int open_file(cli_input *input, int descriptor, uint64_t limit) {
  unsigned char first[1024];
  ssize_t got = descriptor >= 0 ? pread(descriptor, first, sizeof first, 0) : 0;
  input_kind told = kind_by_content(first, got > 0 ? (size_t)got : 0);
  if (!kind_by_name(input->path, &input->kind)) input->kind = told;
  else if (input->kind == INPUT_PICTURE && told != INPUT_PICTURE && got > 0) input->kind = told;
  bool redirected = input->kind == INPUT_SCENE && hl_plain_is_stream(input->path);
  bool whole = descriptor >= 0 && (input->kind == INPUT_PICTURE || redirected);
  return whole ? read_whole(input, descriptor, limit) : EXIT_CODE_OK;
}

int input_open(const char *path, uint64_t limit, cli_input *input) {
  *input = (cli_input){.path = path, .title = path};
  if (strcmp(path, "-") == 0) return open_standard_input(input, limit);
  int descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  struct stat about;
  bool known = descriptor >= 0 && fstat(descriptor, &about) == 0;
  bool piped = known && (S_ISFIFO(about.st_mode) || S_ISSOCK(about.st_mode));
  int exit_code = piped ? open_pipe(input, descriptor, limit)
                        : open_file(input, known ? descriptor : -1, limit);
  if (descriptor >= 0) close(descriptor);
  return exit_code;
}

void input_close(cli_input *input) {
  free(input->bytes);
  input->bytes = NULL;
}

/* ---- scenes and volumes ---- */

void input_load_options(const cli_value *reading, const cli_value *place, hl_volume_load_options *options) {
  const cli_value *component = &reading[READ_COMPONENT];
  hl_volume_load_options_defaults(options);
  if (reading[READ_ARRAY].given) options->array = reading[READ_ARRAY].text;
  if (reading[READ_SERIES].given) options->series = reading[READ_SERIES].text;
  if (component->given)
    options->component = component->chosen ? component->choice : (int)component->number[0];
  if (reading[READ_TIME].given) options->time = (int)reading[READ_TIME].number[0];
  if (reading[READ_CHANNEL].given) options->channel_name = reading[READ_CHANNEL].text;
  if (reading[READ_LEVEL].given) options->level = (int)reading[READ_LEVEL].number[0];
  if (place[PLACE_SPACING].given)
    memcpy(options->spacing, place[PLACE_SPACING].number, sizeof options->spacing);
  if (place[PLACE_SPACE].given) options->file_space = place[PLACE_SPACE].text;
}

int input_check_place(const cli_value *place) {
  int axis[3];
  double sign[3];
  const cli_value *space = &place[PLACE_SPACE];
  if (!space->given || hl_body_axes_read(space->text, axis, sign)) return EXIT_CODE_OK;
  return fail(EXIT_CODE_USAGE, "--space: '%s': " HL_BODY_AXES_WANTED, space->text);
}

/* The length of a list's first item. */
static size_t item_length(const char *list) { return strcspn(list, ","); }

int input_check_channels(const cli_value *said) {
  size_t count = 0;
  if (!said->given) return EXIT_CODE_OK;
  for (const char *text = said->text;; text += item_length(text) + 1) {
    const size_t length = item_length(text);
    if (length == 0)
      return fail(
          EXIT_CODE_USAGE,
          "--channel: '%s': give a number from 0 on or a name, several as 0,2, or all: halflight info "
          "lists the channels' names",
          said->text);
    if (++count > HL_CHANNELS_MOST)
      return fail(EXIT_CODE_USAGE, "--channel: '%s': a picture shows %d channels at most", said->text,
                  HL_CHANNELS_MOST);
    for (const char *before = said->text; before < text; before += item_length(before) + 1)
      if (item_length(before) == length && memcmp(before, text, length) == 0)
        return fail(EXIT_CODE_USAGE, "--channel: '%s': channel %.*s is there twice", said->text, (int)length,
                    text);
    if (text[length] == '\0') return EXIT_CODE_OK;
  }
}

bool input_has_channels(const cli_value *said) {
  return said->given && (hl_plain_equal(said->text, "all") || strchr(said->text, ',') != NULL);
}

int input_picture_side(void) {
  hl_scene_description description;
  hl_scene_description_defaults(&description);
  return description.width > description.height ? description.width : description.height;
}

int input_check_unit(const cli_value *unit, const hl_volume *volume) {
  const char *told = hl_volume_unit(volume);
  const hl_unit *known = told != NULL ? hl_unit_find(told) : NULL,
                *asked = unit->given ? hl_unit_find(unit->text) : NULL;
  if (!unit->given || known == NULL || (asked != NULL && asked->metres == known->metres)) return EXIT_CODE_OK;
  return fail(EXIT_CODE_USAGE, "--unit: the volume's file tells its unit, %s: --spacing changes distances",
              told);
}

hl_status input_load_volume(hl_context *context, const cli_input *input,
                            const hl_volume_load_options *options, hl_volume **volume, hl_error *error) {
  hl_volume_load_options chosen;
  hl_volume_load_options_defaults(&chosen);
  if (options != NULL) chosen = *options;
  chosen.bytes = input->bytes;
  chosen.byte_count = input->length;
  return hl_volume_load_with(context, input->title, &chosen, volume, error);
}

hl_status input_smooth(double sigma, hl_volume **volume, hl_error *error) {
  hl_volume *smoothed = NULL;
  hl_error own = {0};
  hl_status status = hl_volume_smooth(*volume, sigma, &smoothed, &own);
  if (status != HL_OK) {
    *error = own;
    snprintf(error->message, sizeof error->message, "--smooth: %.900s", own.message);
    return status;
  }
  hl_volume_release(*volume);
  *volume = smoothed;
  return HL_OK;
}

void input_name_source(const hl_volume_load_options *options, hl_scene_volume *volume) {
  volume->array = options->array;
  volume->series = options->series;
  volume->component = options->component;
  volume->time = options->time, volume->channel = options->channel, volume->level = options->level;
  hl_volume_selection read = {.struct_size = sizeof read};
  const bool known = hl_volume_get_selection(volume->volume, &read) == HL_OK;
  if (options->channel_name != NULL && known) volume->channel = read.channel;
  if (options->pixels > 0 && known && read.levels > 1)
    volume->level = read.aim; /* the scene may be drawn in another size */
  memcpy(volume->spacing, options->spacing, sizeof volume->spacing);
  volume->file_space = options->file_space;
}

hl_status input_name_scene(hl_context *context, const hl_volume_load_options *options, hl_scene **scene,
                           hl_error *error) {
  hl_scene_description description = *hl_scene_describe(*scene);
  hl_scene_volume volume = description.volumes[0];
  hl_scene *named = NULL;
  input_name_source(options, &volume);
  description.volumes = &volume;
  hl_status status = hl_scene_create(context, &description, &named, error);
  if (status != HL_OK) return status;
  hl_scene_release(*scene);
  *scene = named;
  return HL_OK;
}

static hl_status load_volume_scene(hl_context *context, const cli_input *input,
                                   const hl_volume_load_options *options, hl_scene **scene, hl_error *error) {
  hl_volume *volume = NULL;
  const char *file = strcmp(input->path, "-") == 0 ? STANDARD_INPUT : input->path;
  hl_status status = input_load_volume(context, input, options, &volume, error);
  if (status == HL_OK && input->smooth != NULL) status = input_smooth(*input->smooth, &volume, error);
  if (status == HL_OK)
    status = hl_scene_for_volume_look(context, volume, file, input->look != NULL ? input->look : "auto",
                                      scene, error);
  if (status == HL_OK && options != NULL) status = input_name_scene(context, options, scene, error);
  hl_volume_release(volume);
  return status;
}

/* Relative file names in a picture's scene are relative to the picture's folder. If one of these files does
 * not exist, all names are relative to the current folder instead, as on the command line that made the
 * picture. */
static hl_status load_picture_scene(hl_context *context, const cli_input *input, hl_scene **scene,
                                    hl_error *error) {
  char *text = NULL, *folder = strdup(input->path);
  hl_error of_folder = {0};
  hl_status status = hl_image_find_scene(context, input->title, input->bytes, input->length, &text, error);
  if (folder != NULL) folder[base_name(folder) - folder] = '\0';
  if (status == HL_OK)
    status = hl_scene_from_json_coarse(context, text, strlen(text), folder, input->title, input->first_pixels,
                                       scene, error);
  if (status == HL_ERROR_IO && folder != NULL && folder[0] != '\0' &&
      hl_scene_from_json_coarse(context, text, strlen(text), NULL, input->title, input->first_pixels, scene,
                                &of_folder) == HL_OK)
    status = HL_OK;
  hl_text_release(context, text);
  free(folder);
  return status;
}

hl_status input_load(hl_context *context, const cli_input *input, const hl_volume_load_options *options,
                     hl_scene **scene, hl_error *error) {
  if (input->kind == INPUT_VOLUME) return load_volume_scene(context, input, options, scene, error);
  if (input->kind == INPUT_PICTURE && input->bytes != NULL)
    return load_picture_scene(context, input, scene, error);
  if (input->bytes == NULL)
    return hl_scene_load_coarse(context, input->path, input->first_pixels, scene, error);
  return hl_scene_from_json_coarse(context, (const char *)input->bytes, input->length, NULL, input->title,
                                   input->first_pixels, scene, error);
}

bool is_mesh_file(hl_context *context, const char *path) {
  return !hl_plain_is_url(path) && hl_mesh_reads_name(context, path) &&
         !hl_volume_reads_cells(context, path) && !hl_volume_reads_particles(context, path);
}

int compare_by_number(const void *a, const void *b) {
  return strverscmp(*(char *const *)a, *(char *const *)b);
}

bool find_installed(const char *const *places, char path[PATH_MAX]) {
  enum { LONGEST = 64 };
  if (!hl_program_path(path, PATH_MAX - LONGEST)) return false;
  char *slash = strrchr(path, '/');
  for (size_t n = 0; slash != NULL && places[n] != NULL; n++) {
    snprintf(slash, LONGEST, "%s", places[n]);
    if (access(path, R_OK) == 0) return true;
  }
  return false;
}
