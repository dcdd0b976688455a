/* cli/overlay.h - the overlays that options of `halflight render` ask for, and the files of pictures. */
#ifndef HL_CLI_OVERLAY_H
#define HL_CLI_OVERLAY_H

#include "host.h"
#include "options.h"

#define MILLIMETRES_PER_INCH 25.4

typedef struct cli_overlay {
  hl_overlay overlay; /* its texts are borrowed from the options, or from `texts` and `unit` */
  hl_annotation notes[MAXIMUM_REPEATS];
  char *texts[MAXIMUM_REPEATS]; /* owned; of `notes` */
  char unit[40];                /* unit of --scale-bar */
  double width;                 /* width from --width, millimetres; 0: not stated */
  double pixels_per_inch;       /* the pixels per inch that files state, from --dpi; 0: they follow from
                                 * --width, or files state none */
  double font_points;           /* 0: the default */
  bool drawn;                   /* anything is drawn over pictures */
} cli_overlay;

/* The length of a unit on paper in millimetres: "mm", "cm", "in" or "pt"; 0 for any other text. */
double overlay_unit(const char *name);

void overlay_release(cli_overlay *overlay);

/* Whether overlays, or a physical size that the file states, make a picture's file different from what its
 * scene alone describes. */
bool overlay_is_any(const cli_overlay *overlay);

/* Finds out, before a picture of the scene is made, whether all overlays can be drawn over it. */
hl_status overlay_check_scene(hl_context *context, const cli_overlay *overlay, const hl_scene *scene,
                              hl_error *error);

/* Writes a picture with its overlays, in the format that the path's ending names. options: the scene's, as
 * for hl_image_write(). overlay: may be null. */
hl_status overlay_write(hl_context *context, const cli_overlay *overlay, const hl_image *image,
                        const hl_scene *scene, const char *path, hl_image_write_options *options,
                        hl_error *error);

/* Writes the bytes of a picture's file to memory, with overlays. format: "png" and so on. */
hl_status overlay_encode(hl_context *context, const cli_overlay *overlay, const hl_image *image,
                         const hl_scene *scene, const char *format, hl_image_write_options *options,
                         unsigned char **bytes, size_t *length, hl_error *error);

#endif
