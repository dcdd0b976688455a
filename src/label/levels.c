/* label/levels.c - see levels.h. */
#include "label/levels.h"

#include <string.h>

enum { CELL = 2 }; /* length of a cell's edge in voxels */

enum { LEVEL_OF_FACES = HL_LEVEL_FALL + 1 }; /* the number of planes with sums over faces */

/* The filter [1 2 1] / 4 that blurs the sums of cells, so that the sums have no steps from cell to cell. */
static const label_filter BLUR = {2, {0.5f, 0.25f, 0}};

/* The weight of an imaginary face that is added, at every voxel, to the sums over the faces of the label's
 * border. On the imaginary face, the field has the values that it should have, so that the face asks for no
 * correction. The imaginary face decides the result for a voxel that lies far from any border. An imaginary
 * voxel of the same weight, which is not thin, is added to the sums over voxels. */
static const float FAINT = 1e-3f;

/* The least fall of the field across the border's faces. A smaller fall counts as the least fall, so that the
 * field is not made too steep. */
static const float LEAST_FALL = 0.04f;

/* Limits of a field's values, which must fit the bytes that store them (occupancy.c). */
static const float LEAST = -0.5f, GREATEST = 1.49f;

/* The distance by which the border of thin things is moved outwards, in voxels. */
static const float GROWTH = 0.25f;

typedef struct level_job {
  const unsigned char *inside;
  const label_field *field;
  const label_levels *levels;
} level_job;

void hl_label_levels_size(const size_t field[3], size_t size[3]) {
  for (int a = 0; a < 3; a++) size[a] = (field[a] + CELL - 1) / CELL;
}

static float *plane_of(const label_levels *levels, int plane) {
  return levels->values + (size_t)plane * levels->size[0] * levels->size[1] * levels->size[2];
}

/* ---- the border ---- */

/* A row of voxels, and the rows around it. At the field's ends the row itself takes the place of a missing
 * row. Each member holds indices of the first voxels of rows. */
typedef struct border_row {
  size_t at, beside[4]; /* at: the row; beside: the rows before and after `at` along y, then along z */
  size_t across[2][2];  /* [before, after along z][before, after along y] */
} border_row;

static border_row row_at(const label_field *field, size_t y, size_t z) {
  const size_t nx = field->size[0], slice = nx * field->size[1], at = z * slice + y * nx;
  const size_t before = y > 0 ? nx : 0, after = y + 1 < field->size[1] ? nx : 0;
  const size_t above = z > 0 ? slice : 0, below = z + 1 < field->size[2] ? slice : 0;
  return (border_row){at,
                      {at - before, at + after, at - above, at + below},
                      {{at - above - before, at - above + after}, {at + below - before, at + below + after}}};
}

/* Marks the voxels of a row that a face of the border touches. */
static void mark_border(const level_job *job, const border_row *row, unsigned char *marks) {
  const size_t nx = job->field->size[0];
  const unsigned char *own = job->inside + row->at, *a = job->inside + row->beside[0],
                      *b = job->inside + row->beside[1], *c = job->inside + row->beside[2],
                      *d = job->inside + row->beside[3];
  for (size_t x = 0; x < nx; x++)
    marks[x] = (unsigned char)((own[x] ^ a[x]) | (own[x] ^ b[x]) | (own[x] ^ c[x]) | (own[x] ^ d[x]));
  for (size_t x = 0; x + 1 < nx; x++) marks[x] |= own[x] ^ own[x + 1];
  for (size_t x = nx - 1; x > 0; x--) marks[x] |= own[x] ^ own[x - 1];
}

/* Adds the faces of the label's border between a voxel and its neighbours to the sums. Each face is added
 * twice, once from each side. */
static void add_faces(const level_job *job, const border_row *row, size_t x, float sums[LEVEL_OF_FACES]) {
  const size_t at = row->at + x, nx = job->field->size[0];
  const size_t beside[6] = {row->beside[0] + x, row->beside[1] + x,  row->beside[2] + x,
                            row->beside[3] + x, x > 0 ? at - 1 : at, x + 1 < nx ? at + 1 : at};
  const float *values = job->field->values, own = values[at];
  for (int n = 0; n < 6; n++) {
    if (job->inside[beside[n]] == job->inside[at]) continue;
    const float other = values[beside[n]];
    sums[HL_LEVEL_FACES] += 1;
    sums[HL_LEVEL_VALUE] += 0.5f * (own + other);
    sums[HL_LEVEL_FALL] += job->inside[at] ? own - other : other - own;
  }
}

/* ---- thin parts ---- */

/* Marks the voxels of a row that lie in a block of 2x2x2 voxels of which at least seven are the label's. A
 * part of the label without such a block is one voxel thin. Derived: let (a, b, c) be a plane's normal, a >=
 * b >= c >= 0. Seven corners of a cube of edge 1 lie between two planes with this normal only if the planes
 * are at least a + b apart, which is 1 or more. So a plate that is one voxel thin has no such block, whatever
 * its orientation.
 */
static void mark_thick(const level_job *job, const border_row *row, unsigned char *squares,
                       unsigned char *marks) {
  enum { MOST_OF_BLOCK = 7 };
  const size_t nx = job->field->size[0];
  const unsigned char *own = job->inside + row->at;
  memset(marks, 0, nx);
  for (int n = 0; n < 4; n++) { /* the squares of four voxels across the row, on one side of it */
    const unsigned char *b = job->inside + row->beside[n & 1], *c = job->inside + row->beside[2 + (n >> 1)],
                        *d = job->inside + row->across[n >> 1][n & 1];
    for (size_t x = 0; x < nx; x++) squares[x + 1] = (unsigned char)(own[x] + b[x] + c[x] + d[x]);
    squares[0] = squares[1], squares[nx + 1] = squares[nx];
    for (size_t x = 0; x < nx; x++)
      marks[x] |= (squares[x] + squares[x + 1] >= MOST_OF_BLOCK) |
                  (squares[x + 1] + squares[x + 2] >= MOST_OF_BLOCK);
  }
  for (size_t x = 0; x < nx; x++) marks[x] &= own[x];
}

/* ---- sums ---- */

/* Adds a row of voxels to the sums of the row of cells that begins with cell `first`. marks: scratch memory,
 * [2 * voxels of the row + 2]. */
static void sum_row(const level_job *job, const border_row *row, unsigned char *marks, size_t first) {
  const size_t nx = job->field->size[0];
  const unsigned char *inside = job->inside + row->at;
  mark_border(job, row, marks);
  for (size_t x = 0; x < nx; x++) {
    if (!marks[x]) continue;
    float sums[LEVEL_OF_FACES] = {0};
    add_faces(job, row, x, sums);
    for (int s = 0; s < LEVEL_OF_FACES; s++) plane_of(job->levels, s)[first + x / CELL] += sums[s];
  }
  mark_thick(job, row, marks + nx, marks);
  float *thin = plane_of(job->levels, HL_LEVEL_THIN) + first,
        *all = plane_of(job->levels, HL_LEVEL_VOXELS) + first;
  for (size_t x = 0; x < nx; x++) {
    all[x / CELL] += inside[x];
    thin[x / CELL] += (float)(inside[x] & !marks[x]);
  }
}

/* Computes the sums over the border's faces and over the label's voxels in a slice of cells. */
static void sum_cells(void *data, size_t cell_z, int worker) {
  const level_job *job = data;
  const label_field *field = job->field;
  const size_t *cells = job->levels->size, plane = cells[0] * cells[1];
  unsigned char *marks = (unsigned char *)(field->lines + (size_t)worker * field->line_floats);
  for (int p = 0; p < HL_LEVEL_PLANES; p++)
    memset(plane_of(job->levels, p) + cell_z * plane, 0, plane * sizeof(float));
  for (size_t z = CELL * cell_z; z < CELL * (cell_z + 1) && z < field->size[2]; z++)
    for (size_t y = 0; y < field->size[1]; y++) {
      const border_row row = row_at(field, y, z);
      sum_row(job, &row, marks, cell_z * plane + y / CELL * cells[0]);
    }
}

/* ---- the field ---- */

/* The two cells along an axis between whose middles the middle of a voxel lies: the voxel's own cell, whose
 * middle is a quarter of a cell away, and the next cell on the other side. */
typedef struct cells_around {
  size_t own, other;
} cells_around;

enum { OWN = 3, OTHER = 1 }; /* weights of the two cells, in quarters */

static cells_around around(size_t at, size_t cells) {
  const size_t own = at / CELL;
  const size_t other = at % CELL == 0 ? (own > 0 ? own - 1 : own) : (own + 1 < cells ? own + 1 : own);
  return (cells_around){own, other};
}

/* Interpolates the cells' sums to a row of voxels, along y and z only. Interpolation along x comes later.
 * rows: [HL_LEVEL_PLANES][cells]. */
static void blend_rows(const label_levels *levels, size_t y, size_t z, float *rows) {
  const size_t *cells = levels->size;
  const cells_around j = around(y, cells[1]), k = around(z, cells[2]);
  for (int s = 0; s < HL_LEVEL_PLANES; s++, rows += cells[0]) {
    const float *from = plane_of(levels, s), *a = from + (k.own * cells[1] + j.own) * cells[0],
                *b = from + (k.own * cells[1] + j.other) * cells[0],
                *c = from + (k.other * cells[1] + j.own) * cells[0],
                *d = from + (k.other * cells[1] + j.other) * cells[0];
    for (size_t x = 0; x < cells[0]; x++)
      rows[x] = (OWN * OWN * a[x] + OWN * OTHER * (b[x] + c[x]) + OTHER * OTHER * d[x]) * (1.0f / 64);
  }
}

static float levelled(const float sums[HL_LEVEL_PLANES], float value) {
  const float faces = sums[HL_LEVEL_FACES] + FAINT, middle = (sums[HL_LEVEL_VALUE] + FAINT * 0.5f) / faces,
              fall = (sums[HL_LEVEL_FALL] + FAINT * HL_LABEL_SLOPE) / faces;
  value = 0.5f + (value - middle) * (HL_LABEL_SLOPE / (fall > LEAST_FALL ? fall : LEAST_FALL)) +
          GROWTH * HL_LABEL_SLOPE * sums[HL_LEVEL_THIN] / (sums[HL_LEVEL_VOXELS] + FAINT);
  return value < LEAST ? LEAST : value > GREATEST ? GREATEST : value;
}

static void level_slice(void *data, size_t z, int worker) {
  const level_job *job = data;
  const label_field *field = job->field;
  const size_t cells = job->levels->size[0];
  float *rows = field->lines + (size_t)worker * field->line_floats;
  for (size_t y = 0; y < field->size[1]; y++) {
    float *values = field->values + (z * field->size[1] + y) * field->size[0];
    blend_rows(job->levels, y, z, rows);
    for (size_t x = 0; x < field->size[0]; x++) {
      const cells_around i = around(x, cells);
      float sums[HL_LEVEL_PLANES];
      for (int s = 0; s < HL_LEVEL_PLANES; s++) {
        const float *row = rows + (size_t)s * cells;
        sums[s] = OWN * row[i.own] + OTHER * row[i.other];
      }
      values[x] = levelled(sums, values[x]);
    }
  }
}

void hl_label_level(hl_pool *pool, const unsigned char *inside, const label_field *field,
                    const label_levels *levels) {
  level_job job = {inside, field, levels};
  hl_pool_run(pool, levels->size[2], sum_cells, &job);
  for (int p = 0; p < HL_LEVEL_PLANES; p++) {
    label_field blurred = *field;
    blurred.values = plane_of(levels, p);
    memcpy(blurred.size, levels->size, sizeof blurred.size);
    hl_label_filter(pool, &blurred, &BLUR);
  }
  hl_pool_run(pool, field->size[2], level_slice, &job);
}
