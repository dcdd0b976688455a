/* scene/bodies.c - which marked places of a lattice hang together: a flood from each place that is not yet
 * reached. */
#include "scene/bodies.h"

#include <stdbool.h>
#include <string.h>

#include "core/memory.h"

typedef struct flood {
  const unsigned char *marked;
  const int *size;
  uint32_t *body;
  uint32_t *waiting; /* [places]; each place waits once at most */
} flood;

static void reach(flood *f, size_t place, uint32_t body, size_t *end) {
  if (!f->marked[place] || f->body[place] != 0) return;
  f->body[place] = body;
  f->waiting[(*end)++] = (uint32_t)place;
}

static void flood_from(flood *f, size_t start, uint32_t body) {
  const size_t nx = (size_t)f->size[0], ny = (size_t)f->size[1], nz = (size_t)f->size[2];
  size_t end = 0;
  reach(f, start, body, &end);
  for (size_t next = 0; next < end; next++) {
    size_t p = f->waiting[next], x = p % nx, y = p / nx % ny, z = p / nx / ny;
    if (x > 0) reach(f, p - 1, body, &end);
    if (x + 1 < nx) reach(f, p + 1, body, &end);
    if (y > 0) reach(f, p - nx, body, &end);
    if (y + 1 < ny) reach(f, p + nx, body, &end);
    if (z > 0) reach(f, p - nx * ny, body, &end);
    if (z + 1 < nz) reach(f, p + nx * ny, body, &end);
  }
}

static hl_status count_places(hl_context *context, size_t places, hl_bodies *bodies, hl_error *error) {
  bodies->places = hl_allocate_zeroed(context, (size_t)bodies->count + 1, sizeof *bodies->places);
  if (bodies->places == NULL)
    return hl_fail_memory(error, ((size_t)bodies->count + 1) * sizeof *bodies->places, "a volume's bodies");
  for (size_t p = 0; p < places; p++) bodies->places[bodies->body[p]]++;
  bodies->places[0] = 0;
  for (uint32_t b = 1; b <= bodies->count; b++)
    if (bodies->places[b] > bodies->places[bodies->largest]) bodies->largest = b;
  return HL_OK;
}

hl_status hl_bodies_find(hl_context *context, const unsigned char *marked, const int size[3],
                         hl_bodies *bodies, hl_error *error) {
  const size_t places = (size_t)size[0] * (size_t)size[1] * (size_t)size[2];
  *bodies = (hl_bodies){.body = hl_allocate_zeroed(context, places, sizeof *bodies->body)};
  flood f = {marked, size, bodies->body, hl_allocate(context, places, sizeof *f.waiting)};
  hl_status status = HL_OK;
  if (bodies->body == NULL || f.waiting == NULL) {
    status = hl_fail_memory(error, 2 * places * sizeof *f.waiting, "a volume's bodies");
  } else {
    for (size_t p = 0; p < places; p++)
      if (marked[p] && bodies->body[p] == 0) flood_from(&f, p, ++bodies->count);
    status = count_places(context, places, bodies, error);
  }
  hl_release(context, f.waiting);
  return status;
}

void hl_bodies_release(hl_context *context, hl_bodies *bodies) {
  hl_release(context, bodies->body);
  hl_release(context, bodies->places);
  *bodies = (hl_bodies){0};
}
