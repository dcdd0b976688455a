/* gpu/kernels/sublights.h - attenuates the buffers of sub-lights by the slabs of a run (shadow_sublights).
 * The functions compute for one pixel the same numbers as shadow_sublights/sublight_lanes.h for sixteen
 * pixels.
 *
 * run_light() makes, in the buffer of the light's centre, the transmittance of each slab of the run for
 * itself. Four kinds of passes follow. The first pass makes the slabs' copies that are shifted by half a
 * pixel. The second pass multiplies the sub-lights' pixels by all slabs of the run, and stores the pixels at
 * each sheet. At the end of a run of the processors (LIT_SLABS), the third pass finds the sub-lights' blocks
 * without light, and the fourth pass finds the blocks of the next slabs that some sub-light reaches. */
#ifndef HL_GPU_SUBLIGHTS_H
#define HL_GPU_SUBLIGHTS_H

#include "core/sheet_constants.h"
#include "gpu/kernels/pass_place.h"

#if SUBLIGHTS

#define MOVED_COPIES    3 /* the copies of a slab besides the slab itself */
#define EVERY_BLOCK     0xffff
#define BLOCKS_OF_TILE  4 /* along an axis */
#define MOST_ROW_BLOCKS 60

/* The marks of a light with sub-lights. */
typedef struct sublight_marks {
  GLOBAL int
      *touched; /* [ring][tiles]; the last slab that absorbed light in the tile of the centre's buffer */
  GLOBAL int *present; /* [ring][tiles]; the last slab whose copies may have pixels below 1 in the tile */
  GLOBAL int *lit;     /* [tiles]; the tile's blocks that light of some sub-light reaches, one bit each */
  GLOBAL int *dark;    /* [sublights][tiles of a sub-light]; the tile's blocks without light, one bit each */
  GLOBAL int *changed; /* [2][sublights][tiles of a sub-light]; the last slab that may have changed the tile;
                        * one copy for even runs, one for odd runs */
} sublight_marks;

DEVICE sublight_marks marks_of_light(GLOBAL const device_sweep *plan, GLOBAL const plan_light *light,
                                     GLOBAL int *marks) {
  const int tiles = light->sublight_tiles_x * light->sublight_tiles_y;
  sublight_marks of;
  of.touched = marks + light->sublight_marks;
  of.present = of.touched + plan->ring * light->tiles;
  of.lit = of.present + plan->ring * light->tiles;
  of.dark = of.lit + light->tiles;
  of.changed = of.dark + light->sublights * tiles;
  return of;
}

/* ---- the slab's copies ---- */

DEVICE float middle_of(float a, float b, float c, float d) {
  return limited(fused(b + c, 0.625f, (a + d) * -0.125f), 0.0f, 1.0f);
}
DEVICE float middle_of_pixels(GLOBAL const float *at, int step) {
  return middle_of(at[-step], at[0], at[step], at[2 * step]);
}

/* A pixel in a copy of a slab; copy 0 is the slab itself. plane: the plane's index among the planes of a
 * sheet. */
DEVICE GLOBAL float *pixel_of_copy(GLOBAL const device_sweep *plan, GLOBAL const plan_light *light,
                                   GLOBAL float *planes, GLOBAL float *halves, int sheet, int plane, int copy,
                                   int x, int y) {
  if (copy == 0) return pixel_in_plane(plan, light, planes, sheet, plane, x, y);
  return halves + (wide)light->halves * 16 +
         (((wide)(sheet % plan->ring) * PLANES_OF_SHEET + (wide)plane) * MOVED_COPIES + (wide)(copy - 1)) *
             (wide)light->plane +
         light->origin + (wide)y * (wide)light->stride + x;
}

/* Makes a pixel of the shifted copies of a run's slabs. */
DEVICE void make_halves(GLOBAL const device_sweep *plan, GLOBAL const plan_pass *pass, GLOBAL float *planes,
                        GLOBAL float *halves, GLOBAL int *marks, int number) {
  GLOBAL const plan_light *light = &plan->lights[pass->light];
  const sublight_marks of = marks_of_light(plan, light, marks);
  const int sheet = pass->first + number / (light->tiles * 256), tile = number / 256 % light->tiles,
            slot = sheet % plan->ring * light->tiles, tile_x = tile % light->tiles_x,
            tile_y = tile / light->tiles_x, x = tile_x * 16 + (number & 15),
            y = tile_y * 16 + (number >> 4 & 15);
  if (sheet > pass->sheet) return;
  int touched = 0;
  for (int down = 0; down < 2 && (tile_y + down) * light->tiles_x < light->tiles; down++)
    for (int across = 0; across < 2 && tile_x + across < light->tiles_x; across++)
      touched = touched || of.touched[slot + tile + down * light->tiles_x + across] == sheet;
  if (!touched) return;
  of.present[slot + tile] = sheet;
  for (int p = 0; p < PLANES_OF_SHEET; p++) {
    GLOBAL const float *from = pixel_in_plane(plan, light, planes, sheet, p, x, y);
    float across[4];
    for (int i = 0; i < 4; i++) across[i] = middle_of_pixels(from + (i - 1) * light->stride, 1);
    *pixel_of_copy(plan, light, planes, halves, sheet, p, 1, x, y) = across[1];
    *pixel_of_copy(plan, light, planes, halves, sheet, p, 2, x, y) = middle_of_pixels(from, light->stride);
    *pixel_of_copy(plan, light, planes, halves, sheet, p, 3, x, y) = middle_of(across[0], across[1],
                                                                               across[2], across[3]);
  }
}

/* ---- which pixel of a slab a sub-light's pixel reads ---- */

/* A tile of a sub-light, and a slab in the sub-light's view. */
typedef struct sublight_tile {
  GLOBAL const device_sweep *plan;
  GLOBAL const plan_light *light;
  GLOBAL const plan_sublight_place *place;
  GLOBAL float *planes, *halves;
  sublight_marks marks;
  int sublight, sheet;
  int x, y; /* of the tile */
} sublight_tile;

DEVICE int is_present(const sublight_tile *tile, int x, int y) {
  GLOBAL const plan_light *light = tile->light;
  if (x < 0 || y < 0 || x >= light->tiles_x || y * light->tiles_x >= light->tiles) return 0;
  return tile->marks.present[tile->sheet % tile->plan->ring * light->tiles + y * light->tiles_x + x] ==
         tile->sheet;
}

/* Returns whether a tile of the sub-light, in the row of the own tile, has light. */
DEVICE int is_tile_lit(const sublight_tile *tile, int x) {
  GLOBAL const plan_light *light = tile->light;
  if (x < 0 || x >= light->sublight_tiles_x) return 0;
  const int row = tile->sublight * light->sublight_tiles_y + tile->y;
  return tile->marks.dark[row * light->sublight_tiles_x + x] != EVERY_BLOCK;
}

/* A distance of pixels, rounded down to whole tiles. */
DEVICE int whole_tiles(float pixels) { return whole_below(limited(pixels * 0.0625f, -2.0f, 65536.0f)); }

/* Returns whether the slab may change a pixel of the tile. */
DEVICE int may_change(const sublight_tile *tile) {
  GLOBAL const plan_sublight_place *place = tile->place;
  int low[2], high[2];
  if (!place->reaches) return 0;
  if (!(is_tile_lit(tile, tile->x) ||
        (place->shifted && (is_tile_lit(tile, tile->x - 1) || is_tile_lit(tile, tile->x + 1)))))
    return 0;
  for (int axis = 0; axis < 2; axis++) {
    const float from = (float)((axis == 0 ? tile->x : tile->y) * 16);
    low[axis] = whole_tiles(place->scale[axis] * from + place->shift[axis] - 2.0f);
    high[axis] = whole_tiles(place->scale[axis] * (from + 16.0f) + place->shift[axis] + 2.0f);
  }
  if (low[0] < 0) low[0] = 0;
  if (low[1] < 0) low[1] = 0;
  if (high[0] >= tile->light->tiles_x) high[0] = tile->light->tiles_x - 1;
  if (high[1] >= tile->light->tiles / tile->light->tiles_x)
    high[1] = tile->light->tiles / tile->light->tiles_x - 1;
  for (int y = low[1]; y <= high[1]; y++)
    for (int x = low[0]; x <= high[0]; x++)
      if (is_present(tile, x, y)) return 1;
  return 0;
}

/* The pixel of a slab that a pixel of a sub-light reads. */
typedef struct slab_pixel {
  int x, y, copy;
  int reads; /* whether the sub-light's pixel is multiplied by the slab's pixel */
} slab_pixel;

/* As sublight_row(): a tile of the slab darkens sixteen pixels of a row if one of the two tiles of the
 * sub-light under them has light. x, y: the pixel. */
DEVICE slab_pixel pixel_of_shifted(const sublight_tile *tile, int x, int y) {
  GLOBAL const plan_sublight_place *place = tile->place;
  const int across = place->halves[0] >> 1;
  slab_pixel found;
  found.x = x + across;
  found.y = y + (place->halves[1] >> 1);
  found.copy = (place->halves[0] & 1) + 2 * (place->halves[1] & 1);
  const int column = (found.x >> 4) * 16 - across;
  found.reads = is_present(tile, found.x >> 4, found.y >> 4) &&
                (is_tile_lit(tile, column >> 4) || is_tile_lit(tile, (column + 15) >> 4));
  return found;
}

/* nearest_halves() for one pixel */
DEVICE int nearest_half(float scale, float start, float size, int i) {
  return whole_below(limited((float)i * scale + start, -2.0f, size + 1.0f) * 2.0f + 0.5f);
}

/* The half pixel that is read, less two half pixels for each pixel i of the row, as in taps_of_row(). */
DEVICE int half_apart(float scale, float start, int i) {
  return whole_below(((float)i * (scale - 1.0f) + start) * 2.0f + 0.5f);
}

/* Returns whether a row of the slab's pixels, in tiles `first` to `last`, is below 1 somewhere in the copies
 * that are shifted along v (between = 1), or in the other two. */
DEVICE int row_is_present(const sublight_tile *tile, int first, int last, int line, int between) {
  for (int x = first * 16; x < (last + 1) * 16; x++) {
    if (!is_present(tile, x >> 4, line >> 4)) continue;
    for (int p = 0; p < 2 * PLANES_OF_SHEET; p++)
      if (*pixel_of_copy(tile->plan, tile->light, tile->planes, tile->halves, tile->sheet, p / 2,
                         2 * between + p % 2, x, line) < 1.0f)
        return 1;
  }
  return 0;
}

/* As sublight_tile() of the processors. column, row: the pixel in its tile. */
DEVICE slab_pixel pixel_of_scaled(const sublight_tile *tile, int column, int row) {
  GLOBAL const plan_light *light = tile->light;
  GLOBAL const plan_sublight_place *place = tile->place;
  const int tiles_y = light->tiles / light->tiles_x;
  const float width = (float)(light->tiles_x * 16), height = (float)(tiles_y * 16);
  const float start_x = place->scale[0] * ((float)(tile->x * 16) + 0.5f) + place->shift[0] - 0.5f,
              start_y = place->scale[1] * ((float)(tile->y * 16) + 0.5f) + place->shift[1] - 0.5f;
  const int begin = half_apart(place->scale[0], start_x, 0), end = half_apart(place->scale[0], start_x, 15),
            least = begin < end ? begin : end, taps = (begin < end ? end : begin) - least + 1;
  const int weighs = taps <= SUBLIGHT_TAPS && least >= -56 && (float)least <= 2.0f * width + 16.0f;
  const int half_x = weighs ? 2 * column + half_apart(place->scale[0], start_x, column)
                            : nearest_half(place->scale[0], start_x, width, column),
            half_y = nearest_half(place->scale[1], start_y, height, row);
  slab_pixel found;
  found.x = half_x >> 1;
  found.y = half_y >> 1;
  found.copy = (half_x & 1) + 2 * (half_y & 1);
  found.reads = is_tile_lit(tile, tile->x) && is_present(tile, found.x >> 4, found.y >> 4);
  if (!found.reads) return found;
  int first = nearest_half(place->scale[0], start_x, width, 0) >> 5,
      last = nearest_half(place->scale[0], start_x, width, 15) >> 5;
  if (first < 0) first = 0;
  if (last >= light->tiles_x) last = light->tiles_x - 1;
  if (found.x >> 4 >= first && found.x >> 4 <= last) return found;
  const int top = nearest_half(place->scale[1], start_y, height, 0),
            bottom = nearest_half(place->scale[1], start_y, height, 15);
  const int y0 = top < 0 ? 0 : top / 32, y1 = bottom < 0 ? -1 : bottom / 32;
  found.reads = (y1 >= tiles_y ? tiles_y - 1 : y1) > y0 + 3 ||
                row_is_present(tile, first, last, found.y, half_y & 1);
  return found;
}

/* ---- compositing ---- */

/* Multiplies a sub-light's pixel by a pixel of a slab, as composite_sublight() and composite_outside(). */
DEVICE void composite_slab_pixel(const sublight_tile *tile, slab_pixel from, int values[PLANES_OF_SHEET]) {
  const float carry = tile->place->carry;
  for (int c = 0; c < CHANNELS; c++) {
    const float passing = *pixel_of_copy(tile->plan, tile->light, tile->planes, tile->halves, tile->sheet, c,
                                         from.copy, from.x, from.y);
    if (!(passing < 1.0f)) continue;
    const float light = (float)values[c], left = light * passing;
    values[c] = (int)(left + carry);
#if OUTSIDE
    const float of_slab = *pixel_of_copy(tile->plan, tile->light, tile->planes, tile->halves, tile->sheet,
                                         CHANNELS + c, from.copy, from.x, from.y),
                taken = 1.0f - passing;
    float kept = limited(divided(of_slab - passing, greater(taken, LEAST_ABSORBED)), 0.0f, 1.0f);
    if (!(taken > LEAST_ABSORBED)) kept = 1.0f;
    values[CHANNELS + c] = (int)(fused(greater((float)values[CHANNELS + c] - left, 0.0f), kept, left) +
                                 carry);
#endif
  }
}

/* A pixel in the first of the planes of a sub-light, at a sheet. */
DEVICE GLOBAL word16 *pixel_of_sublight(GLOBAL const plan_light *light, GLOBAL word16 *of_sublights,
                                        int sublight, int slot, int x, int y) {
  return of_sublights + (wide)light->sublight_planes * 16 +
         ((wide)slot * (wide)light->sublights + (wide)sublight) *
             (PLANES_OF_SHEET * (wide)light->sublight_plane) +
         (wide)y * (wide)light->sublight_stride + x;
}

/* Multiplies a pixel of a sub-light by the slabs of a run. */
DEVICE void composite_sublights(GLOBAL const device_sweep *plan, GLOBAL const plan_pass *pass,
                                GLOBAL const plan_sublight_place *places, GLOBAL float *planes,
                                GLOBAL float *halves, GLOBAL word16 *of_sublights, GLOBAL int *marks,
                                int number) {
  GLOBAL const plan_light *light = &plan->lights[pass->light];
  const int tiles = light->sublight_tiles_x * light->sublight_tiles_y, own = number / 256 % tiles,
            column = number & 15, row = number >> 4 & 15, copy = light->sublights * tiles;
  sublight_tile tile;
  tile.plan = plan;
  tile.light = light;
  tile.planes = planes;
  tile.halves = halves;
  tile.marks = marks_of_light(plan, light, marks);
  tile.sublight = number / (tiles * 256);
  if (tile.sublight >= light->sublights) return;
  tile.x = own % light->sublight_tiles_x;
  tile.y = own / light->sublight_tiles_x;
  const int x = tile.x * 16 + column, y = tile.y * 16 + row;
  GLOBAL int *changed = tile.marks.changed + tile.sublight * tiles + own;
  int changed_at = changed[(pass->run & 1) * copy], values[PLANES_OF_SHEET];
  GLOBAL const word16 *before = pixel_of_sublight(light, of_sublights, tile.sublight,
                                                  (pass->first - 1) % plan->ring, x, y);
  for (int p = 0; p < PLANES_OF_SHEET; p++) values[p] = before[p * (wide)light->sublight_plane];
  for (tile.sheet = pass->first; tile.sheet <= pass->sheet; tile.sheet++) {
    tile.place = places + (wide)tile.sheet * (wide)plan->sublight_count + light->first_sublight +
                 tile.sublight;
    if (may_change(&tile)) {
      const slab_pixel from = tile.place->shifted ? pixel_of_shifted(&tile, x, y)
                                                  : pixel_of_scaled(&tile, column, row);
      if (from.reads) composite_slab_pixel(&tile, from, values);
      changed_at = tile.sheet;
    }
    if (!(changed_at > 0 && changed_at > tile.sheet - plan->ring)) continue;
    GLOBAL word16 *to = pixel_of_sublight(light, of_sublights, tile.sublight, tile.sheet % plan->ring, x, y);
    for (int p = 0; p < PLANES_OF_SHEET; p++) to[p * (wide)light->sublight_plane] = (word16)values[p];
  }
  changed[(1 - (pass->run & 1)) * copy] = changed_at;
}

/* ---- the blocks with light ---- */

/* Takes the rest of the light from a block, as darken_block(). first: the block's first pixel. */
DEVICE void darken_block_of(GLOBAL const plan_light *light, GLOBAL word16 *first) {
  for (int p = 0; p < PLANES_OF_SHEET; p++)
    for (int i = 0; i < 16; i++)
      first[p * (wide)light->sublight_plane + i / 4 * light->sublight_stride + i % 4] = 0;
}

/* Finds the blocks without light in a tile of a sub-light, and darkens them. Clears the lit blocks of a tile
 * of the centre's buffer, which the next pass finds. */
DEVICE void find_dark(GLOBAL const device_sweep *plan, GLOBAL const plan_pass *pass,
                      GLOBAL const plan_sublight_place *places, GLOBAL word16 *of_sublights,
                      GLOBAL int *marks, int number) {
  GLOBAL const plan_light *light = &plan->lights[pass->light];
  const sublight_marks of = marks_of_light(plan, light, marks);
  const int tiles = light->sublight_tiles_x * light->sublight_tiles_y, sublight = number / tiles,
            tile = number % tiles;
  if (number < light->tiles) of.lit[number] = 0;
  if (sublight >= light->sublights) return;
  if (!places[(wide)pass->sheet * (wide)plan->sublight_count + light->first_sublight + sublight].reaches)
    return;
  int dark = of.dark[number];
  for (int block = 0; block < 16; block++) {
    if (dark >> block & 1) continue;
    GLOBAL word16 *first = pixel_of_sublight(light, of_sublights, sublight, pass->sheet % plan->ring,
                                             tile % light->sublight_tiles_x * 16 + block % 4 * 4,
                                             tile / light->sublight_tiles_x * 16 + block / 4 * 4);
    GLOBAL const word16 *at = first + OUTSIDE * CHANNELS * (wide)light->sublight_plane;
    int lit = 0;
    for (int i = 0; i < 16 * CHANNELS && !lit; i++)
      lit = (float)at[i / 16 * (wide)light->sublight_plane + i % 16 / 4 * light->sublight_stride + i % 4] >=
            DARK * (float)SUBLIGHT_ONE;
    if (lit) continue;
    dark |= 1 << block;
    darken_block_of(light, first);
  }
  if (dark != of.dark[number])
    of.changed[number + (1 - (pass->run & 1)) * light->sublights * tiles] = pass->sheet;
  of.dark[number] = dark;
}

/* The blocks of a sub-light that lie under the four columns, or rows, of a tile's blocks. */
typedef struct blocks_below {
  int first[BLOCKS_OF_TILE], last[BLOCKS_OF_TILE];
} blocks_below;

DEVICE int segment_at(float position, int count) {
  return position < 0.0f ? -1 : position >= (float)(4 * count) ? count : (int)position / 4;
}

/* hl_sublight_blocks() */
DEVICE blocks_below blocks_of_tile(GLOBAL const plan_sublight_maps *maps, int axis, int tile, int tiles) {
  const int end = tiles * BLOCKS_OF_TILE;
  blocks_below under;
  for (int i = 0; i < BLOCKS_OF_TILE; i++) {
    const float from = (float)(tile * 16 + i * 4 - BLOCK_SPARE), to = from + (4 + 2 * BLOCK_SPARE);
    const int first = segment_at(lesser(maps->near_scale[axis] * (from - maps->near_shift[axis]),
                                        maps->far_scale[axis] * (from - maps->far_shift[axis])),
                                 end),
              last = segment_at(greater(maps->near_scale[axis] * (to - maps->near_shift[axis]),
                                        maps->far_scale[axis] * (to - maps->far_shift[axis])),
                                end);
    under.first[i] = first < 0 ? 0 : first;
    under.last[i] = last < end ? last : end - 1;
  }
  return under;
}

/* lit_by_blocks() */
DEVICE int lit_by_blocks_of(GLOBAL const int *dark, int tiles_x, const blocks_below *columns,
                            const blocks_below *rows) {
  int lit = 0;
  if (columns->last[BLOCKS_OF_TILE - 1] - columns->first[0] >= MOST_ROW_BLOCKS) return EVERY_BLOCK;
  for (int block = 0; block < 16; block++) {
    const int across = block % 4, down = block / 4;
    for (int y = rows->first[down]; y <= rows->last[down]; y++)
      for (int x = columns->first[across]; x <= columns->last[across]; x++)
        if ((dark[y / 4 * tiles_x + x / 4] >> (y % 4 * 4 + x % 4) & 1) == 0) lit |= 1 << block;
  }
  return lit;
}

/* The blocks of a tile of the centre's buffer that the light of one sub-light reaches in the next slabs.
 * number: of the sub-light and the tile; *tile: receives the tile. */
DEVICE int blocks_reached(GLOBAL const device_sweep *plan, GLOBAL const plan_pass *pass,
                          GLOBAL const plan_sublight_maps *all_maps, GLOBAL int *marks, int number,
                          int *tile) {
  GLOBAL const plan_light *light = &plan->lights[pass->light];
  const sublight_marks of = marks_of_light(plan, light, marks);
  const int sublight = number % light->sublights, tiles_x = light->sublight_tiles_x;
  *tile = number / light->sublights;
  if (*tile >= light->tiles) return 0;
  GLOBAL const plan_sublight_maps *maps = all_maps + (wide)pass->chunk * (wide)plan->sublight_count +
                                          light->first_sublight + sublight;
  if (!maps->reaches) return maps->comes ? EVERY_BLOCK : 0;
  GLOBAL const int *dark = of.dark + sublight * tiles_x * light->sublight_tiles_y;
  const blocks_below columns = blocks_of_tile(maps, 0, *tile % light->tiles_x, tiles_x),
                     rows = blocks_of_tile(maps, 1, *tile / light->tiles_x, light->sublight_tiles_y);
  int any = 0, every = EVERY_BLOCK;
  for (int y = rows.first[0] / 4; 4 * y <= rows.last[BLOCKS_OF_TILE - 1]; y++)
    for (int x = columns.first[0] / 4; 4 * x <= columns.last[BLOCKS_OF_TILE - 1]; x++) {
      const int lit = ~dark[y * tiles_x + x] & EVERY_BLOCK;
      any |= lit;
      every &= lit;
    }
  return any == 0 || every == EVERY_BLOCK ? any : lit_by_blocks_of(dark, tiles_x, &columns, &rows);
}

#endif

#endif
