/* guess/vessels.c - finds bright tubes within other matter, as angiography shows vessels.
 *
 * A scan may have a few voxels that are far brighter than all others. If these bright voxels form tubes, the
 * scan was made to show the tubes, and not the object around them. In Hounsfield units the brightest voxels
 * are bone, not vessels. A voxel lies in a tube if straight lines through it stay among bright voxels for
 * long in only one or two directions. In a sheet, lines in four or more directions stay among bright voxels
 * for long; in a ball and in noise, no line stays among bright voxels for long. */
#include <math.h>

#include "guess/analysis.h"
#include "guess/sample.h"

/* The least distance from the background of the brightest matter, as a multiple of the objects' mean
 * distance. */
#define CONTRAST    3
#define LEAST_TUBES 0.5  /* least fraction of the bright voxels that lies in tubes */
#define MOST_BRIGHT 0.06 /* greatest fraction of the object's voxels that is bright */
#define SPREAD      0.4  /* least part of the object's extent over which tubes reach, along two axes */
/* A line is long if its run of bright voxels has at least this number of times the length of the shortest
 * line's run. */
#define ELONGATED 2.5

enum { LONG = 5 /* a long line has at least this many voxels */, REACH = 32, DIRECTIONS = 13, LEVELS = 4 };
enum { MOST_SEEDS = 4000, LEAST_SEEDS = 60 };

/* The directions to the 26 neighbours of a voxel, without the opposites of listed directions. */
static const int directions[DIRECTIONS][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1}, {1, 1, 0},  {1, -1, 0},
                                              {1, 0, 1},  {1, 0, -1}, {0, 1, 1}, {0, 1, -1}, {1, 1, 1},
                                              {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};

/* The voxels of one kind that were met: their number, and the bounds of their coordinates. */
typedef struct met {
  size_t count, low[3], high[3];
} met;

typedef struct vessel_search {
  const hl_volume *volume;
  const hl_sample *sample;
  const hl_data_analysis *analysis; /* distances are relative, as the sample's values are */
  double step[DIRECTIONS];          /* length of a step in each direction, in the volume's world */
  double level;                     /* distance from the background beyond which voxels are bright */
} vessel_search;

static void meet(met *m, const size_t place[3]) {
  for (int a = 0; a < 3; a++) {
    if (m->count == 0 || place[a] < m->low[a]) m->low[a] = place[a];
    if (m->count == 0 || place[a] > m->high[a]) m->high[a] = place[a];
  }
  m->count++;
}

static double distance_at(const vessel_search *s, const ptrdiff_t place[3]) {
  const size_t *n = s->volume->dimension;
  for (int a = 0; a < 3; a++)
    if (place[a] < 0 || (size_t)place[a] >= n[a]) return -INFINITY;
  double value = hl_volume_value_within(s->volume, (size_t)place[0], (size_t)place[1], (size_t)place[2]);
  double relative = (value - s->sample->low) / s->sample->range;
  return isfinite(value) ? s->analysis->direction * (relative - s->analysis->background) : -INFINITY;
}

/* The length of the run of bright voxels on a line through a bright voxel, up to REACH voxels to either
 * side. */
static int run_through(const vessel_search *s, const size_t seed[3], const int direction[3]) {
  int run = 1;
  for (int side = -1; side <= 1; side += 2)
    for (int n = 1; n <= REACH; n++, run++) {
      ptrdiff_t place[3];
      for (int a = 0; a < 3; a++) place[a] = (ptrdiff_t)seed[a] + side * n * direction[a];
      if (!(distance_at(s, place) > s->level)) break;
    }
  return run;
}

static bool is_in_tube(const vessel_search *s, const size_t seed[3]) {
  double length[DIRECTIONS], least = INFINITY;
  int run[DIRECTIONS], along = 0;
  for (int d = 0; d < DIRECTIONS; d++) {
    run[d] = run_through(s, seed, directions[d]);
    length[d] = run[d] * s->step[d];
    least = fmin(least, length[d]);
  }
  for (int d = 0; d < DIRECTIONS; d++) along += run[d] >= LONG && length[d] > ELONGATED * least;
  return along == 1 || along == 2;
}

/* Counts the object's voxels, the bright voxels and the voxels in tubes, at the places of the sample. every:
 * of this number of bright voxels, one is examined for lying in a tube. */
static void look(const vessel_search *s, size_t every, met *things, met *bright, met *tubes) {
  const size_t *n = s->volume->dimension, step = s->sample->step;
  *things = *bright = *tubes = (met){0};
  for (size_t k = step / 2; k < n[2]; k += step)
    for (size_t j = step / 2; j < n[1]; j += step)
      for (size_t i = step / 2; i < n[0]; i += step) {
        const size_t place[3] = {i, j, k};
        double distance = distance_at(s, (ptrdiff_t[3]){(ptrdiff_t)i, (ptrdiff_t)j, (ptrdiff_t)k});
        if (distance > s->analysis->solid) meet(things, place);
        if (!(distance > s->level)) continue;
        meet(bright, place);
        if (bright->count % every == 0 && is_in_tube(s, place)) meet(tubes, place);
      }
}

static bool are_spread(const met *tubes, const met *things) {
  int axes = 0;
  for (int a = 0; a < 3; a++)
    axes += (double)(tubes->high[a] - tubes->low[a]) > SPREAD * (double)(things->high[a] - things->low[a]);
  return tubes->count > 0 && axes >= 2;
}

/* Returns true if the voxels beyond the level are vessels. expected: the approximate number of these voxels
 * in the sample. *few: set to whether the voxels beyond the level are few enough to be vessels. */
static bool are_vessels(const vessel_search *s, size_t expected, bool *few) {
  met things, bright, tubes;
  size_t every = expected / MOST_SEEDS + 1;
  look(s, every, &things, &bright, &tubes);
  *few = (double)bright.count <= MOST_BRIGHT * (double)things.count;
  return *few && bright.count / every >= LEAST_SEEDS &&
         (double)tubes.count >= LEAST_TUBES * (double)(bright.count / every) && are_spread(&tubes, &things);
}

double hl_data_find_vessels(const hl_volume *volume, const hl_sample *sample, const float *distances,
                            const hl_data_analysis *analysis) {
  vessel_search s = {volume, sample, analysis, .level = analysis->dense};
  if (hl_is_hounsfield(volume) || !(analysis->top > CONTRAST * analysis->mean)) return 0;
  for (int d = 0; d < DIRECTIONS; d++) {
    const int *to = directions[d];
    s.step[d] = vec3_length(mat3_apply(volume->index_to_world.linear, (vec3){to[0], to[1], to[2]}));
  }
  for (int n = 0; n < LEVELS; n++) {
    size_t beyond = 0;
    while (beyond < sample->count && (double)distances[sample->count - 1 - beyond] > s.level) beyond++;
    if (beyond < LEAST_SEEDS) return 0;
    bool few = false;
    if (are_vessels(&s, beyond, &few)) return s.level;
    if (few) return 0; /* even higher levels would divide the bright matter itself, because of its noise */
    s.level = hl_threshold_otsu(distances, sample->count, s.level);
  }
  return 0;
}
