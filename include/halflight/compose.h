/* halflight/compose.h - makes scenes by named options, also for a bare volume, a volume that is given without
 * a scene.
 *
 * The program, the Python package and the viewer make their scenes by hl_scene_compose(). The options have
 * the names of the options of `halflight render`. An option is given by its name, without dashes, and its
 * value as text. */
#ifndef HALFLIGHT_COMPOSE_H
#define HALFLIGHT_COMPOSE_H

#include "settings.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One option. An option that may be given several times ("iso", "tf", "show", ...) stands in the list of
 * options several times. */
typedef struct hl_option {
  const char *name;  /* the option's name, as "look", "iso" or "view"; hl_option_name() lists all names */
  const char *value; /* the option's value, as text that is written as for `halflight render`; null or "" for
                      * a switch, an option without a value */
} hl_option;

/* The form in which the value of an option is read. */
typedef enum hl_option_kind {
  HL_OPTION_SWITCH = 0,  /* no value */
  HL_OPTION_TEXT = 1,    /* the value is a text in the option's own form; for example "120:gold:0.3" for the
                          * option "iso" */
  HL_OPTION_CHOICE = 2,  /* the value is one of hl_option_choices() */
  HL_OPTION_NUMBERS = 3, /* the value is numbers joined by ',' or 'x', or one of hl_option_choices() */
  HL_OPTION_COLOR = 4    /* the value is a colour (linear R,G,B, a grey, #rrggbb or a CSS name), or one of
                          * hl_option_choices() */
} hl_option_kind;

/* Returns the name of option number `index` of hl_scene_compose(), or null past the last option. */
HL_API const char *hl_option_name(size_t index);

/* Returns how the value of a named option is read; HL_OPTION_TEXT for an unknown name. */
HL_API hl_option_kind hl_option_kind_of(const char *name);

/* Returns the choices of a named option as an array that a choice with a null name ends. Returns null if the
 * option has no choices. */
HL_API const hl_setting_choice *hl_option_choices(const char *name);

/* Flags, joined by |, that tell hl_scene_compose() how the caller made or changed the description. */
typedef enum hl_compose_flag {
  /* The description was made by hl_scene_for_volume() or a similar function, which chose its camera, light
   * and sky. If an option affects the camera, the light or the sky, it is chosen anew. */
  HL_COMPOSE_BARE = 1,
  HL_COMPOSE_CHANGED = 2, /* the caller changed which voxels of the volumes are seen: the camera of an
                           * HL_COMPOSE_BARE description is placed anew so that they fill the picture */
  HL_COMPOSE_CUT = 4, /* the caller cut the volume: the light of an HL_COMPOSE_BARE description is chosen for
                       * the part that is left */
  HL_COMPOSE_CAMERA = 8,   /* the caller placed the camera: it is not moved */
  HL_COMPOSE_LIGHTS = 16,  /* the caller chose the lights: their strengths are not changed */
  HL_COMPOSE_SKY = 32,     /* the caller chose the sky: it is not changed */
  HL_COMPOSE_MESHES = 64,  /* the caller added meshes: the camera of an HL_COMPOSE_BARE description shows the
                            * meshes, too */
  HL_COMPOSE_VALUES = 128, /* a label map of an HL_COMPOSE_BARE description is drawn by its values, even if no
                            * option asks for this */
  /* the caller has chosen opacities: a channel that hides another channel keeps its own opacities */
  HL_COMPOSE_FUNCTIONS = 256
} hl_compose_flag;

/* Makes a scene of a description and options. The options are applied in this fixed order, whatever their
 * order in the list is: label maps, looks and functions, cuts, outline, camera, floor, lights, exposure, sky,
 * ambient light, settings. A bare label map is drawn by its values, and not by its labels, if one of these
 * options says how values are drawn: "tf", "colormap", "range", "threshold", "iso", "mask" and the maximum
 * projection. If a bare label map's file has further layers, the scene shows them, too. flags:
 * hl_compose_flag values, joined by |. The context's log names options that change nothing. *scene is owned
 * by the caller, who releases it. Errors name an option with two dashes, as on the program's command line:
 * HL_ERROR_ARGUMENT for an impossible value, HL_ERROR_INPUT or HL_ERROR_IO for a file that an option
 * names. */
HL_API HL_WARN_UNUSED hl_status hl_scene_compose(hl_context *context, const hl_scene_description *description,
                                                 unsigned flags, const hl_option *options,
                                                 size_t option_count, hl_scene **scene, hl_error *error);

/* Checks options before any file is read. Refuses unknown names, values that cannot be read, and options that
 * exclude each other, as hl_scene_compose() would. */
HL_API HL_WARN_UNUSED hl_status hl_options_check(const hl_option *options, size_t option_count,
                                                 hl_error *error);

/* Makes a scene of a label map's layers, each of which becomes a volume. The options "label-table" and "show"
 * say how the labels are named and which of them show; labels of "show" that the map lacks are passed over.
 * path: the label map's file; reading: the options for reading it, as for hl_volume_load_with(); null stands
 * for the defaults. */
HL_API HL_WARN_UNUSED hl_status hl_scene_for_label_map(hl_context *context, const char *path,
                                                       const hl_volume_load_options *reading,
                                                       const hl_option *options, size_t option_count,
                                                       hl_scene **scene, hl_error *error);

/* Shows the labels that a list names, and hides the others. show: the value of the option "show":
 * NAME|NUMBER|all|rest[=COLOR|=own][:OPACITY], with commas between the items; "rest" stands for the labels
 * that the list does not name. labels: [count]. HL_ERROR_ARGUMENT: an item cannot be read, or no label has
 * its name; the message suggests a name or lists the labels. */
HL_API HL_WARN_UNUSED hl_status hl_labels_show(hl_context *context, const char *show, hl_label *labels,
                                               size_t count, hl_error *error);

/* Finds the colour, linear RGB, of mesh or isosurface number `index` if it has no colour of its own. The
 * colours are ivory, blue, ochre, green, rose and violet, and repeat after the sixth. */
HL_API void hl_surface_color(size_t index, double color[3]);

/* The default size of a floor (hl_scene_make_floor()). */
#define HL_FLOOR_SIZE 3.0

/* Fills a mesh of a scene with the defaults of a floor: matt and grey, and left whole by the scene's cuts. */
HL_API void hl_scene_floor_defaults(hl_scene_mesh *floor);

/* Makes the triangles of a floor: a square, perpendicular to `up`, that touches everything visible from
 * below. up: null means the camera's up. size: the length of the floor's sides divided by the width of
 * everything that stands on the floor, from 1 to 1000. *mesh is owned by the caller, who adds it to the
 * description's meshes and releases it. */
HL_API HL_WARN_UNUSED hl_status hl_scene_make_floor(hl_context *context,
                                                    const hl_scene_description *description,
                                                    const double up[3], double size, hl_mesh **mesh,
                                                    hl_error *error);

#ifdef __cplusplus
}
#endif
#endif
