/* halflight/settings.h - describes the tables of settings: type, range, default and meaning of each key of a
 * scene.
 *
 * Each key has one row in a table. Scene files are read and written by these rows, and hl_scene_create()
 * takes its checks and defaults from them. Programs can make editors and documents from them, too. */
#ifndef HALFLIGHT_SETTINGS_H
#define HALFLIGHT_SETTINGS_H

#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The tables of settings. The comment at each table names the struct that has the fields, and then the place
 * of the keys in a scene file. */
typedef enum hl_setting_kind {
  HL_SETTINGS_SCENE = 0,             /* hl_scene_description; the file's top level */
  HL_SETTINGS_IMAGE = 1,             /* hl_scene_description; "image" */
  HL_SETTINGS_CAMERA = 2,            /* hl_camera; "camera" */
  HL_SETTINGS_LIGHT = 3,             /* hl_light; each of "lights" */
  HL_SETTINGS_VOLUME = 4,            /* hl_scene_volume; each of "volumes" */
  HL_SETTINGS_MATERIAL = 5,          /* hl_material; a volume's "material" */
  HL_SETTINGS_TRANSFER_FUNCTION = 6, /* fields of hl_transfer_function; keys of a volume's
                                      * "transfer_function" */
  HL_SETTINGS_RENDER = 7,            /* hl_render_settings; "render" */
  HL_SETTINGS_MESH = 8,              /* hl_scene_mesh; each of "meshes" */
  HL_SETTINGS_SKY = 9,               /* hl_sky; "sky" */
  HL_SETTINGS_ISO = 10,              /* hl_isosurface; each of a volume's "iso" */
  HL_SETTINGS_CUT = 11               /* hl_cut; each of a volume's "cuts" */
} hl_setting_kind;

/* The type of a setting. Each comment names the field's C type, and then the value in a scene file. */
typedef enum hl_setting_type {
  HL_SETTING_FLAG = 0,      /* int, 0 or 1; true or false */
  HL_SETTING_WHOLE = 1,     /* int; a whole number, or one of the choices' names */
  HL_SETTING_NUMBER = 2,    /* double; a number */
  HL_SETTING_CHOICE = 3,    /* an enum; one of the choices' names */
  HL_SETTING_POINT = 4,     /* double[3]; [x, y, z] */
  HL_SETTING_DIRECTION = 5, /* double[3]; [x, y, z], not all 0 */
  HL_SETTING_COLOR = 6      /* double[3]; [r, g, b] */
} hl_setting_type;

/* One of the values that a setting may have. */
typedef struct hl_setting_choice {
  const char *name; /* null ends the list */
  int value;
} hl_setting_choice;

typedef struct hl_setting {
  const char *key;   /* the key in a scene file; "transform/translate" stands for the key "translate" in the
                      * object "transform" */
  const char *field; /* the field's name in the struct */
  hl_setting_type type;
  const char *unit;                 /* "degrees", "world units", ...; "" for none */
  double low, high;                 /* the least and the greatest value of a number, or of each of three
                                     * numbers; both ends are allowed */
  int open_low;                     /* non-zero if the value `low` itself is refused */
  double standard[3];               /* the default: one number in standard[0], or three numbers */
  const hl_setting_choice *choices; /* the choices, which a null name ends; null if the setting has none */
  size_t offset;                    /* the byte offset of the field in the struct */
  unsigned only_for; /* for lights, cameras and skies: the types that have the key, as bits (1 << type); if 0,
                      * all types have it */
  int optional;      /* non-zero if hl_scene_to_json() leaves the key out if the field has its default */
  const char *sentence;
  const char *mend;   /* the part of an error's text that asks for a value in the range; {low} and {high}
                       * stand for the range's ends */
  const char *option; /* the option of `halflight render` that sets the field, without dashes; null if there
                       * is no such option */
} hl_setting;

/* Returns the number of rows of a table; 0 for an unknown kind of table. */
HL_API size_t hl_setting_count(hl_setting_kind kind);

/* Returns row number `index` of a table, or null past the last row. The row is constant. */
HL_API const hl_setting *hl_setting_get(hl_setting_kind kind, size_t index);

/* Returns the row of a key, or null if the table has no such key. */
HL_API const hl_setting *hl_setting_find(hl_setting_kind kind, const char *key);

#ifdef __cplusplus
}
#endif
#endif
