/* platform/posix/program.c - prepares the program's arguments and its standard streams. On POSIX systems the
 * preparation does nothing, because arguments and streams consist of bytes. */
#include "platform/program.h"

void hl_program_begin(int *count, char ***arguments) { (void)count, (void)arguments; }
