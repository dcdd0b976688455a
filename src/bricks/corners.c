/* bricks/corners.c - hl_corners_of_cells().
 *
 * The weights along an axis. A plain mean of the two cells beside a corner would blur. Derived: the cells'
 * data are means over cells, a kernel with the variance 1/12 in squared edges of a cell. The cubic B-spline
 * of the coefficients is a kernel with the variance 1/3. A plain mean of two cells would add the variance
 * 1/4. The weights -1/6, 2/3, 2/3, -1/6 have the variance -5/12, which cancels 1/12 + 1/3. Therefore the
 * field equals the source to the fourth order of the edge.
 *
 * The limit. The negative weights would make values beside a shock that no cell has. Clipping such values
 * would add mass beside thin matter, and take mass from its middle. So the coefficient is the plain mean of
 * the eight cells, plus what flows to it from the six neighbouring corners, and flows are made smaller until
 * no corner leaves its range (flux-corrected transport: S. T. Zalesak, Fully multidimensional flux-corrected
 * transport algorithms for fluids, 1979). What flows into one corner flows out of another one.
 *
 * The flows. Derived: along an axis, A = M + D, where M is the mean of two cells, A has the weights above,
 * and D has -1/6, 1/6, 1/6, -1/6. With F = (next cell - previous cell) / 6 for each cell, D is the F of the
 * cell before a corner minus the F of the cell behind it. In space, A A A - M M M is a sum of one D for each
 * axis, times M M, A M, M A or A A along the other two, as the order of the axes is. The mean over the six
 * orders has the weights 1/3, 1/6, 1/6 and 1/3, which make the numbers of `across`. */
#include "bricks/corners.h"

#include <math.h>
#include <stdbool.h>

enum {
  AROUND = 4, /* the cells along an axis that make a coefficient */
  SIDE = CORNERS_MOST +
         2,        /* corners along an axis, with one more at each end, whose flows are limited, too */
  FLOWS = SIDE + 1 /* flows along their axis: before each corner, and behind the last one */
};

/* The weights, across the axis of a flow, of the 4 x 4 cells around the line from corner to corner. */
static const double across[AROUND][AROUND] = {{1.0 / 108, -11.0 / 216, -11.0 / 216, 1.0 / 108},
                                              {-11.0 / 216, 37.0 / 108, 37.0 / 108, -11.0 / 216},
                                              {-11.0 / 216, 37.0 / 108, 37.0 / 108, -11.0 / 216},
                                              {1.0 / 108, -11.0 / 216, -11.0 / 216, 1.0 / 108}};

/* What is known of a corner before its flows are limited. */
typedef struct corner {
  float mean;            /* the mean of the eight cells that meet here, without the cells that have no
                          * value; NaN if no cell has a value */
  float least, greatest; /* the range of these cells */
  float take, give; /* 0 to 1: the part of all flows into the corner, and out of it, that keeps its range */
  bool flows;       /* whether all 4^3 cells have values */
} corner;

typedef struct corner_block {
  size_t count[3];                    /* corners with one more at each end; at most SIDE */
  corner corners[SIDE][SIDE][SIDE];   /* [z][y][x] */
  float flow[3][FLOWS][FLOWS][FLOWS]; /* [axis][z][y][x]; the flow into the corner of the same index from the
                                       * corner before it along the axis. The flow is NaN if a cell that it
                                       * is made of has no value */
} corner_block;

static const size_t cell_step[3] = {1, CORNERS_CELLS, (size_t)CORNERS_CELLS *CORNERS_CELLS};

static const float *cells_at(const float *cells, const size_t at[3]) {
  return cells + at[2] * cell_step[2] + at[1] * cell_step[1] + at[0];
}

/* The flow along an axis. first: the first of the cells around the corner that the flow enters. */
static float flow_of(const float *first, int axis) {
  const size_t along = cell_step[axis], u = cell_step[axis == 0], v = cell_step[axis == 2 ? 1 : 2];
  double sum = 0;
  for (size_t k = 0; k < AROUND; k++)
    for (size_t j = 0; j < AROUND; j++) {
      const float *cell = first + k * v + j * u;
      sum += across[k][j] * ((double)cell[2 * along] - (double)cell[0]);
    }
  return (float)(sum / 6);
}

/* Whether a cell is one of the two in the middle of AROUND cells. */
static bool is_middle(size_t cell) { return cell == AROUND / 2 - 1 || cell == AROUND / 2; }

/* The mean and the range of the eight cells that meet at a corner. */
static corner meeting(const float *first) {
  corner c = {.mean = NAN, .least = INFINITY, .greatest = -INFINITY, .flows = true};
  double sum = 0;
  int count = 0;
  for (size_t k = 0; k < AROUND; k++)
    for (size_t j = 0; j < AROUND; j++)
      for (size_t i = 0; i < AROUND; i++) {
        float value = first[k * cell_step[2] + j * cell_step[1] + i];
        if (!(value == value)) c.flows = false;
        bool meets = is_middle(i) && is_middle(j) && is_middle(k);
        if (!meets || !(value == value)) continue;
        sum += (double)value;
        c.least = value < c.least ? value : c.least;
        c.greatest = value > c.greatest ? value : c.greatest;
        count++;
      }
  if (count > 0) c.mean = (float)(sum / count);
  return c;
}

/* The flow into the corner at `at` through its side before it (side 0) or behind it (side 1). */
static float flow_into(const corner_block *block, int axis, size_t side, const size_t at[3]) {
  const size_t n[3] = {at[0] + (axis == 0 ? side : 0), at[1] + (axis == 1 ? side : 0),
                       at[2] + (axis == 2 ? side : 0)};
  float flow = block->flow[axis][n[2]][n[1]][n[0]];
  return side == 0 ? flow : -flow;
}

/* The part, at most 1, of `wanted` for which there is room. */
static float part_of(double room, double wanted) { return wanted > room ? (float)(room / wanted) : 1; }

/* Finds which part of the flows keeps a corner in its range, even if the opposite flows do not come. */
static void limit_corner(const corner_block *block, const size_t at[3], corner *c) {
  double in = 0, out = 0;
  c->take = c->give = 1;
  if (!c->flows) return;
  for (int axis = 0; axis < 3; axis++)
    for (size_t side = 0; side < 2; side++) {
      double flow = (double)flow_into(block, axis, side, at);
      if (flow > 0) in += flow;
      else out -= flow;
    }
  c->take = part_of((double)c->greatest - (double)c->mean, in);
  c->give = part_of((double)c->mean - (double)c->least, out);
}

/* The coefficient of a corner that is none of the block's outermost. */
static float coefficient(const corner_block *block, const size_t at[3]) {
  const corner *c = &block->corners[at[2]][at[1]][at[0]];
  if (!c->flows) return c->mean;
  double sum = (double)c->mean;
  for (int axis = 0; axis < 3; axis++)
    for (size_t side = 0; side < 2; side++) {
      size_t n[3] = {at[0], at[1], at[2]};
      n[axis] += 2 * side;
      n[axis]--;
      const corner *other = &block->corners[n[2]][n[1]][n[0]];
      float flow = flow_into(block, axis, side, at),
            part = flow > 0 ? fminf(c->take, other->give) : fminf(c->give, other->take);
      sum += (double)flow * (double)part;
    }
  return sum < (double)c->least      ? c->least
         : sum > (double)c->greatest ? c->greatest
                                     : (float)sum; /* rounding */
}

static void find_flows(corner_block *block, const float *cells, int axis) {
  size_t end[3], at[3];
  for (int a = 0; a < 3; a++) end[a] = block->count[a] + (a == axis);
  for (at[2] = 0; at[2] < end[2]; at[2]++)
    for (at[1] = 0; at[1] < end[1]; at[1]++)
      for (at[0] = 0; at[0] < end[0]; at[0]++)
        block->flow[axis][at[2]][at[1]][at[0]] = flow_of(cells_at(cells, at), axis);
}

void hl_corners_of_cells(const float *cells, const size_t count[3], float *out) {
  corner_block block;
  size_t at[3], n = 0;
  for (int axis = 0; axis < 3; axis++) block.count[axis] = count[axis] + 2;
  for (int axis = 0; axis < 3; axis++) find_flows(&block, cells, axis);
  for (at[2] = 0; at[2] < block.count[2]; at[2]++)
    for (at[1] = 0; at[1] < block.count[1]; at[1]++)
      for (at[0] = 0; at[0] < block.count[0]; at[0]++) {
        corner *c = &block.corners[at[2]][at[1]][at[0]];
        *c = meeting(cells_at(cells, at));
        limit_corner(&block, at, c);
      }
  for (at[2] = 1; at[2] <= count[2]; at[2]++)
    for (at[1] = 1; at[1] <= count[1]; at[1]++)
      for (at[0] = 1; at[0] <= count[0]; at[0]++) out[n++] = coefficient(&block, at);
}
