/* volume/formats/vdb/nanovdb_grid.c - walks through a NanoVDB tree on all threads. The unit of work of a
 * thread is a lower node of the tree, which has 128^3 voxels.
 *
 * In index space x runs along the volume's i, y along j, z along k; in a leaf, z is the fastest axis. */
#define PNANOVDB_C
#define PNANOVDB_BUF_BOUNDS_CHECK
#include <nanovdb/PNanoVDB.h>

#include <limits.h>
#include <math.h>
#include <string.h>

#include "core/context.h"
#include "volume/convert.h"
#include "volume/formats/vdb/nanovdb_grid.h"
#include "volume/io/parallel.h"

enum {
  LEAF = 8,
  LOWER = 128,
  LEAF_VOXELS = LEAF * LEAF * LEAF,
  TILES_MOST = 4096, /* greatest number of tiles of a root, because the tiles are examined one by one; a tile
                      * has 4096^3 voxels */
  FPN_LOG_BITS_MOST = 4,
  PARALLEL_VOXELS = 1 << 20
};

typedef struct walk {
  const nanovdb_grid *grid;
  pnanovdb_buf_t memory;
  pnanovdb_root_handle_t root;
  int64_t low[3], size[3]; /* the box of active voxels */
  int64_t first[3];        /* the first lower node that intersects the box; `count` is the number of lower
                            * nodes along each axis that intersect the box */
  size_t count[3];
  hl_voxel_type type;  /* type of the staged values, from which the volume's stored values are made */
  size_t bytes;        /* bytes of a staged value */
  size_t stored_bytes; /* bytes of a voxel of the volume */
  unsigned char *voxels;
  hl_exact *exact;
} walk;

/* ---- kinds ---- */

typedef struct kind_of_grid {
  hl_voxel_type type;
  unsigned char components;
} kind_of_grid;

static const kind_of_grid kinds[PNANOVDB_GRID_TYPE_END] = {
    [PNANOVDB_GRID_TYPE_FLOAT] = {HL_VOXEL_F32, 1},  [PNANOVDB_GRID_TYPE_DOUBLE] = {HL_VOXEL_F64, 1},
    [PNANOVDB_GRID_TYPE_INT16] = {HL_VOXEL_I16, 1},  [PNANOVDB_GRID_TYPE_INT32] = {HL_VOXEL_I32, 1},
    [PNANOVDB_GRID_TYPE_INT64] = {HL_VOXEL_I64, 1},  [PNANOVDB_GRID_TYPE_VEC3F] = {HL_VOXEL_F32, 3},
    [PNANOVDB_GRID_TYPE_VEC3D] = {HL_VOXEL_F64, 3},  [PNANOVDB_GRID_TYPE_MASK] = {HL_VOXEL_U8, 1},
    [PNANOVDB_GRID_TYPE_HALF] = {HL_VOXEL_F16, 1},   [PNANOVDB_GRID_TYPE_UINT32] = {HL_VOXEL_U32, 1},
    [PNANOVDB_GRID_TYPE_BOOLEAN] = {HL_VOXEL_U8, 1}, [PNANOVDB_GRID_TYPE_RGBA8] = {HL_VOXEL_U8, 4},
    [PNANOVDB_GRID_TYPE_FP4] = {HL_VOXEL_F32, 1},    [PNANOVDB_GRID_TYPE_FP8] = {HL_VOXEL_F32, 1},
    [PNANOVDB_GRID_TYPE_FP16] = {HL_VOXEL_F32, 1},   [PNANOVDB_GRID_TYPE_FPN] = {HL_VOXEL_F32, 1},
    [PNANOVDB_GRID_TYPE_VEC4F] = {HL_VOXEL_F32, 4},  [PNANOVDB_GRID_TYPE_VEC4D] = {HL_VOXEL_F64, 4}};

void nanovdb_kind(uint32_t kind, hl_voxel_type *type, size_t *components) {
  bool known = kind < PNANOVDB_GRID_TYPE_END && kinds[kind].components > 0;
  *type = known ? kinds[kind].type : (hl_voxel_type)0;
  *components = known ? kinds[kind].components : 1;
}

/* ---- the header ---- */

static hl_status fail_damaged(const nanovdb_grid *grid, const char *what, hl_error *error) {
  return hl_fail(error, HL_ERROR_INPUT, "%s: the grid is damaged: %s", grid->path, what);
}

static void begin(const nanovdb_grid *grid, walk *w) {
  const pnanovdb_grid_handle_t handle = {pnanovdb_address_null()};
  *w = (walk){.grid = grid};
  w->memory = pnanovdb_make_buf((uint32_t *)(void *)grid->bytes, grid->size / 4);
  w->root = pnanovdb_tree_get_root(w->memory, pnanovdb_grid_get_tree(w->memory, handle));
}

/* Finds the range of lower nodes that intersect the box. */
static void find_lower_nodes(walk *w) {
  for (int a = 0; a < 3; a++) {
    int64_t low = w->low[a], high = w->low[a] + w->size[a] - 1;
    w->first[a] = (low - (low & (LOWER - 1))) / LOWER;
    w->count[a] = (size_t)((high - (high & (LOWER - 1))) / LOWER - w->first[a] + 1);
  }
}

/* Makes the box of active voxels the box to read, and finds the lower nodes that intersect the box. */
static void take_box(walk *w) {
  memcpy(w->low, w->grid->low, sizeof w->low);
  memcpy(w->size, w->grid->box_size, sizeof w->size);
  find_lower_nodes(w);
}

/* The box of the regions of 128^3 voxels in which the tree has nodes or active tiles, and the number of lower
 * nodes. */
typedef struct tree_extent {
  int64_t low[3], high[3]; /* the first voxel and the last voxel of the box */
  uint64_t lower_nodes;
} tree_extent;

static void add_cube(const int64_t begin[3], int64_t side, tree_extent *extent) {
  for (int a = 0; a < 3; a++) {
    if (begin[a] < extent->low[a]) extent->low[a] = begin[a];
    if (begin[a] + side - 1 > extent->high[a]) extent->high[a] = begin[a] + side - 1;
  }
}

/* Adds the regions of an upper node to the extent. A 32-bit word of the node's masks stands for 32 regions
 * along z. */
static void add_upper(const walk *w, pnanovdb_upper_handle_t upper, const int64_t begin[3],
                      tree_extent *extent) {
  enum { WORDS = PNANOVDB_UPPER_TABLE_COUNT / 32 };
  for (uint32_t n = 0; n < WORDS; n++) {
    const pnanovdb_address_t word = pnanovdb_address_offset(upper.address, 4 * n);
    const uint32_t children = pnanovdb_read_uint32(
        w->memory, pnanovdb_address_offset(word, PNANOVDB_UPPER_OFF_CHILD_MASK));
    const uint32_t any = children | pnanovdb_read_uint32(w->memory, pnanovdb_address_offset(
                                                                        word, PNANOVDB_UPPER_OFF_VALUE_MASK));
    extent->lower_nodes += (uint64_t)__builtin_popcount(children);
    if (any == 0) continue;
    int64_t at[3] = {begin[0] + LOWER * (n >> 5), begin[1] + LOWER * (n & 31),
                     begin[2] + LOWER * __builtin_ctz(any)};
    add_cube(at, LOWER, extent);
    at[2] = begin[2] + LOWER * (31 - __builtin_clz(any));
    add_cube(at, LOWER, extent);
  }
}

/* Finds the extent of the tree. A tile's key has 21 bits for each axis: the upper bits of its first voxel. */
static hl_status find_extent(const walk *w, tree_extent *extent, hl_error *error) {
  enum { KEY_BITS = 21, TILE_BITS = 12 };
  const uint32_t kind = w->grid->kind, tiles = pnanovdb_root_get_tile_count(w->memory, w->root);
  *extent = (tree_extent){.low = {INT64_MAX, INT64_MAX, INT64_MAX},
                          .high = {INT64_MIN, INT64_MIN, INT64_MIN}};
  for (uint32_t n = 0; n < tiles; n++) {
    const pnanovdb_root_tile_handle_t tile = pnanovdb_root_get_tile(kind, w->root, n);
    const uint64_t key = pnanovdb_root_tile_get_key(w->memory, tile);
    int64_t begin[3];
    for (int a = 0; a < 3; a++) {
      const uint32_t place = (uint32_t)(key >> (KEY_BITS * (2 - a)) & ((1u << KEY_BITS) - 1)) << TILE_BITS;
      begin[a] = (int32_t)place;
    }
    if (pnanovdb_int64_is_zero(pnanovdb_root_tile_get_child(w->memory, tile))) {
      if (pnanovdb_root_tile_get_state(w->memory, tile) != 0) add_cube(begin, 1 << TILE_BITS, extent);
      continue;
    }
    const pnanovdb_upper_handle_t upper = pnanovdb_root_get_child(kind, w->memory, w->root, tile);
    if (upper.address.byte_offset > w->grid->size)
      return fail_damaged(w->grid, "a node lies outside of it", error);
    add_upper(w, upper, begin, extent);
  }
  if (extent->lower_nodes > w->grid->size / pnanovdb_grid_type_constants[kind].lower_size)
    return fail_damaged(w->grid, "its nodes name more nodes than there is room for", error);
  return HL_OK;
}

/* Finds the box of active voxels. The box that the file states is clipped to the tree's extent, so that a
 * damaged box cannot be larger than the extent. Fails if the box is empty, or if a side needs more than 32
 * bits. */
static hl_status find_box(const walk *w, nanovdb_grid *grid, hl_error *error) {
  const pnanovdb_coord_t low = pnanovdb_root_get_bbox_min(w->memory, w->root),
                         high = pnanovdb_root_get_bbox_max(w->memory, w->root);
  const int64_t lows[3] = {low.x, low.y, low.z}, highs[3] = {high.x, high.y, high.z};
  tree_extent extent;
  bool cut = false;
  hl_status status = find_extent(w, &extent, error);
  for (int a = 0; a < 3 && status == HL_OK; a++) {
    const int64_t from = lows[a] > extent.low[a] ? lows[a] : extent.low[a],
                  to = highs[a] < extent.high[a] ? highs[a] : extent.high[a];
    if (lows[a] > highs[a] || from > to || to - from >= INT32_MAX)
      return hl_fail(error, HL_ERROR_INPUT, "%s: the grid has no active voxels", grid->path);
    cut = cut || from != lows[a] || to != highs[a];
    grid->low[a] = from;
    grid->box_size[a] = to - from + 1;
  }
  if (cut)
    hl_log(grid->context, HL_LOG_WARNING,
           "%.300s: the box of active voxels is larger than the grid's nodes: it is cut to them: the file "
           "may be "
           "damaged",
           grid->path);
  return status;
}

static hl_status check_root(const walk *w, hl_error *error) {
  uint64_t size = w->grid->size, at = w->root.address.byte_offset;
  uint32_t tiles = pnanovdb_root_get_tile_count(w->memory, w->root);
  uint64_t tile_bytes = pnanovdb_grid_type_constants[w->grid->kind].root_tile_size;
  uint64_t root_bytes = pnanovdb_grid_type_constants[w->grid->kind].root_size;
  if (at % 32 != 0 || at > size || root_bytes > size - at)
    return fail_damaged(w->grid, "its root lies outside", error);
  if (tiles > (size - at - root_bytes) / tile_bytes)
    return fail_damaged(w->grid, "its root has more tiles than there is room for", error);
  if (tiles > TILES_MOST)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: %u regions of 4096^3 voxels: at most %d are read: crop the grid", w->grid->path,
                   tiles, TILES_MOST);
  return HL_OK;
}

/* Sets the volume's axes and origin by the grid's map: world = matrix * index + vector. Voxel centres have
 * whole indices. */
static void place(const walk *w, hl_volume_description *description) {
  const pnanovdb_grid_handle_t handle = {pnanovdb_address_null()};
  pnanovdb_map_handle_t map = pnanovdb_grid_get_map(w->memory, handle);
  for (uint32_t row = 0; row < 3; row++) {
    description->origin[row] = pnanovdb_map_get_vecd(w->memory, map, row);
    for (uint32_t a = 0; a < 3; a++) {
      double step = pnanovdb_map_get_matd(w->memory, map, 3 * row + a);
      description->axis[a][row] = step;
      description->origin[row] += step * (double)w->low[a];
    }
  }
}

hl_status nanovdb_grid_describe(nanovdb_grid *grid, hl_volume_description *description, hl_error *error) {
  const pnanovdb_grid_handle_t handle = {pnanovdb_address_null()};
  walk w;
  begin(grid, &w);
  if (grid->size < PNANOVDB_GRID_SIZE + PNANOVDB_TREE_SIZE ||
      pnanovdb_version_get_major(pnanovdb_grid_get_version(w.memory, handle)) !=
          PNANOVDB_MAJOR_VERSION_NUMBER)
    return fail_damaged(grid, "its version is not 32", error);
  if (pnanovdb_grid_get_grid_type(w.memory, handle) != grid->kind)
    return fail_damaged(grid, "its type is not what the file says", error);
  hl_status status = check_root(&w, error);
  if (status == HL_OK) status = find_box(&w, grid, error);
  if (status != HL_OK) return status;
  take_box(&w);
  for (int a = 0; a < 3; a++) description->dimensions[a] = (size_t)w.size[a];
  place(&w, description);
  return HL_OK;
}

/* ---- values ---- */

/* Converts the wanted component of a value of the grid, or the value's magnitude, to the staged type. */
static void take_value(const walk *w, const unsigned char *from, unsigned char *to) {
  const nanovdb_grid *grid = w->grid;
  if (grid->component != HL_COMPONENT_MAGNITUDE) {
    memcpy(to, from + (size_t)grid->component * w->bytes, w->bytes);
    return;
  }
  double sum = 0;
  for (int c = 0; c < kinds[grid->kind].components; c++) {
    double value = 0;
    float single;
    if (kinds[grid->kind].type == HL_VOXEL_F64) memcpy(&value, from + 8 * c, 8);
    else if (kinds[grid->kind].type == HL_VOXEL_F32) {
      memcpy(&single, from + 4 * c, 4);
      value = (double)single;
    } else value = from[c];
    sum += value * value;
  }
  float magnitude = (float)sqrt(sum);
  memcpy(to, &magnitude, sizeof magnitude);
}

/* Finds the bytes of `count` values at an address; null if any of the values lies outside of the grid's
 * memory. */
static const unsigned char *values_at(const walk *w, pnanovdb_address_t address, size_t count,
                                      size_t *stride) {
  *stride = kinds[w->grid->kind].components * hl_voxel_type_bytes(kinds[w->grid->kind].type);
  uint64_t at = address.byte_offset, bytes = count * *stride;
  return at <= w->grid->size && bytes <= w->grid->size - at ? w->grid->bytes + at : NULL;
}

static bool is_quantised(uint32_t kind) {
  return kind == PNANOVDB_GRID_TYPE_FP4 || kind == PNANOVDB_GRID_TYPE_FP8 ||
         kind == PNANOVDB_GRID_TYPE_FP16 || kind == PNANOVDB_GRID_TYPE_FPN;
}

/* The logarithm to base 2 of the number of bits of a value, in a leaf of a quantised kind. */
static uint32_t log_bits(const walk *w, pnanovdb_leaf_handle_t leaf) {
  switch (w->grid->kind) {
    case PNANOVDB_GRID_TYPE_FP4: return 2;
    case PNANOVDB_GRID_TYPE_FP8: return 3;
    case PNANOVDB_GRID_TYPE_FP16: return 4;
    default: return pnanovdb_leaf_get_bbox_dif_and_flags(w->memory, leaf) >> 29;
  }
}

static bool stage_quantised(const walk *w, pnanovdb_leaf_handle_t leaf, unsigned char *stage) {
  uint32_t bits = log_bits(w, leaf);
  if (bits > FPN_LOG_BITS_MOST) return false;
  pnanovdb_address_t table = pnanovdb_leaf_get_table_address(w->grid->kind, w->memory, leaf, 0);
  for (int n = 0; n < LEAF_VOXELS; n++) {
    const pnanovdb_coord_t place = {n >> 6, n >> 3 & 7, n & 7};
    float value = pnanovdb_leaf_fp_read_float(w->memory, table, &place, bits);
    memcpy(stage + 4 * (size_t)n, &value, sizeof value);
  }
  return true;
}

/* Stages the values of a leaf whose values are bits. In a mask grid, the value of a voxel is 1 if the voxel
 * is active. In a grid of booleans, the values follow the leaf's mask of active voxels, as in NanoVDB.h; the
 * offset in PNanoVDB.h differs. */
static void stage_bits(const walk *w, pnanovdb_leaf_handle_t leaf, unsigned char *stage) {
  enum { MASK_BYTES = 64 };
  bool active = w->grid->kind == PNANOVDB_GRID_TYPE_MASK;
  pnanovdb_address_t bits = pnanovdb_address_offset(
      leaf.address, active ? PNANOVDB_LEAF_OFF_VALUE_MASK : PNANOVDB_LEAF_OFF_VALUE_MASK + MASK_BYTES);
  for (uint32_t n = 0; n < LEAF_VOXELS; n++)
    stage[n] = pnanovdb_read_uint32(w->memory, pnanovdb_address_offset(bits, 4 * (n >> 5))) >> (n & 31) & 1;
}

/* Stages the 512 values of a leaf, in the leaf's order. Returns false if a part of the leaf lies outside of
 * the grid's memory. */
static bool stage_leaf(const walk *w, pnanovdb_leaf_handle_t leaf, unsigned char *stage) {
  uint32_t kind = w->grid->kind;
  if (leaf.address.byte_offset > w->grid->size) return false;
  if (is_quantised(kind)) return stage_quantised(w, leaf, stage);
  if (kind == PNANOVDB_GRID_TYPE_BOOLEAN || kind == PNANOVDB_GRID_TYPE_MASK) {
    stage_bits(w, leaf, stage);
    return true;
  }
  size_t stride;
  const unsigned char *values = values_at(w, pnanovdb_leaf_get_table_address(kind, w->memory, leaf, 0),
                                          LEAF_VOXELS, &stride);
  for (size_t n = 0; values != NULL && n < LEAF_VOXELS; n++)
    take_value(w, values + n * stride, stage + n * w->bytes);
  return values != NULL;
}

/* Stages the value that all voxels of a tile have. state: whether the tile is active, which is the value in a
 * mask. */
static bool tile_value(const walk *w, pnanovdb_address_t address, bool state, unsigned char value[8]) {
  size_t stride;
  memset(value, 0, 8);
  if (w->grid->kind == PNANOVDB_GRID_TYPE_MASK) value[0] = state;
  else {
    const unsigned char *from = values_at(w, address, 1, &stride);
    if (from == NULL) return false;
    take_value(w, from, value);
    if (w->grid->kind == PNANOVDB_GRID_TYPE_BOOLEAN) value[0] &= 1;
  }
  return true;
}

/* ---- boxes of voxels ---- */

/* Finds the part of a cube that lies in the volume's box. The cube begins at `begin`, and has edges of `side`
 * voxels. from, to: set to the part's indices in the volume; `to` is one past the end. Returns false if the
 * part is empty. */
static bool clip(const walk *w, const int64_t begin[3], int64_t side, int64_t from[3], int64_t to[3]) {
  bool any = true;
  for (int a = 0; a < 3; a++) {
    int64_t first = begin[a] - w->low[a];
    from[a] = first > 0 ? first : 0;
    to[a] = first + side < w->size[a] ? first + side : w->size[a];
    any = any && from[a] < to[a];
  }
  return any;
}

static unsigned char *voxel_at(const walk *w, int64_t i, int64_t j, int64_t k) {
  return w->voxels + (size_t)((k * w->size[1] + j) * w->size[0] + i) * w->stored_bytes;
}

/* The number of voxel (i, j, k) in the order of the volume's voxels. */
static size_t number_of(const walk *w, int64_t i, int64_t j, int64_t k) {
  return (size_t)((k * w->size[1] + j) * w->size[0] + i);
}

static void fill_box(const walk *w, const int64_t begin[3], int64_t side, const unsigned char value[8]) {
  int64_t from[3], to[3];
  unsigned char stored[4];
  if (!clip(w, begin, side, from, to)) return;
  hl_voxels_store(w->type, false, value, 1, stored);
  for (int64_t k = from[2]; k < to[2]; k++)
    for (int64_t j = from[1]; j < to[1]; j++) {
      unsigned char *row = voxel_at(w, from[0], j, k);
      for (int64_t n = 0; n < to[0] - from[0]; n++, row += w->stored_bytes) {
        memcpy(row, stored, w->stored_bytes);
        hl_exact_note(w->exact, false, value, number_of(w, from[0] + n, j, k), 1);
      }
    }
}

static bool put_leaf(const walk *w, pnanovdb_leaf_handle_t leaf, const int64_t begin[3]) {
  unsigned char stage[LEAF_VOXELS * 8], stored[LEAF_VOXELS * 4];
  int64_t from[3], to[3];
  if (!clip(w, begin, LEAF, from, to)) return true;
  if (!stage_leaf(w, leaf, stage)) return false;
  hl_voxels_store(w->type, false, stage, LEAF_VOXELS, stored);
  for (int64_t k = from[2]; k < to[2]; k++)
    for (int64_t j = from[1]; j < to[1]; j++) {
      unsigned char *row = voxel_at(w, from[0], j, k);
      int64_t n = ((from[0] + w->low[0]) & 7) << 6 | ((j + w->low[1]) & 7) << 3 | ((k + w->low[2]) & 7);
      for (int64_t i = from[0]; i < to[0]; i++, row += w->stored_bytes, n += LEAF * LEAF) {
        memcpy(row, stored + (size_t)n * w->stored_bytes, w->stored_bytes);
        hl_exact_note(w->exact, false, stage + (size_t)n * w->bytes, number_of(w, i, j, k), 1);
      }
    }
  return true;
}

/* ---- nodes ---- */

static bool put_lower(const walk *w, pnanovdb_lower_handle_t lower, const int64_t begin[3]) {
  uint32_t kind = w->grid->kind;
  bool sound = lower.address.byte_offset <= w->grid->size;
  for (uint32_t n = 0; n < PNANOVDB_LOWER_TABLE_COUNT && sound; n++) {
    const int64_t at[3] = {begin[0] + LEAF * (n >> 8), begin[1] + LEAF * (n >> 4 & 15),
                           begin[2] + LEAF * (n & 15)};
    int64_t from[3], to[3];
    unsigned char value[8];
    if (!clip(w, at, LEAF, from, to)) continue;
    if (pnanovdb_lower_get_child_mask(w->memory, lower, n)) {
      sound = put_leaf(w, pnanovdb_lower_get_child(kind, w->memory, lower, n), at);
      continue;
    }
    bool state = pnanovdb_lower_get_value_mask(w->memory, lower, n);
    sound = tile_value(w, pnanovdb_lower_get_table_address(kind, w->memory, lower, n), state, value);
    if (sound) fill_box(w, at, LEAF, value);
  }
  return sound;
}

/* Stores the 128^3 voxels from `begin` on. All voxels of a region of 128^3 voxels lie in the same tile of the
 * root, or in no tile. */
static bool put_region(const walk *w, const int64_t begin[3]) {
  uint32_t kind = w->grid->kind;
  const pnanovdb_coord_t place = {(int32_t)begin[0], (int32_t)begin[1], (int32_t)begin[2]};
  pnanovdb_root_tile_handle_t tile = pnanovdb_root_find_tile(kind, w->memory, w->root, &place);
  pnanovdb_address_t value = pnanovdb_address_offset(w->root.address,
                                                     pnanovdb_grid_type_constants[kind].root_off_background);
  bool state = false;
  if (!pnanovdb_address_is_null(tile.address) &&
      !pnanovdb_int64_is_zero(pnanovdb_root_tile_get_child(w->memory, tile))) {
    pnanovdb_upper_handle_t upper = pnanovdb_root_get_child(kind, w->memory, w->root, tile);
    uint32_t n = pnanovdb_upper_coord_to_offset(&place);
    if (upper.address.byte_offset > w->grid->size) return false;
    if (pnanovdb_upper_get_child_mask(w->memory, upper, n))
      return put_lower(w, pnanovdb_upper_get_child(kind, w->memory, upper, n), begin);
    value = pnanovdb_upper_get_table_address(kind, w->memory, upper, n);
    state = pnanovdb_upper_get_value_mask(w->memory, upper, n);
  } else if (!pnanovdb_address_is_null(tile.address)) {
    value = pnanovdb_root_tile_get_value_address(kind, w->memory, tile);
    state = pnanovdb_root_tile_get_state(w->memory, tile) != 0;
  }
  unsigned char number[8];
  if (!tile_value(w, value, state, number)) return false;
  fill_box(w, begin, LOWER, number);
  return true;
}

static hl_status read_part(void *data, size_t number, int worker, hl_error *error) {
  const walk *w = data;
  int64_t begin[3];
  (void)worker;
  for (int a = 0; a < 3; a++) {
    begin[a] = LOWER * (w->first[a] + (int64_t)(number % w->count[a]));
    number /= w->count[a];
  }
  return put_region(w, begin) ? HL_OK : fail_damaged(w->grid, "a node lies outside of it", error);
}

hl_status nanovdb_grid_read(const nanovdb_grid *grid, const hl_volume_description *description, void *voxels,
                            hl_exact *exact, hl_error *error) {
  walk w;
  hl_pool *pool = NULL;
  begin(grid, &w);
  take_box(&w);
  w.type = description->type;
  w.bytes = hl_voxel_type_bytes(w.type);
  w.stored_bytes = hl_storage_bytes(hl_voxel_type_storage(w.type));
  w.voxels = voxels;
  w.exact = exact;
  size_t parts = w.count[0] * w.count[1] * w.count[2];
  bool parallel = w.size[0] * w.size[1] * w.size[2] >= PARALLEL_VOXELS;
  hl_status status = hl_pool_create(grid->context, parallel ? 0 : 1, &pool, error);
  if (status == HL_OK)
    status = hl_parallel_read(grid->context, pool, grid->path, parts, read_part, &w, error);
  hl_pool_destroy(pool);
  return status;
}

hl_status nanovdb_grid_read_box(const nanovdb_grid *grid, const size_t first[3], const size_t size[3],
                                float *voxels, hl_error *error) {
  walk w;
  hl_status status = HL_OK;
  begin(grid, &w);
  take_box(&w);
  for (int a = 0; a < 3; a++) {
    w.low[a] += (int64_t)first[a];
    w.size[a] = (int64_t)size[a];
  }
  find_lower_nodes(&w);
  w.type = HL_VOXEL_F32;
  w.bytes = w.stored_bytes = sizeof *voxels;
  w.voxels = (unsigned char *)voxels;
  for (size_t part = 0; part < w.count[0] * w.count[1] * w.count[2] && status == HL_OK; part++)
    status = read_part(&w, part, 0, error);
  return status;
}
