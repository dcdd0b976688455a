/* volume/exact.c - see exact.h. */
#include "volume/exact.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "volume/convert.h"

/* Floats hold all whole numbers up to 2^24: numbers that are nearer to 0 count as held, whatever their
 * fraction. */
#define HELD_BELOW 0x1p24

void hl_exact_begin(hl_context *context, hl_voxel_type type, size_t count, bool is_off, hl_exact *exact) {
  exact->context = context;
  exact->type = type;
  exact->count = count;
  exact->is_off = is_off;
  atomic_init(&exact->rounds, false);
  atomic_init(&exact->failed, false);
  atomic_init(&exact->numbers, NULL);
}

static bool is_wide(hl_voxel_type type) {
  return type == HL_VOXEL_U32 || type == HL_VOXEL_I32 || type == HL_VOXEL_U64 || type == HL_VOXEL_I64 ||
         type == HL_VOXEL_F64;
}

/* Whether a float rounds this whole number: it has more than 24 bits between its first and its last one. */
static bool rounds_whole(uint64_t magnitude) {
  return magnitude >> 24 != 0 && magnitude >> __builtin_ctzll(magnitude) >> 24 != 0;
}

static bool rounds_double(double value) {
  return fabs(value) >= HELD_BELOW && (double)(float)value != value; /* false for NaN */
}

/* The size of a signed number. */
static uint64_t magnitude_of(int64_t value) { return value < 0 ? 0 - (uint64_t)value : (uint64_t)value; }

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

/* The block of numbers, made by the first thread that needs it; null without memory. */
static unsigned char *numbers_of(hl_exact *exact) {
  void *made = atomic_load(&exact->numbers), *none = NULL;
  if (made != NULL) return made;
  made = hl_allocate_zeroed(exact->context, exact->count, hl_voxel_type_bytes(exact->type));
  if (made == NULL || atomic_compare_exchange_strong(&exact->numbers, &none, made)) return made;
  hl_release(exact->context, made);
  return none;
}

void hl_exact_note(hl_exact *exact, bool swap, const void *source, size_t first, size_t count) {
  if (exact == NULL || !is_wide(exact->type)) return;
  const unsigned char *from = source;
  size_t bytes = hl_voxel_type_bytes(exact->type);
  for (size_t n = 0; n < count; n++) {
    if (!rounds_number(exact->type, swap, from + n * bytes)) continue;
    if (!exact->rounds) exact->rounds = true;
    if (exact->is_off) return;
    unsigned char *numbers = numbers_of(exact);
    if (numbers == NULL) {
      exact->failed = true;
      return;
    }
    copy_number(bytes, swap, from + n * bytes, numbers + (first + n) * bytes);
  }
}

/* Gives a voxel whose number was not noted the number that its float holds. */
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

/* Only numbers that their floats round were noted: of a voxel whose float is not the noted number's, zero at
 * first, the float tells the number. */
hl_status hl_exact_take(hl_exact *exact, const float *stored, void **numbers, hl_error *error) {
  *numbers = NULL;
  if (exact->failed)
    return hl_fail_memory(error, exact->count * hl_voxel_type_bytes(exact->type), "whole numbers above 2^24");
  *numbers = atomic_exchange(&exact->numbers, NULL);
  for (size_t n = 0; *numbers != NULL && n < exact->count; n++)
    if (!((float)hl_exact_number(exact->type, *numbers, n) == stored[n]))
      fill_number(exact->type, (double)stored[n], n, *numbers);
  return HL_OK;
}

void hl_exact_release(hl_exact *exact) { hl_release(exact->context, atomic_exchange(&exact->numbers, NULL)); }
