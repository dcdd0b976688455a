/* platform/posix/program.c - see platform/program.h: the arguments and streams are bytes. */
#include "platform/program.h"

void hl_program_begin(int *count, char ***arguments) { (void)count, (void)arguments; }
