/* volume/formats/vdb/nanovdb_load.c - reads the segments and grids of a NanoVDB file. One grid becomes the
 * volume.
 *
 * Source: nanovdb/util/IO.h of OpenVDB 10. A segment consists of a header of 16 bytes (mark, version, number
 * of grids, codec), 176 bytes of metadata and a name for each grid, and then the grids. All numbers are
 * little-endian. */
#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"
#include "volume/convert.h"
#include "volume/formats/vdb/nanovdb.h"
#include "volume/formats/vdb/nanovdb_bricks.h"
#include "volume/formats/vdb/nanovdb_grid.h"
#include "volume/in_bricks.h"
#include "volume/io/bundle.h"
#include "volume/io/unpack.h"

enum {
  HEADER_BYTES = 16,
  FACTS_BYTES = 176,
  /* offsets of fields in the metadata of a grid */
  AT_GRID_BYTES = 0,
  AT_FILE_BYTES = 8,
  AT_VOXELS = 24,
  AT_KIND = 32,
  AT_CLASS = 36,
  AT_NAME_BYTES = 136,
  AT_CODEC = 168,
  NAME_BYTES_MOST = 4096,
  CLASS_FOG = 2,         /* GridClass::FogVolume */
  CHUNK_BYTES = 1 << 30, /* Blosc packs a grid in pieces of this many bytes */
};

typedef enum nanovdb_codec { CODEC_NONE = 0, CODEC_ZIP = 1, CODEC_BLOSC = 2 } nanovdb_codec;

/* The position, the sizes and the name of a grid in the file. */
typedef struct grid_entry {
  uint64_t at, file_bytes, grid_bytes, voxels;
  uint32_t kind, class, codec;
} grid_entry;

typedef struct grid_list {
  hl_source *source;
  const char *path;
  grid_entry *entries; /* owned; [HL_ARRAYS_MOST], of which the first `count` are set */
  size_t count;
  int density; /* index of the grid with the name "density"; -1 if no grid has this name */
} grid_list;

static uint64_t little(const unsigned char *bytes, int count) {
  uint64_t value = 0;
  for (int n = count - 1; n >= 0; n--) value = value << 8 | bytes[n];
  return value;
}

static hl_status read_exactly(const grid_list *list, uint64_t at, void *bytes, size_t count,
                              hl_error *error) {
  size_t got;
  hl_status status = hl_source_read(list->source, at, bytes, count, &got, error);
  return status == HL_OK && got < count
             ? hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)at, "%s, byte %llu: the file is cut short",
                              list->path, (unsigned long long)at)
             : status;
}

/* ---- the list of grids ---- */

static hl_status read_facts(grid_list *list, hl_load_request *request, uint64_t *at, grid_entry *entry,
                            hl_error *error) {
  unsigned char facts[FACTS_BYTES];
  char name[NAME_BYTES_MOST + 1] = "";
  hl_status status = read_exactly(list, *at, facts, sizeof facts, error);
  if (status != HL_OK) return status;
  uint64_t length = little(facts + AT_NAME_BYTES, 4);
  if (length > NAME_BYTES_MOST)
    return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)*at,
                          "%s: a name of %llu bytes: at most %d are read", list->path,
                          (unsigned long long)length, NAME_BYTES_MOST);
  status = read_exactly(list, *at + FACTS_BYTES, name, (size_t)length, error);
  *at += FACTS_BYTES + length;
  *entry = (grid_entry){.file_bytes = little(facts + AT_FILE_BYTES, 8),
                        .grid_bytes = little(facts + AT_GRID_BYTES, 8),
                        .voxels = little(facts + AT_VOXELS, 8),
                        .kind = (uint32_t)little(facts + AT_KIND, 4),
                        .class = (uint32_t)little(facts + AT_CLASS, 4),
                        .codec = (uint32_t)little(facts + AT_CODEC, 2)};
  hl_voxel_type type;
  size_t components;
  nanovdb_kind(entry->kind, &type, &components);
  if (list->density < 0 && strcmp(name, "density") == 0) list->density = (int)request->array_count;
  return status == HL_OK ? hl_arrays_add(request, name, components, type, false, error) : status;
}

/* Reads the metadata and the names of a segment's grids. The grids themselves stand after the metadata of all
 * grids, one after the other. */
static hl_status read_segment(grid_list *list, hl_load_request *request, uint64_t *at, hl_error *error) {
  unsigned char header[HEADER_BYTES];
  hl_status status = read_exactly(list, *at, header, sizeof header, error);
  if (status == HL_OK && memcmp(header, "NanoVDB", 7) != 0)
    return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)*at,
                          "%s, byte %llu: a segment must begin with \"NanoVDB\"", list->path,
                          (unsigned long long)*at);
  uint64_t count = little(header + 12, 2), size = hl_source_size(list->source);
  if (status == HL_OK && (count == 0 || little(header + 8, 4) >> 21 != 32))
    return hl_fail(
        error, HL_ERROR_UNSUPPORTED,
        "%s: no grid, or a version other than 32: %llu: convert it with nanovdb_convert of OpenVDB 8 to 10",
        list->path, (unsigned long long)little(header + 8, 4) >> 21);
  *at += HEADER_BYTES;
  size_t first = list->count;
  for (uint64_t n = 0; n < count && status == HL_OK && list->count < HL_ARRAYS_MOST; n++)
    status = read_facts(list, request, at, &list->entries[list->count++], error);
  for (size_t n = first; n < list->count && status == HL_OK; n++) {
    grid_entry *entry = &list->entries[n];
    entry->at = *at;
    if (*at > size || entry->file_bytes > size - *at)
      status = hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)*at,
                              "%s, byte %llu: a grid of %llu bytes, the file has only %llu: it is cut short",
                              list->path, (unsigned long long)*at, (unsigned long long)entry->file_bytes,
                              (unsigned long long)size);
    *at += entry->file_bytes;
  }
  return status;
}

static hl_status read_list(grid_list *list, hl_load_request *request, hl_error *error) {
  hl_status status = HL_OK;
  list->density = -1;
  list->entries = hl_allocate_zeroed(request->context, HL_ARRAYS_MOST, sizeof *list->entries);
  if (list->entries == NULL) return hl_fail_memory(error, 10000, "a list of grids");
  for (uint64_t at = 0; status == HL_OK && list->count < HL_ARRAYS_MOST && at < hl_source_size(list->source);)
    status = read_segment(list, request, &at, error);
  if (list->count == HL_ARRAYS_MOST) request->more = true;
  return status;
}

/* ---- the grid's own memory ---- */

/* Reads the next packed piece: eight bytes with its length, and then its bytes. *packed is owned by the
 * caller. */
static hl_status read_piece(const grid_list *list, uint64_t *at, uint64_t end, unsigned char **packed,
                            size_t *length, hl_error *error) {
  unsigned char count[8];
  hl_context *context = hl_source_context(list->source);
  *packed = NULL;
  hl_status status = read_exactly(list, *at, count, sizeof count, error);
  if (status != HL_OK) return status;
  uint64_t bytes = little(count, 8);
  *at += 8;
  if (*at > end || bytes > end - *at)
    return hl_fail_offset(error, HL_ERROR_INPUT, (int64_t)*at, "%s: packed data go beyond their grid",
                          list->path);
  *packed = hl_allocate(context, (size_t)bytes, 1);
  if (*packed == NULL) return hl_fail_memory(error, (size_t)bytes, list->path);
  *length = (size_t)bytes;
  status = read_exactly(list, *at, *packed, *length, error);
  *at += bytes;
  return status;
}

static hl_status fail_packed(const grid_list *list, hl_error *error) {
  return hl_fail(error, HL_ERROR_INPUT, "%s: the packed grid does not unpack to its size: it is damaged",
                 list->path);
}

/* Unpacks a grid, piece by piece, into *bytes. The memory for *bytes is allocated only after the first piece
 * has stated the right size. */
static hl_status unpack(const grid_list *list, const grid_entry *entry, unsigned char **bytes,
                        hl_error *error) {
  hl_context *context = hl_source_context(list->source);
  bool is_zip = entry->codec == CODEC_ZIP, sound = true;
  uint64_t at = entry->at, end = entry->at + entry->file_bytes;
  hl_status status = HL_OK;
  for (uint64_t done = 0; done < entry->grid_bytes && status == HL_OK;) {
    uint64_t left = entry->grid_bytes - done;
    size_t some = (size_t)(is_zip || left < CHUNK_BYTES ? left : CHUNK_BYTES), length = 0;
    unsigned char *packed;
    status = read_piece(list, &at, end, &packed, &length, error);
    if (status == HL_OK)
      sound = is_zip ? hl_deflate_can_hold(length, some) : hl_blosc_can_hold(packed, length, some);
    if (status == HL_OK && sound && *bytes == NULL) {
      *bytes = hl_allocate(context, (size_t)entry->grid_bytes, 1);
      if (*bytes == NULL) status = hl_fail_memory(error, (size_t)entry->grid_bytes, list->path);
    }
    if (status == HL_OK && sound)
      status = is_zip ? hl_unpack_deflate(context, packed, length, *bytes + done, some, &sound, error)
                      : hl_unpack_blosc(list->path, packed, length, *bytes + done, some, &sound, error);
    if (status == HL_OK && !sound) status = fail_packed(list, error);
    hl_release(context, packed);
    done += some;
  }
  return status;
}

static hl_status read_grid(const grid_list *list, const grid_entry *entry, unsigned char **bytes,
                           hl_error *error) {
  hl_context *context = hl_source_context(list->source);
  if (entry->codec == CODEC_ZIP || entry->codec == CODEC_BLOSC) return unpack(list, entry, bytes, error);
  if (entry->codec != CODEC_NONE || entry->grid_bytes > entry->file_bytes)
    return hl_fail(error, HL_ERROR_INPUT, "%s: a grid of %llu bytes by codec %u in %llu bytes: it is damaged",
                   list->path, (unsigned long long)entry->grid_bytes, entry->codec,
                   (unsigned long long)entry->file_bytes);
  *bytes = hl_allocate(context, (size_t)entry->grid_bytes, 1);
  return *bytes != NULL ? read_exactly(list, entry->at, *bytes, (size_t)entry->grid_bytes, error)
                        : hl_fail_memory(error, (size_t)entry->grid_bytes, list->path);
}

/* ---- the volume ---- */

/* Allocates the volume's voxels. A dense volume may take far more memory than its sparse grid; the error for
 * a lack of memory states the number of bytes. */
static hl_status allocate(const grid_list *list, const grid_entry *entry, const hl_volume_description *grid,
                          void **voxels, hl_error *error) {
  hl_context *context = hl_source_context(list->source);
  size_t count = grid->dimensions[0] * grid->dimensions[1] * grid->dimensions[2],
         bytes = hl_storage_bytes(hl_voxel_type_storage(grid->type));
  *voxels = hl_allocate(context, count, bytes);
  if (*voxels != NULL) return HL_OK;
  return hl_fail(
      error, HL_ERROR_MEMORY,
      "%s: %llu active voxels in a box of %zu x %zu x %zu, a volume of %llu bytes, which there is no "
      "memory for (limit %llu)",
      list->path, (unsigned long long)entry->voxels, grid->dimensions[0], grid->dimensions[1],
      grid->dimensions[2], (unsigned long long)count * bytes,
      (unsigned long long)context->options.memory_limit);
}

static hl_status make_volume(const grid_list *list, const grid_entry *entry, nanovdb_grid *grid,
                             hl_payload *payload, hl_load_request *request, hl_volume **volume,
                             hl_error *error) {
  void *voxels = NULL, *numbers = NULL;
  hl_exact exact;
  hl_status status = nanovdb_grid_describe(grid, &payload->grid, error);
  if (status == HL_OK) status = hl_volume_check_grid(&payload->grid, list->path, error);
  if (status != HL_OK) return status;
  hl_volume_description description = hl_payload_grid(payload, request->spacing);
  hl_bricks bricks = {0};
  if (description.type == HL_VOXEL_F32) status = nanovdb_bricks_read(grid, &description, &bricks, error);
  if (status != HL_OK) return status;
  if (bricks.directory != NULL) {
    status = hl_volume_take_bricks(request->context, &bricks, &description, list->path, volume, error);
    if (status == HL_OK) hl_volume_set_field_error(*volume, 0, "exact", "the dense grid of the voxels");
    return status;
  }
  status = allocate(list, entry, &description, &voxels, error);
  const size_t *n = description.dimensions;
  hl_exact_begin(request->context, description.type, n[0] * n[1] * n[2], HL_EXACT_IN_MEMORY, &exact);
  if (status == HL_OK) status = nanovdb_grid_read(grid, &description, voxels, &exact, error);
  if (status == HL_OK) status = hl_exact_take(&exact, voxels, &numbers, error);
  if (status == HL_OK)
    return hl_volume_adopt_exact(request->context, &description, list->path, voxels, numbers, volume, error);
  hl_exact_release(&exact);
  hl_release(request->context, voxels);
  return status;
}

static hl_status load_grid(grid_list *list, hl_load_request *request, hl_volume **volume, hl_error *error) {
  hl_payload payload;
  hl_payload_defaults(&payload);
  hl_status status = hl_arrays_choose(request, list->path, request->array == NULL ? list->density : -1,
                                      error);
  if (status != HL_OK) return status;
  const grid_entry *entry = &list->entries[request->chosen];
  nanovdb_kind(entry->kind, &payload.grid.type, &payload.components);
  request->says_fog = entry->class == CLASS_FOG;
  payload.block = 1;
  payload.colors = HL_COLORS_UNREAD;
  if (payload.grid.type == 0)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: a grid of type %u, which holds no voxels that are read (points, indices): choose "
                   "another by \"array\" (--array), or rasterize it",
                   list->path, entry->kind);
  status = hl_component_choose(request, list->path, false, &payload, error);
  nanovdb_grid grid = {request->context, list->path,        NULL, (size_t)entry->grid_bytes,
                       entry->kind,      payload.component, {0},  {0}};
  if (status == HL_OK) status = read_grid(list, entry, &grid.bytes, error);
  if (status == HL_OK) status = make_volume(list, entry, &grid, &payload, request, volume, error);
  hl_release(request->context, grid.bytes);
  return status;
}

hl_status hl_nanovdb_load(hl_stream **stream, hl_load_request *request, hl_volume **volume, hl_error *error) {
  hl_context *context = request->context;
  unsigned char *whole = NULL;
  hl_bundle one = {.context = context};
  grid_list list = {.path = (*stream)->path};
  hl_status status = hl_bundle_of_file(context, list.path, &one, error);
  if (status == HL_OK && !hl_stream_memory(*stream, &one.memory, &one.memory_size) &&
      !hl_stream_is_plain_file(*stream)) {
    status = hl_stream_read_rest(*stream, &whole, &one.memory_size, error);
    one.memory = whole;
  }
  if (status == HL_OK) status = hl_bundle_entry_open(&one, &one.entries[0], true, &list.source, error);
  if (status == HL_OK) status = read_list(&list, request, error);
  if (status == HL_OK) status = load_grid(&list, request, volume, error);
  hl_release(context, list.entries);
  hl_source_close(list.source);
  hl_bundle_close(&one);
  hl_release(context, whole);
  return status;
}

const char *hl_nanovdb_missing(void) { return NULL; }
