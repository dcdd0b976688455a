/* platform/posix/program.c - see platform/program.h. Nothing must be done here, because arguments and streams
 * are bytes already. */
#include "platform/program.h"

void hl_program_begin(int *count, char ***arguments) { (void)count, (void)arguments; }
