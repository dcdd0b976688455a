/* volume/dicom/header.h - the header of one DICOM file: everything but the pixels.
 *
 * Numbers that a file does not state are NAN. Source: DICOM PS3.3 (the attributes), PS3.6 (their tags). */
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
  double temporal, echo, b_value, trigger, acquisition,
      instance; /* differ between volumes at the same positions: echoes, diffusion, phases, times */
  double segment;
  uint32_t file, index; /* index of the file in the set, and of the frame in the file */
} hl_dicom_frame;

/* How the pixels are written. */
typedef struct hl_dicom_pixels {
  size_t rows, columns, samples;
  int allocated, stored, high;                         /* bits; the place of the highest stored bit */
  bool is_signed, planar, is_float, big_endian, words; /* words: 8-bit pixels lie in 16-bit words */
  bool inverted;                                       /* MONOCHROME1: the least value is white */
  bool is_ybr, is_halved; /* is_ybr: brightness and two colour differences; is_halved: the differences are
                             stored for every other column only */
  hl_dicom_codec codec;
  uint64_t offset, length; /* of the pixel data in the file; the length is unset where encapsulated */
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
  hl_dicom_frame
      *frames; /* owned; [frames_told]: the attributes that the file states for single frames; or null */
  size_t frames_told, frames_capacity;
  double *offsets; /* owned; [offset_count]: the frames' offsets along the normal, of dose grids */
  size_t offset_count;
  bool has_pixels;
  hl_dicom_pixels pixels;
} hl_dicom_header;

/* Whether bytes may begin a DICOM file: one with the mark "DICM", or one that begins with an element. */
bool hl_dicom_has_mark(const unsigned char *bytes, size_t length);
bool hl_dicom_may_begin(const unsigned char *bytes, size_t length);

/* Prepares the reader for the elements after the file's meta information, whose transfer syntax it finds.
 * *source is replaced if the rest of the file is deflated. */
hl_status hl_dicom_begin(hl_source **source, hl_dicom_header *header, hl_dicom_reader *reader,
                         hl_error *error);

/* Reads a file's header up to its pixels. Release the header in any case. *source: as above. */
hl_status hl_dicom_header_read(hl_source **source, hl_dicom_header *header, hl_error *error);
void hl_dicom_header_release(hl_context *context, hl_dicom_header *header);

#endif
