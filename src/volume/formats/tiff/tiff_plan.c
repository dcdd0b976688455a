/* volume/formats/tiff/tiff_plan.c - finds the order of a TIFF file's pages.
 *
 * OME-XML follows the schema of 2016-06 of the Open Microscopy Environment. The XML element Pixels states the
 * sizes and the order of the dimensions. The XML elements TiffData say which page of which file holds a
 * plane. In files of ImageJ, the description of the first page has lines "name=value", as ij.io.FileSaver
 * writes them. The planes of ImageJ's files are ordered by channel (which changes fastest), slice and
 * frame. */
#include "volume/formats/tiff/tiff_plan.h"

#include <halflight/scene.h>
#include <math.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "text/plain_json.h"
#include "volume/io/lengths.h"
#include "volume/io/text.h"
#include "volume/io/xml.h"

enum { FILES_MOST = 65536, NAME_BYTES = 1024, SIZE_MOST = 1 << 24 };

void tiff_plan_release(tiff_plan *plan) {
  for (size_t n = 0; n < plan->file_count; n++) hl_release(plan->context, plan->files[n]);
  hl_release(plan->context, plan->files);
  hl_release(plan->context, plan->slices);
  *plan = (tiff_plan){.context = NULL};
}

static hl_status make_slices(tiff_plan *plan, size_t count, const char *path, hl_error *error) {
  plan->slices = hl_allocate_zeroed(plan->context, count, sizeof *plan->slices);
  plan->slice_count = count;
  return plan->slices != NULL ? HL_OK : hl_fail_memory(error, count * sizeof *plan->slices, path);
}

/* Adds a file to the plan. name: null for the first file. */
static hl_status add_file(tiff_plan *plan, const char *name, uint32_t *index, hl_error *error) {
  /* the search begins at the last file, because this file holds most of the planes still to be placed */
  for (size_t n = plan->file_count; name != NULL && n-- > 1;)
    if (strcmp(plan->files[n], name) == 0) {
      *index = (uint32_t)n;
      return HL_OK;
    }
  if (plan->file_count >= FILES_MOST)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "a volume of more than %d files: save it as one",
                   (int)FILES_MOST);
  /* The list is full when its length is a power of two; then its capacity is doubled. */
  if ((plan->file_count & (plan->file_count - 1)) == 0) {
    size_t wanted = plan->file_count == 0 ? 1 : 2 * plan->file_count;
    char **larger = hl_reallocate(plan->context, plan->files, wanted, sizeof *larger);
    if (larger == NULL) return hl_fail_memory(error, wanted * sizeof *larger, "names of files");
    plan->files = larger;
  }
  char *copy = name == NULL ? NULL : hl_copy_text(plan->context, name);
  if (name != NULL && copy == NULL) return hl_fail_memory(error, strlen(name) + 1, name);
  *index = (uint32_t)plan->file_count;
  plan->files[plan->file_count++] = copy;
  return HL_OK;
}

/* ---- OME-XML ---- */

typedef struct ome_reader {
  tiff_plan *plan;
  hl_load_request *request;
  const char *path;
  size_t pages, components; /* pages and components of the first file */
  size_t size[3];           /* number of planes along each of Z, C, T */
  char order[3];            /* the letters Z, C and T in the order of the file's axes; the first axis changes
                             * fastest */
  bool in_pixels, done, is_planned;
  /* The state of the TiffData element that is being read. */
  struct {
    bool is_open, whole; /* is_open: whether the planes of the element have not been placed yet; whole:
                          * whether the element holds all further planes up to the last */
    size_t first[3], count, page;
  } element;
  size_t placed; /* number of planes placed by all elements */
  size_t told;   /* number of Channel elements read so far */
  char file[NAME_BYTES];
} ome_reader;

static bool has_name(const hl_xml_tag *tag, const char *name) {
  const char *colon = strrchr(tag->name, ':');
  return strcmp(colon != NULL ? colon + 1 : tag->name, name) == 0;
}

/* Reads an attribute that is a whole number; *number becomes `other` if the attribute is absent. */
static bool read_number(const hl_xml_tag *tag, const char *name, size_t other, size_t *number) {
  const char *text = hl_xml_attribute(tag, name);
  *number = other;
  return text == NULL || (hl_text_sizes(text, number, 1) == 1 && *number <= SIZE_MOST);
}

/* The length of a voxel along an axis; 0 if the file does not state it. *unit: set to the length of the
 * stated unit in micrometres, or to 0 if the unit is no unit of length (for example "pixel"). */
static double read_length(const hl_xml_tag *tag, char axis, double *unit) {
  char name[] = "PhysicalSizeX", unit_name[] = "PhysicalSizeXUnit";
  name[sizeof name - 2] = axis;
  unit_name[12] = axis;
  const char *text = hl_xml_attribute(tag, name), *told = hl_xml_attribute(tag, unit_name);
  double value;
  *unit = told != NULL ? hl_micrometres(told) : 1; /* in the schema, micrometres are the default */
  if (text == NULL || !hl_text_number(text, strlen(text), &value) || !(value > 0) || !isfinite(value))
    return 0;
  return value;
}

/* Reads the lengths of voxels. The lengths are converted to micrometres if every stated length has a known
 * unit; otherwise the numbers are not converted. */
static void read_lengths(ome_reader *ome, const hl_xml_tag *tag) {
  double unit[3], *spacing = ome->plan->spacing;
  bool known = true;
  for (int axis = 0; axis < 3; axis++) {
    spacing[axis] = read_length(tag, "XYZ"[axis], &unit[axis]);
    known = known && (spacing[axis] == 0 || unit[axis] > 0);
  }
  for (int axis = 0; axis < 3 && known; axis++) spacing[axis] *= unit[axis];
  if (known && spacing[0] > 0) ome->request->unit = "micrometre";
}

static hl_status fail_ome(const ome_reader *ome, const char *what, hl_error *error) {
  return hl_fail(error, HL_ERROR_INPUT, "%s: its OME-XML %s", ome->path, what);
}

static hl_status read_pixels(ome_reader *ome, const hl_xml_tag *tag, hl_error *error) {
  const char *order = hl_xml_attribute(tag, "DimensionOrder");
  size_t total;
  if (!read_number(tag, "SizeZ", 1, &ome->size[0]) || !read_number(tag, "SizeC", 1, &ome->size[1]) ||
      !read_number(tag, "SizeT", 1, &ome->size[2]) || ome->size[0] == 0 || ome->size[1] == 0 ||
      ome->size[2] == 0 || !hl_multiply(ome->size[0], ome->size[1], &total) ||
      !hl_multiply(total, ome->size[2], &total) || total > SIZE_MOST)
    return fail_ome(ome, "has sizes that are no numbers from 1 on, or too large", error);
  memcpy(ome->order, "ZCT", 3);
  if (order != NULL && strlen(order) == 5 && strchr(order + 2, 'Z') != NULL &&
      strchr(order + 2, 'C') != NULL && strchr(order + 2, 'T') != NULL)
    memcpy(ome->order, order + 2, 3);
  /* the file counts the samples of a pixel, which are colours, as channels; the plan counts all samples of a
   * pixel as one channel */
  if (ome->components > 1 && ome->size[1] % ome->components == 0) ome->size[1] /= ome->components;
  read_lengths(ome, tag);
  ome->in_pixels = true;
  return HL_OK;
}

static int axis_of(char letter) { return letter == 'Z' ? 0 : letter == 'C' ? 1 : 2; }

/* Chooses the time step and the channel, and allocates the list of slices. */
static hl_status begin_slices(ome_reader *ome, hl_error *error) {
  if (ome->is_planned) return HL_OK;
  ome->is_planned = true;
  hl_status status = HL_OK;
  if (ome->told == 0) status = hl_steps_choose(ome->request, ome->path, ome->size[2], ome->size[1], error);
  else status = hl_channel_find(ome->request, ome->path, error);
  return status == HL_OK ? make_slices(ome->plan, ome->size[0], ome->path, error) : status;
}

/* Finds the slices that a TiffData element's pages hold. */
static hl_status place_planes(ome_reader *ome, hl_error *error) {
  size_t at[3], total = ome->size[0] * ome->size[1] * ome->size[2], place = 0, factor = 1;
  uint32_t file = 0;
  ome->element.is_open = false;
  hl_status status = begin_slices(ome, error);
  if (status != HL_OK) return status;
  for (int n = 0; n < 3; n++) {
    int axis = axis_of(ome->order[n]);
    if (ome->element.first[axis] >= ome->size[axis])
      return fail_ome(ome, "names a plane beyond its sizes", error);
    place += ome->element.first[axis] * factor;
    factor *= ome->size[axis];
  }
  size_t count = ome->element.whole || ome->element.count > total - place ? total - place
                                                                          : ome->element.count;
  const hl_selection *chosen = &ome->request->selection;
  ome->placed += count;
  if (ome->placed > 2 * total) return fail_ome(ome, "names most of its planes more than once", error);
  for (size_t n = 0; n < count; n++) {
    size_t left = place + n;
    for (int k = 0; k < 3; k++) {
      int axis = axis_of(ome->order[k]);
      at[axis] = left % ome->size[axis];
      left /= ome->size[axis];
    }
    if (at[1] != (size_t)chosen->channel || at[2] != (size_t)chosen->time) continue;
    if (file == 0 && ome->file[0] != 0 && (status = add_file(ome->plan, ome->file, &file, error)) != HL_OK)
      return status;
    ome->plan->slices[at[0]] = (tiff_slice){file, (uint32_t)(ome->element.page + n), true};
  }
  return HL_OK;
}

static hl_status begin_planes(ome_reader *ome, const hl_xml_tag *tag, hl_error *error) {
  if (!read_number(tag, "FirstZ", 0, &ome->element.first[0]) ||
      !read_number(tag, "FirstC", 0, &ome->element.first[1]) ||
      !read_number(tag, "FirstT", 0, &ome->element.first[2]) ||
      !read_number(tag, "IFD", 0, &ome->element.page) ||
      !read_number(tag, "PlaneCount", 1, &ome->element.count))
    return fail_ome(ome, "has a TiffData whose numbers are none", error);
  ome->element.whole = hl_xml_attribute(tag, "PlaneCount") == NULL && hl_xml_attribute(tag, "IFD") == NULL;
  ome->file[0] = 0;
  ome->element.is_open = true;
  return tag->is_end ? place_planes(ome, error) : HL_OK;
}

/* Reads the name of a further file, which must lie in the folder of the first file. Names with a path are
 * refused, because they could name any file of the machine. */
static hl_status read_file(ome_reader *ome, const hl_xml_tag *tag, hl_error *error) {
  const char *name = hl_xml_attribute(tag, "FileName"), *slash = strrchr(ome->path, '/');
  if (name == NULL) return HL_OK;
  if (strchr(name, '/') != NULL || strlen(name) >= sizeof ome->file || name[0] == 0)
    return fail_ome(ome, "names a file that is not beside it", error);
  /* the member `file` stays empty for the first file's own name */
  if (strcmp(name, slash != NULL ? slash + 1 : ome->path) != 0) strcpy(ome->file, name);
  return HL_OK;
}

/* Reads the name and the colour of a channel. A colour is a number of 32 bits, whose bytes are red, green,
 * blue and alpha from the highest to the lowest. */
static hl_status read_channel(ome_reader *ome, const hl_xml_tag *tag, hl_error *error) {
  const char *name = hl_xml_attribute(tag, "Name"), *color = hl_xml_attribute(tag, "Color");
  double value;
  hl_status status = HL_OK;
  if (ome->told == 0) {
    status = hl_steps_choose(ome->request, ome->path, ome->size[2], ome->size[1], error);
    if (status == HL_OK) status = hl_channels_make(ome->request, error);
  }
  if (status != HL_OK || ome->told++ >= ome->size[1]) return status;
  hl_channel *channel = &ome->request->channels[ome->told - 1];
  if (name != NULL) hl_channel_name(channel, name);
  if (color == NULL || !hl_text_number(color, strlen(color), &value) || !(fabs(value) < 0x1p32)) return HL_OK;
  uint32_t code = (uint32_t)(int64_t)value;
  channel->has_color = true;
  for (int c = 0; c < 3; c++) channel->srgb[c] = (code >> (24 - 8 * c) & 255) / 255.0;
  return HL_OK;
}

static hl_status read_tag(ome_reader *ome, const hl_xml_tag *tag, hl_error *error) {
  if (!ome->in_pixels) return tag->is_start && has_name(tag, "Pixels") ? read_pixels(ome, tag, error) : HL_OK;
  if (tag->is_start && has_name(tag, "Channel") && !ome->is_planned) return read_channel(ome, tag, error);
  if (tag->is_start && has_name(tag, "TiffData")) return begin_planes(ome, tag, error);
  if (tag->is_start && ome->element.is_open && has_name(tag, "UUID")) return read_file(ome, tag, error);
  if (tag->is_end && ome->element.is_open && has_name(tag, "TiffData")) return place_planes(ome, error);
  if (tag->is_end && has_name(tag, "Pixels")) ome->done = true; /* only the first image of the file is read */
  return HL_OK;
}

/* Completes the plan at the end of the XML. If no TiffData element says which pages hold the planes, page n
 * is assumed to hold plane n. */
static hl_status finish_ome(ome_reader *ome, hl_error *error) {
  if (!ome->in_pixels) return fail_ome(ome, "has no Pixels: is it a companion of another file?", error);
  hl_status status = begin_slices(ome, error);
  size_t missing = 0;
  bool any = false;
  for (size_t z = 0; status == HL_OK && z < ome->plan->slice_count; z++)
    any = any || ome->plan->slices[z].is_there;
  if (status == HL_OK && !any) {
    memset(ome->element.first, 0, sizeof ome->element.first);
    ome->element.whole = true, ome->element.page = 0, ome->file[0] = 0;
    status = place_planes(ome, error);
  }
  for (size_t z = 0; status == HL_OK && z < ome->plan->slice_count; z++)
    missing += !ome->plan->slices[z].is_there;
  if (missing > 0)
    hl_log(ome->plan->context, HL_LOG_WARNING,
           "%.300s: its OME-XML names no page for %zu of %zu slices: they are 0", ome->path, missing,
           ome->plan->slice_count);
  return status;
}

static hl_status plan_ome(hl_load_request *request, const char *path, const char *description, size_t pages,
                          size_t components, tiff_plan *plan, hl_error *error) {
  ome_reader ome = {.plan = plan, .request = request, .path = path, .pages = pages, .components = components};
  hl_stream *stream = NULL;
  hl_xml_tag *tag = hl_allocate(plan->context, 1, sizeof *tag);
  if (tag == NULL) return hl_fail_memory(error, sizeof *tag, path);
  bool ended = false;
  hl_status status = hl_stream_open_memory(plan->context, path, description, strlen(description), &stream,
                                           error);
  while (status == HL_OK && !ome.done) {
    status = hl_xml_next_tag(stream, tag, &ended, error);
    if (status != HL_OK || ended) break;
    status = read_tag(&ome, tag, error);
  }
  if (status == HL_OK) status = finish_ome(&ome, error);
  hl_stream_close(stream);
  hl_release(plan->context, tag);
  plan->is_told = true;
  return status;
}

/* ---- ImageJ, and pages alone ---- */

/* The number in the description's line "name=NUMBER"; `other` if the description has no such line. */
static double find_number(const char *description, const char *name, double other) {
  size_t length = strlen(name);
  for (const char *line = description; line != NULL; line = strchr(line, '\n')) {
    if (*line == '\n') line++;
    if (strncmp(line, name, length) != 0 || line[length] != '=') continue;
    const char *text = line + length + 1;
    double value;
    if (hl_text_number(text, strcspn(text, "\r\n"), &value) && isfinite(value)) return value;
  }
  return other;
}

static size_t find_count(const char *description, const char *name) {
  double value = find_number(description, name, 1);
  return value >= 1 && value <= SIZE_MOST && value == floor(value) ? (size_t)value : 1;
}

enum { UNIT_BYTES = 64 };

/* Copies the text from the description's line "name=TEXT"; "" if the description has no such line. */
static void find_text(const char *description, const char *name, char text[UNIT_BYTES]) {
  size_t length = strlen(name);
  text[0] = 0;
  for (const char *line = description; line != NULL; line = strchr(line, '\n')) {
    if (*line == '\n') line++;
    if (strncmp(line, name, length) != 0 || line[length] != '=') continue;
    size_t count = strcspn(line + length + 1, "\r\n");
    if (count >= UNIT_BYTES) return;
    memcpy(text, line + length + 1, count);
    text[count] = 0;
    return;
  }
}

static bool is_imagej(const char *description) {
  return description != NULL && strncmp(description, "ImageJ=", 7) == 0;
}

/* Finds the lengths of voxels from ImageJ's description and the page's resolution. The resolution states the
 * lengths along x and y; the description states the distance between slices and the units. The unit of y or z
 * is stated only if it differs from the unit of x. The lengths are converted to micrometres if all units are
 * known. */
static void take_imagej_lengths(hl_load_request *request, const char *description, const double resolution[2],
                                tiff_plan *plan) {
  static const char *const names[] = {"unit", "yunit", "zunit"};
  double unit[3];
  for (int axis = 0; axis < 2; axis++) plan->spacing[axis] = resolution[axis] > 0 ? 1 / resolution[axis] : 1;
  plan->spacing[2] = fabs(find_number(description, "spacing", 1));
  for (int axis = 0; axis < 3; axis++) {
    char text[UNIT_BYTES];
    find_text(description, names[axis], text);
    unit[axis] = text[0] != 0 ? hl_micrometres(text) : axis > 0 ? unit[0] : 0;
  }
  if (!(unit[0] > 0 && unit[1] > 0 && unit[2] > 0)) return;
  for (int axis = 0; axis < 3; axis++) plan->spacing[axis] *= unit[axis];
  request->unit = "micrometre";
}

/* ---- tifffile's series: a JSON object with the array's shape, and perhaps the letters of its axes ---- */

/* An axis of a series: its size, and the number of pages between neighbouring indices. The axes are times,
 * channels and slices. */
typedef struct series_axis {
  size_t count, step;
} series_axis;
typedef struct series_sizes {
  series_axis times, channels, slices;
} series_sizes;

enum { SHAPE_MOST = 12 };

/* Assigns letters to axes without letters. Counted from the end, the axes before y and x are z, time and
 * channel. */
static void name_axes(size_t count, char letters[SHAPE_MOST]) {
  static const char usual[] = "CTZ";
  for (size_t n = 0; n < count; n++) letters[n] = count - n <= 3 ? usual[3 - (count - n)] : 'Q';
}

/* Finds which of a shape's axes before y and x are times, channels and slices. Returns false if two axes are
 * times, channels or slices. Axes of other letters are slices, and neighbouring axes of slices are merged. */
static bool sort_axes(const size_t *shape, const char *letters, size_t count, series_sizes *sizes) {
  size_t step = 1;
  const series_axis *before = NULL;
  *sizes = (series_sizes){{1, 0}, {1, 0}, {1, 0}};
  for (size_t n = count; n-- > 0;) { /* the last axis varies fastest */
    if (shape[n] == 1) continue;
    series_axis *axis = letters[n] == 'T'   ? &sizes->times
                        : letters[n] == 'C' ? &sizes->channels
                                            : &sizes->slices;
    const bool joins = axis == &sizes->slices && before == axis;
    if (axis->count > 1 && !joins) return false;
    if (axis->count == 1) axis->step = step;
    if (!hl_multiply(axis->count, shape[n], &axis->count) || !hl_multiply(step, shape[n], &step))
      return false;
    before = axis;
  }
  return true;
}

/* Reads the description that tifffile writes. Returns false if the text describes no series, or a series that
 * cannot be read. samples: number of samples of a pixel. */
static bool read_series(const char *description, size_t samples, series_sizes *sizes) {
  size_t shape[SHAPE_MOST], count = 0;
  char letters[SHAPE_MOST];
  if (description == NULL || description[0] != '{') return false;
  json_t *root = hl_plain_json_load_text(description);
  const json_t *list = json_object_get(root, "shape");
  const char *axes = json_string_value(json_object_get(root, "axes"));
  size_t rank = json_array_size(list), inner = samples > 1 ? 3 : 2;
  bool good = rank >= inner && rank - inner <= SHAPE_MOST;
  for (size_t n = 0; good && n + inner < rank; n++) {
    json_int_t size = json_integer_value(json_array_get(list, n));
    good = size >= 1 && size <= SIZE_MOST;
    shape[count++] = good ? (size_t)size : 1;
  }
  if (good) name_axes(count, letters);
  if (good && axes != NULL && strlen(axes) == rank) memcpy(letters, axes, count);
  json_decref(root);
  return good && sort_axes(shape, letters, count, sizes);
}

size_t tiff_plan_pages(const char *description, size_t components) {
  series_sizes sizes;
  if (is_imagej(description)) return find_count(description, "images");
  if (!read_series(description, components, &sizes)) return 0;
  return sizes.times.count * sizes.channels.count * sizes.slices.count;
}

/* Plans the volume of a file whose pages stand in the order of the given axes. */
static hl_status plan_sizes(hl_load_request *request, const char *path, const series_sizes *sizes,
                            tiff_plan *plan, hl_error *error) {
  hl_status status = hl_steps_choose(request, path, sizes->times.count, sizes->channels.count, error);
  if (status == HL_OK) status = make_slices(plan, sizes->slices.count, path, error);
  const hl_selection *chosen = &request->selection;
  for (size_t z = 0; status == HL_OK && z < sizes->slices.count; z++) {
    size_t channel = (size_t)chosen->channel, time = (size_t)chosen->time;
    size_t page = time * sizes->times.step + channel * sizes->channels.step + z * sizes->slices.step;
    plan->slices[z] = (tiff_slice){0, (uint32_t)page, true};
  }
  return status;
}

/* Returns whether channels of a single slice are slices. tifffile.imwrite(..., imagej=True) writes the first
 * of three axes as channels, even if the array has no channels. The channels count as slices if a picture
 * cannot show so great a number of channels, and the caller names no channel. */
static bool are_slices(const hl_load_request *request, size_t channels, size_t slices) {
  return slices == 1 && channels > HL_CHANNELS_MOST && request->channel < 0 && request->channel_name == NULL;
}

static hl_status plan_imagej(hl_load_request *request, const char *path, const char *description,
                             size_t pages, const double resolution[2], tiff_plan *plan, hl_error *error) {
  size_t times = find_count(description, "frames"), channels = find_count(description, "channels");
  const size_t steps = channels * times, whole = steps > pages ? 0 : pages / steps;
  if (whole == 0 || (whole * steps != pages && whole != find_count(description, "slices")))
    times = channels = 1;
  const size_t slices = pages / (channels * times);
  series_sizes sizes = {{times, slices * channels}, {channels, 1}, {slices, channels}};
  if (are_slices(request, channels, slices)) {
    sizes = (series_sizes){{times, channels}, {1, 0}, {channels, 1}};
    hl_log(
        plan->context, HL_LOG_WARNING,
        "%.300s: its description tells %zu channels of one slice: they are taken as slices: for one channel, "
        "choose by \"channel\" (--channel)",
        path, channels);
  }
  plan->is_told = true;
  take_imagej_lengths(request, description, resolution, plan);
  return plan_sizes(request, path, &sizes, plan, error);
}

static hl_status plan_pages(hl_load_request *request, const char *path, const char *description, size_t pages,
                            size_t components, size_t depth, const double resolution[2], tiff_plan *plan,
                            hl_error *error) {
  if (is_imagej(description)) return plan_imagej(request, path, description, pages, resolution, plan, error);
  series_sizes sizes;
  size_t wanted;
  bool told = read_series(description, components, &sizes) &&
              hl_multiply(sizes.times.count, sizes.channels.count, &wanted) &&
              hl_multiply(wanted, sizes.slices.count, &wanted) && wanted <= pages;
  const size_t slices = depth > 1 ? depth : pages; /* if a page has several slices, each page is a volume */
  if (!told) sizes = (series_sizes){{pages / slices, slices}, {1, 0}, {slices, 1}};
  if (told && wanted < pages)
    hl_log(plan->context, HL_LOG_WARNING,
           "%.300s: the first series of %zu of %zu pages is taken: others follow it in the file", path,
           wanted, pages);
  plan->is_told = told;
  return plan_sizes(request, path, &sizes, plan, error);
}

hl_status tiff_plan_make(hl_load_request *request, const char *path, const char *description, size_t pages,
                         size_t components, size_t depth, const double resolution[2], tiff_plan *plan,
                         hl_error *error) {
  *plan = (tiff_plan){.context = request->context};
  uint32_t first;
  hl_status status = add_file(plan, NULL, &first, error);
  if (status != HL_OK) return status;
  bool ome = description != NULL && strstr(description, "<OME") != NULL;
  return ome ? plan_ome(request, path, description, pages, components, plan, error)
             : plan_pages(request, path, description, pages, components, depth, resolution, plan, error);
}
