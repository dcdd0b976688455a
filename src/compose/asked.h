/* compose/asked.h - reads the options of one call. The values that were read have the order of the table of
 * options. */
#ifndef HL_COMPOSE_ASKED_H
#define HL_COMPOSE_ASKED_H

#include <halflight/compose.h>
#include <stdbool.h>

typedef enum hl_ask {
  HL_ASK_SIZE,
  HL_ASK_BACKGROUND,
  HL_ASK_EXPOSURE,
  HL_ASK_TONE,
  HL_ASK_VIEW,
  HL_ASK_UP,
  HL_ASK_AZIMUTH,
  HL_ASK_ELEVATION,
  HL_ASK_ROLL,
  HL_ASK_ZOOM,
  HL_ASK_FOVY,
  HL_ASK_ORTHO,
  HL_ASK_LOOK, /* from this option to HL_ASK_SHADING: options for the look of volumes */
  HL_ASK_TF,
  HL_ASK_COLORMAP,
  HL_ASK_COLOR_BY,
  HL_ASK_COLOR_BY_THRESHOLD,
  HL_ASK_RANGE,
  HL_ASK_RANGE_SCALE,
  HL_ASK_THRESHOLD,
  HL_ASK_ISO,
  HL_ASK_DENSITY,
  HL_ASK_SLICE,
  HL_ASK_CLIP,
  HL_ASK_CUT_PLANE,
  HL_ASK_CUT_BOX,
  HL_ASK_CUT_SPHERE,
  HL_ASK_CUT_SHADING,
  HL_ASK_CUT_CASTS_SHADOW,
  HL_ASK_WHOLE,
  HL_ASK_SCATTERING,
  HL_ASK_SHADING,
  HL_ASK_FLOOR,
  HL_ASK_OUTLINE,
  HL_ASK_RULER,
  HL_ASK_LABELS,
  HL_ASK_MASK,
  HL_ASK_LABEL_TABLE,
  HL_ASK_SHOW,
  HL_ASK_UNIT,
  HL_ASK_AMBIENT,
  HL_ASK_SKY,
  HL_ASK_LIGHT_RIG,
  HL_ASK_LIGHT,
  HL_ASK_LIGHT_SIZE,
  HL_ASK_SHADOWS, /* from this option to the last one: settings of hl_render_settings */
  HL_ASK_SOFT_METHOD,
  HL_ASK_LIGHT_SAMPLES,
  HL_ASK_SHADOW_RESOLUTION,
  HL_ASK_SHADOW_LOOKUP,
  HL_ASK_SHEET_SPACING,
  HL_ASK_PIXEL_SAMPLES,
  HL_ASK_KERNEL,
  HL_ASK_RECONSTRUCTION,
  HL_ASK_SLICING,
  HL_ASK_THREADS,
  HL_ASK_COUNT
} hl_ask;

enum { HL_ASK_MOST_TEXTS = 32 };

/* The choices of "background". */
enum { HL_BACKGROUND_TRANSPARENT = 1, HL_BACKGROUND_SKY = 2 };

/* The choices of "look": the library's looks, and the maximum projection. */
enum {
  HL_LOOK_AUTO,
  HL_LOOK_SURFACE,
  HL_LOOK_TRANSLUCENT,
  HL_LOOK_XRAY,
  HL_LOOK_SMOKE,
  HL_LOOK_VESSELS,
  HL_LOOK_MIP
};

/* The value of one option. */
typedef struct hl_asked {
  bool given;
  const char *text; /* the value as the caller gave it; of an option that was given several times, the last
                     * value */
  const char *texts[HL_ASK_MOST_TEXTS]; /* [count] */
  int count;
  bool chosen; /* whether the value is one of the option's choices; if so, `choice` is the value of the
                * choice */
  int choice;
  double number[3]; /* the value's numbers; of an option that was given several times, the numbers of the last
                     * value */
  bool percent[3];  /* whether each number is a percentile */
} hl_asked;

/* A row of the table of options. */
typedef struct hl_option_row {
  const char *name;
  hl_option_kind kind;
  int count;      /* number of numbers, 1 to 3 */
  char separator; /* character between numbers */
  bool percent;   /* whether each number may be a percentile */
  bool even;      /* whether a single number stands for all numbers */
  bool repeats;
  bool named;                       /* for HL_OPTION_NUMBERS: whether NAME= may stand before the numbers */
  const hl_setting_choice *choices; /* the option's own choices; if null, the option has the choices of
                                     * `setting`, if the setting has choices */
  hl_setting_kind setting_kind;
  const char *setting; /* the setting that the option sets; null if the option sets no setting */
} hl_option_row;

extern const hl_option_row hl_option_rows[HL_ASK_COUNT];

/* Reads options into asked: [HL_ASK_COUNT]. `asked` borrows its texts from the options. */
hl_status hl_options_read(const hl_option *options, size_t count, hl_asked *asked, hl_error *error);

/* Reads the numbers of a row's option from a text that has no NAME=. */
bool hl_row_numbers(const hl_option_row *row, const char *text, hl_asked *asked);

/* The text after NAME= of an option's value; the whole text if the value does not begin with NAME=. */
const char *hl_after_name(const char *text);

/* The choices of a row's option: the row's own choices, or else the choices of the row's setting. Null if the
 * setting has no choices either. */
const hl_setting_choice *hl_row_choices(const hl_option_row *row);

#endif
