/* particles/subdivide.c - the coefficients of a spline on a lattice of half the spacing.
 *
 * Along each axis the even points get (d[j-1] + 6 d[j] + d[j+1]) / 8 and the odd ones (d[j] + d[j+1]) / 2:
 * the two-scale relation of the cubic B-spline. There are no points beyond the outermost ones. Points
 * beyond would have received 5/8 of the outermost coefficient. The outermost point receives this part, so
 * that no weight is lost (derived). */
#include "particles/particles.h"

#include "core/memory.h"

typedef struct subdividing {
  const hl_particle_level *coarse, *fine;
  float *room; /* owned; a coarse slice and a row for each worker */
} subdividing;

/* The coarse coefficients whose weighted sum is a fine coefficient. */
typedef struct taps {
  size_t index[3];
  float weight[3];
} taps;

static taps taps_of(size_t i, size_t coarse, bool periodic) {
  size_t j = i / 2, last = coarse - 1;
  if (i % 2 == 1) {
    size_t next = j < last ? j + 1 : periodic ? 0 : last;
    return (taps){{j, next, j}, {0.5f, 0.5f, 0}};
  }
  taps t = {{j > 0 ? j - 1 : last, j, j < last ? j + 1 : 0}, {0.125f, 0.75f, 0.125f}};
  if (periodic) return t;
  if (j == 0) t.index[0] = 0, t.weight[0] = 0, t.weight[1] += 0.625f;
  if (j == last) t.index[2] = last, t.weight[2] = 0, t.weight[1] += 0.625f;
  return t;
}

static void subdivide_slice(void *data, size_t z, int worker) {
  const subdividing *s = data;
  const size_t *from = s->coarse->points, *to = s->fine->points;
  size_t slice = from[0] * from[1];
  float *plane = s->room + (size_t)worker * (slice + from[0]), *line = plane + slice;
  taps tz = taps_of(z, from[2], s->coarse->periodic[2]);
  const float *d = s->coarse->field;
  for (size_t n = 0; n < slice; n++)
    plane[n] = tz.weight[0] * d[tz.index[0] * slice + n] + tz.weight[1] * d[tz.index[1] * slice + n] +
               tz.weight[2] * d[tz.index[2] * slice + n];
  for (size_t y = 0; y < to[1]; y++) {
    taps ty = taps_of(y, from[1], s->coarse->periodic[1]);
    float *row = s->fine->field + (z * to[1] + y) * to[0];
    for (size_t n = 0; n < from[0]; n++)
      line[n] = ty.weight[0] * plane[ty.index[0] * from[0] + n] +
                ty.weight[1] * plane[ty.index[1] * from[0] + n] +
                ty.weight[2] * plane[ty.index[2] * from[0] + n];
    for (size_t x = 0; x < to[0]; x++) {
      taps tx = taps_of(x, from[0], s->coarse->periodic[0]);
      row[x] += tx.weight[0] * line[tx.index[0]] + tx.weight[1] * line[tx.index[1]] +
                tx.weight[2] * line[tx.index[2]];
    }
  }
}

hl_status hl_particles_subdivide(hl_context *context, hl_pool *pool, const hl_particle_level *coarse,
                                 const hl_particle_level *fine, const char *subject, hl_error *error) {
  subdividing s = {.coarse = coarse, .fine = fine};
  size_t room = (size_t)hl_pool_threads(pool) * coarse->points[0] * (coarse->points[1] + 1);
  s.room = hl_allocate(context, room, sizeof *s.room);
  if (s.room == NULL) return hl_fail_memory(error, room * sizeof *s.room, subject);
  hl_pool_run(pool, fine->points[2], subdivide_slice, &s);
  hl_release(context, s.room);
  return hl_pool_cancelled(pool) ? hl_fail(error, HL_ERROR_CANCELLED, "%s: stopped", subject) : HL_OK;
}
