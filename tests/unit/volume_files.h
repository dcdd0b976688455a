/* tests/unit/volume_files.h - small volume files in every format, made byte by byte for the tests.
 *
 * All hold the same grid of 3 x 2 x 2 voxels with the values of voxel_value(type, n), n counting voxels in
 * file order, so that a reader's mistake in order, type, sign or byte order shows.
 */
#ifndef HL_TESTS_VOLUME_FILES_H
#define HL_TESTS_VOLUME_FILES_H

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "volume/convert.h"

enum {
  NI = 3,
  NJ = 2,
  NK = 2,
  VOXELS = NI * NJ * NK,
  FILE_BYTES = 8192,
  FOLDER_BYTES = 64,
  PATH_BYTES = 256
};

typedef struct byte_buffer {
  unsigned char data[FILE_BYTES];
  size_t length;
} byte_buffer;

/* A file, the file to which it refers, if any, and the volume that must be read. */
typedef struct volume_sample {
  char name[128], other_name[128]; /* other_name: "" if there is no other file */
  byte_buffer file, other;
  hl_voxel_type type;
  double origin[3], axis[3][3]; /* as in hl_volume_description */
  double scale, shift;
  bool is_text; /* voxels as decimal numbers */
} volume_sample;

typedef void sample_function(const volume_sample *sample, void *data);

/* Calls function for every variant of every format. */
void for_each_sample(sample_function *function, void *data);

/* Its parts in volume_files_more.c: NumPy arrays, VolVis' and microscopes' files, and files of several
 * components whose first is the volume. */
void for_each_numpy_sample(sample_function *function, void *data);
void for_each_volvis_sample(sample_function *function, void *data);
void for_each_microscope_sample(sample_function *function, void *data);
void for_each_component_sample(sample_function *function, void *data);

/* A sample with unit axes; the rest of its name describes it in failing tests. */
volume_sample begin_sample(hl_voxel_type type, const char *name, ...) __attribute__((format(printf, 2, 3)));

double voxel_value(hl_voxel_type type, int n);

void add(byte_buffer *target, const void *source, size_t length);
void add_text(byte_buffer *target, const char *format, ...) __attribute__((format(printf, 2, 3)));
void add_voxels(byte_buffer *target, hl_voxel_type type, bool big_endian);
void add_voxels_as_text(byte_buffer *target, hl_voxel_type type, const char *separator);
void add_base64(byte_buffer *target, const unsigned char *source, size_t length);
void add_compressed(byte_buffer *target, const unsigned char *source, size_t length, bool gzip);
void add_integer(byte_buffer *target, uint64_t value, size_t length, bool big_endian);

/* A folder of the test's own under the system's temporary one; remove_folder removes it with its files. */
void make_folder(char folder[FOLDER_BYTES]);
void remove_folder(const char *folder);
void write_file(const char *folder, const char *name, const byte_buffer *content, char path[PATH_BYTES]);
/* Writes the sample's files. path: of the file to load. */
void write_sample(const char *folder, const volume_sample *sample, char path[PATH_BYTES]);
void remove_sample(const char *folder, const volume_sample *sample);

/* Returns whether the volume is the sample's: grid, type, place and the first voxels. */
bool is_sample(const hl_volume *volume, const volume_sample *sample, int voxels);

#endif
