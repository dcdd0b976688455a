/* figure/legend.c - draws the legend, which explains the colours of the picture. Each visible volume has a
 * part: a strip with its transfer function's colours and opacity over its values, or rows for its
 * isosurfaces or its labels. The range of a strip begins at the least value with opacity and ends at the
 * greatest, or where the function's points end, unless the overlay or the volume states the range. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "figure/overlay.h"
#include "figure/strip.h"
#include "scene/function/function_plane.h"
#include "scene/function/transfer_function.h"
#include "text/plain.h"
#include "text/stem.h"
#include "text/units.h"

enum { TITLE_LINES_MOST = 4, ROW_LINES_MOST = 3, NUMBER_BYTES = 40, NAME_BYTES = 64 };

/* lengths in the legend, in units of the letters' size */
static const double row = 1.35, gap = 0.45, swatch = 0.9, column_gap = 1.6;
/* A title that is at most this wide has one line, even if the rest of the legend is narrower. */
static const double title_width = 10;

/* The state of drawing the legend, from its top downwards; in columns, also from the left to the right. */
typedef struct legend {
  const hl_ink *ink;
  const hl_overlay_place *place;
  double top, right, bottom; /* the upper, right and lower edge of the legend or, in columns, of its current
                              * column; points */
  double y;                  /* the place of the top of the next volume's part on the page, points */
  double strip_height;       /* height of a strip of colours, points */
  size_t left_out;           /* the number of rows without room */
  double body; /* the greatest width of a strip with its curve and numbers, or of a row; in columns
                * also of a title; points */
} legend;

/* ---- a volume's rows in the legend ---- */

static bool has_strip(const hl_scene_volume *volume) {
  const hl_transfer_function *function = &volume->transfer_function;
  if (volume->label_count > 0) return false;
  for (size_t p = 0; p < function->opacity_count; p++)
    if (function->opacity[p].opacity > 0) return true;
  return false;
}

/* Returns whether a label has a row: if it is seen and listed, and a label of a mask gives matter its colour.
 */
static bool has_row(const hl_label *label, bool of_mask) {
  return label->visible && !label->unlisted && label->opacity > 0 && (!of_mask || label->tint > 0);
}

static size_t count_rows(const hl_scene_volume *volume) {
  size_t count = volume->iso_count;
  for (size_t l = 0; l < volume->label_count; l++) count += has_row(&volume->labels[l], false);
  for (size_t l = 0; l < volume->mask.label_count; l++) count += has_row(&volume->mask.labels[l], true);
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

/* Returns the width of the text of one row of the legend, in points. */
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

/* Finds the colour and the name of the n-th row of a volume. Solid labels come before translucent labels,
 * since translucent labels often surround them. Returns false if the volume has fewer rows. */
static bool row_of(const hl_scene_volume *volume, size_t n, const double **color,
                   char text[NUMBER_BYTES * 4]) {
  const size_t counts[2] = {volume->label_count, volume->mask.label_count};
  const hl_label *lists[2] = {volume->labels, volume->mask.labels};
  for (int turn = 0; turn < 4; turn++)
    for (size_t l = 0; l < counts[turn % 2]; l++) {
      const hl_label *label = &lists[turn % 2][l];
      const bool solid = label->opacity >= 1;
      if (!has_row(label, turn % 2 == 1) || solid != (turn < 2) || n-- > 0) continue;
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
  if (made->place->legend.in_columns) return SIZE_MAX;
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

/* Returns the width of a volume's rows; 0 if the volume has no rows. The width is at most the width of the
 * legend's shape, unless a word or the number of lines of a row needs more. */
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

/* If the legend has columns, and the thing of this height finds no room in the current column, begins the
 * next column. */
static void make_room(legend *made, double height) {
  if (!made->place->legend.in_columns || made->y <= made->top || made->y + height <= made->bottom) return;
  made->right += made->body + column_gap * made->ink->size;
  made->y = made->top;
}

/* Draws the rows for which there is room, and counts the rows that are left out. The first row is drawn in
 * any case: a legend that is too high for the picture finds no place in it. */
static void draw_rows(legend *made, const hl_scene_volume *volume) {
  const size_t count = count_rows(volume);
  const bool in_columns = made->place->legend.in_columns;
  const double size = made->ink->size, width = in_columns ? made->body : width_of_rows(made, volume);
  const double *color;
  char text[NUMBER_BYTES * 4];
  for (size_t n = 0; row_of(volume, n, &color, text); n++) {
    double height;
    lay_row(made, made->right - width, text, &height);
    if (n > 0) make_room(made, height);
    if (n == 0 || n + 1 == count || in_columns || made->y + height + row * size <= made->bottom) {
      draw_row(made, made->right - width, color, text);
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

/* Cuts the ends of a range at which neither colour nor opacity changes: the values beyond the outermost
 * points of a function that has several colours. A strip then ends where the range of a function ends. */
static void cut_even_ends(const hl_transfer_function *function, double range[2]) {
  const size_t colors = function->color_count, opacities = function->opacity_count;
  if (colors < 2 || opacities == 0) return;
  const double low = fmin(function->color[0].value, function->opacity[0].value),
               high = fmax(function->color[colors - 1].value, function->opacity[opacities - 1].value);
  if (fmax(range[0], low) < fmin(range[1], high))
    range[0] = fmax(range[0], low), range[1] = fmin(range[1], high);
}

/* Finds the range of values along a volume's strip: the visible values, or the values of its colours. */
static hl_status find_scale(const legend *made, const hl_scene_volume *volume, hl_strip_scale *scale,
                            hl_error *error) {
  const double *for_all = made->place->overlay->legend_range;
  const double own[2] = {volume->legend_low, volume->legend_high};
  const double *stated = for_all[0] < for_all[1] ? for_all : own;
  const hl_transfer_function *function = &volume->transfer_function;
  double range[2];
  const bool even = hl_strip_is_even(function);
  hl_status status = hl_transfer_function_visible_range(volume->volume, function, range, error);
  if (status != HL_OK) return status;
  if (!even) cut_even_ends(function, range);
  if (even) {
    range[0] = function->color[0].value;
    range[1] = function->color[function->color_count - 1].value;
  }
  /* A stated range holds values of the legend's volume. The stated range does not hold for the colours of a
   * second volume, because these colours have another range. */
  *scale = hl_strip_scale_of(function, !even && stated[0] < stated[1] ? stated : range);
  if (hl_curves_have_own(&function->plane.curves)) {
    memcpy(scale->own, function->plane.curves.own_between, sizeof scale->own);
    hl_transfer_function_color(&(hl_transfer_function){.color = function->plane.curves.own_color,
                                                       .color_count = function->plane.curves.own_color_count},
                               0, scale->own_color);
  }
  return HL_OK;
}

static hl_status draw_strip(legend *made, const hl_scene_volume *volume, hl_error *error) {
  const double size = made->ink->size, top = made->y + 0.5 * size;
  hl_strip_scale scale;
  hl_status status = find_scale(made, volume, &scale, error);
  if (status != HL_OK) return status;
  const double wide = made->place->legend.in_columns ? made->body : 0;
  const double right = made->right - wide +
                       (wide > 0 ? hl_strip_width(made->ink, &scale, made->strip_height) : 0);
  hl_strip_draw(made->ink, &volume->transfer_function, &scale, right, top, made->strip_height);
  made->y = top + made->strip_height + size;
  return HL_OK;
}

/* ---- all steps together ---- */

/* Widens the legend's body to a volume's strip and rows. */
static hl_status widen_body(legend *made, const hl_scene_volume *volume, bool first, hl_error *error) {
  char name[NAME_BYTES];
  hl_strip_scale scale;
  const char *title = title_of(made->place, volume, first, name);
  if (volume->transfer_function.plane.second != HL_SECOND_NONE)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "legend: the transfer function of '%.60s' takes two numbers: a strip of colours shows one",
                   title != NULL ? title : "the volume");
  made->body = fmax(made->body, width_of_rows(made, volume));
  if (title != NULL && made->place->legend.in_columns)
    made->body = fmax(made->body, fmin(widest_row(made, title), title_width * made->ink->size));
  if (!has_strip(volume)) return HL_OK;
  hl_status status = find_scale(made, volume, &scale, error);
  if (status == HL_OK) made->body = fmax(made->body, hl_strip_width(made->ink, &scale, made->strip_height));
  return status;
}

/* Draws a title above a part of the legend. below: the height of this part. The title is broken into lines
 * that are as wide as the body of the legend, or a little wider. If the title would have too many lines,
 * the lines are wider still. */
static void draw_title(legend *made, const char *title, double below) {
  const double size = made->ink->size;
  const bool in_columns = made->place->legend.in_columns;
  const double least = fmax(fmin(title_width * size, made->place->legend.width), widest_word(made, title));
  hl_line_of_text line = {.text = title,
                          .align_x = in_columns ? 0 : 1,
                          .wide_most = fmax(made->body, in_columns ? 0 : least) + 1,
                          .lines_most = 2 * TITLE_LINES_MOST};
  double width, height, one;
  hl_ink_measure(made->ink, &(hl_line_of_text){.text = title}, &width, &one);
  hl_ink_measure(made->ink, &line, &width, &height);
  while (!in_columns && height > (TITLE_LINES_MOST + 0.5) * one && line.wide_most < most_wide(made)) {
    line.wide_most += 0.5 * size;
    hl_ink_measure(made->ink, &line, &width, &height);
  }
  line.wide_most = fmin(line.wide_most, most_wide(made));
  line.lines_most = TITLE_LINES_MOST;
  hl_ink_measure(made->ink, &line, &width, &height);
  const double high = row * size + fmax(height - one, 0);
  make_room(made, high + below);
  line.x = made->right - (in_columns ? made->body : 0);
  line.y = made->y;
  hl_ink_text(made->ink, &line);
  made->y += high;
}

static hl_status draw_volume(legend *made, const hl_scene_volume *volume, bool first, hl_error *error) {
  char name[NAME_BYTES];
  const char *title = title_of(made->place, volume, first, name);
  const double part = has_strip(volume) ? made->strip_height + 1.5 * made->ink->size : row * made->ink->size;
  if (title != NULL) draw_title(made, title, part);
  else make_room(made, part);
  hl_status status = has_strip(volume) ? draw_strip(made, volume, error) : HL_OK;
  if (status == HL_OK) draw_rows(made, volume);
  made->y += 0.5 * made->ink->size;
  return status;
}

/* A volume that gives another volume its colours. */
typedef struct other_volume {
  hl_scene_volume volume; /* its function has the colours of the other volume's function */
  hl_color_point own; /* the colour of the coloured volume's surface where the surface keeps its own colour */
} other_volume;

/* Finds the colour of a volume's surface: of its first isosurface, or of the least value that has half of the
 * greatest opacity. */
static void own_color(const hl_scene_volume *volume, double color[3]) {
  const hl_function_curves *curves = &volume->transfer_function.plane.curves;
  const hl_transfer_function own = {.color = curves->own_color, .color_count = curves->own_color_count};
  double greatest = 0;
  size_t n = 0;
  for (size_t p = 0; p < curves->opacity_count; p++) greatest = fmax(greatest, curves->opacity[p].opacity);
  while (curves->opacity[n].opacity < greatest / 2) n++;
  if (volume->iso_count > 0) memcpy(color, volume->iso[0].color, 3 * sizeof *color);
  else hl_transfer_function_color(&own, curves->opacity[n].value, color);
}

/* Returns the volume whose values the colours of `volume` stand for: `volume` itself, or a second volume
 * that gives the colours. *other then holds the second volume with these colours. */
static const hl_scene_volume *volume_of_colors(const hl_scene_description *scene,
                                               const hl_scene_volume *volume, other_volume *other) {
  static const hl_opacity_point opaque = {0, 1};
  const hl_function_plane *plane = &volume->transfer_function.plane;
  if (!hl_has_second_colors(&volume->transfer_function)) return volume;
  for (size_t v = 0; v < scene->volume_count; v++)
    if (scene->volumes[v].name != NULL && strcmp(scene->volumes[v].name, plane->volume) == 0) {
      other->volume = scene->volumes[v];
      own_color(volume, other->own.color);
      other->own.value = 0;
      other->volume.transfer_function = (hl_transfer_function){.unit_distance = 1,
                                                               .opacity = &opaque,
                                                               .opacity_count = 1,
                                                               .color = plane->curves.color,
                                                               .color_count = plane->curves.color_count,
                                                               .plane.curves = plane->curves};
      hl_function_curves *curves = &other->volume.transfer_function.plane.curves;
      curves->own_color = &other->own, curves->own_color_count = 1;
      return &other->volume;
    }
  return volume;
}

hl_status hl_overlay_legend(const hl_ink *ink, const hl_overlay_place *place, hl_error *error) {
  const hl_scene_description *scene = place->scene;
  other_volume other;
  const double height = place->legend.height;
  size_t strips = 0, lines = 0;
  for (size_t v = 0; v < scene->volume_count; v++) {
    const hl_scene_volume *volume = volume_of_colors(scene, &scene->volumes[v], &other);
    if (!scene->volumes[v].visible) continue;
    strips += has_strip(volume);
    lines += 1 + count_rows(volume);
  }
  if (lines == 0) return hl_fail(error, HL_ERROR_ARGUMENT, "legend: the picture has no volume");
  double left_for_strips = 0.75 * height - (double)lines * row * ink->size;
  double each = strips > 0 ? left_for_strips / (double)strips - 1.5 * ink->size : 0;
  if (place->legend.in_columns) each = place->legend.strip_height;
  const double top = place->picture.top + place->margin;
  legend made = {.ink = ink,
                 .place = place,
                 .top = top,
                 .right = place->picture.left + place->picture.width - place->margin,
                 .bottom = top + height,
                 .y = top,
                 .strip_height = fmax(3 * ink->size, fmin(place->legend.strip_height, each))};
  hl_status status = HL_OK;
  for (int turn = 0; turn < 2; turn++) { /* the body's width is known before anything is drawn */
    bool first = true;
    if (turn == 1 && place->legend.in_columns) made.right = place->picture.left + place->margin + made.body;
    for (size_t v = 0; status == HL_OK && v < scene->volume_count; v++) {
      const hl_scene_volume *volume = volume_of_colors(scene, &scene->volumes[v], &other);
      if (!scene->volumes[v].visible) continue;
      status = turn == 0 ? widen_body(&made, volume, first, error) : draw_volume(&made, volume, first, error);
      first = false;
    }
  }
  if (place->rows_left_out != NULL) *place->rows_left_out = made.left_out;
  return status;
}
