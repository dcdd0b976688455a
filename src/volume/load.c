/* volume/load.c - hl_volume_load: tells the format, by content first and by name where it has no mark. */
#include <math.h>
#include <string.h>

#include "core/context.h"
#include "volume/format.h"
#include "volume/text.h"

enum { SNIFFED_BYTES = 1024 };

typedef hl_status load_function(hl_stream **stream, hl_load_request *request, hl_volume **volume,
                                hl_error *error);

static bool begins(const unsigned char *bytes, size_t length, const char *mark, size_t mark_length) {
  return length >= mark_length && memcmp(bytes, mark, mark_length) == 0;
}

static load_function *by_content(const unsigned char *bytes, size_t length) {
  if (begins(bytes, length, "NRRD", 4)) return hl_load_nrrd;
  if (begins(bytes, length, "# vtk DataFile", 14)) return hl_load_legacy_vtk;
  if (hl_is_npy(bytes, length)) return hl_load_npy;
  if (hl_is_nifti(bytes, length)) return hl_load_nifti;
  if (hl_is_vti(bytes, length)) return hl_load_vti;
  if (hl_is_metaimage(bytes, length)) return hl_load_metaimage;
  if (hl_is_raw_descriptor(bytes, length)) return hl_load_raw_descriptor;
  return NULL;
}

/* Takes the mark with which Windows programs begin UTF-8 text, where the rest is a header of text. */
static hl_status take_byte_order_mark(hl_stream *stream, const unsigned char **bytes, size_t *length,
                                      hl_error *error) {
  if (!begins(*bytes, *length, "\xef\xbb\xbf", 3) || by_content(*bytes + 3, *length - 3) == NULL)
    return HL_OK;
  hl_stream_take(stream, 3);
  return hl_stream_peek(stream, SNIFFED_BYTES, bytes, length, error);
}

/* Files that people will try, with what to do about them; null if this is none of them. */
static const char *known_but_unsupported(const unsigned char *bytes, size_t length) {
  static const struct {
    size_t place;
    const char *mark;
    size_t mark_length;
    const char *advice;
  } marks[] = {
      {128, "DICM", 4, "a DICOM file: convert its series to NIfTI with dcm2niix"},
      {0, " BDV", 4, "an OpenVDB file: make it dense and save it as NRRD or NIfTI"},
      {0, "NanoVDB", 7, "a NanoVDB file: make it dense and save it as NRRD or NIfTI"},
      {0, "II*\0", 4, "a TIFF file: convert the stack to NRRD or MetaImage"},
      {0, "MM\0*", 4, "a TIFF file: convert the stack to NRRD or MetaImage"},
      {0, "\x89PNG", 4, "a picture, not a volume"},
      {0, "\x89HDF", 4, "an HDF5 file (MINC, NeXus, ...): export the volume as NRRD or NIfTI"},
      {0, "BZh", 3, "compressed with bzip2: decompress it first"},
      {0, "PK\3\4", 4, "a zip archive: unpack it first"},
      {0, "\3757zXZ", 5, "compressed with xz: decompress it first"},
      {0, "\x28\xb5\x2f\xfd", 4, "compressed with zstd: decompress it first"},
      {0, "11111\n", 6, "a VolVis SLC file: convert it to NRRD or raw"},
  };
  for (size_t n = 0; n < sizeof marks / sizeof *marks; n++)
    if (length > marks[n].place &&
        begins(bytes + marks[n].place, length - marks[n].place, marks[n].mark, marks[n].mark_length))
      return marks[n].advice;
  return NULL;
}

/* A NIfTI pair is loaded through its header, whichever of the two was named. */
static hl_status switch_to_pair_header(hl_stream **stream, bool *switched, hl_error *error) {
  const char *slash = strrchr((*stream)->path, '/'), *name = slash == NULL ? (*stream)->path : slash + 1;
  char header[1024];
  size_t length = strlen(name);
  *switched = false;
  if (hl_text_ends(name, ".img.gz")) length -= 7;
  else if (hl_text_ends(name, ".img")) length -= 4;
  else return HL_OK;
  if (length + 8 > sizeof header) return HL_OK;
  memcpy(header, name, length);
  static const char *const endings[] = {".hdr", ".hdr.gz"};
  for (int n = 0; n < 2; n++) {
    strcpy(header + length, endings[n]);
    hl_status status = hl_stream_switch(stream, header, error);
    *switched = status == HL_OK;
    if (status == HL_OK) return hl_stream_inflate_if_gzip(stream, error);
    if (status != HL_ERROR_IO) return status;
  }
  return HL_OK;
}

static hl_status fail_unknown(const hl_stream *stream, const unsigned char *bytes, size_t length,
                              hl_error *error) {
  const char *path = stream->path, *advice = known_but_unsupported(bytes, length);
  if (advice != NULL) return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: %s", path, advice);
  if (length == 0) return hl_fail(error, HL_ERROR_INPUT, "%s: the file is empty", path);
  static const struct {
    const char *ending, *mark;
  } marks[] = {{".nrrd", "\"NRRD000\""},
               {".nhdr", "\"NRRD000\""},
               {".mha", "\"ObjectType = Image\" or \"NDims = 3\""},
               {".mhd", "\"ObjectType = Image\" or \"NDims = 3\""},
               {".vti", "\"<VTKFile\""},
               {".vtk", "\"# vtk DataFile Version\""}};
  for (size_t n = 0; n < sizeof marks / sizeof *marks; n++)
    if (hl_text_ends(path, marks[n].ending))
      return hl_fail(error, HL_ERROR_INPUT, "%s: the file does not begin with %s, as %s files do", path,
                     marks[n].mark, marks[n].ending);
  return hl_fail(error, HL_ERROR_INPUT,
                 "%s: not a volume file that is known (NRRD, MetaImage, NIfTI, VTK .vti, .vtk, NumPy .npy); "
                 "raw voxels need their "
                 "size and type in the name: name_256x256x128_uint8.raw",
                 path);
}

bool hl_find_type(const hl_named_type *types, size_t count, const char *name, hl_voxel_type *type) {
  for (size_t n = 0; n < count; n++)
    if (hl_text_is_one_of(name, types[n].name)) {
      *type = types[n].type;
      return true;
    }
  return false;
}

hl_status hl_stream_inflate_if_gzip(hl_stream **stream, hl_error *error) {
  const unsigned char *bytes;
  size_t length;
  hl_status status = hl_stream_peek(*stream, 3, &bytes, &length, error);
  if (status == HL_OK && begins(bytes, length, "\x1f\x8b\x08", 3))
    status = hl_stream_push_inflate(stream, error);
  return status;
}

static hl_status load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  hl_payload raw;
  bool named = hl_raw_name((*stream)->path, &raw);
  /* Raw voxels may begin with any bytes, also with those of another format. */
  if (named && !hl_text_ends((*stream)->path, ".gz") && hl_stream_at_most(*stream) == hl_payload_bytes(&raw))
    return hl_load_raw(stream, request, volume, error);
  hl_status status = hl_stream_inflate_if_gzip(stream, error);
  if (status != HL_OK) return status;
  const unsigned char *bytes;
  size_t length;
  status = hl_stream_peek(*stream, SNIFFED_BYTES, &bytes, &length, error);
  if (status == HL_OK) status = take_byte_order_mark(*stream, &bytes, &length, error);
  if (status != HL_OK) return status;
  load_function *format = by_content(bytes, length);
  if (format != NULL) return format(stream, request, volume, error);
  if (named || hl_text_ends((*stream)->path, ".raw") || hl_text_ends((*stream)->path, ".raw.gz"))
    return hl_load_raw(stream, request, volume, error);
  if (length > 0 && (hl_text_ends((*stream)->path, ".nii") || hl_text_ends((*stream)->path, ".nii.gz") ||
                     hl_text_ends((*stream)->path, ".hdr")))
    return hl_load_nifti(stream, request, volume, error); /* which says what is wrong with it */
  bool switched;
  status = switch_to_pair_header(stream, &switched, error);
  if (status != HL_OK) return status;
  if (switched) return hl_load_nifti(stream, request, volume, error);
  return fail_unknown(*stream, bytes, length, error);
}

void hl_volume_load_options_defaults(hl_volume_load_options *options) {
  if (options == NULL) return;
  *options = (hl_volume_load_options){.struct_size = sizeof *options, .component = HL_COMPONENT_DEFAULT};
}

static hl_status check_options(const hl_volume_load_options *options, hl_error *error) {
  static const char subject[] = "hl_volume_load_with";
  if (options->struct_size != sizeof *options)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "%s: struct_size is %zu, expected %zu: call hl_volume_load_options_defaults first",
                   subject, options->struct_size, sizeof *options);
  if (options->component < HL_COMPONENT_MAGNITUDE)
    return hl_fail(error, HL_ERROR_ARGUMENT, "%s: component is %d: give an index or an HL_COMPONENT_ value",
                   subject, options->component);
  bool given = options->spacing[0] != 0 || options->spacing[1] != 0 || options->spacing[2] != 0;
  for (int axis = 0; axis < 3; axis++)
    if (given && !(options->spacing[axis] > 0 && isfinite(options->spacing[axis])))
      return hl_fail(error, HL_ERROR_ARGUMENT,
                     "%s: spacing[%d] is %g: give three finite numbers above 0, or 0 for the file's", subject,
                     axis, options->spacing[axis]);
  return HL_OK;
}

hl_status hl_volume_load_with(hl_context *context, const char *path, const hl_volume_load_options *options,
                              hl_volume **volume, hl_error *error) {
  if (volume != NULL) *volume = NULL;
  if (context == NULL || path == NULL || volume == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_volume_load: context, path and volume must not be null");
  hl_volume_load_options chosen;
  hl_volume_load_options_defaults(&chosen);
  if (options == NULL) options = &chosen;
  hl_status status = check_options(options, error);
  if (status != HL_OK) return status;
  hl_load_request request = {.context = context, .array = options->array, .component = options->component};
  memcpy(request.spacing, options->spacing, sizeof request.spacing);
  hl_stream *stream = NULL;
  status = options->bytes != NULL
               ? hl_stream_open_memory(context, path, options->bytes, options->byte_count, &stream, error)
               : hl_stream_open(context, path, false, &stream, error);
  if (status == HL_OK) status = load(&stream, &request, volume, error);
  hl_stream_close(stream);
  if (status != HL_OK) {
    hl_arrays_release(context, request.arrays, request.array_count);
    return status;
  }
  if (request.array_told[0] != 0) hl_log(context, HL_LOG_WARNING, "%s", request.array_told);
  if (request.component_told[0] != 0) hl_log(context, HL_LOG_WARNING, "%s", request.component_told);
  (*volume)->arrays = request.arrays;
  (*volume)->array_count = request.array_count;
  (*volume)->chosen_array = request.chosen;
  (*volume)->component = request.chosen_component;
  return HL_OK;
}

hl_status hl_volume_load(hl_context *context, const char *path, hl_volume **volume, hl_error *error) {
  return hl_volume_load_with(context, path, NULL, volume, error);
}
