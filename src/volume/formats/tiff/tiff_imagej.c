/* volume/formats/tiff/tiff_imagej.c - reads the colours and the windows of channels from a private tag of
 * ImageJ.
 *
 * Source: ImageJ's ij/io/TiffEncoder.java and TiffDecoder.java. Tag 50839 holds a header and pieces of data.
 * The header has the mark "IJIJ" and, for each kind of data, its four letters and the number of its pieces.
 * Tag 50838 has the length of the header and of each piece. Data of the kind "rang" are one piece of doubles:
 * a least and a greatest value for each channel. Data of the kind "luts" are a piece for each channel, which
 * has 256 values of red, then of green, then of blue. Numbers and letters are in the byte order of the
 * file. */
#include "volume/formats/tiff/tiff_imagej.h"

#include <math.h>
#include <string.h>

enum { TAG_LENGTHS = 50838, TAG_BYTES = 50839, TABLE = 256, HEADER_MOST = 1024 };

static uint32_t word_at(const unsigned char *at, bool high_first) {
  uint32_t word = 0;
  for (int n = 0; n < 4; n++) word = word << 8 | at[high_first ? n : 3 - n];
  return word;
}

static double double_at(const unsigned char *at, bool high_first) {
  uint64_t bits = 0;
  double value;
  for (int n = 0; n < 8; n++) bits = bits << 8 | at[high_first ? n : 7 - n];
  memcpy(&value, &bits, sizeof value);
  return value;
}

static void take_table(const unsigned char *table, hl_channel *channel) {
  channel->has_color = true;
  for (int c = 0; c < 3; c++) channel->srgb[c] = table[c * TABLE + TABLE - 1] / 255.0;
}

static void take_ranges(const unsigned char *ranges, uint32_t bytes, bool high_first, hl_channel *channels) {
  for (uint32_t n = 0; n < TIFF_IMAGEJ_CHANNELS_MOST && 16 * (n + 1) <= bytes; n++) {
    double low = double_at(ranges + 16 * n, high_first), high = double_at(ranges + 16 * n + 8, high_first);
    if (!isfinite(low) || !isfinite(high)) continue;
    channels[n].window[0] = low, channels[n].window[1] = high;
  }
}

size_t tiff_imagej_channels(const tiff_file *file, hl_channel *channels) {
  uint32_t length_count = 0, byte_count = 0;
  const uint32_t *lengths = NULL;
  const unsigned char *bytes = NULL;
  size_t found = 0;
  bool high_first = TIFFIsBigEndian(file->tiff) != 0;
  memset(channels, 0, TIFF_IMAGEJ_CHANNELS_MOST * sizeof *channels);
  if (!TIFFGetField(file->tiff, TAG_LENGTHS, &length_count, &lengths) ||
      !TIFFGetField(file->tiff, TAG_BYTES, &byte_count, &bytes) || length_count < 2 || lengths[0] < 12 ||
      lengths[0] > byte_count || lengths[0] > HEADER_MOST || word_at(bytes, high_first) != 0x494a494a)
    return 0;
  size_t piece = 1, place = lengths[0];
  for (size_t at = 4; at + 8 <= lengths[0]; at += 8) {
    uint32_t kind = word_at(bytes + at, high_first), count = word_at(bytes + at + 4, high_first);
    for (uint32_t n = 0; n < count && piece < length_count; n++, piece++) {
      uint32_t length = lengths[piece];
      if (length > byte_count - place) return found;
      if (kind == 0x6c757473 && length == 3 * TABLE && found < TIFF_IMAGEJ_CHANNELS_MOST) /* "luts" */
        take_table(bytes + place, &channels[found++]);
      else if (kind == 0x72616e67) take_ranges(bytes + place, length, high_first, channels); /* "rang" */
      place += length;
    }
  }
  return found;
}
