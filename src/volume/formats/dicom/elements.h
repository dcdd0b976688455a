/* volume/formats/dicom/elements.h - reads the data elements of a DICOM file, one after the other.
 *
 * Elements inside sequences are returned, too. An element is identified by its own tag and by the tags of the
 * sequences around the element. Source: DICOM PS3.5, sections 7.1 (elements) and 7.5 (sequences). */
#ifndef HL_VOLUME_DICOM_ELEMENTS_H
#define HL_VOLUME_DICOM_ELEMENTS_H

#include "volume/io/source.h"

enum { HL_DICOM_DEPTH_MOST = 16, HL_DICOM_PIXEL_DATA = 0x7fe00010 };
#define HL_DICOM_UNDEFINED UINT32_MAX /* stated length of a sequence or item that an end marker ends */

/* Makes the number of a value representation from its two letters in the file: HL_DICOM_VR('U', 'S'). */
#define HL_DICOM_VR(a, b) ((uint16_t)((a) << 8 | (b)))

typedef struct hl_dicom_element {
  uint32_t tag; /* group << 16 | element */
  uint16_t vr;  /* value representation; 0 if the file states none */
  uint32_t length;
  uint64_t offset; /* position of the element's value in the file */
} hl_dicom_element;

/* A sequence whose items are being read. */
typedef struct hl_dicom_level {
  uint32_t tag;
  uint32_t item; /* number of the sequence's current item, from 0 */
  bool in_item, fragments;
  bool implicit;     /* whether the elements in the sequence's items state no value representations */
  uint64_t end;      /* position of the sequence's end; UINT64_MAX if an end marker ends it */
  uint64_t item_end; /* position of the item's end; UINT64_MAX if an end marker ends it */
} hl_dicom_level;

typedef struct hl_dicom_reader {
  hl_source *source; /* borrowed */
  uint64_t at;       /* position of the next element */
  bool implicit, big_endian;
  int depth;
  hl_dicom_level level[HL_DICOM_DEPTH_MOST];
} hl_dicom_reader;

/* Reads the next element that is not a sequence. *found is false at the end of the file, and after the pixel
 * data at the file's top level. */
hl_status hl_dicom_next(hl_dicom_reader *reader, hl_dicom_element *element, bool *found, hl_error *error);

/* Copies an element's text without leading and trailing blanks. The text is cut if the buffer is too
 * short. */
hl_status hl_dicom_text(hl_dicom_reader *reader, const hl_dicom_element *element, char *text, size_t size,
                        hl_error *error);
/* Reads up to `most` numbers of an element's value. vr: the type of the binary numbers, for files that state
 * none. *count: set to the number of values in the element. Entries of `numbers` beyond this count are not
 * changed. */
hl_status hl_dicom_numbers(hl_dicom_reader *reader, const hl_dicom_element *element, uint16_t vr,
                           double *numbers, int most, int *count, hl_error *error);

/* Read a whole number of 16 or 32 bits at an address of any alignment. */
uint32_t hl_dicom_u16(const unsigned char *bytes, bool big_endian);
uint32_t hl_dicom_u32(const unsigned char *bytes, bool big_endian);

#endif
