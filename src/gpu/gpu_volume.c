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

/* Finds the number of bytes that a volume's voxels take on the device. */
static size_t voxel_bytes(const gpu_volume *volume) {
  const size_t row = hl_gpu_row_bytes(volume);
  if (volume->directory != NULL) return volume->slots * volume->brick_width * volume->brick_width * row;
  return (size_t)volume->dimension[1] * (size_t)volume->dimension[2] * row + READ_BEHIND;
}

static size_t directory_entries(const gpu_volume *volume) {
  if (volume->directory == NULL) return 0;
  return volume->directory_size[0] * volume->directory_size[1] * volume->directory_size[2];
}

static size_t bricks_of(const gpu_volume *volume) {
  return (size_t)volume->brick_count[0] * (size_t)volume->brick_count[1] * (size_t)volume->brick_count[2];
}

static size_t whole_sixteens(size_t bytes) { return (bytes + 15) / 16 * 16; }

void hl_gpu_find_places(const gpu_volume *volumes, int count, gpu_place *places) {
  places[0] = (gpu_place){0};
  for (int v = 0; v < count; v++) {
    const gpu_volume *volume = &volumes[v];
    const gpu_place *own = &places[v];
    places[v + 1] = (gpu_place){
        .voxels = own->voxels + whole_sixteens(voxel_bytes(volume)),
        .colors = own->colors + whole_sixteens(volume->colors == NULL ? 0 : volume->color_bytes),
        .mask = own->mask + hl_gpu_mask_begin(&volume->mask, PLAN_MASK_PARTS),
        .directory = own->directory + directory_entries(volume),
        .bricks = own->bricks + bricks_of(volume),
        .tables = own->tables + PLAN_TABLE_FLOATS + (volume->plane_sums != NULL ? 2 * PLAN_PLANE_FLOATS : 0)};
  }
}

/* Copies a volume's voxels to the place that begins after a number of bytes. */
static bool upload_voxels(hl_gpu *gpu, const gpu_volume *volume, size_t begin) {
  const size_t packed = (size_t)volume->dimension[0] * storage_bytes(volume->storage),
               row = hl_gpu_row_bytes(volume),
               rows = (size_t)volume->dimension[1] * (size_t)volume->dimension[2];
  if (packed == row && volume->load_row == NULL)
    return hl_gpu_upload(gpu, BUFFER_VOXELS, begin, volume->voxels, rows * row);
  const size_t at_once = STAGE_BYTES / row + 1;
  unsigned char *stage = hl_allocate_zeroed(gpu->context, at_once, row);
  if (stage == NULL)
    return snprintf(gpu->device.problem, sizeof gpu->device.problem, "no memory is left"), false;
  bool done = true;
  for (size_t first = 0; first < rows && done; first += at_once) {
    size_t count = rows - first < at_once ? rows - first : at_once;
    for (size_t i = 0; i < count; i++) load_row(volume, first + i, packed, stage + i * row);
    done = hl_gpu_upload(gpu, BUFFER_VOXELS, begin + first * row, stage, count * row);
  }
  hl_release(gpu->context, stage);
  return done;
}

/* Copies the coefficients and the directory of a field in bricks to the device. */
static bool upload_bricks(hl_gpu *gpu, const gpu_volume *volume, const gpu_place *place) {
  return hl_gpu_upload(gpu, BUFFER_VOXELS, place->voxels, volume->voxels, voxel_bytes(volume)) &&
         hl_gpu_upload(gpu, BUFFER_DIRECTORY, place->directory * sizeof *volume->directory, volume->directory,
                       directory_entries(volume) * sizeof *volume->directory);
}

static bool upload_matter(hl_gpu *gpu, const gpu_volume *volume, const gpu_place *place) {
  const bool done = volume->directory != NULL ? upload_bricks(gpu, volume, place)
                                              : upload_voxels(gpu, volume, place->voxels);
  return done && (volume->colors == NULL ||
                  hl_gpu_upload(gpu, BUFFER_COLORS, place->colors, volume->colors, volume->color_bytes));
}

size_t hl_gpu_mask_begin(const gpu_mask *mask, int part) {
  size_t begin = 0;
  for (int before = 0; before < part; before++) begin += whole_sixteens(mask->bytes[before]);
  return begin;
}

static bool upload_mask(hl_gpu *gpu, const gpu_mask *mask, size_t begin) {
  bool done = true;
  for (int part = 0; part < PLAN_MASK_PARTS && done; part++)
    done = hl_gpu_upload(gpu, BUFFER_MASK, begin + hl_gpu_mask_begin(mask, part), mask->part[part],
                         mask->bytes[part]);
  return done;
}

/* Copies columns of a volume's tables to the device. first: the number of columns before them. */
static bool upload_columns(hl_gpu *gpu, const gpu_place *place, size_t first, const float *columns,
                           size_t count) {
  const size_t column = PLAN_TABLE_ROWS * sizeof(float);
  return columns == NULL || hl_gpu_upload(gpu, BUFFER_TABLES, place->tables * sizeof(float) + first * column,
                                          columns, count * column);
}

static bool upload_tables(hl_gpu *gpu, const gpu_volume *volume, const gpu_place *place) {
  const size_t plane = PLAN_PLANE_FLOATS * sizeof(float), bricks = bricks_of(volume),
               planes = (place->tables + PLAN_TABLE_FLOATS) * sizeof(float);
  bool done = upload_columns(gpu, place, 0, volume->sums, 4) &&
              upload_columns(gpu, place, 4, volume->color, 4) &&
              upload_columns(gpu, place, 8, volume->shown, 4) &&
              upload_columns(gpu, place, 12, volume->outside, 1) &&
              upload_columns(gpu, place, 13, volume->bent, 1) &&
              upload_columns(gpu, place, 14, volume->steepness, 1);
  if (done && volume->plane_sums != NULL)
    done = hl_gpu_upload(gpu, BUFFER_TABLES, planes, volume->plane_sums, plane) &&
           hl_gpu_upload(gpu, BUFFER_TABLES, planes + plane, volume->plane_color, plane);
  done = done && hl_gpu_upload(gpu, BUFFER_DISTANCES, place->bricks, volume->relevant, bricks);
  if (done && volume->cell_bits != NULL)
    done = hl_gpu_upload(gpu, BUFFER_CELL_BITS, place->bricks * sizeof *volume->cell_bits, volume->cell_bits,
                         bricks * sizeof *volume->cell_bits);
  return done && upload_mask(gpu, &volume->mask, place->mask);
}

/* Makes room for the data of all volumes. The room for cells' bits is needed only if some volume has them. */
static bool make_matter_room(hl_gpu *gpu, const gpu_place *end) {
  return hl_gpu_reserve(gpu, BUFFER_VOXELS, end->voxels) && hl_gpu_reserve(gpu, BUFFER_COLORS, end->colors) &&
         hl_gpu_reserve(gpu, BUFFER_DIRECTORY, end->directory * sizeof(plan_brick));
}

static bool make_table_room(hl_gpu *gpu, const gpu_volume *volumes, int count, const gpu_place *end) {
  bool bits = false;
  for (int v = 0; v < count; v++) bits = bits || volumes[v].cell_bits != NULL;
  return hl_gpu_reserve(gpu, BUFFER_TABLES, end->tables * sizeof(float)) &&
         hl_gpu_reserve(gpu, BUFFER_DISTANCES, end->bricks) &&
         hl_gpu_reserve(gpu, BUFFER_DISTANCES_MADE, end->bricks) &&
         hl_gpu_reserve(gpu, BUFFER_CELL_BITS, bits ? end->bricks * sizeof(uint64_t) : 0) &&
         hl_gpu_reserve(gpu, BUFFER_MASK, end->mask);
}

/* If one volume's voxels change, the places of all volumes may change, so that all are copied again. The same
 * holds for tables. */
bool hl_gpu_prepare(hl_gpu *gpu, const gpu_volume *volumes, int count) {
  gpu_place places[PLAN_VOLUMES + 1];
  bool same = gpu->volume_count == count, same_tables = same, done = true;
  for (int v = 0; v < count; v++) {
    same = same && gpu->version[v] == volumes[v].version;
    same_tables = same_tables && gpu->tables_version[v] == volumes[v].tables_version;
  }
  same_tables = same_tables && same;
  if (same && same_tables) return true;
  hl_gpu_find_places(volumes, count, places);
  gpu->volume_count = 0;
  if (!same) done = make_matter_room(gpu, &places[count]);
  for (int v = 0; v < count && done && !same; v++) done = upload_matter(gpu, &volumes[v], &places[v]);
  done = done && make_table_room(gpu, volumes, count, &places[count]);
  for (int v = 0; v < count && done; v++) {
    done = upload_tables(gpu, &volumes[v], &places[v]);
    memcpy(gpu->brick_count[v], volumes[v].brick_count, sizeof gpu->brick_count[v]);
    gpu->version[v] = volumes[v].version;
    gpu->tables_version[v] = volumes[v].tables_version;
  }
  gpu->has_distances = false;
  if (done) gpu->volume_count = count;
  return done;
}

void hl_gpu_forget(hl_gpu *gpu) {
  gpu->volume_count = 0;
  gpu->sky_version = 0;
}
