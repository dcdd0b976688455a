/* gpu/gpu_volume.c - makes room in the memory of an open device, and copies volumes to it. */
#include <stdio.h>
#include <string.h>

#include "gpu/gpu_state.h"

bool hl_gpu_reserve(hl_gpu *gpu, enum buffer_use use, size_t bytes) {
  gpu_buffer *buffer = &gpu->buffers[use];
  if (bytes < 64) bytes = 64;
  if (buffer->bytes >= bytes) return true;
  gpu->device.driver->release(&gpu->device, buffer);
  if (use >= BUFFER_PIXELS || use == BUFFER_RAYS)
    bytes += bytes / 4; /* a quarter more is reserved, because frames need slightly different sizes while a
                         * camera turns */
  return gpu->device.driver->allocate(&gpu->device, bytes, buffer);
}

bool hl_gpu_upload(hl_gpu *gpu, enum buffer_use use, size_t offset, const void *from, size_t bytes) {
  return bytes == 0 || gpu->device.driver->upload(&gpu->device, &gpu->buffers[use], offset, from, bytes);
}

bool hl_gpu_reserve_and_upload(hl_gpu *gpu, enum buffer_use use, const void *from, size_t bytes) {
  return hl_gpu_reserve(gpu, use, bytes) && hl_gpu_upload(gpu, use, 0, from, bytes);
}

static size_t storage_bytes(int storage) { return storage == 0 ? 1 : storage == 1 ? 2 : 4; }

/* Rows begin at multiples of sixteen bytes, because kernels load aligned words. The multiple is odd:
 * otherwise neighbouring rows of a volume with rows of 256 or 2048 bytes would share a cache's banks and
 * sets. */
size_t hl_gpu_row_bytes(const gpu_volume *volume) {
  if (volume->directory != NULL) return volume->brick_width * sizeof(float);
  return ((size_t)volume->dimension[0] * storage_bytes(volume->storage) + 15) / 16 * 16 | 16;
}

/* READ_BEHIND: the number of bytes after the last voxel that kernels may read. */
enum { READ_BEHIND = 16, STAGE_BYTES = 1 << 20 };

/* Copies a row of the volume's voxels. number: the index of the row among the rows of all slices. */
static void load_row(const gpu_volume *volume, size_t number, size_t packed, unsigned char *row) {
  const size_t rows = (size_t)volume->dimension[1];
  if (volume->load_row != NULL) volume->load_row(volume->pages, number % rows, number / rows, row);
  else memcpy(row, (const unsigned char *)volume->voxels + number * packed, packed);
}

static bool upload_voxels(hl_gpu *gpu, const gpu_volume *volume) {
  const size_t packed = (size_t)volume->dimension[0] * storage_bytes(volume->storage),
               row = hl_gpu_row_bytes(volume),
               rows = (size_t)volume->dimension[1] * (size_t)volume->dimension[2];
  if (!hl_gpu_reserve(gpu, BUFFER_VOXELS, rows * row + READ_BEHIND)) return false;
  if (packed == row && volume->load_row == NULL)
    return hl_gpu_upload(gpu, BUFFER_VOXELS, 0, volume->voxels, rows * row);
  const size_t at_once = STAGE_BYTES / row + 1;
  unsigned char *stage = hl_allocate_zeroed(gpu->context, at_once, row);
  if (stage == NULL)
    return snprintf(gpu->device.problem, sizeof gpu->device.problem, "no memory is left"), false;
  bool done = true;
  for (size_t first = 0; first < rows && done; first += at_once) {
    size_t count = rows - first < at_once ? rows - first : at_once;
    for (size_t i = 0; i < count; i++) load_row(volume, first + i, packed, stage + i * row);
    done = hl_gpu_upload(gpu, BUFFER_VOXELS, first * row, stage, count * row);
  }
  hl_release(gpu->context, stage);
  return done;
}

/* Copies the coefficients and the directory of a field in bricks to the device. */
static bool upload_bricks(hl_gpu *gpu, const gpu_volume *volume) {
  const size_t width = hl_gpu_row_bytes(volume) / sizeof(float),
               bytes = volume->slots * width * width * width * sizeof(float);
  size_t entries = 1;
  for (int axis = 0; axis < 3; axis++) entries *= volume->directory_size[axis];
  return hl_gpu_reserve(gpu, BUFFER_VOXELS, bytes) &&
         hl_gpu_upload(gpu, BUFFER_VOXELS, 0, volume->voxels, bytes) &&
         hl_gpu_reserve_and_upload(gpu, BUFFER_DIRECTORY, volume->directory,
                                   entries * sizeof *volume->directory);
}

static bool upload_colors(hl_gpu *gpu, const gpu_volume *volume) {
  if (volume->colors == NULL) return hl_gpu_reserve(gpu, BUFFER_COLORS, 0);
  return hl_gpu_reserve_and_upload(gpu, BUFFER_COLORS, volume->colors, volume->color_bytes);
}

size_t hl_gpu_mask_begin(const gpu_mask *mask, int part) {
  size_t begin = 0;
  for (int before = 0; before < part; before++) begin += (mask->bytes[before] + 15) / 16 * 16;
  return begin;
}

static bool upload_mask(hl_gpu *gpu, const gpu_mask *mask) {
  bool done = hl_gpu_reserve(gpu, BUFFER_MASK, hl_gpu_mask_begin(mask, PLAN_MASK_PARTS));
  for (int part = 0; part < PLAN_MASK_PARTS && done; part++)
    done = hl_gpu_upload(gpu, BUFFER_MASK, hl_gpu_mask_begin(mask, part), mask->part[part],
                         mask->bytes[part]);
  return done;
}

static bool upload_tables(hl_gpu *gpu, const gpu_volume *volume) {
  size_t bricks = (size_t)volume->brick_count[0] * (size_t)volume->brick_count[1] *
                  (size_t)volume->brick_count[2];
  const size_t column = PLAN_TABLE_ROWS * sizeof(float);
  const size_t tables = PLAN_TABLE_FLOATS * sizeof(float), plane = PLAN_PLANE_FLOATS * sizeof(float);
  bool done = hl_gpu_reserve(gpu, BUFFER_TABLES, tables + (volume->plane_sums != NULL ? 2 * plane : 0)) &&
              hl_gpu_upload(gpu, BUFFER_TABLES, 0, volume->sums, 4 * column) &&
              hl_gpu_upload(gpu, BUFFER_TABLES, 4 * column, volume->color, 4 * column) &&
              hl_gpu_upload(gpu, BUFFER_TABLES, 8 * column, volume->shown, 4 * column);
  done = done && hl_gpu_upload(gpu, BUFFER_TABLES, 12 * column, volume->outside, column);
  if (done && volume->bent != NULL)
    done = hl_gpu_upload(gpu, BUFFER_TABLES, 13 * column, volume->bent, column);
  if (done && volume->steepness != NULL)
    done = hl_gpu_upload(gpu, BUFFER_TABLES, 14 * column, volume->steepness, column);
  if (done && volume->plane_sums != NULL)
    done = hl_gpu_upload(gpu, BUFFER_TABLES, tables, volume->plane_sums, plane) &&
           hl_gpu_upload(gpu, BUFFER_TABLES, tables + plane, volume->plane_color, plane);
  if (done)
    done = hl_gpu_reserve_and_upload(gpu, BUFFER_DISTANCES, volume->relevant, bricks) &&
           hl_gpu_reserve(gpu, BUFFER_DISTANCES_MADE, bricks);
  memcpy(gpu->brick_count, volume->brick_count, sizeof gpu->brick_count);
  gpu->has_distances = false;
  if (done && volume->cell_bits != NULL)
    done = hl_gpu_reserve_and_upload(gpu, BUFFER_CELL_BITS, volume->cell_bits,
                                     bricks * sizeof *volume->cell_bits);
  return done && hl_gpu_reserve(gpu, BUFFER_CELL_BITS, 64) && hl_gpu_reserve(gpu, BUFFER_DIRECTORY, 64);
}

bool hl_gpu_prepare(hl_gpu *gpu, const gpu_volume *volume) {
  if (gpu->version != volume->version) {
    gpu->version = gpu->tables_version = 0;
    if (!(volume->directory != NULL ? upload_bricks(gpu, volume) : upload_voxels(gpu, volume)) ||
        !upload_colors(gpu, volume))
      return false;
    gpu->version = volume->version;
  }
  if (gpu->tables_version != volume->tables_version) {
    gpu->tables_version = 0;
    if (!upload_tables(gpu, volume) || !upload_mask(gpu, &volume->mask)) return false;
    gpu->tables_version = volume->tables_version;
  }
  return true;
}

void hl_gpu_forget(hl_gpu *gpu) { gpu->version = gpu->tables_version = gpu->sky_version = 0; }
