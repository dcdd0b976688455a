/* halflight/compose.h - makes scenes by named options. A volume without a scene (a bare volume) gets one.
 *
 * The program, the Python package and the viewer make their scenes by hl_scene_compose(). The options are
 * those of `halflight render`: an option is its name, without dashes, and its value as text. */
#ifndef HALFLIGHT_COMPOSE_H
#define HALFLIGHT_COMPOSE_H

#include "settings.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One option. An option that may be given several times ("iso", "tf", "show", ...) stands in the list several
 * times. */
typedef struct hl_option {
  const char *name;  /* the option's name, as "look", "iso" or "view"; hl_option_name() lists all names */
  const char *value; /* the option's value, written as for `halflight render`; null or "" for a switch */
} hl_option;

/* How the value of an option is read. */
typedef enum hl_option_kind {
  HL_OPTION_SWITCH = 0,  /* no value */
  HL_OPTION_TEXT = 1,    /* the value is a text in the option's own form, as "120:gold:0.3" for "iso" */
  HL_OPTION_CHOICE = 2,  /* one of hl_option_choices() */
  HL_OPTION_NUMBERS = 3, /* the value is numbers joined by ',' or 'x', or one of hl_option_choices() */
  HL_OPTION_COLOR = 4    /* the value is a colour (linear R,G,B, a grey, #rrggbb or a CSS name), or one of
                          * hl_option_choices() */
} hl_option_kind;

/* The name of option number `index` of hl_scene_compose(); null past the last. */
HL_API const char *hl_option_name(size_t index);

/* The kind of a named option; HL_OPTION_TEXT for an unknown name. */
HL_API hl_option_kind hl_option_kind_of(const char *name);

/* The choices of a named option, ended by a null name; null where the option has no choices. */
HL_API const hl_setting_choice *hl_option_choices(const char *name);

/* Flags, joined by |, that tell hl_scene_compose() how the caller made or changed the description. */
typedef enum hl_compose_flag {
  /* The description was made by hl_scene_for_volume() or a similar function, which chose its camera, light
   * and sky. Where an option affects one of these, it is then chosen anew. */
  HL_COMPOSE_BARE = 1,
  HL_COMPOSE_CHANGED = 2, /* the caller changed what is seen of the volumes: the camera of an HL_COMPOSE_BARE
                           * description frames them anew */
  HL_COMPOSE_CUT = 4, /* the caller cut the volume: the light of an HL_COMPOSE_BARE description is chosen for
                       * the part that is left */
  HL_COMPOSE_CAMERA = 8,  /* the caller placed the camera: it stays */
  HL_COMPOSE_LIGHTS = 16, /* the caller chose the lights: their strengths stay */
  HL_COMPOSE_SKY = 32,    /* the caller chose the sky: it stays */
  HL_COMPOSE_MESHES = 64, /* the caller added meshes: the camera of an HL_COMPOSE_BARE description takes them
                           * into the picture, too */
  HL_COMPOSE_VALUES = 128 /* label maps of an HL_COMPOSE_BARE description are drawn by their values, even if
                           * no option asks for this */
} hl_compose_flag;

/* Makes a scene of a description and options. The options are applied in a fixed order, which is not that of
 * the list: label maps, looks and functions, cuts, camera, floor, lights, exposure, sky, ambient light,
 * settings. A bare label map is drawn by its values where options say how values are drawn: "tf", "colormap",
 * "range", "threshold", "iso", "mask" and the maximum projection. If a bare label map's file has further
 * layers, the scene shows them, too. flags: hl_compose_flag values, joined by |. The context's log names
 * options that change nothing. Errors name an option as the program does, with two dashes: HL_ERROR_ARGUMENT
 * for an impossible value, HL_ERROR_INPUT or HL_ERROR_IO for a file that an option names. */
HL_API HL_WARN_UNUSED hl_status hl_scene_compose(hl_context *context, const hl_scene_description *description,
                                                 unsigned flags, const hl_option *options,
                                                 size_t option_count, hl_scene **scene, hl_error *error);

/* Refuses options that hl_scene_compose() would refuse before it reads a file: unknown names, values that
 * cannot be read, options that exclude each other. */
HL_API HL_WARN_UNUSED hl_status hl_options_check(const hl_option *options, size_t option_count,
                                                 hl_error *error);

/* Makes a scene of a label map's layers, each of which becomes a volume. The options "label-table" and "show"
 * say how the labels are named and which of them show; labels of "show" that the map lacks are passed over.
 * path, reading (null: the defaults): as for hl_volume_load_with(). */
HL_API HL_WARN_UNUSED hl_status hl_scene_for_label_map(hl_context *context, const char *path,
                                                       const hl_volume_load_options *reading,
                                                       const hl_option *options, size_t option_count,
                                                       hl_scene **scene, hl_error *error);

/* The colour, linear RGB, of mesh or isosurface number `index` where it has none of its own: ivory, blue,
 * ochre, green, rose, violet, and ivory again. */
HL_API void hl_surface_color(size_t index, double color[3]);

#ifdef __cplusplus
}
#endif
#endif
