/* volume/formats/slices/slice_codecs.h - decodes pictures for slice_picture.c, with one decoder for each kind
 * of picture.
 *
 * Each decoder reads the shape. If `samples` is not null, the decoder also reads the pixels,
 * [height][width][samples] of the shape's type in native byte order. The caller releases the pixels' memory,
 * also after a failure. A file that is too short for its shape is refused before memory for pixels is
 * allocated. */
#ifndef HL_VOLUME_SLICE_CODECS_H
#define HL_VOLUME_SLICE_CODECS_H

#include "volume/exact.h"

/* A picture file in memory. */
typedef struct hl_slice_file {
  hl_context *context;
  const char *path; /* for error lines */
  const unsigned char *bytes;
  size_t length;
  hl_exact *exact; /* records the slice's numbers as the file has them; may be null */
  size_t first;    /* the number of the slice's first voxel in the volume */
} hl_slice_file;

typedef struct hl_slice_shape {
  size_t width, height, samples; /* samples: number of samples of a pixel */
  hl_voxel_type type;
  bool colors, premultiplied; /* colors: whether samples are red, green, blue and perhaps alpha;
                               * premultiplied: whether alpha is multiplied into the colours */
} hl_slice_shape;

hl_status hl_slice_read_png(const hl_slice_file *file, hl_slice_shape *shape, unsigned char **samples,
                            hl_error *error);
hl_status hl_slice_read_jpeg(const hl_slice_file *file, hl_slice_shape *shape, unsigned char **samples,
                             hl_error *error);

/* Decodes one component of the first page of a TIFF file. If voxels is null, reads only the shape. */
hl_status hl_slice_read_tiff(const hl_slice_file *file, hl_slice_shape *shape, int component, void *voxels,
                             hl_error *error);

/* Returns whether a file has the name of a file of bare voxels. */
bool hl_slice_is_raw(const char *name);
/* Reads a slice of bare voxels. If voxels is null, finds only the slice's shape. */
hl_status hl_slice_read_raw(const hl_slice_file *file, hl_slice_shape *shape, void *voxels, hl_error *error);

/* Refuses a picture whose header promises more pixels than the file can hold. bytes_most: the greatest number
 * of bytes that the file can decode to. */
hl_status hl_slice_check_size(const hl_slice_file *file, const hl_slice_shape *shape, size_t bytes_most,
                              hl_error *error);

typedef enum hl_slice_stack {
  HL_SLICE_ALONE,
  HL_SLICE_STACK, /* a TIFF file of several pages, which is a volume of its own */
  HL_SLICE_OF_OME /* an OME-TIFF file, which names all files of its volume */
} hl_slice_stack;

hl_status hl_slice_find_stack(const hl_slice_file *file, hl_slice_stack *stack, hl_error *error);

#endif
