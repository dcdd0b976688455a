/* grid/faces.c - see faces.h. */
#include "grid/faces.h"

#include <math.h>
#include <string.h>

#include "grid/field.h"
#include "grid/relevant.h"

/* The two axes along a face of a box whose normal is `axis`. */
static int row_axis(int axis) { return axis == 0 ? 1 : 0; }
static int column_axis(int axis) { return axis == 2 ? 1 : 2; }

typedef struct face_job {
  const grid *grid;
  const kernel *kernel;
  const classifier *classifier;
  int axis;
  int32_t last_cell; /* the last cell of the grid along the axis */
  field_taps across; /* the four voxels on which the field depends across the face, and their weights */
  int visible;       /* whether some point of the face is visible */
} face_job;

/* The value of the volume's field at a point of the face. */
static float value_at(const face_job *job, const field_taps *column, const field_taps *row) {
  static const int step[3] = {1, FIELD_TAPS, FIELD_TAPS * FIELD_TAPS};
  const int u = row_axis(job->axis), v = column_axis(job->axis);
  int32_t first[3];
  double voxels[FIELD_TAPS * FIELD_TAPS * FIELD_TAPS], sum = 0;
  first[job->axis] = job->across.first, first[v] = column->first, first[u] = row->first;
  hl_field_window(job->grid, first, (const int32_t[3]){FIELD_TAPS, FIELD_TAPS, FIELD_TAPS}, voxels);
  for (int n = 0; n < FIELD_TAPS * FIELD_TAPS * FIELD_TAPS; n++) {
    const int a = n / (FIELD_TAPS * FIELD_TAPS), b = n / FIELD_TAPS % FIELD_TAPS, c = n % FIELD_TAPS;
    sum += job->across.weight[a] * column->weight[b] * row->weight[c] *
           voxels[a * step[job->axis] + b * step[v] + c * step[u]];
  }
  return (float)sum;
}

/* Returns whether the brick that holds a point of the face may be visible. row, column: the coordinates of
 * the point on the face, in voxels. */
static bool may_be_visible(const face_job *job, int32_t row, int32_t column) {
  int32_t at[3];
  /* the lower voxel of the cell that holds the point; a point at the end of the last cell belongs to the last
   * cell */
  at[job->axis] = job->across.first + 1 < job->last_cell ? job->across.first + 1 : job->last_cell;
  at[row_axis(job->axis)] = row;
  at[column_axis(job->axis)] = column;
  for (int a = 0; a < 3; a++) at[a] = (at[a] + 1) / HL_BRICK_CELLS;
  return job->grid->relevant[hl_brick_index(job->grid, at)] != 0;
}

static void look_along_row(void *data, size_t column, int worker) {
  (void)worker;
  face_job *job = data;
  const field_taps columns = hl_field_taps(job->kernel, (double)column);
  for (int32_t n = 0; n < job->grid->dimension[row_axis(job->axis)]; n++) {
    if (__atomic_load_n(&job->visible, __ATOMIC_RELAXED)) return;
    if (!may_be_visible(job, n, (int32_t)column)) continue;
    const field_taps rows = hl_field_taps(job->kernel, n);
    const float value = value_at(job, &columns, &rows);
    if (hl_classifier_span_visible(job->classifier, job->grid, value, value))
      __atomic_store_n(&job->visible, 1, __ATOMIC_RELAXED);
  }
}

void hl_faces_find(hl_pool *pool, const kernel *kernel, const classifier *classifier, grid *grid) {
  for (int axis = 0; axis < 3; axis++)
    for (int high = 0; high < 2; high++) {
      const float face = high ? grid->face_high[axis] : grid->face_low[axis];
      grid->face_shows[axis][high] = false;
      if (fabsf(face) >= FACE_FAR_OUT) continue;
      face_job job = {.grid = grid,
                      .kernel = kernel,
                      .classifier = classifier,
                      .axis = axis,
                      .last_cell = grid->dimension[axis] - 1,
                      .across = hl_field_taps(kernel, (double)face)};
      hl_pool_run(pool, (size_t)grid->dimension[column_axis(axis)], look_along_row, &job);
      grid->face_shows[axis][high] = job.visible != 0;
    }
}
