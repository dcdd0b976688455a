/* cli/output.h - is OUT a name that can be written to? Found out before the work, not after. */
#ifndef HL_CLI_OUTPUT_H
#define HL_CLI_OUTPUT_H

#include <stdbool.h>
#include <stddef.h>

/* True if path ends in extension (".png"), in upper or lower case, and has something before it. */
bool has_extension(const char *path, const char *extension);

/* The extensions of what is written; null after the last. */
extern const char *const picture_extensions[], *const volume_extensions[];

/* Refuses a name without one of the extensions, a folder, a place that cannot be written, and any of
 * the inputs. Returns the exit code. */
int output_check(const char *path, const char *const *extensions, char *const *inputs, int input_count);

/* All of the bytes on standard output; returns the exit code. */
int output_to_stdout(const unsigned char *bytes, size_t length);

/* "head.png" for "scans/head.nii.gz" and ".png", in the current folder; owned by the caller (free), null
 * without memory. */
char *output_default_name(const char *input, const char *extension);

#endif
