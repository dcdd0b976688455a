/* server/picture_zip.c - writes a zip archive of stored pictures.
 *
 * Source of the format: PKWARE's APPNOTE.TXT, 4.3. An archive has for each file a header and then the file;
 * after all files the list of files, and the end of the list. Numbers are little-endian. */
#include "picture_zip.h"

#include <stdlib.h>
#include <string.h>

#include <zlib.h>

enum {
  LOCAL_HEADER = 0x04034b50,
  LIST_ENTRY = 0x02014b50,
  LIST_END = 0x06054b50,
  VERSION = 10, /* version 1.0 of the format, which is sufficient for stored files */
  DATE = 0x21,  /* 1 January 1980, the first day of the format's calendar */
  NAME_BYTES = 32,
  BYTES_MOST = 1 << 30
};

static void put(picture_zip *zip, uint32_t value, int bytes) {
  for (int n = 0; n < bytes; n++, value >>= 8) zip->failed |= fputc((int)(value & 255), zip->file) == EOF;
}

static void name_of(const picture_zip *zip, size_t index, char name[NAME_BYTES]) {
  snprintf(name, NAME_BYTES, "frame-%0*zu.png", zip->digits, index);
}

/* Writes the fields that a file's header and its entry in the list have in common. */
static void put_facts(picture_zip *zip, size_t index) {
  const picture_zip_entry *entry = &zip->entries[index];
  char name[NAME_BYTES];
  name_of(zip, index, name);
  put(zip, VERSION, 2);
  put(zip, 0, 2); /* flags */
  put(zip, 0, 2); /* method: stored */
  put(zip, 0, 2); /* time: midnight */
  put(zip, DATE, 2);
  put(zip, entry->checksum, 4);
  put(zip, entry->length, 4);
  put(zip, entry->length, 4);
  put(zip, (uint32_t)strlen(name), 2);
  put(zip, 0, 2); /* no further fields */
}

static void put_name(picture_zip *zip, size_t index) {
  char name[NAME_BYTES];
  name_of(zip, index, name);
  zip->failed |= fputs(name, zip->file) < 0;
}

bool picture_zip_begin(picture_zip *zip, const char *path, int pictures) {
  *zip = (picture_zip){.digits = snprintf(NULL, 0, "%d", pictures)};
  zip->capacity = (size_t)pictures;
  if (pictures < 1 || pictures > PICTURE_ZIP_MOST) return false;
  zip->entries = calloc(zip->capacity, sizeof *zip->entries);
  zip->file = fopen(path, "wbxe");
  return zip->file != NULL && zip->entries != NULL;
}

bool picture_zip_add(picture_zip *zip, const unsigned char *png, size_t length) {
  long at = ftell(zip->file);
  if (zip->count == zip->capacity || at < 0 || length > BYTES_MOST || (size_t)at > BYTES_MOST - length)
    return false;
  zip->entries[zip->count] = (picture_zip_entry){(uint32_t)at, (uint32_t)length,
                                                 (uint32_t)crc32(0, png, (uInt)length)};
  put(zip, LOCAL_HEADER, 4);
  put_facts(zip, zip->count);
  put_name(zip, zip->count);
  zip->failed |= fwrite(png, 1, length, zip->file) != length;
  zip->count++;
  return !zip->failed;
}

static void put_list(picture_zip *zip) {
  long begin = ftell(zip->file);
  for (size_t n = 0; n < zip->count; n++) {
    put(zip, LIST_ENTRY, 4);
    put(zip, VERSION, 2); /* version of the program that wrote the archive */
    put_facts(zip, n);
    put(zip, 0, 2); /* no comment */
    put(zip, 0, 2); /* number of the first disk */
    put(zip, 0, 2); /* attributes: no text */
    put(zip, 0, 4); /* no further attributes */
    put(zip, zip->entries[n].at, 4);
    put_name(zip, n);
  }
  uint32_t length = (uint32_t)(ftell(zip->file) - begin);
  put(zip, LIST_END, 4);
  put(zip, 0, 2);
  put(zip, 0, 2);
  put(zip, (uint32_t)zip->count, 2);
  put(zip, (uint32_t)zip->count, 2);
  put(zip, length, 4);
  put(zip, (uint32_t)begin, 4);
  put(zip, 0, 2); /* no comment */
}

bool picture_zip_end(picture_zip *zip) {
  bool good = zip->file != NULL && !zip->failed;
  if (good) put_list(zip);
  if (zip->file != NULL) good &= fclose(zip->file) == 0 && !zip->failed;
  free(zip->entries);
  *zip = (picture_zip){.file = NULL};
  return good;
}
