/* volume/formats/dicom/rle.c - decodes DICOM's run-length coding (PS3.5, annex G).
 *
 * A frame begins with a header of sixteen 32-bit numbers: the number of segments, then the offset of each
 * segment. A segment holds one byte of every pixel, compressed like PackBits. The first segment holds the
 * highest byte of a sample. */
#include <string.h>

#include "core/error.h"
#include "volume/formats/dicom/codecs.h"

enum { HEADER_BYTES = 64, SEGMENTS_MOST = 15 };

static const bool native_is_big_endian = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;

/* Unpacks a segment to `count` bytes that lie `step` bytes apart. Returns false if the segment ends too
 * early. */
static bool unpack(const unsigned char *bytes, size_t length, size_t count, size_t step, unsigned char *to) {
  size_t done = 0;
  for (size_t n = 0; done < count && n < length;) {
    unsigned control = bytes[n++];
    size_t run = control < 128 ? control + 1u : 257u - control;
    if (control == 128) continue;
    if (run > count - done) run = count - done; /* further bytes of the run are padding of a row */
    if (control < 128) {
      if (length - n < run) return false;
      for (size_t k = 0; k < run; k++) to[(done + k) * step] = bytes[n + k];
      n += control + 1u <= length - n ? control + 1u : length - n;
    } else {
      if (n == length) return false;
      for (size_t k = 0; k < run; k++) to[(done + k) * step] = bytes[n];
      n++;
    }
    done += run;
  }
  return done == count;
}

hl_status hl_dicom_decode_rle(const hl_dicom_packed *packed, void *values, hl_error *error) {
  const hl_dicom_pixels *p = packed->pixels;
  size_t bytes_each = p->allocated > 8 ? (size_t)p->allocated / 8 : 1, segments = p->samples * bytes_each;
  if (packed->length < HEADER_BYTES)
    return hl_dicom_fail_packed(packed, "RLE", "it is shorter than its header", error);
  if (hl_dicom_u32(packed->bytes, false) != segments || segments > SEGMENTS_MOST)
    return hl_dicom_fail_packed(packed, "RLE", "it has another number of segments than a pixel has bytes",
                                error);
  for (size_t segment = 0; segment < segments; segment++) {
    size_t begin = hl_dicom_u32(packed->bytes + 4 + 4 * segment, false), end = packed->length;
    if (segment + 1 < segments) end = hl_dicom_u32(packed->bytes + 8 + 4 * segment, false);
    if (end > packed->length) end = packed->length;
    if (begin < HEADER_BYTES || begin > end)
      return hl_dicom_fail_packed(packed, "RLE", "a segment begins outside the picture's bytes", error);
    size_t sample = segment / bytes_each, place = segment % bytes_each; /* the first segment of a sample holds
                                                                         * its highest byte */
    if (!native_is_big_endian) place = bytes_each - 1 - place;
    if (!unpack(packed->bytes + begin, end - begin, p->rows * p->columns, p->samples * bytes_each,
                (unsigned char *)values + sample * bytes_each + place))
      return hl_dicom_fail_packed(packed, "RLE", "a segment ends too early", error);
  }
  return HL_OK;
}
