/* platform/program.h - what a program does first. */
#ifndef HL_PLATFORM_PROGRAM_H
#define HL_PLATFORM_PROGRAM_H

/* Converts the arguments of main() to UTF-8, and lets the standard streams carry plain bytes, on systems
 * where they are not so already. */
void hl_program_begin(int *count, char ***arguments);

#endif
