/* volume/load.c - hl_volume_load: finds the format of a volume's file, and reads the file. The format is
 * found by the file's name if the name proves the format, else by the file's content, else by a name that
 * suggests the format. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "core/door.h"
#include "core/file.h"
#include "core/memory.h"
#include "text/body_axes.h"
#include "text/plain.h"
#include "volume/file_space.h"
#include "volume/formats/format.h"
#include "volume/io/bundle_zip.h"
#include "volume/io/decoders.h"
#include "volume/io/text.h"

static bool begins(const unsigned char *bytes, size_t length, const char *mark, size_t mark_length) {
  return length >= mark_length && memcmp(bytes, mark, mark_length) == 0;
}

/* Finds the format that claims a file by its first bytes. length: the number of bytes, of which at most
 * HL_FORMAT_SNIFFED_BYTES are used. */
static const hl_format *by_content(const unsigned char *bytes, size_t length) {
  if (length > HL_FORMAT_SNIFFED_BYTES) length = HL_FORMAT_SNIFFED_BYTES;
  for (int n = 0; hl_formats[n] != NULL; n++)
    if (hl_formats[n]->has_content != NULL && hl_formats[n]->has_content(bytes, length)) return hl_formats[n];
  return NULL;
}

static const hl_format *by_fit(const hl_stream *stream) {
  for (int n = 0; hl_formats[n] != NULL; n++)
    if (hl_formats[n]->fits != NULL && hl_formats[n]->fits(stream)) return hl_formats[n];
  return NULL;
}

/* Finds the format by the file's name. *format is null if no format claims the file. */
static hl_status by_name(hl_stream **stream, const hl_format **format, hl_error *error) {
  bool claimed = false;
  hl_status status = HL_OK;
  for (int n = 0; hl_formats[n] != NULL && status == HL_OK && !claimed; n++) {
    if (hl_formats[n]->claim_name == NULL) continue;
    status = hl_formats[n]->claim_name(stream, &claimed, error);
    if (claimed) *format = hl_formats[n];
  }
  return status;
}

/* Skips the byte order mark with which Windows programs begin UTF-8 text, if a known header follows. */
static hl_status take_byte_order_mark(hl_stream *stream, const unsigned char **bytes, size_t *length,
                                      hl_error *error) {
  if (!begins(*bytes, *length, "\xef\xbb\xbf", 3) || by_content(*bytes + 3, *length - 3) == NULL)
    return HL_OK;
  hl_stream_take(stream, 3);
  return hl_stream_peek(stream, HL_FORMAT_SNIFFED_BYTES, bytes, length, error);
}

/* Finds advice for a file of a well-known format that Halflight does not read. The file's first bytes tell
 * its format. Returns null for all other files. Sources: the formats' own descriptions, and the list of marks
 * of file(1). */
static const char *known_but_unsupported(const unsigned char *bytes, size_t length) {
#define EXPORT     "export the volume as NRRD or NIfTI, or show it in Python: halflight.render("
#define MICROSCOPE "convert it to OME-TIFF or OME-Zarr (bfconvert, bioformats2raw)"
  static const struct {
    size_t place;
    const char *mark;
    size_t mark_length;
    const char *advice;
  } marks[] = {
      {0, "\x89PNG", 4, "a picture, not a volume: give a folder of numbered ones"},
      {0, "\xff\xd8\xff", 3, "a JPEG picture, not a volume: give a folder of numbered ones"},
      {0, "\x76\x2f\x31\x01", 4, "an OpenEXR picture, not a volume: `halflight convert` makes a .png of it"},
      {0, "\x89HDF", 4,
       "an HDF5 file (MINC, NeXus, Imaris, ...): " EXPORT "h5py.File(path)[\"name\"]). Python's "
       "halflight.open_snapshot(path) opens particles, and halflight.open_amr(path, name) opens adaptive "
       "grids"},
      {0, "InitialCycleNumber", 18,
       "the parameters of Enzo: give it to Python's halflight.open_amr(path, \"Density\")"},
      {0, "CDF\001", 4, "a NetCDF file (MINC, ...): " EXPORT "xarray.open_dataset(path)[\"name\"])"},
      {0, "CDF\002", 4, "a NetCDF file (MINC, ...): " EXPORT "xarray.open_dataset(path)[\"name\"])"},
      {0, "CDF\005", 4, "a NetCDF file: " EXPORT "xarray.open_dataset(path)[\"name\"])"},
      {0, "\x28\xb5\x2f\xfd", 4, "compressed with zstd: decompress it first"},
      {0, "7z\xbc\xaf\x27\x1c", 6, "a 7-Zip archive: unpack it"},
      {0, "Rar!\x1a\x07", 6, "a RAR archive: unpack it"},
      {257, "ustar", 5, "a tar archive: unpack it"},
      {0, "ZISRAWFILE", 10, "a CZI file of Zeiss: " MICROSCOPE},
      {0, "\xda\xce\xbe\x0a", 4, "an ND2 file of Nikon: " MICROSCOPE},
      {0, "p\0\0\0", 4, "a LIF file of Leica: " MICROSCOPE},
      {0, "\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", 8, "a compound file (OIB of Olympus, ...): " MICROSCOPE},
      {0, "# AmiraMesh", 11, "an Amira mesh: save it as NRRD"},
      {0, "# Avizo", 7, "an Avizo mesh: save it as NRRD"},
      {0, "SIMPLE  =", 9, "a FITS file: export the cube as NumPy .npy or NRRD"},
      {0, "MATLAB ", 7, "a file of MATLAB: write the array with niftiwrite, or save it as NumPy .npy"},
      {0, "MATRIX72v", 9, "an ECAT 7 file: convert it to NIfTI"},
      {0, "# === DATA DESCRIPTION FILE", 27, "a PAR file of Philips: convert it and its .REC with dcm2niix"},
      {0, "PVM", 3, "a PVM file of V3: convert it to raw (pvm2raw)"},
      {0, "DDS v3d", 7, "a PVM file of V3: convert it to raw (pvm2raw)"},
  };
#undef MICROSCOPE
  for (size_t n = 0; n < sizeof marks / sizeof *marks; n++)
    if (length > marks[n].place &&
        begins(bytes + marks[n].place, length - marks[n].place, marks[n].mark, marks[n].mark_length))
      return marks[n].advice;
  return NULL;
}

/* Finds advice for a file of simulations that Python opens by other packages. Returns null for all other
 * files. */
static const char *known_by_name(const char *path) {
#define PYVISTA(read) "give it to Python's halflight.render(" read ", array=\"name\")"
  static const char *const names[][2] = {
      {".foam", "a case of OpenFOAM: " PYVISTA("pyvista.OpenFOAMReader(path).read()")},
      {".case", "a case of EnSight: " PYVISTA("pyvista.get_reader(path).read()")},
      {".encas", "a case of EnSight: " PYVISTA("pyvista.get_reader(path).read()")},
      {".ex2", "an Exodus file: " PYVISTA("pyvista.read(path)")},
      {".exo", "an Exodus file: " PYVISTA("pyvista.read(path)")},
  };
#undef PYVISTA
  for (size_t n = 0; n < sizeof names / sizeof *names; n++)
    if (hl_text_ends(path, names[n][0])) return names[n][1];
  return NULL;
}

static void list_formats(char *text, size_t size) {
  size_t used = 0;
  for (int n = 0; hl_formats[n] != NULL && used < size; n++)
    if (hl_formats[n]->name != NULL)
      used += (size_t)snprintf(text + used, size - used, "%s%s", used > 0 ? ", " : "", hl_formats[n]->name);
}

static bool is_mesh_name(const char *path) {
  static const char *const endings[] = {".ply", ".stl", ".obj", ".gltf", ".glb"};
  for (size_t n = 0; n < sizeof endings / sizeof *endings; n++)
    if (hl_text_ends(path, endings[n])) return true;
  return false;
}

static hl_status fail_unknown(const hl_stream *stream, const unsigned char *bytes, size_t length,
                              hl_error *error) {
  const char *path = stream->path, *advice = known_by_name(path);
  if (advice == NULL) advice = known_but_unsupported(bytes, length);
  if (advice != NULL) return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: %s", path, advice);
  if (stream->cut_short)
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: its compressed data end before the volume's header: is it cut short?", path);
  if (length == 0) return hl_fail(error, HL_ERROR_INPUT, "%s: the file is empty", path);
  if (is_mesh_name(path))
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: a mesh, not a volume: give it to `halflight render` beside a volume, or alone", path);
  for (int n = 0; hl_formats[n] != NULL; n++)
    for (int ending = 0; ending < HL_FORMAT_ENDINGS && hl_formats[n]->endings[ending] != NULL; ending++)
      if (hl_text_ends(path, hl_formats[n]->endings[ending]))
        return hl_fail(error, HL_ERROR_INPUT, "%s: the file does not begin with %s, as %s files do", path,
                       hl_formats[n]->beginning, hl_formats[n]->endings[ending]);
  char known[400] = "";
  list_formats(known, sizeof known);
  return hl_fail(error, HL_ERROR_INPUT,
                 "%s: not a volume file that is known (%s); raw voxels need their "
                 "size and type in the name: name_256x256x128_uint8.raw",
                 path, known);
}

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error);

/* The only file of an archive, apart from files that macOS adds; null if the archive has no such file or
 * several. */
static const hl_bundle_entry *only_file(const hl_bundle *bundle) {
  const hl_bundle_entry *only = NULL;
  for (size_t n = 0; n < bundle->count; n++) {
    const char *name = bundle->entries[n].name, *slash = strrchr(name, '/');
    if (strncmp(name, "__MACOSX/", 9) == 0 || (slash == NULL ? name : slash + 1)[0] == '.') continue;
    if (only != NULL) return NULL;
    only = &bundle->entries[n];
  }
  return only;
}

/* Unpacks a volume's file of an archive into memory, and reads the volume. */
static hl_status load_packed(const hl_bundle *bundle, const hl_bundle_entry *entry, hl_load_request *request,
                             hl_volume **volume, hl_error *error) {
  hl_context *context = request->context;
  hl_source *source = NULL;
  hl_stream *stream = NULL;
  unsigned char *bytes = NULL;
  size_t length = 0;
  char *path = hl_path_join(context, bundle->path, entry->name);
  if (path == NULL) return hl_fail_memory(error, strlen(entry->name), bundle->path);
  hl_status status = hl_bundle_entry_open(bundle, entry, true, &source, error);
  if (status == HL_OK) status = hl_source_read_whole(source, path, SIZE_MAX, &bytes, &length, error);
  hl_source_close(source);
  if (status == HL_OK && begins(bytes, length, "PK\3\4", 4))
    status = hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: a zip archive within another: unpack it", path);
  if (status == HL_OK) status = hl_stream_open_memory(context, path, bytes, length, &stream, error);
  if (status == HL_OK) status = load(&stream, request, volume, error);
  hl_stream_close(stream);
  hl_release(context, bytes);
  hl_release(context, path);
  return status;
}

/* Reads a folder or a zip archive: calls the readers of the formats one by one, until a reader claims the
 * folder or archive. */
static hl_status load_bundle(hl_bundle *bundle, hl_load_request *request, hl_volume **volume,
                             hl_error *error) {
  bool claimed = false;
  hl_status status = HL_OK;
  for (int n = 0; hl_formats[n] != NULL && status == HL_OK && !claimed; n++)
    if (hl_formats[n]->load_bundle != NULL)
      status = hl_formats[n]->load_bundle(bundle, request, &claimed, volume, error);
  if (status != HL_OK || claimed) return status;
  const hl_bundle_entry *only = bundle->is_archive ? only_file(bundle) : NULL;
  if (only != NULL) return load_packed(bundle, only, request, volume, error);
  return hl_fail(error, HL_ERROR_INPUT, "%s: a %s in which no volume was found: give a volume file",
                 bundle->path, bundle->is_archive ? "zip archive" : "folder");
}

static hl_status load_folder(const char *path, hl_load_request *request, hl_volume **volume,
                             hl_error *error) {
  hl_bundle bundle;
  hl_status status = hl_bundle_open_folder(request->context, path, &bundle, error);
  if (status == HL_OK) status = load_bundle(&bundle, request, volume, error);
  hl_bundle_close(&bundle);
  return status;
}

/* Reads a store on a server. If the caller names no level of resolution, the function reads a level that is
 * fine enough for a picture of the caller's size, or of PIXELS pixels if the caller states no size. */
static hl_status load_from_server(const char *url, hl_load_request *request, hl_volume **volume,
                                  hl_error *error) {
  enum { PIXELS = 512 };
  hl_bundle bundle;
  bool claimed = false;
  if (request->pixels == 0) request->pixels = PIXELS;
  hl_status status = hl_bundle_open_server(request->context, url, &bundle, error);
  for (int n = 0; hl_formats[n] != NULL && status == HL_OK && !claimed; n++)
    if (hl_formats[n]->load_bundle != NULL && hl_formats[n]->finds_by_name)
      status = hl_formats[n]->load_bundle(&bundle, request, &claimed, volume, error);
  if (status == HL_OK && !claimed)
    status = hl_fail(error, HL_ERROR_INPUT,
                     "%s: the server has no Zarr store there: download other files, and give them", url);
  hl_bundle_close(&bundle);
  return status;
}

static hl_status load_archive(hl_stream *stream, hl_load_request *request, hl_volume **volume,
                              hl_error *error) {
  hl_bundle bundle = {.context = request->context};
  const unsigned char *bytes = NULL;
  size_t length = 0;
  hl_status status = HL_OK;
  if (!hl_stream_is_plain_file(stream) && !hl_stream_memory(stream, &bytes, &length))
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: a zip archive in a pipe: give it as a file",
                   stream->path);
  status = hl_bundle_open_zip(request->context, stream->path, bytes, length, &bundle, error);
  if (status == HL_OK) status = load_bundle(&bundle, request, volume, error);
  hl_bundle_close(&bundle);
  return status;
}

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  const hl_format *format = by_fit(*stream);
  if (format != NULL) return format->load(stream, request, volume, error);
  hl_status status = hl_stream_unpack(stream, error);
  if (status != HL_OK) return status;
  const unsigned char *bytes;
  size_t length;
  status = hl_stream_peek(*stream, HL_FORMAT_SNIFFED_BYTES, &bytes, &length, error);
  if (status == HL_OK) status = take_byte_order_mark(*stream, &bytes, &length, error);
  if (status != HL_OK) return status;
  if (begins(bytes, length, "PK\3\4", 4)) return load_archive(*stream, request, volume, error);
  format = by_content(bytes, length);
  if (format == NULL) status = by_name(stream, &format, error);
  if (status != HL_OK) return status;
  if (format != NULL) return format->load(stream, request, volume, error);
  status = hl_stream_peek(*stream, HL_FORMAT_SNIFFED_BYTES, &bytes, &length, error);
  return status == HL_OK ? fail_unknown(*stream, bytes, length, error) : status;
}

void hl_volume_load_options_defaults(hl_volume_load_options *options) {
  if (options == NULL) return;
  *options = (hl_volume_load_options){.struct_size = sizeof *options,
                                      .component = HL_COMPONENT_DEFAULT,
                                      .time = HL_INDEX_DEFAULT,
                                      .channel = HL_INDEX_DEFAULT,
                                      .level = HL_INDEX_DEFAULT};
}

static hl_status check_options(const hl_volume_load_options *options, hl_error *error) {
  static const char subject[] = "hl_volume_load_with";
  if (options->struct_size != sizeof *options)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "%s: struct_size is %zu, expected %zu: call hl_volume_load_options_defaults first",
                   subject, options->struct_size, sizeof *options);
  if (options->component < HL_COMPONENT_LUMINANCE)
    return hl_fail(error, HL_ERROR_ARGUMENT, "%s: component is %d: give an index or an HL_COMPONENT_ value",
                   subject, options->component);
  if (options->time < HL_INDEX_DEFAULT || options->channel < HL_INDEX_DEFAULT ||
      options->level < HL_INDEX_DEFAULT)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "%s: time %d, channel %d, level %d: give an index or HL_INDEX_DEFAULT for each", subject,
                   options->time, options->channel, options->level);
  if (options->pixels < 0 || options->preview_pixels < 0)
    return hl_fail(error, HL_ERROR_ARGUMENT, "%s: pixels %d, preview_pixels %d: give 0 or more for each",
                   subject, options->pixels, options->preview_pixels);
  if (options->space != HL_SPACE_UNKNOWN && hl_space_name(options->space) == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "%s: there is no space %d", subject, (int)options->space);
  int body_axis[3];
  double sign[3];
  if (options->file_space != NULL && !hl_body_axes_read(options->file_space, body_axis, sign))
    return hl_fail(error, HL_ERROR_ARGUMENT, "space: '%.40s': " HL_BODY_AXES_WANTED, options->file_space);
  bool given = options->spacing[0] != 0 || options->spacing[1] != 0 || options->spacing[2] != 0;
  for (int axis = 0; axis < 3; axis++)
    if (given && !(options->spacing[axis] > 0 && isfinite(options->spacing[axis])))
      return hl_fail(error, HL_ERROR_ARGUMENT,
                     "%s: spacing[%d] is %g: give three finite numbers above 0, or 0 for the file's", subject,
                     axis, options->spacing[axis]);
  return HL_OK;
}

/* Refuses the name of a series if the file has no series. */
static hl_status check_series(const hl_load_request *request, const char *path, hl_error *error) {
  if (request->series == NULL || request->series_count > 0) return HL_OK;
  return hl_fail(error, HL_ERROR_INPUT, "%s: only DICOM files have series: leave \"series\" (--series) out",
                 path);
}

/* Copies to the volume the facts that the reader has found, such as the list of arrays, and warns about
 * default choices. */
static hl_status finish(hl_load_request *request, const char *path, hl_status status, hl_volume **volume,
                        hl_error *error) {
  if (status == HL_OK) {
    status = check_series(request, path, error);
    if (status == HL_OK) status = hl_channel_check(request, path, error);
    if (status != HL_OK) hl_volume_release(*volume), *volume = NULL;
  }
  if (status != HL_OK) {
    hl_arrays_release(request->context, request->arrays, request->array_count);
    hl_release(request->context, request->channels);
    hl_release(request->context, request->series_list);
    return status;
  }
  if (request->array_told[0] != 0) hl_log(request->context, HL_LOG_WARNING, "%s", request->array_told);
  if (request->component_told[0] != 0)
    hl_log(request->context, HL_LOG_WARNING, "%s", request->component_told);
  if (request->selection_told[0] != 0)
    hl_log(request->context, HL_LOG_WARNING, "%s", request->selection_told);
  (*volume)->channels = request->channels;
  if (request->channels != NULL && !(request->window[0] < request->window[1]))
    memcpy(request->window, request->channels[request->selection.channel].window, sizeof request->window);
  if (request->window[0] < request->window[1])
    memcpy((*volume)->window, request->window, sizeof request->window);
  (*volume)->is_anatomical = request->is_anatomical;
  (*volume)->says_labels = request->says_labels;
  (*volume)->says_fog = request->says_fog;
  /* if the caller gives the spacing, its unit is not known */
  (*volume)->unit = request->spacing[0] > 0 ? NULL : request->unit;
  (*volume)->absence = request->absence;
  (*volume)->selection = request->selection;
  (*volume)->resolutions = request->resolutions;
  (*volume)->series = request->series_list;
  (*volume)->series_count = request->series_count;
  (*volume)->chosen_series = request->chosen_series;
  (*volume)->arrays = request->arrays;
  (*volume)->array_count = request->array_count;
  (*volume)->chosen_array = request->chosen;
  if ((*volume)->colors == NULL) (*volume)->component = request->chosen_component;
  return HL_OK;
}

/* Applies the options that say in which anatomical space the volume's world is. */
static void place_in_body(hl_context *context, const char *path, const hl_volume_load_options *options,
                          hl_volume *volume) {
  hl_volume_state_space(context, path, options->file_space, volume);
  hl_volume_turn_into(context, path, options->space, volume);
}

hl_status hl_volume_load_with(hl_context *context, const char *path, const hl_volume_load_options *options,
                              hl_volume **volume, hl_error *error) {
  HL_DOOR;
  if (volume != NULL) *volume = NULL;
  if (context == NULL || path == NULL || volume == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_volume_load: context, path and volume must not be null");
  hl_volume_load_options chosen;
  hl_volume_load_options_defaults(&chosen);
  if (options == NULL) options = &chosen;
  hl_status status = check_options(options, error);
  if (status != HL_OK) return status;
  /* the parts that pictures see lie in the world of a file only if this world is not turned afterwards */
  const bool seen_in_file = options->file_space == NULL;
  hl_load_request request = {.context = context,
                             .array = options->array,
                             .component = options->component,
                             .series = options->series,
                             .time = options->time,
                             .channel = options->channel,
                             .channel_name = options->channel_name,
                             .level = options->level,
                             .pixels = options->pixels,
                             .preview_pixels = options->preview_pixels,
                             .coarse = seen_in_file ? options->coarse : NULL,
                             .seen = options->seen,
                             .seen_count = options->seen_count,
                             .selection = {1, 1, 1, 0, 0, 0, 0}};
  memcpy(request.spacing, options->spacing, sizeof request.spacing);
  hl_stream *stream = NULL;
  bool on_server = options->bytes == NULL && hl_plain_is_url(path) && !hl_is_confined(context);
  if (on_server || (options->bytes == NULL && hl_file_kind(context, path) == 'd')) {
    status = on_server ? load_from_server(path, &request, volume, error)
                       : load_folder(path, &request, volume, error);
    status = finish(&request, path, status, volume, error);
    if (status == HL_OK) place_in_body(context, path, options, *volume);
    return status;
  }
  status = options->bytes != NULL
               ? hl_stream_open_memory(context, path, options->bytes, options->byte_count, &stream, error)
               : hl_stream_open(context, path, false, &stream, error);
  if (status == HL_OK) status = load(&stream, &request, volume, error);
  hl_stream_close(stream);
  status = finish(&request, path, status, volume, error);
  if (status == HL_OK) place_in_body(context, path, options, *volume);
  return status;
}

hl_status hl_volume_load(hl_context *context, const char *path, hl_volume **volume, hl_error *error) {
  HL_DOOR;
  return hl_volume_load_with(context, path, NULL, volume, error);
}
