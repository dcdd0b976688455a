/* gpu/program_cache.h - compiled kernels in files, so that the next process need not compile them. */
#ifndef HL_GPU_PROGRAM_CACHE_H
#define HL_GPU_PROGRAM_CACHE_H

#include "gpu/driver.h"

/* The most bytes that a folder of compiled kernels holds. Where there are more, the oldest files are
 * removed. */
enum { PROGRAM_CACHE_BYTES = 64 << 20, PROGRAM_KEY_BYTES = 1024 };

/* Reads the program that hl_program_store() stored under a key. False where there is none, or where it is not
 * the user's own. folder: may be null, which means that there is none. */
bool hl_program_stored(const char *folder, const char *key, gpu_binary *binary);

/* Stores a program; a failure does no harm. The file, and a new folder, are readable by the user only. */
void hl_program_store(const char *folder, const char *key, const gpu_binary *binary);

/* A number made from a text: FNV-1a (Fowler, Noll, Vo), 64 bits. */
uint64_t hl_program_number(const char *text);

#endif
