/* figure/ink.c - draws texts, lines and filled shapes over a picture, through cairo and pango.
 *
 * Texts are laid out as plain text, never as markup. A halo in the opposite grey lies below each text, so
 * that it can be read on dark and on bright parts of a picture. In a PDF the letters stay text in their font,
 * and the halo is drawn as paths. */
#define _GNU_SOURCE
#include "figure/ink.h"

#include <glib.h>

#include "elementary/elementary.h"
#include "image/srgb.h"

enum { MOST_BYTES = 2000 };
/* The width of the halo, as a fraction of the letters' size, and the halo's opacity. */
static const double halo_width = 0.22, halo_alpha = 0.55;

/* Returns a copy of a text (g_free()), in which U+FFFD stands for everything that is no plain text: control
 * characters other than line breaks, Unicode's marks for the direction of writing, and bytes that are no
 * UTF-8. */
static char *clean(const char *text) {
  char *whole = g_utf8_make_valid(text, (gssize)strnlen(text, MOST_BYTES));
  GString *made = g_string_new(NULL);
  for (const char *at = whole; *at != '\0'; at = g_utf8_next_char(at)) {
    gunichar letter = g_utf8_get_char(at);
    bool turns = (letter >= 0x202a && letter <= 0x202e) || (letter >= 0x2066 && letter <= 0x2069) ||
                 letter == 0x2028 || letter == 0x2029;
    g_string_append_unichar(made, (g_unichar_iscntrl(letter) && letter != '\n') || turns ? 0xfffd : letter);
  }
  g_free(whole);
  return g_string_free(made, FALSE);
}

static PangoLayout *lay_out(const hl_ink *ink, const hl_line_of_text *line) {
  PangoLayout *layout = pango_cairo_create_layout(ink->cairo);
  PangoFontDescription *font = pango_font_description_new();
  /* Hinting is off, so that letters have the same places on paper and in pixels. */
  cairo_font_options_t *unhinted = cairo_font_options_create();
  cairo_font_options_set_hint_style(unhinted, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(unhinted, CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_antialias(unhinted, CAIRO_ANTIALIAS_GRAY);
  pango_cairo_context_set_font_options(pango_layout_get_context(layout), unhinted);
  cairo_font_options_destroy(unhinted);
  char *text = clean(line->text);
  pango_font_description_set_family(font, ink->font);
  pango_font_description_set_absolute_size(font,
                                           ink->size * (line->scale > 0 ? line->scale : 1) * PANGO_SCALE);
  if (line->bold) pango_font_description_set_weight(font, PANGO_WEIGHT_BOLD);
  pango_layout_set_font_description(layout, font);
  pango_layout_set_single_paragraph_mode(layout, !line->paragraphs);
  if (line->wide_most > 0) {
    pango_layout_set_width(layout, (int)(line->wide_most * PANGO_SCALE));
    pango_layout_set_ellipsize(layout, PANGO_ELLIPSIZE_END);
  }
  if (line->lines_most > 1) {
    pango_layout_set_wrap(layout, PANGO_WRAP_WORD_CHAR);
    pango_layout_set_height(layout, -line->lines_most);
  }
  if (line->align_x == 1) pango_layout_set_alignment(layout, PANGO_ALIGN_RIGHT);
  if (line->align_x == 0.5) pango_layout_set_alignment(layout, PANGO_ALIGN_CENTER);
  if (line->gap > 0) {
    PangoAttrList *wider = pango_attr_list_new();
    pango_attr_list_insert(wider, pango_attr_letter_spacing_new((int)(line->gap * ink->size * PANGO_SCALE)));
    pango_layout_set_attributes(layout, wider);
    pango_attr_list_unref(wider);
  }
  pango_layout_set_text(layout, text, -1);
  g_free(text);
  pango_font_description_free(font);
  return layout;
}

static void size_of(PangoLayout *layout, double *width, double *height) {
  PangoRectangle room;
  pango_layout_get_extents(layout, NULL, &room);
  *width = (double)room.width / PANGO_SCALE;
  *height = (double)room.height / PANGO_SCALE;
}

void hl_ink_measure(const hl_ink *ink, const hl_line_of_text *line, double *width, double *height) {
  PangoLayout *layout = lay_out(ink, line);
  size_of(layout, width, height);
  g_object_unref(layout);
}

hl_rectangle hl_ink_box(const hl_ink *ink, const hl_line_of_text *line) {
  hl_rectangle box;
  hl_ink_measure(ink, line, &box.width, &box.height);
  box.left = line->x - line->align_x * box.width;
  box.top = line->y - line->align_y * box.height;
  return box;
}

static void set_grey(cairo_t *cairo, double grey, double alpha) {
  cairo_set_source_rgba(cairo, grey, grey, grey, alpha);
}

void hl_ink_text(const hl_ink *ink, const hl_line_of_text *line) {
  PangoLayout *layout = lay_out(ink, line);
  double width, height;
  size_of(layout, &width, &height);
  cairo_save(ink->cairo);
  PangoRectangle room;
  pango_layout_get_extents(layout, NULL, &room);
  cairo_translate(ink->cairo, line->x - line->align_x * width - (double)room.x / PANGO_SCALE,
                  line->y - line->align_y * height);
  cairo_move_to(ink->cairo, 0, 0);
  pango_cairo_layout_path(ink->cairo, layout);
  cairo_set_line_join(ink->cairo, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_width(ink->cairo, ink->size * halo_width);
  set_grey(ink->cairo, ink->halo, halo_alpha);
  cairo_stroke(ink->cairo);
  cairo_move_to(ink->cairo, 0, 0);
  set_grey(ink->cairo, ink->color, 1);
  /* On pixels cairo moves each glyph to a whole pixel, which tears words apart and leaves the halo behind.
   * cairo does not move outlines that are filled as paths. In a PDF letters stay letters. */
  if (cairo_surface_get_type(cairo_get_target(ink->cairo)) == CAIRO_SURFACE_TYPE_IMAGE) {
    pango_cairo_layout_path(ink->cairo, layout);
    cairo_fill(ink->cairo);
  } else {
    pango_cairo_show_layout(ink->cairo, layout);
  }
  cairo_new_path(ink->cairo);
  cairo_restore(ink->cairo);
  g_object_unref(layout);
}

void hl_ink_bar(const hl_ink *ink, hl_rectangle bar) {
  const double rim = ink->size * halo_width / 2;
  set_grey(ink->cairo, ink->halo, halo_alpha);
  cairo_rectangle(ink->cairo, bar.left - rim, bar.top - rim, bar.width + 2 * rim, bar.height + 2 * rim);
  /* the edges of the bar's own rectangle run in the opposite direction, so that the rectangle is left out of
   * the halo */
  cairo_rectangle(ink->cairo, bar.left + bar.width, bar.top, -bar.width, bar.height);
  cairo_fill(ink->cairo);
  set_grey(ink->cairo, ink->color, 1);
  cairo_rectangle(ink->cairo, bar.left, bar.top, bar.width, bar.height);
  cairo_fill(ink->cairo);
}

void hl_ink_stroke(const hl_ink *ink, double width) {
  cairo_set_line_cap(ink->cairo, CAIRO_LINE_CAP_ROUND);
  cairo_set_line_join(ink->cairo, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_width(ink->cairo, width + ink->size * halo_width);
  set_grey(ink->cairo, ink->halo, halo_alpha);
  cairo_stroke_preserve(ink->cairo);
  cairo_set_line_width(ink->cairo, width);
  set_grey(ink->cairo, ink->color, 1);
  cairo_stroke(ink->cairo);
}

/* Encodes a linear value by the sRGB curve (IEC 61966-2-1); the inverse of hl_srgb_decode(). */
static double encode(double linear) {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 1;
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * hl_pow(linear, 1 / 2.4) - 0.055;
}

void hl_ink_source(cairo_t *cairo, const double linear[3], double alpha) {
  cairo_set_source_rgba(cairo, encode(linear[0]), encode(linear[1]), encode(linear[2]), alpha);
}
