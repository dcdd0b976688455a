/* volume/formats/dicom/jpeg_codes.h - reads marker segments, tables of codes and bits, for all JPEG processes
 * with Huffman codes.
 *
 * Source: ITU-T T.81. Markers: annex B. Codes: annexes C and F.2.2. */
#ifndef HL_VOLUME_DICOM_JPEG_CODES_H
#define HL_VOLUME_DICOM_JPEG_CODES_H

#include "volume/formats/dicom/codecs.h"

enum { HL_JPEG_TABLES = 4, HL_JPEG_LOOK_BITS = 9 };

typedef struct hl_jpeg_table {
  bool known;
  unsigned char values[256];
  int greatest[17];                      /* the greatest code of each length; -1 if no code has this length */
  int first[17];                         /* for each length: a code minus first[length] is the index of the
                                          * code's value */
  uint16_t look[1 << HL_JPEG_LOOK_BITS]; /* length << 8 | value; 0 for a longer code */
} hl_jpeg_table;

/* The state of reading one JPEG picture. */
typedef struct hl_jpeg_reader {
  const unsigned char *bytes;
  size_t length, at;
  uint64_t bits; /* the next bits of the data; the first bit is bit `bit_count` - 1 */
  int bit_count;
  size_t missing;                         /* number of bytes that were needed although the data had ended */
  size_t restart;                         /* number of units between two restart markers; 0 if the picture has
                                           * no restart markers */
  hl_jpeg_table table[2][HL_JPEG_TABLES]; /* tables of DC codes and differences; tables of AC codes */
} hl_jpeg_reader;

/* The markers of segments. */
enum {
  HL_JPEG_FRAME = 0xc0,          /* baseline JPEG */
  HL_JPEG_FRAME_EXTENDED = 0xc1, /* sequential JPEG with Huffman codes */
  HL_JPEG_FRAME_LOSSLESS = 0xc3,
  HL_JPEG_TABLES_OF_CODES = 0xc4,
  HL_JPEG_SCAN = 0xda,
  HL_JPEG_QUANTIZATION = 0xdb,
  HL_JPEG_RESTART_INTERVAL = 0xdd
};

/* The type of a decoder's function that takes the content of a marker segment. The reader itself takes the
 * tables of codes and the restart interval, and passes all other segments to this function. */
typedef hl_status hl_jpeg_take_function(void *decoder, int marker, const unsigned char *content,
                                        size_t length, hl_error *error);

/* Reads the marker segments up to and including the segment of the first scan. Afterwards the reader stands
 * at the first code of the scan. name: the kind of JPEG, for error lines. */
hl_status hl_jpeg_read_headers(hl_jpeg_reader *r, const hl_dicom_packed *packed, const char *name,
                               hl_jpeg_take_function *take, void *decoder, hl_error *error);

/* Reads bytes until r->bits holds at least 48 bits. Bits after a marker or after the end of the data are
 * zeros. */
void hl_jpeg_fill(hl_jpeg_reader *r);

/* Takes the next code, and returns its value; -1 if the table has no such code. r->bits must hold at least 32
 * bits. */
int hl_jpeg_take_code(hl_jpeg_reader *r, const hl_jpeg_table *table);

/* Takes `count` bits, 1 to 16, and returns the signed difference that they stand for (T.81, figure F.12). */
int hl_jpeg_take_number(hl_jpeg_reader *r, int count);

/* Skips everything up to and including the next restart marker. */
void hl_jpeg_take_restart(hl_jpeg_reader *r);

#endif
