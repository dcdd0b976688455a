/* platform/windows/names.h - converts names of files between UTF-8 with '/' and the system's UTF-16 with '\',
 * and converts the system's error numbers to errno. */
#ifndef HL_PLATFORM_WINDOWS_NAMES_H
#define HL_PLATFORM_WINDOWS_NAMES_H

#include <stdbool.h>
#include <stddef.h>
#include <wchar.h>

/* Converts a file's name to UTF-16 for the system's calls. A long name gets the prefix that removes the
 * system's limit of 260 characters. The caller frees the result. Returns null, with errno set, if the text is
 * not UTF-8 or memory is short. */
wchar_t *hl_wide_name(const char *path);

/* Converts a text to UTF-16, with '\' for '/' and without a prefix. */
wchar_t *hl_wide_text(const char *text);

/* Writes UTF-16 of `length` characters as UTF-8, with '/' for '\'. Returns false if the text does not fit. */
bool hl_narrow_name(const wchar_t *wide, size_t length, char *text, size_t size);

/* Replaces the last six characters of a name by random letters. Returns false, with errno set, on failure. */
bool hl_choose_name(char *path);

/* Sets errno for an error number of the system, as GetLastError() returns it. Returns -1. */
int hl_system_error(unsigned long error);

#endif
