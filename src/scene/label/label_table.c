/* scene/label/label_table.c - see label_table.h. */
#include "scene/label/label_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "scene/function/transfer_function.h"
#include "text/color.h"
#include "text/plain.h"
#include "volume/io/text.h"

enum { MOST_BYTES = 4 << 20, MOST_WORDS = 12 };

/* A word of a line of a table: a number or a text. */
typedef struct word {
  char *text; /* the text of the word, in the block of the list's names; ends with 0 */
  double number;
  int64_t whole;
  bool is_number, is_whole, has_point;
} word;

/* The columns of a table with a header, as in dseg.tsv of BIDS; -1: the table does not have the column. */
typedef enum column { COLUMN_VALUE, COLUMN_NAME, COLUMN_COLOR, COLUMN_RED, COLUMN_GREEN, COLUMN_BLUE } column;
enum { COLUMNS = COLUMN_BLUE + 1 };
typedef struct columns {
  char separator; /* 0: the table has no header */
  int at[COLUMNS];
} columns;

static word make_word(char *text, bool quoted) {
  word made = {.text = text, .has_point = strchr(text, '.') != NULL};
  made.is_whole = !quoted && hl_text_whole(text, &made.whole);
  made.is_number = !quoted && hl_text_numbers(text, &made.number, 1) == 1 && isfinite(made.number);
  return made;
}

/* The characters that separate a line's words. Usually blanks, tabs, commas and semicolons separate words.
 * But if the label's number is followed by a comma, by a semicolon, or by a tab in a line whose words are all
 * separated by tabs, this character alone separates words, and names may have blanks. */
static const char *separators_of(const char *line) {
  const char *at = line + strspn(line, " \t");
  at += strspn(at, "-0123456789");
  at += strspn(at, " ");
  int tabs = 0;
  for (const char *c = line; *c != 0; c++) tabs += *c == '\t' && c[1] != '\t';
  return *at == ',' ? "," : *at == ';' ? ";" : *at == '\t' && tabs >= 4 ? "\t" : " \t,;";
}

/* Splits a line into words, in place. Separators within quotes do not count. */
static int part_line(char *line, word words[MOST_WORDS]) {
  int count = 0;
  const char *separators = separators_of(line);
  for (char *at = line; count < MOST_WORDS;) {
    while (*at == ' ' || (*at != 0 && strchr(separators, *at) != NULL)) at++;
    if (*at == 0) break;
    bool quoted = *at == '"';
    char *begin = quoted ? ++at : at, *end = at + strcspn(at, quoted ? "\"" : separators);
    at = end + (*end != 0);
    *end = 0;
    while (!quoted && end > begin && end[-1] == ' ') *--end = 0;
    words[count++] = make_word(begin, quoted);
  }
  return count;
}

/* Splits a line at one separator alone, in place. Names may have blanks, and fields may be empty. Separators
 * within quotes do not count. */
static int part_at(char separator, char *line, word words[MOST_WORDS]) {
  int count = 0;
  for (char *at = line; at != NULL && count < MOST_WORDS;) {
    at += strspn(at, " ");
    const bool quoted = *at == '"' && strchr(at + 1, '"') != NULL;
    char *begin = quoted ? at + 1 : at, *last = quoted ? strchr(begin, '"') : begin;
    char *end = strchr(last, separator);
    at = end != NULL ? end + 1 : NULL;
    if (end == NULL) end = last + strlen(last);
    if (quoted) end = last;
    while (!quoted && end > begin && end[-1] == ' ') end--;
    *end = 0;
    words[count++] = make_word(begin, quoted);
  }
  return count;
}

/* The names of columns, separated by blanks. */
static const char *const column_names[COLUMNS] = {[COLUMN_VALUE] = "index label value id number",
                                                  [COLUMN_NAME] = "name",
                                                  [COLUMN_COLOR] = "color colour hex",
                                                  [COLUMN_RED] = "red r",
                                                  [COLUMN_GREEN] = "green g",
                                                  [COLUMN_BLUE] = "blue b"};

/* Returns whether a text is one of several names. */
static bool is_among(const char *names, const char *text, size_t length) {
  for (const char *at = names; length > 0; at++) {
    const size_t wide = strcspn(at, " ");
    if (wide == length && hl_plain_equal_bytes(at, text, length)) return true;
    at += wide;
    if (*at == 0) break;
  }
  return false;
}

/* Returns whether a line is the header of a table, whose columns may be in any order. */
static bool read_header(const char *line, columns *found) {
  const char *first = strpbrk(line, "\t,;");
  *found = (columns){.separator = first != NULL ? *first : 0};
  for (int c = 0; c < COLUMNS; c++) found->at[c] = -1;
  for (int n = 0; n < MOST_WORDS && found->separator != 0; n++) {
    line += strspn(line, " \"");
    const char separators[] = {found->separator, 0};
    const size_t field = strcspn(line, separators);
    size_t length = field;
    while (length > 0 && strchr(" \"", line[length - 1]) != NULL) length--;
    for (int c = 0; c < COLUMNS; c++)
      if (found->at[c] < 0 && is_among(column_names[c], line, length)) found->at[c] = n;
    if (line[field] == 0) break;
    line += field + 1;
  }
  if (found->at[COLUMN_VALUE] < 0 || found->at[COLUMN_NAME] < 0) found->separator = 0;
  return found->separator != 0;
}

/* Reads a colour from three words, which must be numbers. */
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

/* Reads a colour that is written as #rrggbb, or as a name of CSS. */
static bool read_web_color(const char *text, double color[3]) {
  const bool is_number = text[0] >= '0' && text[0] <= '9';
  return !is_number && hl_parse_color(text, 0, 1, color);
}

/* Reads a label from one line. Returns false if the line has none of the known forms. */
static bool read_label(const word *words, int count, hl_label *label) {
  *label = (hl_label){.value = words[0].whole, .opacity = 1, .visible = 1};
  if (count >= 5 && !words[1].is_number) {
    label->name = words[1].text;
    return read_color(words + 2, label->color);
  }
  if (count >= 8 && !words[count - 1].is_number) { /* a line of ITK-SNAP's label descriptions */
    label->name = words[count - 1].text;
    label->visible = words[5].number != 0;
    return read_color(words + 1, label->color);
  }
  if (count >= 2 && count < 5 && !words[1].is_number) {
    label->name = words[1].text;
    if (count < 3 || !read_web_color(words[2].text, label->color))
      hl_label_distinct_color(label->value, label->color);
    return true;
  }
  return false;
}

/* Reads the colour that a line of a table with columns gives. *given: false if the line gives no colour, but
 * "n/a" or an empty field. Returns false if the field holds anything else that is no colour. */
static bool read_cells(const word *words, int count, const columns *table, bool *given, double color[3]) {
  const int at = table->at[COLUMN_COLOR];
  const int rgb[3] = {table->at[COLUMN_RED], table->at[COLUMN_GREEN], table->at[COLUMN_BLUE]};
  *given = false;
  if (at >= 0 && at < count && words[at].text[0] != 0 && strcmp(words[at].text, "n/a") != 0)
    return *given = read_web_color(words[at].text, color);
  if (rgb[0] < 0 || rgb[1] < 0 || rgb[2] < 0) return true;
  word parts[3] = {0};
  for (int c = 0; c < 3; c++) {
    if (rgb[c] >= count || words[rgb[c]].text[0] == 0) return true;
    parts[c] = words[rgb[c]];
  }
  return *given = read_color(parts, color);
}

/* Reads a label from one line by the columns of a table. A label without a colour gets a colour made from its
 * number. */
static bool read_row(const word *words, int count, const columns *table, hl_label *label) {
  bool given;
  if (table->at[COLUMN_NAME] >= count) return false;
  *label = (hl_label){.value = words[table->at[COLUMN_VALUE]].whole,
                      .name = words[table->at[COLUMN_NAME]].text,
                      .opacity = 1,
                      .visible = 1};
  if (!read_cells(words, count, table, &given, label->color)) return false;
  if (!given) hl_label_distinct_color(label->value, label->color);
  return true;
}

static int by_value(const void *a, const void *b) {
  const hl_label *x = a, *y = b;
  if (x->value != y->value) return x->value < y->value ? -1 : 1;
  /* if a label has two names, the name in the later line counts */
  return x->name < y->name ? -1 : x->name > y->name;
}

static hl_status fail_line(const char *name, size_t line, const char *what, hl_error *error) {
  return hl_fail(
      error, HL_ERROR_INPUT,
      "%s: line %zu: %s: give a label's number, name, red, green and blue, as FreeSurfer, ITK-SNAP "
      "or CSV tables do",
      name, line, what);
}

/* Adds a label from a line. Lines without a label are left out. */
static hl_status add_line(const char *name, size_t number, char *line, columns *table, hl_label_list *list,
                          hl_error *error) {
  word words[MOST_WORDS];
  if (table->separator == 0 && list->count == 0 && read_header(line, table)) return HL_OK;
  const bool has_columns = table->separator != 0;
  const int count = has_columns ? part_at(table->separator, line, words) : part_line(line, words);
  if (count == 0 || words[0].text[0] == '#' || (count == 1 && words[0].text[0] == 0)) return HL_OK;
  const int value = has_columns ? table->at[COLUMN_VALUE] : 0;
  if (value >= count || !words[value].is_number)
    return list->count == 0 && !has_columns ? HL_OK : fail_line(name, number, "begins with no number", error);
  if (!words[value].is_whole) return fail_line(name, number, "its number is no label's", error);
  if (list->count == HL_MOST_LABELS) return fail_line(name, number, "too many labels", error);
  hl_label *label = &list->labels[list->count];
  if (!(has_columns ? read_row(words, count, table, label) : read_label(words, count, label)))
    return fail_line(name, number, "is no label", error);
  list->count++;
  return HL_OK;
}

/* Sorts the labels of a list by value. Of several lines for the same label, the last line counts. */
static void sort(hl_label_list *list) {
  size_t kept = 0;
  qsort(list->labels, list->count, sizeof *list->labels, by_value);
  for (size_t n = 0; n < list->count; n++) {
    if (kept > 0 && list->labels[kept - 1].value == list->labels[n].value) kept--;
    list->labels[kept++] = list->labels[n];
  }
  list->count = kept;
}

/* Skips the mark at the beginning of UTF-8 text, if the text has this mark. */
static char *skip_mark(char *text) { return strncmp(text, "\xef\xbb\xbf", 3) == 0 ? text + 3 : text; }

/* Ends a line at its line feed, its carriage return or both. Returns the next line, or null after the last
 * line. */
static char *end_line(char *line) {
  char *end = line + strcspn(line, "\r\n");
  if (*end == 0) return NULL;
  char *next = end + (end[0] == '\r' && end[1] == '\n' ? 2 : 1);
  *end = 0;
  return next;
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
  columns table = {0};
  for (char *line = skip_mark(list->names); line != NULL && status == HL_OK; number++) {
    char *next = end_line(line);
    status = add_line(name, number, line, &table, list, error);
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

/* The fractional part of the golden ratio, times 2^64. If hues follow each other at this distance, each hue
 * is as far as possible from all earlier hues. The product with a label, modulo 2^64, is the hue as a
 * fraction of a full turn; this product is exact for labels of any size. */
static const uint64_t GOLDEN = 0x9e3779b97f4a7c15u;

void hl_label_distinct_color(int64_t value, double linear[3]) {
  static const double strengths[3] = {0.72, 0.5, 0.85};
  double hue = 6 * (double)((uint64_t)value * GOLDEN >> 11) * 0x1p-53;
  double strength = strengths[(value < 0 ? 0 - (uint64_t)value : (uint64_t)value) % 3];
  for (int c = 0; c < 3; c++) {
    /* the distance of the label's hue from the opposite of this channel's hue; at this channel's own hue, the
     * distance is 3 */
    double away = fabs(fmod(hue + 6 - 2 * c, 6) - 3);
    double pure = fmin(fmax(away - 1, 0), 1);
    linear[c] = hl_srgb_decode(0.92 * (1 - strength * (1 - pure)));
  }
}
