/* volume/io/numbers.c - reads numbers from a stream.
 *
 * In: a stream at the first number. Out: doubles. */
#include "volume/io/numbers.h"

#include <string.h>

#include "core/memory.h"
#include "volume/convert.h"

hl_status hl_next_number(hl_stream *stream, double *value, bool *found, hl_error *error) {
  const unsigned char *bytes;
  size_t available, begin;
  *found = false;
  do {
    hl_status status = hl_stream_peek(stream, HL_NUMBER_CHARACTERS, &bytes, &available, error);
    if (status != HL_OK || available == 0) return status;
    for (begin = 0; begin < available && hl_is_separator(bytes[begin]); begin++) {}
    if (begin > 0) hl_stream_take(stream, begin);
  } while (begin > 0 && available - begin < HL_NUMBER_CHARACTERS);
  bytes += begin;
  available -= begin;
  size_t length = 0;
  while (length < available && length < HL_NUMBER_CHARACTERS && !hl_is_separator(bytes[length]) &&
         bytes[length] != '<')
    length++;
  if (length == 0) return HL_OK;
  if (!hl_text_number((const char *)bytes, length, value))
    return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)stream->offset,
                          "%s, byte %llu: expected a number here", stream->path,
                          (unsigned long long)stream->offset);
  hl_stream_take(stream, length);
  *found = true;
  return HL_OK;
}

static hl_status fail_short(const hl_stream *stream, uint64_t count, hl_error *error) {
  return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)stream->offset,
                        "%s: promises %llu numbers in an array, but the file ends before them", stream->path,
                        (unsigned long long)count);
}

static hl_status read_text(hl_stream *stream, uint64_t count, double *numbers, hl_error *error) {
  for (uint64_t n = 0; n < count; n++) {
    bool found;
    hl_status status = hl_next_number(stream, &numbers[n], &found, error);
    if (status != HL_OK) return status;
    if (!found) return fail_short(stream, count, error);
  }
  return HL_OK;
}

static double number_of(hl_voxel_type type, uint64_t bits) {
  float single;
  double both;
  uint32_t word = (uint32_t)bits;
  switch (type) {
    case HL_VOXEL_I8: return (int8_t)bits;
    case HL_VOXEL_I16: return (int16_t)bits;
    case HL_VOXEL_I32: return (int32_t)bits;
    case HL_VOXEL_I64: return (double)(int64_t)bits;
    case HL_VOXEL_F32: memcpy(&single, &word, sizeof single); return (double)single;
    case HL_VOXEL_F64: memcpy(&both, &bits, sizeof both); return both;
    default: return (double)bits;
  }
}

double hl_binary_number(const unsigned char *bytes, hl_voxel_type type, bool big_endian) {
  size_t count = hl_voxel_type_bytes(type);
  uint64_t bits = 0;
  for (size_t n = 0; n < count; n++) bits |= (uint64_t)bytes[big_endian ? count - 1 - n : n] << 8 * n;
  return number_of(type, bits);
}

static hl_status read_binary(hl_stream *stream, const hl_number_code *code, uint64_t count, double *numbers,
                             hl_error *error) {
  enum { STAGE = 1024 };
  unsigned char stage[STAGE * 8];
  size_t bytes = hl_voxel_type_bytes(code->type), got;
  for (uint64_t done = 0; done < count;) {
    size_t wanted = count - done < STAGE ? (size_t)(count - done) : STAGE;
    hl_status status = hl_stream_read(stream, stage, wanted * bytes, &got, error);
    if (status != HL_OK) return status;
    if (got < wanted * bytes) return fail_short(stream, count, error);
    for (size_t n = 0; n < wanted; n++)
      numbers[done + n] = hl_binary_number(stage + n * bytes, code->type, code->big_endian);
    done += wanted;
  }
  return HL_OK;
}

hl_status hl_read_numbers(hl_stream *stream, const hl_number_code *code, uint64_t count, double **numbers,
                          hl_error *error) {
  uint64_t most = hl_stream_at_most(stream), least = code->text ? 2 : hl_voxel_type_bytes(code->type);
  if (count > (most < UINT64_MAX ? most + 1 : most) / least) return fail_short(stream, count, error);
  *numbers = hl_allocate(stream->context, count, sizeof **numbers);
  if (*numbers == NULL) return hl_fail_memory(error, count * sizeof **numbers, stream->path);
  hl_status status = code->text ? read_text(stream, count, *numbers, error)
                                : read_binary(stream, code, count, *numbers, error);
  if (status == HL_OK) return HL_OK;
  hl_release(stream->context, *numbers);
  *numbers = NULL;
  return status;
}
