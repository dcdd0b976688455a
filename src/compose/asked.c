/* compose/asked.c - defines the table of options by which scenes are composed, and reads the options'
 * values. */
#include "compose/asked.h"

#include <math.h>
#include <string.h>

#include "core/door.h"
#include "core/error.h"
#include "guess/rigs.h"
#include "text/color.h"
#include "text/edit_distance.h"
#include "text/plain.h"

static const hl_setting_choice backgrounds[] = {
    {"transparent", HL_BACKGROUND_TRANSPARENT}, {"sky", HL_BACKGROUND_SKY}, {NULL, 0}};
static const hl_setting_choice sides[] = {
    {"front", HL_SIDE_FRONT}, {"back", HL_SIDE_BACK},     {"left", HL_SIDE_LEFT}, {"right", HL_SIDE_RIGHT},
    {"top", HL_SIDE_TOP},     {"bottom", HL_SIDE_BOTTOM}, {"iso", HL_SIDE_ISO},   {NULL, 0}};
/* each value is 2 * axis + sign, where the sign is 1 for a negative direction */
static const hl_setting_choice axes[] = {{"+x", 0}, {"-x", 1}, {"+y", 2}, {"-y", 3}, {"+z", 4},
                                         {"-z", 5}, {"x", 0},  {"y", 2},  {"z", 4},  {NULL, 0}};
static const hl_setting_choice looks[] = {{"auto", HL_LOOK_AUTO},
                                          {"surface", HL_LOOK_SURFACE},
                                          {"translucent", HL_LOOK_TRANSLUCENT},
                                          {"xray", HL_LOOK_XRAY},
                                          {"smoke", HL_LOOK_SMOKE},
                                          {"vessels", HL_LOOK_VESSELS},
                                          {"mip", HL_LOOK_MIP},
                                          {NULL, 0}};
static const hl_setting_choice range_scales[] = {
    {"linear", HL_RANGE_LINEAR}, {"log", HL_RANGE_LOG}, {NULL, 0}};

/* clang-format off */
#define NUMBER(row, n)       [row] = {.name = (n), .kind = HL_OPTION_NUMBERS, .count = 1}
#define NAMED(row, n, c, ...) [row] = {.name = (n), .kind = HL_OPTION_NUMBERS, .count = (c), .named = true, .repeats = true, __VA_ARGS__}
#define TEXTS(row, n)        [row] = {.name = (n), .kind = HL_OPTION_TEXT, .repeats = true}
#define TEXT(row, n)         [row] = {.name = (n), .kind = HL_OPTION_TEXT}
#define SWITCH(row, n)       [row] = {.name = (n), .kind = HL_OPTION_SWITCH}
#define CHOICE(row, n, ...)  [row] = {.name = (n), .kind = HL_OPTION_CHOICE, __VA_ARGS__}
#define OF_RENDER(k)         .setting_kind = HL_SETTINGS_RENDER, .setting = (k)
#define RENDER_CHOICE(row, n, k) CHOICE(row, n, OF_RENDER(k))
#define RENDER_NUMBER(row, n, k) [row] = {.name = (n), .kind = HL_OPTION_NUMBERS, .count = 1, OF_RENDER(k)}

const hl_option_row hl_option_rows[HL_ASK_COUNT] = {
    [HL_ASK_SIZE] = {.name = "size", .kind = HL_OPTION_NUMBERS, .count = 2, .separator = 'x', .even = true},
    [HL_ASK_BACKGROUND] = {.name = "background", .kind = HL_OPTION_COLOR, .choices = backgrounds,
                           .setting_kind = HL_SETTINGS_IMAGE, .setting = "background"},
    NUMBER(HL_ASK_EXPOSURE, "exposure"),
    CHOICE(HL_ASK_TONE, "tone", .setting_kind = HL_SETTINGS_IMAGE, .setting = "tone"),
    CHOICE(HL_ASK_VIEW, "view", .choices = sides),
    [HL_ASK_UP] = {.name = "up", .kind = HL_OPTION_NUMBERS, .count = 3, .separator = ',', .choices = axes},
    NUMBER(HL_ASK_AZIMUTH, "azimuth"),
    NUMBER(HL_ASK_ELEVATION, "elevation"),
    NUMBER(HL_ASK_ROLL, "roll"),
    NUMBER(HL_ASK_ZOOM, "zoom"),
    NUMBER(HL_ASK_FOVY, "fovy"),
    SWITCH(HL_ASK_ORTHO, "ortho"),
    CHOICE(HL_ASK_LOOK, "look", .choices = looks),
    TEXTS(HL_ASK_TF, "tf"),
    TEXTS(HL_ASK_COLORMAP, "colormap"),
    TEXT(HL_ASK_COLOR_BY, "color-by"),
    [HL_ASK_COLOR_BY_THRESHOLD] = {.name = "color-by-threshold", .kind = HL_OPTION_NUMBERS, .count = 2, .separator = ',', .even = true},
    NAMED(HL_ASK_RANGE, "range", 2, .separator = ',', .percent = true),
    CHOICE(HL_ASK_RANGE_SCALE, "range-scale", .choices = range_scales),
    NAMED(HL_ASK_THRESHOLD, "threshold", 1, .separator = ','),
    TEXTS(HL_ASK_ISO, "iso"),
    NUMBER(HL_ASK_DENSITY, "density"),
    TEXT(HL_ASK_SLICE, "slice"),
    TEXTS(HL_ASK_CLIP, "clip"),
    TEXTS(HL_ASK_CUT_PLANE, "cut-plane"),
    TEXTS(HL_ASK_CUT_BOX, "cut-box"),
    TEXTS(HL_ASK_CUT_SPHERE, "cut-sphere"),
    CHOICE(HL_ASK_CUT_SHADING, "cut-shading", .setting_kind = HL_SETTINGS_VOLUME, .setting = "cut_shading"),
    SWITCH(HL_ASK_CUT_CASTS_SHADOW, "cut-casts-shadow"),
    SWITCH(HL_ASK_WHOLE, "whole"),
    [HL_ASK_SCATTERING] = {.name = "scattering", .kind = HL_OPTION_COLOR, .setting_kind = HL_SETTINGS_VOLUME,
                           .setting = "scattering/albedo"},
    CHOICE(HL_ASK_SHADING, "shading", .setting_kind = HL_SETTINGS_VOLUME, .setting = "shading"),
    SWITCH(HL_ASK_FLOOR, "floor"),
    SWITCH(HL_ASK_OUTLINE, "outline"),
    TEXTS(HL_ASK_RULER, "ruler"),
    TEXT(HL_ASK_LABELS, "labels"),
    TEXT(HL_ASK_MASK, "mask"),
    TEXT(HL_ASK_LABEL_TABLE, "label-table"),
    TEXTS(HL_ASK_SHOW, "show"),
    TEXT(HL_ASK_UNIT, "unit"),
    [HL_ASK_AMBIENT] = {.name = "ambient", .kind = HL_OPTION_COLOR, .setting_kind = HL_SETTINGS_SCENE,
                        .setting = "ambient"},
    TEXT(HL_ASK_SKY, "sky"),
    CHOICE(HL_ASK_LIGHT_RIG, "light-rig", .choices = hl_light_rig_choices),
    [HL_ASK_LIGHT] = {.name = "light", .kind = HL_OPTION_NUMBERS, .count = 2, .separator = ','},
    NUMBER(HL_ASK_LIGHT_SIZE, "light-size"),
    RENDER_CHOICE(HL_ASK_SHADOWS, "shadows", "shadows"),
    RENDER_CHOICE(HL_ASK_SOFT_METHOD, "soft-method", "soft_method"),
    RENDER_NUMBER(HL_ASK_LIGHT_SAMPLES, "light-samples", "light_samples"),
    RENDER_NUMBER(HL_ASK_SHADOW_RESOLUTION, "shadow-resolution", "shadow_resolution"),
    RENDER_CHOICE(HL_ASK_SHADOW_LOOKUP, "shadow-lookup", "shadow_lookup"),
    RENDER_NUMBER(HL_ASK_SHEET_SPACING, "sheet-spacing", "sheet_spacing"),
    RENDER_NUMBER(HL_ASK_PIXEL_SAMPLES, "pixel-samples", "pixel_samples"),
    RENDER_CHOICE(HL_ASK_KERNEL, "kernel", "kernel"),
    RENDER_CHOICE(HL_ASK_RECONSTRUCTION, "reconstruction", "reconstruction"),
    RENDER_CHOICE(HL_ASK_SLICING, "slicing", "slicing"),
    RENDER_NUMBER(HL_ASK_THREADS, "threads", "threads"),
};
/* clang-format on */

const char *hl_option_name(size_t index) { return index < HL_ASK_COUNT ? hl_option_rows[index].name : NULL; }

/* The number of the table's row for an option; HL_ASK_COUNT if no option has this name. */
static size_t find_row(const char *name) {
  size_t row = 0;
  while (row < HL_ASK_COUNT && (name == NULL || strcmp(hl_option_rows[row].name, name) != 0)) row++;
  return row;
}

hl_option_kind hl_option_kind_of(const char *name) {
  HL_DOOR;
  size_t row = find_row(name);
  return row < HL_ASK_COUNT ? hl_option_rows[row].kind : HL_OPTION_TEXT;
}

const hl_setting_choice *hl_row_choices(const hl_option_row *row) {
  if (row->choices != NULL || row->setting == NULL) return row->choices;
  return hl_setting_find(row->setting_kind, row->setting)->choices;
}

const hl_setting_choice *hl_option_choices(const char *name) {
  HL_DOOR;
  size_t row = find_row(name);
  return row < HL_ASK_COUNT ? hl_row_choices(&hl_option_rows[row]) : NULL;
}

/* Reads a choice, in upper or lower case. *text becomes the choice's own name. */
static bool read_choice(const hl_option_row *row, const char **text, hl_asked *asked) {
  for (const hl_setting_choice *choice = hl_row_choices(row); choice != NULL && choice->name != NULL;
       choice++)
    if (hl_plain_equal(choice->name, *text)) {
      *text = choice->name;
      asked->chosen = true;
      asked->choice = choice->value;
      return true;
    }
  return false;
}

const char *hl_after_name(const char *text) {
  const char *equals = strchr(text, '=');
  return equals != NULL ? equals + 1 : text;
}

bool hl_row_numbers(const hl_option_row *row, const char *text, hl_asked *asked) {
  for (int n = 0; n < row->count; n++) {
    char *end;
    asked->number[n] = hl_plain_number(text, &end);
    if (end == text || !isfinite(asked->number[n])) return false;
    asked->percent[n] = row->percent && *end == '%';
    if (asked->percent[n] && !(asked->number[n] >= 0 && asked->number[n] <= 100)) return false;
    end += asked->percent[n];
    if (row->even && n == 0 && *end == '\0') {
      for (int other = 1; other < row->count; other++) asked->number[other] = asked->number[0];
      return true;
    }
    if (*end != (n + 1 < row->count ? row->separator : '\0')) return false;
    text = end + 1;
  }
  return true;
}

static bool read_color(const hl_option_row *row, const char **text, hl_asked *asked) {
  const hl_setting *setting = hl_setting_find(row->setting_kind, row->setting);
  return read_choice(row, text, asked) || hl_parse_color(*text, setting->low, setting->high, asked->number);
}

static bool read_value(const hl_option_row *row, const char **text, hl_asked *asked) {
  switch (row->kind) {
    case HL_OPTION_SWITCH: return true;
    case HL_OPTION_TEXT: return (*text)[0] != '\0';
    case HL_OPTION_CHOICE: return read_choice(row, text, asked);
    case HL_OPTION_NUMBERS:
      return read_choice(row, text, asked) ||
             hl_row_numbers(row, row->named ? hl_after_name(*text) : *text, asked);
    case HL_OPTION_COLOR: return read_color(row, text, asked);
  }
  return false;
}

static hl_status refuse_name(const char *name, hl_error *error) {
  const char *names[HL_ASK_COUNT + 1] = {NULL};
  for (size_t row = 0; row < HL_ASK_COUNT; row++) names[row] = hl_option_rows[row].name;
  const char *near = hl_nearest_name(name, names);
  if (near != NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "unknown option '--%.80s': did you mean --%s?", name, near);
  return hl_fail(error, HL_ERROR_ARGUMENT, "unknown option '--%.80s': hl_option_name() lists them", name);
}

static hl_status refuse_value(const hl_option_row *row, const char *text, hl_error *error) {
  static const char *const kinds[] = {[HL_OPTION_SWITCH] = "nothing",
                                      [HL_OPTION_TEXT] = "a text",
                                      [HL_OPTION_CHOICE] = "one of its choices",
                                      [HL_OPTION_NUMBERS] = "numbers",
                                      [HL_OPTION_COLOR] = "a colour"};
  const char *names[64] = {NULL};
  const hl_setting_choice *choices = hl_row_choices(row);
  char mend[400] = "";
  size_t count = 0;
  for (; choices != NULL && choices[count].name != NULL && count < 63; count++)
    names[count] = choices[count].name;
  if (count > 0) hl_suggest_name(text, names, mend, sizeof mend);
  return hl_fail(error, HL_ERROR_ARGUMENT, "--%s: '%.200s' is not %s%s%s", row->name, text, kinds[row->kind],
                 count > 0 ? ": " : "", mend);
}

hl_status hl_options_read(const hl_option *options, size_t count, hl_asked *asked, hl_error *error) {
  memset(asked, 0, HL_ASK_COUNT * sizeof *asked);
  for (size_t n = 0; n < count; n++) {
    const char *text = options[n].value != NULL ? options[n].value : "";
    if (options[n].name == NULL)
      return hl_fail(error, HL_ERROR_ARGUMENT, "option number %zu has no name", n + 1);
    size_t which = find_row(options[n].name);
    if (which == HL_ASK_COUNT) return refuse_name(options[n].name, error);
    hl_asked *one = &asked[which];
    if (one->count == (hl_option_rows[which].repeats ? HL_ASK_MOST_TEXTS : 1))
      return hl_fail(error, HL_ERROR_ARGUMENT, "--%s is given more than %d times", options[n].name,
                     one->count);
    if (!read_value(&hl_option_rows[which], &text, one))
      return refuse_value(&hl_option_rows[which], text, error);
    one->texts[one->count++] = one->text = text;
    one->given = true;
  }
  return HL_OK;
}
