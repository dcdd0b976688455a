/* field/sky_field.c - sweeps the light of a sky through a lattice, along the three axes and back.
 *
 * The sphere of directions is divided like the surface of a cube. Each face of the cube belongs to one end of
 * an axis, and is divided into squares of equal angles. Light of one direction moves from slice to slice
 * (sky_lanes.h). Cells keep the sum over directions of transmittance times the integrals of radiance and
 * spherical harmonics. This is enough for the mean over a cosine or a phase function (lookup_lanes.h;
 * Ramamoorthi and Hanrahan, "An efficient representation for irradiance environment maps", 2001). The sums of
 * a cell always have the same order.
 *
 * Processes that share a picture divide two parts of the work by slabs of cells: sampling the volumes, and
 * adding the light up. Moving light from slice to slice is a fifth of the work, and each process does all of
 * it. */
#include "field/sky_field.h"

#include <string.h>

#include "core/context.h"
#include "elementary/elementary.h"
#include "field/field_planes.h"
#include "field/harmonics.h"
#include "field/open_light.h"
#include "field/surface_links.h"
#include "scene/light/sky.h"

/* The number of cells by which look-ups are moved off a surface. */
static const double LIFT_CELLS = 0.5;

/* SIDE: number of squares along each side of a cube's face. With fewer squares, edges of the light of
 * single directions show on the floors of slots and on flat faces of meshes. */
enum { SIDE = 6, ENDS = 6, SIDE_SAMPLES = 64 };

_Static_assert(SIDE *SIDE == FIELD_DIRECTIONS, "room for a cube's face");

/* The directions of the light that comes from one end of an axis. */
typedef struct sky_end {
  sky_direction directions[FIELD_DIRECTIONS];
  float basis[FIELD_DIRECTIONS][3 * FIELD_HARMONICS];
  int count; /* number of directions from which the sky sends light */
} sky_end;

/* ---- radiance ---- */

/* The number of samples of the sky along each side of a square of directions. */
static int samples_of_sky(const hl_sky *sky) {
  if (sky->type != HL_SKY_IMAGE) return 8;
  int pixels = sky->width / (4 * SIDE) + 1;
  return pixels < 8 ? 8 : pixels > SIDE_SAMPLES ? SIDE_SAMPLES : pixels;
}

/* The direction of a point of a face. x, y: from -1 to 1 in equal angles. slope: receives the distances that
 * a ray moves along the two other axes while it moves by 1 along the face's axis. */
static vec3 direction_of(const field_slices *s, int sign, double x, double y, double slope[2]) {
  double v[3] = {0, 0, 0};
  slope[0] = hl_tan(HL_PI / 4 * x);
  slope[1] = hl_tan(HL_PI / 4 * y);
  v[s->axis] = sign;
  v[s->across] = slope[0];
  v[s->down] = slope[1];
  return vec3_normalise(vec3_of(v));
}

/* Adds the integrals over a square of a face. white: the sky is taken as an even sky of radiance 1. Derived:
 * the solid angle of dx dy in equal angles is (pi / 4)^2 (1 + u^2) (1 + v^2) / (1 + u^2 + v^2)^(3/2), where u
 * and v are the slopes. */
static void integrate_square(const hl_sky *sky, const field_slices *s, int sign, int square,
                             double integral[3][FIELD_HARMONICS]) {
  const sky_axes axes = hl_sky_axes(sky);
  int n = samples_of_sky(sky);
  double step = 2.0 / (SIDE * n), left = -1 + 2.0 / SIDE * (square % SIDE),
         top = -1 + 2.0 / SIDE * (square / SIDE);
  memset(integral, 0, 3 * sizeof *integral);
  for (int i = 0; i < n * n; i++) {
    double slope[2], radiance[3], harmonics[FIELD_HARMONICS];
    vec3 direction = direction_of(s, sign, left + step * (i % n + 0.5), top + step * (i / n + 0.5), slope);
    double u = slope[0] * slope[0], v = slope[1] * slope[1], square_root = sqrt(1 + u + v);
    double angle = HL_PI / 4 * step * HL_PI / 4 * step * (1 + u) * (1 + v) / (square_root * (1 + u + v));
    hl_sky_radiance(sky, &axes, direction, radiance);
    hl_harmonics(direction, harmonics);
    for (int c = 0; c < 3; c++)
      for (int k = 0; k < FIELD_HARMONICS; k++) integral[c][k] += radiance[c] * harmonics[k] * angle;
  }
}

/* Sets the four cells from which a direction's light comes. Derived: a ray to a cell's middle has crossed
 * the slice before at the distance (u, v) from the middle. light_stride: as in sky_slice. */
static void set_taps(double u, double v, int32_t light_stride, sky_direction *direction) {
  double column = floor(u), row = floor(v), fu = u - column, fv = v - row;
  direction->offset = (int32_t)row * FIELD_DIRECTIONS * light_stride + (int32_t)column;
  direction->link = 3 * (1 + (int)row) + 1 + (int)column;
  direction->weight[0] = (float)((1 - fu) * (1 - fv));
  direction->weight[1] = (float)(fu * (1 - fv));
  direction->weight[2] = (float)((1 - fu) * fv);
  direction->weight[3] = (float)(fu * fv);
  direction->across = (float)(u * u);
  direction->down = (float)(v * v);
}

/* The number of the first direction whose light moves as far across and down in a slice as the light of the
 * direction that was added last. */
static int find_slope(const sky_end *end) {
  const sky_direction *last = &end->directions[end->count - 1], *direction = end->directions;
  while (direction->across != last->across || direction->down != last->down) direction++;
  return (int)(direction - end->directions);
}

/* Finds the directions in which the sky sends light from one end of an axis. first: the sky's channel from
 * which the first channel of the harmonics is made. */
static void set_up_end(const sky_content *content, int end_index, int first, int channels,
                       int32_t light_stride, sky_end *end) {
  field_slices s = hl_field_slices(&content->lattice, end_index / 2);
  int sign = end_index % 2 ? -1 : 1;
  end->count = 0;
  for (int square = 0; square < FIELD_DIRECTIONS; square++) {
    double integral[3][FIELD_HARMONICS], slope[2];
    integrate_square(content->sky, &s, sign, square, integral);
    float *basis = end->basis[end->count];
    bool shines = false;
    for (int c = 0; c < channels; c++)
      for (int k = 0; k < FIELD_HARMONICS; k++) {
        basis[c * FIELD_HARMONICS + k] = (float)integral[first + c][k];
        shines |= integral[first + c][0] > 0;
      }
    if (!shines) continue;
    sky_direction *direction = &end->directions[end->count++];
    *direction = (sky_direction){.basis = basis};
    (void)direction_of(&s, sign, -1 + (2 * (square % SIDE) + 1.0) / SIDE,
                       -1 + (2 * (square / SIDE) + 1.0) / SIDE, slope);
    set_taps(slope[0], slope[1], light_stride, direction);
    direction->slope = find_slope(end);
  }
}

/* ---- the sweep ---- */

typedef struct sweep_rows {
  const field_functions *functions;
  sky_slice slice;
} sweep_rows;

static void move_row(void *data, size_t row, int worker) {
  const sweep_rows *rows = data;
  (void)worker;
  rows->functions->sky_row(&rows->slice, (int32_t)row);
}

/* The number of floats that hold the light of all directions in one slice. They include a border around the
 * slice, where nothing hides the light. */
static size_t light_of_slice(const field_slices *s) { return FIELD_DIRECTIONS * hl_field_planes(s).plane; }

/* The number of floats that hold the light of one slice, for the axis whose slices need the most. */
static size_t most_light(const sky_content *content) {
  size_t most = 0;
  for (int a = 0; a < 3; a++) {
    field_slices s = hl_field_slices(&content->lattice, a);
    most = light_of_slice(&s) > most ? light_of_slice(&s) : most;
  }
  return most;
}

/* The light of two slices that follow each other, as in sky_slice. */
typedef struct moving_light {
  float *light[2];
  uint64_t *lit[2];
} moving_light;

static void lay_out_light(const sky_content *content, moving_light *moving, hl_layout *layout) {
  const size_t floats = most_light(content), blocks = floats / (FIELD_DIRECTIONS * FIELD_LANES);
  for (int i = 0; i < 2; i++) {
    moving->light[i] = hl_layout_take(layout, floats, sizeof(float));
    moving->lit[i] = hl_layout_take(layout, blocks, sizeof(uint64_t));
  }
}

/* Begins a sweep: sets all light in both slices and in their borders to 1, and marks the first `directions`
 * directions as lit. */
static void open_light(const moving_light *moving, const field_slices *s, int directions, hl_pool *pool) {
  const size_t floats = light_of_slice(s);
  for (int i = 0; i < 2; i++) {
    hl_pool_fill(pool, moving->light[i], floats, 1);
    for (size_t b = 0; b < floats / (FIELD_DIRECTIONS * FIELD_LANES); b++)
      moving->lit[i][b] = (1ull << directions) - 1;
  }
}

/* The progress of the work: the number of slices whose light has been moved, over all ends of axes and all
 * passes. */
typedef struct sky_progress {
  const hl_context *context;
  double done, whole; /* done: number of slices whose light has been moved; whole: number of all slices */
} sky_progress;

static void tell_progress(sky_progress *progress, int32_t slices) {
  progress->done += slices;
  hl_progress(progress->context, "sky", progress->done / progress->whole);
}

/* The memory to which the field's light is added: the cells, and the harmonics that are kept for each
 * cell. */
typedef struct sky_target {
  float *field;   /* the float of the first cell's first harmonic */
  size_t step[3]; /* numbers of floats from one cell to the next along x, y and z */
} sky_target;

/* Sets the links through which light comes to a slice. rising: whether the light comes from the slice before;
 * if not, it comes from the slice after. A link is stored with the later of its two slices, so links to the
 * slice after are read with that slice, from their other ends. */
static void set_links(const surface_links *links, const field_slices *s, size_t slice, bool rising,
                      sky_slice *of) {
  const field_planes planes = hl_field_planes(s);
  const unsigned char *taken = links->taken + (slice + !rising) * FIELD_LINKS * planes.plane;
  of->cut = links->cut + slice * (size_t)s->rows * (size_t)(s->stride / FIELD_LANES);
  of->cut_here = rising ? LINKS_BEFORE : LINKS_AFTER;
  for (int k = 0; k < FIELD_LINKS; k++) {
    const int across = k % 3 - 1, down = k / 3 - 1, own = rising ? k : FIELD_LINKS - 1 - k;
    of->taken[k] = taken + (size_t)own * planes.plane;
    if (!rising) of->taken[k] += down * planes.stride + across;
  }
}

/* Sweeps the light of one end of an axis through all slices. moving: memory for the light of two slices.
 * links: the links along the end's axis; null if there are no surfaces. */
static void sweep_end(const sky_content *content, const opacity_field *opacity, const surface_links *links,
                      const moving_light *moving, const sky_target *target, int end_index, int first,
                      int channels, const field_functions *functions, hl_pool *pool, sky_progress *progress) {
  field_slices s = hl_field_slices(&content->lattice, end_index / 2);
  const field_planes planes = hl_field_planes(&s);
  sky_end end;
  set_up_end(content, end_index, first, channels, planes.stride, &end);
  const bool adds_passing = end_index % 2 == 0 && first == 0;
  if (end.count == 0 && !adds_passing) {
    tell_progress(progress, s.slices);
    return;
  }
  open_light(moving, &s, end.count, pool);
  for (int32_t i = 0; i < s.slices && !hl_pool_cancelled(pool); i++) {
    size_t slice = (size_t)(end_index % 2 ? i : s.slices - 1 - i),
           at = slice * (size_t)s.rows * (size_t)s.stride;
    sweep_rows rows = {functions,
                       {.directions = end.directions,
                        .direction_count = end.count,
                        .channels = channels,
                        .depth = opacity->depth[s.axis] + 3 * at,
                        .flags = opacity->flags[s.axis] + at / FIELD_LANES,
                        .stride = s.stride,
                        .columns = s.columns,
                        .old = moving->light[i % 2],
                        .left = moving->light[1 - i % 2],
                        .old_lit = moving->lit[i % 2],
                        .left_lit = moving->lit[1 - i % 2],
                        .light_stride = planes.stride,
                        .field = target->field + slice * target->step[s.axis],
                        .across = target->step[s.across],
                        .down = target->step[s.down],
                        .passing = adds_passing ? FIELD_HARMONICS * content->channels : 0}};
    if (links != NULL) set_links(links, &s, slice, end_index % 2, &rows.slice);
    hl_pool_run(pool, (size_t)s.rows, move_row, &rows);
    tell_progress(progress, 1);
  }
}

/* ---- memory ---- */

/* The number of floats of a cell while its light is added up. Afterwards SKY_CELL numbers of 16 bits replace
 * the floats. */
static size_t cell_floats(const sky_content *content) {
  if (content->channels == 1) return 16;
  return FIELD_HARMONICS * (size_t)content->channels + 1 + (content->content.surfaces != NULL ? 3 : 0);
}

_Static_assert(16 * sizeof(float) >= SKY_CELL * sizeof(int16_t) && 16 >= FIELD_HARMONICS + 4,
               "room for a cell");

/* The number of floats of a row, which begins with a cache line. */
static size_t row_floats(const sky_content *content) {
  return (cell_floats(content) * (size_t)content->lattice.count[0] + 15) / 16 * 16;
}

/* The number of floats of all rows of the field. */
static size_t field_floats(const sky_content *content) {
  return row_floats(content) * (size_t)content->lattice.count[1] * (size_t)content->lattice.count[2];
}

static size_t field_bytes(const sky_content *content) { return field_floats(content) * sizeof(float); }

typedef struct passing_arrays {
  opacity_field opacity;
  moving_light moving;
  opacity_scratch scratch;
  surface_links links; /* the links between cells along one axis; used if the content has surfaces */
  field_matter *matter;
  field_share share;
} passing_arrays;

static void lay_out(const sky_content *content, passing_arrays *arrays, hl_layout *layout) {
  arrays->opacity.lattice = content->lattice;
  hl_opacity_lay_out(&arrays->opacity, &arrays->scratch, layout);
  if (content->content.surfaces != NULL) hl_surface_links_lay_out(&content->lattice, &arrays->links, layout);
  lay_out_light(content, &arrays->moving, layout);
  arrays->matter = hl_layout_take(layout, (size_t)content->content.count, sizeof *arrays->matter);
  hl_field_share_lay_out(content->exchange, (size_t)content->lattice.count[2], &arrays->share, layout);
}

void hl_sky_count(const sky_content *content, const sky_field *held, hl_layout *layout) {
  passing_arrays arrays;
  const size_t kept = field_bytes(content);
  hl_layout_take(layout, kept > held->bytes ? kept - held->bytes : 0, 1);
  lay_out(content, &arrays, layout);
}

/* ---- the field ---- */

static bool attenuates_in_color(const sky_content *content) {
  for (int v = 0; v < content->content.count; v++) {
    if (content->content.matter[v].cast > 0 && !hl_is_grey(content->colors[v])) return true;
  }
  return false;
}

/* Finds the links that surfaces cut along an axis. Where a surface cuts the way from a cell to the next cell
 * along the axis, stores the place of the cut in one of the cell's last three floats. Returns null if there
 * are no surfaces. */
static const surface_links *find_links(const sky_content *content, const surface_links *links,
                                       const sky_target *target, float *field, int axis, hl_pool *pool) {
  const field_content *of = &content->content;
  link_places places = {.first = field + FIELD_HARMONICS * content->channels + 1 + axis};
  if (of->surfaces == NULL) return NULL;
  memcpy(places.step, target->step, sizeof places.step);
  hl_surface_links_find(of->surfaces, &content->lattice, axis, links, &places, pool);
  return links;
}

static void make(hl_context *context, const sky_content *content, passing_arrays *arrays,
                 const field_functions *functions, float *field, hl_pool *pool) {
  bool colored = attenuates_in_color(content);
  size_t cell = cell_floats(content);
  const int32_t *count = content->lattice.count;
  sky_target target = {.step = {cell, row_floats(content), row_floats(content) * (size_t)count[1]}};
  field_content matter = content->content;
  matter.matter = arrays->matter;
  const surface_links *links = NULL;
  const int passes = colored ? 3 : 1;
  sky_progress progress = {.context = context, .whole = 2.0 * passes * (count[0] + count[1] + count[2])};
  tell_progress(&progress, 0);
  for (int pass = 0; pass < passes; pass++) {
    for (int v = 0; v < matter.count; v++) {
      arrays->matter[v] = content->content.matter[v];
      arrays->matter[v].cast *= (float)content->colors[v][pass];
    }
    hl_opacity_find(&matter, functions, &arrays->scratch, &arrays->share, &arrays->opacity, pool);
    target.field = field + pass * FIELD_HARMONICS;
    for (int end = 0; end < ENDS; end++) {
      if (end % 2 == 0) links = find_links(content, &arrays->links, &target, field, end / 2, pool);
      sweep_end(content, &arrays->opacity, links, &arrays->moving, &target, end, pass,
                colored ? 1 : content->channels, functions, pool, &progress);
    }
  }
  if (arrays->share.with != NULL)
    hl_field_share_complete(&arrays->share, false, field, count[2], target.step[2] * sizeof *field);
  if (!content->media) hl_open_light_spread(&content->lattice, content->channels, field, target.step, pool);
}

/* Finds the harmonics of the light where nothing hides the sky, and for each channel a bound of the harmonics
 * in all cells. The bound is a sum of magnitudes over the directions, because matter can only lessen the
 * light of each direction. */
static void find_open(const sky_content *content, sky_light *light) {
  double sum[3][FIELD_HARMONICS] = {{0}}, bound[3][FIELD_HARMONICS] = {{0}};
  for (int end = 0; end < ENDS; end++) {
    field_slices s = hl_field_slices(&content->lattice, end / 2);
    for (int square = 0; square < FIELD_DIRECTIONS; square++) {
      double integral[3][FIELD_HARMONICS];
      integrate_square(content->sky, &s, end % 2 ? -1 : 1, square, integral);
      for (int c = 0; c < 3; c++)
        for (int k = 0; k < FIELD_HARMONICS; k++) {
          sum[c][k] += integral[c][k];
          bound[c][k] += fabs(integral[c][k]);
        }
    }
  }
  for (int c = 0; c < 3; c++) {
    double greatest = 0;
    for (int k = 0; k < FIELD_HARMONICS; k++) {
      light->open[c][k] = (float)sum[c][k];
      greatest = fmax(greatest, bound[c][k]);
    }
    light->stored_unit[c] = (float)(greatest / SKY_MOST);
  }
}

/* ---- how the field is stored ---- */

enum { MOST_FLOATS = 3 * FIELD_HARMONICS + 1 + 3 };

typedef struct store_rows {
  float *field; /* [rows][row_floats]; the cells as floats, which are turned into numbers of 16 bits in
                 * place */
  size_t row_floats, cell_floats, columns;
  size_t used;              /* number of floats of a cell that are stored */
  float scale[MOST_FLOATS]; /* [used]; the factors that turn floats into numbers of 16 bits */
  int place[MOST_FLOATS];   /* [used]; for each float of a cell, its place among the cell's numbers of 16
                             * bits */
} store_rows;

static bool is_dark(const float *cell, size_t count) {
  for (size_t i = 0; i < count; i++)
    if (cell[i] != 0) return false;
  return true;
}

static void store_cell(const store_rows *rows, const float *cell, int16_t numbers[SKY_CELL]) {
  int32_t whole[MOST_FLOATS];
  for (size_t i = 0; i < rows->used && i < MOST_FLOATS; i++) {
    float number = cell[i] * rows->scale[i];
    number += number < 0 ? -0.5f : 0.5f;
    number = number < -SKY_MOST ? -SKY_MOST : number > SKY_MOST ? SKY_MOST : number;
    whole[i] = (int32_t)number;
  }
  for (size_t i = 0; i < rows->used && i < MOST_FLOATS; i++) numbers[rows->place[i]] = (int16_t)whole[i];
}

/* Stores a row of cells along x. A cell's numbers overwrite floats of this cell and of cells before it, which
 * have been converted already. Most cells are dark, and their numbers are zeros. Memory for these numbers is
 * zero already, except where it held the floats of a cell with light. */
static void store_row(void *data, size_t row, int worker) {
  const store_rows *rows = data;
  const size_t size = rows->cell_floats;
  float *cells = rows->field + row * rows->row_floats;
  int16_t *at = (int16_t *)cells;
  size_t written = 0; /* the number of the 16-bit numbers before the end of the floats of the last cell with
                       * light */
  (void)worker;
  for (size_t x = 0; x < rows->columns; x++, at += SKY_CELL) {
    const float *cell = cells + x * size;
    int16_t numbers[SKY_CELL] = {0};
    bool dark = is_dark(cell, rows->used);
    if (dark && x * SKY_CELL >= written) continue;
    if (!dark) store_cell(rows, cell, numbers), written = 2 * (x + 1) * size;
    memcpy(at, numbers, sizeof numbers);
    if (x > 0 && numbers[SKY_PASSING] != 0) at[SKY_PASSING + 1 - SKY_CELL] = numbers[SKY_PASSING];
  }
}

/* Turns the field's floats into the numbers that samples look up. */
static void store(const sky_content *content, void *memory, sky_light *light, hl_pool *pool) {
  const int harmonics = light->channels * FIELD_HARMONICS;
  store_rows rows = {memory, row_floats(content), cell_floats(content), (size_t)light->count[0],
                     .used = (size_t)harmonics + 1 + (light->cut ? 3 : 0)};
  for (int i = 0; i < harmonics; i++) {
    const int channel = i / FIELD_HARMONICS;
    rows.scale[i] = light->stored_unit[channel] > 0 ? 1 / light->stored_unit[channel] : 0;
    rows.place[i] = SKY_PLACE(i % FIELD_HARMONICS * light->channels + channel);
  }
  rows.scale[harmonics] = SKY_MOST;
  rows.place[harmonics] = SKY_PASSING;
  for (int a = 0; a < 3; a++) {
    rows.scale[harmonics + 1 + a] = SKY_MOST;
    rows.place[harmonics + 1 + a] = SKY_CUT(a);
  }
  hl_pool_run(pool, (size_t)light->count[1] * (size_t)light->count[2], store_row, &rows);
  light->cells = memory;
  light->row_numbers = 2 * rows.row_floats;
}

hl_status hl_sky_make(hl_context *context, hl_pool *pool, const sky_content *content,
                      const field_functions *functions, sky_field *made, hl_error *error) {
  hl_sky white = *content->sky;
  sky_content own = *content;
  sky_light *light = &made->light;
  passing_arrays arrays;
  const size_t bytes = field_bytes(content);
  *light = (sky_light){.version = light->version + 1,
                       .channels = content->channels,
                       .cell = (float)content->lattice.cell,
                       .color = {1, 1, 1},
                       .cut = content->content.surfaces != NULL};
  vec3_store(light->low, content->lattice.low);
  light->lift = (float)(LIFT_CELLS * content->lattice.cell);
  light->inverse_cell = (float)(1 / content->lattice.cell);
  memcpy(light->count, content->lattice.count, sizeof light->count);
  if (content->channels == 1) { /* with one channel, the field is made for a white sky, and `color` holds the
                                 * sky's colour */
    for (int c = 0; c < 3; c++) {
      light->color[c] = (float)(white.color[c] * white.strength);
      white.color[c] = 1;
    }
    white.strength = 1;
    own.sky = &white;
  }
  find_open(&own, light);
  if (made->bytes != bytes) {
    hl_release(context, made->memory);
    made->bytes = 0;
    made->memory = hl_allocate(context, bytes, 1);
    if (made->memory == NULL) return hl_fail_memory(error, bytes, "the light of the sky");
    made->bytes = bytes;
  }
  hl_layout layout = {0};
  while (hl_layout_pass(&layout, context)) lay_out(content, &arrays, &layout);
  if (layout.base == NULL) return hl_fail_memory(error, layout.bytes, "the light of the sky");
  hl_pool_clear(pool, made->memory, made->bytes);
  make(context, &own, &arrays, functions, made->memory, pool);
  hl_release(context, layout.base);
  store(content, made->memory, light, pool);
  return hl_pool_check(pool, "rendering", error);
}

void hl_sky_release(hl_context *context, sky_field *field) {
  hl_release(context, field->memory);
  hl_key_release(context, &field->key);
  *field = (sky_field){.light.version = field->light.version};
}
