/* cli/render/overlay.c - reads the options of `halflight render` that draw over pictures, and the physical
 * size of pictures.
 */
#define _GNU_SOURCE
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "render.h"
#include "text/plain.h"

static const double default_pixels_per_inch = 300;

/* ---- reading ---- */

/* Reads a length, "89mm", "8.9cm", "3.5in" or "252pt", and converts it to millimetres; 0 if the text is no
 * such length. */
static double read_width(const char *text) {
  char *rest;
  double number = hl_plain_number(text, &rest);
  while (*rest == ' ') rest++;
  double width = number * overlay_unit(rest);
  return width >= 1 && width <= 5000 ? width : 0;
}

/* Reads the value of --scale-bar: a length ("auto", "50um" or "5"), and the depth at which the bar's length
 * is right ("@target" or "@300"). */
static int read_scale_bar(const cli_value *value, cli_overlay *made) {
  char text[80];
  snprintf(text, sizeof text, "%s", value->text);
  char *depth = strrchr(text, '@'), *rest = text;
  bool good = strlen(value->text) < sizeof text;
  if (depth != NULL) *depth++ = '\0';
  made->overlay.scale_bar = 1;
  if (strcmp(text, "auto") != 0) {
    made->overlay.scale_bar_length = hl_plain_number(text, &rest);
    while (*rest == ' ') rest++;
    good = good && rest > text && made->overlay.scale_bar_length > 0 &&
           isfinite(made->overlay.scale_bar_length) && strlen(rest) < sizeof made->unit;
    snprintf(made->unit, sizeof made->unit, "%.*s", (int)sizeof made->unit - 1, rest);
    if (made->unit[0] != '\0') made->overlay.scale_bar_unit = made->unit;
  }
  if (depth != NULL && strcmp(depth, "target") == 0) made->overlay.scale_bar_depth = HL_DEPTH_OF_TARGET;
  else if (depth != NULL) {
    made->overlay.scale_bar_depth = hl_plain_number(depth, &rest);
    good = good && *depth != '\0' && *rest == '\0' && made->overlay.scale_bar_depth > 0 &&
           isfinite(made->overlay.scale_bar_depth);
  }
  if (good) return EXIT_CODE_OK;
  return fail(
      EXIT_CODE_USAGE,
      "--scale-bar: '%s' is not auto or a length, as 50um, with @target or @DEPTH where the picture is a "
      "perspective one",
      value->text);
}

/* Keeps the first `length` characters of a text as the text of an annotation. */
static int keep_annotation(const char *text, size_t length, hl_annotation *note, cli_overlay *made) {
  note->text = made->texts[made->overlay.annotation_count++] = strndup(text, length);
  return note->text != NULL ? EXIT_CODE_OK : fail(EXIT_CODE_FAILURE, "out of memory");
}

/* Reads the value of --annotate: "TEXT@X,Y" with fractions of the picture, "TEXT@X,Y,Z" with a point of the
 * world, or a text without a place. */
static int read_annotation(const char *text, cli_overlay *made) {
  const char *at = strrchr(text, '@');
  hl_annotation *note = &made->notes[made->overlay.annotation_count];
  if (at == NULL) {
    note->at[0] = NAN;
    return keep_annotation(text, strlen(text), note, made);
  }
  size_t numbers = 0;
  char *rest = (char *)at + 1;
  while (rest != NULL && numbers < 3) {
    const char *from = rest;
    note->at[numbers++] = hl_plain_number(from, &rest);
    if (rest == from || !isfinite(note->at[numbers - 1])) rest = NULL;
    else if (*rest == ',' && numbers < 3) rest++;
    else break;
  }
  if (at == text || rest == NULL || *rest != '\0' || numbers < 2)
    return fail(
        EXIT_CODE_USAGE,
        "--annotate: '%s' is no TEXT@X,Y (fractions of the picture from its upper left, as A@0.03,0.05) "
        "or TEXT@X,Y,Z (a point of the world)",
        text);
  note->in_world = numbers == 3;
  return keep_annotation(text, (size_t)(at - text), note, made);
}

/* The option that draws a part of the overlay, and the part's corner. */
typedef struct placed_part {
  const char *name;
  int option;
  hl_corner *corner;
} placed_part;

/* Reads a value of --place: "PART=CORNER". */
static int read_place(const char *text, const cli_value *values, hl_overlay *overlay) {
  const placed_part parts[] = {{"legend", RENDER_LEGEND, &overlay->legend_corner},
                               {"scale-bar", RENDER_SCALE_BAR, &overlay->scale_bar_corner},
                               {"axes", RENDER_AXES, &overlay->arrows_corner}};
  static const char *const corners[] = {"upper-left", "upper-right", "lower-left", "lower-right", "below"};
  const size_t length = strcspn(text, "=");
  char corner[16] = "";
  if (text[length] == '=') snprintf(corner, sizeof corner, "%.15s", text + length + 1);
  for (char *space = strchr(corner, ' '); space != NULL; space = strchr(space, ' ')) *space = '-';
  for (size_t p = 0; p < sizeof parts / sizeof *parts; p++) {
    if (strlen(parts[p].name) != length || strncmp(text, parts[p].name, length) != 0) continue;
    if (!values[parts[p].option].given || (parts[p].option == RENDER_AXES && overlay->axes != HL_AXES_ARROWS))
      return fail(EXIT_CODE_USAGE, "--place: '%s': nothing is there to place: add --%s", text,
                  parts[p].option == RENDER_AXES ? "axes arrows" : parts[p].name);
    for (int c = 0; c < (parts[p].option == RENDER_LEGEND ? 5 : 4); c++)
      if (strcmp(corner, corners[c]) == 0) {
        *parts[p].corner = (hl_corner)(HL_CORNER_UPPER_LEFT + c);
        return EXIT_CODE_OK;
      }
  }
  return fail(EXIT_CODE_USAGE,
              "--place: '%s' is no PART=CORNER: give legend, scale-bar or axes, and upper-left, upper-right, "
              "lower-left or lower-right, as legend=upper-left; or legend=below",
              text);
}

int render_overlay_read(const cli_value *values, cli_overlay *overlay) {
  *overlay = (cli_overlay){0};
  hl_overlay_defaults(&overlay->overlay);
  overlay->overlay.annotations = overlay->notes;
  if (values[RENDER_WIDTH].given) overlay->width = read_width(values[RENDER_WIDTH].text);
  if (values[RENDER_WIDTH].given && overlay->width == 0)
    return fail(
        EXIT_CODE_USAGE,
        "--width: '%s' is no length from 1mm to 5000mm: give mm, cm, in or pt, as 89mm; --size is in pixels",
        values[RENDER_WIDTH].text);
  if (values[RENDER_DPI].given) overlay->pixels_per_inch = values[RENDER_DPI].number[0];
  else if (values[RENDER_WIDTH].given && !values[RENDER_SIZE].given)
    overlay->pixels_per_inch = default_pixels_per_inch;
  if (values[RENDER_FONT_SIZE].given) overlay->font_points = values[RENDER_FONT_SIZE].number[0];
  if (values[RENDER_UNIT].given) overlay->overlay.world_unit = values[RENDER_UNIT].text;
  if (values[RENDER_AXES].given) overlay->overlay.axes = (hl_axes)values[RENDER_AXES].choice;
  overlay->overlay.marks = values[RENDER_MARKS].given || values[RENDER_RULER].given;
  const cli_value *legend = &values[RENDER_LEGEND];
  overlay->overlay.legend = legend->given;
  if (legend->given && strcmp(legend->text, "auto") != 0) overlay->overlay.legend_title = legend->text;
  overlay->drawn = values[RENDER_SCALE_BAR].given || legend->given || values[RENDER_AXES].given ||
                   overlay->overlay.marks || values[RENDER_ANNOTATE].given;
  int exit_code = EXIT_CODE_OK;
  if (values[RENDER_SCALE_BAR].given) exit_code = read_scale_bar(&values[RENDER_SCALE_BAR], overlay);
  for (int n = 0; n < values[RENDER_ANNOTATE].count && exit_code == EXIT_CODE_OK; n++)
    exit_code = read_annotation(values[RENDER_ANNOTATE].texts[n], overlay);
  for (int n = 0; n < values[RENDER_PLACE].count && exit_code == EXIT_CODE_OK; n++)
    exit_code = read_place(values[RENDER_PLACE].texts[n], values, &overlay->overlay);
  return exit_code;
}

/* ---- options that go together ---- */

int render_overlay_check_options(const cli_value *values, const char *path) {
  static const int drawn[] = {RENDER_SCALE_BAR, RENDER_LEGEND, RENDER_AXES,
                              RENDER_MARKS,     RENDER_RULER,  RENDER_ANNOTATE};
  cli_overlay overlay;
  int exit_code = render_overlay_read(values, &overlay);
  for (size_t n = 0; n < sizeof drawn / sizeof *drawn && exit_code == EXIT_CODE_OK; n++) {
    if (!values[drawn[n]].given) continue;
    if (output_is_linear(path))
      exit_code = fail(
          EXIT_CODE_USAGE,
          "--%s is drawn over .png, .tif, .pdf and .svg pictures: '%s' holds linear light as it is",
          render_options[drawn[n]].name, path);
    else if (values[RENDER_DEPTH].given && values[RENDER_DEPTH].choice == 16)
      exit_code = fail(EXIT_CODE_USAGE, "--%s is drawn with 8 bits per channel: leave --depth 16 out",
                       render_options[drawn[n]].name);
  }
  if (exit_code == EXIT_CODE_OK && values[RENDER_FONT_SIZE].given && !overlay.drawn)
    exit_code = fail(EXIT_CODE_USAGE,
                     "--font-size is the size of letters drawn over the picture: add --scale-bar, --legend, "
                     "--axes, --marks, --ruler or --annotate");
  const cli_value *size = &values[RENDER_SIZE];
  if (exit_code == EXIT_CODE_OK && size->given && overlay.width > 0 && overlay.pixels_per_inch > 0 &&
      fabs(overlay.width / MILLIMETRES_PER_INCH * overlay.pixels_per_inch - size->number[0]) > 0.5)
    exit_code = fail(EXIT_CODE_USAGE,
                     "--size, --width and --dpi contradict each other: leave one of them out");
  overlay_release(&overlay);
  return exit_code;
}

void render_set_size(cli_value *size, double width, double height, char text[RENDER_SIZE_TEXT]) {
  size->given = true;
  size->number[0] = fmax(1, round(width));
  size->number[1] = fmax(1, round(height));
  snprintf(text, RENDER_SIZE_TEXT, "%.0fx%.0f", size->number[0], size->number[1]);
  size->text = size->texts[0] = text;
  size->count = 1;
}

void render_overlay_set_size(cli_value *values, const hl_scene *scene, char text[RENDER_SIZE_TEXT]) {
  cli_value *size = &values[RENDER_SIZE];
  hl_scene_description shape;
  hl_scene_description_defaults(&shape);
  if (scene != NULL) shape = *hl_scene_describe(scene);
  if (!values[RENDER_WIDTH].given || (size->given && size->text != text)) return;
  double per_inch = values[RENDER_DPI].given ? values[RENDER_DPI].number[0] : default_pixels_per_inch;
  double width = read_width(values[RENDER_WIDTH].text) / MILLIMETRES_PER_INCH * per_inch;
  render_set_size(size, width, width * shape.height / shape.width, text);
}
