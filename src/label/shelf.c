/* label/shelf.c - see shelf.h. */
#include "label/shelf.h"

#include <string.h>

#include "core/memory.h"

enum { PLACES = 1024 };

typedef struct place {
  double *labels; /* owned; [count]; null: the place is free */
  size_t count;
  hl_volume *made; /* null: no voxel has one of the labels */
} place;

typedef struct shelf {
  place places[PLACES];
  int next; /* the place that is filled next; what it held goes */
} shelf;

static void lock(hl_volume *map) {
  while (atomic_flag_test_and_set_explicit(&map->shelf_lock, memory_order_acquire)) {}
}
static void unlock(hl_volume *map) { atomic_flag_clear_explicit(&map->shelf_lock, memory_order_release); }

static void clear_place(hl_context *context, place *place) {
  hl_release(context, place->labels);
  hl_volume_release(place->made);
  *place = (struct place){0};
}

static void release_shelf(hl_context *context, void *kept) {
  shelf *shelf = kept;
  for (int n = 0; n < PLACES; n++) clear_place(context, &shelf->places[n]);
  hl_release(context, shelf);
}

/* Finds what was made of these labels before, and retains it. */
static bool find(hl_volume *map, hl_label_values labels, hl_volume **made) {
  bool found = false;
  lock(map);
  const shelf *shelf = map->shelf;
  for (int n = 0; shelf != NULL && n < PLACES && !found; n++) {
    const place *place = &shelf->places[n];
    found = place->labels != NULL && place->count == labels.count &&
            memcmp(place->labels, labels.values, labels.count * sizeof *place->labels) == 0;
    if (found) *made = place->made;
  }
  if (found) hl_volume_retain(*made);
  unlock(map);
  return found;
}

/* Keeps what was made. Without memory it is not kept. */
static void keep(hl_volume *map, hl_label_values labels, hl_volume *made) {
  place old = {0},
        fresh = {hl_allocate(map->context, labels.count, sizeof *fresh.labels), labels.count, made};
  if (fresh.labels == NULL) return;
  memcpy(fresh.labels, labels.values, labels.count * sizeof *fresh.labels);
  hl_volume_retain(made);
  lock(map);
  if (map->shelf == NULL) {
    map->shelf = hl_allocate_zeroed(map->context, 1, sizeof(shelf));
    map->release_shelf = release_shelf;
  }
  shelf *shelf = map->shelf;
  if (shelf == NULL) {
    old = fresh;
  } else {
    old = shelf->places[shelf->next];
    shelf->places[shelf->next] = fresh;
    shelf->next = (shelf->next + 1) % PLACES;
  }
  unlock(map);
  clear_place(map->context, &old);
}

hl_status hl_label_occupancy_of(hl_context *context, int threads, hl_volume *map, hl_label_values labels,
                                hl_volume **made, hl_error *error) {
  *made = NULL;
  if (find(map, labels, made)) return HL_OK;
  hl_pool *pool = NULL;
  hl_status status = hl_pool_create(context, threads, &pool, error);
  if (status == HL_OK) status = hl_label_occupancy(map->context, pool, map, labels, made, error);
  hl_pool_destroy(pool);
  if (status == HL_OK) keep(map, labels, *made);
  return status;
}
