/* volume/scraps.c - see scraps.h. Bodies are assembled from runs. A run is a sequence of neighbouring firm
 * voxels in a row. */
#include "volume/scraps.h"

#include <math.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"

/* The greatest distance, in steps from voxel to voxel, of faint matter from the body to which the matter
 * belongs. The faint rim of a body is two or three voxels thick. */
enum { REACH = 4 };

/* The marks of voxels. A faint voxel that belongs to a body has the mark KEPT + n, where n is the number of
 * steps from the body. */
enum { UNSEEN = 0, FAINT = 1, FIRM = 2, KEPT = 3 };

typedef struct run {
  uint32_t first, end; /* the run's voxels in its row: first .. end - 1 */
  uint32_t body;       /* the index of another run of the same body; in a body's first run, the run's own
                        * index */
  uint64_t voxels;     /* number of voxels of the whole body; set only in the body's first run */
} run;

typedef struct hl_kept_scraps {
  hl_scraps_rule rule;
  hl_scraps scraps;
} hl_kept_scraps;

typedef struct search {
  const hl_volume *volume;
  bool above;           /* whether matter has greater stored values than its surroundings */
  float faint, firm;    /* stored values */
  unsigned char *mark;  /* owned; [k][j][i] */
  run *runs;            /* owned; [run_count] */
  size_t *first_of_row; /* owned; [rows + 1]; the index of each row's first run */
  size_t run_count, room;
} search;

/* ---- marks ---- */

/* Marks the voxels of a row. If matter has lower values than its surroundings, negated values are
 * compared. */
#define MARK(type)                                               \
  for (size_t i = 0; i < count; i++) {                           \
    const float value = side * (float)((const type *)row)[i];    \
    mark[i] = (unsigned char)((value > faint) + (value > firm)); \
  }

static void mark_row(const search *s, const void *restrict row, size_t count, unsigned char *restrict mark) {
  const float side = s->above ? 1 : -1, faint = side * s->faint, firm = side * s->firm;
  switch (s->volume->storage) {
    case HL_STORAGE_U8: MARK(uint8_t) break;
    case HL_STORAGE_U16: MARK(uint16_t) break;
    case HL_STORAGE_F32: MARK(float) break;
  }
}

/* ---- bodies ---- */

static uint32_t body_of(run *runs, uint32_t n) {
  while (runs[n].body != n) n = runs[n].body = runs[runs[n].body].body;
  return n;
}

/* Joins the bodies of runs in two neighbouring rows that touch each other. */
static void join(search *s, size_t row, size_t other) {
  uint32_t a = (uint32_t)s->first_of_row[row], b = (uint32_t)s->first_of_row[other];
  const uint32_t end = (uint32_t)s->run_count, other_end = (uint32_t)s->first_of_row[other + 1];
  while (a < end && b < other_end) {
    const run *one = &s->runs[a], *two = &s->runs[b];
    if (one->first < two->end && two->first < one->end) {
      const uint32_t x = body_of(s->runs, a), y = body_of(s->runs, b);
      s->runs[x > y ? x : y].body = x < y ? x : y;
    }
    if (one->end < two->end) a++;
    else b++;
  }
}

static hl_status add_run(search *s, size_t first, size_t end, hl_error *error) {
  if (s->run_count == s->room) {
    const size_t room = 2 * s->room + 1024;
    run *more = room < UINT32_MAX ? hl_reallocate(s->volume->context, s->runs, room, sizeof *more) : NULL;
    if (more == NULL) return hl_fail_memory(error, room * sizeof *more, "the bodies of a volume");
    s->runs = more;
    s->room = room;
  }
  const uint32_t n = (uint32_t)s->run_count++;
  s->runs[n] = (run){(uint32_t)first, (uint32_t)end, n, 0};
  return HL_OK;
}

static hl_status find_runs_of_row(search *s, const unsigned char *mark, hl_error *error) {
  const size_t count = s->volume->dimension[0];
  hl_status status = HL_OK;
  for (size_t i = 0; i < count && status == HL_OK;) {
    const unsigned char *found = memchr(mark + i, FIRM, count - i);
    if (found == NULL) break;
    const size_t first = (size_t)(found - mark);
    for (i = first; i < count && mark[i] == FIRM; i++) {}
    status = add_run(s, first, i, error);
  }
  return status;
}

static hl_status find_runs(search *s, hl_error *error) {
  const size_t *n = s->volume->dimension;
  hl_status status = HL_OK;
  for (size_t k = 0, row = 0; k < n[2] && status == HL_OK; k++) {
    if (hl_cancelled(s->volume->context))
      return hl_fail(error, HL_ERROR_CANCELLED, "cancelled while the bodies of a volume were found");
    for (size_t j = 0; j < n[1] && status == HL_OK; j++, row++) {
      unsigned char *mark = s->mark + row * n[0];
      s->first_of_row[row] = s->run_count;
      mark_row(s, hl_volume_row(s->volume, j, k), n[0], mark);
      status = find_runs_of_row(s, mark, error);
      if (status == HL_OK && j > 0) join(s, row, row - 1);
      if (status == HL_OK && k > 0) join(s, row, row - n[1]);
      s->first_of_row[row + 1] = s->run_count;
    }
  }
  return status;
}

/* Marks the voxels of bodies that are not hidden, and sets in *scraps the number and the share of hidden
 * bodies. */
static void keep_bodies(search *s, double least, hl_scraps *scraps) {
  const size_t *n = s->volume->dimension;
  uint64_t most = 0, all = 0, hidden = 0;
  for (uint32_t r = 0; r < s->run_count; r++) {
    run *body = &s->runs[body_of(s->runs, r)];
    body->voxels += s->runs[r].end - s->runs[r].first;
    most = body->voxels > most ? body->voxels : most;
  }
  const double limit = least * (double)most;
  for (uint32_t r = 0; r < s->run_count; r++) {
    if (s->runs[r].body != r) continue;
    all += s->runs[r].voxels;
    if ((double)s->runs[r].voxels >= limit) continue;
    scraps->bodies++;
    hidden += s->runs[r].voxels;
  }
  scraps->share = all > 0 ? (double)hidden / (double)all : 0;
  for (size_t row = 0; row < n[1] * n[2]; row++)
    for (size_t r = s->first_of_row[row]; r < s->first_of_row[row + 1]; r++)
      if ((double)s->runs[body_of(s->runs, (uint32_t)r)].voxels >= limit)
        memset(s->mark + row * n[0] + s->runs[r].first, KEPT, s->runs[r].end - s->runs[r].first);
}

/* ---- faint matter ---- */

/* Returns whether a neighbour of voxel i of a row has a mark. */
static bool has_neighbour(const search *s, size_t j, size_t k, size_t i, unsigned char mark) {
  const size_t *n = s->volume->dimension, slice = n[0] * n[1];
  const unsigned char *at = s->mark + k * slice + j * n[0] + i;
  return (i > 0 && at[-1] == mark) || (i + 1 < n[0] && at[1] == mark) || (j > 0 && *(at - n[0]) == mark) ||
         (j + 1 < n[1] && at[n[0]] == mark) || (k > 0 && *(at - slice) == mark) ||
         (k + 1 < n[2] && at[slice] == mark);
}

/* Marks faint voxels beside voxels with the mark `mark` as one step further from the body. */
static void reach_on(search *s, unsigned char mark) {
  const size_t *n = s->volume->dimension;
  for (size_t k = 0; k < n[2]; k++)
    for (size_t j = 0; j < n[1]; j++) {
      unsigned char *row = s->mark + (k * n[1] + j) * n[0], *end = row + n[0], *at = row;
      for (; (at = memchr(at, FAINT, (size_t)(end - at))) != NULL; at++)
        if (has_neighbour(s, j, k, (size_t)(at - row), mark)) *at = (unsigned char)(mark + 1);
    }
}

/* ---- the volume without its scraps ---- */

#define HIDE(type)                   \
  for (size_t i = 0; i < count; i++) \
    if (mark[i] == FAINT || mark[i] == FIRM) ((type *)row)[i] = (type)value;

static void hide_in_row(hl_storage storage, const unsigned char *mark, size_t count, float value, void *row) {
  switch (storage) {
    case HL_STORAGE_U8: HIDE(uint8_t) break;
    case HL_STORAGE_U16: HIDE(uint16_t) break;
    case HL_STORAGE_F32: HIDE(float) break;
  }
}

static hl_status make_volume(const search *s, hl_volume **made, hl_error *error) {
  static const hl_voxel_type types[] = {
      [HL_STORAGE_U8] = HL_VOXEL_U8, [HL_STORAGE_U16] = HL_VOXEL_U16, [HL_STORAGE_F32] = HL_VOXEL_F32};
  const hl_volume *volume = s->volume;
  const size_t *n = volume->dimension, row_bytes = n[0] * hl_storage_bytes(volume->storage);
  /* the value `faint` is rounded to a whole number in the direction in which matter is not seen */
  const float value = volume->storage == HL_STORAGE_F32 ? s->faint
                      : s->above                        ? fmaxf(floorf(s->faint), 0)
                                                        : ceilf(s->faint);
  unsigned char *voxels = hl_allocate(volume->context, n[1] * n[2], row_bytes);
  if (voxels == NULL) return hl_fail_memory(error, n[1] * n[2] * row_bytes, "a volume without its scraps");
  for (size_t k = 0, row = 0; k < n[2]; k++)
    for (size_t j = 0; j < n[1]; j++, row++) {
      memcpy(voxels + row * row_bytes, hl_volume_row(volume, j, k), row_bytes);
      hide_in_row(volume->storage, s->mark + row * n[0], n[0], value, voxels + row * row_bytes);
    }
  hl_volume_description grid = hl_volume_own_grid(volume);
  grid.type = types[volume->storage];
  grid.value_scale = volume->value_scale;
  grid.value_offset = volume->value_offset;
  hl_status status = hl_volume_adopt(volume->context, &grid, "voxels without scraps", voxels, made, error);
  if (status == HL_OK) status = hl_volume_take_about(*made, volume, error);
  if (status == HL_OK) return HL_OK;
  hl_volume_release(*made);
  *made = NULL;
  return status;
}

static hl_status find_scraps(const hl_volume *volume, const hl_scraps_rule *rule, hl_scraps *scraps,
                             hl_error *error) {
  hl_context *context = volume->context;
  const size_t voxels = hl_volume_voxel_count(volume), rows = volume->dimension[1] * volume->dimension[2];
  search s = {.volume = volume,
              .above = (rule->firm >= rule->faint) == (volume->value_scale > 0),
              .faint = (float)((rule->faint - volume->value_offset) / volume->value_scale),
              .firm = (float)((rule->firm - volume->value_offset) / volume->value_scale),
              .mark = hl_allocate(context, voxels, 1),
              .first_of_row = hl_allocate(context, rows + 1, sizeof *s.first_of_row)};
  hl_status status = s.mark != NULL && s.first_of_row != NULL
                         ? HL_OK
                         : hl_fail_memory(error, voxels, "the bodies of a volume");
  if (status == HL_OK) status = find_runs(&s, error);
  if (status == HL_OK) keep_bodies(&s, rule->least, scraps);
  if (status == HL_OK && scraps->bodies > 0) {
    for (int step = 0; step < REACH; step++) reach_on(&s, (unsigned char)(KEPT + step));
    status = make_volume(&s, &scraps->volume, error);
  }
  hl_release(context, s.runs);
  hl_release(context, s.first_of_row);
  hl_release(context, s.mark);
  return status;
}

/* ---- results that volumes keep ---- */

static void lock(hl_volume *volume) {
  while (atomic_flag_test_and_set_explicit(&volume->shelf_lock, memory_order_acquire)) {}
}
static void unlock(hl_volume *volume) {
  atomic_flag_clear_explicit(&volume->shelf_lock, memory_order_release);
}

static bool take_kept(hl_volume *volume, const hl_scraps_rule *rule, hl_scraps *scraps) {
  lock(volume);
  const hl_kept_scraps *kept = volume->scraps;
  const bool found = kept != NULL && kept->rule.faint == rule->faint && kept->rule.firm == rule->firm &&
                     kept->rule.least == rule->least;
  if (found) *scraps = kept->scraps;
  if (found && scraps->volume != NULL) hl_volume_retain(scraps->volume);
  unlock(volume);
  return found;
}

static void release(hl_context *context, hl_kept_scraps *kept) {
  if (kept != NULL) hl_volume_release(kept->scraps.volume);
  hl_release(context, kept);
}

/* Stores a result in the volume, and releases an earlier result. */
static hl_status keep(hl_volume *volume, const hl_scraps_rule *rule, const hl_scraps *scraps,
                      hl_error *error) {
  hl_kept_scraps *made = hl_allocate(volume->context, 1, sizeof *made);
  if (made == NULL) return hl_fail_memory(error, sizeof *made, "the bodies of a volume");
  *made = (hl_kept_scraps){*rule, *scraps};
  if (made->scraps.volume != NULL) hl_volume_retain(made->scraps.volume);
  lock(volume);
  hl_kept_scraps *earlier = volume->scraps;
  volume->scraps = made;
  unlock(volume);
  release(volume->context, earlier);
  return HL_OK;
}

/* ---- doors of this file ---- */

bool hl_scraps_apply(const hl_volume *volume) {
  return volume->voxels != NULL && volume->pages == NULL && volume->bricks == NULL &&
         volume->colors == NULL && volume->wall == NULL;
}

uint64_t hl_scraps_bytes(const hl_volume *volume) {
  return (uint64_t)hl_volume_voxel_count(volume) * (1 + hl_storage_bytes(volume->storage));
}

void hl_scraps_release_kept(hl_volume *volume) {
  release(volume->context, volume->scraps);
  volume->scraps = NULL;
}

hl_status hl_scraps_hide(hl_volume *volume, const hl_scraps_rule *rule, hl_scraps *scraps, hl_error *error) {
  *scraps = (hl_scraps){0};
  if (take_kept(volume, rule, scraps)) return HL_OK;
  hl_status status = find_scraps(volume, rule, scraps, error);
  if (status == HL_OK) status = keep(volume, rule, scraps, error);
  if (status == HL_OK) return HL_OK;
  hl_volume_release(scraps->volume);
  scraps->volume = NULL;
  return status;
}
