/* volume/formats/format.c - functions that the readers of all formats share, which choose an array and a
 * component, and find types by their names. */
#include "volume/formats/format.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "text/plain.h"
#include "volume/colors.h"
#include "volume/convert.h"
#include "volume/io/text.h"

hl_status hl_arrays_add(hl_load_request *request, const char *name, size_t components, hl_voxel_type type,
                        bool of_cells, hl_error *error) {
  if (request->arrays == NULL)
    request->arrays = hl_allocate_zeroed(request->context, HL_ARRAYS_MOST, sizeof *request->arrays);
  if (request->arrays == NULL)
    return hl_fail_memory(error, HL_ARRAYS_MOST * sizeof *request->arrays, "a list of arrays");
  request->more = request->array_count == HL_ARRAYS_MOST;
  if (request->more) return HL_OK;
  char *copy = hl_copy_text(request->context, name);
  if (copy == NULL) return hl_fail_memory(error, strlen(name) + 1, "the name of an array");
  request->arrays[request->array_count++] = (hl_array_entry){
      .name = copy, .components = components, .type = type, .of_cells = of_cells};
  return HL_OK;
}

/* Writes a list of arrays as a text: "density; velocity (3 components); ...". */
static void list_arrays(const hl_load_request *request, char *text, size_t size) {
  enum { NAMED = 12 };
  size_t used = 0;
  text[0] = 0;
  for (size_t n = 0; n < request->array_count && n < NAMED && used < size; n++) {
    const hl_array_entry *array = &request->arrays[n];
    char shown[HL_PRINTABLE_BYTES], components[40] = "";
    if (array->components > 1)
      snprintf(components, sizeof components, " (%zu components)", array->components);
    used += (size_t)snprintf(
        text + used, size - used, "%s%s%s%s%s", n > 0 ? "; " : "",
        array->name[0] != 0 ? hl_text_printable(shown, array->name) : "one without a name", components,
        array->of_cells ? " of cells" : "", array->type == 0 ? " (not read)" : "");
  }
  if (request->array_count > NAMED && used < size) snprintf(text + used, size - used, "; ...");
}

static hl_status choose_named(hl_load_request *request, const char *path, hl_error *error) {
  for (int cells = 0; cells < 2; cells++)
    for (size_t n = 0; n < request->array_count; n++)
      if (request->arrays[n].of_cells == (cells == 1) &&
          strcmp(request->arrays[n].name, request->array) == 0) {
        request->chosen = n;
        return HL_OK;
      }
  char list[600], shown[HL_PRINTABLE_BYTES];
  list_arrays(request, list, sizeof list);
  return hl_fail(error, HL_ERROR_INPUT, "%s: there is no array \"%s\": there is %s%s", path,
                 hl_text_printable(shown, request->array), list,
                 strchr(request->array, ',') != NULL
                     ? ": a volume shows one array; a scene shows several, by a volume for each"
                     : "");
}

/* Returns whether VTK uses an array to mark points and cells that are duplicates or hidden. An array of such
 * marks cannot be the volume. */
static bool is_ghost(const hl_array_entry *array) {
  return hl_text_is_one_of(array->name, "vtkGhostType|vtkGhostLevels|vtkValidPointMask");
}

/* Chooses the array to read if the caller names none. An array of the numbers of points or cells is chosen
 * only if the file has no other array. */
static size_t choose_default(const hl_load_request *request) {
  for (int cells = 0; cells < 2; cells++)
    for (size_t n = 0; n < request->array_count; n++) {
      const hl_array_entry *array = &request->arrays[n];
      if (array->of_cells == (cells == 1) && array->components == 1 && array->type != 0 && !is_ghost(array) &&
          !array->is_id)
        return n;
    }
  for (size_t n = 0; n < request->array_count; n++)
    if (request->arrays[n].type != 0 && !is_ghost(&request->arrays[n]) && !request->arrays[n].is_id) return n;
  for (size_t n = 0; n < request->array_count; n++)
    if (request->arrays[n].type != 0 && !is_ghost(&request->arrays[n])) return n;
  return 0;
}

hl_status hl_arrays_choose(hl_load_request *request, const char *path, int active, hl_error *error) {
  if (request->array != NULL) return choose_named(request, path, error);
  bool usable = active >= 0 && (size_t)active < request->array_count && !is_ghost(&request->arrays[active]);
  request->chosen = usable ? (size_t)active : choose_default(request);
  if (request->array_count < 2) return HL_OK;
  char list[600], shown[HL_PRINTABLE_BYTES];
  list_arrays(request, list, sizeof list);
  const char *name = request->arrays[request->chosen].name;
  snprintf(request->array_told, sizeof request->array_told,
           "%.200s: of %zu arrays%s, %s is taken: name another by \"array\" (--array, or --color-by "
           "FILE:ARRAY): %s",
           path, request->array_count, request->more ? " and more" : "",
           name[0] != 0 ? hl_text_printable(shown, name) : "the one without a name", list);
  return HL_OK;
}

/* Chooses one of `count` times, channels or levels. The choice is the wanted time, channel or level, or the
 * first if the caller wants none. */
static hl_status choose_step(const char *path, const char *kind, int wanted, size_t count, int *chosen,
                             hl_error *error) {
  if (wanted >= 0 && (size_t)wanted >= count && count <= 1)
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: there is no %s %d: the file has one, 0: leave \"%s\" (--%s) out", path, kind, wanted,
                   kind, kind);
  if (wanted >= 0 && (size_t)wanted >= count)
    return hl_fail(error, HL_ERROR_INPUT, "%s: there is no %s %d: choose 0 to %zu", path, kind, wanted,
                   count - 1);
  *chosen = wanted >= 0 ? wanted : 0;
  return HL_OK;
}

/* Writes a warning that names the time step and the channel that were chosen by default, if the file has
 * several. */
static void tell_of_steps(hl_load_request *request, const char *path) {
  const hl_selection *selection = &request->selection;
  char counts[2][40] = {"", ""};
  const bool time = selection->times > 1 && request->time<0, channel = selection->channels> 1 &&
                    request->channel < 0 && request->channel_name == NULL,
             both = time && channel;
  if (!time && !channel) return;
  if (time) snprintf(counts[0], sizeof counts[0], "%zu time steps", selection->times);
  if (channel) snprintf(counts[1], sizeof counts[1], "%zu channels", selection->channels);
  snprintf(request->selection_told, sizeof request->selection_told,
           "%.200s: %s%s%s: %s%s%s %s taken: choose by %s%s%s", path, counts[0], both ? " and " : "",
           counts[1], time ? "time 0" : "", both ? " and " : "", channel ? "channel 0" : "",
           both ? "are" : "is", time ? "\"time\" (--time)" : "", both ? " and " : "",
           channel ? "\"channel\" (--channel)" : "");
}

/* Converts a text of digits to a number; -1 for any other text. */
static int number_of(const char *text) {
  enum { DIGITS_MOST = 9 };
  const size_t digits = strspn(text, "0123456789");
  return digits > 0 && digits <= DIGITS_MOST && text[digits] == 0 ? atoi(text) : -1;
}

/* If the text that names the wanted channel is the number of a channel in the file, chooses the channel by
 * this number. */
static void take_number(hl_load_request *request, size_t channels) {
  const int number = request->channel_name != NULL ? number_of(request->channel_name) : -1;
  if (number < 0 || (size_t)number >= channels) return;
  request->channel = number;
  request->channel_name = NULL;
}

hl_status hl_steps_choose(hl_load_request *request, const char *path, size_t times, size_t channels,
                          hl_error *error) {
  hl_selection *selection = &request->selection;
  selection->times = times;
  selection->channels = channels;
  take_number(request, channels);
  hl_status status = choose_step(path, "time", request->time, times, &selection->time, error);
  if (status == HL_OK)
    status = choose_step(path, "channel", request->channel, channels, &selection->channel, error);
  if (status == HL_OK) tell_of_steps(request, path);
  return status;
}

/* ---- channels ---- */

hl_status hl_channels_make(hl_load_request *request, hl_error *error) {
  size_t count = request->selection.channels;
  hl_release(request->context, request->channels);
  request->channels = hl_allocate_zeroed(request->context, count, sizeof *request->channels);
  return request->channels != NULL ? HL_OK
                                   : hl_fail_memory(error, count * sizeof *request->channels, "channels");
}

void hl_channel_name(hl_channel *channel, const char *name) {
  snprintf(channel->name, sizeof channel->name, "%s", name);
  for (char *c = channel->name; *c != 0; c++)
    if ((unsigned char)*c < ' ' || *c == 0x7f) *c = '?';
}

/* Writes the names of the channels as ", or by name: DAPI, GFP"; "" if the channels have no names. */
static void list_channels(const hl_load_request *request, char *list, size_t size) {
  size_t used = 0;
  list[0] = 0;
  for (size_t n = 0; request->channels != NULL && n < request->selection.channels && used < size; n++) {
    const char *name = request->channels[n].name;
    if (name[0] != 0)
      used += (size_t)snprintf(list + used, size - used, "%s%s", used == 0 ? ", or by name: " : ", ", name);
  }
}

hl_status hl_channel_check(hl_load_request *request, const char *path, hl_error *error) {
  char list[600];
  const size_t count = request->selection.channels;
  take_number(request, count);
  const char *name = request->channel_name;
  if (name == NULL) return HL_OK;
  const char *quote = number_of(name) >= 0 ? "" : "'";
  list_channels(request, list, sizeof list);
  if (count <= 1)
    return hl_fail(
        error, HL_ERROR_INPUT,
        "%s: there is no channel %s%.100s%s: the file has one, 0%s: leave \"channel\" (--channel) out", path,
        quote, name, quote, list);
  return hl_fail(error, HL_ERROR_INPUT, "%s: there is no channel %s%.100s%s: choose 0 to %zu%s", path, quote,
                 name, quote, count - 1, list);
}

hl_status hl_channel_find(hl_load_request *request, const char *path, hl_error *error) {
  if (request->channel_name == NULL) return HL_OK;
  for (int exact = 1; exact >= 0; exact--)
    for (size_t n = 0; n < request->selection.channels; n++) {
      const char *name = request->channels[n].name;
      if (name[0] == 0) continue;
      if (!(exact ? strcmp(name, request->channel_name) == 0 : hl_plain_equal(name, request->channel_name)))
        continue;
      request->channel = request->selection.channel = (int)n;
      request->channel_name = NULL;
      return HL_OK;
    }
  return hl_channel_check(request, path, error);
}

/* ---- levels ---- */

/* The greatest number of voxels of a level that is chosen by default. A larger level would take minutes to
 * read, and would not change a picture that is a thousand pixels wide. */
static const uint64_t VOXELS_OF_A_PICTURE = (uint64_t)1 << 30;

/* The number of voxels along the longest axis of a level. */
static size_t longest_axis(const hl_level_size *level) {
  size_t longest = 0;
  for (int axis = 0; axis < 3; axis++)
    if (level->dimensions[axis] > longest) longest = level->dimensions[axis];
  return longest;
}

/* Returns whether a level is fine enough for a picture: the number of voxels along its longest axis is at
 * least the number of pixels along the picture's longer side. */
static bool fills_picture(const hl_level_size *level, int pixels) {
  return longest_axis(level) >= (size_t)pixels;
}

/* The number of voxels of a level; UINT64_MAX on overflow. */
static uint64_t level_voxels(const hl_level_size *level) {
  uint64_t voxels = 1;
  for (int axis = 0; axis < 3; axis++)
    if (__builtin_mul_overflow(voxels, level->dimensions[axis], &voxels)) return UINT64_MAX;
  return voxels;
}

static uint64_t level_bytes(const hl_level_size *level) {
  uint64_t bytes;
  return __builtin_mul_overflow(level_voxels(level), hl_storage_bytes(hl_voxel_type_storage(level->type)),
                                &bytes)
             ? UINT64_MAX
             : bytes;
}

/* Returns the coarsest level that has at least as many voxels along its longest axis as the picture has
 * pixels, or `level` if no coarser level has. If the number of pixels is 0, the result is `level`. */
static size_t coarsest_for(int pixels, const hl_level_size *levels, size_t count, size_t level) {
  while (level + 1 < count && pixels > 0 && fills_picture(&levels[level + 1], pixels)) level++;
  return level;
}

/* Sets the level to read, and the coarser level of the first picture. */
static void aim_at(hl_load_request *request, const hl_level_size *levels, size_t level) {
  hl_selection *selection = &request->selection;
  selection->aim = (int)level;
  selection->level = (int)coarsest_for(request->preview_pixels, levels, selection->levels, level);
}

hl_status hl_level_choose(hl_load_request *request, const char *path, const hl_level_size *levels,
                          size_t count, hl_error *error) {
  hl_selection *selection = &request->selection;
  hl_resolutions *resolutions = &request->resolutions;
  uint64_t limit = request->context->options.memory_limit;
  selection->levels = count;
  resolutions->is_chosen = request->level >= 0;
  for (size_t n = 0; n < count && n < HL_RESOLUTIONS_MOST; n++)
    resolutions->longest[n] = longest_axis(&levels[n]);
  hl_status status = choose_step(path, "level", request->level, count, &selection->level, error);
  if (status != HL_OK || request->level >= 0) {
    aim_at(request, levels, (size_t)selection->level);
    return status;
  }
  size_t level = 0;
  while (level + 1 < count && limit > 0 && level_bytes(&levels[level]) > limit / 2) level++;
  size_t by_memory = level;
  while (level + 1 < count && level_voxels(&levels[level]) > VOXELS_OF_A_PICTURE) level++;
  resolutions->finest = (int)level;
  level = coarsest_for(request->pixels, levels, count, level);
  aim_at(request, levels, level);
  if (level > 0)
    hl_log(request->context, HL_LOG_WARNING,
           "%.300s: level %zu of %zu is taken, %s: choose by \"level\" (--level)", path, level, count,
           level > by_memory ? "as fine as the picture shows"
                             : "the finest that the memory limit leaves room for");
  return HL_OK;
}

/* Refuses a time, a channel or a level that the file does not have. */
static hl_status check_steps(const hl_load_request *request, const char *path, hl_error *error) {
  const hl_selection *selection = &request->selection;
  int unused;
  hl_status status = choose_step(path, "time", request->time, selection->times, &unused, error);
  if (status == HL_OK)
    status = choose_step(path, "channel", request->channel, selection->channels, &unused, error);
  return status == HL_OK ? choose_step(path, "level", request->level, selection->levels, &unused, error)
                         : status;
}

/* Chooses the default component, and writes a warning that names the component. If the component is the
 * colours, no warning is written. */
static int default_component(hl_load_request *request, const char *path, bool is_series,
                             const hl_payload *payload) {
  size_t components = payload->components;
  if (!is_series && payload->colors == HL_COLORS_MEANT && hl_can_be_colors(payload->grid.type, components))
    return HL_COMPONENT_COLOR;
  bool magnitude = !is_series && components <= 3;
  if (is_series)
    snprintf(request->component_told, sizeof request->component_told,
             "%.200s: a series of volumes: the first, 0, is taken: choose by \"time\" (--time): 0 to %zu",
             path, components - 1);
  else
    snprintf(request->component_told, sizeof request->component_told,
             "%.200s: voxels of several components: %s is taken: choose by \"component\" (--component): 0 to "
             "%zu, or magnitude",
             path, magnitude ? "their magnitude" : "component 0", components - 1);
  return magnitude ? HL_COMPONENT_MAGNITUDE : 0;
}

/* If the components are a series, finds the component of the caller's time and channel. *wanted: set to this
 * component. */
static hl_status component_of_steps(hl_load_request *request, const char *path, bool is_series,
                                    const hl_payload *payload, int *wanted, hl_error *error) {
  hl_selection *selection = &request->selection;
  if (selection->times == 1 && selection->channels == 1 && is_series) selection->times = payload->components;
  take_number(request, selection->channels);
  hl_status status = check_steps(request, path, error);
  bool named = is_series && ((request->time >= 0 && selection->times > 1) ||
                             (request->channel >= 0 && selection->channels > 1));
  if (status != HL_OK || !named) return status;
  if (request->component != HL_COMPONENT_DEFAULT)
    return hl_fail(
        error, HL_ERROR_INPUT,
        "%s: its components are its time steps and channels: leave \"component\" (--component) out", path);
  int time = request->time >= 0 ? request->time : 0, channel = request->channel >= 0 ? request->channel : 0;
  int first; /* index of the component that holds the channel's first time step */
  if (!__builtin_mul_overflow(selection->times, channel, &first) &&
      !__builtin_add_overflow(first, time, wanted))
    return HL_OK;
  return hl_fail(error, HL_ERROR_UNSUPPORTED,
                 "%s: time %d of channel %d lies too far in the file: save it as a file of its own", path,
                 time, channel);
}

hl_status hl_component_choose(hl_load_request *request, const char *path, bool is_series, hl_payload *payload,
                              hl_error *error) {
  size_t components = payload->components;
  int wanted = request->component;
  hl_status status = component_of_steps(request, path, is_series, payload, &wanted, error);
  if (status != HL_OK) return status;
  if (components == 1 && (wanted == HL_COMPONENT_DEFAULT || wanted == 0)) {
    payload->component = request->chosen_component = 0;
    return HL_OK;
  }
  if (components == 1)
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: its voxels have one component, 0: leave \"component\" (--component) out", path);
  if (wanted == HL_COMPONENT_DEFAULT) wanted = default_component(request, path, is_series, payload);
  if (hl_component_is_colors(wanted) &&
      (is_series || payload->colors == HL_COLORS_UNREAD || !hl_can_be_colors(payload->grid.type, components)))
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: %zu components of %s are not read as colours: these are 3 or 4 of uint8 or uint16: "
                   "choose another by \"component\" (--component)",
                   path, components, hl_voxel_type_name(payload->grid.type));
  if (wanted != HL_COMPONENT_MAGNITUDE && !hl_component_is_colors(wanted) &&
      (wanted < 0 || (size_t)wanted >= components))
    return hl_fail(error, HL_ERROR_INPUT, "%s: there is no component %d: choose 0 to %zu, or magnitude", path,
                   wanted, components - 1);
  payload->component = request->chosen_component = wanted;
  if (is_series && wanted >= 0) {
    request->selection.time = (int)((size_t)wanted % request->selection.times);
    request->selection.channel = (int)((size_t)wanted / request->selection.times);
  }
  return HL_OK;
}

hl_status hl_component_only(hl_load_request *request, const char *path, bool is_series, hl_payload *payload,
                            hl_error *error) {
  hl_status status = hl_arrays_add(request, "", payload->components, payload->grid.type, false, error);
  if (status == HL_OK && request->array != NULL && request->array[0] != 0)
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: the file has one array, without a name: leave \"array\" (--array) out", path);
  request->chosen = 0;
  return status == HL_OK ? hl_component_choose(request, path, is_series, payload, error) : status;
}

bool hl_find_type(const hl_named_type *types, size_t count, const char *name, hl_voxel_type *type) {
  for (size_t n = 0; n < count; n++)
    if (hl_text_is_one_of(name, types[n].name)) {
      *type = types[n].type;
      return true;
    }
  return false;
}
