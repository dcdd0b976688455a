/* tests/fuzz/target.h - what the fuzz targets share: a context with a limit, files, and checks of every
 * answer.
 *
 * A target is one source file with LLVMFuzzerTestOneInput. scripts/fuzz links it to libFuzzer; corpus.c links
 * it to a main that runs the committed inputs, as an ordinary test.
 */
#ifndef HL_TESTS_FUZZ_TARGET_H
#define HL_TESTS_FUZZ_TARGET_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <halflight/halflight.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* A promise that must hold for every input; the line goes to stderr and the program stops. */
#define REQUIRE(condition) ((condition) ? (void)0 : fuzz_broken(__FILE__, __LINE__, #condition))
_Noreturn void fuzz_broken(const char *file, int line, const char *promise);

/* Bytes that one input may hold at once: each target's own, small, so that no input costs much time. */
extern const uint64_t fuzz_memory_limit;

/* The process's one context, with that limit. */
hl_context *fuzz_context(void);

/* The same context, confined to the process's own folder: whatever an input names, no other file of the
 * machine takes part. Names are relative to the folder. */
hl_context *fuzz_confined(void);

/* After each input: everything was given back. */
void fuzz_check_nothing_held(void);

/* The answer of a fallible call: a failure has its code and one printable line. made: what the call was to
 * make is there. True if it succeeded. */
bool fuzz_check_answer(hl_status status, const hl_error *error, bool made);

/* Writes a file into the process's own folder (in memory where there is one) and gives its path, valid until
 * the next call with this slot (0 to 3); the folder goes with the process. */
const char *fuzz_write_file(int slot, const char *name, const uint8_t *data, size_t size);
void fuzz_remove_file(int slot);
const char *fuzz_folder(void);

/* The input as one file, or, cut at the first line "%%%%", as two; loads the first as a volume and checks
 * it. */
void fuzz_load_volume(const char *name, const char *second_name, const uint8_t *data, size_t size);

/* The same for a mesh. second_name: null where the format names no other file. */
void fuzz_load_mesh(const char *name, const char *second_name, const uint8_t *data, size_t size);

/* Numbers drawn from an input; zeros when it is used up. */
typedef struct fuzz_source {
  const uint8_t *data;
  size_t left;
} fuzz_source;

unsigned fuzz_byte(fuzz_source *source);
int fuzz_choice(fuzz_source *source, int count); /* 0 .. count - 1 */
double fuzz_unit(fuzz_source *source);           /* [0, 1] in steps of 1/65535 */
double fuzz_number(fuzz_source *source);         /* mostly within [-8, 8], now and then huge, tiny or 0 */

#endif
