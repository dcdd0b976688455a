/* particles/order.c - brings particles into the order of a Morton curve, with places in fixed point.
 *
 * In: a caller's arrays. Out: an hl_particle_set. Particles are first counted into 2^18 buckets by the
 * highest bits of their places; then the buckets are sorted in parallel, by three bits at a time. The order
 * of each bucket depends on its particles alone, so it is the same with any number of threads. */
#include "particles/particles.h"

#include <math.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"

enum {
  KEY_BITS = 21, /* bits of a key for each axis */
  BUCKET_BITS = 6,
  BUCKETS = 1 << (3 * BUCKET_BITS),
  FEW = 24 /* at most this number of particles are sorted by insertion */
};

typedef struct keyed {
  uint64_t key;   /* Morton code: the bits of x, y and z, interleaved from the highest to the lowest */
  uint32_t index; /* the particle's index in the input */
} keyed;

typedef struct ordering {
  const hl_particle_input *input;
  hl_particle_set *set;
  keyed *items;    /* owned; [set->count] */
  uint32_t *begin; /* owned; [BUCKETS + 1] */
} ordering;

static bool position_of(const hl_particle_input *input, size_t n, double position[3]) {
  for (int a = 0; a < 3; a++)
    position[a] = input->is_double ? ((const double *)input->positions)[3 * n + (size_t)a]
                                   : (double)((const float *)input->positions)[3 * n + (size_t)a];
  return isfinite(position[0]) && isfinite(position[1]) && isfinite(position[2]);
}

static void place_of(const hl_particle_set *set, const double position[3], uint32_t place[3]) {
  for (int a = 0; a < 3; a++) {
    double at = (position[a] - set->low[a]) / set->unit[a];
    if (set->periodic[a]) at -= floor(at / 4294967296.0) * 4294967296.0;
    double most = set->periodic[a] ? 4294967295.0 : 2147483647.0;
    place[a] = (uint32_t)(at < 0 ? 0 : at > most ? most : at);
  }
}

/* Spreads the lowest 21 bits of a number so that two zeros lie between neighbouring bits (the "magic bits" of
 * Morton codes). */
static uint64_t apart(uint64_t x) {
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

static uint64_t key_of(const hl_particle_set *set, const uint32_t place[3]) {
  uint64_t key = 0;
  for (int a = 0; a < 3; a++) {
    uint32_t bits = place[a] >> (set->periodic[a] ? 32 - KEY_BITS : 31 - KEY_BITS);
    key |= apart(bits & ((1u << KEY_BITS) - 1)) << (2 - a);
  }
  return key;
}

/* Counts the particles whose places are finite, and finds the box of the places. The units of the fixed-point
 * coordinates follow from this box. */
static hl_status find_units(const hl_particle_input *input, const char *subject, hl_particle_set *set,
                            hl_error *error) {
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, extent = 0;
  for (size_t n = 0; n < input->count; n++) {
    double position[3];
    if (!position_of(input, n, position)) continue;
    set->count++;
    for (int a = 0; a < 3; a++) low[a] = fmin(low[a], position[a]), high[a] = fmax(high[a], position[a]);
  }
  if (set->count == 0)
    return hl_fail(error, HL_ERROR_INPUT, "%s: no particle has a finite place: give at least one", subject);
  if (set->count > UINT32_MAX / 2)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: %zu particles: at most %u are taken: leave some out",
                   subject, set->count, UINT32_MAX / 2);
  for (int a = 0; a < 3; a++) {
    set->periodic[a] = input->period[a] > 0;
    if (!set->periodic[a]) extent = fmax(extent, high[a] - low[a]);
  }
  if (!(extent <= 1e30))
    return hl_fail(error, HL_ERROR_INPUT, "%s: the particles are %g apart: use another unit of length",
                   subject, extent);
  if (!(extent > 0)) extent = 1;
  for (int a = 0; a < 3; a++) {
    set->low[a] = set->periodic[a] ? input->period_low[a] : low[a];
    set->unit[a] = set->periodic[a] ? input->period[a] / 4294967296.0 : extent / 2147483647.0;
  }
  return HL_OK;
}

/* Counts the particles of each bucket. Then puts each particle's key into its bucket, in the order of the
 * input. */
static hl_status fill_buckets(hl_context *context, ordering *o, const char *subject, hl_error *error) {
  const int shift = 3 * (KEY_BITS - BUCKET_BITS);
  hl_particle_set *set = o->set;
  o->items = hl_allocate(context, set->count, sizeof *o->items);
  o->begin = hl_allocate_zeroed(context, BUCKETS + 2, sizeof *o->begin);
  if (o->items == NULL || o->begin == NULL)
    return hl_fail_memory(error, set->count * sizeof *o->items, subject);
  for (int pass = 0; pass < 2; pass++) {
    for (size_t n = 0; n < o->input->count; n++) {
      double position[3];
      uint32_t place[3];
      if (!position_of(o->input, n, position)) continue;
      place_of(set, position, place);
      uint64_t key = key_of(set, place), bucket = key >> shift;
      if (pass == 0) o->begin[bucket + 2]++;
      else o->items[o->begin[bucket + 1]++] = (keyed){key, (uint32_t)n};
    }
    for (size_t b = 1; pass == 0 && b < BUCKETS + 2; b++) o->begin[b] += o->begin[b - 1];
  }
  return HL_OK;
}

static void sort_few(keyed *items, size_t count) {
  for (size_t n = 1; n < count; n++) {
    keyed item = items[n];
    size_t at = n;
    for (; at > 0 && items[at - 1].key > item.key; at--) items[at] = items[at - 1];
    items[at] = item;
  }
}

/* Sorts into eight parts by three bits of the key, which begin at the bit `shift`, and then sorts each part
 * by the lower bits. The method is American flag sort (P. M. McIlroy, K. Bostic, M. D. McIlroy, Engineering
 * radix sort, 1993). */
static void sort_items(keyed *items, size_t count, int shift) {
  if (count <= FEW || shift < 0) {
    sort_few(items, shift < 0 ? 0 : count);
    return;
  }
  size_t begin[9] = {0}, next[8];
  for (size_t n = 0; n < count; n++) begin[(items[n].key >> shift & 7) + 1]++;
  for (int d = 0; d < 8; d++) begin[d + 1] += begin[d], next[d] = begin[d];
  for (int d = 0; d < 8; d++)
    while (next[d] < begin[d + 1]) {
      keyed item = items[next[d]];
      unsigned digit = item.key >> shift & 7;
      if (digit == (unsigned)d) {
        next[d]++;
        continue;
      }
      items[next[d]] = items[next[digit]];
      items[next[digit]++] = item;
    }
  for (int d = 0; d < 8; d++) sort_items(items + begin[d], begin[d + 1] - begin[d], shift - 3);
}

enum { BUCKETS_AT_ONCE = 512 };

static void order_buckets(void *data, size_t index, int worker) {
  const ordering *o = data;
  (void)worker;
  for (size_t b = index * BUCKETS_AT_ONCE; b < (index + 1) * BUCKETS_AT_ONCE; b++) {
    size_t begin = o->begin[b], end = o->begin[b + 1];
    sort_items(o->items + begin, end - begin, 3 * (KEY_BITS - BUCKET_BITS - 1));
    for (size_t n = begin; n < end; n++) {
      double position[3];
      position_of(o->input, o->items[n].index, position);
      place_of(o->set, position, o->set->place[n]);
      o->set->order[n] = o->items[n].index;
    }
  }
}

static hl_status take_lengths(const hl_particle_input *input, const char *subject, hl_particle_set *set,
                              hl_error *error) {
  for (size_t n = 0; n < set->count; n++) {
    set->length[n] = input->lengths[set->order[n]];
    if (!(set->length[n] > 0) || !isfinite(set->length[n]))
      return hl_fail(
          error, HL_ERROR_INPUT,
          "%s: the smoothing length of particle %u is %g: give a finite number above 0, or none for all",
          subject, set->order[n], (double)set->length[n]);
  }
  return HL_OK;
}

hl_status hl_particles_order(hl_context *context, hl_pool *pool, const hl_particle_input *input,
                             const char *subject, hl_particle_set *set, hl_error *error) {
  *set = (hl_particle_set){0};
  ordering o = {.input = input, .set = set};
  hl_status status = find_units(input, subject, set, error);
  if (status == HL_OK) status = fill_buckets(context, &o, subject, error);
  if (status == HL_OK) {
    set->place = hl_allocate(context, set->count, sizeof *set->place);
    set->order = hl_allocate(context, set->count, sizeof *set->order);
    set->length = hl_allocate(context, set->count, sizeof *set->length);
    if (set->place == NULL || set->order == NULL || set->length == NULL)
      status = hl_fail_memory(error, set->count * sizeof *set->place, subject);
  }
  if (status == HL_OK) hl_pool_run(pool, BUCKETS / BUCKETS_AT_ONCE, order_buckets, &o);
  hl_release(context, o.items);
  hl_release(context, o.begin);
  if (status == HL_OK && hl_pool_cancelled(pool))
    status = hl_fail(error, HL_ERROR_CANCELLED, "%s: stopped", subject);
  if (status != HL_OK) return status;
  return input->lengths != NULL ? take_lengths(input, subject, set, error)
                                : hl_particles_find_lengths(context, pool, subject, set, error);
}

void hl_particles_release(hl_context *context, hl_particle_set *set) {
  hl_release(context, set->place);
  hl_release(context, set->order);
  hl_release(context, set->length);
  *set = (hl_particle_set){0};
}
