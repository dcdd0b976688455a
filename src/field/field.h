/* field/field.h - fields of absorption and of light in a lattice of cells over the whole content. Neither
 * field depends on the eye.
 *
 * In: the grids and classifiers of a frame's volumes, its meshes, its sky. Out: the fraction of light that
 * each cell absorbs along each axis (opacity.c), and the sky's light that reaches each cell (sky_field.c).
 * Samples look up the sky's light (lookup_lanes.h).
 *
 * A lattice is walked in slices: planes of cells at a right angle to an axis. A slice's rows lie along
 * `across`, one below the other along `down`, and are padded to whole vectors of lanes.
 *
 * The matter of volumes fills cells, and a cell absorbs a part of the light that crosses it. Surfaces fill no
 * cells: they cut the links between the middles of cells (surface_links.h). */
#ifndef HL_FIELD_FIELD_H
#define HL_FIELD_FIELD_H

#include "core/error.h"
#include "core/memory.h"
#include "core/vector.h"
#include "grid/classifier.h"

enum {
  FIELD_LANES = 16,
  FIELD_DIRECTIONS = 36, /* number of directions of light that come from one end of an axis */
  FIELD_SAMPLES = 4      /* the greatest number of samples along an edge of a cell */
};

typedef struct field_lattice {
  int32_t count[3]; /* numbers of cells along x, y and z */
  vec3 low;         /* the lattice's low corner; frame space */
  double cell;      /* the edge of a cell, which is a cube; frame units */
} field_lattice;

typedef struct field_slices {
  int axis, across, down;
  int32_t slices, rows, columns, stride; /* stride: the number of columns, rounded up to whole vectors of
                                          * lanes */
} field_slices;

static inline field_slices hl_field_slices(const field_lattice *lattice, int axis) {
  field_slices s = {.axis = axis, .across = axis == 0 ? 1 : 0, .down = axis == 2 ? 1 : 2};
  s.slices = lattice->count[axis];
  s.rows = lattice->count[s.down];
  s.columns = lattice->count[s.across];
  s.stride = (s.columns + FIELD_LANES - 1) / FIELD_LANES * FIELD_LANES;
  return s;
}

static inline size_t hl_field_cells(const field_lattice *lattice) {
  return (size_t)lattice->count[0] * (size_t)lattice->count[1] * (size_t)lattice->count[2];
}

/* The matter of one volume, in the form in which the folder field samples it. */
typedef struct field_matter {
  const grid *grid;
  const classifier *classifier;
  float to_index[3][4];  /* maps frame space to the volume's index space */
  float low[3], high[3]; /* the volume's box; index space */
  float cast;            /* the extinction for lights divided by the extinction for the eye; if 0, the volume
                          * casts no shadow */
  int visible;
  int smooth; /* whether the voxels are coefficients of the interpolating kernel */
} field_matter;

/* The optical depth of each cell, for each axis along which light crosses the cell. */
typedef struct opacity_field {
  field_lattice lattice;
  float *depth[3]; /* [slices][rows][3][stride]; the optical depth d of the cell for light along the slices'
                    * axis, across and down; the cell lets 2^-d of the light through */
  unsigned char
      /* [slices][rows][stride / FIELD_LANES]; FIELD_MATTER and FIELD_RECEIVES for a block of cells;
       * FIELD_RECEIVES is set only in slabs whose light this process finds (field_share.h). */
      *flags[3];
  unsigned char *seen; /* [z][y][x]; 1 for each cell in which, or near which, something may be visible */
} opacity_field;

enum { FIELD_MATTER = 1, FIELD_RECEIVES = 2 };

/* A cell is linked with nine cells of the slice before and with nine of the slice after. */
enum { FIELD_LINKS = 9 };

/* Flags of a block of FIELD_LANES cells. LINKS_BEFORE: a surface cuts some link from the block to the slice
 * before. LINKS_AFTER: a surface cuts some link from the block to the slice after. */
enum { LINKS_BEFORE = 1, LINKS_AFTER = 2 };

/* ---- the functions of this room that are compiled for each instruction set ---- */

/* Sixteen neighbouring cells along x. */
typedef struct field_block {
  const field_matter *matter; /* [count]; the volumes */
  int count;
  float corner[3]; /* the low corner of the first cell; frame space */
  float cell;
  int samples; /* number of samples along an edge of a cell */
  /* whether only four of the 2 x 2 x 2 samples of a cell are taken, of which no two lie in one row. Each of
   * these samples counts twice, so that each row along each axis has its depth */
  int every_other;
  const uint32_t *cells; /* [count]; the cells that a volume's bricks reach, one bit each */
} field_block;

/* The type of the function that finds the optical depth d of each cell of a block along x, y and z; the cell
 * lets 2^-d of the light through. */
typedef void field_opacity_function(const field_block *block, float depth[3][FIELD_LANES]);

/* A direction from which the sky's light comes, in the form that a sweep along an axis needs, from slice to
 * slice. */
typedef struct sky_direction {
  /* the distance, in floats, from a cell to the first of the four cells of the slice before from which the
   * cell gets this direction's light */
  int32_t offset;
  float weight[4];    /* weights of the four cells: the first cell, the next cell across, and the two cells
                       * below these two */
  int link;           /* the number of the link to the first of the four cells: 3 (1 + down) + 1 + across */
  float across, down; /* squares of the distances, in cells, by which the light moves across and down while it
                       * crosses a slice */
  int slope; /* the number of the first direction with the same `across` and `down`. The two directions are
              * mirror images of each other, so a cell has one transmittance for both */
  const float *basis; /* [channels x FIELD_HARMONICS]; for each channel and harmonic, the integral of the
                       * sky's radiance times the harmonic over the solid angle of this direction */
} sky_direction;

typedef struct sky_slice {
  const sky_direction *directions; /* [direction_count]; the directions of the sweep */
  int direction_count, channels;
  const float *depth;         /* [rows][3][stride]; the optical depths of the slice's cells, as in
                               * opacity_field */
  const unsigned char *flags; /* [rows][stride / FIELD_LANES]; the flags of the slice's blocks, as in
                               * opacity_field */
  int32_t stride, columns;
  /* [rows + 2][FIELD_DIRECTIONS][light_stride]: the light that leaves the slice before. Rows of all
   * directions lie beside each other, because a row's cells read them one after the other. */
  const float *old;
  float *left; /* the light that leaves this slice, laid out as `old` */
  /* [rows + 2][light_stride / FIELD_LANES]: the directions that have light in a block, one bit each. Where a
   * bit is 0, the block's light is 0. */
  const uint64_t *old_lit;
  uint64_t *left_lit;
  int32_t light_stride;
  float *field;        /* the first float of the slice's first cell */
  size_t across, down; /* numbers of floats from a cell to the next cell in its row, and to the cell in the
                        * next row */
  int passing; /* index, among a cell's floats, of the mean of the cell's transmittances along three axes. The
                * sweep adds a third of the transmittance along the slices' axis to this mean; if 0, the sweep
                * adds nothing */
  /* [rows][stride / FIELD_LANES]; for each block of cells, whether surfaces cut its links: LINKS_BEFORE and
   * LINKS_AFTER; null if there are no surfaces */
  const unsigned char *cut;
  unsigned char cut_here; /* LINKS_BEFORE or LINKS_AFTER: the side from which the light comes through
                           * links */
  /* [rows + 2][light_stride]; the fraction, in 255ths, that surfaces absorb of the light that goes along a
   * link between cells */
  const unsigned char *taken[FIELD_LINKS];
} sky_slice;

/* The type of the function that moves the light of all directions to the next slice, in one row of cells, and
 * adds it to the cells near which something is visible. In a block of cells that all get less than SKY_FAINT
 * of a direction's light, this light counts as 0 and is not moved on. */
typedef void sky_row_function(const sky_slice *slice, int32_t row);

typedef struct field_functions {
  field_opacity_function *opacity;
  sky_row_function *sky_row;
} field_functions;

#endif
