/* light/light_emission.c - divides an emission image into cells, and makes the taps of a penumbra from the
 * cells. */
#include "light/light_emission.h"

#include "core/memory.h"

/* The least and the greatest number of samples of the emission image along each side of a cell. */
enum { LEAST_SAMPLES = 4, GREATEST_SAMPLES = 32 };

/* Adds the colour at a point of the emission image to a sum. The colour is interpolated bilinearly between
 * the middles of pixels. s, t: the point's position in the image, to the right and upwards, each from -1 to
 * 1. */
static void add_color(const light_picture *picture, double s, double t, double sum[HL_CHANNELS]) {
  const int size[2] = {picture->width, picture->height};
  const double position[2] = {(1 + s) / 2 * size[0] - 0.5, (1 - t) / 2 * size[1] - 0.5};
  size_t pixel[2][2];
  double fraction[2];
  for (int axis = 0; axis < 2; axis++) {
    double at = fmin(fmax(position[axis], 0), size[axis] - 1);
    pixel[axis][0] = (size_t)at;
    pixel[axis][1] = pixel[axis][0] + 1 < (size_t)size[axis] ? pixel[axis][0] + 1 : pixel[axis][0];
    fraction[axis] = at - (double)pixel[axis][0];
  }
  for (int corner = 0; corner < 4; corner++) {
    int right = corner & 1, below = corner >> 1;
    double weight = (right ? fraction[0] : 1 - fraction[0]) * (below ? fraction[1] : 1 - fraction[1]);
    const float *color = picture->pixels + 3 * (pixel[1][below] * (size_t)picture->width + pixel[0][right]);
    for (int c = 0; c < HL_CHANNELS; c++) sum[c] += weight * (double)color[c];
  }
}

/* Finds the mean colour of the emission image in cell (i, j) of side x side cells. For a parallel light, a
 * point's offset is an offset of the direction in which light travels. The image shows the directions in
 * which the light is seen, which are the opposite directions. So the sign of the offset is reversed. */
static void mean_of_cell(const light_source *source, const emission_plane *plane, int side, int i, int j,
                         double mean[HL_CHANNELS]) {
  const light_picture *picture = &source->emission;
  int longer = picture->width > picture->height ? picture->width : picture->height, n = 2 * longer / side + 1;
  n = n < LEAST_SAMPLES ? LEAST_SAMPLES : n > GREATEST_SAMPLES ? GREATEST_SAMPLES : n;
  for (int c = 0; c < HL_CHANNELS; c++) mean[c] = 0;
  for (int k = 0; k < n * n; k++) {
    double s, t, a = (i + (k / n + 0.5) / n) / side, b = (j + (k % n + 0.5) / n) / side;
    vec3 offset = hl_light_point(source, a, b);
    hl_emission_place(plane, source->parallel ? vec3_scale(offset, -1) : offset, &s, &t);
    add_color(picture, s, t, mean);
  }
  for (int c = 0; c < HL_CHANNELS; c++) mean[c] /= n * n;
}

void hl_light_emission_weights(const light_source *source, int side, float (*weights)[HL_CHANNELS],
                               double mean[HL_CHANNELS]) {
  size_t cells = (size_t)side * (size_t)side;
  for (int c = 0; c < HL_CHANNELS; c++) mean[c] = source->emission.pixels == NULL;
  for (size_t i = 0; i < cells; i++)
    for (int c = 0; c < HL_CHANNELS; c++) weights[i][c] = 1;
  if (source->emission.pixels == NULL) return;
  emission_plane plane = source->shape.kind->plane(&source->shape, source->direction);
  for (size_t i = 0; i < cells; i++) {
    double color[HL_CHANNELS];
    mean_of_cell(source, &plane, side, (int)(i / (size_t)side), (int)(i % (size_t)side), color);
    for (int c = 0; c < HL_CHANNELS; c++) {
      weights[i][c] = (float)color[c];
      mean[c] += color[c] / (double)cells;
    }
  }
  for (size_t i = 0; i < cells; i++)
    for (int c = 0; c < HL_CHANNELS; c++)
      weights[i][c] = mean[c] > 0 ? (float)((double)weights[i][c] / mean[c]) : 1;
}

/* Sets the weight of each cell, also of dark cells, to the fraction of the light that the cell sends. */
static void weigh_cells(const light_source *source, light_emission *emission) {
  float weights[EMISSION_CELLS][HL_CHANNELS];
  hl_light_emission_weights(source, EMISSION_SIDE, weights, emission->mean);
  emission->even = true;
  emission->count = EMISSION_CELLS;
  for (int i = 0; i < EMISSION_CELLS; i++)
    for (int c = 0; c < HL_CHANNELS; c++) {
      emission->even = emission->even && fabsf(weights[i][c] - 1) < 1e-6f;
      emission->cells[i].weight[c] = weights[i][c] / EMISSION_CELLS;
    }
}

hl_status hl_light_emission_create(hl_context *context, const light_source *source, light_emission **emission,
                                   hl_error *error) {
  *emission = NULL;
  if (source->emission.pixels == NULL) return HL_OK;
  *emission = hl_allocate_zeroed(context, 1, sizeof **emission);
  if (*emission == NULL) return hl_fail_memory(error, sizeof **emission, "a light's emission image");
  weigh_cells(source, *emission);
  return HL_OK;
}

/* The middle of cell i of the unit square. */
static vec3 middle_of_cell(const light_source *source, int i) {
  return hl_light_point(source, (i / EMISSION_SIDE + 0.5) / EMISSION_SIDE,
                        (i % EMISSION_SIDE + 0.5) / EMISSION_SIDE);
}

/* The greatest slope of rays for which the taps of a light that is tilted against the sheets reach all of the
 * light's cells. If rays come to receivers at greater slopes, the outermost cells share taps. */
static const double GREATEST_SLOPE = 0.5;

/* Removes the dark cells of an emission image, and finds bounds of the positions of the other cells. */
static void finish(light_emission *emission) {
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  int count = 0;
  for (int i = 0; i < EMISSION_CELLS; i++) {
    emission_cell cell = emission->cells[i];
    if (!(cell.weight[0] > 0 || cell.weight[1] > 0 || cell.weight[2] > 0)) continue;
    const double at[3] = {cell.u, cell.v, cell.z};
    for (int axis = 0; axis < 3; axis++) {
      low[axis] = fmin(low[axis], at[axis]);
      high[axis] = fmax(high[axis], at[axis]);
    }
    emission->cells[count++] = cell;
  }
  emission->count = count;
  double tilt = GREATEST_SLOPE * (high[2] - low[2]);
  emission->tilted = tilt > 0;
  emission->reach = 0;
  for (int axis = 0; axis < 2; axis++) {
    emission->range[axis] = high[axis] - low[axis] + tilt;
    emission->reach = fmax(emission->reach, fmax(fabs(low[axis]), fabs(high[axis])) + tilt);
  }
}

/* For parallel light, the unit of the cells' positions is negative: light that travels more towards u comes
 * from a place farther back along u. */
void hl_light_emission_see(const light_source *source, const sheet_light *seen, vec3 normal,
                           light_emission *emission) {
  double unit = fmax(seen->width_u, seen->width_v) * (source->parallel ? -1 : 1);
  for (int i = 0; i < EMISSION_CELLS; i++) {
    double position[3];
    hl_sheet_light_position(seen, source, normal, middle_of_cell(source, i), position);
    emission->cells[i].u = position[0] / unit;
    emission->cells[i].v = position[1] / unit;
    emission->cells[i].z = position[2] / unit;
  }
  finish(emission);
}

void hl_light_emission_project(const light_source *source, const view *view, double size,
                               light_emission *emission) {
  double unit = size * (source->parallel ? -1 : 1);
  vec3 u = vec3_normalise(view->du), v = vec3_normalise(view->dv);
  for (int i = 0; i < EMISSION_CELLS; i++) {
    vec3 offset = middle_of_cell(source, i);
    emission->cells[i].u = vec3_dot(offset, u) / unit;
    emission->cells[i].v = vec3_dot(offset, v) / unit;
    emission->cells[i].z = 0;
  }
  finish(emission);
}

bool hl_light_emission_colored(const hl_light *light) {
  const float *pixel = light->emission.pixels;
  size_t count = pixel == NULL ? 0 : (size_t)light->emission.width * (size_t)light->emission.height;
  for (size_t i = 0; i < count; i++, pixel += 3)
    if (pixel[0] != pixel[1] || pixel[1] != pixel[2]) return true;
  return false;
}

void hl_light_emission_steps(const light_emission *emission, double width, int step[2]) {
  for (int axis = 0; axis < 2; axis++)
    step[axis] = (int)fmin(fmax(1, ceil(emission->range[axis] * width / EMISSION_SIDE)),
                           EMISSION_GREATEST_STEP);
}

/* Distributes the weight of each cell among the four taps around the cell, by the cell's distances from these
 * taps. */
void hl_light_emission_taps(const light_emission *emission, double width, const int step[2],
                            const double slope[2], emission_taps *taps) {
  enum { GRID = EMISSION_SIDE + 3 };
  float grid[GRID][GRID][HL_CHANNELS] = {{{0}}};
  int first[2] = {INT32_MAX, INT32_MAX}, tap[EMISSION_CELLS][2];
  float fraction[EMISSION_CELLS][2];
  for (int i = 0; i < emission->count; i++) {
    const emission_cell *cell = &emission->cells[i];
    const double at[2] = {(cell->u - slope[0] * cell->z) * width / step[0],
                          (cell->v - slope[1] * cell->z) * width / step[1]};
    for (int axis = 0; axis < 2; axis++) {
      tap[i][axis] = (int)floor(at[axis]);
      fraction[i][axis] = (float)(at[axis] - tap[i][axis]);
      if (tap[i][axis] < first[axis]) first[axis] = tap[i][axis];
    }
  }
  for (int i = 0; i < emission->count; i++) {
    int x = tap[i][0] - first[0], y = tap[i][1] - first[1];
    /* a cell's position may lie outside the grid of taps if the slope is beyond GREATEST_SLOPE */
    x = x < GRID - 1 ? x : GRID - 2;
    y = y < GRID - 1 ? y : GRID - 2;
    for (int corner = 0; corner < 4; corner++) {
      int right = corner & 1, below = corner >> 1;
      float weight = (right ? fraction[i][0] : 1 - fraction[i][0]) *
                     (below ? fraction[i][1] : 1 - fraction[i][1]);
      for (int c = 0; c < HL_CHANNELS; c++)
        grid[y + below][x + right][c] += weight * emission->cells[i].weight[c];
    }
  }
  taps->count = 0;
  for (int i = 0; i < GRID * GRID; i++) {
    const float *weight = grid[i / GRID][i % GRID];
    if (!(weight[0] + weight[1] + weight[2] > 0)) continue;
    taps->x[taps->count] = (first[0] + i % GRID) * step[0];
    taps->y[taps->count] = (first[1] + i / GRID) * step[1];
    for (int c = 0; c < HL_CHANNELS; c++) taps->weight[c][taps->count] = weight[c];
    taps->count++;
  }
}
