/* volume/tiff_file.h - the pages of a TIFF file, decoded by libtiff to one component's voxels.
 *
 * libtiff reads from a file or from the caller's memory. Its warnings go to the context's log, its errors
 * become error lines, and each of its allocations is bounded. A tiff_file belongs to one thread. */
#ifndef HL_VOLUME_TIFF_FILE_H
#define HL_VOLUME_TIFF_FILE_H

#include <tiffio.h>

#include "volume/exact.h"

/* What a page's directory says about its voxels. */
typedef struct tiff_shape {
  uint32_t width, height, depth; /* depth: slices of a page, ImageDepth */
  hl_voxel_type type;
  unsigned bits;       /* bits of a sample in the file */
  unsigned components; /* samples of a pixel */
  bool planar;         /* each component has chunks of its own */
  bool colors;         /* red, green, blue, perhaps alpha, of whole bytes */
  bool premultiplied;  /* alpha is multiplied into the colours */
} tiff_shape;

enum { TIFF_NO_WARNINGS = 1 << 20 };

typedef struct tiff_file {
  hl_context *context;
  char *path;                  /* owned */
  const unsigned char *memory; /* borrowed; [size]; null: the file is read */
  uint64_t size, at;
  int descriptor; /* -1: none */
  TIFF *tiff;
  char message[300]; /* libtiff's first error since it was cleared */
  int warnings;      /* the number logged so far; TIFF_NO_WARNINGS, set before opening: none is logged */
} tiff_file;

/* bytes: the content, or null. quiet: the context's `reads` callback is not called (from other threads).
 * Close *file in any case. */
hl_status tiff_file_open(hl_context *context, const char *path, const void *bytes, size_t byte_count,
                         bool quiet, tiff_file *file, hl_error *error);
void tiff_file_close(tiff_file *file);

/* Fails with libtiff's own words. */
hl_status tiff_file_fail(const tiff_file *file, const char *what, hl_error *error);

/* Makes the directory at an offset current. level: which of its reduced pictures; 0: the directory itself. */
hl_status tiff_file_go(tiff_file *file, uint64_t offset, int level, hl_error *error);

/* The current directory's shape; fails if its kind of picture cannot be read. */
hl_status tiff_file_shape(tiff_file *file, tiff_shape *shape, hl_error *error);
bool tiff_shapes_equal(const tiff_shape *a, const tiff_shape *b);

/* Offsets of all directories, owned by the caller (hl_release). */
hl_status tiff_file_pages(tiff_file *file, uint64_t **offsets, size_t *count, hl_error *error);

/* Where the current directory's first pixels lie in the file, if all of its pixels follow them uncompressed,
 * a whole number of bytes for each sample; else 0. *bytes: those of a slice. */
uint64_t tiff_file_plain(tiff_file *file, const tiff_shape *shape, uint64_t *bytes);

/* Whether the current directory's chunks have enough bytes for a page of its shape, at the best ratio that
 * its compression can reach. */
bool tiff_file_can_hold(tiff_file *file, const tiff_shape *shape);

/* Where the voxels of a page go. */
typedef struct tiff_target {
  void *voxels;    /* width x height stored voxels, or colours (colors.h) */
  hl_exact *exact; /* notes the page's numbers; may be null */
  size_t first;    /* the number of the page's first voxel in the volume */
  uint32_t slice;  /* of a page of several slices: which */
  uint64_t
      plain; /* where the page's pixels lie in the file, one row after the other; 0: libtiff finds them */
} tiff_target;

/* Decodes the current directory's component, or an HL_COMPONENT_ value. */
hl_status tiff_file_read(tiff_file *file, const tiff_shape *shape, int component, const tiff_target *target,
                         hl_error *error);

#endif
