/* guess/channels.c - makes one scene of several bare volumes, which are files of one volume each, or channels
 * of one file. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "core/door.h"
#include "core/memory.h"
#include "guess/for_volume.h"
#include "scene/geometry/lengths.h"
#include "scene/geometry/placement.h"
#include "scene/scene.h"
#include "text/plain.h"
#include "text/stem.h"
#include "text/units.h"

enum { NAME_BYTES = 256 };

/* ---- one scene of several ---- */

/* The volumes of the new scene, and their names. */
typedef struct joined_volumes {
  hl_scene_volume *volumes;  /* owned; [count] */
  char (*names)[NAME_BYTES]; /* owned; [count] */
  double *spacings; /* owned; [count]: the distance of sheets, in units of the volume's shortest edge */
  size_t count;
} joined_volumes;

/* Names a volume after its file: a volume of scans/head.nii.gz is named "head". */
static void name_after_file(const hl_scene_volume *volume, size_t index, char name[NAME_BYTES]) {
  size_t length;
  const char *stem = hl_stem(volume->file != NULL ? volume->file : "", &length);
  if (volume->name != NULL) snprintf(name, NAME_BYTES, "%s", volume->name);
  else if (length > 0) snprintf(name, NAME_BYTES, "%.*s", (int)(length < 200 ? length : 200), stem);
  else snprintf(name, NAME_BYTES, "volume%zu", index + 1);
}

static bool is_taken(const joined_volumes *joined, size_t index, const char *name) {
  for (size_t other = 0; other < index; other++)
    if (strcmp(joined->names[other], name) == 0) return true;
  return false;
}

static void name_volume(joined_volumes *joined, size_t index) {
  char stem[NAME_BYTES], *name = joined->names[index];
  name_after_file(&joined->volumes[index], index, stem);
  snprintf(name, NAME_BYTES, "%s", stem);
  for (size_t copy = 2; is_taken(joined, index, name); copy++)
    snprintf(name, NAME_BYTES, "%.230s-%zu", stem, copy);
  joined->volumes[index].name = name;
}

/* The length of a volume's shortest voxel edge, in the world. */
static double shortest_edge(const hl_scene_volume *volume) {
  return mat3_shortest_column(hl_scene_volume_index_to_world(volume).linear);
}

/* The distance between a scene's sheets, in the world. */
static double sheet_distance(const hl_scene_description *description) {
  return description->render.sheet_spacing * hl_scene_smallest_edge(description);
}

/* The length of the diagonal of the box around all volumes. */
static double diagonal_of(const hl_scene_description *description) {
  vec3 low, high;
  hl_scene_content_box(description, &low, &high);
  return vec3_length(vec3_subtract(high, low));
}

/* Warns if the small voxels of one volume make many sheets in a much larger volume, because a frame's time
 * grows with the number of its sheets. */
static void tell_of_sheets(hl_scene *const *scenes, size_t count, const hl_scene_description *joined) {
  const double edge = hl_scene_smallest_edge(joined), sheets = diagonal_of(joined) / sheet_distance(joined);
  double most = 0, greatest = 0;
  for (size_t n = 0; n < count; n++) {
    const hl_scene_description *own = &scenes[n]->description;
    most = fmax(most, diagonal_of(own) / sheet_distance(own));
  }
  for (size_t v = 0; v < joined->volume_count; v++)
    greatest = fmax(greatest, shortest_edge(&joined->volumes[v]));
  if (sheets > HL_MANY_SHEETS && sheets > 2 * most)
    hl_log(
        scenes[0]->description.volumes[0].volume->context, HL_LOG_WARNING,
        "about %.0f sheets, since the smallest voxel edges of the volumes are %.3g and %.3g: "
        "--sheet-spacing 1 makes about %.0f; where a file tells a wrong unit, write \"spacing\" beside the "
        "\"file\" in a scene",
        sheets, edge, greatest, diagonal_of(joined) / edge);
}

double hl_scene_joined_spacing(const hl_scene_description *description, const double *spacings) {
  HL_DOOR;
  if (description == NULL || spacings == NULL) return 0;
  double distance = INFINITY, shortest = INFINITY;
  for (size_t n = 0; n < description->volume_count; n++) {
    const double edge = shortest_edge(&description->volumes[n]);
    distance = fmin(distance, spacings[n] * edge);
    shortest = fmin(shortest, edge);
  }
  if (description->volume_count == 0 || !(shortest > 0)) return description->render.sheet_spacing;
  return round(1e6 * distance / shortest) / 1e6;
}

/* Converts the lengths of a volume to the unit of another world. */
static void convert_lengths(double factor, hl_scene_volume *volume) {
  if (factor == 1) return;
  volume->scale *= factor;
  for (int axis = 0; axis < 3; axis++) volume->translate[axis] *= factor;
  volume->transfer_function.unit_distance *= factor;
}

/* The unit of lengths of the first scene whose files tell a unit, in metres; 0 if no file tells a unit. */
static double common_metres(hl_scene *const *scenes, size_t count) {
  double metres = 0;
  for (size_t n = 0; n < count && !(metres > 0); n++) metres = hl_scene_world_metres(&scenes[n]->description);
  return metres;
}

static hl_status describe_joined(hl_scene *const *scenes, size_t count, joined_volumes *joined,
                                 hl_scene_description *description, hl_error *error) {
  hl_view view;
  const double common = common_metres(scenes, count);
  for (size_t n = 0; n < count; n++) {
    const hl_scene_description *own = &scenes[n]->description;
    const double metres = hl_scene_world_metres(own);
    for (size_t v = 0; v < own->volume_count; v++) {
      joined->volumes[joined->count] = own->volumes[v];
      joined->spacings[joined->count] = sheet_distance(own) / shortest_edge(&own->volumes[v]);
      if (metres > 0) convert_lengths(hl_length_ratio(metres, common), &joined->volumes[joined->count]);
      name_volume(joined, joined->count++);
    }
  }
  description->volumes = joined->volumes;
  description->volume_count = joined->count;
  description->render.sheet_spacing = hl_scene_joined_spacing(description, joined->spacings);
  tell_of_sheets(scenes, count, description);
  hl_status status = hl_view_choose(description, HL_SIDE_AUTOMATIC, NULL, &view, error);
  return status == HL_OK ? hl_camera_frame_view(description, &view, 1, &description->camera, error) : status;
}

hl_status hl_scene_join(hl_context *context, hl_scene *const *scenes, size_t count, hl_scene **scene,
                        hl_error *error) {
  HL_DOOR;
  if (scene != NULL) *scene = NULL;
  if (context == NULL || scenes == NULL || count == 0 || scene == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_scene_join: null context, scenes or scene, or no scene");
  size_t total = 0;
  for (size_t n = 0; n < count; n++) {
    if (scenes[n] == NULL || scenes[n]->description.volume_count == 0)
      return hl_fail(error, HL_ERROR_ARGUMENT, "hl_scene_join: scene %zu is null or has no volume", n);
    total += scenes[n]->description.volume_count;
  }
  hl_scene_description description = scenes[0]->description;
  joined_volumes joined = {.volumes = hl_allocate(context, total, sizeof *joined.volumes),
                           .names = hl_allocate(context, total, NAME_BYTES),
                           .spacings = hl_allocate(context, total, sizeof *joined.spacings)};
  const size_t bytes = sizeof *joined.volumes + NAME_BYTES + sizeof *joined.spacings;
  hl_status status = joined.volumes != NULL && joined.names != NULL && joined.spacings != NULL
                         ? describe_joined(scenes, count, &joined, &description, error)
                         : hl_fail_memory(error, total * bytes, "volumes");
  if (status == HL_OK) status = hl_scene_create(context, &description, scene, error);
  hl_release(context, joined.volumes);
  hl_release(context, joined.names);
  hl_release(context, joined.spacings);
  return status;
}

/* ---- colours ---- */

/* Finds the colour that a volume's file gives the channel from which the volume was read. Returns false if
 * the file gives the channel no colour. */
static bool told_color(const hl_volume *volume, double srgb[3]) {
  if (volume == NULL || volume->channels == NULL) return false;
  const hl_channel *channel = &volume->channels[volume->selection.channel];
  if (channel->has_color) memcpy(srgb, channel->srgb, sizeof channel->srgb);
  return channel->has_color;
}

/* Returns whether the files give each volume a colour, and no two volumes the same colour. */
static bool colors_differ(const hl_scene_description *description) {
  double own[3], other[3];
  for (size_t n = 0; n < description->volume_count; n++) {
    if (!told_color(description->volumes[n].volume, own)) return false;
    for (size_t m = 0; m < n; m++)
      if (told_color(description->volumes[m].volume, other) && memcmp(own, other, sizeof own) == 0)
        return false;
  }
  return true;
}

hl_status hl_scene_channel_color(const hl_scene_description *description, size_t index, double srgb[3]) {
  HL_DOOR;
  static const unsigned char list[][3] = {{0, 255, 0},   {255, 0, 255}, {0, 255, 255},
                                          {255, 255, 0}, {255, 64, 0},  {64, 96, 255}};
  if (description == NULL || srgb == NULL || index >= description->volume_count) return HL_ERROR_ARGUMENT;
  if (colors_differ(description) && told_color(description->volumes[index].volume, srgb)) return HL_OK;
  for (int c = 0; c < 3; c++) srgb[c] = list[index % (sizeof list / sizeof *list)][c] / 255.0;
  return HL_OK;
}

/* ---- channels of a file ---- */

/* The scenes of single channels, while they are made. */
typedef struct channel_scenes {
  hl_context *context;
  const char *path, *look;
  const double *smooth; /* the smoothing of each channel, in voxels; null: what the data need */
  hl_volume_load_options options;
  hl_scene *scenes[HL_CHANNELS_MOST]; /* owned */
  size_t count;
} channel_scenes;

/* Writes into the scene of a channel the options by which its volume was read, and the volume's name. */
static hl_status name_channel(channel_scenes *made, const hl_volume *volume, hl_scene **scene,
                              hl_error *error) {
  char numbered[24];
  hl_scene_description description = (*scene)->description;
  hl_scene_volume named = description.volumes[0];
  const hl_volume_load_options *options = &made->options;
  int channel = volume->selection.channel;
  bool is_named = volume->channels != NULL && volume->channels[channel].name[0] != 0;
  snprintf(numbered, sizeof numbered, "channel%d", channel);
  named.name = is_named ? volume->channels[channel].name : numbered;
  named.array = options->array, named.series = options->series, named.component = options->component;
  named.time = options->time, named.channel = channel, named.level = options->level;
  if (volume->selection.levels > 1) named.level = volume->selection.aim;
  memcpy(named.spacing, options->spacing, sizeof named.spacing);
  named.file_space = options->file_space;
  description.volumes = &named;
  hl_scene *with_name = NULL;
  hl_status status = hl_scene_create(made->context, &description, &with_name, error);
  if (status != HL_OK) return status;
  hl_scene_release(*scene);
  *scene = with_name;
  return HL_OK;
}

/* Refuses a channel that has a scene already, whether its number or its name was given. */
static hl_status refuse_again(const channel_scenes *made, const hl_volume *volume, hl_error *error) {
  for (size_t n = 0; n < made->count; n++)
    if (made->scenes[n]->description.volumes[0].channel == volume->selection.channel)
      return hl_fail(error, HL_ERROR_ARGUMENT, "%s: channel %d is there twice", made->path,
                     volume->selection.channel);
  return HL_OK;
}

/* Replaces the volume of a channel by the smoothed volume that was asked for. */
static hl_status smooth_channel(const channel_scenes *made, hl_volume **volume, hl_error *error) {
  hl_volume *smoothed = NULL;
  hl_error own = {0};
  hl_status status = hl_volume_smooth(*volume, *made->smooth, &smoothed, &own);
  if (status != HL_OK)
    return hl_fail(error, status, "%s: channel %d: %s", made->path, (*volume)->selection.channel,
                   own.message);
  hl_volume_release(*volume);
  *volume = smoothed;
  return HL_OK;
}

/* Makes the scene of a channel. name: its number or its name. *channels: set to the number of channels that
 * the file has. */
static hl_status add_channel(channel_scenes *made, const char *name, size_t *channels, hl_error *error) {
  hl_volume *volume = NULL;
  hl_scene *scene = NULL;
  made->options.channel_name = name;
  hl_status status = hl_volume_load_with(made->context, made->path, &made->options, &volume, error);
  if (status == HL_OK) {
    *channels = volume->selection.channels;
    status = refuse_again(made, volume, error);
  }
  if (status == HL_OK && made->smooth != NULL) status = smooth_channel(made, &volume, error);
  if (status == HL_OK)
    status = hl_scene_for_volume_look(made->context, volume, made->path, made->look, &scene, error);
  if (status == HL_OK) status = name_channel(made, volume, &scene, error);
  hl_volume_release(volume);
  if (status == HL_OK) made->scenes[made->count++] = scene;
  else hl_scene_release(scene);
  return status;
}

static hl_status add_all(channel_scenes *made, hl_error *error) {
  size_t all = 1;
  hl_status status = HL_OK;
  for (size_t n = 0; status == HL_OK && n < all; n++) {
    char number[24];
    snprintf(number, sizeof number, "%zu", n);
    status = add_channel(made, number, &all, error);
    if (status == HL_OK && all > HL_CHANNELS_MOST)
      status = hl_fail(error, HL_ERROR_INPUT,
                       "%s: it has %zu channels, and a picture shows %d at most: choose by \"channel\" "
                       "(--channel 0,2)",
                       made->path, all, HL_CHANNELS_MOST);
  }
  return status;
}

/* The length of the longest beginning of a list that ends before a comma and is shorter than `below`; 0 if
 * the list has no such beginning. */
static size_t shorter_beginning(const char *list, size_t below) {
  while (below > 0 && list[--below] != ',') {}
  return below;
}

/* Makes the scene of the channel that a list begins with. The name of a channel may hold commas. The longest
 * beginning of the list that is a channel's name counts. If no beginning is a channel's name, the error is
 * about the shortest beginning. *length: the length of the name. */
static hl_status add_first(channel_scenes *made, const char *list, size_t *length, hl_error *error) {
  hl_status status;
  char name[HL_CHANNEL_NAME_BYTES];
  size_t unused, shortest = strcspn(list, ",");
  if (shortest == 0 || shortest >= sizeof name)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_scene_for_channels: an empty or too long name of a channel in the list");
  for (*length = strlen(list);; *length = shorter_beginning(list, *length)) {
    if (*length >= sizeof name) continue;
    memcpy(name, list, *length);
    name[*length] = 0;
    status = add_channel(made, name, &unused, error);
    if (status == HL_OK || *length == shortest) return status;
  }
}

/* Makes the scenes of the channels that a list names. */
static hl_status add_listed(channel_scenes *made, const char *list, hl_error *error) {
  for (;;) {
    size_t length = 0;
    if (made->count == HL_CHANNELS_MOST)
      return hl_fail(error, HL_ERROR_ARGUMENT, "hl_scene_for_channels: give %d channels at most",
                     HL_CHANNELS_MOST);
    hl_status status = add_first(made, list, &length, error);
    if (status != HL_OK || list[length] == 0) return status;
    list += length + 1;
  }
}

/* Gives each volume the colour of its channel, which replaces the colours of its look. */
static hl_status color_channels(hl_context *context, hl_scene **scene, hl_error *error) {
  hl_scene_description description = (*scene)->description;
  hl_scene_volume volumes[HL_CHANNELS_MOST];
  hl_color_point colors[HL_CHANNELS_MOST];
  hl_scene *colored = NULL;
  for (size_t n = 0; n < description.volume_count; n++) {
    volumes[n] = description.volumes[n];
    double srgb[3];
    hl_status status = hl_scene_channel_color(&description, n, srgb);
    if (status != HL_OK) return hl_fail(error, status, "hl_scene_for_channels: channel %zu has no colour", n);
    colors[n] = (hl_color_point){.value = 0};
    for (int c = 0; c < 3; c++) colors[n].color[c] = hl_srgb_decode(srgb[c]);
    volumes[n].transfer_function.color = &colors[n];
    volumes[n].transfer_function.color_count = 1;
  }
  description.volumes = volumes;
  hl_status status = hl_scene_create(context, &description, &colored, error);
  if (status != HL_OK) return status;
  hl_scene_release(*scene);
  *scene = colored;
  return HL_OK;
}

hl_status hl_scene_for_channels(hl_context *context, const char *path, const hl_volume_load_options *options,
                                const char *channels, const double *smooth, const char *look,
                                hl_scene **scene, hl_error *error) {
  HL_DOOR;
  if (scene != NULL) *scene = NULL;
  if (context == NULL || path == NULL || look == NULL || scene == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_scene_for_channels: null context, path, look or scene");
  channel_scenes made = {.context = context, .path = path, .look = look, .smooth = smooth};
  hl_volume_load_options_defaults(&made.options);
  if (options != NULL) made.options = *options;
  made.options.channel = HL_INDEX_DEFAULT;
  const bool all = channels == NULL || hl_plain_equal(channels, "all");
  hl_status status = all ? add_all(&made, error) : add_listed(&made, channels, error);
  if (status == HL_OK) status = hl_scene_join(context, made.scenes, made.count, scene, error);
  if (status == HL_OK && made.count > 1) status = color_channels(context, scene, error);
  for (size_t n = 0; n < made.count; n++) hl_scene_release(made.scenes[n]);
  if (status != HL_OK) {
    hl_scene_release(*scene);
    *scene = NULL;
  }
  return status;
}
