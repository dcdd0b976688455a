/* platform/nameless_file.h - makes files that the system deletes when they are closed, or when the process
 * ends. */
#ifndef HL_PLATFORM_NAMELESS_FILE_H
#define HL_PLATFORM_NAMELESS_FILE_H

/* Makes an empty file for reading and writing. path: a path in the file's folder that ends in "XXXXXX"; the
 * function replaces these six letters. Returns a descriptor, or -1 with errno set. */
int hl_nameless_file(char *path);

#endif
