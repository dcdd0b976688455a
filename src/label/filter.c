/* label/filter.c - see filter.h. */
#include "label/filter.h"

#include <string.h>

enum { REACH = HL_FILTER_REACH };

typedef struct filter_job {
  const label_field *field;
  const label_filter *filter;
} filter_job;

size_t hl_label_line_floats(const size_t size[3]) {
  return (HL_FILTER_ROWS + size[2]) * (size[0] + 2 * REACH);
}

static void add_rows(const filter_job *job, const float *const rows[HL_FILTER_ROWS], float *out) {
  job->field->functions->weigh(job->filter->taps, job->filter->reach, rows, job->field->size[0], out);
}

/* Filters a row along x. line: working space for the row and REACH more values on either side. */
static void filter_row(const filter_job *job, float *line, float *row) {
  const size_t nx = job->field->size[0];
  const float *rows[HL_FILTER_ROWS];
  memcpy(line + REACH, row, nx * sizeof *row);
  for (size_t i = 0; i < REACH; i++) line[i] = row[0], line[REACH + nx + i] = row[nx - 1];
  for (size_t r = 0; r < HL_FILTER_ROWS; r++) rows[r] = line + r;
  add_rows(job, rows, row);
}

/* Filters a slice along x and y. */
static void filter_slice(void *data, size_t z, int worker) {
  const filter_job *job = data;
  const label_field *field = job->field;
  const size_t nx = field->size[0], ny = field->size[1];
  float *slice = field->values + z * nx * ny, *kept = field->lines + (size_t)worker * field->line_floats;
  for (size_t y = 0; y < ny; y++) filter_row(job, kept, slice + y * nx);
  /* loads the rows y - REACH to y + REACH with their unfiltered values, [HL_FILTER_ROWS][nx] */
  for (size_t r = 0; r < HL_FILTER_ROWS; r++) {
    size_t y = r < REACH ? 0 : r - REACH < ny ? r - REACH : ny - 1;
    memcpy(kept + r * nx, slice + y * nx, nx * sizeof *slice);
  }
  for (size_t y = 0; y < ny; y++) {
    const float *rows[HL_FILTER_ROWS];
    for (size_t r = 0; r < HL_FILTER_ROWS; r++) rows[r] = kept + (y + r) % HL_FILTER_ROWS * nx;
    add_rows(job, rows, slice + y * nx);
    size_t next = y + REACH + 1;
    /* the next row of the field, which is not filtered yet; beyond the field's last row, a copy of the
     * unfiltered last row */
    const float *from = next < ny ? slice + next * nx : rows[2 * REACH];
    memmove(kept + y % HL_FILTER_ROWS * nx, from, nx * sizeof *slice);
  }
}

/* Filters the columns along z whose second coordinate is y. */
static void filter_columns(void *data, size_t y, int worker) {
  const filter_job *job = data;
  const label_field *field = job->field;
  const size_t nx = field->size[0], nz = field->size[2], slice = nx * field->size[1];
  float *column = field->values + y * nx, *lines = field->lines + (size_t)worker * field->line_floats;
  for (size_t z = 0; z < nz + 2 * REACH; z++) {
    size_t from = z < REACH ? 0 : z - REACH < nz ? z - REACH : nz - 1;
    memcpy(lines + z * nx, column + from * slice, nx * sizeof *lines);
  }
  for (size_t z = 0; z < nz; z++) {
    const float *rows[HL_FILTER_ROWS];
    for (size_t r = 0; r < HL_FILTER_ROWS; r++) rows[r] = lines + (z + r) * nx;
    add_rows(job, rows, column + z * slice);
  }
}

void hl_label_filter(hl_pool *pool, const label_field *field, const label_filter *filter) {
  filter_job job = {field, filter};
  hl_pool_run(pool, field->size[2], filter_slice, &job);
  hl_pool_run(pool, field->size[1], filter_columns, &job);
}
