/* cli/render/series_files.c - finds the files of a series, and makes the scene of each file.
 *
 * The files of a series are volumes, which may be label maps, or meshes. Meshes beside volumes are in every
 * picture. */
#define _GNU_SOURCE
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/frames.h"
#include "cli/input.h"
#include "series.h"
#include "start/joined.h"
#include "text/number_word.h"
#include "text/plain.h"

enum { MOST_LABEL_LAYERS = 64 };

/* ---- names ---- */

static bool is_pattern(const char *path) {
  return strpbrk(path, "*?[") != NULL && !hl_plain_is_url(path) && access(path, F_OK) != 0;
}

bool series_has_number(const char *text) {
  int numbers = 0;
  hl_number_word word;
  for (const char *at = strchr(text, '%'); at != NULL; at = strchr(at + word.length, '%')) {
    if (hl_number_word_read(at, "d", &word)) numbers++;
    else if (at[1] == '%') word.length = 2;
    else return false;
  }
  return numbers == 1;
}

bool render_has_pattern(char **operands) {
  bool pattern = false;
  for (char **operand = operands; *operand != NULL; operand++) pattern = pattern || is_pattern(*operand);
  return pattern;
}

bool render_is_series(const cli_value *values, char **operands) {
  const cli_value *output = &values[RENDER_OUTPUT];
  return render_has_pattern(operands) || values[RENDER_PART].given || values[RENDER_RANKS].given ||
         values[RENDER_RANGE_OF_ALL].given || values[RENDER_TIME].chosen ||
         (output->given && series_has_number(output->text)) ||
         (operands[1] != NULL && output->given && !values[RENDER_VIEWS].given &&
          output_has_name(output->text));
}

static int fail_names(int count) {
  return fail(EXIT_CODE_FAILURE, "out of memory for the names of %d files", count);
}

static int add_file(series_job *job, const char *path) {
  char **larger = realloc(job->files.names, ((size_t)job->files.count + 1) * sizeof *larger);
  if (larger != NULL) job->files.names = larger;
  if (larger == NULL || (larger[job->files.count] = strdup(path)) == NULL)
    return fail_names(job->files.count);
  job->files.count++;
  return EXIT_CODE_OK;
}

static int add_pattern(series_job *job, const char *pattern) {
  glob_t found = {0};
  int answer = glob(pattern, 0, NULL, &found), exit_code = EXIT_CODE_OK;
  if (answer != 0)
    exit_code = answer == GLOB_NOMATCH ? fail(EXIT_CODE_INPUT, "%s: there is no such file", pattern)
                                       : fail(EXIT_CODE_INPUT, "%s: its folder cannot be read", pattern);
  for (size_t n = 0; n < found.gl_pathc && exit_code == EXIT_CODE_OK; n++)
    exit_code = add_file(job, found.gl_pathv[n]);
  globfree(&found);
  return exit_code;
}

/* Decides whether the files of the series are meshes or volumes. Meshes that were named one by one are in
 * every picture, and do not belong to the series, unless there are only meshes. A pattern that finds meshes
 * beside volumes is refused, because nothing says which mesh belongs to which volume. */
static int part_meshes(series_job *job) {
  int meshes = 0;
  for (int n = 0; n < job->files.count; n++) meshes += is_mesh_file(job->host.context, job->files.names[n]);
  job->files.of_meshes = meshes > 0;
  if (meshes == 0 || meshes == job->files.count) return EXIT_CODE_OK;
  return fail(EXIT_CODE_USAGE,
              "a pattern found meshes, and there are volumes: name each mesh that shall be in all pictures "
              "by its whole name");
}

/* A file, and the name of the file's picture. */
typedef struct named_file {
  const char *file;
  char *picture; /* owned */
} named_file;

static int compare_pictures(const void *a, const void *b) {
  const named_file *x = a, *y = b;
  int order = strcmp(x->picture, y->picture);
  return order != 0 ? order : strcmp(x->file, y->file);
}

/* Refuses files whose pictures would have one name. */
static int check_picture_names(const series_job *job) {
  int exit_code = EXIT_CODE_OK, count = 0;
  if (!output_has_name(job->pattern)) return EXIT_CODE_OK;
  named_file *named = calloc((size_t)job->files.count, sizeof *named);
  for (; named != NULL && count < job->files.count; count++) {
    named[count].file = job->files.names[count];
    named[count].picture = output_name_picture(job->pattern, job->files.names[count]);
    if (named[count].picture == NULL) break;
  }
  if (count < job->files.count) exit_code = fail_names(job->files.count);
  else qsort(named, (size_t)count, sizeof *named, compare_pictures);
  for (int n = 1; n < count && exit_code == EXIT_CODE_OK; n++)
    if (strcmp(named[n - 1].picture, named[n].picture) == 0)
      exit_code = fail(EXIT_CODE_USAGE,
                       "'%s' and '%s' would both be drawn to '%s': number the pictures, as in -o '%%04d.png'",
                       named[n - 1].file, named[n].file, named[n].picture);
  for (int n = 0; n < count; n++) free(named[n].picture);
  free(named);
  return exit_code;
}

int series_find_files(series_job *job, char **operands) {
  int exit_code = EXIT_CODE_OK, operand_count = 0;
  for (; operands[operand_count] != NULL && exit_code == EXIT_CODE_OK; operand_count++) {
    char *operand = operands[operand_count];
    if (is_pattern(operand)) exit_code = add_pattern(job, operand);
    else if (is_mesh_file(job->host.context, operand)) job->meshes[job->mesh_count++] = operand;
    else exit_code = add_file(job, operand);
  }
  /* If there is neither a volume nor a pattern, the meshes are the files of the series. */
  if (job->mesh_count == operand_count) {
    job->mesh_count = 0;
    for (int n = 0; n < operand_count && exit_code == EXIT_CODE_OK; n++)
      exit_code = add_file(job, operands[n]);
  }
  job->meshes[job->mesh_count] = NULL;
  if (exit_code == EXIT_CODE_OK) exit_code = part_meshes(job);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  qsort(job->files.names, (size_t)job->files.count, sizeof *job->files.names, compare_by_number);
  job->files.bad = calloc((size_t)job->files.count, sizeof *job->files.bad);
  return job->files.bad != NULL ? check_picture_names(job) : fail(EXIT_CODE_FAILURE, "out of memory");
}

void series_release_files(series_job *job) {
  for (int n = 0; n < job->files.count; n++) free(job->files.names[n]);
  free(job->files.names);
  free(job->files.bad);
}

/* ---- a file's content ---- */

/* Finds the options for reading a file. All files are read at the first file's resolution. They must have the
 * first file's anatomical space (check_space()). */
static void reading_of(const series_job *job, int number, hl_volume_load_options *options) {
  render_load_options(job->values, options);
  if (job->files.of_times) options->time = number;
  if (job->scene != NULL) options->level = hl_scene_describe(job->scene)->volumes[0].level;
  options->preview_pixels = job->host.preview_pixels;
}

static hl_space space_of(const hl_volume *volume) {
  hl_volume_info info = {.struct_size = sizeof info};
  return hl_volume_get_info(volume, &info) == HL_OK ? info.space : HL_SPACE_UNKNOWN;
}

static int check_space(const series_job *job, int number, const hl_volume *volume) {
  if (job->scene == NULL) return EXIT_CODE_OK;
  hl_space space = space_of(volume), first = space_of(hl_scene_describe(job->scene)->volumes[0].volume);
  if (space == first || space == HL_SPACE_UNKNOWN || first == HL_SPACE_UNKNOWN) return EXIT_CODE_OK;
  return fail(EXIT_CODE_INPUT,
              "%s: its axes point elsewhere (RAS or LPS) than those of '%s', the first file: "
              "'halflight convert' both to one format",
              job->files.names[number], job->files.names[job->files.first]);
}

/* Marks the file as bad if the exit code after reading it means a fault of the file. */
static int note(series_job *job, int number, int exit_code) {
  job->files.bad[number] = exit_code == EXIT_CODE_INPUT || exit_code == EXIT_CODE_UNSUPPORTED;
  return exit_code;
}

int series_load_volume(series_job *job, int number, int channel, hl_volume **volume) {
  cli_input input = {0};
  hl_volume_load_options options;
  hl_error error = {0};
  if (job->files.bad[number]) return EXIT_CODE_INPUT;
  reading_of(job, number, &options);
  if (channel >= 0) options.channel = channel, options.channel_name = NULL;
  int exit_code = input_open(job->files.names[number], job->values[RENDER_MAX_MEMORY].bytes, &input);
  if (exit_code == EXIT_CODE_OK) {
    hl_status status = input_load_volume(job->host.context, &input, &options, volume, &error);
    double smooth = job->scene != NULL ? hl_volume_smoothing(hl_scene_describe(job->scene)->volumes[0].volume)
                                       : 0;
    /* a file that is read again, finer, is smoothed as the first file was, also if that was not smoothed */
    const bool again = job->scene != NULL && job->host.preview_pixels > 0;
    if (status == HL_OK && (smooth > 0 || again)) status = input_smooth(smooth, volume, &error);
    if (status != HL_OK) exit_code = host_fail(&job->host, PHASE_READ, status, &error);
  }
  input_close(&input);
  return note(job, number, exit_code);
}

int series_find_times(series_job *job) {
  if (!job->values[RENDER_TIME].chosen) return EXIT_CODE_OK;
  job->values[RENDER_TIME] = (cli_value){.given = true};
  if (job->files.count != 1 || job->files.of_meshes)
    return fail(EXIT_CODE_USAGE, "--time all is for the time steps of one file: give one volume");
  hl_volume *volume = NULL;
  hl_volume_selection selection = {.struct_size = sizeof selection};
  const int channel = input_has_channels(&job->values[RENDER_CHANNEL])
                          ? 0
                          : HL_INDEX_DEFAULT; /* any tells the times */
  int exit_code = series_load_volume(job, 0, channel, &volume);
  if (exit_code == EXIT_CODE_OK && hl_volume_get_selection(volume, &selection) != HL_OK) selection.times = 1;
  hl_volume_release(volume);
  while (exit_code == EXIT_CODE_OK && job->files.count < (int)selection.times)
    exit_code = add_file(job, job->files.names[0]);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  job->files.of_times = true;
  free(job->files.bad);
  job->files.bad = calloc((size_t)job->files.count, sizeof *job->files.bad);
  return job->files.bad != NULL ? check_picture_names(job) : fail_names(job->files.count);
}

/* ---- the scene of a file ---- */

/* Makes a scene like the first file's, but with other volumes; if volumes is null, with another first
 * mesh. */
static hl_status make_scene(const series_job *job, hl_scene_volume *volumes, size_t volume_count,
                            const hl_scene_mesh *mesh, hl_scene **scene, hl_error *error) {
  hl_scene_description description = *hl_scene_describe(job->scene);
  hl_scene_mesh *meshes = mesh != NULL ? calloc(description.mesh_count, sizeof *meshes) : NULL;
  if (mesh != NULL && meshes == NULL) {
    snprintf(error->message, sizeof error->message, "out of memory: %zu meshes", description.mesh_count);
    return error->code = HL_ERROR_MEMORY;
  }
  if (meshes != NULL) {
    memcpy(meshes, description.meshes, description.mesh_count * sizeof *meshes);
    meshes[0] = *mesh;
    description.meshes = meshes;
  } else {
    description.volumes = volumes;
    description.volume_count = volume_count;
  }
  hl_status status = hl_scene_create(job->host.context, &description, scene, error);
  free(meshes);
  return status;
}

/* The number of volumes in the scene that come from the first file: one, or one for each channel. The volumes
 * after them are label maps. */
static size_t volumes_of_file(const series_job *job) {
  const hl_scene_description *description = hl_scene_describe(job->scene);
  size_t count = 1;
  while (input_has_channels(&job->values[RENDER_CHANNEL]) && count < description->volume_count &&
         count < HL_CHANNELS_MOST && description->volumes[count].file != NULL &&
         strcmp(description->volumes[count].file, description->volumes[0].file) == 0)
    count++;
  return count;
}

/* Makes a scene like the first file's, with this file's volumes in place of the first file's. If `loaded` is
 * null, the first file's voxels are kept. Bare label maps get the labels of their own voxels. The label maps
 * of --labels are kept. */
static hl_status scene_of_volumes(const series_job *job, int number, hl_volume *const *loaded,
                                  hl_scene **scene, hl_error *error) {
  const hl_scene_description *description = hl_scene_describe(job->scene);
  hl_scene_volume volumes[HL_CHANNELS_MOST + MOST_LABEL_LAYERS];
  memcpy(volumes, description->volumes, description->volume_count * sizeof *volumes);
  hl_label *labels[HL_CHANNELS_MOST] = {NULL};
  hl_status status = HL_OK;
  for (size_t n = 0; n < volumes_of_file(job) && status == HL_OK; n++) {
    volumes[n].file = job->files.names[number];
    if (job->files.of_times) volumes[n].time = number;
    if (loaded != NULL) volumes[n].volume = loaded[n];
    if (loaded == NULL || volumes[n].label_count == 0) continue;
    status = hl_labels_of_volume(job->host.context, loaded[n], NULL, &labels[n], &volumes[n].label_count,
                                 error);
    volumes[n].labels = labels[n];
  }
  if (status == HL_OK) status = make_scene(job, volumes, description->volume_count, NULL, scene, error);
  for (size_t n = 0; n < HL_CHANNELS_MOST; n++) hl_labels_release(job->host.context, labels[n]);
  return status;
}

static int volume_scene(series_job *job, int number, hl_scene **scene) {
  hl_volume *loaded[HL_CHANNELS_MOST] = {NULL};
  size_t count = volumes_of_file(job);
  hl_error error = {0};
  int exit_code = EXIT_CODE_OK;
  for (size_t n = 0; n < count && exit_code == EXIT_CODE_OK; n++) {
    int channel = count > 1 ? hl_scene_describe(job->scene)->volumes[n].channel : HL_INDEX_DEFAULT;
    exit_code = series_load_volume(job, number, channel, &loaded[n]);
  }
  if (exit_code == EXIT_CODE_OK) exit_code = note(job, number, check_space(job, number, loaded[0]));
  if (exit_code == EXIT_CODE_OK) {
    hl_status status = scene_of_volumes(job, number, loaded, scene, &error);
    if (status != HL_OK) exit_code = note(job, number, host_fail(&job->host, PHASE_READ, status, &error));
  }
  for (size_t n = 0; n < count; n++) hl_volume_release(loaded[n]);
  return exit_code;
}

/* Copies to a layer of a label map the settings that the options gave to the same layer of the first file. */
static void take_settings(const hl_scene_volume *from, hl_scene_volume *layer) {
  hl_scene_volume made = *from;
  made.volume = layer->volume;
  made.file = layer->file;
  made.component = layer->component;
  made.level = layer->level;
  made.labels = layer->labels;
  made.label_count = layer->label_count;
  *layer = made;
}

static int label_scene(series_job *job, int number, hl_scene **scene) {
  const hl_scene_description *description = hl_scene_describe(job->scene);
  hl_scene_volume volumes[MOST_LABEL_LAYERS];
  hl_scene *map = NULL;
  hl_error error = {0};
  hl_volume_load_options options;
  reading_of(job, number, &options);
  hl_status status = render_load_label_map(&job->host, job->values, job->files.names[number], &options, &map,
                                           &error);
  if (status != HL_OK) return note(job, number, host_fail(&job->host, PHASE_READ, status, &error));
  const hl_scene_description *layers = hl_scene_describe(map);
  size_t count = layers->volume_count < MOST_LABEL_LAYERS ? layers->volume_count : MOST_LABEL_LAYERS;
  for (size_t n = 0; n < count; n++) {
    size_t like = n < description->volume_count ? n : description->volume_count - 1;
    volumes[n] = layers->volumes[n];
    take_settings(&description->volumes[like], &volumes[n]);
  }
  int exit_code = count > 0 ? check_space(job, number, volumes[0].volume) : EXIT_CODE_OK;
  if (exit_code == EXIT_CODE_OK) {
    status = make_scene(job, volumes, count, NULL, scene, &error);
    if (status != HL_OK) exit_code = host_fail(&job->host, PHASE_READ, status, &error);
  }
  hl_scene_release(map);
  return note(job, number, exit_code);
}

/* Makes the scene of one file of a series of meshes: this file's mesh replaces the first file's mesh. */
static int mesh_scene(series_job *job, int number, hl_scene **scene) {
  hl_scene_mesh mesh = hl_scene_describe(job->scene)->meshes[0], own;
  hl_error error = {0};
  hl_status status = load_mesh(job->host.context, job->files.names[number], 0, &own, &error);
  mesh.mesh = own.mesh;
  mesh.file = own.file;
  memcpy(mesh.color, own.color, sizeof mesh.color);
  if (status == HL_OK) status = make_scene(job, NULL, 0, &mesh, scene, &error);
  hl_mesh_release(own.mesh);
  return note(job, number,
              status == HL_OK ? EXIT_CODE_OK : host_fail(&job->host, PHASE_READ, status, &error));
}

int series_scene(series_job *job, int number, hl_scene **scene) {
  if (job->files.bad[number]) return EXIT_CODE_INPUT;
  if (job->files.of_meshes) return mesh_scene(job, number, scene);
  return render_is_label_map(job->values) ? label_scene(job, number, scene)
                                          : volume_scene(job, number, scene);
}

int series_go_nearer(series_job *job, int number, hl_scene **scene) {
  return note(job, number, render_go_nearer(&job->host, &hl_scene_describe(*scene)->camera, 1, scene));
}

hl_status series_scene_unread(const series_job *job, int number, hl_scene **scene) {
  hl_scene_mesh mesh;
  hl_error error = {0};
  if (!job->files.of_meshes &&
      (render_is_label_map(job->values) || hl_scene_describe(job->scene)->volumes[0].label_count > 0))
    return HL_ERROR_UNSUPPORTED;
  if (!job->files.of_meshes) return scene_of_volumes(job, number, NULL, scene, &error);
  mesh = hl_scene_describe(job->scene)->meshes[0];
  mesh.file = job->files.names[number];
  return make_scene(job, NULL, 0, &mesh, scene, &error);
}
