/* server/picture_zip.h - writes an archive of numbered pictures, which are stored without compression. The
 * archive replaces a film if ffmpeg is absent. */
#ifndef HL_SERVER_PICTURE_ZIP_H
#define HL_SERVER_PICTURE_ZIP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum { PICTURE_ZIP_MOST = 65535 }; /* number of files that a zip archive can hold without ZIP64 */

typedef struct picture_zip_entry {
  uint32_t at, length, checksum;
} picture_zip_entry;

typedef struct picture_zip {
  FILE *file;                 /* owned */
  picture_zip_entry *entries; /* owned; [count] */
  size_t count, capacity;
  int digits; /* number of digits in the names */
  bool failed;
} picture_zip;

/* Begins an archive of `pictures` pictures, at most PICTURE_ZIP_MOST. */
bool picture_zip_begin(picture_zip *zip, const char *path, int pictures);
/* Adds the next picture, the bytes of a PNG. Returns false if the file cannot be written or would exceed 1
 * GiB. */
bool picture_zip_add(picture_zip *zip, const unsigned char *png, size_t length);
/* Writes the list of files, and closes the file. The memory is released also after a failure. */
bool picture_zip_end(picture_zip *zip);

#endif
