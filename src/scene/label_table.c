/* scene/label_table.c - see label_table.h. */
#include "scene/label_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "scene/transfer_function.h"
#include "volume/text.h"

enum { MOST_BYTES = 4 << 20, MOST_WORDS = 12 };

/* A word of a line: a number or a text. */
typedef struct word {
  char *text; /* in the list's names; ends with 0 */
  double number;
  bool is_number, has_point;
} word;

static bool is_separator(char c) { return c == ' ' || c == '\t' || c == '\r' || c == ',' || c == ';'; }

/* Parts a line into words, in place; quotes hold separators together. */
static int part_line(char *line, word words[MOST_WORDS]) {
  int count = 0;
  for (char *at = line; *at != 0 && count < MOST_WORDS;) {
    while (is_separator(*at)) at++;
    if (*at == 0) break;
    bool quoted = *at == '"';
    char *begin = quoted ? ++at : at, *end;
    while (*at != 0 && (quoted ? *at != '"' : !is_separator(*at))) at++;
    end = at;
    if (*at != 0) at++;
    *end = 0;
    word *made = &words[count++];
    *made = (word){.text = begin, .has_point = strchr(begin, '.') != NULL};
    made->is_number = !quoted && hl_text_numbers(begin, &made->number, 1) == 1 && isfinite(made->number);
  }
  return count;
}

/* The colour that begins at a word: three numbers. */
static bool read_color(const word *words, double color[3]) {
  bool fractions = true, point = false;
  for (int c = 0; c < 3; c++) {
    if (!words[c].is_number || words[c].number < 0 || words[c].number > 255) return false;
    fractions &= words[c].number <= 1;
    point |= words[c].has_point;
  }
  for (int c = 0; c < 3; c++) color[c] = hl_srgb_decode(words[c].number / (fractions && point ? 1 : 255));
  return true;
}

/* Reads one line's label; false: it has none of the forms. */
static bool read_label(const word *words, int count, hl_label *label) {
  *label = (hl_label){.value = words[0].number, .opacity = 1, .visible = 1};
  if (count >= 5 && !words[1].is_number) {
    label->name = words[1].text;
    return read_color(words + 2, label->color);
  }
  if (count >= 8 && !words[count - 1].is_number) { /* ITK-SNAP */
    label->name = words[count - 1].text;
    label->visible = words[5].number != 0;
    return read_color(words + 1, label->color);
  }
  if (count >= 2 && count < 5 && !words[1].is_number) {
    label->name = words[1].text;
    hl_label_distinct_color(label->value, label->color);
    return true;
  }
  return false;
}

static int by_value(const void *a, const void *b) {
  const hl_label *x = a, *y = b;
  if (x->value != y->value) return x->value < y->value ? -1 : 1;
  return x->name < y->name ? -1 : x->name > y->name; /* names lie in the order of lines */
}

static hl_status fail_line(const char *name, size_t line, const char *what, hl_error *error) {
  return hl_fail(
      error, HL_ERROR_INPUT,
      "%s: line %zu: %s: give a label's number, name, red, green and blue, as FreeSurfer, ITK-SNAP "
      "or CSV tables do",
      name, line, what);
}

/* Adds a line's label; lines without one are passed over. */
static hl_status add_line(const char *name, size_t number, char *line, hl_label_list *list, hl_error *error) {
  word words[MOST_WORDS];
  int count = part_line(line, words);
  if (count == 0 || words[0].text[0] == '#') return HL_OK;
  if (!words[0].is_number)
    return list->count == 0 ? HL_OK : fail_line(name, number, "begins with no number", error);
  if (words[0].number != floor(words[0].number) || fabs(words[0].number) > 1e9)
    return fail_line(name, number, "its number is no label's", error);
  if (list->count == HL_MOST_LABELS) return fail_line(name, number, "too many labels", error);
  if (!read_label(words, count, &list->labels[list->count]))
    return fail_line(name, number, "is no label", error);
  list->count++;
  return HL_OK;
}

/* Sorts by value; of several lines for one label the last counts. */
static void sort(hl_label_list *list) {
  size_t kept = 0;
  qsort(list->labels, list->count, sizeof *list->labels, by_value);
  for (size_t n = 0; n < list->count; n++) {
    if (kept > 0 && list->labels[kept - 1].value == list->labels[n].value) kept--;
    list->labels[kept++] = list->labels[n];
  }
  list->count = kept;
}

hl_status hl_label_table_parse(hl_context *context, const char *text, size_t length, const char *name,
                               hl_label_list *list, hl_error *error) {
  *list = (hl_label_list){.labels = hl_allocate(context, HL_MOST_LABELS, sizeof *list->labels),
                          .names = hl_allocate(context, length + 1, 1)};
  if (list->labels == NULL || list->names == NULL) {
    hl_label_list_release(context, list);
    return hl_fail_memory(error, HL_MOST_LABELS * sizeof *list->labels, "a table of labels");
  }
  memcpy(list->names, text, length);
  list->names[length] = 0;
  hl_status status = HL_OK;
  size_t number = 1;
  for (char *line = list->names; line != NULL && status == HL_OK; number++) {
    char *end = strchr(line, '\n'), *next = end != NULL ? end + 1 : NULL;
    if (end != NULL) *end = 0;
    status = add_line(name, number, line, list, error);
    line = next;
  }
  if (status == HL_OK && list->count == 0)
    status = hl_fail(error, HL_ERROR_INPUT,
                     "%s: no label is in it: give lines of number, name, red, green, blue", name);
  if (status == HL_OK) sort(list);
  else hl_label_list_release(context, list);
  return status;
}

hl_status hl_label_table_load(hl_context *context, const char *path, hl_label_list *list, hl_error *error) {
  unsigned char *bytes = NULL;
  size_t length = 0;
  *list = (hl_label_list){0};
  hl_status status = hl_file_read(context, path, MOST_BYTES, &bytes, &length, error);
  if (status == HL_OK) status = hl_label_table_parse(context, (char *)bytes, length, path, list, error);
  hl_release(context, bytes);
  return status;
}

void hl_label_list_release(hl_context *context, hl_label_list *list) {
  hl_release(context, list->labels);
  hl_release(context, list->names);
  *list = (hl_label_list){0};
}

/* The golden ratio's fraction, by which successive hues are as far from all earlier ones as can be. */
static const double GOLDEN = 0.61803398874989485;

void hl_label_distinct_color(double value, double linear[3]) {
  double turn = value * GOLDEN, hue = 6 * (turn - floor(turn));
  double strength = fmod(fabs(value), 3) < 1 ? 0.72 : fmod(fabs(value), 3) < 2 ? 0.5 : 0.85;
  for (int c = 0; c < 3; c++) {
    double away = fabs(fmod(hue + 6 - 2 * c, 6) - 3); /* 3: this channel's own hue is opposite */
    double pure = fmin(fmax(away - 1, 0), 1);
    linear[c] = hl_srgb_decode(0.92 * (1 - strength * (1 - pure)));
  }
}
