/* volume/formats/tiff/tiff_file.h - decodes the pages of a TIFF file by libtiff to the voxels of one
 * component.
 *
 * libtiff reads from a file or from the caller's memory. libtiff's warnings go to the context's log,
 * libtiff's errors become error lines, and the size of each of libtiff's allocations is limited. Only one
 * thread may use a tiff_file. */
#ifndef HL_VOLUME_TIFF_FILE_H
#define HL_VOLUME_TIFF_FILE_H

#include <tiffio.h>

#include "volume/exact.h"

/* The size and type of a page's voxels, as the page's directory states them. */
typedef struct tiff_shape {
  uint32_t width, height, depth; /* depth: number of slices of a page (ImageDepth) */
  hl_voxel_type type;
  unsigned bits;       /* bits of a sample in the file */
  unsigned components; /* number of samples of a pixel */
  bool planar;         /* whether each component has chunks of its own */
  bool colors;         /* whether samples are red, green, blue and perhaps alpha, of whole bytes */
  bool premultiplied;  /* whether alpha is multiplied into the colours */
} tiff_shape;

enum { TIFF_NO_WARNINGS = 1 << 20 };

typedef struct tiff_file {
  hl_context *context;
  char *path;                  /* owned */
  const unsigned char *memory; /* borrowed; [size]; null if the file is read */
  uint64_t size, at;
  int descriptor; /* descriptor of the open file; -1 if the content is in memory */
  TIFF *tiff;
  char message[300]; /* the first error that libtiff has reported since the caller cleared this text */
  int warnings;      /* number of warnings logged so far; if set to TIFF_NO_WARNINGS before the file is
                      * opened, no warnings are logged */
} tiff_file;

/* Opens a file. bytes: the file's content; null if the file is to be read. quiet: whether the context's
 * `reads` callback is not called, as on threads other than the caller's. The caller must close *file also
 * after a failure. */
hl_status tiff_file_open(hl_context *context, const char *path, const void *bytes, size_t byte_count,
                         bool quiet, tiff_file *file, hl_error *error);
void tiff_file_close(tiff_file *file);

/* Fails with an error that contains libtiff's message. */
hl_status tiff_file_fail(const tiff_file *file, const char *what, hl_error *error);

/* Makes a directory, or one of its reduced pictures, the current directory. level: the number of the reduced
 * picture; 0 for the directory itself. */
hl_status tiff_file_go(tiff_file *file, uint64_t offset, int level, hl_error *error);

/* Finds the shape of the current directory's page. Fails if the page is of a kind that cannot be read. */
hl_status tiff_file_shape(tiff_file *file, tiff_shape *shape, hl_error *error);
bool tiff_shapes_equal(const tiff_shape *a, const tiff_shape *b);

/* Finds the offsets of all directories. The caller owns *offsets (hl_release). */
hl_status tiff_file_pages(tiff_file *file, uint64_t **offsets, size_t *count, hl_error *error);

/* The position in the file of the current page's first pixel; 0 unless all pixels are uncompressed, follow
 * each other, and have samples of whole bytes. *bytes: set to the size of a slice. */
uint64_t tiff_file_plain(tiff_file *file, const tiff_shape *shape, uint64_t *bytes);

/* Returns whether the file is long enough for the current page, if its compression has reached the greatest
 * possible ratio. */
bool tiff_file_can_hold(tiff_file *file, const tiff_shape *shape);

/* The memory in which the voxels of a page are stored, and the way in which the voxels are read. */
typedef struct tiff_target {
  void *voxels;    /* owned by the caller; room for width x height stored voxels, or colours (colors.h) */
  hl_exact *exact; /* records the page's numbers as the file has them; may be null */
  size_t first;    /* the number of the page's first voxel in the volume */
  uint32_t slice;  /* for a page of several slices: the index of the slice to read */
  uint64_t plain;  /* position of the page's pixels in the file, if their rows follow each other; 0 if libtiff
                    * is to find them */
} tiff_target;

/* Decodes the current page. component: an index or an HL_COMPONENT_ value. */
hl_status tiff_file_read(tiff_file *file, const tiff_shape *shape, int component, const tiff_target *target,
                         hl_error *error);

#endif
