/* cli/figure/panels.c - reads the file FIGURE.json of `halflight figure`.
 *
 * A panel's keys are "input", "letter", "aspect", "inset" and the options of `halflight render`. The options
 * are put on a command line and parsed by the parser of `render`, so that they mean the same. The names of
 * files in FIGURE.json may be hostile: names of inputs, and of files in options, that lead out of its folder
 * are refused. */
#define _GNU_SOURCE
#include "panels.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/frames.h"
#include "cli/suggest.h"
#include "text/color.h"
#include "text/edit_distance.h"
#include "text/plain.h"
#include "text/plain_json.h"

enum { MOST_WORDS = 4 * MAXIMUM_OPTIONS, MOST_KEY = 40 };

/* The state of reading one FIGURE.json. Errors name the file and the place in it. */
typedef struct page_reading {
  const char *path;
  figure_page *page;
  json_t *shared; /* borrowed; "options"; null if there is none */
} page_reading;

/* ---- names of files ---- */

/* Returns whether a text, or the part of it after '=', is a name that leads out of the folder. */
static bool leads_out(const char *text) {
  const char *equals = strchr(text, '=');
  for (const char *at = text; at != NULL; at = at == text && equals != NULL ? equals + 1 : NULL) {
    if (at[0] == '/') return true;
    for (const char *dots = strstr(at, ".."); dots != NULL; dots = strstr(dots + 2, ".."))
      if ((dots == at || dots[-1] == '/') && (dots[2] == '/' || dots[2] == '\0')) return true;
  }
  return false;
}

/* Returns whether an option must not be given for a panel, because the page sets it for all panels, or
 * because it concerns the whole run. */
static bool is_of_the_page(int which) {
  static const int kept[] = {RENDER_OUTPUT,      RENDER_FORMAT, RENDER_SIZE,        RENDER_DEPTH,
                             RENDER_NO_METADATA, RENDER_LAYERS, RENDER_WIDTH,       RENDER_DPI,
                             RENDER_FONT_SIZE,   RENDER_VIEWS,  RENDER_RANGE_OF_ALL};
  for (size_t n = 0; n < sizeof kept / sizeof *kept; n++)
    if (which == kept[n]) return true;
  return which > RENDER_RAYS;
}

static bool names_a_file(int which) {
  return which == RENDER_TF || which == RENDER_LABELS || which == RENDER_MASK ||
         which == RENDER_LABEL_TABLE || which == RENDER_SKY || which == RENDER_COLORMAP ||
         which == RENDER_COLOR_BY;
}

/* ---- a panel's command line ---- */

static int add_word(figure_panel *panel, const char *word) {
  if (panel->word_count == MOST_WORDS) return fail(EXIT_CODE_INPUT, "a panel has too many options");
  if (panel->words == NULL) panel->words = calloc(MOST_WORDS + 1, sizeof *panel->words);
  char *copy = panel->words != NULL ? strdup(word) : NULL;
  if (copy == NULL) return fail(EXIT_CODE_FAILURE, "out of memory");
  panel->words[panel->word_count++] = copy;
  return EXIT_CODE_OK;
}

static int add_option(figure_panel *panel, const char *name, const char *value) {
  char word[MOST_KEY + 4];
  snprintf(word, sizeof word, "--%s", name);
  int exit_code = add_word(panel, word);
  return exit_code == EXIT_CODE_OK && value != NULL ? add_word(panel, value) : exit_code;
}

static const char *option_name(const void *data, size_t index) {
  (void)data;
  return index < RENDER_OPTION_COUNT ? render_options[index].name : NULL;
}

static int find_option(const char *name) {
  for (int which = 0; which < RENDER_OPTION_COUNT; which++)
    if (strcmp(render_options[which].name, name) == 0) return which;
  return -1;
}

/* Reads one value of an option: a text, a number, or several numbers. */
static int add_value(const page_reading *reading, figure_panel *panel, int which, const json_t *value) {
  char text[160] = "";
  const char *name = render_options[which].name;
  if (json_is_string(value)) {
    if (names_a_file(which) && leads_out(json_string_value(value)))
      return fail(EXIT_CODE_INPUT, "%s: %s: '%s' leads out of the file's folder: name a file in it or below",
                  reading->path, name, json_string_value(value));
    return add_option(panel, name, json_string_value(value));
  }
  if (json_is_number(value)) {
    hl_plain_print(text, sizeof text, "%.17g", json_number_value(value));
    return add_option(panel, name, text);
  }
  size_t used = 0, index;
  json_t *one;
  json_array_foreach(value, index, one) {
    if (!json_is_number(one) || used > sizeof text - 40) break;
    used += (size_t)hl_plain_print(text + used, sizeof text - used, "%s%.17g", index > 0 ? "," : "",
                                   json_number_value(one));
  }
  if (json_is_array(value) && index == json_array_size(value) && index > 0)
    return add_option(panel, name, text);
  return fail(EXIT_CODE_INPUT, "%s: %s: give a text, a number, several numbers, or true", reading->path,
              name);
}

/* Refuses a key that no panel has. For the words of a panel's data, the message names "input"; for other
 * words, the option of the same meaning. */
static int refuse_key(const page_reading *reading, const char *key, const char *name) {
  static const char *const data[] = {"file", "scene", "volume", "data", "path", "source", "render", "image"};
  const char *meant = NULL;
  for (size_t n = 0; n < sizeof data / sizeof *data; n++)
    if (strcmp(name, data[n]) == 0) meant = "input";
  if (meant == NULL) meant = synonym_of(name, option_name, NULL);
  if (meant == NULL) meant = hl_nearest_candidate(name, option_name, NULL);
  return fail(EXIT_CODE_INPUT, "%s: a panel has no key '%.40s'%s%s%s", reading->path, key,
              meant != NULL ? ": did you mean '" : ": see 'halflight help figure'",
              meant != NULL ? meant : "", meant != NULL ? "'?" : "");
}

/* Reads an option from JSON. Its value is true, a value, or a list of values if the option may be given
 * several times. A list of numbers is one value. */
static int add_json_option(const page_reading *reading, figure_panel *panel, const char *key,
                           const json_t *value) {
  char name[MOST_KEY];
  snprintf(name, sizeof name, "%s", key);
  for (char *at = name; *at != '\0'; at++)
    if (*at == '_') *at = '-';
  int which = strlen(key) < sizeof name ? find_option(name) : -1;
  if (which < 0) return refuse_key(reading, key, name);
  if (is_of_the_page(which))
    return fail(
        EXIT_CODE_INPUT, "%s: '%s' is not for a panel: it holds for the whole page%s", reading->path, key,
        which == RENDER_SIZE ? ", whose \"width\", \"dpi\" and \"columns\" give the panels' sizes" : "");
  if (json_is_true(value) && render_options[which].kind == OPTION_SWITCH)
    return add_option(panel, name, NULL);
  if (json_is_null(value) || json_is_false(value))
    return EXIT_CODE_OK; /* `null` or `false` switches off an option that the shared options set */
  const bool numbers = render_options[which].kind == OPTION_NUMBERS &&
                       json_is_number(json_array_get(value, 0));
  if (!json_is_array(value) || !render_options[which].repeatable || numbers)
    return add_value(reading, panel, which, value);
  size_t index;
  json_t *one;
  int exit_code = EXIT_CODE_OK;
  json_array_foreach(value, index, one) {
    exit_code = add_value(reading, panel, which, one);
    if (exit_code != EXIT_CODE_OK) break;
  }
  return exit_code;
}

static int add_inputs(const page_reading *reading, figure_panel *panel, const json_t *input) {
  const size_t count = json_is_array(input) ? json_array_size(input) : 1;
  if (count == 0 || count > MAXIMUM_OPERANDS)
    return fail(EXIT_CODE_INPUT, "%s: \"input\": give from 1 to %d files", reading->path,
                (int)MAXIMUM_OPERANDS);
  int exit_code = add_word(panel, "--");
  for (size_t n = 0; n < count && exit_code == EXIT_CODE_OK; n++) {
    const char *name = json_string_value(json_is_array(input) ? json_array_get(input, n) : input);
    if (name == NULL)
      return fail(EXIT_CODE_INPUT, "%s: each panel needs \"input\": a file's name", reading->path);
    if (leads_out(name))
      return fail(EXIT_CODE_INPUT,
                  "%s: input: '%s' leads out of the file's folder: name a file in it or below", reading->path,
                  name);
    exit_code = add_word(panel, name);
  }
  return exit_code;
}

/* ---- keys of the page and of panels that are no options ---- */

static bool is_own_key(const char *key) {
  static const char *const own[] = {"input", "letter", "aspect", "inset", "part", "corner", "at"};
  for (size_t n = 0; n < sizeof own / sizeof *own; n++)
    if (strcmp(key, own[n]) == 0) return true;
  return false;
}

/* Reads a length in millimetres: a number, or a text such as "89mm". */
static bool read_length(const json_t *value, double *millimetres) {
  if (json_is_number(value)) *millimetres = json_number_value(value);
  const char *text = json_string_value(value);
  if (text == NULL) return json_is_number(value);
  char *rest;
  double number = hl_plain_number(text, &rest);
  if (rest == text || overlay_unit(rest) == 0) return false;
  *millimetres = number * overlay_unit(rest);
  return true;
}

static int read_corner(const page_reading *reading, figure_panel *panel, const json_t *inset) {
  const json_t *part = json_object_get(inset, "part"), *corner = json_object_get(inset, "corner");
  panel->inset.part = part == NULL ? 0.35 : json_number_value(part);
  if (!(panel->inset.part > 0.02 && panel->inset.part < 1))
    return fail(EXIT_CODE_INPUT, "%s: \"part\": an inset's width over its panel's, from 0.02 to 1",
                reading->path);
  const char *text = corner == NULL ? "lower right" : json_string_value(corner);
  bool good = text != NULL && (strncmp(text, "lower ", 6) == 0 || strncmp(text, "upper ", 6) == 0) &&
              (strcmp(text + 6, "left") == 0 || strcmp(text + 6, "right") == 0);
  if (!good)
    return fail(EXIT_CODE_INPUT, "%s: \"corner\": give upper left, upper right, lower left or lower right",
                reading->path);
  panel->inset.lower = text[0] == 'l';
  panel->inset.right = text[6] == 'r';
  return EXIT_CODE_OK;
}

/* Returns whether an inset states a direction or a projection of its own, and is therefore framed anew. */
static bool has_own_view(const json_t *inset) {
  static const int framing[] = {RENDER_VIEW, RENDER_UP,   RENDER_AZIMUTH, RENDER_ELEVATION,
                                RENDER_ROLL, RENDER_FOVY, RENDER_ORTHO};
  for (size_t n = 0; n < sizeof framing / sizeof *framing; n++)
    if (json_object_get(inset, render_options[framing[n]].name) != NULL) return true;
  return false;
}

/* Reads the place of its panel that an inset shows: fractions from the upper left; default the middle. */
static int read_place(const page_reading *reading, figure_panel *panel, const json_t *inset) {
  const json_t *at = json_object_get(inset, "at");
  bool good = at == NULL || (json_array_size(at) == 2 && panel->inset.zoom > 0);
  for (size_t n = 0; n < 2; n++) {
    const json_t *number = json_array_get(at, n);
    panel->inset.at[n] = at == NULL ? 0.5 : json_number_value(number);
    good = good && (at == NULL || json_is_number(number)) && panel->inset.at[n] >= 0 &&
           panel->inset.at[n] <= 1;
  }
  if (good) return EXIT_CODE_OK;
  return fail(EXIT_CODE_INPUT,
              "%s: \"at\": give the place of the panel that the inset shows, [x, y] from 0 to 1 from its "
              "upper left, without a view of the inset's own",
              reading->path);
}

/* Reads how many times as large as its panel an inset shows things. The inset then has the panel's camera,
 * and its "zoom" is no option of `halflight render`: it is removed from the inset's keys. An inset with a
 * view of its own keeps the option. */
static int read_zoom(const page_reading *reading, figure_panel *panel, json_t *inset) {
  if (has_own_view(inset)) return EXIT_CODE_OK;
  const json_t *zoom = json_object_get(inset, "zoom");
  const char *text = json_string_value(zoom);
  char *rest = NULL;
  panel->inset.zoom = zoom == NULL   ? 1
                      : text != NULL ? hl_plain_number(text, &rest)
                                     : json_number_value(zoom);
  if ((text != NULL && *rest != '\0') || !(panel->inset.zoom > 0 && panel->inset.zoom <= 1e6))
    return fail(EXIT_CODE_INPUT, "%s: \"zoom\" of an inset: give a factor above 0", reading->path);
  json_object_del(inset, "zoom");
  return EXIT_CODE_OK;
}

/* Joins two objects of options. If both have an option of the same name, the value in `above` counts. Both
 * objects may be null. */
static json_t *join(const json_t *below, const json_t *above) {
  json_t *joined = json_object();
  const char *key;
  json_t *value;
  json_object_foreach((json_t *)below, key,
                      value) if (strcmp(key, "inset") != 0 && strcmp(key, "letter") != 0)
      json_object_set(joined, key, value);
  json_object_foreach((json_t *)above, key, value) json_object_set(joined, key, value);
  return joined;
}

static int fill_panel(const page_reading *reading, figure_panel *panel, const json_t *keys) {
  const json_t *letter = json_object_get(keys, "letter"), *aspect = json_object_get(keys, "aspect");
  if (letter != NULL && !json_is_null(letter)) {
    const char *text = json_string_value(letter);
    if (text == NULL || strlen(text) > 20)
      return fail(EXIT_CODE_INPUT, "%s: \"letter\": give a short text, as \"a\"", reading->path);
    panel->letter = strdup(text);
  }
  panel->aspect = json_number_value(aspect);
  if (aspect != NULL && !(panel->aspect >= 0.05 && panel->aspect <= 20))
    return fail(EXIT_CODE_INPUT, "%s: \"aspect\": width over height, from 0.05 to 20", reading->path);
  int exit_code = EXIT_CODE_OK;
  const char *key;
  json_t *value;
  json_object_foreach((json_t *)keys, key, value) {
    if (!is_own_key(key)) exit_code = add_json_option(reading, panel, key, value);
    if (exit_code != EXIT_CODE_OK) return exit_code;
  }
  return add_inputs(reading, panel, json_object_get(keys, "input"));
}

/* Adds a panel and its inset. The inset has the panel's input and options unless it sets its own. */
static int add_panel(page_reading *reading, const json_t *given, const json_t *below, int inside) {
  figure_page *page = reading->page;
  if (!json_is_object(given)) return fail(EXIT_CODE_INPUT, "%s: a panel is an object", reading->path);
  if (page->count == FIGURE_MOST_PANELS)
    return fail(EXIT_CODE_INPUT, "%s: a figure has at most %d panels", reading->path,
                (int)FIGURE_MOST_PANELS);
  const int index = page->count++;
  figure_panel *panel = &page->panels[index];
  panel->inset.of = inside;
  json_t *own = json_copy((json_t *)given);
  int exit_code = inside >= 0 ? read_corner(reading, panel, own) : EXIT_CODE_OK;
  if (exit_code == EXIT_CODE_OK && inside >= 0) exit_code = read_zoom(reading, panel, own);
  if (exit_code == EXIT_CODE_OK && inside >= 0) exit_code = read_place(reading, panel, own);
  json_t *keys = join(below, own);
  json_decref(own);
  if (keys == NULL) return fail(EXIT_CODE_FAILURE, "out of memory");
  if (exit_code == EXIT_CODE_OK) exit_code = fill_panel(reading, panel, keys);
  const json_t *inset = json_object_get(given, "inset");
  if (exit_code == EXIT_CODE_OK && inset != NULL && inside >= 0)
    exit_code = fail(EXIT_CODE_INPUT, "%s: an inset has no inset", reading->path);
  if (exit_code == EXIT_CODE_OK && inset != NULL) {
    json_t *bare = json_copy(keys); /* the inset gets the panel's options without the overlays, which are
                                     * drawn once, over the panel */
    static const char *const drawn[] = {"scale-bar", "scale_bar", "legend", "axes",
                                        "marks",     "annotate",  "unit",   "place"};
    for (size_t n = 0; n < sizeof drawn / sizeof *drawn; n++) json_object_del(bare, drawn[n]);
    exit_code = add_panel(reading, inset, bare, index);
    json_decref(bare);
  }
  json_decref(keys);
  return exit_code;
}

/* Gives the panels letters. If the file gives no letters and there are several panels, the letters are "a",
 * "b" and so on; "letters": false leaves them out. */
static int add_letters(const page_reading *reading, const json_t *letters) {
  figure_page *page = reading->page;
  int outer = 0;
  for (int p = 0; p < page->count; p++) outer += page->panels[p].inset.of < 0;
  char letter[2] = "a";
  if (json_is_string(letters) && strlen(json_string_value(letters)) == 1)
    letter[0] = json_string_value(letters)[0];
  else if (letters != NULL && !json_is_boolean(letters))
    return fail(EXIT_CODE_INPUT, "%s: \"letters\": give the first one, as \"A\", or false", reading->path);
  if (json_is_false(letters) || (letters == NULL && outer < 2)) return EXIT_CODE_OK;
  for (int p = 0; p < page->count; p++) {
    if (page->panels[p].inset.of >= 0) continue;
    if (page->panels[p].letter == NULL) page->panels[p].letter = strdup(letter);
    letter[0]++;
  }
  return EXIT_CODE_OK;
}

static int read_share(const page_reading *reading, const json_t *share) {
  size_t index;
  json_t *one;
  json_array_foreach(share, index, one) {
    const char *text = json_is_string(one) ? json_string_value(one) : "";
    bool *flag = strcmp(text, "camera") == 0  ? &reading->page->share_camera
                 : strcmp(text, "light") == 0 ? &reading->page->share_light
                 : strcmp(text, "range") == 0 ? &reading->page->share_function
                                              : NULL;
    if (flag == NULL)
      return fail(EXIT_CODE_INPUT, "%s: \"share\": '%.40s' is none of camera, light and range", reading->path,
                  text);
    *flag = true;
  }
  return share == NULL || json_is_array(share)
             ? EXIT_CODE_OK
             : fail(EXIT_CODE_INPUT, "%s: \"share\": give a list, as [\"camera\", \"light\"]", reading->path);
}

static int read_page_numbers(const page_reading *reading, const json_t *root) {
  figure_page *page = reading->page;
  const json_t *dpi = json_object_get(root, "dpi"), *font = json_object_get(root, "font-size"),
               *columns = json_object_get(root, "columns"), *ground = json_object_get(root, "background");
  *page = (figure_page){.panels = page->panels,
                        .width = 183,
                        .gap = 2,
                        .pixels_per_inch = 300,
                        .font_points = 7,
                        .background = {1, 1, 1}};
  if (font == NULL) font = json_object_get(root, "font_size");
  if (dpi != NULL) page->pixels_per_inch = json_number_value(dpi);
  if (font != NULL) page->font_points = json_number_value(font);
  if (columns != NULL) page->columns = (int)json_integer_value(columns);
  bool good = (json_object_get(root, "width") == NULL ||
               read_length(json_object_get(root, "width"), &page->width)) &&
              (json_object_get(root, "gap") == NULL || read_length(json_object_get(root, "gap"), &page->gap));
  if (!good || !(page->width >= 5 && page->width <= 5000 && page->gap >= 0 && page->gap <= 100))
    return fail(EXIT_CODE_INPUT, "%s: \"width\" and \"gap\": give lengths, as \"183mm\" and \"2mm\"",
                reading->path);
  if (!(page->pixels_per_inch >= FIGURE_LEAST_DPI && page->pixels_per_inch <= FIGURE_MOST_DPI))
    return fail(EXIT_CODE_INPUT, "%s: \"dpi\": give a number from %d to %d", reading->path,
                (int)FIGURE_LEAST_DPI, (int)FIGURE_MOST_DPI);
  if (!(page->font_points >= 1 && page->font_points <= 200))
    return fail(EXIT_CODE_INPUT, "%s: \"font-size\": give points from 1 to 200", reading->path);
  if (columns != NULL && !(page->columns >= 1 && page->columns <= FIGURE_MOST_PANELS))
    return fail(EXIT_CODE_INPUT, "%s: \"columns\": give a number from 1 to %d", reading->path,
                (int)FIGURE_MOST_PANELS);
  if (ground == NULL) return EXIT_CODE_OK;
  page->transparent = json_is_string(ground) && strcmp(json_string_value(ground), "transparent") == 0;
  if (page->transparent ||
      (json_is_string(ground) && hl_parse_color(json_string_value(ground), 0, 1, page->background)))
    return EXIT_CODE_OK;
  return fail(EXIT_CODE_INPUT, "%s: \"background\": give a colour, as \"white\", or \"transparent\"",
              reading->path);
}

static int check_page_keys(const page_reading *reading, const json_t *root) {
  static const char *const known[] = {"panels",  "width",   "gap",   "dpi",        "font-size", "font_size",
                                      "columns", "letters", "share", "background", "options",   "$schema"};
  const char *key;
  json_t *value;
  json_object_foreach((json_t *)root, key, value) {
    bool found = false;
    for (size_t n = 0; n < sizeof known / sizeof *known; n++) found |= strcmp(key, known[n]) == 0;
    if (!found)
      return fail(EXIT_CODE_INPUT,
                  "%s: unknown key '%.40s': a figure has panels, width, gap, dpi, font-size, columns, "
                  "letters, share, "
                  "background and options",
                  reading->path, key);
  }
  return EXIT_CODE_OK;
}

static int read_root(page_reading *reading, const json_t *root) {
  const json_t *panels = json_object_get(root, "panels");
  if (!json_is_object(root) || !json_is_array(panels) || json_array_size(panels) == 0)
    return fail(EXIT_CODE_INPUT, "%s: a figure is an object with a list \"panels\"", reading->path);
  int exit_code = check_page_keys(reading, root);
  if (exit_code == EXIT_CODE_OK) exit_code = read_page_numbers(reading, root);
  if (exit_code == EXIT_CODE_OK) exit_code = read_share(reading, json_object_get(root, "share"));
  for (size_t p = 0; p < json_array_size(panels) && exit_code == EXIT_CODE_OK; p++)
    exit_code = add_panel(reading, json_array_get(panels, p), json_object_get(root, "options"), -1);
  return exit_code == EXIT_CODE_OK ? add_letters(reading, json_object_get(root, "letters")) : exit_code;
}

/* Replaces the bytes of a PNG by the JSON that it carries; other bytes stay. */
static int take_from_picture(const char *path, unsigned char **bytes, size_t *length) {
  hl_context *context = NULL;
  hl_error error = {0};
  char *text = NULL, *copy = NULL;
  if (*length < 8 || memcmp(*bytes, "\x89PNG\r\n\x1a\n", 8) != 0) return EXIT_CODE_OK;
  hl_status status = hl_context_create(NULL, &context, &error);
  if (status == HL_OK) status = hl_image_find_scene(context, path, *bytes, *length, &text, &error);
  free(*bytes);
  *bytes = NULL;
  if (status == HL_OK) copy = strdup(text);
  if (copy != NULL) *length = strlen(copy), *bytes = (unsigned char *)copy;
  hl_text_release(context, text);
  hl_context_destroy(context);
  if (status != HL_OK) return fail(EXIT_CODE_INPUT, "%s", error.message);
  return copy != NULL ? EXIT_CODE_OK : fail(EXIT_CODE_FAILURE, "out of memory");
}

bool figure_is_in_picture(const char *path) {
  size_t length = 0;
  unsigned char *bytes = frames_read_picture(path, &length);
  hl_context *context = NULL;
  char *text = NULL;
  json_t *json = NULL;
  if (bytes != NULL && hl_context_create(NULL, &context, NULL) == HL_OK &&
      hl_image_find_scene(context, path, bytes, length, &text, NULL) == HL_OK)
    json = hl_plain_json_load_text(text);
  const bool found = json_object_get(json, "panels") != NULL;
  json_decref(json);
  hl_text_release(context, text);
  hl_context_destroy(context);
  free(bytes);
  return found;
}

int figure_page_read(const char *path, figure_page *page) {
  *page = (figure_page){.panels = calloc(FIGURE_MOST_PANELS, sizeof *page->panels)};
  if (page->panels == NULL) return fail(EXIT_CODE_FAILURE, "out of memory");
  size_t length = 0;
  unsigned char *bytes = frames_read_picture(path, &length);
  if (bytes == NULL) return frames_fail_read(path);
  int exit_code = take_from_picture(path, &bytes, &length);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  json_error_t place;
  json_t *root = hl_plain_json_load((const char *)bytes, length, JSON_REJECT_DUPLICATES, &place);
  free(bytes);
  if (root == NULL)
    return fail(EXIT_CODE_INPUT, "%s: line %d, column %d: %s", path, place.line, place.column, place.text);
  page_reading reading = {.path = path, .page = page};
  exit_code = read_root(&reading, root);
  page->json = root;
  return exit_code;
}

char *figure_page_text(const figure_page *page) {
  json_object_set_new(page->json, "dpi", json_real(page->pixels_per_inch));
  return json_dumps(page->json, JSON_COMPACT);
}

void figure_page_release(figure_page *page) {
  json_decref(page->json);
  for (int p = 0; p < page->count; p++) {
    figure_panel *panel = &page->panels[p];
    for (size_t w = 0; w < panel->word_count; w++) free(panel->words[w]);
    free(panel->words);
    free(panel->letter);
    overlay_release(&panel->overlay);
    hl_image_destroy(panel->image);
    hl_scene_release(panel->scene);
  }
  free(page->panels);
}
