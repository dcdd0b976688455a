/* particles/lattice.c - chooses the lattice on which particles are spread.
 *
 * In: particles with smoothing lengths, and limits. Out: place, spacing, size and levels. All operations are
 * exact or correctly rounded, so that the choice is the same on every machine. */
#include "particles/particles.h"

#include <math.h>

enum {
  BINS_OF_OCTAVE = 8,
  OCTAVES = 320, /* floats have exponents from -149 to 128 */
  /* The least number of cells that the coarsest level has along the longest axis. Along any other axis that
   * is not periodic, the box then has at least four cells, because it extends beyond the particles at both
   * ends (see PART_OF_EXTENT). Kernels need these cells for their margin (levels.h). */
  LEAST_CELLS = 16,
  /* The lattice extends beyond the outermost particles by the reach of a kernel of median size, plus the
   * longest extent divided by this number. The reach of the widest kernel limits this. */
  PART_OF_EXTENT = 8
};

/* The number of particles whose smoothing length lies in each eighth of an octave. */
typedef struct lengths {
  uint64_t count[OCTAVES * BINS_OF_OCTAVE];
  double most;
} lengths;

static void count_lengths(const hl_particle_set *set, lengths *l) {
  *l = (lengths){.most = 0};
  for (size_t n = 0; n < set->count; n++) {
    int exponent;
    double length = (double)set->length[n], part = frexp(length, &exponent); /* part lies from 1/2 to 1 */
    l->count[(exponent + 160) * BINS_OF_OCTAVE + (int)((part - 0.5) * 2 * BINS_OF_OCTAVE)]++;
    l->most = fmax(l->most, length);
  }
}

/* A quantile of the smoothing lengths: about the fraction `part` of them is less than the result. It is
 * accurate to a bin, whose lower end is returned. */
static double length_below(const lengths *l, size_t count, double part) {
  uint64_t sum = 0;
  int bin = 0;
  for (; bin < OCTAVES * BINS_OF_OCTAVE - 1; bin++) {
    sum += l->count[bin];
    if ((double)sum > part * (double)count) break;
  }
  return ldexp(0.5 + 0.5 * (bin % BINS_OF_OCTAVE) / BINS_OF_OCTAVE, bin / BINS_OF_OCTAVE - 160);
}

/* The box that the lattice must hold. Along a periodic axis it is the period. */
static void find_box(const hl_particle_set *set, const lengths *l, double low[3], double extent[3]) {
  uint32_t least[3] = {UINT32_MAX, UINT32_MAX, UINT32_MAX}, greatest[3] = {0, 0, 0};
  double longest = 0;
  for (size_t n = 0; n < set->count; n++)
    for (int a = 0; a < 3; a++) {
      if (set->place[n][a] < least[a]) least[a] = set->place[n][a];
      if (set->place[n][a] > greatest[a]) greatest[a] = set->place[n][a];
    }
  for (int a = 0; a < 3; a++) {
    low[a] = set->low[a] + (set->periodic[a] ? 0 : set->unit[a] * least[a]);
    extent[a] = set->unit[a] * (set->periodic[a] ? 4294967296.0 : (double)(greatest[a] - least[a]));
    longest = fmax(longest, extent[a]);
  }
  double pad = fmin(2 * l->most, longest / PART_OF_EXTENT + 2 * length_below(l, set->count, 0.5));
  for (int a = 0; a < 3; a++)
    if (!set->periodic[a]) low[a] -= pad, extent[a] += 2 * pad;
}

/* The number of levels that the widest kernels need. It is limited so that the coarsest level has LEAST_CELLS
 * cells along the longest axis. most: the greatest smoothing length. spacing: the length of a cell of level
 * 0. longest: the number of cells of level 0 along the longest axis. */
static int levels_for(double most, double spacing, double longest) {
  int levels = 1;
  while (levels < HL_PARTICLE_LEVELS && most >= 4 * spacing && longest / 2 >= LEAST_CELLS) {
    spacing *= 2, longest /= 2;
    levels++;
  }
  return levels;
}

/* Lays a lattice of this spacing into the box. Returns the number of its points, as a double; INFINITY if
 * there are too many. */
static double lay(const double low[3], const double extent[3], double most, double spacing,
                  hl_particle_lattice *lattice) {
  double longest = fmax(fmax(extent[0], extent[1]), extent[2]) / spacing, points = 1;
  lattice->levels = levels_for(most, spacing, longest);
  double coarsest = (double)(1 << (lattice->levels - 1));
  for (int a = 0; a < 3; a++) {
    double cells = fmax(ceil(extent[a] / spacing / coarsest - 1e-9), 1) * coarsest;
    bool periodic = lattice->periodic[a];
    if (cells > 1e9) return INFINITY;
    lattice->cells[a] = (size_t)cells;
    lattice->spacing[a] = periodic ? extent[a] / cells : spacing;
    lattice->low[a] = periodic ? low[a] : low[a] - (cells * spacing - extent[a]) / 2;
    points *= cells + (periodic ? 0 : 1);
  }
  return points;
}

static bool fits(const hl_particle_limits *limits, const hl_particle_lattice *lattice, double points) {
  bool short_enough = true;
  for (int a = 0; a < 3; a++) short_enough &= limits->side == 0 || lattice->cells[a] <= limits->side;
  return points <= (double)limits->points && short_enough;
}

hl_status hl_particles_lattice(const hl_particle_set *set, const hl_particle_limits *limits,
                               const char *subject, hl_particle_lattice *lattice, hl_error *error) {
  const double finer = 1.02; /* factor by which the spacing grows until the lattice fits */
  lengths l;
  double low[3], extent[3];
  count_lengths(set, &l);
  find_box(set, &l, low, extent);
  for (int a = 0; a < 3; a++) lattice->periodic[a] = set->periodic[a];
  double spacing = limits->spacing, points;
  if (spacing > 0) {
    points = lay(low, extent, l.most, spacing, lattice);
    if (points <= (double)limits->points) return HL_OK;
    return hl_fail(error, HL_ERROR_MEMORY,
                   "%s: a spacing of %g makes %.3g voxels, and at most %zu are made: give a larger spacing "
                   "or more memory",
                   subject, spacing, points, limits->points);
  }
  spacing = fmax(length_below(&l, set->count, 0.02) / 2, fmax(fmax(extent[0], extent[1]), extent[2]) * 1e-6);
  while (points = lay(low, extent, l.most, spacing, lattice), !fits(limits, lattice, points)) {
    if (lattice->cells[0] + lattice->cells[1] + lattice->cells[2] <= 3)
      return hl_fail(error, HL_ERROR_MEMORY, "%s: no memory for a lattice of %zu points", subject,
                     limits->points);
    spacing *= finer;
  }
  return HL_OK;
}
