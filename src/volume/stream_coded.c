/* volume/stream_coded.c - streams that decode bytes written as text: base64 (RFC 4648) and hexadecimal.
 *
 * White space may stand anywhere. A base64 text may hold several padded parts one after the other (VTK
 * encodes a header and its data apart); it ends at the first character of another kind, such as '<'.
 */
#include <string.h>

#include "core/memory.h"
#include "volume/stream.h"

enum { NOT_A_DIGIT = 255, SPACE = 254, PADDING = 253 };

typedef struct coded_stream {
  hl_stream base;
  unsigned char digit[256]; /* value of each character */
  unsigned group_digits;    /* digits in a full group: 4 or 2 */
  unsigned digit_bits;      /* bits in a digit: 6 or 4 */
  uint32_t bits;            /* of the digits of the group so far */
  unsigned held, padding;   /* digits and padding characters of the group so far */
  unsigned char left[3];    /* decoded bytes that did not fit the last pull */
  unsigned left_count;
  bool finished;
} coded_stream;

static hl_status fail_character(const coded_stream *stream, hl_error *error) {
  const hl_stream *below = stream->base.below;
  return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)below->offset,
                        "%s, byte %llu: a group of %s digits breaks off here", stream->base.path,
                        (unsigned long long)below->offset,
                        stream->digit_bits == 6 ? "base64" : "hexadecimal");
}

/* Turns a complete group into bytes; false if its padding is impossible. */
static bool end_group(coded_stream *stream, unsigned char bytes[3], unsigned *count) {
  unsigned bits = stream->held * stream->digit_bits;
  *count = bits / 8;
  if (*count == 0 || (stream->padding > 0 && stream->held + stream->padding != stream->group_digits))
    return false;
  uint32_t aligned = stream->bits << (24 - bits);
  for (unsigned n = 0; n < *count; n++) bytes[n] = (unsigned char)(aligned >> (16 - 8 * n));
  stream->bits = 0;
  stream->held = stream->padding = 0;
  return true;
}

static hl_status coded_pull(hl_stream *base, unsigned char *bytes, size_t capacity, size_t *count,
                            hl_error *error) {
  coded_stream *stream = (coded_stream *)base;
  *count = 0;
  while (stream->left_count > 0 && *count < capacity) {
    bytes[(*count)++] = stream->left[0];
    memmove(stream->left, stream->left + 1, --stream->left_count);
  }
  while (*count < capacity && !stream->finished) {
    const unsigned char *text;
    size_t available, n = 0;
    hl_status status = hl_stream_peek(base->below, 1, &text, &available, error);
    if (status != HL_OK) return status;
    if (available == 0) stream->finished = true;
    for (; n < available && *count < capacity; n++) {
      unsigned value = stream->digit[text[n]];
      if (value == SPACE) continue;
      if (value == NOT_A_DIGIT || (stream->padding > 0 && value != PADDING)) {
        stream->finished = true;
        break;
      }
      if (value == PADDING) stream->padding++;
      else {
        stream->bits = stream->bits << stream->digit_bits | value;
        stream->held++;
      }
      if (stream->held + stream->padding < stream->group_digits) continue;
      unsigned char group[3];
      unsigned made;
      if (!end_group(stream, group, &made)) return fail_character(stream, error);
      unsigned kept = made < capacity - *count ? made : (unsigned)(capacity - *count);
      memcpy(bytes + *count, group, kept);
      *count += kept;
      stream->left_count = made - kept;
      memcpy(stream->left, group + kept, made - kept);
    }
    hl_stream_take(base->below, n);
  }
  if (stream->finished && stream->held + stream->padding > 0) base->cut_short = true;
  return HL_OK;
}

static uint64_t coded_at_most(const hl_stream *base) {
  const coded_stream *stream = (const coded_stream *)base;
  uint64_t below = hl_stream_at_most(base->below);
  if (below == UINT64_MAX) return below;
  return below / stream->group_digits * (stream->group_digits * stream->digit_bits / 8) + 6;
}

static hl_status push_coded(hl_stream **stream, const char *digits, unsigned digit_bits, hl_error *error) {
  coded_stream *made = (coded_stream *)hl_stream_make((*stream)->context, sizeof *made, *stream);
  if (made == NULL) return hl_fail_memory(error, HL_STREAM_BUFFER_BYTES, (*stream)->path);
  made->base.pull = coded_pull;
  made->base.at_most = coded_at_most;
  made->digit_bits = digit_bits;
  made->group_digits = digit_bits == 6 ? 4 : 2;
  memset(made->digit, NOT_A_DIGIT, sizeof made->digit);
  for (unsigned n = 0; digits[n] != 0; n++)
    made->digit[(unsigned char)digits[n]] = (unsigned char)(n & ((1u << digit_bits) - 1));
  for (const char *space = " \t\r\n"; *space != 0; space++) made->digit[(unsigned char)*space] = SPACE;
  if (digit_bits == 6) made->digit['='] = PADDING;
  *stream = &made->base;
  return HL_OK;
}

hl_status hl_stream_push_base64(hl_stream **stream, hl_error *error) {
  return push_coded(stream, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/", 6, error);
}

hl_status hl_stream_push_hex(hl_stream **stream, hl_error *error) {
  hl_status status = push_coded(stream, "0123456789abcdef", 4, error);
  coded_stream *made = (coded_stream *)*stream;
  for (unsigned n = 10; status == HL_OK && n < 16; n++) made->digit['A' + n - 10] = (unsigned char)n;
  return status;
}
