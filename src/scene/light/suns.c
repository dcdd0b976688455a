/* scene/light/suns.c - finds the suns of a sky's image, and makes lights of them.
 *
 * The search begins at the brightest pixel. The spot around this pixel is a cap of directions. The cap's
 * radius is chosen from a series of radii, so that the cap holds the most light for its size. In each
 * channel, light that exceeds the brightest pixel of the ring around the cap goes from the cap's pixels to
 * the sun. The rest of the light stays in the image, so that the image has no step at the cap's rim. Spots
 * that are too wide, or too weak for a light of their own, stay in the image.
 *
 * The image is interpolated bilinearly between the middles of its pixels (scene/light/sky.c). So the image is
 * a sum of tent functions, with a tent for each pixel. The integral over a tent's directions is the integral
 * over the tent's row angle times the integral over the tent's column angle. */
#include "scene/light/suns.h"

#include <string.h>

#include "core/memory.h"
#include "elementary/elementary.h"
#include "scene/light/sky.h"

/* WIDEST: the greatest half angle of a sun. FARTHEST: the greatest angle from a sun's middle at which light
 * may still belong to the sun. */
static const double WIDEST = 12 * HL_PI / 180, FARTHEST = 20 * HL_PI / 180;
/* The factor between the radii of caps that are tried. The first radius is FARTHEST, each further radius is
 * the radius before times this factor, and the last radius is less than a pixel. */
static const double LADDER = 0.70710678118654752;
/* The radius of the ring around a cap is RING times the cap's radius, plus RING_ROWS rows of the image. */
static const double RING = 1.2, RING_ROWS = 1.5;
/* The least brightness of a sun's brightest pixel, as a multiple of the mean brightness of the image. */
static const double FAR_ABOVE = 8;
/* The least fraction of the image's light that a sun sends. */
static const double LEAST_SHARE = 0.05;
/* The greatest brightness of a sun's surroundings, as a fraction of the brightness of the sun's brightest
 * pixel. */
static const double MOST_AROUND = 0.5;

enum { TRIES = 64 /* most spots tried that are no suns */, STEPS = 16 /* most steps to a spot's middle */ };

/* ---- integrals over a pixel's tent ---- */

/* Integrals of a pixel's tent over the angle a to the sky's up, along the pixel's column: of the tent times
 * sin a, times sin^2 a and times sin a cos a. These integrals give the tent's solid angle, and the components
 * of the tent's directions across and along up. */
typedef struct row_integrals {
  double area, across, along;
} row_integrals;

/* The nodes and weights of Gauss and Legendre's rule of integration with five points. The pieces that this
 * rule integrates are at most half a turn long, and rarely more than a degree. */
static const double NODES[5] = {-0.906179845938664, -0.538469310105683, 0, 0.538469310105683,
                                0.906179845938664},
                    WEIGHTS[5] = {0.236926885056189, 0.478628670499366, 0.568888888888889, 0.478628670499366,
                                  0.236926885056189};

/* Adds a piece of a tent to the integrals of a row, from the angle `from` to `to`, but only up to `last`. On
 * this piece, the tent is linear, with 0 at `foot` and 1 at `top`; if `foot` and `top` are the same, the tent
 * is 1 everywhere. */
static void add_piece(double from, double to, double last, double foot, double top, row_integrals *sum) {
  to = fmin(to, last);
  for (int i = 0; i < 5 && to > from; i++) {
    double a = (from + to) / 2 + (to - from) / 2 * NODES[i];
    double part = (to - from) / 2 * WEIGHTS[i] * (foot == top ? 1 : (a - foot) / (top - foot));
    sum->area += part * hl_sin(a);
    sum->across += part * hl_sin(a) * hl_sin(a);
    sum->along += part * hl_sin(a) * hl_cos(a);
  }
}

static row_integrals integrals_of_row(const hl_sky *sky, int row) {
  row_integrals sum = {0, 0, 0};
  double high = HL_PI / sky->height, top = (row + 0.5) * high, last = sky->hemisphere ? HL_PI / 2 : HL_PI;
  bool first_row = row == 0, last_row = row == sky->height - 1;
  add_piece(first_row ? 0 : top - high, top, last, first_row ? top : top - high, top, &sum);
  add_piece(top, last_row ? HL_PI : top + high, last, last_row ? top : top + high, top, &sum);
  return sum;
}

/* ---- the image ---- */

typedef struct cap {
  vec3 middle;
  double radius;
} cap;

typedef struct brightest {
  float brightness; /* the sum of the pixel's channels; 0 if the row has no pixel left */
  int column;
} brightest;

typedef struct search {
  const hl_sky *sky;
  const float *pixels;  /* [height][width][3]; the image without the suns that were found so far */
  row_integrals *rows;  /* [height]; the integrals of the tents of each row's pixels */
  double (*columns)[2]; /* [width]: sine and cosine of the angle to the middle column */
  brightest *peaks;     /* [height]; the brightest pixel of each row, without the pixels in `left_out` */
  double wide, bend;    /* two integrals over the angles of a column's tent. wide: the integral of the tent.
                         * bend: the integral of the tent times the cosine of the angle from the column's
                         * middle */
  cap left_out[TRIES];  /* caps in which no sun begins any more */
  int left_out_count;
  double mean, total; /* brightness of the whole image: its mean, and its integral over all directions */
} search;

static float brightness_of(const float *pixel) { return pixel[0] + pixel[1] + pixel[2]; }

static vec3 direction_of(const search *all, int row, int column) {
  double angle = (row + 0.5) * HL_PI / all->sky->height, across = hl_sin(angle);
  return (vec3){across * all->columns[column][0], across * all->columns[column][1], hl_cos(angle)};
}

static size_t place_of(const search *all, int row, int column) {
  return 3 * ((size_t)row * (size_t)all->sky->width + (size_t)column);
}

static const float *pixel_of(const search *all, int row, int column) {
  return all->pixels + place_of(all, row, column);
}

/* The integral of unit vectors over the directions around a pixel, weighted by the tent filter with which the
 * sky's image is read. */
static vec3 moment_of(const search *all, int row, int column) {
  const row_integrals *of = &all->rows[row];
  double across = of->across * all->bend;
  return (vec3){across * all->columns[column][0], across * all->columns[column][1], of->along * all->wide};
}

static bool is_left_out(const search *all, vec3 direction) {
  for (int i = 0; i < all->left_out_count; i++)
    if (vec3_dot(direction, all->left_out[i].middle) > hl_cos(all->left_out[i].radius)) return true;
  return false;
}

static void find_row_peak(search *all, int row) {
  brightest *peak = &all->peaks[row];
  *peak = (brightest){0, 0};
  if (!(all->rows[row].area > 0)) return;
  for (int column = 0; column < all->sky->width; column++) {
    float brightness = brightness_of(pixel_of(all, row, column));
    if (brightness <= peak->brightness) continue;
    if (all->left_out_count > 0 && is_left_out(all, direction_of(all, row, column))) continue;
    *peak = (brightest){brightness, column};
  }
}

/* Finds the rows of the image that a cap may touch. */
static void rows_of_cap(const search *all, const cap *of, int *first, int *end) {
  double angle = hl_acos(fmin(fmax(of->middle.z, -1), 1)), rows = all->sky->height / HL_PI;
  *first = (int)fmax(floor((angle - of->radius) * rows - 1), 0);
  *end = (int)fmin(ceil((angle + of->radius) * rows + 1), all->sky->height);
}

static void renew_peaks(search *all, const cap *changed) {
  int first, end;
  rows_of_cap(all, changed, &first, &end);
  for (int row = first; row < end; row++) find_row_peak(all, row);
}

typedef void visit_pixel(const search *all, int row, int column, void *data);

/* The number of columns of a row that a cap may touch on each side of its middle. Derived: let the cap's
 * middle be at the angle b to up, and a direction at the angle a to up, turned about up by t from the middle.
 * The cosine of the angle between middle and direction is sin a sin b cos t + cos a cos b. */
static int columns_of_cap(const search *all, const cap *of, int row) {
  double a = (row + 0.5) * HL_PI / all->sky->height, b = hl_acos(fmin(fmax(of->middle.z, -1), 1));
  double least = (hl_cos(of->radius) - hl_cos(a) * hl_cos(b)) / fmax(hl_sin(a) * hl_sin(b), 1e-12);
  if (least > 1) return 0;
  double turn = least < -1 ? HL_PI : hl_acos(least);
  return (int)fmin(ceil(turn / (2 * HL_PI) * all->sky->width + 1), all->sky->width / 2 + 1.0);
}

/* Visits the pixels whose middles lie within a cap, but farther than `nearest` from the cap's middle. If
 * `nearest` is below 0, visits all pixels of the cap. */
static void visit_cap(const search *all, const cap *of, double nearest, visit_pixel *visit, void *data) {
  int first, end, width = all->sky->width;
  rows_of_cap(all, of, &first, &end);
  double least = hl_cos(of->radius), most = nearest < 0 ? 2 : hl_cos(nearest);
  int middle = (int)((0.5 + hl_atan2(of->middle.x, of->middle.y) / (2 * HL_PI)) * width);
  for (int row = first; row < end; row++) {
    int reach = columns_of_cap(all, of, row), low = middle - reach, high = middle + reach + 1;
    if (high - low > width) low = 0, high = width;
    for (int i = low; i < high && all->rows[row].area > 0; i++) {
      int column = (i + width) % width;
      double cosine = vec3_dot(direction_of(all, row, column), of->middle);
      if (cosine >= least && cosine < most) visit(all, row, column, data);
    }
  }
}

/* ---- one spot ---- */

typedef struct center {
  float least;
  vec3 sum;
} center;

static void add_to_center(const search *all, int row, int column, void *data) {
  center *of = data;
  float brightness = brightness_of(pixel_of(all, row, column));
  if (brightness >= of->least)
    of->sum = vec3_add(of->sum,
                       vec3_scale(direction_of(all, row, column), all->rows[row].area * (double)brightness));
}

/* Finds the middle of the spot around a pixel. The middle is the mean direction of pixels in a cap around
 * this middle: the pixels that are at least half as bright as the given pixel. */
static vec3 find_middle(const search *all, int row, int column, double radius) {
  cap around = {direction_of(all, row, column), radius};
  for (int i = 0; i < STEPS; i++) {
    center sum = {brightness_of(pixel_of(all, row, column)) / 2, {0, 0, 0}};
    visit_cap(all, &around, -1, add_to_center, &sum);
    vec3 before = around.middle;
    if (vec3_length(sum.sum) > 0) around.middle = vec3_normalise(sum.sum);
    if (vec3_length(vec3_subtract(around.middle, before)) < 1e-3 * HL_PI / all->sky->height) break;
  }
  return around.middle;
}

/* A bright spot of the image: a cap, and the light in the cap that exceeds the cap's surroundings. */
typedef struct spot {
  cap cap;
  float around[3];      /* R, G, B: the greatest values in the ring around the cap */
  double irradiance[3]; /* irradiance of the light in the cap that exceeds `around` */
  double brightness;    /* the sum of the irradiance's channels */
  vec3 moment;          /* the integral, over the cap, of brightness times the unit vector of the direction */
} spot;

static void raise_around(const search *all, int row, int column, void *data) {
  spot *of = data;
  const float *pixel = pixel_of(all, row, column);
  for (int c = 0; c < 3; c++) of->around[c] = pixel[c] > of->around[c] ? pixel[c] : of->around[c];
}

static void add_beyond(const search *all, int row, int column, void *data) {
  spot *of = data;
  const float *pixel = pixel_of(all, row, column);
  double sum = 0;
  for (int c = 0; c < 3; c++) {
    double beyond = fmax((double)pixel[c] - (double)of->around[c], 0);
    of->irradiance[c] += beyond * all->rows[row].area * all->wide;
    sum += beyond;
  }
  of->moment = vec3_add(of->moment, vec3_scale(moment_of(all, row, column), sum));
}

/* A spot whose light is taken out of the image. */
typedef struct taking {
  const spot *spot;
  float *rest; /* the image out of which the spot's light is taken */
} taking;

static void take_beyond(const search *all, int row, int column, void *data) {
  const taking *of = data;
  const float *around = of->spot->around;
  float *pixel = of->rest + place_of(all, row, column);
  for (int c = 0; c < 3; c++) pixel[c] = pixel[c] < around[c] ? pixel[c] : around[c];
}

static spot measure_spot(const search *all, vec3 middle, double radius) {
  spot made = {.cap = {middle, radius}};
  cap ring = {middle, RING * radius + RING_ROWS * HL_PI / all->sky->height};
  visit_cap(all, &ring, radius, raise_around, &made);
  visit_cap(all, &made.cap, -1, add_beyond, &made);
  for (int c = 0; c < 3; c++) made.brightness += made.irradiance[c];
  return made;
}

static spot spot_of_radius(const search *all, int row, int column, double radius) {
  return measure_spot(all, find_middle(all, row, column, radius), radius);
}

/* Finds the spot around a pixel. The spot's radius maximises the light in the cap divided by the power 3/4 of
 * the radius. For a uniform disk, the chosen radius is the least radius that holds the whole disk. For a
 * Gaussian spot, the chosen radius holds nine tenths of the spot's light. With the power 3/4, a small sun
 * counts more than a glow around the sun that sends as much light, and two suns side by side stay two suns.
 * If the next wider radius holds more light, the function takes the wider radius, because a disk may cover
 * only a part of the pixels at the rim. */
static spot find_spot(const search *all, int row, int column) {
  spot best = {.cap = {direction_of(all, row, column), FARTHEST}}, wider = best;
  double score = 0, least = 0.5 * HL_PI / all->sky->height;
  for (double radius = FARTHEST; radius > least; radius *= LADDER) {
    spot before = wider;
    wider = spot_of_radius(all, row, column, radius);
    double of_this = wider.brightness / sqrt(radius * sqrt(radius));
    if (of_this <= score) continue;
    score = of_this;
    best = before.brightness > wider.brightness ? before : wider;
  }
  return best;
}

/* Makes a sun of a spot. Derived: the mean of the unit vectors in a cap with half angle a has the length (1 +
 * cos a) / 2. */
static sky_sun sun_of_spot(const spot *of) {
  sky_sun sun = {.towards = vec3_normalise(of->moment), .straight = vec3_length(of->moment) / of->brightness};
  memcpy(sun.irradiance, of->irradiance, sizeof sun.irradiance);
  sun.half_angle = hl_acos(fmin(fmax(2 * sun.straight - 1, -1), 1));
  return sun;
}

static bool is_sun(const search *all, const spot *of, float brightest) {
  if (!(of->brightness >= LEAST_SHARE * all->total)) return false;
  return brightness_of(of->around) <= MOST_AROUND * (double)brightest && sun_of_spot(of).half_angle <= WIDEST;
}

/* ---- the search ---- */

static int brightest_row(const search *all) {
  int best = 0;
  for (int row = 1; row < all->sky->height; row++)
    if (all->peaks[row].brightness > all->peaks[best].brightness) best = row;
  return best;
}

static void leave_out(search *all, vec3 middle, double radius) {
  cap *out = &all->left_out[all->left_out_count++];
  *out = (cap){middle, fmin(2 * radius, FARTHEST)};
  renew_peaks(all, out);
}

static size_t image_bytes(const hl_sky *sky) {
  return (size_t)sky->width * (size_t)sky->height * 3 * sizeof(float);
}

/* Takes a sun's light out of the image. For the first sun, the image is copied. */
static hl_status take_out(hl_context *context, search *all, const spot *sun, sky_suns *found,
                          hl_error *error) {
  size_t bytes = image_bytes(all->sky);
  if (found->rest == NULL) {
    found->rest = hl_allocate(context, bytes, 1);
    if (found->rest == NULL) return hl_fail_memory(error, bytes, "the suns of a sky's image");
    memcpy(found->rest, all->pixels, bytes);
    all->pixels = found->rest;
  }
  found->suns[found->count++] = sun_of_spot(sun);
  visit_cap(all, &sun->cap, -1, take_beyond, &(taking){sun, found->rest});
  renew_peaks(all, &sun->cap);
  return HL_OK;
}

static hl_status find_all(hl_context *context, search *all, sky_suns *found, hl_error *error) {
  hl_status status = HL_OK;
  while (status == HL_OK && found->count < HL_MOST_SUNS && all->left_out_count < TRIES) {
    int row = brightest_row(all), column = all->peaks[row].column;
    float brightest = all->peaks[row].brightness;
    if (!((double)brightest > FAR_ABOVE * all->mean)) break;
    spot best = find_spot(all, row, column);
    if (is_sun(all, &best, brightest)) status = take_out(context, all, &best, found, error);
    else leave_out(all, direction_of(all, row, column), best.cap.radius);
  }
  return status;
}

static void set_up(search *all) {
  const hl_sky *sky = all->sky;
  double turn = 2 * HL_PI / sky->width, solid_angle = 0;
  all->wide = turn;
  /* the integral of (1 - |t| / turn) cos t over t from -turn to turn (derived) */
  all->bend = 2 * (1 - hl_cos(turn)) / turn;
  for (int column = 0; column < sky->width; column++) {
    double angle = (column + 0.5 - 0.5 * sky->width) * turn;
    all->columns[column][0] = hl_sin(angle);
    all->columns[column][1] = hl_cos(angle);
  }
  for (int row = 0; row < sky->height; row++) {
    double sum = 0;
    all->rows[row] = integrals_of_row(sky, row);
    for (int column = 0; column < sky->width; column++)
      sum += (double)brightness_of(pixel_of(all, row, column));
    all->total += sum * all->rows[row].area * all->wide;
    solid_angle += sky->width * all->rows[row].area * all->wide;
    find_row_peak(all, row);
  }
  all->mean = all->total / solid_angle;
}

hl_status hl_suns_find(hl_context *context, const hl_sky *sky, sky_suns *found, hl_error *error) {
  *found = (sky_suns){.count = 0};
  if (sky->type != HL_SKY_IMAGE) return HL_OK;
  size_t width = (size_t)sky->width, height = (size_t)sky->height;
  search all = {.sky = sky,
                .pixels = sky->pixels,
                .rows = hl_allocate(context, height, sizeof *all.rows),
                .columns = hl_allocate(context, width, sizeof *all.columns),
                .peaks = hl_allocate(context, height, sizeof *all.peaks)};
  hl_status status = HL_OK;
  if (all.rows == NULL || all.columns == NULL || all.peaks == NULL) {
    status = hl_fail_memory(error, (width + height) * sizeof *all.columns, "the suns of a sky's image");
  } else {
    set_up(&all);
    status = find_all(context, &all, found, error);
  }
  hl_release(context, all.rows);
  hl_release(context, all.columns);
  hl_release(context, all.peaks);
  return status;
}

void hl_suns_release(hl_context *context, sky_suns *found) {
  hl_release(context, found->rest);
  *found = (sky_suns){.count = 0};
}

/* ---- lights ---- */

/* Makes the parallel light that shines as a sun does. Derived: a sky whose irradiance E comes from about one
 * direction gives a surface E / pi times the dot product of its normal with the mean of the sky's directions,
 * and a medium E / (4 pi) times its phase function (halflight/light.h). A light of colour I gives a surface I
 * times the cosine to the light's middle, and a medium I times the phase function. So for surfaces, I is E /
 * pi times the length of the mean of the sky's directions. For media, I would have to be E / (4 pi), so that
 * a medium takes only the fraction 1 / (4 length) of the light (hl_sun_part_of_media). */
hl_light hl_sun_light(const hl_sky *sky, const sky_sun *sun) {
  const sky_axes axes = hl_sky_axes(sky);
  hl_light light;
  hl_light_defaults(&light);
  vec3 towards = vec3_add(
      vec3_add(vec3_scale(axes.right, sun->towards.x), vec3_scale(axes.middle, sun->towards.y)),
      vec3_scale(axes.up, sun->towards.z));
  light.type = HL_LIGHT_DIRECTIONAL;
  light.direction[0] = -towards.x, light.direction[1] = -towards.y, light.direction[2] = -towards.z;
  light.angular_diameter_deg = 2 * sun->half_angle * 180 / HL_PI;
  for (int c = 0; c < 3; c++) light.color[c] = sun->irradiance[c] * sky->strength * sun->straight / HL_PI;
  light.intensity = 1;
  return light;
}
