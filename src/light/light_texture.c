/* light/light_texture.c - places a light texture, averages it to the picture's pixels and blurs it by the
 * light's shape. */
#include "light/light_texture.h"

#include "core/context.h"
#include "core/memory.h"
#include "elementary/elementary.h"
#include "scene/light/light_kind.h"
#include "view/view.h"

/* The light's view through its screen; the view's pixels are the pixels of the projected image. Derived: let
 * the screen have the middle c and the half edges R and U. A sample x lies on the ray through the screen's
 * point c + s R + t U. For a light at P, x - P = w (c - P + s R + t U); for parallel light along d, x = c + s
 * R + t U + k d. The three components of each equation are linear equations for s, t and a third unknown, w
 * or k. */
static view view_of_screen(const light_source *source, int width, int height) {
  vec3 corner = vec3_add(vec3_subtract(source->screen.center, source->screen.right), source->screen.up);
  view view = {.perspective = !source->parallel,
               .width = width,
               .height = height,
               .origin = source->position,
               .corner = source->parallel ? corner : vec3_subtract(corner, source->position),
               .du = vec3_scale(source->screen.right, 2.0 / width),
               .dv = vec3_scale(source->screen.up, -2.0 / height),
               .direction = source->direction};
  hl_view_finish(&view);
  return view;
}

/* The length of a vector of the screen after the light has projected it to the content's middle. The length
 * is measured at a right angle to the light's ray at the content's middle. If the content lies between the
 * light and the screen, the vector keeps its length. */
static double length_at_content(const light_source *source, const view *view, vec3 step, vec3 content) {
  vec3 way = source->direction;
  double magnified = 1;
  if (!source->parallel) {
    vec3 offset = vec3_subtract(content, source->position);
    magnified = fmax(mat3_apply(view->inverse, offset).x, 1);
    if (vec3_length(offset) > 0) way = vec3_normalise(offset);
  }
  return magnified * vec3_length(vec3_subtract(step, vec3_scale(way, vec3_dot(step, way))));
}

/* ---- convolution along one axis ---- */

/* The weights with which pixels of an image are added up, for each pixel of a result along one axis. */
typedef struct axis_weights {
  int count, taps;
  int *first;     /* owned; [count]; for each pixel of the result, the first weighted pixel of the image. All
                   * weighted pixels lie in the image, because outside the image there is no light */
  float *weights; /* owned; [count][taps] */
} axis_weights;

/* The type of a function that gives the fraction of a kernel's area that lies below x. The kernel reaches
 * from -1 to 1. */
typedef double kernel_fraction(double x);

static double box_below(double x) { return fmin(fmax((x + 1) / 2, 0), 1); }

/* Derived: the part of a disk of radius 1 that lies below x has the area x sqrt(1 - x^2) + asin x + pi /
 * 2. */
static double disk_below(double x) {
  if (x <= -1) return 0;
  if (x >= 1) return 1;
  return 0.5 + (x * sqrt(1 - x * x) + hl_asin(x)) / HL_PI;
}

/* A convolution along one axis. Pixel i of the result is a weighted mean of the image; the middle of its
 * kernel lies at start + (i + 1/2) step. */
typedef struct axis_plan {
  int count;                      /* number of result pixels */
  double start, step, half_width; /* The middle of the first kernel's pixel, the distance between kernels, and
                                   * half of a kernel's width; in pixels of the image that is convolved */
} axis_plan;

/* Finds the weights of a convolution along one axis. length: the number of the image's pixels along the
 * axis. */
static hl_status weigh_axis(hl_context *context, kernel_fraction *below, const axis_plan *plan, int length,
                            axis_weights *axis, hl_error *error) {
  double half_width = plan->half_width;
  axis->count = plan->count;
  axis->taps = (int)fmin(ceil(2 * half_width) + 2, length);
  size_t taps = (size_t)axis->taps, count = (size_t)axis->count;
  axis->first = hl_allocate(context, count, sizeof *axis->first);
  axis->weights = hl_allocate(context, count, taps * sizeof *axis->weights);
  if (axis->first == NULL || axis->weights == NULL)
    return hl_fail_memory(error, count * taps * sizeof(float), "a light's texture");
  for (int i = 0; i < axis->count; i++) {
    double middle = plan->start + (i + 0.5) * plan->step;
    int first = (int)fmin(fmax(floor(middle - half_width), 0), length - axis->taps);
    axis->first[i] = first;
    for (int tap = 0; tap < axis->taps; tap++)
      axis->weights[(size_t)i * taps + (size_t)tap] = (float)(below((first + tap + 1 - middle) / half_width) -
                                                              below((first + tap - middle) / half_width));
  }
  return HL_OK;
}

static void release_axis(hl_context *context, axis_weights *axis) {
  hl_release(context, axis->first);
  hl_release(context, axis->weights);
}

/* Convolves one line of pixels with three channels. from_step, to_step: the number of floats from one pixel
 * to the next. */
static void convolve_line(const float *from, size_t from_step, const axis_weights *axis, float *to,
                          size_t to_step) {
  for (int i = 0; i < axis->count; i++) {
    const float *weights = axis->weights + (size_t)i * (size_t)axis->taps;
    const float *pixel = from + (size_t)axis->first[i] * from_step;
    float sum[3] = {0, 0, 0};
    for (int tap = 0; tap < axis->taps; tap++, pixel += from_step)
      for (size_t c = 0; c < 3; c++) sum[c] += weights[tap] * pixel[c];
    for (size_t c = 0; c < 3; c++) to[(size_t)i * to_step + c] = sum[c];
  }
}

enum { LINES_BETWEEN_QUESTIONS = 16 };

typedef struct texture_image {
  const float *pixels; /* [height][width][3]; linear RGB */
  int width, height;
} texture_image;

/* Convolves an image: first along its rows, then along its columns. */
static hl_status convolve(hl_context *context, const texture_image *from, const axis_weights *u,
                          const axis_weights *v, float *to, hl_error *error) {
  size_t width = (size_t)from->width;
  int height = from->height;
  size_t narrow_width = (size_t)u->count * 3;
  float *narrow = hl_allocate(context, narrow_width, (size_t)height * sizeof *narrow);
  if (narrow == NULL)
    return hl_fail_memory(error, narrow_width * (size_t)height * sizeof *narrow, "a light's texture");
  bool cancelled = false;
  for (int y = 0; y < height && !cancelled; y++) {
    convolve_line(from->pixels + 3 * (size_t)y * width, 3, u, narrow + (size_t)y * narrow_width, 3);
    cancelled = y % LINES_BETWEEN_QUESTIONS == 0 && hl_cancelled(context);
  }
  for (int x = 0; x < u->count && !cancelled; x++) {
    convolve_line(narrow + 3 * (size_t)x, narrow_width, v, to + 3 * (size_t)x, narrow_width);
    cancelled = x % LINES_BETWEEN_QUESTIONS == 0 && hl_cancelled(context);
  }
  hl_release(context, narrow);
  return cancelled ? hl_fail(error, HL_ERROR_CANCELLED, "cancelled while preparing") : HL_OK;
}

/* The two convolutions that make one blurred level of a texture: along u and along v. */
typedef struct level_plan {
  axis_plan axis[2];
} level_plan;

static hl_status make_level(hl_context *context, kernel_fraction *below, const texture_image *from,
                            const level_plan *plan, float *to, hl_error *error) {
  axis_weights u = {0}, v = {0};
  hl_status status = weigh_axis(context, below, &plan->axis[0], from->width, &u, error);
  if (status == HL_OK) status = weigh_axis(context, below, &plan->axis[1], from->height, &v, error);
  if (status == HL_OK) status = convolve(context, from, &u, &v, to, error);
  release_axis(context, &u);
  release_axis(context, &v);
  return status;
}

/* ---- blur by the light's extent ---- */

/* The standard deviations, along u and v, by which the light's extent blurs the image; in pixels of the
 * image. For parallel light, the deviations hold at the distance 1 behind the screen, for near light at an
 * infinite distance. The deviations are the light's spread, projected onto the screen along the ray to the
 * content's middle. */
static void spread_on_screen(const light_source *source, const view *view, vec3 content,
                             double deviation[2]) {
  vec3 ray = source->parallel ? source->direction : vec3_normalise(vec3_subtract(content, source->position));
  mat3 inverse, spread = source->spread;
  if (source->shape.kind->sphere) /* a sphere counts as the disk that faces the content */
    spread = source->shape.kind->spread(&source->shape, vec3_scale(ray, -1));
  deviation[0] = deviation[1] = 0;
  if (source->shadows != HL_SHADOWS_SOFT ||
      !mat3_invert(mat3_from_columns(ray, view->du, view->dv), &inverse))
    return;
  for (int axis = 0; axis < 2; axis++) {
    vec3 row = inverse.row[1 + axis];
    deviation[axis] = sqrt(fmax(vec3_dot(row, mat3_apply(spread, row)), 0));
  }
}

/* The factor by which the image's blur at a point is scaled. For parallel light it is the point's distance
 * from the screen; for a near light it is |1 - Zs / Z|, where Zs and Z are the distances of the screen and of
 * the point from the light. */
static double blur_at(const light_source *source, const view *view, vec3 point) {
  if (source->parallel) return fabs(mat3_apply(view->inverse, vec3_subtract(point, view->corner)).x);
  double w = mat3_apply(view->inverse, vec3_subtract(point, view->origin)).x;
  return fabs(1 - 1 / fmax(w, 0.05));
}

/* FIRST_BLUR: the standard deviation of level 0's blur, in pixels of the picture. Each level's standard
 * deviation is sqrt(2) times the standard deviation of the level before. The edge of a level's pixel is
 * LEVEL_PIXEL times the level's standard deviation, but at least LEAST_PIXEL times the edge of a picture's
 * pixel. The edge is larger if a side of the level would otherwise have more than GREATEST_LEVEL_SIDE pixels.
 */
static const double FIRST_BLUR = 1.4, LEVEL_PIXEL = 0.5, LEAST_PIXEL = 0.7;
enum { GREATEST_LEVEL_SIDE = 8192 };

static level_plan plan_level(const light_texture *texture, const double deviation[2], double half_widths,
                             double blur) {
  level_plan plan;
  const int image[2] = {texture->width, texture->height};
  for (int axis = 0; axis < 2; axis++) {
    double sigma = deviation[axis] * blur, least = LEAST_PIXEL / (double)texture->sharpness[axis];
    axis_plan *along = &plan.axis[axis];
    along->half_width = fmax(half_widths * sigma, 0.5 / (double)texture->sharpness[axis]);
    double extent = image[axis] + 2 * along->half_width;
    along->step = fmax(fmax(sigma * LEVEL_PIXEL, least), extent / (GREATEST_LEVEL_SIDE - 4));
    along->count = (int)fmin(ceil(extent / along->step + 4),
                             GREATEST_LEVEL_SIDE); /* two more pixels on either side */
    along->start = (image[axis] - along->count * along->step) / 2;
  }
  return plan;
}

/* Makes the blurred levels of a texture. The texture's memory begins with the averaged image, which has
 * `averaged` floats, followed by the levels. */
static hl_status make_levels(hl_context *context, const light_source *source, const view *view,
                             const texture_use *use, light_texture *texture, size_t averaged,
                             hl_error *error) {
  double deviation[2], widest = 0, reach = 0;
  level_plan plans[TEXTURE_LEVELS];
  const bool box = source->shape.kind->parallelogram;
  kernel_fraction *below = box ? box_below : disk_below;
  double half_widths = box ? sqrt(3) : 2; /* half of the kernel's width, in standard deviations of the
                                           * kernel */
  spread_on_screen(source, view, use->content, deviation);
  for (int axis = 0; axis < 2; axis++)
    widest = fmax(widest, deviation[axis] * (double)texture->sharpness[axis]);
  for (int i = 0; i < use->point_count; i++) reach = fmax(reach, blur_at(source, view, use->points[i]));
  if (!(widest * reach > 0.25))
    return HL_OK; /* the blur is below a quarter of a pixel of the picture, so the texture needs no levels */
  double first = FIRST_BLUR / widest;
  size_t floats = 0;
  while (texture->level_count < TEXTURE_LEVELS) {
    int l = texture->level_count++;
    plans[l] = plan_level(texture, deviation, half_widths, first * hl_pow(2, 0.5 * l));
    floats += (size_t)plans[l].axis[0].count * (size_t)plans[l].axis[1].count * 3;
    if (first * hl_pow(2, 0.5 * l) >= reach) break;
  }
  texture->first = (float)(1 / (first * first));
  for (int axis = 0; axis < 2; axis++) texture->edge[axis] = (float)(sqrt(12) * deviation[axis]);
  float *memory = hl_reallocate(context, texture->memory, averaged + floats, sizeof *memory);
  if (memory == NULL) return hl_fail_memory(error, floats * sizeof *memory, "a light's texture");
  texture->memory = memory;
  if (averaged > 0) texture->pixels = memory;
  const texture_image image = {texture->pixels, texture->width, texture->height};
  float *to = memory + averaged;
  for (int l = 0; l < texture->level_count; l++) {
    texture_level *level = &texture->level[l];
    const axis_plan *along = plans[l].axis;
    *level = (texture_level){.pixels = to, .width = along[0].count, .height = along[1].count};
    for (int axis = 0; axis < 2; axis++) {
      level->scale[axis] = (float)(1 / along[axis].step);
      level->shift[axis] = (float)(-along[axis].start / along[axis].step);
    }
    hl_status status = make_level(context, below, &image, &plans[l], to, error);
    if (status != HL_OK) return status;
    to += (size_t)level->width * (size_t)level->height * 3;
  }
  return HL_OK;
}

/* ---- the screen ---- */

/* The number of pixels along a side of the averaged image: the length of the projected image's side in pixels
 * of the picture, but at most the image's own number of pixels. */
static int resolution(double length, int count, double pixel, float *sharpness) {
  double wanted = ceil(length / pixel);
  int chosen = wanted < 1 ? 1 : wanted < count ? (int)wanted : count;
  *sharpness = (float)fmax(length / chosen / pixel, 1);
  return chosen;
}

static hl_status average_image(hl_context *context, const light_picture *described, light_texture *texture,
                               hl_error *error) {
  const texture_image image = {described->pixels, described->width, described->height};
  double step_u = (double)described->width / texture->width,
         step_v = (double)described->height / texture->height;
  const level_plan plan = {
      {{texture->width, 0, step_u, step_u / 2}, {texture->height, 0, step_v, step_v / 2}}};
  texture->memory = hl_allocate(context, (size_t)texture->width * (size_t)texture->height,
                                3 * sizeof *texture->memory);
  if (texture->memory == NULL)
    return hl_fail_memory(error, (size_t)texture->width * (size_t)texture->height * 12, "a light's texture");
  texture->pixels = texture->memory;
  return make_level(context, box_below, &image, &plan, texture->memory, error);
}

static void store_row(float to[4], const double from[4]) {
  for (int column = 0; column < 4; column++) to[column] = (float)from[column];
}

hl_status hl_light_texture_create(hl_context *context, const light_source *source, const texture_use *use,
                                  light_texture *texture, hl_error *error) {
  const light_picture *described = &source->screen.picture;
  *texture = (light_texture){.pixels = described->pixels, .parallel = source->parallel};
  if (described->pixels == NULL) return HL_OK;
  view whole = view_of_screen(source, 1, 1);
  double right = 2 * length_at_content(source, &whole, source->screen.right, use->content);
  double up = 2 * length_at_content(source, &whole, source->screen.up, use->content);
  texture->width = resolution(right, described->width, use->pixel, &texture->sharpness[0]);
  texture->height = resolution(up, described->height, use->pixel, &texture->sharpness[1]);
  view view = view_of_screen(source, texture->width, texture->height);
  double rows[3][4];
  hl_view_homogeneous(&view, affine3_identity(), rows);
  for (int row = 0; row < 3; row++) store_row(texture->map[row], rows[row]);
  vec3 along = view.inverse.row[0];
  store_row(texture->beyond, (double[4]){along.x, along.y, along.z, -vec3_dot(along, view.corner)});
  size_t averaged = 0;
  hl_status status = HL_OK;
  if (texture->width != described->width || texture->height != described->height) {
    status = average_image(context, described, texture, error);
    averaged = (size_t)texture->width * (size_t)texture->height * 3;
  }
  return status == HL_OK ? make_levels(context, source, &view, use, texture, averaged, error) : status;
}

void hl_light_texture_release(hl_context *context, light_texture *texture) {
  hl_release(context, texture->memory);
}
