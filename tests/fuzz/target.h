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

/* A promise that must hold for every input. If it is broken, the line goes to stderr and the program stops.
 */
#define REQUIRE(condition) ((condition) ? (void)0 : fuzz_broken(__FILE__, __LINE__, #condition))
_Noreturn void fuzz_broken(const char *file, int line, const char *promise);

/* The number of bytes that one input may hold at once. Each target sets its own, and it is small, so that no
 * input takes much time. */
extern const uint64_t fuzz_memory_limit;

/* The process's only context, with the limit `most_bytes`. */
hl_context *fuzz_context(void);

/* The same context, confined to the process's own folder, so that an input cannot name other files of the
 * machine. Names are relative to the folder. */
hl_context *fuzz_confined(void);

/* Checks after each input that all memory was given back. */
void fuzz_check_nothing_held(void);

/* Checks the result of a call. A failure must have a code and one printable line. made: whether the call has
 * made its result. Returns whether the call succeeded. */
bool fuzz_check_answer(hl_status status, const hl_error *error, bool made);

/* Writes a file into the process's own folder (in memory where there is one) and gives its path, valid until
 * the next call with this slot (0 to 3); the folder goes with the process. */
const char *fuzz_write_file(int slot, const char *name, const uint8_t *data, size_t size);
void fuzz_remove_file(int slot);
const char *fuzz_folder(void);

/* Loads the input as a volume and checks it. If it has a line "%%%%", it is cut there into two files, and the
 * first is loaded. */
void fuzz_load_volume(const char *name, const char *second_name, const uint8_t *data, size_t size);

/* The same for a mesh. second_name: null if the format names no other file. */
void fuzz_load_mesh(const char *name, const char *second_name, const uint8_t *data, size_t size);

/* Draws numbers from an input; zeros when the input is used up. */
typedef struct fuzz_source {
  const uint8_t *data;
  size_t left;
} fuzz_source;

unsigned fuzz_byte(fuzz_source *source);
int fuzz_choice(fuzz_source *source, int count); /* 0 .. count - 1 */
double fuzz_unit(fuzz_source *source);           /* [0, 1] in steps of 1/65535 */
double fuzz_number(fuzz_source *source);         /* mostly within [-8, 8], now and then huge, tiny or 0 */

#endif
