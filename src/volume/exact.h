/* volume/exact.h - keeps the file's own numbers beside stored values that round some of them.
 *
 * Stored values of 32-bit and 64-bit integers and of doubles are floats, which hold whole numbers exactly up
 * to 2^24. If a float rounds any number of a file (for example the ids of an atlas), the numbers are also
 * kept in the file's type. Labels, masks, `info`, `convert` and percentiles use these numbers. Pictures of
 * values use the rounded floats. If the voxels lie in pages, the numbers lie in a second scratch file. If
 * several ranks share the volume, each rank keeps the numbers of its own voxels.
 *
 * In: voxels as a file or a caller gives them, in pieces of any size and order, from several threads at once.
 * Out: the numbers of all voxels, or null if floats hold all numbers exactly. */
#ifndef HL_VOLUME_EXACT_H
#define HL_VOLUME_EXACT_H

#include "core/error.h"
#include "volume/volume.h"

typedef enum hl_exact_place {
  HL_EXACT_IN_MEMORY,
  HL_EXACT_IN_FILE /* the numbers are kept in a scratch file, for voxels that lie in pages */
} hl_exact_place;

typedef struct hl_exact {
  hl_context *context;
  hl_voxel_type type;
  size_t first, count; /* the voxels whose numbers are kept. first: the number of the first of these voxels,
                        * which is 0 unless several ranks share the volume. count: the number of these
                        * voxels */
  hl_exact_place place;
  atomic_bool rounds;      /* whether floats round any of the recorded numbers */
  atomic_int failure;      /* the system's error number if memory or disk had no room for the numbers, else
                            * 0 */
  _Atomic(void *) numbers; /* owned; [count], of the file's type; a number is 0 until it is recorded. Null
                            * until a number is recorded that a float rounds */
  atomic_int file; /* owned; the scratch file that holds the numbers; -1 if the numbers are in memory, or no
                    * number was recorded. Numbers that were not recorded are holes of the file, which read as
                    * zeros */
} hl_exact;

void hl_exact_begin(hl_context *context, hl_voxel_type type, size_t count, hl_exact_place place,
                    hl_exact *exact);

/* Records the numbers of `count` voxels, of which the first is voxel number `first`. source: the adjacent
 * numbers as the file has them, at an address of any alignment. swap: whether the file's byte order differs
 * from the native order. Voxels of other ranks are skipped. If memory or the disk is short, hl_exact_take()
 * fails later. exact: may be null. */
void hl_exact_note(hl_exact *exact, bool swap, const void *source, size_t first, size_t count);

/* Hands the recorded numbers to the caller, who owns them. stored: the stored values of all voxels, [count].
 * *numbers becomes null if floats hold all numbers without rounding. */
hl_status hl_exact_take(hl_exact *exact, const float *stored, void **numbers, hl_error *error);
/* Hands the recorded numbers over as a file, which the caller owns. *file becomes -1 if floats hold all
 * numbers without rounding. */
hl_status hl_exact_take_file(hl_exact *exact, int *file, hl_error *error);
/* Reads `count` numbers of a file that hl_exact_take_file() gave, beginning with number `first`. stored: the
 * stored values of these voxels. Returns false if the file cannot be read. */
bool hl_exact_read(int file, hl_voxel_type type, size_t first, size_t count, const float *stored,
                   void *numbers);
void hl_exact_release(hl_exact *exact);

/* Sets each number that was not recorded to the value of its voxel's float. stored: [count], the floats of
 * the voxels. numbers: [count] of the type; a number that was not recorded is zero. */
void hl_exact_fill(hl_voxel_type type, const float *stored, size_t count, void *numbers);

/* The number at index i of a row, as a double. row: numbers of the type, in native byte order. */
static inline double hl_exact_number(hl_voxel_type type, const void *row, size_t i) {
  switch (type) {
    case HL_VOXEL_U32: return ((const uint32_t *)row)[i];
    case HL_VOXEL_I32: return ((const int32_t *)row)[i];
    case HL_VOXEL_U64: return (double)((const uint64_t *)row)[i];
    case HL_VOXEL_I64: return (double)((const int64_t *)row)[i];
    default: return ((const double *)row)[i];
  }
}

#endif
