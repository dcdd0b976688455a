/* platform/program.h - prepares the arguments and the standard streams at the start of a program. */
#ifndef HL_PLATFORM_PROGRAM_H
#define HL_PLATFORM_PROGRAM_H

/* Converts the arguments of main() to UTF-8, and makes the standard streams carry plain bytes, on systems
 * where this is not so already. */
void hl_program_begin(int *count, char ***arguments);

#endif
