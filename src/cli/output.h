/* cli/output.h - is OUT a name that a picture can be written to? Found out before the work, not after. */
#ifndef HL_CLI_OUTPUT_H
#define HL_CLI_OUTPUT_H

#include <stdbool.h>

/* True if path ends in extension (".png"), in upper or lower case, and has something before it. */
bool has_extension(const char *path, const char *extension);

/* Refuses a name without a picture's extension, a folder, a place that cannot be written, and any of
 * the inputs. Returns the exit code. */
int output_check(const char *path, char *const *inputs, int input_count);

#endif
