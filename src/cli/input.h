/* cli/input.h - reads the operand INPUT of a subcommand: a scene, a picture that carries a scene, or a bare
 * volume, for which a scene is made.
 *
 * A pipe ("-" is standard input) is read once, into memory, because its first bytes must tell its kind before
 * a reader reads it from the beginning. */
#ifndef HL_CLI_INPUT_H
#define HL_CLI_INPUT_H

#include <limits.h>
#include <math.h>
#include <stdbool.h>

#include "host.h"
#include "options.h"

typedef enum input_kind { INPUT_SCENE, INPUT_PICTURE, INPUT_VOLUME } input_kind;

typedef struct cli_input {
  const char *path;  /* as given; "-" is standard input */
  const char *title; /* the input's name in messages */
  input_kind kind;
  unsigned char *bytes; /* owned; [length]: the content of a pipe or a picture; else null */
  size_t length;
  const char *look;     /* the look of a bare volume (hl_look_name); null stands for the look that suits the
                         * data */
  const double *smooth; /* the smoothing of a bare volume, in voxels (hl_volume_smooth()); null stands for the
                         * smoothing that the data need */
  int first_pixels;     /* for a scene: the longer side of the picture for which its volumes are read first
                         * (hl_scene_load_coarse()); 0: they are read at once as the scene says */
} cli_input;

/* The rows of --array, --component, --time, --channel and --level in a subcommand's table of options;
 * heading: see cli_option.group. */
#define INPUT_OPTION_ARRAY(heading)                                                                       \
  {                                                                                                       \
    .name = "array", .kind = OPTION_TEXT, .argument = "NAME", .group = (heading),                         \
    .help =                                                                                               \
        "the array of the file to read (default: the active one,\nelse the first one with one component)" \
  }
#define INPUT_OPTION_COMPONENT                                                                              \
  {                                                                                                         \
    .name = "component", .kind = OPTION_NUMBERS, .argument = "N|WORD",                                      \
    .help =                                                                                                 \
        "the component to read of voxels with several values,\nor the volume of a series, from 0; "         \
        "magnitude: "                                                                                       \
        "the length\nof the values as a vector; color: colours, with opacity\nfrom alpha if there is one; " \
        "luminance: colours, with\nopacity from luminance (default: the only one; else\ncolours if they "   \
        "are; "                                                                                             \
        "else the magnitude of 2 or 3; else 0)",                                                            \
    .choices = input_components, .count = 1, .whole = true, .low = 0, .high = 1e9                           \
  }
#define INPUT_OPTION_SERIES                                                                   \
  {                                                                                           \
    .name = "series", .kind = OPTION_TEXT, .argument = "NAME",                                \
    .help = "the DICOM series to read, by number, UID or description\n(default: the largest)" \
  }
#define INPUT_OPTION_INDEX(word, text)                                                                  \
  {                                                                                                     \
    .name = (word), .kind = OPTION_NUMBERS, .argument = "N", .help = (text), .count = 1, .whole = true, \
    .low = 0, .high = 1e9                                                                               \
  }
#define INPUT_OPTION_TIME INPUT_OPTION_INDEX("time", "the time step to read, from 0 (default: 0)")
#define INPUT_OPTION_CHANNEL                                                                 \
  {                                                                                          \
    .name = "channel", .kind = OPTION_TEXT, .argument = "N|NAME",                            \
    .help = "the channel to read: its number, from 0, or its\nname in the file (default: 0)" \
  }
#define INPUT_OPTION_CHANNELS                                                                           \
  {                                                                                                     \
    .name = "channel", .also = "channels", .kind = OPTION_TEXT, .argument = "NAME|N|N,N|all",           \
    .help = "number of the channel to show, from 0 (default: 0), or\nits name in the file; several "    \
            "channels (DAPI,GFP or 0,2),\nor all, share a picture, each in its colour from the\nfile, " \
            "or in green, magenta, ..."                                                                 \
  }
#define INPUT_OPTION_LEVEL                                                                                \
  INPUT_OPTION_INDEX("level", "the resolution to read; 0 is the finest (default: the\nfinest up to 2^30 " \
                              "voxels that fits into memory)")
#define INPUT_OPTION_SPACING                                                                             \
  {                                                                                                      \
    .name = "spacing", .kind = OPTION_NUMBERS, .argument = "SX,SY,SZ|S",                                 \
    .help = "distance of voxels in world units, also as one\nnumber for all axes (default: the file's)", \
    .count = 3, .separator = ',', .even = true, .low = 0, .above = true, .high = INFINITY                \
  }
#define INPUT_OPTION_SPACE                                                                                  \
  {                                                                                                         \
    .name = "space", .kind = OPTION_TEXT, .argument = "RAS|LPS|XYZ",                                        \
    .help = "directions in the body to which x, y and z of the file\npoint, by one letter each: R or L, A " \
            "or P, "                                                                                        \
            "S or I, as\nPIR for sagittal slices (default: the file's)"                                     \
  }
/* Rows for the table of options of a subcommand: all options of enum input_reading except the channel, from
 * row `first` on. */
#define INPUT_OPTIONS(first, heading)                                                         \
  [first] = INPUT_OPTION_ARRAY(heading), [(first) + READ_COMPONENT] = INPUT_OPTION_COMPONENT, \
  [(first) + READ_SERIES] = INPUT_OPTION_SERIES, [(first) + READ_TIME] = INPUT_OPTION_TIME,   \
  [(first) + READ_LEVEL] = INPUT_OPTION_LEVEL
extern const cli_choice input_components[];

/* The options that choose the part of a file that is read, in the order of the rows in a subcommand's
 * table. */
enum input_reading { READ_ARRAY, READ_COMPONENT, READ_SERIES, READ_TIME, READ_CHANNEL, READ_LEVEL };

/* The options that state where a file's voxels lie, in the order of the rows in a subcommand's table. */
enum input_place { PLACE_SPACING, PLACE_SPACE };

/* Finds out the kind of an input, by its name or, if the name does not tell, by its first bytes; reads pipes
 * and pictures into memory. limit: the greatest number of bytes to hold; 0 stands for half of the machine's
 * memory. Returns the exit code; call input_close() even after a failure. */
int input_open(const char *path, uint64_t limit, cli_input *input);
void input_close(cli_input *input);

/* Finds the load options that the options of enum input_reading, --spacing and --space ask for. reading: the
 * values of enum input_reading. place: the values of enum input_place. The text of --channel becomes the name
 * of one channel. */
void input_load_options(const cli_value *reading, const cli_value *place, hl_volume_load_options *options);

/* Refuses a value of --space that names no directions. place: the values of enum input_place. Returns the
 * exit code. */
int input_check_place(const cli_value *place);

/* Refuses values of --channel that no file can have: empty items of a list, an item that is there twice, and
 * more items than a picture shows. */
int input_check_channels(const cli_value *said);

/* Returns whether --channel may ask for more than one channel; "all" counts as several, although a file may
 * have only one. */
bool input_has_channels(const cli_value *said);

/* The longer side of a picture whose size nobody has chosen, in pixels: the value of
 * hl_volume_load_options.pixels if no picture's size is known. */
int input_picture_side(void);

/* Reads an input that is a volume. options: all members except `bytes`, which the input has; null stands for
 * the defaults. */
hl_status input_load_volume(hl_context *context, const cli_input *input,
                            const hl_volume_load_options *options, hl_volume **volume, hl_error *error);

/* Refuses the unit of --unit if the volume's file states another one. Returns the exit code. */
int input_check_unit(const cli_value *unit, const hl_volume *volume);

/* Replaces a volume by the smoothed volume that --smooth asks for. */
hl_status input_smooth(double sigma, hl_volume **volume, hl_error *error);

/* Writes into a scene's volume the options with which it was read, so that the scene's text has them. The
 * strings are borrowed. */
void input_name_source(const hl_volume_load_options *options, hl_scene_volume *volume);

/* Writes into a scene of one volume the options with which this volume was read. */
hl_status input_name_scene(hl_context *context, const hl_volume_load_options *options, hl_scene **scene,
                           hl_error *error);

/* The scene of an input. It is read from the input, or made for a bare volume. options: the options for
 * reading a bare volume; null stands for the defaults. */
hl_status input_load(hl_context *context, const cli_input *input, const hl_volume_load_options *options,
                     hl_scene **scene, hl_error *error);

/* Returns whether a file holds a mesh. A VTK file of particles, or of cells that enclose a volume and have
 * values, is a volume. A URL is no mesh, because only volumes are read from servers. */
bool is_mesh_file(hl_context *context, const char *path);

/* Orders names (char **) by the numbers in them, for qsort(). */
int compare_by_number(const void *a, const void *b);

/* Finds a file or a folder that is installed with the program. places: paths relative to the program's
 * folder, each less than 64 bytes long and with a slash at its beginning; null ends them. Returns whether one
 * of them is readable; path becomes the first readable one. */
bool find_installed(const char *const *places, char path[PATH_MAX]);

#endif
