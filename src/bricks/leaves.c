/* bricks/leaves.c - hl_bricks_choose(): lists leaves by a descent from the coarsest bricks.
 *
 * In: a function that tells whether a brick is left out, is a leaf, or is split. Out: a list for
 * hl_bricks_build(). */
#include "bricks/build.h"
#include "core/context.h"
#include "core/memory.h"

typedef struct descent {
  hl_context *context;
  const hl_bricks_source *source;
  hl_bricks_choice (*choose)(void *data, int level, const size_t brick[3]);
  void *data;
  const char *subject;
  hl_bricks_leaf *leaves; /* owned; [room] */
  size_t count, room;
  size_t visited; /* bricks that the descent has visited */
  size_t most;    /* the number of leaves whose coefficients fit into the memory limit */
  hl_error *error;
} descent;

static hl_status add_leaf(descent *d, int level, const size_t brick[3]) {
  if (d->count == d->most)
    return hl_fail_memory(d->error, (d->count + 1) * brick_points(d->source->shift) * sizeof(float),
                          d->subject);
  if (d->count == d->room) {
    size_t room = 2 * d->room + 64;
    hl_bricks_leaf *grown = hl_reallocate(d->context, d->leaves, room, sizeof *grown);
    if (grown == NULL) return hl_fail_memory(d->error, room * sizeof *grown, d->subject);
    d->leaves = grown;
    d->room = room;
  }
  d->leaves[d->count++] = (hl_bricks_leaf){level, {brick[0], brick[1], brick[2]}};
  return HL_OK;
}

/* The number of bricks of a level that are needed along an axis to hold all lattice points. */
static size_t bricks_along(const hl_bricks_source *source, int level, int axis) {
  return ((source->dimension[axis] - 1) >> (source->shift + level)) + 1;
}

static hl_status descend(descent *d, int level, const size_t brick[3]) {
  enum { BRICKS_AT_ONCE = 1024 }; /* number of bricks between two checks for cancellation */
  if (d->visited++ % BRICKS_AT_ONCE == 0 && hl_cancelled(d->context))
    return hl_fail(d->error, HL_ERROR_CANCELLED, "%s: cancelled", d->subject);
  for (int axis = 0; axis < 3; axis++)
    if (brick[axis] >= bricks_along(d->source, level, axis)) return HL_OK;
  hl_bricks_choice choice = d->choose(d->data, level, brick);
  if (choice == HL_BRICKS_NOTHING) return HL_OK;
  if (choice == HL_BRICKS_LEAF || level == 0) return add_leaf(d, level, brick);
  hl_status status = HL_OK;
  for (size_t child = 0; child < 8 && status == HL_OK; child++) {
    const size_t at[3] = {2 * brick[0] + (child & 1), 2 * brick[1] + (child >> 1 & 1),
                          2 * brick[2] + (child >> 2)};
    status = descend(d, level - 1, at);
  }
  return status;
}

/* Refuses a field whose directory is larger than the memory limit, before the descent, which would visit each
 * of its coarsest bricks. */
static hl_status check_directory(hl_context *context, const hl_bricks_source *source, const char *subject,
                                 hl_error *error) {
  const uint64_t limit = context->options.memory_limit;
  size_t bytes = sizeof(hl_brick_entry);
  bool fits = true;
  for (int axis = 0; axis < 3; axis++)
    fits = fits && hl_multiply(bytes, bricks_along(source, 0, axis), &bytes);
  if (fits && (limit == 0 || bytes <= limit)) return HL_OK;
  return hl_fail_memory(error, fits ? bytes : SIZE_MAX, subject);
}

hl_status hl_bricks_choose(hl_context *context, const hl_bricks_source *source,
                           hl_bricks_choice (*choose)(void *data, int level, const size_t brick[3]),
                           void *data, const char *subject, hl_bricks_leaf **leaves, size_t *count,
                           hl_error *error) {
  descent d = {.context = context,
               .source = source,
               .choose = choose,
               .data = data,
               .subject = subject,
               .error = error};
  const uint64_t limit = context->options.memory_limit;
  int level = source->levels - 1;
  d.most = limit > 0 ? (size_t)(limit / (brick_points(source->shift) * sizeof(float))) : SIZE_MAX;
  hl_status status = check_directory(context, source, subject, error);
  size_t b[3];
  *leaves = NULL;
  *count = 0;
  for (b[2] = 0; status == HL_OK && b[2] < bricks_along(source, level, 2); b[2]++)
    for (b[1] = 0; status == HL_OK && b[1] < bricks_along(source, level, 1); b[1]++)
      for (b[0] = 0; status == HL_OK && b[0] < bricks_along(source, level, 0); b[0]++)
        status = descend(&d, level, b);
  if (status != HL_OK) {
    hl_release(context, d.leaves);
    return status;
  }
  *leaves = d.leaves;
  *count = d.count;
  return HL_OK;
}
