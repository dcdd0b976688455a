/* platform/posix/program.c - prepares the arguments and the standard streams. On POSIX systems nothing must
 * be done, because arguments and streams are bytes already. */
#include "platform/program.h"

void hl_program_begin(int *count, char ***arguments) { (void)count, (void)arguments; }
