/* cli/info/formats.h - prints the formats for `halflight info --formats`. */
#ifndef HL_CLI_INFO_FORMATS_H
#define HL_CLI_INFO_FORMATS_H

#include <stdbool.h>

/* Prints the formats that this program reads and writes. Returns the exit code. */
int info_formats(bool as_json);

#endif
