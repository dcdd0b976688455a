/* figure/legend.c - draws the legend, which explains the colours of the picture. Each visible volume has a
 * part: a strip with its transfer function's colours and opacity over its values, or rows for its isosurfaces
 * or its labels.
 *
 * The strip shows the function's own colours, as a fully lit surface has them. Its range begins at the least
 * value with opacity and ends at the greatest, unless the overlay states it. The curve beside the strip shows
 * the opacity: it touches the strip where the opacity is 0, and lies farthest from it at the greatest opacity
 * in the range. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "figure/overlay.h"
#include "scene/function/transfer_function.h"
#include "text/plain.h"
#include "text/stem.h"
#include "text/units.h"

enum {
  STEPS_BETWEEN_POINTS = 8,
  CURVE_STEPS = 256,
  TICKS_MOST = 6,
  TITLE_LINES_MOST = 4,
  ROW_LINES_MOST = 3,
  NUMBER_BYTES = 40,
  NAME_BYTES = 64
};

/* lengths in the legend, in units of the letters' size */
static const double row = 1.35, strip_width = 1.1, curve_width = 1.6, gap = 0.45, swatch = 0.9;
/* A title that is at most this wide has one line, also if all else in the legend is narrower. */
static const double title_width = 10;

/* The state of drawing the legend, from its top downwards. */
typedef struct legend {
  const hl_ink *ink;
  const hl_overlay_place *place;
  double right, bottom; /* the legend's right and lower edge, points */
  double y;             /* the place of the top of the next volume's part on the page, points */
  double strip_height;  /* height of a strip of colours, points */
  size_t left_out;      /* the number of rows without room */
  double body;          /* the greatest width of a strip with its curve and numbers, or of a row; points */
} legend;

/* ---- what a volume has ---- */

static bool has_strip(const hl_scene_volume *volume) {
  const hl_transfer_function *function = &volume->transfer_function;
  if (volume->label_count > 0) return false;
  for (size_t p = 0; p < function->opacity_count; p++)
    if (function->opacity[p].opacity > 0) return true;
  return false;
}

static size_t count_rows(const hl_scene_volume *volume) {
  size_t count = volume->iso_count;
  for (size_t l = 0; l < volume->label_count; l++) count += volume->labels[l].visible != 0;
  for (size_t l = 0; l < volume->mask.label_count; l++)
    count += volume->mask.labels[l].visible != 0 && volume->mask.labels[l].tint > 0;
  return count;
}

/* The title of a volume's part of the legend; null if the part has no title. Of several volumes, a volume
 * without a name has the name of its file, without folder and extension. name: [NAME_BYTES], room for it. */
static const char *title_of(const hl_overlay_place *place, const hl_scene_volume *volume, bool first,
                            char *name) {
  if (first && place->overlay->legend_title != NULL) return place->overlay->legend_title;
  if (volume->name != NULL && volume->name[0] != '\0') return volume->name;
  for (size_t a = 0; a < hl_volume_array_count(volume->volume); a++) {
    hl_volume_array array = {.struct_size = sizeof array};
    if (hl_volume_get_array(volume->volume, a, &array) == HL_OK && array.chosen && array.name[0] != '\0')
      return array.name;
  }
  if (place->scene->volume_count < 2 || volume->file == NULL) return NULL;
  size_t length;
  const char *stem = hl_stem(volume->file, &length);
  snprintf(name, NAME_BYTES, "%.*s", (int)length, stem);
  return name;
}

/* ---- rows: a colour and a name ---- */

/* The width of the text of one row of the legend, points. */
static double widest_row(const legend *made, const char *text) {
  double width, height;
  hl_ink_measure(made->ink, &(hl_line_of_text){.text = text}, &width, &height);
  return width;
}

/* The width of the widest word of a text, points. */
static double widest_word(const legend *made, const char *text) {
  char **words = g_strsplit(text, " ", 0);
  double widest = 0;
  for (char **word = words; *word != NULL; word++) widest = fmax(widest, widest_row(made, *word));
  g_strfreev(words);
  return widest;
}

/* The text of a row, beside its swatch. A text that is too wide is broken into lines. *height: the row's
 * height, points. */
static hl_line_of_text lay_row(const legend *made, double left, const char *text, double *height) {
  const double size = made->ink->size, middle = made->y + row * size / 2;
  hl_line_of_text line = {.text = text,
                          .x = left + (swatch + gap) * size,
                          .y = middle,
                          .align_y = 0.5,
                          .wide_most = made->right - left - (swatch + gap) * size + 1,
                          .lines_most = ROW_LINES_MOST};
  double width, high, one;
  hl_ink_measure(made->ink, &line, &width, &high);
  hl_ink_measure(made->ink, &(hl_line_of_text){.text = text}, &width, &one);
  line.y += fmax(high - one, 0) / 2;
  *height = row * size + fmax(high - one, 0);
  return line;
}

static void draw_row(legend *made, double left, const double color[3], const char *text) {
  const double size = made->ink->size, side = swatch * size, middle = made->y + row * size / 2;
  double height;
  const hl_line_of_text line = lay_row(made, left, text, &height);
  cairo_t *cairo = made->ink->cairo;
  cairo_rectangle(cairo, left, middle - side / 2, side, side);
  hl_ink_stroke(made->ink, 0.12 * size);
  cairo_rectangle(cairo, left, middle - side / 2, side, side);
  hl_ink_source(cairo, color, 1);
  cairo_fill(cairo);
  hl_ink_text(made->ink, &line);
  made->y += height;
}

/* Finds the colour and the name that the n-th row of a volume shows. Returns false if the volume has fewer
 * rows. */
static bool row_of(const hl_scene_volume *volume, size_t n, const double **color,
                   char text[NUMBER_BYTES * 4]) {
  const size_t counts[2] = {volume->label_count, volume->mask.label_count};
  const hl_label *lists[2] = {volume->labels, volume->mask.labels};
  for (int list = 0; list < 2; list++)
    for (size_t l = 0; l < counts[list]; l++) {
      const hl_label *label = &lists[list][l];
      if (!label->visible || (list == 1 && !(label->tint > 0)) || n-- > 0) continue;
      *color = label->color;
      if (label->name != NULL && label->name[0] != '\0')
        snprintf(text, NUMBER_BYTES * 4, "%.*s", NUMBER_BYTES * 4 - 1, label->name);
      else snprintf(text, NUMBER_BYTES, "%" PRId64, label->value);
      return true;
    }
  if (n >= volume->iso_count) return false;
  *color = volume->iso[n].color;
  hl_plain_print(text, NUMBER_BYTES, "= %.6g", volume->iso[n].value);
  return true;
}

/* The greatest width of anything in a legend; points. */
static double most_wide(const legend *made) { return 0.45 * made->place->picture.width; }

/* The number of a volume's rows for which the legend could have room. */
static size_t most_rows(const legend *made) {
  const double top = made->place->picture.top + made->place->margin;
  return (size_t)fmax((made->bottom - top) / (row * made->ink->size), 0) + 1;
}

/* Returns whether no row has too many lines in a width. */
static bool rows_fit(const legend *made, const hl_scene_volume *volume, double width) {
  const double size = made->ink->size;
  const double *color;
  char text[NUMBER_BYTES * 4];
  for (size_t n = 0; n < most_rows(made) && row_of(volume, n, &color, text); n++) {
    double wide, high, one;
    hl_line_of_text line = {
        .text = text, .wide_most = width - (swatch + gap) * size + 1, .lines_most = ROW_LINES_MOST + 1};
    hl_ink_measure(made->ink, &line, &wide, &high);
    hl_ink_measure(made->ink, &(hl_line_of_text){.text = text}, &wide, &one);
    if (high > (ROW_LINES_MOST + 0.5) * one) return false;
  }
  return true;
}

/* The width of a volume's rows; 0 if it has none. It is at most the width that the legend's shape states, but
 * for words and rows that need more. */
static double width_of_rows(const legend *made, const hl_scene_volume *volume) {
  const double size = made->ink->size, beside = (swatch + gap) * size;
  double widest = 0, word = 0;
  const double *color;
  char text[NUMBER_BYTES * 4];
  size_t n = 0;
  for (; n < most_rows(made) && row_of(volume, n, &color, text); n++) {
    widest = fmax(widest, widest_row(made, text));
    word = fmax(word, widest_word(made, text));
  }
  double width = fmax(fmin(widest + beside, made->place->legend.width), word + beside);
  while (n > 0 && width < fmin(most_wide(made), widest + beside) && !rows_fit(made, volume, width))
    width += 0.5 * size;
  return n > 0 ? fmin(most_wide(made), width) : 0;
}

/* Draws the rows for which there is room, and says how many are left out. The first row is drawn in any case:
 * a legend that is too high for the picture finds no place in it. */
static void draw_rows(legend *made, const hl_scene_volume *volume) {
  const size_t count = count_rows(volume);
  const double size = made->ink->size, left = made->right - width_of_rows(made, volume);
  const double *color;
  char text[NUMBER_BYTES * 4];
  for (size_t n = 0; row_of(volume, n, &color, text); n++) {
    double height;
    lay_row(made, left, text, &height);
    if (n == 0 || n + 1 == count || made->y + height + row * size <= made->bottom) {
      draw_row(made, left, color, text);
      continue;
    }
    snprintf(text, sizeof text, "\u2026 %zu more", count - n);
    hl_ink_text(made->ink, &(hl_line_of_text){.text = text, .x = made->right, .y = made->y, .align_x = 1});
    made->y += row * size;
    made->left_out += count - n;
    return;
  }
}

/* ---- the strip ---- */

/* Adds a colour to the strip's gradient, which runs from its lower end to its upper end. */
static void add_stop(cairo_pattern_t *pattern, const double range[2], double value, const double color[3],
                     cairo_t *scratch) {
  double r, g, b, a;
  hl_ink_source(scratch, color, 1);
  cairo_pattern_get_rgba(cairo_get_source(scratch), &r, &g, &b, &a);
  cairo_pattern_add_color_stop_rgb(pattern, (value - range[0]) / (range[1] - range[0]), r, g, b);
}

/* Adds the colours of a transfer function between two of its neighbouring points to the strip's gradient. The
 * colours are linear in light, and so need several stops in sRGB. */
static void add_stretch(cairo_pattern_t *pattern, const double range[2], const hl_color_point *from,
                        const hl_color_point *to, cairo_t *scratch) {
  const int steps = to->value > from->value ? STEPS_BETWEEN_POINTS : 1;
  for (int s = 0; s < steps; s++) {
    double part = (double)s / steps, color[3];
    for (int c = 0; c < 3; c++) color[c] = from->color[c] + part * (to->color[c] - from->color[c]);
    add_stop(pattern, range, from->value + part * (to->value - from->value), color, scratch);
  }
  add_stop(pattern, range, to->value, to->color, scratch);
}

/* Makes the gradient of a strip. bottom, top: places of the strip's ends on the page. */
static cairo_pattern_t *make_pattern(const hl_transfer_function *function, const double range[2],
                                     double bottom, double top, cairo_t *scratch) {
  cairo_pattern_t *pattern = cairo_pattern_create_linear(0, bottom, 0, top);
  hl_color_point from = {.value = range[0]}, to = {.value = range[1]};
  hl_transfer_function_color(function, from.value, from.color);
  for (size_t p = 0; p < function->color_count; p++) {
    const hl_color_point *point = &function->color[p];
    if (point->value <= range[0] || point->value >= range[1]) continue;
    add_stretch(pattern, range, &from, point, scratch);
    from = *point;
  }
  hl_transfer_function_color(function, to.value, to.color);
  add_stretch(pattern, range, &from, &to, scratch);
  return pattern;
}

/* Draws the curve of opacity, to the left of the place x. */
static void draw_curve(const legend *made, const hl_transfer_function *function, const double range[2],
                       double x, double bottom, double top) {
  cairo_t *cairo = made->ink->cairo;
  const double size = made->ink->size;
  double greatest = 0;
  for (size_t p = 0; p < function->opacity_count; p++)
    greatest = fmax(greatest, function->opacity[p].opacity);
  cairo_new_path(cairo);
  cairo_move_to(cairo, x, bottom);
  for (int s = 0; s <= CURVE_STEPS; s++) {
    double part = (double)s / CURVE_STEPS, value = range[0] + part * (range[1] - range[0]);
    double opacity = hl_transfer_function_opacity(function, value);
    cairo_line_to(cairo, x - curve_width * size * opacity / greatest, bottom + part * (top - bottom));
  }
  cairo_line_to(cairo, x, top);
  cairo_close_path(cairo);
  cairo_set_source_rgba(cairo, made->ink->color, made->ink->color, made->ink->color, 0.3);
  cairo_fill_preserve(cairo);
  hl_ink_stroke(made->ink, 0.06 * size);
}

/* The least number of the form 1, 2 or 5 times a power of ten that is at least `least`. */
static double round_step(double least) {
  double power = pow(10, floor(log10(least)));
  static const double steps[] = {1, 2, 5, 10};
  for (int s = 0; s < 3; s++)
    if (steps[s] * power >= least * (1 - 1e-9)) return steps[s] * power;
  return 10 * power;
}

static void write_number(double value, double step, const double range[2], char text[NUMBER_BYTES]) {
  double greatest = fmax(fabs(range[0]), fabs(range[1]));
  int decimals = step < 1 ? (int)ceil(-log10(step) - 1e-9) : 0;
  if (fabs(value) < step / 1e6) value = 0;
  if (greatest >= 1e6 || step < 1e-4) hl_plain_print(text, NUMBER_BYTES, "%.4g", value);
  else hl_plain_print(text, NUMBER_BYTES, "%.*f", decimals, value);
}

static double first_number(const double range[2], double step) { return ceil(range[0] / step - 1e-9); }

/* Returns the distance of the numbers beside a strip. The strip has room for `ticks` numbers. It has two
 * numbers at least, although they may be crowded, because a single number tells no scale. */
static double choose_step(const double range[2], double ticks) {
  double step = round_step((range[1] - range[0]) / fmax(ticks, 1));
  while ((first_number(range, step) + 1) * step > range[1] + 1e-9 * step) step = round_step(0.4 * step);
  return step;
}

/* Returns the width of the numbers beside a strip, and draws the numbers if `draws` is set. x: their right
 * edge. */
static double draw_numbers(const legend *made, const double range[2], double x, double bottom, double top,
                           bool draws) {
  const double size = made->ink->size;
  const double step = choose_step(range, fmin(TICKS_MOST, (bottom - top) / (1.6 * size)));
  double widest = 0;
  for (double n = first_number(range, step); n * step <= range[1] + 1e-9 * step; n++) {
    char text[NUMBER_BYTES];
    write_number(n * step, step, range, text);
    widest = fmax(widest, widest_row(made, text));
    if (!draws) continue;
    double y = bottom + (n * step - range[0]) / (range[1] - range[0]) * (top - bottom);
    cairo_new_path(made->ink->cairo);
    cairo_move_to(made->ink->cairo, x, y);
    cairo_line_to(made->ink->cairo, x + 0.3 * size, y);
    hl_ink_stroke(made->ink, 0.08 * size);
    hl_ink_text(made->ink,
                &(hl_line_of_text){.text = text, .x = x + (0.3 + gap) * size, .y = y, .align_y = 0.5});
  }
  return widest + (0.3 + gap) * size;
}

/* Finds the values at the ends of a volume's strip. */
static hl_status find_range(const legend *made, const hl_scene_volume *volume, double range[2],
                            hl_error *error) {
  const double *stated = made->place->overlay->legend_range;
  hl_status status = hl_transfer_function_visible_range(volume->volume, &volume->transfer_function, range,
                                                        error);
  if (status == HL_OK && stated[0] < stated[1]) memcpy(range, stated, sizeof(double[2]));
  return status;
}

static hl_status draw_strip(legend *made, const hl_scene_volume *volume, hl_error *error) {
  const hl_transfer_function *function = &volume->transfer_function;
  const double size = made->ink->size, top = made->y + 0.5 * size, bottom = top + made->strip_height;
  double range[2];
  hl_status status = find_range(made, volume, range, error);
  if (status != HL_OK) return status;
  double numbers = draw_numbers(made, range, 0, bottom, top, false), x = made->right - numbers;
  cairo_t *cairo = made->ink->cairo;
  cairo_save(cairo);
  cairo_pattern_t *pattern = make_pattern(function, range, bottom, top, cairo);
  cairo_restore(cairo);
  draw_curve(made, function, range, x - strip_width * size, bottom, top);
  cairo_rectangle(cairo, x - strip_width * size, top, strip_width * size, bottom - top);
  hl_ink_stroke(made->ink, 0.12 * size);
  cairo_rectangle(cairo, x - strip_width * size, top, strip_width * size, bottom - top);
  cairo_set_source(cairo, pattern);
  cairo_fill(cairo);
  cairo_pattern_destroy(pattern);
  draw_numbers(made, range, x, bottom, top, true);
  made->y = bottom + size;
  return HL_OK;
}

/* ---- the whole ---- */

/* Widens the legend's body to a volume's strip and rows. */
static hl_status widen_body(legend *made, const hl_scene_volume *volume, bool first, hl_error *error) {
  char name[NAME_BYTES];
  double range[2];
  if (volume->transfer_function.plane.second != HL_SECOND_NONE) {
    const char *title = title_of(made->place, volume, first, name);
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "legend: the transfer function of '%.60s' takes two numbers: a strip of colours shows one",
                   title != NULL ? title : "the volume");
  }
  made->body = fmax(made->body, width_of_rows(made, volume));
  if (!has_strip(volume)) return HL_OK;
  hl_status status = find_range(made, volume, range, error);
  if (status != HL_OK) return status;
  const double numbers = draw_numbers(made, range, 0, made->strip_height, 0, false);
  made->body = fmax(made->body, numbers + (strip_width + curve_width) * made->ink->size);
  return HL_OK;
}

/* Draws a title. It is broken into lines that are as wide as the body of the legend, or a little wider; wider
 * still where it would have too many lines. */
static void draw_title(legend *made, const char *title) {
  const double size = made->ink->size;
  const double least = fmax(fmin(title_width * size, made->place->legend.width), widest_word(made, title));
  hl_line_of_text line = {.text = title,
                          .x = made->right,
                          .y = made->y,
                          .align_x = 1,
                          .wide_most = fmax(made->body, least) + 1,
                          .lines_most = 2 * TITLE_LINES_MOST};
  double width, height, one;
  hl_ink_measure(made->ink, &(hl_line_of_text){.text = title}, &width, &one);
  hl_ink_measure(made->ink, &line, &width, &height);
  while (height > (TITLE_LINES_MOST + 0.5) * one && line.wide_most < most_wide(made)) {
    line.wide_most += 0.5 * size;
    hl_ink_measure(made->ink, &line, &width, &height);
  }
  line.wide_most = fmin(line.wide_most, most_wide(made));
  line.lines_most = TITLE_LINES_MOST;
  hl_ink_measure(made->ink, &line, &width, &height);
  hl_ink_text(made->ink, &line);
  made->y += row * size + fmax(height - one, 0);
}

static hl_status draw_volume(legend *made, const hl_scene_volume *volume, bool first, hl_error *error) {
  char name[NAME_BYTES];
  const char *title = title_of(made->place, volume, first, name);
  if (title != NULL) draw_title(made, title);
  hl_status status = has_strip(volume) ? draw_strip(made, volume, error) : HL_OK;
  if (status == HL_OK) draw_rows(made, volume);
  made->y += 0.5 * made->ink->size;
  return status;
}

hl_status hl_overlay_legend(const hl_ink *ink, const hl_overlay_place *place, hl_error *error) {
  const hl_scene_description *scene = place->scene;
  const double height = place->legend.height;
  size_t strips = 0, lines = 0;
  for (size_t v = 0; v < scene->volume_count; v++) {
    const hl_scene_volume *volume = &scene->volumes[v];
    if (!volume->visible) continue;
    strips += has_strip(volume);
    lines += 1 + count_rows(volume);
  }
  if (lines == 0) return hl_fail(error, HL_ERROR_ARGUMENT, "legend: the picture has no volume");
  double left_for_strips = 0.75 * height - (double)lines * row * ink->size;
  double each = strips > 0 ? left_for_strips / (double)strips - 1.5 * ink->size : 0;
  legend made = {.ink = ink,
                 .place = place,
                 .right = place->picture.left + place->picture.width - place->margin,
                 .bottom = place->picture.top + place->margin + height,
                 .y = place->picture.top + place->margin,
                 .strip_height = fmax(3 * ink->size, fmin(place->legend.strip_height, each))};
  hl_status status = HL_OK;
  for (int turn = 0; turn < 2; turn++) { /* the body's width is known before anything is drawn */
    bool first = true;
    for (size_t v = 0; status == HL_OK && v < scene->volume_count; v++) {
      const hl_scene_volume *volume = &scene->volumes[v];
      if (!volume->visible) continue;
      status = turn == 0 ? widen_body(&made, volume, first, error) : draw_volume(&made, volume, first, error);
      first = false;
    }
  }
  if (place->rows_left_out != NULL) *place->rows_left_out = made.left_out;
  return status;
}
