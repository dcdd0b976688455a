/* cli/animate/animate.h - declares the functions that the files of `halflight animate` share. */
#ifndef HL_CLI_ANIMATE_ANIMATE_H
#define HL_CLI_ANIMATE_ANIMATE_H

#include "cli/frames.h"
#include "cli/host.h"
#include "film/film.h"

/* The numbered pictures of a film, in a folder: "turn-frames/0000.png". */
typedef struct animate_frames {
  cli_host *host;
  const film *film;
  const char *folder;
  frames_style style;
  int digits; /* number of digits of a picture's number */
  int done;   /* number of this run's finished pictures, including pictures that existed before */
  int rendered;
} animate_frames;

/* The path of a picture; path: [size]. */
void animate_frame_path(const animate_frames *frames, int frame, char *path, size_t size);

/* Returns whether a frame's picture exists and was made from the frame's own scene. */
bool animate_frame_is_there(const animate_frames *frames, int frame);

/* Renders the missing pictures among every `parts`-th picture, beginning with number `part` (from 0). Draws a
 * progress bar with the estimated time to the end. Returns the exit code. */
int animate_render(animate_frames *frames, int part, int parts);

/* Returns whether all pictures of the film exist. */
bool animate_is_complete(const animate_frames *frames);

/* Joins the pictures to a film. Returns the exit code. */
int animate_join(const animate_frames *frames, const char *path, double frames_per_second);

/* Removes the film's pictures, and then their folder if it is empty. */
void animate_remove_frames(const animate_frames *frames);

/* These two functions join, and remove, the pictures of a series of files. The pictures are named
 * "turn-frames/000000.png" and so on. */
int animate_join_series(const char *folder, int count, const char *output, double frames_per_second,
                        bool quiet);
void animate_remove_series(const char *folder, int count);

#endif
