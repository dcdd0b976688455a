/* gpu/program_cache.h - stores compiled kernels in files, so that the next process need not compile them. */
#ifndef HL_GPU_PROGRAM_CACHE_H
#define HL_GPU_PROGRAM_CACHE_H

#include "gpu/driver.h"

/* The greatest number of bytes of compiled kernels that a folder holds. If there are more, the oldest files
 * are removed. */
enum { PROGRAM_CACHE_BYTES = 64 << 20, PROGRAM_KEY_BYTES = 1024 };

/* Reads the program that hl_program_store() stored under a key. Returns false if there is no such program, or
 * if its file does not belong to the user. folder: may be null; then there is no program. */
bool hl_program_stored(const char *folder, const char *key, gpu_binary *binary);

/* Stores a program. A failure is ignored. Only the user can read the file and a folder that this function
 * makes. */
void hl_program_store(const char *folder, const char *key, const gpu_binary *binary);

/* A hash of a text: FNV-1a (Fowler, Noll, Vo), 64 bits. */
uint64_t hl_program_number(const char *text);

#endif
