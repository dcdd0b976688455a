/* particles/neighbours.c - finds smoothing lengths from the distances between neighbours.
 *
 * In: particles in Morton order. Out: half the exact distance from each particle to its k-th neighbour. The
 * search uses a tree. Runs of sixteen particles are its leaves, and eight nodes of a layer are the children
 * of a node of the next layer. A node knows the box around its particles. A search visits near nodes first,
 * and leaves out nodes that are farther away than the k-th nearest particle found so far.
 *
 * Only one particle of each leaf gets such a search. The distance to its k-th neighbour, made a little
 * longer, is a guess for the other particles of the leaf. All particles that are nearer to the leaf's box
 * than the guess are gathered once, and are then compared with each other particle of the leaf. A particle
 * that has fewer than k neighbours within the guess gets a search of its own. */
#include "particles/particles.h"

#include <math.h>

#include "core/memory.h"

enum {
  LEAF = 16,          /* number of particles of a leaf */
  FANOUT = 8,         /* number of child nodes of a node */
  LAYERS = 12,        /* the most layers: enough for 16 * 8^11 particles */
  FOUND_MOST = 4096,  /* the most distances that a search collects before it drops the farthest ones; also the
                       * most particles in a crowd */
  AT_ONCE = 64 * LEAF /* number of particles that one call of a job searches for */
};

typedef struct box {
  uint32_t low[3], high[3];
} box;

typedef struct tree {
  const hl_particle_set *set;
  box *layer[LAYERS]; /* owned; layer 0 has the leaves */
  size_t count[LAYERS];
  int layers;
  float unit[3];     /* the unit of places along each axis, divided by the least of the three units. With
                      * these factors, a squared distance is either 0 or at least 1 */
  double least_unit; /* the least unit; world */
  size_t neighbours; /* k */
} tree;

/* One search. */
typedef struct search {
  const tree *tree;
  const uint32_t *place;
  float bound;             /* a squared distance; only nearer particles count as neighbours */
  float found[FOUND_MOST]; /* squared distances that were found so far, including the distance 0 of the
                            * particle itself */
  size_t count;
} search;

static void grow(box *b, const uint32_t low[3], const uint32_t high[3]) {
  for (int a = 0; a < 3; a++) {
    if (low[a] < b->low[a]) b->low[a] = low[a];
    if (high[a] > b->high[a]) b->high[a] = high[a];
  }
}

static void make_leaves(void *data, size_t index, int worker) {
  tree *t = data;
  (void)worker;
  size_t last = (index + 1) * AT_ONCE / LEAF;
  for (size_t n = index * AT_ONCE / LEAF; n < last && n < t->count[0]; n++) {
    box b = {{UINT32_MAX, UINT32_MAX, UINT32_MAX}, {0, 0, 0}};
    for (size_t p = n * LEAF; p < (n + 1) * LEAF && p < t->set->count; p++)
      grow(&b, t->set->place[p], t->set->place[p]);
    t->layer[0][n] = b;
  }
}

static hl_status make_tree(hl_context *context, hl_pool *pool, const char *subject, tree *t,
                           hl_error *error) {
  size_t count = (t->set->count + LEAF - 1) / LEAF;
  for (t->layers = 0; t->layers < LAYERS; count = (count + FANOUT - 1) / FANOUT) {
    int l = t->layers++;
    t->count[l] = count;
    t->layer[l] = hl_allocate(context, count, sizeof *t->layer[l]);
    if (t->layer[l] == NULL) return hl_fail_memory(error, count * sizeof *t->layer[l], subject);
    if (l == 0) hl_pool_run(pool, (t->set->count + AT_ONCE - 1) / AT_ONCE, make_leaves, t);
    for (size_t n = 0; l > 0 && n < count; n++) {
      box b = t->layer[l - 1][n * FANOUT];
      for (size_t c = n * FANOUT + 1; c < (n + 1) * FANOUT && c < t->count[l - 1]; c++)
        grow(&b, t->layer[l - 1][c].low, t->layer[l - 1][c].high);
      t->layer[l][n] = b;
    }
    if (count == 1) break;
  }
  return HL_OK;
}

/* The least squared distance between a place and a box. Along periodic axes, the shorter way counts, which
 * may cross the border of the period. */
static float box_distance(const tree *t, const uint32_t place[3], const box *b) {
  float sum = 0;
  for (int a = 0; a < 3; a++) {
    uint32_t below = b->low[a] - place[a], above = place[a] - b->high[a];
    if (place[a] >= b->low[a] && place[a] <= b->high[a]) continue;
    uint32_t gap = place[a] < b->low[a] ? below : above;
    if (t->set->periodic[a]) gap = below < above ? below : above;
    float d = (float)gap * t->unit[a];
    sum += d * d;
  }
  return sum;
}

/* Moves the k least numbers to the front, and returns the greatest of them. k: from 1 to count. The method is
 * quickselect with the median of three as pivot. */
static float select_least(float *x, size_t count, size_t k) {
  size_t low = 0, high = count - 1, wanted = k - 1;
  while (low < high) {
    float a = x[low], b = x[low + (high - low) / 2], c = x[high];
    float pivot = a < b ? (b < c ? b : a < c ? c : a) : (a < c ? a : b < c ? c : b);
    size_t i = low, j = high;
    for (;;) {
      while (x[i] < pivot) i++;
      while (x[j] > pivot) j--;
      if (i >= j) break;
      float swap = x[i];
      x[i++] = x[j], x[j--] = swap;
    }
    if (wanted <= j) high = j;
    else low = j + 1;
  }
  return x[wanted];
}

/* Drops all but the k least distances. */
static void drop_far(search *s) {
  size_t k = s->tree->neighbours + 1;
  if (s->count < k) return;
  float least = select_least(s->found, s->count, k);
  s->count = k;
  if (least < s->bound) s->bound = least;
}

static void look_at_leaf(search *s, size_t leaf) {
  const hl_particle_set *set = s->tree->set;
  const float *unit = s->tree->unit;
  size_t begin = leaf * LEAF, end = begin + LEAF < set->count ? begin + LEAF : set->count;
  if (s->count + LEAF > FOUND_MOST) drop_far(s);
  for (size_t n = begin; n < end; n++) {
    float x = (float)(int32_t)(set->place[n][0] - s->place[0]) * unit[0],
          y = (float)(int32_t)(set->place[n][1] - s->place[1]) * unit[1],
          z = (float)(int32_t)(set->place[n][2] - s->place[2]) * unit[2];
    float distance = x * x + y * y + z * z;
    s->found[s->count] = distance;
    s->count += distance < s->bound;
  }
}

/* Visits the nodes below a node, the nearest first. */
static void look_at(search *s, int layer, size_t node) {
  const tree *t = s->tree;
  if (layer == 0) {
    look_at_leaf(s, node);
    return;
  }
  size_t first = node * FANOUT, count = t->count[layer - 1] - first;
  if (count > FANOUT) count = FANOUT;
  float distance[FANOUT];
  for (size_t c = 0; c < count; c++) distance[c] = box_distance(t, s->place, &t->layer[layer - 1][first + c]);
  for (size_t visited = 0; visited < count; visited++) {
    size_t nearest = 0;
    for (size_t c = 1; c < count; c++) nearest = distance[c] < distance[nearest] ? c : nearest;
    if (!(distance[nearest] < s->bound)) return;
    look_at(s, layer - 1, first + nearest);
    distance[nearest] = INFINITY;
  }
}

static float distance_between(const tree *t, const uint32_t a[3], const uint32_t b[3]) {
  float sum = 0;
  for (int axis = 0; axis < 3; axis++) {
    float d = (float)(int32_t)(a[axis] - b[axis]) * t->unit[axis];
    sum += d * d;
  }
  return sqrtf(sum);
}

/* Finds the distance from a particle to its k-th neighbour, by a search of the whole tree. bound: an upper
 * bound of this distance. If the distance is greater than the bound, the result is infinite. */
static float search_one(search *s, size_t n, float bound) {
  s->place = s->tree->set->place[n];
  s->count = 0;
  s->bound = bound * bound * 1.0001f;   /* the factor keeps a particle exactly at the bound, in spite of
                                         * rounding */
  if (!(s->bound > 0)) s->bound = 0.5f; /* below the least distance other than 0 */
  look_at(s, s->tree->layers - 1, 0);
  if (s->count <= s->tree->neighbours) return INFINITY;
  drop_far(s);
  return sqrtf(s->bound);
}

/* ---- the neighbours of all particles of a leaf ---- */

/* All particles that may be neighbours of a leaf's particles. */
typedef struct crowd {
  uint32_t place[3][FOUND_MOST];
  float distance[FOUND_MOST]; /* squared distances to the particle that is searched for */
  size_t count;
} crowd;

/* The least squared distance between two boxes. Along periodic axes, the shorter way counts, which may cross
 * the border of the period. */
static float distance_of_boxes(const tree *t, const box *one, const box *other) {
  float sum = 0;
  for (int a = 0; a < 3; a++) {
    if (one->low[a] <= other->high[a] && other->low[a] <= one->high[a]) continue;
    uint32_t above = other->low[a] - one->high[a], below = one->low[a] - other->high[a];
    uint32_t gap = other->low[a] > one->high[a] ? above : below;
    if (t->set->periodic[a]) gap = above < below ? above : below;
    float d = (float)gap * t->unit[a];
    sum += d * d;
  }
  return sum;
}

/* Adds to the crowd all particles below a node whose squared distance to a leaf's box is less than `bound`.
 * Returns false if there are too many. */
static bool gather(const tree *t, int layer, size_t node, const box *leaf, float bound, crowd *c) {
  if (layer > 0) {
    size_t first = node * FANOUT, last = first + FANOUT;
    if (last > t->count[layer - 1]) last = t->count[layer - 1];
    for (size_t n = first; n < last; n++)
      if (distance_of_boxes(t, leaf, &t->layer[layer - 1][n]) < bound &&
          !gather(t, layer - 1, n, leaf, bound, c))
        return false;
    return true;
  }
  size_t begin = node * LEAF, end = begin + LEAF < t->set->count ? begin + LEAF : t->set->count;
  if (c->count + LEAF > FOUND_MOST) return false;
  for (size_t n = begin; n < end; n++) {
    for (int a = 0; a < 3; a++) c->place[a][c->count] = t->set->place[n][a];
    c->count += box_distance(t, t->set->place[n], leaf) < bound;
  }
  return true;
}

/* Finds the distance from a particle to its k-th neighbour among the crowd. bound: the squared distance
 * within which the crowd was gathered. If the distance is not less than this bound, the crowd may lack
 * neighbours, and the result is infinite. */
static float search_crowd(search *s, crowd *c, size_t n, float bound) {
  const uint32_t *place = s->tree->set->place[n];
  const float *unit = s->tree->unit;
  for (size_t m = 0; m < c->count; m++) {
    float x = (float)(int32_t)(c->place[0][m] - place[0]) * unit[0],
          y = (float)(int32_t)(c->place[1][m] - place[1]) * unit[1],
          z = (float)(int32_t)(c->place[2][m] - place[2]) * unit[2];
    c->distance[m] = x * x + y * y + z * z;
  }
  s->count = 0;
  for (size_t m = 0; m < c->count; m++) {
    s->found[s->count] = c->distance[m];
    s->count += c->distance[m] < bound;
  }
  size_t k = s->tree->neighbours + 1;
  return s->count < k ? INFINITY : sqrtf(select_least(s->found, s->count, k));
}

/* Finds the particle of a leaf that is nearest to the middle of the leaf's box. */
static size_t middle_of(const tree *t, size_t leaf, size_t begin, size_t end) {
  const box *b = &t->layer[0][leaf];
  uint32_t middle[3];
  float least = INFINITY;
  size_t nearest = begin;
  for (int a = 0; a < 3; a++) middle[a] = b->low[a] + (b->high[a] - b->low[a]) / 2;
  for (size_t n = begin; n < end; n++) {
    float distance = distance_between(t, t->set->place[n], middle);
    if (distance < least) least = distance, nearest = n;
  }
  return nearest;
}

/* Finds the distance from each particle of a leaf to its k-th neighbour. middle: the particle in the middle
 * of the leaf. near: this distance for the middle of the leaf before, which is about the same. bound: an
 * upper bound of the distance for this particle. Returns the distance for this particle. */
static float search_leaf(search *s, crowd *c, size_t leaf, size_t middle, float near, float bound) {
  const float more = 1.12f; /* this factor is ample: if particles are evenly spread, the distance to the 48th
                             * neighbour varies by only 5 % */
  const tree *t = s->tree;
  size_t begin = leaf * LEAF, end = begin + LEAF < t->set->count ? begin + LEAF : t->set->count;
  float at_middle = search_one(s, middle, fminf(more * near, bound));
  if (!(at_middle < INFINITY)) at_middle = search_one(s, middle, bound);
  float guess = more * more * at_middle * at_middle;
  c->count = 0;
  bool gathered = gather(t, t->layers - 1, 0, &t->layer[0][leaf], guess * 1.0001f, c);
  for (size_t n = begin; n < end; n++) {
    float distance = n == middle ? at_middle : gathered ? search_crowd(s, c, n, guess) : INFINITY;
    if (!(distance < INFINITY))
      distance = search_one(s, n, at_middle + distance_between(t, t->set->place[n], t->set->place[middle]));
    t->set->length[n] = (float)(0.5 * (double)distance * t->least_unit);
  }
  return at_middle;
}

static void find_distances(void *data, size_t index, int worker) {
  const tree *t = data;
  search s = {.tree = t};
  crowd c;
  float before = INFINITY;
  size_t last_middle = 0, first = index * (AT_ONCE / LEAF);
  (void)worker;
  for (size_t leaf = first; leaf < first + AT_ONCE / LEAF && leaf < t->count[0]; leaf++) {
    size_t begin = leaf * LEAF, end = begin + LEAF < t->set->count ? begin + LEAF : t->set->count;
    size_t middle = middle_of(t, leaf, begin, end);
    float moved = before < INFINITY ? distance_between(t, t->set->place[middle], t->set->place[last_middle])
                                    : 0;
    before = search_leaf(&s, &c, leaf, middle, before, before + moved);
    last_middle = middle;
  }
}

/* A particle gets the length 0 if its k nearest neighbours all lie at its own place. Such lengths are
 * replaced by the least length of all other particles. */
static hl_status mend_lengths(hl_particle_set *set, const char *subject, hl_error *error) {
  float least = INFINITY;
  for (size_t n = 0; n < set->count; n++)
    if (set->length[n] > 0 && set->length[n] < least) least = set->length[n];
  if (!(least < INFINITY))
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: all particles are at one place: give smoothing lengths, or more places", subject);
  for (size_t n = 0; n < set->count; n++)
    if (!(set->length[n] > 0)) set->length[n] = least;
  return HL_OK;
}

hl_status hl_particles_find_lengths(hl_context *context, hl_pool *pool, const char *subject,
                                    hl_particle_set *set, hl_error *error) {
  tree t = {.set = set};
  t.neighbours = set->count - 1 < HL_PARTICLES_NEIGHBOURS ? set->count - 1 : HL_PARTICLES_NEIGHBOURS;
  t.least_unit = fmin(fmin(set->unit[0], set->unit[1]), set->unit[2]);
  for (int a = 0; a < 3; a++) t.unit[a] = (float)(set->unit[a] / t.least_unit);
  hl_status status = make_tree(context, pool, subject, &t, error);
  if (status == HL_OK) hl_pool_run(pool, (set->count + AT_ONCE - 1) / AT_ONCE, find_distances, &t);
  for (int l = 0; l < t.layers; l++) hl_release(context, t.layer[l]);
  if (status == HL_OK && hl_pool_cancelled(pool))
    status = hl_fail(error, HL_ERROR_CANCELLED, "%s: stopped", subject);
  return status == HL_OK ? mend_lengths(set, subject, error) : status;
}
