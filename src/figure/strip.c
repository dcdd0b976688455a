/* figure/strip.c - draws the strip of a legend.
 *
 * The strip shows the function's own colours, as a fully lit surface has them. The curve beside the strip
 * shows the opacity: it touches the strip where the opacity is 0, and lies farthest from it at the greatest
 * opacity. If all values of the strip have the same opacity, no curve of opacity is drawn. A function whose
 * colours were spread by logarithms has a logarithmic strip, on which each colour takes the same length. */
#include "figure/strip.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "elementary/elementary.h"
#include "text/plain.h"

enum { STEPS_BETWEEN_POINTS = 8, CURVE_STEPS = 256, TICKS_MOST = 6, NUMBER_BYTES = 40 };

/* lengths in the strip, in units of the letters' size */
static const double strip_width = 1.1, curve_width = 1.6, gap = 0.45, tick = 0.3;

/* ---- the scale ---- */

bool hl_strip_is_even(const hl_transfer_function *function) {
  for (size_t p = 1; p < function->opacity_count; p++)
    if (function->opacity[p].opacity != function->opacity[0].opacity) return false;
  return function->color_count > 1 &&
         function->color[0].value < function->color[function->color_count - 1].value;
}

/* Whether all values from low to high have the same opacity. */
static bool is_even_between(const hl_transfer_function *function, double low, double high) {
  const double opacity = hl_transfer_function_opacity(function, low);
  bool even = hl_transfer_function_opacity(function, high) == opacity;
  for (size_t p = 0; p < function->opacity_count; p++) {
    const hl_opacity_point *point = &function->opacity[p];
    even &= point->value < low || point->value > high || point->opacity == opacity;
  }
  return even;
}

hl_strip_scale hl_strip_scale_of(const hl_transfer_function *function, const double range[2]) {
  return (hl_strip_scale){.low = range[0],
                          .high = range[1],
                          .logarithmic = range[0] > 0 && hl_transfer_function_scale(function) == HL_RANGE_LOG,
                          .even = is_even_between(function, range[0], range[1])};
}

/* Returns the place of a value along the strip, from 0 at the lower end to 1 at the upper end. */
static double part_of(const hl_strip_scale *scale, double value) {
  if (scale->logarithmic) return hl_ln(value / scale->low) / hl_ln(scale->high / scale->low);
  return (value - scale->low) / (scale->high - scale->low);
}

/* Returns the value at a place along the strip, from 0 at the lower end to 1 at the upper end. */
static double value_at(const hl_strip_scale *scale, double part) {
  if (scale->logarithmic) return scale->low * hl_pow(scale->high / scale->low, part);
  return scale->low + part * (scale->high - scale->low);
}

/* ---- the colours ---- */

/* Adds a colour to the strip's gradient, which runs from its lower end to its upper end. */
static void add_stop(cairo_pattern_t *pattern, double part, const double color[3], cairo_t *scratch) {
  double r, g, b, a;
  hl_ink_source(scratch, color, 1);
  cairo_pattern_get_rgba(cairo_get_source(scratch), &r, &g, &b, &a);
  cairo_pattern_add_color_stop_rgb(pattern, part, r, g, b);
}

/* Adds the colours of a transfer function between two of its neighbouring points to the strip's gradient. The
 * colours are linear in light, and so need several stops in sRGB. */
static void add_stretch(cairo_pattern_t *pattern, const hl_strip_scale *scale, const hl_color_point *from,
                        const hl_color_point *to, cairo_t *scratch) {
  const int steps = to->value > from->value ? STEPS_BETWEEN_POINTS : 1;
  for (int s = 0; s < steps; s++) {
    double part = (double)s / steps, color[3];
    for (int c = 0; c < 3; c++) color[c] = from->color[c] + part * (to->color[c] - from->color[c]);
    add_stop(pattern, part_of(scale, from->value + part * (to->value - from->value)), color, scratch);
  }
  add_stop(pattern, part_of(scale, to->value), to->color, scratch);
}

/* Makes the gradient of a strip. bottom, top: places of the strip's ends on the page. */
static cairo_pattern_t *make_pattern(const hl_transfer_function *function, const hl_strip_scale *scale,
                                     double bottom, double top, cairo_t *scratch) {
  cairo_pattern_t *pattern = cairo_pattern_create_linear(0, bottom, 0, top);
  hl_color_point from = {.value = scale->low}, to = {.value = scale->high};
  hl_transfer_function_color(function, from.value, from.color);
  for (size_t p = 0; p < function->color_count; p++) {
    const hl_color_point *point = &function->color[p];
    if (point->value <= scale->low || point->value >= scale->high) continue;
    add_stretch(pattern, scale, &from, point, scratch);
    from = *point;
  }
  hl_transfer_function_color(function, to.value, to.color);
  add_stretch(pattern, scale, &from, &to, scratch);
  return pattern;
}

/* Draws the part of the strip at which matter has its own colour. */
static void draw_own(const hl_ink *ink, const hl_strip_scale *scale, double x, double bottom, double top) {
  double ends[2];
  for (int n = 0; n < 2; n++) {
    const double part = part_of(scale, fmin(fmax(scale->own[n], scale->low), scale->high));
    ends[n] = bottom + part * (top - bottom);
  }
  if (!(ends[1] < ends[0])) return;
  cairo_rectangle(ink->cairo, x - strip_width * ink->size, ends[1], strip_width * ink->size,
                  ends[0] - ends[1]);
  hl_ink_source(ink->cairo, scale->own_color, 1);
  cairo_fill(ink->cairo);
}

/* Draws the curve of opacity, to the left of the place x. */
static void draw_curve(const hl_ink *ink, const hl_transfer_function *function, const hl_strip_scale *scale,
                       double x, double bottom, double top) {
  cairo_t *cairo = ink->cairo;
  double greatest = 0;
  for (size_t p = 0; p < function->opacity_count; p++)
    greatest = fmax(greatest, function->opacity[p].opacity);
  cairo_new_path(cairo);
  cairo_move_to(cairo, x, bottom);
  for (int s = 0; s <= CURVE_STEPS; s++) {
    double part = (double)s / CURVE_STEPS;
    double opacity = hl_transfer_function_opacity(function, value_at(scale, part));
    cairo_line_to(cairo, x - curve_width * ink->size * opacity / greatest, bottom + part * (top - bottom));
  }
  cairo_line_to(cairo, x, top);
  cairo_close_path(cairo);
  cairo_set_source_rgba(cairo, ink->color, ink->color, ink->color, 0.3);
  cairo_fill_preserve(cairo);
  hl_ink_stroke(ink, 0.06 * ink->size);
}

/* ---- the numbers ---- */

/* The numbers beside a strip: the multiples of `step` or, if `decades` is set, the powers of ten whose
 * exponents are multiples of `step`. */
typedef struct numbers {
  double step;
  bool decades;
} numbers;

/* The least number of the form 1, 2 or 5 times a power of ten that is at least `least`. */
static double round_step(double least) {
  double power = hl_pow(10, floor(hl_log10(least)));
  static const double steps[] = {1, 2, 5, 10};
  for (int s = 0; s < 3; s++)
    if (steps[s] * power >= least * (1 - 1e-9)) return steps[s] * power;
  return 10 * power;
}

static double first_of(double low, double step) { return ceil(low / step - 1e-9); }

/* Returns whether at least two multiples of a step lie between `low` and `high`. */
static bool has_two(double low, double high, double step) {
  return (first_of(low, step) + 1) * step <= high + 1e-9 * step;
}

/* Returns the numbers beside a strip that has room for `ticks` numbers. The strip gets at least two
 * numbers, even if they are crowded, because a single number tells no scale. A logarithmic strip without
 * two powers of ten has multiples of a step. */
static numbers choose_numbers(const hl_strip_scale *scale, double ticks) {
  if (scale->logarithmic) {
    const double low = hl_log10(scale->low), high = hl_log10(scale->high);
    double step = fmax(1, ceil((high - low) / fmax(ticks, 1) - 1e-9));
    while (step > 1 && !has_two(low, high, step)) step--;
    if (has_two(low, high, step)) return (numbers){step, true};
  }
  double step = round_step((scale->high - scale->low) / fmax(ticks, 1));
  while (!has_two(scale->low, scale->high, step)) step = round_step(0.4 * step);
  return (numbers){step, false};
}

/* Writes a power of ten with its exponent in superior figures. */
static void write_power(double exponent, char text[NUMBER_BYTES]) {
  static const char *const figures[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                        "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  char plain[NUMBER_BYTES / 4];
  hl_plain_print(plain, sizeof plain, "%.0f", fabs(exponent));
  size_t length = (size_t)snprintf(text, NUMBER_BYTES, "10%s", exponent < 0 ? "\u207b" : "");
  for (const char *digit = plain; *digit != '\0'; digit++)
    length += (size_t)snprintf(text + length, NUMBER_BYTES - length, "%s", figures[*digit - '0']);
}

static void write_number(double value, double step, const hl_strip_scale *scale, char text[NUMBER_BYTES]) {
  double greatest = fmax(fabs(scale->low), fabs(scale->high));
  int decimals = step < 1 ? (int)ceil(-hl_log10(step) - 1e-9) : 0;
  if (fabs(value) < step / 1e6) value = 0;
  if (greatest >= 1e6 || step < 1e-4) hl_plain_print(text, NUMBER_BYTES, "%.4g", value);
  else hl_plain_print(text, NUMBER_BYTES, "%.*f", decimals, value);
}

/* Writes the n-th multiple of the numbers' step. Returns the value that it stands for. */
static double write_multiple(const numbers *shown, double n, const hl_strip_scale *scale,
                             char text[NUMBER_BYTES]) {
  const double multiple = n * shown->step;
  if (shown->decades) write_power(multiple, text);
  else write_number(multiple, shown->step, scale, text);
  return shown->decades ? hl_pow(10, multiple) : multiple;
}

static void draw_number(const hl_ink *ink, const char *text, double x, double y) {
  cairo_new_path(ink->cairo);
  cairo_move_to(ink->cairo, x, y);
  cairo_line_to(ink->cairo, x + tick * ink->size, y);
  hl_ink_stroke(ink, 0.08 * ink->size);
  hl_ink_text(ink,
              &(hl_line_of_text){.text = text, .x = x + (tick + gap) * ink->size, .y = y, .align_y = 0.5});
}

/* Returns the width of the numbers beside a strip, and draws the numbers if `draws` is set. x: their left
 * edge. */
static double draw_numbers(const hl_ink *ink, const hl_strip_scale *scale, double x, double bottom,
                           double top, bool draws) {
  const numbers shown = choose_numbers(scale, fmin(TICKS_MOST, (bottom - top) / (1.6 * ink->size)));
  const double low = shown.decades ? hl_log10(scale->low) : scale->low;
  const double high = shown.decades ? hl_log10(scale->high) : scale->high;
  double widest = 0;
  for (double n = first_of(low, shown.step); n * shown.step <= high + 1e-9 * shown.step; n++) {
    char text[NUMBER_BYTES];
    double width, line;
    const double value = write_multiple(&shown, n, scale, text);
    hl_ink_measure(ink, &(hl_line_of_text){.text = text}, &width, &line);
    widest = fmax(widest, width);
    if (draws) draw_number(ink, text, x, bottom + part_of(scale, value) * (top - bottom));
  }
  return widest + (tick + gap) * ink->size;
}

/* ---- all steps together ---- */

double hl_strip_width(const hl_ink *ink, const hl_strip_scale *scale, double height) {
  return draw_numbers(ink, scale, 0, height, 0, false) +
         (strip_width + (scale->even ? 0 : curve_width)) * ink->size;
}

void hl_strip_draw(const hl_ink *ink, const hl_transfer_function *function, const hl_strip_scale *scale,
                   double right, double top, double height) {
  const double bottom = top + height, wide = strip_width * ink->size;
  const double x = right - draw_numbers(ink, scale, 0, bottom, top, false);
  cairo_t *cairo = ink->cairo;
  cairo_save(cairo);
  cairo_pattern_t *pattern = make_pattern(function, scale, bottom, top, cairo);
  cairo_restore(cairo);
  if (!scale->even) draw_curve(ink, function, scale, x - wide, bottom, top);
  cairo_rectangle(cairo, x - wide, top, wide, height);
  hl_ink_stroke(ink, 0.12 * ink->size);
  cairo_rectangle(cairo, x - wide, top, wide, height);
  cairo_set_source(cairo, pattern);
  cairo_fill(cairo);
  cairo_pattern_destroy(pattern);
  draw_own(ink, scale, x, bottom, top);
  draw_numbers(ink, scale, x, bottom, top, true);
}
