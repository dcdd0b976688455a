/* volume/formats/dicom/header.c - reads a file's attributes by one table, and checks them.
 *
 * In: a file's elements. Out: the file's header. The checks in header.c find out whether the frames can be
 * read, before memory for the frames is allocated. */
#include "volume/formats/dicom/header.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "volume/io/text.h"

enum {
  PREAMBLE_BYTES = 128,
  SHARED_GROUPS = 0x52009229,
  GROUPS_OF_FRAMES = 0x52009230,
  DETECTORS = 0x00540022
};

/* ---- the beginning of a file ---- */

bool hl_dicom_has_mark(const unsigned char *bytes, size_t length) {
  return length >= PREAMBLE_BYTES + 4 && memcmp(bytes + PREAMBLE_BYTES, "DICM", 4) == 0;
}

bool hl_dicom_is_named(const char *path) {
  static const char *const endings[] = {".dcm", ".dicom", ".ima"};
  bool named = false;
  for (size_t n = 0; n < sizeof endings / sizeof *endings; n++)
    named = named || hl_text_ends(path, endings[n]);
  return named;
}

bool hl_dicom_is_remnant(const char *path, const unsigned char *bytes, size_t length) {
  size_t zeros = 0;
  while (zeros < length && bytes[zeros] == 0) zeros++;
  return length < PREAMBLE_BYTES + 4 && (zeros == length || hl_dicom_is_named(path));
}

/* Returns whether the bytes begin a DICOM file with or without the mark "DICM". A DICOM file without the mark
 * begins with an element of group 2 or 8 that has a short value. */
bool hl_dicom_may_begin(const unsigned char *bytes, size_t length) {
  if (hl_dicom_has_mark(bytes, length)) return true;
  if (length < 16 || (bytes[0] != 2 && bytes[0] != 8) || bytes[1] != 0 || bytes[3] != 0) return false;
  bool explicit = bytes[4] >= 'A' && bytes[4] <= 'Z' && bytes[5] >= 'A' && bytes[5] <= 'Z';
  return explicit || (bytes[5] == 0 && bytes[6] == 0 && bytes[7] == 0 && bytes[4] <= 64);
}

/* The UID of a private transfer syntax of GE. In this syntax elements are implicit and little-endian, but
 * pixels are big-endian. */
#define GE_PRIVATE "1.2.840.113619.5.2"

static void use_syntax(hl_dicom_header *header, hl_dicom_reader *reader) {
  static const struct {
    const char *uid; /* the end of the UID; all UIDs begin with 1.2.840.10008.1.2 */
    hl_dicom_codec codec;
  } syntaxes[] = {
      {"", HL_DICOM_NATIVE},          {".1", HL_DICOM_NATIVE},        {".1.98", HL_DICOM_NATIVE},
      {".1.99", HL_DICOM_NATIVE},     {".2", HL_DICOM_NATIVE},        {".5", HL_DICOM_RLE},
      {".4.50", HL_DICOM_JPEG},       {".4.51", HL_DICOM_JPEG},       {".4.57", HL_DICOM_JPEG},
      {".4.70", HL_DICOM_JPEG},       {".4.80", HL_DICOM_JPEG_LS},    {".4.81", HL_DICOM_JPEG_LS},
      {".4.90", HL_DICOM_JPEG_2000},  {".4.91", HL_DICOM_JPEG_2000},  {".4.201", HL_DICOM_JPEG_2000},
      {".4.202", HL_DICOM_JPEG_2000}, {".4.203", HL_DICOM_JPEG_2000},
  };
  static const char root[] = "1.2.840.10008.1.2";
  const char *uid = strncmp(header->syntax, root, sizeof root - 1) == 0 ? header->syntax + sizeof root - 1
                                                                        : NULL;
  header->pixels.codec = HL_DICOM_UNKNOWN_CODEC;
  for (size_t n = 0; n < sizeof syntaxes / sizeof *syntaxes && uid != NULL; n++)
    if (strcmp(uid, syntaxes[n].uid) == 0) header->pixels.codec = syntaxes[n].codec;
  if (strcmp(header->syntax, GE_PRIVATE) == 0) {
    header->pixels.codec = HL_DICOM_NATIVE;
    header->has_swapped_pixels = reader->implicit = true;
  }
  if (uid == NULL) return;
  reader->implicit = uid[0] == 0;
  reader->big_endian = strcmp(uid, ".2") == 0;
  header->deflated = strcmp(uid, ".1.99") == 0;
}

/* Reads the file's meta information, group 2, which is always explicit and little-endian (PS3.10, 7.1). */
static hl_status read_meta(hl_dicom_header *header, hl_dicom_reader *reader, hl_error *error) {
  for (;;) {
    const unsigned char *bytes;
    size_t available;
    hl_dicom_element element;
    bool found;
    hl_status status = hl_source_peek(reader->source, reader->at, 8, &bytes, &available, error);
    if (status != HL_OK || available < 8 || hl_dicom_u16(bytes, false) != 2) return status;
    status = hl_dicom_next(reader, &element, &found, error);
    if (status == HL_OK && !found)
      status = hl_fail(error, HL_ERROR_INPUT, "%s: the file ends in its first header",
                       hl_source_path(reader->source));
    if (status == HL_OK && element.tag == 0x00020010)
      status = hl_dicom_text(reader, &element, header->syntax, sizeof header->syntax, error);
    if (status != HL_OK) return status;
  }
}

/* Guesses the transfer syntax from the first element, for a file that states none. */
static hl_status guess_syntax(hl_dicom_reader *reader, hl_error *error) {
  const unsigned char *bytes;
  size_t available;
  hl_status status = hl_source_peek(reader->source, reader->at, 8, &bytes, &available, error);
  if (status != HL_OK || available < 8) return status;
  reader->implicit = !(bytes[4] >= 'A' && bytes[4] <= 'Z' && bytes[5] >= 'A' && bytes[5] <= 'Z');
  reader->big_endian = bytes[0] == 0 && bytes[1] != 0;
  return HL_OK;
}

hl_status hl_dicom_begin(hl_source **source, hl_dicom_header *header, hl_dicom_reader *reader,
                         hl_error *error) {
  const unsigned char *bytes;
  size_t available;
  *reader = (hl_dicom_reader){.source = *source};
  hl_status status = hl_source_peek(*source, 0, PREAMBLE_BYTES + 4, &bytes, &available, error);
  if (status != HL_OK) return status;
  reader->at = hl_dicom_has_mark(bytes, available) ? PREAMBLE_BYTES + 4 : 0;
  status = read_meta(header, reader, error);
  if (status != HL_OK) return status;
  if (header->syntax[0] == 0) {
    header->pixels.codec = HL_DICOM_NATIVE;
    return guess_syntax(reader, error);
  }
  use_syntax(header, reader);
  if (!header->deflated) return HL_OK;
  status = hl_source_inflate(source, reader->at, UINT64_MAX, error);
  reader->source = *source;
  reader->at = 0;
  return status;
}

/* ---- attributes ---- */

typedef struct attribute {
  uint32_t tag;
  uint16_t vr;      /* type of the attribute's numbers, for files that state none; 0 if the attribute is a
                     * text */
  uint16_t numbers; /* the number of the attribute's numbers that are kept; for a text, the number of bytes */
  bool of_frame;    /* whether `place` is an offset in hl_dicom_frame; otherwise it is an offset in
                     * hl_dicom_header */
  size_t place;
} attribute;

#define DS HL_DICOM_VR('D', 'S')
#define US HL_DICOM_VR('U', 'S')
#define UL HL_DICOM_VR('U', 'L')
#define FD HL_DICOM_VR('F', 'D')
#define TEXT(tag, member) \
  { tag, 0, sizeof((hl_dicom_header *)0)->member, false, offsetof(hl_dicom_header, member) }
#define NUMBERS(tag, vr, count, member) \
  { tag, vr, count, false, offsetof(hl_dicom_header, member) }
#define OF_FRAME(tag, vr, count, member) \
  { tag, vr, count, true, offsetof(hl_dicom_frame, member) }

static const attribute attributes[] = {
    TEXT(0x00080008, image_type),
    TEXT(0x00080060, modality),
    TEXT(0x0008103e, description),
    TEXT(0x0020000e, series_uid),
    TEXT(0x00280004, photometric),
    NUMBERS(0x00180050, DS, 1, thickness),
    NUMBERS(0x00180088, DS, 1, slice_spacing),
    NUMBERS(0x00181164, DS, 2, imager_spacing),
    NUMBERS(0x00200011, DS, 1, series_number),
    NUMBERS(0x00280002, US, 1, samples),
    NUMBERS(0x00280006, US, 1, planar),
    NUMBERS(0x00280008, DS, 1, frame_count),
    NUMBERS(0x00280010, US, 1, rows),
    NUMBERS(0x00280011, US, 1, columns),
    NUMBERS(0x00280100, US, 1, allocated),
    NUMBERS(0x00280101, US, 1, stored),
    NUMBERS(0x00280102, US, 1, high),
    NUMBERS(0x00280103, US, 1, representation),
    NUMBERS(0x00280120, US, 1, padding[0]),
    NUMBERS(0x00280121, US, 1, padding[1]),
    NUMBERS(0x00281050, DS, 1, window[0]),
    NUMBERS(0x00281051, DS, 1, window[1]),
    NUMBERS(0x3004000e, DS, 1, dose_scale),
    NUMBERS(0x00480006, UL, 1, matrix_columns),
    NUMBERS(0x00480007, UL, 1, matrix_rows),
    OF_FRAME(0x00200032, DS, 3, position),
    OF_FRAME(0x00200037, DS, 6, orientation),
    OF_FRAME(0x00209301, FD, 3, volume_position),
    OF_FRAME(0x00209302, FD, 6, volume_orientation),
    OF_FRAME(0x00201041, DS, 1, location),
    OF_FRAME(0x00280030, DS, 2, spacing),
    OF_FRAME(0x00281052, DS, 1, intercept),
    OF_FRAME(0x00281053, DS, 1, slope),
    OF_FRAME(0x00200100, DS, 1, temporal),
    OF_FRAME(0x00209128, UL, 1, temporal),
    OF_FRAME(0x00180081, DS, 1, echo),
    OF_FRAME(0x00189082, FD, 1, echo),
    OF_FRAME(0x00189087, FD, 1, b_value),
    OF_FRAME(0x00189089, FD, 3, diffusion),
    OF_FRAME(0x00180082, DS, 1, inversion),
    OF_FRAME(0x00189079, FD, 1, inversion),
    OF_FRAME(0x00181314, DS, 1, flip),
    OF_FRAME(0x00181060, DS, 1, trigger),
    OF_FRAME(0x00209153, FD, 1, trigger),
    OF_FRAME(0x0020930d, FD, 1, trigger),
    OF_FRAME(0x00200012, DS, 1, acquisition),
    OF_FRAME(0x00080032, DS, 1, time),
    OF_FRAME(0x00200013, DS, 1, instance),
    OF_FRAME(0x0062000b, US, 1, segment),
};

static void clear_frame(hl_dicom_frame *frame) {
  double *const numbers = (double *)frame;
  for (size_t n = 0; n < offsetof(hl_dicom_frame, file) / sizeof(double); n++) numbers[n] = NAN;
  frame->file = frame->index = frame->tile = 0;
}

static void clear_header(hl_dicom_header *header) {
  *header = (hl_dicom_header){0};
  for (size_t n = 0; n < sizeof attributes / sizeof *attributes; n++) {
    const attribute *a = &attributes[n];
    if (a->of_frame || a->vr == 0) continue;
    double *place = (double *)(void *)((char *)header + a->place);
    for (int k = 0; k < a->numbers; k++) place[k] = NAN;
  }
  header->segments.fraction_most = NAN;
  clear_frame(&header->base);
}

/* Finds the frame of the file that the reader's current element describes. The element lies in the functional
 * groups of the file's frames. The first time that a frame is described, all its attributes are reset. */
static hl_status frame_of(const hl_dicom_reader *reader, hl_dicom_header *header, hl_dicom_frame **frame,
                          hl_error *error) {
  hl_context *context = hl_source_context(reader->source);
  size_t index = reader->level[0].item;
  if (index >= HL_DICOM_FRAMES_MOST)
    return hl_fail(error, HL_ERROR_INPUT, "%s: more than %d frames", hl_source_path(reader->source),
                   HL_DICOM_FRAMES_MOST);
  if (index >= header->frames_capacity) {
    size_t capacity = 2 * (index + 1) + 16;
    hl_dicom_frame *larger = hl_reallocate(context, header->frames, capacity, sizeof *larger);
    if (larger == NULL) return hl_fail_memory(error, capacity * sizeof *larger, "a list of frames");
    header->frames = larger;
    header->frames_capacity = capacity;
  }
  while (header->frames_told <= index) clear_frame(&header->frames[header->frames_told++]);
  *frame = &header->frames[index];
  return HL_OK;
}

static const attribute *find_attribute(uint32_t tag) {
  for (size_t n = 0; n < sizeof attributes / sizeof *attributes; n++)
    if (attributes[n].tag == tag) return &attributes[n];
  return NULL;
}

/* Reads the offsets of a dose grid's frames along the normal (PS3.3, C.8.8.3.2). */
static hl_status take_offsets(hl_dicom_reader *reader, const hl_dicom_element *element,
                              hl_dicom_header *header, hl_error *error) {
  enum { BYTES_MOST = 60000 };
  hl_context *context = hl_source_context(reader->source);
  if (element->length > BYTES_MOST || header->offsets != NULL) return HL_OK;
  char *text = hl_allocate(context, BYTES_MOST + 1, 1);
  header->offsets = hl_allocate(context, BYTES_MOST / 2, sizeof(double));
  hl_status status = text == NULL || header->offsets == NULL
                         ? hl_fail_memory(error, BYTES_MOST * 5, "offsets of frames")
                         : hl_dicom_text(reader, element, text, BYTES_MOST + 1, error);
  for (char *word = text, *next; status == HL_OK && word != NULL; word = next) {
    next = strchr(word, '\\');
    if (next != NULL) *next++ = 0;
    word = hl_text_trim(word);
    double number;
    if (!hl_text_number(word, strlen(word), &number)) break;
    header->offsets[header->offset_count++] = number;
  }
  hl_release(context, text);
  return status;
}

/* Makes a number from a text that names a kind of picture, so that kinds can be compared. Equal texts give
 * equal numbers (FNV-1a, cut to 52 bits). */
static double kind_of(const char *text) {
  uint64_t hash = 14695981039346656037u;
  for (; *text != 0; text++) hash = (hash ^ (unsigned char)*text) * 1099511628211u;
  return (double)(hash >> 12);
}

/* Reads the type of a single frame's picture, and stores its number as the frame's kind. */
static hl_status take_frame_type(hl_dicom_reader *reader, const hl_dicom_element *element,
                                 hl_dicom_header *header, hl_error *error) {
  char text[2 * HL_DICOM_TEXT_BYTES];
  hl_dicom_frame *frame;
  hl_status status = hl_dicom_text(reader, element, text, sizeof text, error);
  if (status == HL_OK) status = frame_of(reader, header, &frame, error);
  if (status == HL_OK) frame->kind = kind_of(text);
  return status;
}

static hl_status take(hl_dicom_reader *reader, const hl_dicom_element *element, hl_dicom_header *header,
                      hl_error *error) {
  uint32_t outer = reader->depth > 0 ? reader->level[0].tag : 0;
  if (outer == 0 && element->tag == 0x3004000c) return take_offsets(reader, element, header, error);
  hl_status status = hl_dicom_segments_take(reader, element, &header->segments, error);
  if (status == HL_OK) status = hl_dicom_mosaic_take(reader, element, &header->mosaic, error);
  if (status == HL_OK) status = hl_dicom_palette_take(reader, element, &header->palette, error);
  if (status == HL_OK) status = hl_dicom_vectors_take(reader, element, &header->vectors, error);
  if (status == HL_OK && outer == GROUPS_OF_FRAMES && element->tag == 0x00089007)
    return take_frame_type(reader, element, header, error);
  const attribute *a = find_attribute(element->tag);
  if (a == NULL || status != HL_OK) return status;
  bool of_frames = outer == GROUPS_OF_FRAMES;
  if (outer != 0 && !(a->of_frame && (of_frames || outer == SHARED_GROUPS || outer == DETECTORS)) &&
      !(outer == SHARED_GROUPS && a->tag == 0x00180050) && !(outer == SHARED_GROUPS && a->tag == 0x00180088))
    return HL_OK;
  char *place = (char *)header;
  if (a->of_frame) {
    hl_dicom_frame *frame = &header->base;
    status = of_frames ? frame_of(reader, header, &frame, error) : HL_OK;
    if (status != HL_OK) return status;
    place = (char *)frame;
  }
  if (a->vr == 0) return hl_dicom_text(reader, element, place + a->place, a->numbers, error);
  double numbers[6];
  int count;
  status = hl_dicom_numbers(reader, element, a->vr, numbers, a->numbers, &count, error);
  if (status == HL_OK && count == a->numbers)
    memcpy(place + a->place, numbers, (size_t)count * sizeof *numbers);
  return status;
}

/* ---- the results of reading a header ---- */

static hl_status refuse(const hl_source *source, const char *what, hl_error *error) {
  return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: %s: convert it with gdcmconv or dcm2niix",
                 hl_source_path(source), what);
}

static double or_else(double number, double other) { return isnan(number) ? other : number; }

static bool within(double number, double low, double high) { return number >= low && number <= high; }

static hl_status finish_pixels(const hl_source *source, hl_dicom_header *header, hl_error *error) {
  hl_dicom_pixels *p = &header->pixels;
  double samples = or_else(header->samples, 1), allocated = or_else(header->allocated, 16);
  double stored = or_else(header->stored, allocated), high = or_else(header->high, stored - 1);
  if (!within(header->rows, 1, 65535) || !within(header->columns, 1, 65535))
    return hl_fail(error, HL_ERROR_INPUT, "%s: the picture has no rows or no columns",
                   hl_source_path(source));
  if (samples != 1 && samples != 3)
    return refuse(source, "its pixels have neither one nor three samples", error);
  if (allocated != 1 && allocated != 8 && allocated != 16 && allocated != 32 && allocated != 64)
    return refuse(source, "its pixels have none of 1, 8, 16, 32 and 64 bits", error);
  if (!within(stored, 1, allocated) || !within(high, stored - 1, allocated - 1))
    stored = allocated, high = allocated - 1;
  p->rows = (size_t)header->rows;
  p->columns = (size_t)header->columns;
  p->samples = (size_t)samples;
  p->allocated = (int)allocated;
  p->stored = (int)stored;
  p->high = (int)high;
  p->is_signed = header->representation == 1;
  p->planar = header->planar == 1;
  /* In pictures of MONOCHROME1 the least value is shown white. Pictures of CT and PET are not inverted,
   * because their values are measurements */
  bool measured = hl_text_equal(header->modality, "CT") || hl_text_equal(header->modality, "PT");
  p->inverted = hl_text_equal(header->photometric, "MONOCHROME1") && !measured;
  p->is_ybr = hl_text_starts(header->photometric, "YBR_FULL");
  p->is_halved = hl_text_equal(header->photometric, "YBR_FULL_422");
  p->has_palette = p->samples == 1 && (p->allocated == 8 || p->allocated == 16) &&
                   hl_text_equal(header->photometric, "PALETTE COLOR") &&
                   hl_dicom_palette_is_whole(&header->palette) &&
                   header->segments.kind == HL_DICOM_NO_SEGMENTS;
  p->tiles = 1;
  if (header->matrix_rows > header->rows || header->matrix_columns > header->columns)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: tiles of a picture of %.0f x %.0f pixels (whole slide microscopy), and no volume: "
                   "export a stack as OME-TIFF",
                   hl_source_path(source), header->matrix_columns, header->matrix_rows);
  if (p->codec == HL_DICOM_UNKNOWN_CODEC)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: its transfer syntax %s is not read: decompress it with dcmdjpeg or gdcmconv --raw",
                   hl_source_path(source), header->syntax);
  if (p->is_float && p->allocated < 32) return refuse(source, "floats of fewer than 32 bits", error);
  if (p->allocated == 64 && !p->is_float) return refuse(source, "integers of 64 bits", error);
  bool any_bits = p->codec == HL_DICOM_NATIVE || (p->codec == HL_DICOM_RLE && p->allocated == 32);
  if (!any_bits && p->allocated != 8 && p->allocated != 16)
    return refuse(source, "its compressed pixels have neither 8 nor 16 bits", error);
  if (p->codec != HL_DICOM_NATIVE && !p->encapsulated)
    return hl_fail(error, HL_ERROR_INPUT, "%s: its pixels should be compressed, and are not",
                   hl_source_path(source));
  return HL_OK;
}

static hl_status take_pixels(const hl_dicom_reader *reader, const hl_dicom_element *element,
                             hl_dicom_header *header) {
  hl_dicom_pixels *p = &header->pixels;
  header->has_pixels = true;
  p->offset = element->offset;
  p->length = element->length;
  p->encapsulated = element->length == HL_DICOM_UNDEFINED;
  p->is_float = element->tag != HL_DICOM_PIXEL_DATA;
  p->big_endian = reader->big_endian || header->has_swapped_pixels;
  p->words = element->vr != HL_DICOM_VR('O', 'B');
  return HL_OK;
}

/* If a frame has no position in the patient's space, uses the frame's position in the space of an ultrasound
 * volume. */
static void take_volume_place(hl_dicom_header *header, hl_dicom_frame *frame) {
  if (isnan(frame->position[0]) && !isnan(frame->volume_position[0])) {
    memcpy(frame->position, frame->volume_position, sizeof frame->position);
    header->is_volume_space = true;
  }
  if (isnan(frame->orientation[0]) && !isnan(frame->volume_orientation[0]))
    memcpy(frame->orientation, frame->volume_orientation, sizeof frame->orientation);
}

/* Finds how many tiles a mosaic has along each side (mosaic.h). If the file does not state the number of
 * slices, warns, and leaves the mosaic as one picture. */
static void finish_mosaic(const hl_source *source, hl_dicom_header *header) {
  hl_dicom_pixels *p = &header->pixels;
  size_t tiles = (size_t)ceil(sqrt(fmin(header->mosaic.slices, 65536)));
  if (strstr(header->image_type, "MOSAIC") == NULL) return;
  if (header->mosaic.slices < 1 || tiles < 1 || p->rows % tiles != 0 || p->columns % tiles != 0) {
    hl_log(hl_source_context(source), HL_LOG_WARNING,
           "%s: a mosaic of slices that does not tell how many there are: it is shown as one picture",
           hl_source_path(source));
    return;
  }
  p->tiles = tiles;
}

/* Sets each attribute that the file does not state for the frame to the attribute's value for the whole
 * file. */
static void complete_frame(const hl_dicom_header *header, hl_dicom_frame *frame) {
  double *own = (double *)frame;
  const double *base = (const double *)&header->base;
  for (size_t n = 0; n < offsetof(hl_dicom_frame, file) / sizeof(double); n++)
    if (isnan(own[n])) own[n] = base[n];
}

static void finish_base(hl_dicom_header *header) {
  hl_dicom_frame *base = &header->base;
  for (int n = 0; n < 2; n++) base->spacing[n] = or_else(base->spacing[n], header->imager_spacing[n]);
  base->kind = kind_of(header->image_type);
  base->slope = or_else(base->slope, or_else(header->dose_scale, 1));
  base->intercept = or_else(base->intercept, 0);
  if (!isfinite(base->slope) || base->slope == 0) base->slope = 1;
  if (!isfinite(base->intercept)) base->intercept = 0;
  header->frame_count = within(header->frame_count, 1, HL_DICOM_FRAMES_MOST) ? floor(header->frame_count) : 1;
  if (header->frames_told > (size_t)header->frame_count) header->frames_told = (size_t)header->frame_count;
  for (size_t n = 0; n < header->frames_told; n++) {
    complete_frame(header, &header->frames[n]);
    take_volume_place(header, &header->frames[n]);
  }
  take_volume_place(header, base);
}

hl_status hl_dicom_header_read(hl_source **source, hl_dicom_header *header, hl_error *error) {
  hl_dicom_reader reader;
  hl_dicom_element element;
  clear_header(header);
  hl_status status = hl_dicom_begin(source, header, &reader, error);
  for (bool found = true; status == HL_OK && found && !header->has_pixels;) {
    status = hl_dicom_next(&reader, &element, &found, error);
    if (status != HL_OK || !found) break;
    bool pixels = element.tag == HL_DICOM_PIXEL_DATA || element.tag == 0x7fe00008 ||
                  element.tag == 0x7fe00009;
    status = pixels && reader.depth == 0 ? take_pixels(&reader, &element, header)
                                         : take(&reader, &element, header, error);
  }
  if (status != HL_OK || !header->has_pixels) return status;
  finish_base(header);
  status = finish_pixels(*source, header, error);
  if (status == HL_OK) finish_mosaic(*source, header);
  return status;
}

void hl_dicom_header_release(hl_context *context, hl_dicom_header *header) {
  hl_release(context, header->frames);
  hl_release(context, header->offsets);
  hl_dicom_segments_release(context, &header->segments);
  hl_dicom_palette_release(context, &header->palette);
  hl_dicom_vectors_release(context, &header->vectors);
  header->frames = NULL;
  header->offsets = NULL;
}
