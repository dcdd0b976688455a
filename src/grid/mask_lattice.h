/* grid/mask_lattice.h - describes a volume's mask, prepared for frames: factors of extinction, and colours,
 * at the points of a lattice. Between the points, factors and colours are interpolated linearly. */
#ifndef HL_GRID_MASK_LATTICE_H
#define HL_GRID_MASK_LATTICE_H

#include "label/mask.h"
#include "scene/scene.h"

typedef struct mask_lattice {
  /* [k][j][i]; numbers that stand for the factor of extinction at each point (`scale`); borrowed from the
   * scene; null if the volume has no mask. Code may read one element beyond the end */
  const uint16_t *factors;
  const unsigned char *colors; /* [k][j][i][4]; the colour at each point, as in label/mask.h; null if the
                                * mask has no colours */
  const signed char *slopes;   /* [k][j][i][4]; the slope of the factor at each point, as in label/mask.h */
  float slope_scale;           /* the slope for which a stored slope of 1 stands, per step of the lattice */
  const uint32_t (*bricks)[2]; /* the bricks of the lattice, as in label/mask.h */
  int32_t brick_step[3];       /* distance in `bricks` from a brick to the next one along i, j, k */
  int32_t last[3];             /* the greatest index along i, j, k */
  int32_t step[3];             /* distance in `factors` from a point to the next one along i, j, k */
  float to_index[3][4];        /* maps frame space to the lattice's index space */
  /* the factor at a place is the number interpolated linearly between the points, times `scale`, plus
   * `offset`, clamped to [0, 1]. For masks of labels, 65535 stands for 1 and 0 for 0, so that clamping
   * changes nothing */
  float scale, offset;
  float rest; /* the factor outside the lattice */
} mask_lattice;

/* Prepares the lattice of a volume's mask. volume: the volume in frame space. If the volume has no mask, the
 * lattice is empty. */
void hl_mask_lattice_set_up(mask_lattice *lattice, const hl_scene_volume *volume);

/* The points of the lattice around a position, and where the position lies between these points. */
typedef struct mask_cell {
  int32_t near[3], far[3]; /* for each axis, the offsets in `factors` of the points before and after the
                            * position */
  float part[3];
} mask_cell;

/* Finds the points of the lattice around a position of frame space. Returns false if the position lies
 * outside the lattice. */
static inline bool hl_mask_cell_at(const mask_lattice *lattice, const float point[3], mask_cell *cell) {
  for (int a = 0; a < 3; a++) {
    const float *row = lattice->to_index[a], last = (float)lattice->last[a];
    float at = row[0] * point[0] + row[1] * point[1] + row[2] * point[2] + row[3];
    if (!(at >= -0.5f && at <= last + 0.5f)) return false;
    at = at < 0 ? 0 : at > last ? last : at;
    int32_t first = (int32_t)at;
    cell->part[a] = at - (float)first;
    cell->near[a] = first * lattice->step[a];
    cell->far[a] = cell->near[a] + (first < lattice->last[a] ? lattice->step[a] : 0);
  }
  return true;
}

static inline size_t hl_mask_corner(const mask_cell *cell, int corner, float *share) {
  size_t at = 0;
  *share = 1;
  for (int a = 0; a < 3; a++) {
    bool far = (corner >> a & 1) != 0;
    at += (size_t)(far ? cell->far[a] : cell->near[a]);
    *share *= far ? cell->part[a] : 1 - cell->part[a];
  }
  return at;
}

/* Finds the factor of extinction at a position in frame space. */
static inline float hl_mask_factor(const mask_lattice *lattice, const float point[3]) {
  mask_cell cell;
  float sum = 0, share;
  if (!hl_mask_cell_at(lattice, point, &cell)) return lattice->rest;
  for (int corner = 0; corner < 8; corner++) {
    size_t at = hl_mask_corner(&cell, corner, &share);
    sum += share * (float)lattice->factors[at];
  }
  float factor = sum * lattice->scale + lattice->offset;
  return factor < 0 ? 0 : factor > 1 ? 1 : factor;
}

/* Returns whether the mask's factor is 0 everywhere in a box of frame space: middle + t0 half[0] + t1 half[1]
 * + t2 half[2], each t from -1 to 1. */
bool hl_mask_hides_box(const mask_lattice *lattice, vec3 middle, const vec3 half[3]);

/* Mixes a colour with the mask's colour at a position in frame space. */
void hl_mask_tint(const mask_lattice *lattice, const float point[3], float color[3]);

#endif
