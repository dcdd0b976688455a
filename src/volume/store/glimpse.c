/* volume/store/glimpse.c - see glimpse.h. */
#include "volume/store/glimpse.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"

size_t hl_lattice_step(const size_t dimension[3], double most) {
  double step = 1, places;
  do {
    places = 1;
    for (int a = 0; a < 3; a++) places *= ceil((double)dimension[a] / floor(step));
    if (places > most) step = fmax(step + 1, step * 1.1);
  } while (places > most);
  return (size_t)step;
}

size_t hl_border_step(const size_t dimension[3]) {
  size_t step = 1;
  for (int a = 0; a < 3; a++) {
    size_t face[3] = {dimension[0], dimension[1], dimension[2]};
    face[a] = 1;
    size_t enough = hl_lattice_step(face, HL_BORDER_PLACES);
    if (enough > step) step = enough;
  }
  return step;
}

size_t hl_row_step(const size_t dimension[3]) {
  double voxels = (double)dimension[0] * (double)dimension[1] * (double)dimension[2];
  return (size_t)fmin(ceil(sqrt(voxels / HL_ROW_VOXELS)), (double)hl_lattice_step(dimension, HL_CELL_PLACES));
}

/* ---- lattices: the voxels whose three indices are kept ---- */

enum { LATTICES = 6 };
#define NOT_KEPT UINT32_MAX

typedef struct lattice {
  size_t count[3];       /* number of indices kept along each axis */
  uint32_t *place[3];    /* [dimension]; for each index along the axis, the position of this index among the
                          * kept indices, or NOT_KEPT */
  unsigned char *voxels; /* [count[2]][count[1]][count[0]]; stored values of the kept voxels */
} lattice;

struct hl_glimpse {
  hl_context *context;
  size_t dimension[3], bytes; /* bytes: size of a stored value */
  lattice lattices[LATTICES];
};

/* The indices along an axis that a lattice keeps. */
typedef struct series {
  size_t first, step; /* the kept indices form runs of neighbours, which begin at the indices first, first +
                       * step, first + 2 step and so on */
  size_t run;         /* number of consecutive indices in each run */
  bool last;          /* whether the last index of the axis is kept, too */
} series;

static bool keeps(const series *s, size_t index, size_t dimension) {
  return (index >= s->first && (index - s->first) % s->step < s->run) || (s->last && index + 1 == dimension);
}

/* Lists the indices that each lattice of voxels keeps for the automatic choices of guess/. Lattice 0:
 * samples, of which the first lies half a step inside the grid, and the next neighbour of each sample along
 * each axis. Lattice 1: samples, of which the first is voxel 0, and the next two neighbours of each sample.
 * Lattice 2: whole rows along x. Lattices 3 to 5: samples on the three pairs of opposite faces. */
static void list_series(const size_t dimension[3], series all[LATTICES][3]) {
  size_t step = hl_lattice_step(dimension, HL_LATTICE_PLACES), border = hl_border_step(dimension),
         rows = hl_row_step(dimension);
  const series inside = {step / 2, step, 2, false}, row = {0, rows, 1, false}, whole = {0, 1, 1, false},
               corner = {0, step, 3, true}, ends = {0, SIZE_MAX, 1, true},
               face = {border / 2, border, 1, false};
  for (int a = 0; a < 3; a++) {
    all[0][a] = inside;
    all[1][a] = corner;
    all[2][a] = a == 0 ? whole : row;
    for (int pair = 0; pair < 3; pair++) all[3 + pair][a] = a == pair ? ends : face;
  }
}

static void lay_out(hl_glimpse *g, series all[LATTICES][3], hl_layout *layout) {
  for (int n = 0; n < LATTICES; n++) {
    lattice *l = &g->lattices[n];
    size_t voxels = 1;
    for (int a = 0; a < 3; a++) {
      l->count[a] = 0;
      l->place[a] = hl_layout_take(layout, g->dimension[a], sizeof *l->place[a]);
      for (size_t i = 0; i < g->dimension[a]; i++) {
        bool kept = keeps(&all[n][a], i, g->dimension[a]);
        if (l->place[a] != NULL) l->place[a][i] = kept ? (uint32_t)l->count[a] : NOT_KEPT;
        l->count[a] += kept;
      }
      voxels *= l->count[a]; /* the product cannot overflow, as it is not greater than the grid's number of
                              * voxels */
    }
    l->voxels = hl_layout_take(layout, voxels, g->bytes);
  }
}

bool hl_glimpse_create(hl_context *context, const size_t dimension[3], hl_storage storage, uint64_t most,
                       hl_glimpse **glimpse) {
  *glimpse = NULL;
  for (int a = 0; a < 3; a++)
    if (dimension[a] >= NOT_KEPT) return true;
  series all[LATTICES][3];
  hl_glimpse plan = {.context = context, .bytes = hl_storage_bytes(storage)};
  memcpy(plan.dimension, dimension, sizeof plan.dimension);
  list_series(dimension, all);
  hl_layout counted = {0}, handed = {0};
  hl_layout_take(&counted, 1, sizeof plan);
  lay_out(&plan, all, &counted);
  if (counted.bytes > most) return true;
  handed.base = hl_allocate(context, counted.bytes, 1);
  if (handed.base == NULL) return false;
  hl_glimpse *made = hl_layout_take(&handed, 1, sizeof *made);
  *made = plan;
  lay_out(made, all, &handed);
  *glimpse = made;
  return true;
}

void hl_glimpse_release(hl_glimpse *glimpse) {
  if (glimpse != NULL)
    hl_release(glimpse->context, glimpse); /* the arrays are parts of the glimpse's own
                                            * block */
}

/* Returns the memory in which a lattice keeps voxels of the row (j, k); null if the lattice keeps no voxels
 * of this row. */
static unsigned char *row_of(const hl_glimpse *g, const lattice *l, size_t j, size_t k) {
  uint32_t y = l->place[1][j], z = l->place[2][k];
  return y == NOT_KEPT || z == NOT_KEPT ? NULL : l->voxels + (z * l->count[1] + y) * l->count[0] * g->bytes;
}

/* Stores the voxels that the lattice keeps among the voxels i0 to i1 - 1 of a row. values: the stored values
 * of these voxels. */
static void store_row(const hl_glimpse *g, const lattice *l, size_t i0, size_t i1,
                      const unsigned char *values, unsigned char *row) {
  if (l->count[0] == g->dimension[0]) {
    memcpy(row + i0 * g->bytes, values, (i1 - i0) * g->bytes);
    return;
  }
  for (size_t i = i0; i < i1; i++)
    if (l->place[0][i] != NOT_KEPT)
      memcpy(row + l->place[0][i] * g->bytes, values + (i - i0) * g->bytes, g->bytes);
}

void hl_glimpse_store(hl_glimpse *glimpse, size_t first, size_t count, const void *values) {
  const size_t *n = glimpse->dimension;
  for (size_t done = 0, taken; done < count; done += taken) {
    size_t i = (first + done) % n[0], row = (first + done) / n[0];
    taken = n[0] - i < count - done ? n[0] - i : count - done;
    for (int l = 0; l < LATTICES; l++) {
      unsigned char *kept = row_of(glimpse, &glimpse->lattices[l], row % n[1], row / n[1]);
      if (kept != NULL)
        store_row(glimpse, &glimpse->lattices[l], i, i + taken,
                  (const unsigned char *)values + done * glimpse->bytes, kept);
    }
  }
}

const void *hl_glimpse_voxel(const hl_glimpse *glimpse, size_t i, size_t j, size_t k) {
  for (int l = 0; l < LATTICES; l++) {
    const lattice *from = &glimpse->lattices[l];
    const unsigned char *row = from->place[0][i] != NOT_KEPT ? row_of(glimpse, from, j, k) : NULL;
    if (row != NULL) return row + from->place[0][i] * glimpse->bytes;
  }
  return NULL;
}

const void *hl_glimpse_row(const hl_glimpse *glimpse, size_t j, size_t k) {
  for (int l = 0; l < LATTICES; l++) {
    const lattice *from = &glimpse->lattices[l];
    const unsigned char *row = from->count[0] == glimpse->dimension[0] ? row_of(glimpse, from, j, k) : NULL;
    if (row != NULL) return row;
  }
  return NULL;
}
