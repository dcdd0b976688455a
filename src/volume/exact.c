/* volume/exact.c - see exact.h. */
#define _GNU_SOURCE
#include "volume/exact.h"

#include <errno.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "core/context.h"
#include "core/memory.h"
#include "volume/convert.h"
#include "volume/store/scratch_file.h"

/* The number 2^24. Floats hold all whole numbers up to 2^24 exactly. The rounding of fractions of smaller
 * numbers is ignored. */
#define HELD_BELOW 0x1p24

void hl_exact_begin(hl_context *context, hl_voxel_type type, size_t count, hl_exact_place place,
                    hl_exact *exact) {
  exact->context = context;
  exact->type = type;
  exact->first = 0;
  exact->count = count;
  exact->place = place;
  atomic_init(&exact->rounds, false);
  atomic_init(&exact->failure, 0);
  atomic_init(&exact->numbers, NULL);
  atomic_init(&exact->file, -1);
}

static bool is_wide(hl_voxel_type type) {
  return type == HL_VOXEL_U32 || type == HL_VOXEL_I32 || type == HL_VOXEL_U64 || type == HL_VOXEL_I64 ||
         type == HL_VOXEL_F64;
}

/* Returns whether a float rounds this whole number: whether it has more than 24 bits from its first to its
 * last set bit. */
static bool rounds_whole(uint64_t magnitude) {
  return magnitude >> 24 != 0 && magnitude >> __builtin_ctzll(magnitude) >> 24 != 0;
}

static bool rounds_double(double value) {
  /* the comparison fabs(NaN) >= HELD_BELOW is false, so that NaN does not count as rounded */
  return fabs(value) >= HELD_BELOW && (double)(float)value != value;
}

/* The magnitude of a signed number. */
static uint64_t magnitude_of(int64_t value) { return value < 0 ? 0 - (uint64_t)value : (uint64_t)value; }

/* Returns whether any number may lie beyond 2^24 or -2^24. Most files have no number beyond these bounds. For
 * most files, this quick test, whose loop compilers vectorise, makes slower tests unnecessary. */
static bool any_great_32(bool is_signed, bool swap, const unsigned char *from, size_t count) {
  uint32_t bits = 0;
  for (size_t n = 0; n < count; n++) {
    uint32_t word;
    memcpy(&word, from + 4 * n, sizeof word);
    if (swap) word = __builtin_bswap32(word);
    bits |= is_signed ? word ^ (uint32_t)((int32_t)word >> 31) : word;
  }
  return bits >> 24 != 0;
}

static bool any_great_64(bool is_signed, bool swap, const unsigned char *from, size_t count) {
  uint64_t bits = 0;
  for (size_t n = 0; n < count; n++) {
    uint64_t word;
    memcpy(&word, from + 8 * n, sizeof word);
    if (swap) word = __builtin_bswap64(word);
    bits |= is_signed ? word ^ (uint64_t)((int64_t)word >> 63) : word;
  }
  return bits >> 24 != 0;
}

static bool any_great(hl_voxel_type type, bool swap, const unsigned char *from, size_t count) {
  bool is_signed = type == HL_VOXEL_I32 || type == HL_VOXEL_I64;
  if (type == HL_VOXEL_F64) return true;
  return hl_voxel_type_bytes(type) == 4 ? any_great_32(is_signed, swap, from, count)
                                        : any_great_64(is_signed, swap, from, count);
}

static bool rounds_number(hl_voxel_type type, bool swap, const unsigned char *bytes) {
  uint32_t word;
  uint64_t words;
  double value;
  if (hl_voxel_type_bytes(type) == 4) {
    memcpy(&word, bytes, 4);
    if (swap) word = __builtin_bswap32(word);
    return rounds_whole(type == HL_VOXEL_U32 ? word : magnitude_of((int32_t)word));
  }
  memcpy(&words, bytes, 8);
  if (swap) words = __builtin_bswap64(words);
  if (type != HL_VOXEL_F64) return rounds_whole(type == HL_VOXEL_U64 ? words : magnitude_of((int64_t)words));
  memcpy(&value, &words, 8);
  return rounds_double(value);
}

static void copy_number(size_t bytes, bool swap, const unsigned char *from, unsigned char *to) {
  for (size_t n = 0; n < bytes; n++) to[n] = from[swap ? bytes - 1 - n : n];
}

/* The memory for the file's numbers; null if memory is short. The first thread that calls this function
 * allocates the memory. */
static unsigned char *numbers_of(hl_exact *exact) {
  void *made = atomic_load(&exact->numbers), *none = NULL;
  if (made != NULL) return made;
  made = hl_allocate_zeroed(exact->context, exact->count, hl_voxel_type_bytes(exact->type));
  if (made == NULL || atomic_compare_exchange_strong(&exact->numbers, &none, made)) return made;
  hl_release(exact->context, made);
  return none;
}

/* The scratch file for the numbers; -1 if the file cannot be made. The first thread that calls this function
 * makes the file. */
static int file_of(hl_exact *exact) {
  int made = atomic_load(&exact->file), none = -1;
  if (made >= 0) return made;
  made = hl_scratch_open_empty(exact->context, exact->context->options.scratch_folder);
  if (made < 0 || atomic_compare_exchange_strong(&exact->file, &none, made)) return made;
  close(made);
  return none;
}

/* Writes numbers to the scratch file in pieces of 2048 numbers. A piece is written whole if a float rounds
 * any of its numbers, else left out. */
static void note_in_file(hl_exact *exact, bool swap, const unsigned char *from, size_t first, size_t count) {
  enum { PIECE = 2048 };
  unsigned char piece[8 * PIECE];
  size_t bytes = hl_voxel_type_bytes(exact->type);
  for (size_t done = 0, taken; done < count && exact->failure == 0; done += taken, from += taken * bytes) {
    bool any = false;
    taken = count - done < PIECE ? count - done : PIECE;
    for (size_t n = 0; n < taken && !any; n++) any = rounds_number(exact->type, swap, from + n * bytes);
    if (!any) continue;
    for (size_t n = 0; n < taken; n++) copy_number(bytes, swap, from + n * bytes, piece + n * bytes);
    int file = file_of(exact);
    off_t at = (off_t)((first + done) * bytes);
    if (file < 0 || !hl_scratch_write(file, piece, taken * bytes, at))
      exact->failure = errno != 0 ? errno : EIO;
    exact->rounds = true;
  }
}

static void note_in_memory(hl_exact *exact, bool swap, const unsigned char *from, size_t first,
                           size_t count) {
  size_t bytes = hl_voxel_type_bytes(exact->type);
  for (size_t n = 0; n < count; n++) {
    if (!rounds_number(exact->type, swap, from + n * bytes)) continue;
    if (!exact->rounds) exact->rounds = true;
    unsigned char *numbers = numbers_of(exact);
    if (numbers == NULL) {
      exact->failure = ENOMEM;
      return;
    }
    copy_number(bytes, swap, from + n * bytes, numbers + (first + n) * bytes);
  }
}

void hl_exact_note(hl_exact *exact, bool swap, const void *source, size_t first, size_t count) {
  if (exact == NULL || !is_wide(exact->type)) return;
  const size_t begin = first > exact->first ? first : exact->first, own_end = exact->first + exact->count;
  const size_t end = first + count < own_end ? first + count : own_end;
  if (begin >= end) return;
  const unsigned char *from = source;
  from += (begin - first) * hl_voxel_type_bytes(exact->type);
  first = begin - exact->first;
  count = end - begin;
  if (!any_great(exact->type, swap, from, count)) return;
  if (exact->place == HL_EXACT_IN_FILE) note_in_file(exact, swap, from, first, count);
  else note_in_memory(exact, swap, from, first, count);
}

/* Sets the number of voxel n to the value of its float `stored`. The float of a voxel whose number was not
 * recorded holds the number exactly. */
static void fill_number(hl_voxel_type type, double stored, size_t n, void *numbers) {
  switch (type) {
    case HL_VOXEL_U32:
      ((uint32_t *)numbers)[n] = stored >= 0 && stored < 0x1p32 ? (uint32_t)stored : 0;
      break;
    case HL_VOXEL_I32:
      ((int32_t *)numbers)[n] = stored >= -0x1p31 && stored < 0x1p31 ? (int32_t)stored : 0;
      break;
    case HL_VOXEL_U64:
      ((uint64_t *)numbers)[n] = stored >= 0 && stored < 0x1p64 ? (uint64_t)stored : 0;
      break;
    case HL_VOXEL_I64:
      ((int64_t *)numbers)[n] = stored >= -0x1p63 && stored < 0x1p63 ? (int64_t)stored : 0;
      break;
    default: ((double *)numbers)[n] = stored; break;
  }
}

/* Sets the numbers that were not recorded to the voxels' stored values. A number was not recorded if the
 * number is zero, but the voxel's stored value is not zero. */
void hl_exact_fill(hl_voxel_type type, const float *stored, size_t count, void *numbers) {
  for (size_t n = 0; n < count; n++)
    if (!((float)hl_exact_number(type, numbers, n) == stored[n]))
      fill_number(type, (double)stored[n], n, numbers);
}

hl_status hl_exact_take(hl_exact *exact, const float *stored, void **numbers, hl_error *error) {
  *numbers = NULL;
  if (exact->failure != 0)
    return hl_fail_memory(error, exact->count * hl_voxel_type_bytes(exact->type), "whole numbers above 2^24");
  *numbers = atomic_exchange(&exact->numbers, NULL);
  if (*numbers != NULL) hl_exact_fill(exact->type, stored, exact->count, *numbers);
  return HL_OK;
}

hl_status hl_exact_take_file(hl_exact *exact, int *file, hl_error *error) {
  *file = -1;
  if (exact->failure != 0)
    return hl_scratch_fail(exact->context->options.scratch_folder,
                           exact->count * hl_voxel_type_bytes(exact->type), exact->failure, error);
  *file = atomic_exchange(&exact->file, -1);
  return HL_OK;
}

bool hl_exact_read(int file, hl_voxel_type type, size_t first, size_t count, const float *stored,
                   void *numbers) {
  size_t bytes = hl_voxel_type_bytes(type), wanted = count * bytes, done = 0;
  while (done < wanted) {
    ssize_t got = pread(file, (unsigned char *)numbers + done, wanted - done, (off_t)(first * bytes + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return false;
    if (got == 0) break; /* numbers beyond the end of the file count as zeros */
    done += (size_t)got;
  }
  memset((unsigned char *)numbers + done, 0, wanted - done);
  hl_exact_fill(type, stored, count, numbers);
  return true;
}

void hl_exact_release(hl_exact *exact) {
  int file = atomic_exchange(&exact->file, -1);
  if (file >= 0) close(file);
  hl_release(exact->context, atomic_exchange(&exact->numbers, NULL));
}
