/* volume/formats/dicom/set.h - lists all DICOM pictures of an input, their frames, and the series to which
 * they belong. */
#ifndef HL_VOLUME_DICOM_SET_H
#define HL_VOLUME_DICOM_SET_H

#include "volume/formats/dicom/header.h"
#include "volume/io/bundle.h"

typedef struct hl_dicom_file {
  uint32_t entry, series; /* index of the file in the bundle; index of the file's series in the set */
  hl_dicom_pixels pixels;
  double padding[2]; /* the range of padding values, which mark pixels without data; NAN if there is none */
  double slice_spacing, thickness, window[2];
  bool is_volume_space; /* whether positions are in the space of an ultrasound volume instead of the patient's
                         * space */
  hl_dicom_segments segments; /* owned */
  hl_dicom_palette palette;   /* owned */
  bool is_localizer, is_deflated;
  struct {
    size_t count;
    bool is_backwards; /* whether frames without stated positions follow each other in the direction opposite
                        * to the normal */
    bool are_times;    /* whether the frames follow each other in time */
    uint64_t *begins;  /* owned; [count + 1]; positions of the frames' first fragments. Null until they are
                        * found; always null for files of one frame or without fragments */
  } frames;
} hl_dicom_file;

typedef struct hl_dicom_series {
  char uid[HL_DICOM_UID_BYTES], modality[HL_DICOM_TEXT_BYTES], description[HL_DICOM_TEXT_BYTES];
  double number; /* NAN if absent */
  size_t frames;
  size_t rows, columns; /* rows and columns of the series' first slice */
  bool is_segmentation; /* whether the series is one file with segments */
} hl_dicom_series;

typedef struct hl_dicom_set {
  hl_context *context;
  const hl_bundle *bundle;
  hl_dicom_file *files;    /* owned; [file_count] */
  hl_dicom_series *series; /* owned; [series_count] */
  hl_dicom_frame *frames;  /* owned; [frame_count] */
  size_t file_count, file_capacity, series_count, series_capacity, frame_count, frame_capacity;
  size_t damaged;         /* DICOM files that could not be read */
  size_t remnants;        /* files that may be rests of DICOM files (hl_dicom_is_remnant()) */
  char first_damage[300]; /* error of the first damaged file or remnant */
} hl_dicom_set;

/* Reads the headers of all DICOM files in the bundle. strict: whether to fail at a file that cannot be read;
 * otherwise the file is counted as damaged. */
hl_status hl_dicom_set_read(hl_context *context, const hl_bundle *bundle, bool strict, hl_dicom_set *set,
                            hl_error *error);
void hl_dicom_set_release(hl_dicom_set *set);

/* Finds the wanted series by its UID, number or description. If wanted is null, finds the series with the
 * most voxels. */
hl_status hl_dicom_series_choose(const hl_dicom_set *set, const char *wanted, size_t *chosen,
                                 hl_error *error);

/* Writes the line of a series for a list: "3 CT \"Thorax\" 512 x 512 x 200". */
const char *hl_dicom_series_text(const hl_dicom_series *series, char *text, size_t size);

/* Opens a file for reading its elements. If the elements are deflated, the source inflates them. */
hl_status hl_dicom_file_open(const hl_dicom_set *set, const hl_dicom_file *file, hl_source **source,
                             hl_error *error);

#endif
