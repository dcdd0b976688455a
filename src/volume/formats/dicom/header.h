/* volume/formats/dicom/header.h - reads the header of one DICOM file: everything except the pixels.
 *
 * Numbers that a file does not state are NAN. Source: DICOM PS3.3 (the attributes), PS3.6 (their tags). */
#ifndef HL_VOLUME_DICOM_HEADER_H
#define HL_VOLUME_DICOM_HEADER_H

#include "volume/formats/dicom/elements.h"
#include "volume/formats/dicom/mosaic.h"
#include "volume/formats/dicom/palette.h"
#include "volume/formats/dicom/segments.h"
#include "volume/formats/dicom/vectors.h"

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
  double position[3];    /* the centre of the first voxel, in the patient's space: LPS, millimetres */
  double orientation[6]; /* unit vector along a row, then unit vector along a column */
  double spacing[2];     /* distance between rows, then distance between columns */
  double slope, intercept;
  double location;                                  /* SliceLocation: coordinate along the normal,
                                                     * millimetres */
  double volume_position[3], volume_orientation[6]; /* position and orientation in the space of an ultrasound
                                                     * volume */
  /* Attributes that tell volumes at the same positions apart: echoes, diffusion, phases, times, kinds of
   * pictures. */
  double temporal, echo, b_value, diffusion[3], inversion, flip, trigger, kind, acquisition, time, instance;
  double segment;       /* the number of the segment that the frame shows */
  uint32_t file, index; /* index of the file in the set; index of the frame in the file */
  uint32_t tile;        /* number of the frame's tile in a mosaic */
} hl_dicom_frame;

/* The format of the pixels. */
typedef struct hl_dicom_pixels {
  size_t rows, columns, samples;
  int allocated, stored, high;                         /* number of bits that a sample takes; number of bits
                                                        * that are used; position of the highest used bit */
  bool is_signed, planar, is_float, big_endian, words; /* words: whether 8-bit pixels are stored in pairs as
                                                        * 16-bit words */
  size_t tiles;           /* number of tiles along each side of a mosaic, in which each tile is a slice; 1 for
                           * other pictures */
  bool inverted;          /* whether the least value is shown white (MONOCHROME1) */
  bool is_ybr, is_halved; /* is_ybr: whether colours are stored as luma and two colour differences; is_halved:
                           * whether the differences are stored only for every other column */
  bool has_palette;       /* whether each pixel is an index into a table of colours, which becomes three
                           * samples of 8 bits */
  hl_dicom_codec codec;
  uint64_t offset, length; /* position and length of the pixel data in the file; encapsulated pixel data have
                            * no length */
  bool encapsulated;
} hl_dicom_pixels;

typedef struct hl_dicom_header {
  char syntax[HL_DICOM_UID_BYTES];
  bool deflated, has_swapped_pixels; /* has_swapped_pixels: whether pixels are big-endian although all other
                                      * elements are little-endian */
  char series_uid[HL_DICOM_UID_BYTES], modality[HL_DICOM_TEXT_BYTES], description[HL_DICOM_TEXT_BYTES];
  char image_type[2 * HL_DICOM_TEXT_BYTES], photometric[HL_DICOM_TEXT_BYTES];
  double series_number;
  double rows, columns, samples, allocated, stored, high, representation, planar, frame_count;
  double padding[2]; /* the padding value, and the other end of the range of padding values */
  double slice_spacing, thickness, imager_spacing[2], dose_scale;
  double window[2]; /* centre and width of the window of data values to show */
  hl_dicom_frame base;
  hl_dicom_frame *frames; /* owned; [frames_told]; the attributes that the file states for single frames; null
                           * if the file states none */
  size_t frames_told, frames_capacity;
  double *offsets; /* owned; [offset_count]; for a dose grid, the offsets of its frames along the normal */
  size_t offset_count;
  double matrix_rows, matrix_columns; /* size of a larger picture, if the frames are its tiles */
  hl_dicom_mosaic mosaic;
  hl_dicom_palette palette;
  hl_dicom_segments segments;
  hl_dicom_vectors vectors;
  bool is_volume_space; /* whether positions are in the space of an ultrasound volume instead of the patient's
                         * space */
  bool has_pixels;
  hl_dicom_pixels pixels;
} hl_dicom_header;

/* The size of a slice. A slice of a mosaic has the size of a tile; any other slice has the size of the whole
 * picture. */
static inline size_t hl_dicom_slice_rows(const hl_dicom_pixels *p) { return p->rows / p->tiles; }
static inline size_t hl_dicom_slice_columns(const hl_dicom_pixels *p) { return p->columns / p->tiles; }
/* The number of samples that a pixel has after it is read. A pixel with a palette has three samples. */
static inline size_t hl_dicom_read_samples(const hl_dicom_pixels *p) {
  return p->has_palette ? 3 : p->samples;
}

/* Returns whether bytes have the mark "DICM" (hl_dicom_has_mark()), or may begin a DICOM file with or without
 * this mark (hl_dicom_may_begin()). */
bool hl_dicom_has_mark(const unsigned char *bytes, size_t length);
bool hl_dicom_may_begin(const unsigned char *bytes, size_t length);
/* Returns whether a file's name has an ending that DICOM files have. */
bool hl_dicom_is_named(const char *path);
/* Returns whether a file may be the rest of a DICOM file that was cut before the end of its mark: the file
 * holds only zeros, or its name has an ending that DICOM files have. length: the length of the file, or at
 * least 132. */
bool hl_dicom_is_remnant(const char *path, const unsigned char *bytes, size_t length);

/* Reads the file's meta information, which states the transfer syntax, and prepares the reader for the
 * elements after it. *source is replaced if the rest of the file is deflated. */
hl_status hl_dicom_begin(hl_source **source, hl_dicom_header *header, hl_dicom_reader *reader,
                         hl_error *error);

/* Reads a file's header up to its pixels. The caller must release the header also after a failure. *source
 * may be replaced, as by hl_dicom_begin(). */
hl_status hl_dicom_header_read(hl_source **source, hl_dicom_header *header, hl_error *error);
void hl_dicom_header_release(hl_context *context, hl_dicom_header *header);

#endif
