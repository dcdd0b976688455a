/* volume/formats/spm_mat.c - reads the file in which SPM stores the map from indices to the world of an
 * ANALYZE volume.
 *
 * The file is a MAT-file of version 4: a sequence of variables, each of which has five integers, a name and
 * the numbers of a matrix, column by column. The variable "mat" is the matrix from voxel indices, which SPM
 * counts from 1, to the world in millimetres. In older files the matrix is named "M"; its x runs to the left,
 * as in nibabel (spm99analyze.py). Source of the format: MathWorks, "MAT-File Format", Level 4. */
#include "volume/formats/spm_mat.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "volume/io/numbers.h"
#include "volume/io/stream.h"
#include "volume/io/text.h"

enum { MOST_BYTES = 1 << 16, HEAD_BYTES = 20, NUMBERS = 16, PATH_BYTES = 4096 };

/* The part of the file that has not been read yet. */
typedef struct mat_file {
  const unsigned char *at;
  size_t left;
} mat_file;

typedef struct matrix {
  bool found;
  double numbers[NUMBERS]; /* the matrix, column by column */
} matrix;

static uint32_t load_word(const unsigned char *bytes, bool big_endian) {
  uint32_t word = 0;
  for (int n = 0; n < 4; n++) word |= (uint32_t)bytes[big_endian ? 3 - n : n] << 8 * n;
  return word;
}

/* Reads the file's next variable. Returns false at the end of the file, and if the file is not a MAT-file of
 * version 4. */
static bool read_variable(mat_file *file, matrix *mat, matrix *older) {
  static const size_t sizes[] = {8, 4, 4, 2, 2, 1}; /* the size in bytes of each kind of number */
  if (file->left < HEAD_BYTES) return false;
  const bool big_endian = load_word(file->at, false) > 9999;
  uint32_t head[5];
  for (int n = 0; n < 5; n++) head[n] = load_word(file->at + 4 * n, big_endian);
  const uint32_t kind = head[0] / 10 % 10, rows = head[1], columns = head[2], name_bytes = head[4];
  if (head[0] != 1000u * big_endian + 10 * kind + head[0] % 10 || kind > 5 || head[0] % 10 > 2) return false;
  if (rows > MOST_BYTES || columns > MOST_BYTES || head[3] > 1 || name_bytes < 1 || name_bytes > MOST_BYTES)
    return false;
  const uint64_t bytes = (uint64_t)rows * columns * sizes[kind] * (1 + head[3]);
  if (bytes > file->left || HEAD_BYTES + name_bytes + bytes > file->left) return false;
  const unsigned char *name = file->at + HEAD_BYTES, *numbers = name + name_bytes;
  matrix *to = name_bytes == 4 && memcmp(name, "mat", 4) == 0 ? mat
               : name_bytes == 2 && memcmp(name, "M", 2) == 0 ? older
                                                              : NULL;
  if (to != NULL && rows == 4 && columns == 4 && kind == 0 && head[3] == 0) {
    to->found = true;
    for (int n = 0; n < NUMBERS; n++)
      to->numbers[n] = hl_binary_number(numbers + 8 * n, HL_VOXEL_F64, big_endian);
  }
  file->at = numbers + bytes;
  file->left -= HEAD_BYTES + name_bytes + (size_t)bytes;
  return true;
}

/* Sets the grid's axes and origin from the matrix. The matrix counts voxels from 1, the grid from 0. Returns
 * false if no grid can have the matrix's axes. */
static bool put(const matrix *from, const char *path, hl_volume_description *grid) {
  hl_volume_description placed = *grid;
  for (int row = 0; row < 3; row++) {
    placed.origin[row] = from->numbers[12 + row];
    for (int axis = 0; axis < 3; axis++) {
      placed.axis[axis][row] = from->numbers[4 * axis + row];
      placed.origin[row] += placed.axis[axis][row];
    }
  }
  if (hl_volume_check_grid(&placed, path, NULL) != HL_OK) return false;
  *grid = placed;
  return true;
}

static bool place(const char *path, mat_file file, hl_volume_description *grid) {
  matrix mat = {.found = false}, older = {.found = false};
  while (read_variable(&file, &mat, &older)) {}
  for (int column = 0; column < 4; column++) older.numbers[4 * column] *= -1; /* x now runs to the right */
  if (!mat.found) mat = older;
  return mat.found && put(&mat, path, grid);
}

bool hl_spm_mat_place(hl_context *context, const char *header_path, hl_volume_description *grid) {
  char path[PATH_BYTES];
  hl_stream *stream = NULL;
  unsigned char *bytes = NULL;
  size_t length = strlen(header_path), got = 0;
  hl_error ignored;
  if (hl_text_ends(header_path, ".gz")) length -= 3;
  if (length < 4 || length >= sizeof path || strncmp(header_path + length - 4, ".hdr", 4) != 0) return false;
  snprintf(path, sizeof path, "%.*s.mat", (int)(length - 4), header_path);
  if (hl_stream_open(context, path, true, &stream, &ignored) != HL_OK) return false;
  bytes = hl_allocate(context, MOST_BYTES, 1);
  bool placed = bytes != NULL && hl_stream_read(stream, bytes, MOST_BYTES, &got, &ignored) == HL_OK &&
                place(path, (mat_file){bytes, got}, grid);
  hl_stream_close(stream);
  hl_release(context, bytes);
  if (!placed)
    hl_log(context, HL_LOG_WARNING,
           "%.300s: SPM's place of the volume is not read: it is no MAT-file of version 4 with a matrix of "
           "4 x 4 numbers: save it by \"save -v4\"",
           path);
  return placed;
}
