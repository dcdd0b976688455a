/* volume/formats/dicom/set.c - reads the headers of all files and sorts the files into series. */
#include "volume/formats/dicom/set.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "core/vector.h"
#include "text/plain.h"
#include "volume/io/text.h"

/* Makes room for one more item of a list. */
static hl_status make_room(hl_context *context, void **items, size_t count, size_t *capacity, size_t size,
                           hl_error *error) {
  if (count < *capacity) return HL_OK;
  size_t wanted = *capacity > 0 ? 2 * *capacity : 32;
  void *larger = hl_reallocate(context, *items, wanted, size);
  if (larger == NULL) return hl_fail_memory(error, wanted * size, "a list of DICOM files");
  *items = larger;
  *capacity = wanted;
  return HL_OK;
}

/* ---- series ---- */

static hl_status find_series(hl_dicom_set *set, const hl_dicom_header *header, uint32_t *index,
                             hl_error *error) {
  for (size_t n = set->series_count; n > 0; n--)
    if (strcmp(set->series[n - 1].uid, header->series_uid) == 0 && !set->series[n - 1].is_segmentation &&
        header->segments.kind == HL_DICOM_NO_SEGMENTS) {
      *index = (uint32_t)(n - 1);
      return HL_OK;
    }
  hl_status status = make_room(set->context, (void **)&set->series, set->series_count, &set->series_capacity,
                               sizeof *set->series, error);
  if (status != HL_OK) return status;
  hl_dicom_series *series = &set->series[set->series_count];
  *series = (hl_dicom_series){.number = header->series_number,
                              .rows = hl_dicom_slice_rows(&header->pixels),
                              .columns = hl_dicom_slice_columns(&header->pixels),
                              .is_segmentation = header->segments.kind != HL_DICOM_NO_SEGMENTS};
  memcpy(series->uid, header->series_uid, sizeof series->uid);
  memcpy(series->modality, header->modality, sizeof series->modality);
  memcpy(series->description, header->description, sizeof series->description);
  *index = (uint32_t)set->series_count++;
  return HL_OK;
}

const char *hl_dicom_series_text(const hl_dicom_series *series, char *text, size_t size) {
  char number[32] = "no number", description[HL_PRINTABLE_BYTES], modality[HL_PRINTABLE_BYTES];
  if (!isnan(series->number)) hl_plain_print(number, sizeof number, "%.0f", series->number);
  snprintf(text, size, "%s: %s \"%s\", %zu x %zu x %zu", number,
           hl_text_printable(modality, series->modality), hl_text_printable(description, series->description),
           series->columns, series->rows, series->frames);
  return text;
}

static void list_series(const hl_dicom_set *set, char *text, size_t size) {
  enum { NAMED = 12 };
  size_t used = 0;
  text[0] = 0;
  for (size_t n = 0; n < set->series_count && n < NAMED && used < size; n++) {
    char one[200];
    used += (size_t)snprintf(text + used, size - used, "%s%s", n > 0 ? "; " : "",
                             hl_dicom_series_text(&set->series[n], one, sizeof one));
  }
  if (set->series_count > NAMED && used < size) snprintf(text + used, size - used, "; ...");
}

/* Rates how reliably a text names a series. The rate is 3 if the text is the series' UID, 2 if it is the
 * series' number, 1 if it is the series' description, and else 0. */
static int match(const hl_dicom_series *series, const char *wanted) {
  double number;
  if (strcmp(series->uid, wanted) == 0) return 3;
  if (hl_text_number(wanted, strlen(wanted), &number) && number == series->number) return 2;
  return hl_text_equal(series->description, wanted) ? 1 : 0;
}

static size_t largest(const hl_dicom_set *set) {
  size_t chosen = 0;
  double most = 0;
  for (size_t n = 0; n < set->series_count; n++) {
    const hl_dicom_series *series = &set->series[n];
    double size = (double)series->rows * (double)series->columns * (double)series->frames;
    /* A series of a single picture is chosen only if no series has several frames. */
    if (series->frames == 1) size *= 1e-6;
    if (series->is_segmentation)
      /* A segmentation is chosen only if no scan has a similar size, because most users who name no series
       * want the scan. */
      size *= 1e-3;
    if (size > most) {
      most = size;
      chosen = n;
    }
  }
  return chosen;
}

hl_status hl_dicom_series_choose(const hl_dicom_set *set, const char *wanted, size_t *chosen,
                                 hl_error *error) {
  char list[600], shown[HL_PRINTABLE_BYTES];
  if (wanted == NULL) {
    *chosen = largest(set);
    if (set->series_count == 1) return HL_OK;
    char one[200];
    list_series(set, list, sizeof list);
    hl_log(set->context, HL_LOG_WARNING,
           "%s: of %zu series, %s is taken: choose by \"series\" (--series): %s", set->bundle->path,
           set->series_count, hl_dicom_series_text(&set->series[*chosen], one, sizeof one), list);
    return HL_OK;
  }
  int best = 0, equal = 0;
  for (size_t n = 0; n < set->series_count; n++) {
    int how = match(&set->series[n], wanted);
    if (how > best) equal = 0;
    if (how == 0 || how < best) continue;
    if (equal++ == 0) *chosen = n;
    best = how;
  }
  if (equal == 1) return HL_OK;
  if (equal > 1)
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: %d series are called \"%s\": give a UID: %s is the first, %s the last",
                   set->bundle->path, equal, hl_text_printable(shown, wanted), set->series[*chosen].uid,
                   set->series[set->series_count - 1].uid);
  list_series(set, list, sizeof list);
  return hl_fail(error, HL_ERROR_INPUT, "%s: there is no series \"%s\": there is %s", set->bundle->path,
                 hl_text_printable(shown, wanted), list);
}

/* ---- files ---- */

static void move(hl_dicom_frame *frame, vec3 direction, double distance) {
  frame->position[0] += distance * direction.x;
  frame->position[1] += distance * direction.y;
  frame->position[2] += distance * direction.z;
}

/* The distance between slices that the file states: the slice spacing, else the slice thickness, else 1. The
 * distance is negative if slices follow each other in the direction opposite to the normal. */
static double stated_step(const hl_dicom_header *header) {
  if (isfinite(header->slice_spacing) && header->slice_spacing != 0) return header->slice_spacing;
  return header->thickness > 0 && isfinite(header->thickness) ? header->thickness : 1;
}

/* Sets the position of a tile of a mosaic. The position that the file states belongs to a picture that has
 * the mosaic's size and the same centre as the first slice. */
static void place_tile(const hl_dicom_header *header, size_t tile, hl_dicom_frame *frame) {
  const hl_dicom_pixels *p = &header->pixels;
  vec3 row = vec3_of(frame->orientation), column = vec3_of(frame->orientation + 3),
       way = vec3_cross(row, column);
  double step = fabs(stated_step(header));
  if (vec3_dot(way, vec3_of(header->mosaic.normal)) < 0) step = -step;
  move(frame, row, (double)(p->columns - hl_dicom_slice_columns(p)) / 2 * frame->spacing[1]);
  move(frame, column, (double)(p->rows - hl_dicom_slice_rows(p)) / 2 * frame->spacing[0]);
  move(frame, way, (double)tile * step);
  frame->tile = (uint32_t)tile;
}

/* Sets the position of a frame. If the file does not state a position for each frame, frames follow each
 * other along the normal. */
static void place_frame(const hl_dicom_header *header, size_t index, hl_dicom_frame *frame) {
  *frame = index < header->frames_told ? header->frames[index] : header->base;
  frame->index = (uint32_t)index;
  if (header->frames_told > 0 || header->frame_count < 2) return;
  size_t slice = hl_dicom_vectors_slice(&header->vectors, index);
  double distance = (double)slice * stated_step(header),
         volume = hl_dicom_vectors_volume(&header->vectors, index);
  if (!isnan(volume)) frame->temporal = volume;
  /* PS3.3, C.8.8.3.2: offsets may be counted from the first frame's position, or may be coordinates; the
   * first offset is subtracted from all offsets, so that the first distance is 0 */
  if (index < header->offset_count) distance = header->offsets[index] - header->offsets[0];
  move(frame, vec3_cross(vec3_of(frame->orientation), vec3_of(frame->orientation + 3)), distance);
}

/* Checks, before anything is allocated, that the file is long enough for the pixels that its header
 * promises. */
static hl_status check_length(const hl_source *source, const hl_dicom_header *header, hl_error *error) {
  const hl_dicom_pixels *p = &header->pixels;
  uint64_t size = hl_source_size(source), frames = (uint64_t)header->frame_count, needed;
  uint64_t left = p->offset < size ? size - p->offset : 0;
  uint64_t bits = (uint64_t)p->rows * p->columns * (p->is_halved && !p->encapsulated ? 2 : p->samples) *
                  (uint64_t)p->allocated;
  if (p->encapsulated) needed = frames * 8; /* a frame has a fragment or more, of 8 bytes or more */
  else if (__builtin_mul_overflow(bits, frames, &needed)) needed = UINT64_MAX;
  else needed = needed / 8 + (needed % 8 != 0);
  if (needed <= left) return HL_OK;
  return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)p->offset,
                        "%s: %llu frames of %zu x %zu pixels need %llu bytes, the file has only %llu",
                        hl_source_path(source), (unsigned long long)frames, p->columns, p->rows,
                        (unsigned long long)needed, (unsigned long long)left);
}

/* The number of slices in a frame, which is greater than 1 only for a mosaic. */
static size_t slices_of_frame(const hl_dicom_header *header) {
  return header->pixels.tiles > 1 ? (size_t)header->mosaic.slices : 1;
}

static hl_status add_frames(hl_dicom_set *set, const hl_dicom_header *header, size_t file, hl_error *error) {
  size_t slices = slices_of_frame(header), count = (size_t)header->frame_count * slices;
  for (size_t n = 0; n < count; n++) {
    hl_status status = make_room(set->context, (void **)&set->frames, set->frame_count, &set->frame_capacity,
                                 sizeof *set->frames, error);
    if (status != HL_OK) return status;
    hl_dicom_frame *frame = &set->frames[set->frame_count++];
    place_frame(header, n / slices, frame);
    if (slices > 1) place_tile(header, n % slices, frame);
    frame->file = (uint32_t)file;
  }
  if (hl_dicom_vectors_are_projections(&header->vectors))
    hl_log(set->context, HL_LOG_WARNING,
           "%s: its frames are projections from several sides, not slices of a volume: they are shown one "
           "behind the "
           "other",
           set->bundle->path);
  return HL_OK;
}

/* Finds the range of padding values, in the pixels' own type (PS3.3, C.7.5.1.1.2). */
static void take_padding(const hl_dicom_header *header, double padding[2]) {
  for (int n = 0; n < 2; n++) {
    double value = header->padding[n];
    if (header->representation == 1 && value >= 32768) value -= 65536;
    if (header->pixels.inverted)
      value = header->representation == 1 ? -1 - value : ldexp(1, header->pixels.stored) - 1 - value;
    padding[n] = value;
  }
  if (isnan(padding[1])) padding[1] = padding[0];
  if (padding[0] > padding[1]) {
    double other = padding[0];
    padding[0] = padding[1];
    padding[1] = other;
  }
}

/* Adds a file to the set, which takes over the header's segments and palette. */
static hl_status add_file(hl_dicom_set *set, hl_dicom_header *header, size_t entry, hl_error *error) {
  hl_status status = make_room(set->context, (void **)&set->files, set->file_count, &set->file_capacity,
                               sizeof *set->files, error);
  if (status != HL_OK) return status;
  hl_dicom_file *file = &set->files[set->file_count];
  *file = (hl_dicom_file){.entry = (uint32_t)entry,
                          .pixels = header->pixels,
                          .slice_spacing = header->slice_spacing,
                          .thickness = header->thickness,
                          .window = {header->window[0], header->window[1]},
                          .is_localizer = strstr(header->image_type, "LOCALIZER") != NULL,
                          .is_deflated = header->deflated,
                          .frames.is_backwards = header->frames_told == 0 && header->frame_count > 1 &&
                                                 header->slice_spacing < 0 && header->offset_count == 0,
                          .is_volume_space = header->is_volume_space,
                          .frames.are_times = header->vectors.are_times,
                          .frames.count = (size_t)header->frame_count};
  /* Padding values mark pixels outside of the picture. In segmentations, pixels outside of the picture are
   * 0. */
  if (header->segments.kind == HL_DICOM_NO_SEGMENTS) take_padding(header, file->padding);
  else file->padding[0] = file->padding[1] = NAN;
  status = find_series(set, header, &file->series, error);
  if (status == HL_OK) status = add_frames(set, header, set->file_count, error);
  if (status != HL_OK) return status;
  set->series[file->series].frames += file->frames.count * slices_of_frame(header);
  file->segments = header->segments;
  file->palette = header->palette;
  header->segments = (hl_dicom_segments){HL_DICOM_NO_SEGMENTS, NAN, NULL, 0, 0};
  header->palette = (hl_dicom_palette){.entries = {NULL}};
  set->file_count++;
  return HL_OK;
}

/* Counts a DICOM file that cannot be read, and keeps the first error. */
static void add_damaged(hl_dicom_set *set, size_t *count, const char *why) {
  if (set->damaged + set->remnants == 0) snprintf(set->first_damage, sizeof set->first_damage, "%.299s", why);
  ++*count;
}

static hl_status read_file(hl_dicom_set *set, size_t entry, bool strict, hl_error *error) {
  const char *name = set->bundle->entries[entry].name;
  hl_source *source = NULL;
  hl_dicom_header header = {.frames = NULL};
  const unsigned char *bytes;
  size_t available;
  hl_status status = hl_bundle_entry_open(set->bundle, &set->bundle->entries[entry], false, &source, error);
  if (status == HL_OK) status = hl_source_peek(source, 0, 132, &bytes, &available, error);
  bool is_dicom = status == HL_OK && hl_dicom_may_begin(bytes, available);
  bool is_known = is_dicom && (hl_dicom_has_mark(bytes, available) || hl_dicom_is_named(name));
  bool is_remnant = status == HL_OK && !is_dicom && !strict && hl_dicom_is_remnant(name, bytes, available);
  if (is_dicom || (status == HL_OK && strict)) status = hl_dicom_header_read(&source, &header, error);
  if (status == HL_OK && header.has_pixels) status = check_length(source, &header, error);
  if (status == HL_OK && header.has_pixels) status = add_file(set, &header, entry, error);
  if (is_remnant) {
    char why[300];
    snprintf(why, sizeof why, "%.200s: the file ends after %zu bytes, before its first element",
             hl_source_path(source), available);
    add_damaged(set, &set->remnants, why);
  }
  hl_dicom_header_release(set->context, &header);
  hl_source_close(source);
  if (status == HL_OK || status == HL_ERROR_MEMORY || status == HL_ERROR_CANCELLED || strict) return status;
  if (is_known) add_damaged(set, &set->damaged, error != NULL ? error->message : "");
  return HL_OK;
}

hl_status hl_dicom_set_read(hl_context *context, const hl_bundle *bundle, bool strict, hl_dicom_set *set,
                            hl_error *error) {
  *set = (hl_dicom_set){.context = context, .bundle = bundle};
  hl_error own = {0};
  hl_status status = HL_OK;
  for (size_t n = 0; n < bundle->count && status == HL_OK; n++) {
    status = read_file(set, n, strict, &own);
    if (status == HL_OK && hl_cancelled(context))
      status = hl_fail(&own, HL_ERROR_CANCELLED, "%s: cancelled", bundle->path);
  }
  if (status != HL_OK && error != NULL) *error = own;
  return status;
}

void hl_dicom_set_release(hl_dicom_set *set) {
  for (size_t n = 0; n < set->file_count; n++) {
    hl_release(set->context, set->files[n].frames.begins);
    hl_dicom_segments_release(set->context, &set->files[n].segments);
    hl_dicom_palette_release(set->context, &set->files[n].palette);
  }
  hl_release(set->context, set->files);
  hl_release(set->context, set->series);
  hl_release(set->context, set->frames);
}

hl_status hl_dicom_file_open(const hl_dicom_set *set, const hl_dicom_file *file, hl_source **source,
                             hl_error *error) {
  hl_status status = hl_bundle_entry_open(set->bundle, &set->bundle->entries[file->entry], true, source,
                                          error);
  if (status != HL_OK || !file->is_deflated) return status;
  hl_dicom_header header = {.syntax = ""};
  hl_dicom_reader reader;
  status = hl_dicom_begin(source, &header, &reader, error);
  if (status != HL_OK) hl_source_close(*source);
  return status;
}
