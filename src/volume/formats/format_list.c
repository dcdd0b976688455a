/* volume/formats/format_list.c - lists the formats of volumes that this build of the library reads and
 * writes, and the ways to compress bytes and pictures in files. */
#include <string.h>

#include "core/endings.h"
#include "volume/formats/format.h"
#include "volume/formats/formats.h"
#include "volume/io/writer.h"

#define HL_FORMAT(name) extern const hl_format hl_format_##name;
HL_FORMATS
#undef HL_FORMAT

const hl_format *const hl_formats[] = {
#define HL_FORMAT(name) &hl_format_##name,
    HL_FORMATS
#undef HL_FORMAT
        NULL};
enum { FORMATS = sizeof hl_formats / sizeof *hl_formats - 1 };

hl_status hl_volume_get_format(size_t index, hl_file_format *format) {
  if (format == NULL || format->struct_size != sizeof *format || index >= FORMATS) return HL_ERROR_ARGUMENT;
  const hl_format *f = hl_formats[index];
  *format = (hl_file_format){.struct_size = sizeof *format,
                             .name = f->title != NULL ? f->title : f->name,
                             .missing = f->missing != NULL ? f->missing() : NULL};
  for (int n = 0; n < HL_FORMAT_ENDINGS && f->endings[n] != NULL; n++)
    hl_endings_add(format->read_endings, f->endings[n]);
  if (f->more_endings != NULL) hl_endings_add(format->read_endings, f->more_endings);
  const hl_writer *writer;
  /* a format that this build cannot read is not offered for writing */
  for (size_t n = 0; format->missing == NULL && (writer = hl_writer_at(n)) != NULL; n++)
    if (strcmp(writer->format, format->name) == 0) hl_endings_add(format->written_endings, writer->ending);
  format->reads = format->missing == NULL;
  format->writes = format->written_endings[0] != 0;
  return HL_OK;
}

/* ---- packings ---- */

#ifdef HL_HAS_JPEG
#define JPEG_MISSING NULL
#else
#define JPEG_MISSING "libjpeg"
#endif
#ifdef HL_HAS_JPEG_LS
#define JPEG_LS_MISSING NULL
#else
#define JPEG_LS_MISSING "CharLS"
#endif
#ifdef HL_HAS_JPEG_2000
#define JPEG_2000_MISSING NULL
#else
#define JPEG_2000_MISSING "OpenJPEG"
#endif
#ifdef HL_HAS_ZSTD
#define ZSTD_MISSING NULL
#else
#define ZSTD_MISSING "libzstd"
#endif
#ifdef HL_HAS_BLOSC
#define BLOSC_MISSING NULL
#else
#define BLOSC_MISSING "c-blosc"
#endif
#ifdef HL_HAS_LZ4
#define LZ4_MISSING NULL
#else
#define LZ4_MISSING "liblz4"
#endif
#ifdef HL_HAS_LZMA
#define LZMA_MISSING NULL
#else
#define LZMA_MISSING "liblzma"
#endif
#ifdef HL_HAS_BZIP2
#define BZIP2_MISSING NULL
#else
#define BZIP2_MISSING "libbz2"
#endif

typedef struct packing {
  const char *name, *missing;
  const char *read_endings, *written_endings; /* endings of the names of files that are packed as a whole;
                                               * null if files packed as a whole are not read, or not
                                               * written */
} packing;

static const packing packings[] = {
    {"gzip", NULL, ".gz", ".gz"},
    {"bzip2", BZIP2_MISSING, ".bz2", NULL},
    {"xz (LZMA)", LZMA_MISSING, ".xz", NULL},
    {"Zstandard", ZSTD_MISSING, NULL, NULL},
    {"LZ4", LZ4_MISSING, NULL, NULL},
    {"Blosc", BLOSC_MISSING, NULL, NULL},
    {"JPEG", JPEG_MISSING, NULL, NULL},
    {"JPEG-LS", JPEG_LS_MISSING, NULL, NULL},
    {"JPEG 2000", JPEG_2000_MISSING, NULL, NULL},
};

hl_status hl_volume_get_packing(size_t index, hl_file_format *format) {
  if (format == NULL || format->struct_size != sizeof *format || index >= sizeof packings / sizeof *packings)
    return HL_ERROR_ARGUMENT;
  const packing *p = &packings[index];
  *format = (hl_file_format){.struct_size = sizeof *format, .name = p->name, .missing = p->missing};
  format->reads = p->missing == NULL;
  format->writes = p->written_endings != NULL;
  if (p->read_endings != NULL) hl_endings_add(format->read_endings, p->read_endings);
  if (format->writes) hl_endings_add(format->written_endings, p->written_endings);
  return HL_OK;
}
