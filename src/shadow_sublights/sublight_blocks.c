/* shadow_sublights/sublight_blocks.c - finds the blocks of a slab that the light of some sub-light still
 * reaches. In: the sub-lights' maps for a run of slabs, and the blocks of their buffers that have light. Out:
 * the lit blocks of the slab's tiles. */
#include "core/sheet_constants.h"
#include "shadow_sublights/sublights.h"

/* Divides a line of pixels into `count` segments of `length` pixels. Returns the number of the segment that
 * holds a position; -1 for a position before the first segment, `count` for a position after the last
 * segment. */
static int segment_of(float position, int length, int count) {
  return position < 0 ? -1 : position >= (float)(length * count) ? count : (int)position / length;
}

blocks_under hl_sublight_blocks(const sublight_maps *maps, int axis, int tile, int tiles) {
  const sublight_map *near = &maps->near, *far = &maps->far;
  int end = tiles * (TILE / BLOCK);
  blocks_under under;
  for (int i = 0; i < TILE / BLOCK; i++) {
    float from = (float)(tile * TILE + i * BLOCK - BLOCK_SPARE), to = from + BLOCK + 2 * BLOCK_SPARE;
    int first = segment_of(
        fminf(near->scale[axis] * (from - near->shift[axis]), far->scale[axis] * (from - far->shift[axis])),
        BLOCK, end);
    int last = segment_of(
        fmaxf(near->scale[axis] * (to - near->shift[axis]), far->scale[axis] * (to - far->shift[axis])),
        BLOCK, end);
    under.first[i] = first < 0 ? 0 : first;
    under.last[i] = last < end ? last : end - 1;
  }
  return under;
}

/* The lit blocks of a sub-light in a row of blocks, from block `first` to block `last`: one bit for each
 * block, with block `first` in bit 0. The row must have at most 64 blocks. */
static uint64_t lit_in_row(const sublights *all, const sublight *sublight, int row, int first, int last) {
  const uint16_t *tiles = sublight->lit + (size_t)(row / 4) * (size_t)all->tiles_x;
  uint64_t bits = 0;
  for (int x = first / 4; x <= last / 4; x++) {
    uint64_t four = tiles[x] >> 4 * (row % 4) & 15;
    bits |= 4 * x < first ? four >> (first - 4 * x) : four << (4 * x - first);
  }
  return bits;
}

static uint32_t lit_by_blocks(const sublights *all, const sublight *sublight, const blocks_under *columns,
                              const blocks_under *rows) {
  int first = columns->first[0], last = columns->last[TILE / BLOCK - 1];
  uint32_t lit = 0;
  if (last - first >= 60) return ALL_BLOCKS;
  for (int y = 0; y < TILE / BLOCK; y++) {
    uint64_t bits = 0;
    for (int row = rows->first[y]; row <= rows->last[y]; row++)
      bits |= lit_in_row(all, sublight, row, first, last);
    for (int x = 0; x < TILE / BLOCK && bits != 0; x++) {
      int count = columns->last[x] - columns->first[x] + 1;
      if (count > 0 && (bits >> (columns->first[x] - first) & (((uint64_t)1 << count) - 1)) != 0)
        lit |= 1u << (4 * y + x);
    }
  }
  return lit;
}

/* Finds the blocks of a slab's tile that the light of one sub-light reaches. Most tiles are lit everywhere or
 * nowhere, so these two cases are tested first. */
static uint32_t lit_by_sublight(const sublights *all, const sublight *sublight, int tile_x, int tile_y) {
  blocks_under columns = hl_sublight_blocks(&sublight->maps, 0, tile_x, all->tiles_x),
               rows = hl_sublight_blocks(&sublight->maps, 1, tile_y, all->tiles_y);
  int x0 = columns.first[0] / 4, x1 = columns.last[TILE / BLOCK - 1], y0 = rows.first[0] / 4,
      y1 = rows.last[TILE / BLOCK - 1];
  uint32_t any = 0, every = ALL_BLOCKS;
  for (int y = y0; 4 * y <= y1; y++)
    for (int x = x0; 4 * x <= x1; x++) {
      uint32_t lit = sublight->lit[(size_t)y * (size_t)all->tiles_x + (size_t)x];
      any |= lit;
      every &= lit;
    }
  return any == 0 || every == ALL_BLOCKS ? any : lit_by_blocks(all, sublight, &columns, &rows);
}

void hl_sublights_find_lit(const sublights *sublights, shadow_buffer *slab, size_t tile) {
  int x = (int)(tile % (size_t)slab->tiles_x), y = (int)(tile / (size_t)slab->tiles_x);
  uint32_t run = (uint32_t)hl_sublight_run(sublights->slabs);
  if (sublights->found[tile] == run) return;
  uint32_t lit = sublights->slabs == 0 ? ALL_BLOCKS : 0;
  for (int i = 0; i < sublights->count && lit != ALL_BLOCKS; i++) {
    const sublight *sublight = &sublights->sublight[i];
    if (sublight->maps.reaches) lit |= lit_by_sublight(sublights, sublight, x, y);
    else if (sublight->maps.comes) lit = ALL_BLOCKS;
  }
  slab->tile_lit[tile] = (uint16_t)lit;
  sublights->found[tile] = run;
}
