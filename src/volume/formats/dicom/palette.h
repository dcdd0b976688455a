/* volume/formats/dicom/palette.h - finds the colours that the pixels of a PALETTE COLOR picture stand for.
 *
 * Source: DICOM PS3.3, C.7.6.3.1.5 and C.7.6.3.1.6; C.7.9.2 (segmented tables). */
#ifndef HL_VOLUME_DICOM_PALETTE_H
#define HL_VOLUME_DICOM_PALETTE_H

#include "volume/formats/dicom/elements.h"

typedef struct hl_dicom_palette {
  double descriptor[3][3];   /* for each of red, green, blue: number of entries (0 stands for 65536), first
                              * pixel value, bits of an entry */
  unsigned char *entries[3]; /* owned; [65536]; codes of 8 bits; null if not stated */
  size_t counts[3];          /* number of entries that the file states for red, green, blue */
} hl_dicom_palette;

/* Stores the part of the palette that an element states. The element stands at the top level of the file, not
 * within a sequence. Elements that do not concern palettes change nothing. */
hl_status hl_dicom_palette_take(hl_dicom_reader *reader, const hl_dicom_element *element,
                                hl_dicom_palette *palette, hl_error *error);
void hl_dicom_palette_release(hl_context *context, hl_dicom_palette *palette);

bool hl_dicom_palette_is_whole(const hl_dicom_palette *palette);

/* The colour of a pixel value. A value beyond an end of the table has the colour at this end. */
void hl_dicom_palette_color(const hl_dicom_palette *palette, double value, unsigned char rgb[3]);

#endif
