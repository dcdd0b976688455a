/* platform/program.h - what a program does first. */
#ifndef HL_PLATFORM_PROGRAM_H
#define HL_PLATFORM_PROGRAM_H

/* Makes the arguments of main() UTF-8, and the standard streams streams of bytes, where the system has
 * others. */
void hl_program_begin(int *count, char ***arguments);

#endif
