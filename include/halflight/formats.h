/* halflight/formats.h - lists the file formats that this build of the library reads and writes.
 *
 * A build lacks the formats whose libraries were missing when it was made. docs/formats.md describes the
 * formats. */
#ifndef HALFLIGHT_FORMATS_H
#define HALFLIGHT_FORMATS_H

#include "context.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A format of files, or a method of compression that is used within volume files. The texts are static. */
typedef struct hl_file_format {
  size_t struct_size;  /* set by the caller: sizeof(hl_file_format) */
  const char *name;    /* "NRRD" */
  int reads, writes;   /* non-zero if this build reads, or writes, the format */
  const char *missing; /* the library that the format needs and that this build lacks, as "libtiff"; if null,
                        * this build reads the format */
  /* The endings of file names for reading and for writing, separated by blanks, as ".nrrd .nhdr". Files with
   * these endings are read, or written, in this format. The text is "" if the ending does not tell the
   * format, or if the format is not read, or not written. */
  char read_endings[64], written_endings[64];
} hl_file_format;

/* Describe format number `index` of volumes, of compression within volumes' files, of meshes, of pictures,
 * and of figures of vectors. index: from 0 on; beyond the last format, the functions fail with
 * HL_ERROR_ARGUMENT.
 */
HL_API HL_WARN_UNUSED hl_status hl_volume_get_format(size_t index, hl_file_format *format);
HL_API HL_WARN_UNUSED hl_status hl_volume_get_packing(size_t index, hl_file_format *packing);
HL_API HL_WARN_UNUSED hl_status hl_mesh_get_format(size_t index, hl_file_format *format);
HL_API HL_WARN_UNUSED hl_status hl_image_get_format(size_t index, hl_file_format *format);
HL_API HL_WARN_UNUSED hl_status hl_figure_get_format(size_t index, hl_file_format *format);

#ifdef __cplusplus
}
#endif
#endif
