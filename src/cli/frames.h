/* cli/frames.h - declares functions for commands that make many pictures. They divide the pictures among
 * runs, find pictures that exist already, and draw a progress bar with an estimated time. */
#ifndef HL_CLI_FRAMES_H
#define HL_CLI_FRAMES_H

#include "host.h"
#include "options.h"

/* The row of --part in a subcommand's table of options. */
#define FRAMES_OPTION_PART(heading, text) \
  { .name = "part", .kind = OPTION_TEXT, .argument = "K/N", .group = (heading), .help = (text) }

/* The row of --frames-over-ranks. */
#define FRAMES_OPTION_RANKS                                                                  \
  {                                                                                          \
    .name = "frames-over-ranks", .kind = OPTION_SWITCH,                                      \
    .help = "under mpirun or srun: each of their processes renders its\nshare, as by --part" \
  }

/* The row of --no-metadata. */
#define FRAMES_OPTION_NO_METADATA                                                \
  {                                                                              \
    .name = "no-metadata", .kind = OPTION_SWITCH,                                \
    .help = "leave the scene, with the names of its files, out of\nthe pictures" \
  }

/* Reads --part K/N: *part becomes K - 1, and *parts N. Without the option there is one part, number 0. With
 * the option --frames-over-ranks (ranks), K and N come from the launcher's environment variables. Returns the
 * exit code. */
int frames_read_part(const cli_value *value, const cli_value *ranks, int *part, int *parts);

/* The bytes of a picture's file, owned by the caller (free); null if it cannot be read: errno tells why, or
 * is 0 if the file is empty or no regular file. */
unsigned char *frames_read_picture(const char *path, size_t *length);

/* Prints why frames_read_picture() has just returned null. Returns the exit code. */
int frames_fail_read(const char *path);

/* Returns whether a picture exists and carries this scene. */
bool frames_have_scene(const cli_host *host, const char *path, const hl_scene *scene);

/* Draws the progress bar. done: the number of finished pictures. wanted: the number of all pictures.
 * rendered: the number of pictures that this run has rendered in `seconds`. */
void frames_draw_bar(cli_host *host, int done, int wanted, int rendered, double seconds);

/* The options for writing pictures. */
typedef struct frames_style {
  bool opaque;      /* whether pictures are opaque even if the scene's background is transparent */
  bool no_metadata; /* whether pictures do not carry their scenes */
  const struct cli_overlay *overlay; /* the overlays that are drawn over each picture; may be null */
  int number;                        /* the picture's number, from 0 */
  const char *file;                  /* the path of the picture's volume or mesh; may be null */
} frames_style;

/* Renders a scene to a picture. */
hl_status frames_render(const cli_host *host, hl_renderer *renderer, const hl_scene *scene,
                        frames_style style, const char *path, hl_error *error);

#endif
