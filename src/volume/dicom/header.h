/* volume/dicom/header.h - what one DICOM file says of its picture: everything but the pixels.
 *
 * Numbers that a file does not give are NAN. Source: DICOM PS3.3 (the attributes), PS3.6 (their tags). */
#ifndef HL_VOLUME_DICOM_HEADER_H
#define HL_VOLUME_DICOM_HEADER_H

#include "volume/dicom/elements.h"

enum { HL_DICOM_UID_BYTES = 66, HL_DICOM_TEXT_BYTES = 66, HL_DICOM_FRAMES_MOST = 1 << 20 };

typedef enum hl_dicom_codec {
  HL_DICOM_NATIVE,
  HL_DICOM_RLE,
  HL_DICOM_JPEG,
  HL_DICOM_JPEG_LS,
  HL_DICOM_JPEG_2000,
  HL_DICOM_UNKNOWN_CODEC
} hl_dicom_codec;

/* Attributes that may differ between the frames of a file. */
typedef struct hl_dicom_frame {
  double position[3];    /* of the first voxel's centre, in the patient: LPS, millimetres */
  double orientation[6]; /* unit steps along a row, then along a column */
  double spacing[2];     /* between rows, then between columns */
  double slope, intercept;
  double temporal, echo, b_value, trigger, acquisition, instance; /* what tells volumes at one place apart */
  double segment;
  uint32_t file, index; /* in the list of files; the frame in the file */
} hl_dicom_frame;

/* How the pixels are written. */
typedef struct hl_dicom_pixels {
  size_t rows, columns, samples;
  int allocated, stored, high;                         /* bits; the place of the highest stored bit */
  bool is_signed, planar, is_float, big_endian, words; /* words: 8-bit pixels lie in 16-bit words */
  bool inverted;                                       /* MONOCHROME1: the least value is white */
  bool is_ybr, is_halved; /* luma and colour differences; these for every other column only */
  hl_dicom_codec codec;
  uint64_t offset, length; /* of the pixel data in the file; encapsulated: length is not told */
  bool encapsulated;
} hl_dicom_pixels;

typedef struct hl_dicom_header {
  char syntax[HL_DICOM_UID_BYTES];
  bool deflated;
  char series_uid[HL_DICOM_UID_BYTES], modality[HL_DICOM_TEXT_BYTES], description[HL_DICOM_TEXT_BYTES];
  char image_type[2 * HL_DICOM_TEXT_BYTES], photometric[HL_DICOM_TEXT_BYTES];
  double series_number;
  double rows, columns, samples, allocated, stored, high, representation, planar, frame_count;
  double padding[2]; /* the padding value and the other end of its range */
  double slice_spacing, thickness, imager_spacing[2], dose_scale;
  double window[2]; /* centre and width */
  hl_dicom_frame base;
  hl_dicom_frame *frames; /* owned; [frames_told]: from the functional groups of each frame; or null */
  size_t frames_told, frames_capacity;
  double *offsets; /* owned; [offset_count]: of frames along the normal (dose grids) */
  size_t offset_count;
  bool has_pixels;
  hl_dicom_pixels pixels;
} hl_dicom_header;

/* Whether bytes may begin a DICOM file: those with the mark, and those that begin with an element. */
bool hl_dicom_has_mark(const unsigned char *bytes, size_t length);
bool hl_dicom_may_begin(const unsigned char *bytes, size_t length);

/* Begins to read the elements after the file's own header: finds the transfer syntax. *source is replaced
 * where the rest is deflated. */
hl_status hl_dicom_begin(hl_source **source, hl_dicom_header *header, hl_dicom_reader *reader,
                         hl_error *error);

/* Reads a file's header up to its pixels. The header is to be released in any case. *source: as above. */
hl_status hl_dicom_header_read(hl_source **source, hl_dicom_header *header, hl_error *error);
void hl_dicom_header_release(hl_context *context, hl_dicom_header *header);

#endif
