/* label/shelf.c - see shelf.h. */
#include "label/shelf.h"

#include "core/memory.h"

enum { PLACES = 1024 };

typedef struct place {
  bool used;
  int64_t label;
  hl_volume *made; /* the occupancy that was made of the label; null if no voxel has the label */
} place;

/* A volume that was made of several labels together. */
typedef struct joint_place {
  hl_label *labels; /* owned; [label_count]; the labels of which the volume was made, without their names */
  size_t label_count;
  double rest;     /* for a mask: the factor of matter outside the labels */
  hl_volume *made; /* the volume that was made; null if no volume was made yet */
} joint_place;

typedef struct shelf {
  place places[PLACES];
  int next; /* the place that is filled next, after the volume in it was released */
  joint_place lattice, solids;
} shelf;

static void lock(hl_volume *map) {
  while (atomic_flag_test_and_set_explicit(&map->shelf_lock, memory_order_acquire)) {}
}
static void unlock(hl_volume *map) { atomic_flag_clear_explicit(&map->shelf_lock, memory_order_release); }

static void release_shelf(hl_context *context, void *kept) {
  shelf *shelf = kept;
  for (int n = 0; n < PLACES; n++) hl_volume_release(shelf->places[n].made);
  hl_volume_release(shelf->lattice.made);
  hl_volume_release(shelf->solids.made);
  hl_release(context, shelf->lattice.labels);
  hl_release(context, shelf->solids.labels);
  hl_release(context, shelf);
}

/* Looks on the shelf for a volume that was made of this label before, and retains it. */
static bool find(hl_volume *map, int64_t label, hl_volume **made) {
  bool found = false;
  lock(map);
  const shelf *shelf = map->shelf;
  for (int n = 0; shelf != NULL && n < PLACES && !found; n++) {
    const place *place = &shelf->places[n];
    found = place->used && place->label == label;
    if (found) *made = place->made;
  }
  if (found) hl_volume_retain(*made);
  unlock(map);
  return found;
}

/* The map's shelf, which must be locked; null if memory is short. */
static shelf *shelf_of(hl_volume *map) {
  if (map->shelf == NULL) {
    map->shelf = hl_allocate_zeroed(map->context, 1, sizeof(shelf));
    map->release_shelf = release_shelf;
  }
  return map->shelf;
}

/* Keeps a volume that was made. If memory is short, the volume is not kept. */
static void keep(hl_volume *map, int64_t label, hl_volume *made) {
  hl_volume *old = made;
  hl_volume_retain(made);
  lock(map);
  shelf *shelf = shelf_of(map);
  if (shelf != NULL) {
    old = shelf->places[shelf->next].made;
    shelf->places[shelf->next] = (place){true, label, made};
    shelf->next = (shelf->next + 1) % PLACES;
  }
  unlock(map);
  hl_volume_release(old);
}

/* The labels of a list whose occupancies are not on the shelf yet. */
typedef struct missing_labels {
  int64_t *labels;      /* owned; [count]; the missing labels, rising */
  size_t *places;       /* owned; the labels' places in the caller's list */
  hl_label_part *parts; /* owned; [count]; the part of the map's grid that holds each label */
  size_t count;
} missing_labels;

static void release_missing(hl_context *context, missing_labels *missing) {
  hl_release(context, missing->labels);
  hl_release(context, missing->places);
  hl_release(context, missing->parts);
}

static hl_status make_missing(hl_context *context, int threads, hl_volume *map, missing_labels *missing,
                              hl_label_work *work, hl_volume **made, hl_error *error) {
  hl_label_work own_work = {.context = context};
  hl_pool *pool = NULL;
  hl_status status = hl_pool_create(context, threads, &pool, error);
  if (status != HL_OK) return status;
  status = hl_label_parts(context, pool, map, missing->labels, missing->count, missing->parts, error);
  for (size_t n = 0; n < missing->count && status == HL_OK; n++)
    own_work.whole += (double)hl_label_part_voxels(&missing->parts[n]);
  for (size_t n = 0; n < missing->count && status == HL_OK; n++) {
    hl_volume **own = &made[missing->places[n]];
    status = hl_label_occupancy(map->context, pool, map, &missing->labels[n], 1, &missing->parts[n],
                                work != NULL ? work : &own_work, own, error);
    if (status == HL_OK) keep(map, missing->labels[n], *own);
  }
  hl_pool_destroy(pool);
  return status;
}

hl_status hl_label_occupancies(hl_context *context, int threads, hl_volume *map, const int64_t *labels,
                               size_t count, hl_label_work *work, hl_volume **made, hl_error *error) {
  missing_labels missing = {hl_allocate(context, count, sizeof *missing.labels),
                            hl_allocate(context, count, sizeof *missing.places),
                            hl_allocate(context, count, sizeof *missing.parts), 0};
  hl_status status = HL_OK;
  for (size_t n = 0; n < count; n++) made[n] = NULL;
  if (missing.labels == NULL || missing.places == NULL || missing.parts == NULL)
    status = hl_fail_memory(error, count * sizeof *missing.parts, "labels");
  for (size_t n = 0; n < count && status == HL_OK; n++) {
    if (find(map, labels[n], &made[n])) {
      if (work != NULL && made[n] != NULL)
        hl_label_worked(work, hl_volume_voxel_count(made[n]), HL_LABEL_STEPS);
      continue;
    }
    missing.labels[missing.count] = labels[n];
    missing.places[missing.count++] = n;
  }
  if (missing.count > 0) status = make_missing(context, threads, map, &missing, work, made, error);
  for (size_t n = 0; n < count && status != HL_OK; n++) {
    hl_volume_release(made[n]);
    made[n] = NULL;
  }
  release_missing(context, &missing);
  return status;
}

/* ---- several labels together ---- */

static bool same_label(const hl_label *a, const hl_label *b) {
  for (int c = 0; c < 3; c++)
    if (a->color[c] != b->color[c]) return false;
  return a->value == b->value && a->opacity == b->opacity && a->visible == b->visible && a->tint == b->tint;
}

/* Retains the volume of a place if it was made of these labels. The map's shelf is locked. */
static hl_volume *find_joint(const joint_place *place, const hl_label *labels, size_t count, double rest) {
  bool same = place->made != NULL && place->rest == rest && place->label_count == count;
  for (size_t n = 0; same && n < count; n++) same = same_label(&place->labels[n], &labels[n]);
  if (!same) return NULL;
  hl_volume_retain(place->made);
  return place->made;
}

static hl_volume *from_shelf(hl_volume *map, bool of_solids, const hl_label *labels, size_t count,
                             double rest) {
  lock(map);
  const shelf *shelf = map->shelf;
  hl_volume *found = NULL;
  if (shelf != NULL) found = find_joint(of_solids ? &shelf->solids : &shelf->lattice, labels, count, rest);
  unlock(map);
  return found;
}

static void to_shelf(hl_volume *map, bool of_solids, const hl_label *labels, size_t count, double rest,
                     hl_volume *made) {
  hl_label *copy = hl_allocate(map->context, count, sizeof *copy);
  if (copy == NULL) return;
  for (size_t n = 0; n < count; n++) {
    copy[n] = labels[n];
    copy[n].name = NULL;
  }
  joint_place old = {.labels = copy};
  lock(map);
  shelf *shelf = shelf_of(map);
  if (shelf != NULL) {
    joint_place *place = of_solids ? &shelf->solids : &shelf->lattice;
    hl_volume_retain(made);
    old = *place;
    *place = (joint_place){copy, count, rest, made};
  }
  unlock(map);
  hl_volume_release(old.made);
  hl_release(map->context, old.labels);
}

hl_volume *hl_mask_from_shelf(const hl_mask *mask) {
  return from_shelf(mask->volume, false, mask->labels, mask->label_count, mask->rest);
}

void hl_mask_to_shelf(const hl_mask *mask, hl_volume *made) {
  to_shelf(mask->volume, false, mask->labels, mask->label_count, mask->rest, made);
}

hl_volume *hl_solids_from_shelf(hl_volume *map, const hl_label *labels, size_t count) {
  return from_shelf(map, true, labels, count, 0);
}

void hl_solids_to_shelf(hl_volume *map, const hl_label *labels, size_t count, hl_volume *made) {
  to_shelf(map, true, labels, count, 0, made);
}
