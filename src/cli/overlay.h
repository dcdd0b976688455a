/* cli/overlay.h - draws the overlays that options of `halflight render` ask for, and writes the files of
 * pictures. */
#ifndef HL_CLI_OVERLAY_H
#define HL_CLI_OVERLAY_H

#include "host.h"
#include "options.h"

#define MILLIMETRES_PER_INCH 25.4

typedef struct cli_overlay {
  hl_overlay overlay; /* the overlay, whose texts are borrowed from the options, or from `texts` and `unit` */
  hl_annotation notes[MAXIMUM_REPEATS];
  char *texts[MAXIMUM_REPEATS]; /* owned; of `notes` */
  char unit[40];                /* unit of --scale-bar */
  double width;                 /* the width from --width, in millimetres; 0 if it is not given */
  double pixels_per_inch;       /* the pixels per inch that files state, from --dpi; 0 if they follow from
                                 * --width, or if files state none */
  double font_points;           /* 0 stands for the default */
  bool drawn;                   /* anything is drawn over pictures */
} cli_overlay;

/* The length of a unit on paper in millimetres: "mm", "cm", "in" or "pt"; 0 for any other text. */
double overlay_unit(const char *name);

void overlay_release(cli_overlay *overlay);

/* Returns whether a picture's file has overlays or states a physical size, so that the scene alone does not
 * describe the file. */
bool overlay_is_any(const cli_overlay *overlay);

/* Keeps the parts of the overlay in the same places in all pictures of a series. Parts without a given corner
 * stay in their usual corners. */
void overlay_hold(cli_overlay *overlay);

/* Copies an overlay for one picture of a series or a film. In the copy's annotations, "%d" and "%04d" are
 * replaced by the picture's number, and "%s" by the name of its file, without folder and extension. file: may
 * be null; "%s" then stays. Returns false if memory is short. Call overlay_release() on the copy, also after
 * a failure. */
bool overlay_for_picture(const cli_overlay *overlay, int number, const char *file, cli_overlay *copy);

/* Finds out, before a picture of the scene is made, whether all overlays can be drawn over it. */
hl_status overlay_check_scene(hl_context *context, const cli_overlay *overlay, const hl_scene *scene,
                              hl_error *error);

/* Writes a picture with its overlays, in the format that the path's ending names. options: the scene's
 * options for writing, as for hl_image_write(). overlay: may be null. */
hl_status overlay_write(hl_context *context, const cli_overlay *overlay, const hl_image *image,
                        const hl_scene *scene, const char *path, hl_image_write_options *options,
                        hl_error *error);

/* Writes the bytes of a picture's file to memory, with overlays. format: "png" and so on. */
hl_status overlay_encode(hl_context *context, const cli_overlay *overlay, const hl_image *image,
                         const hl_scene *scene, const char *format, hl_image_write_options *options,
                         unsigned char **bytes, size_t *length, hl_error *error);

#endif
