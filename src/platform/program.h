/* platform/program.h - prepares the arguments and the standard streams at the start of a program, and finds
 * the program's own file. */
#ifndef HL_PLATFORM_PROGRAM_H
#define HL_PLATFORM_PROGRAM_H

#include <stdbool.h>
#include <stddef.h>

/* Converts the arguments of main() to UTF-8, and makes the standard streams carry bytes without conversion,
 * on systems whose arguments and streams are different at first. */
void hl_program_begin(int *count, char ***arguments);

/* Writes the absolute path of the running program's file, in UTF-8 and with '/', after following links.
 * Returns false if the system does not tell the path, or if the path does not fit into `size` bytes. */
bool hl_program_path(char *path, size_t size);

#endif
