/* surface/sample_rows.h - defines the positions of the sixteen samples of a pixel.
 *
 * Sample i lies at ((i + 1/2) / 16, (SAMPLE_ROWS[i] + 1/2) / 16) of the pixel. No two samples share a row or
 * a column. */
#ifndef HL_SURFACE_SAMPLE_ROWS_H
#define HL_SURFACE_SAMPLE_ROWS_H

static const unsigned char SAMPLE_ROWS[16] = {3, 10, 1, 8, 15, 6, 13, 4, 11, 2, 9, 0, 7, 14, 5, 12};

/* Four words of 16 bits. Word b has a bit for each sample of a pixel, which is set if bit b of the sample's
 * row number is set. */
#define SAMPLE_ROW_BITS 0xa55af0f033335555u

#endif
