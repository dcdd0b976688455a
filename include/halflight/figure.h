/* halflight/figure.h - makes figures: pictures on a page, with scale bars, legends, axes and text over them.
 *
 * A figure is written as PDF or SVG (pictures as pixels, all else as vectors) or as PNG or TIFF (pixels). It
 * is drawn after the pictures are rendered, by cairo and pango; a build without these two libraries refuses
 * to draw, with HL_ERROR_UNSUPPORTED. Lengths on the page are in millimetres, sizes of letters in points
 * (1/72 inch).
 *
 * Texts are UTF-8 and are drawn as they are: nothing in them is markup. Control characters other than a line
 * break are drawn as U+FFFD, and so are bytes that are not UTF-8. */
#ifndef HALFLIGHT_FIGURE_H
#define HALFLIGHT_FIGURE_H

#include "render.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The ways in which a picture can show the directions of the world. */
typedef enum hl_axes {
  HL_AXES_NONE = 0,
  HL_AXES_ARROWS = 1, /* three arrows, whose usual corner is the lower right one. They are named after the
                       * directions of the body if the volume's file tells these; else x, y and z */
  HL_AXES_LETTERS = 2 /* letters at the picture's edges for the directions of the body: R or L, A or P, S or
                       * I; refused if the volume's file does not tell these directions */
} hl_axes;

/* The places of a scale bar, a legend and arrows in a picture. */
typedef enum hl_corner {
  HL_CORNER_FREE = 0, /* wherever the part covers the least of what the picture shows, at an edge of the
                       * picture and clear of all other parts; of several such places the one that is the
                       * nearest to the part's usual corner */
  HL_CORNER_UPPER_LEFT = 1,
  HL_CORNER_UPPER_RIGHT = 2,
  HL_CORNER_LOWER_LEFT = 3,
  HL_CORNER_LOWER_RIGHT = 4,
  HL_CORNER_BELOW = 5 /* for a legend alone: below all pictures, in a strip that hl_figure_add_strip() makes.
                       * Several panels that ask for it share the legend of the first of them */
} hl_corner;

/* A text over a picture. */
typedef struct hl_annotation {
  const char *text;
  double at[3]; /* the place in the picture, as fractions of its width and height, from its upper left corner;
                 * at[0] NAN: below one another at the upper left, clear of other parts; at[2] is not used */
  int in_world; /* non-zero if `at` is a point of the scene's world instead. A ring is drawn around the point,
                 * and the text stands beside the ring, clear of other parts */
} hl_annotation;

/* A value of hl_overlay.scale_bar_depth that stands for the distance from the eye to the camera's target. */
#define HL_DEPTH_OF_TARGET (-1.0)

/* The things that are drawn over one picture. hl_overlay_defaults() fills the struct so that nothing is
 * drawn. If the panel's image shows matter behind the scale bar, the legend or the arrows, a translucent
 * ground is drawn between the image and the bar, the legend or the arrows. A bar, a legend or arrows that
 * find no room in the picture are left out, and the context's log is told so. */
typedef struct hl_overlay {
  size_t struct_size;
  int scale_bar;           /* non-zero if a scale bar is drawn, with its length as text; its usual corner is
                            * the lower left one */
  double scale_bar_length; /* the scale bar's length in scale_bar_unit; if 0, a length is chosen that is 1,
                            * 2 or 5 times a power of ten and at most a quarter of the picture's width */
  const char *scale_bar_unit; /* the unit of the scale bar's length and text; if null, world_unit, or another
                               * unit that makes the number short */
  const char *world_unit;     /* the unit of length of the scene's world: "m", "mm", "um", "nm", "A", ..., or
                               * any other text, which is written as it is; null stands for the unit that the
                               * volumes' files tell. If the files tell no unit either, the scale bar is
                               * refused */
  double scale_bar_depth; /* the distance from the eye, in the scene's units, at which the scale bar is right,
                           * or HL_DEPTH_OF_TARGET. A perspective camera needs it, because its scale changes
                           * with depth; if 0, the scale bar is refused for such a camera */
  int legend; /* non-zero if a legend is drawn; its usual corner is the upper right one. It shows the colours
               * and opacity of each visible volume over the volume's values, the colours of its isosurfaces,
               * or the names of its labels */
  const char *legend_title; /* the title of the first volume's legend, which replaces the volume's name; the
                             * unit of the values is added; may be null. A title that is wider than the
                             * legend is broken into lines */
  hl_axes axes;
  int marks; /* non-zero if the scene's marks (hl_mark) are drawn, with their lengths and angles in the world
              * of the first volume's file. The unit of lengths is world_unit, or else the unit that this file
              * tells; without either, no unit is written. Refused if the scene has no marks */
  const hl_annotation *annotations; /* [annotation_count] */
  size_t annotation_count;
  const char *letter; /* the panel's letter, such as "a", which is drawn in bold at the upper left; may be
                       * null */
  /* The range of values over which all strips of the legend go, the lower end first. If both ends are equal
   * (the default), each strip goes over the range from legend_low to legend_high of its volume
   * (hl_scene_volume). A volume without such a range has a strip over the values that have opacity. */
  double legend_range[2];
  hl_corner scale_bar_corner, legend_corner, arrows_corner; /* default HL_CORNER_FREE */
} hl_overlay;

HL_API void hl_overlay_defaults(hl_overlay *overlay);

/* A picture on the page. */
typedef struct hl_figure_panel {
  /* Borrowed; the picture; if null, the panel shows the overlay alone. On a transparent page, an overlay
   * without an image has the colours that suit the scene's picture, so that somebody can lay the overlay over
   * the picture. */
  const hl_image *image;
  /* Borrowed; a picture of the same view that is not drawn, of any size: the overlay keeps clear of the
   * matter that it shows, and has grounds over it. If null, `image` stands for it. */
  const hl_image *matter;
  const hl_scene *scene;           /* borrowed; the scene that the picture shows, from which the overlay takes
                                    * background, exposure, camera and volumes; if null, the overlay may hold
                                    * only a letter, and annotations whose places are fractions */
  double left, top, width, height; /* the place and size of the panel on the page, in millimetres; left and
                                    * top are measured from the page's upper left corner */
  int frame;                       /* non-zero if a thin line is drawn around the panel, as around an inset */
  hl_overlay overlay;
} hl_figure_panel;

typedef struct hl_figure {
  size_t struct_size;            /* set by hl_figure_defaults() */
  double width, height;          /* the size of the page, in millimetres */
  double pixels_per_inch;        /* the number of pixels per inch in a PNG or TIFF file; default 300 */
  double font_points;            /* size of letters; default 7 */
  const char *font;              /* the name of the texts' font family; default "Sans" */
  double background[3];          /* linear RGB; default white */
  int background_transparent;    /* default 0 */
  const hl_figure_panel *panels; /* borrowed; [panel_count]; later panels are drawn over earlier ones */
  size_t panel_count;
} hl_figure;

/* A page without panels. */
HL_API void hl_figure_defaults(hl_figure *figure);

/* Describes a page that one picture fills: sets the size of the figure, the size of the panel, and
 * figure->panels. width: the page's width in millimetres; if 0, a width is chosen at which letters of 7
 * points are as high as a 36th of the page's width, and at least 9 pixels high. Before the call, figure and
 * panel must have their defaults. */
HL_API void hl_figure_of_picture(const hl_image *image, const hl_scene *scene, double width,
                                 hl_figure *figure, hl_figure_panel *panel);

/* Makes the page higher by the strip that a legend below the pictures needs. The strip begins at the lower
 * edge of the lowest panel. Does nothing if no panel asks for HL_CORNER_BELOW. */
HL_API HL_WARN_UNUSED hl_status hl_figure_add_strip(hl_context *context, hl_figure *figure, hl_error *error);

/* Moves the legend of a panel below all pictures (HL_CORNER_BELOW) if it may lie anywhere (HL_CORNER_FREE)
 * and the picture has no room for all its rows, or at every edge the picture shows matter under a twentieth
 * of the legend. panel: one of figure->panels, with its image. Call hl_figure_add_strip() afterwards. */
HL_API HL_WARN_UNUSED hl_status hl_figure_clear_legend(hl_context *context, const hl_figure *figure,
                                                       hl_figure_panel *panel, hl_error *error);

/* Checks whether everything in a figure can be drawn, before its pictures are made. For this, the page is
 * drawn with an eighth of its pixels along each side, and without the panels' images. Errors: as for
 * hl_figure_draw(). */
HL_API HL_WARN_UNUSED hl_status hl_figure_check(hl_context *context, const hl_figure *figure,
                                                hl_error *error);

/* Draws the figure as pixels. The number of pixels along a side is the side's length in millimetres x
 * pixels_per_inch / 25.4, rounded. If a picture's pixels coincide with the page's pixels, the page has the
 * picture's 8-bit sRGB codes unchanged. *image is owned by the caller. */
HL_API HL_WARN_UNUSED hl_status hl_figure_draw(hl_context *context, const hl_figure *figure, hl_image **image,
                                               hl_error *error);

/* Writes the figure in the format of the path's extension: .pdf, .svg, .png, .tif or .tiff. The file appears
 * whole or not at all. options: only the members scene_json and pixels_per_inch are used, which are stored in
 * PNG and TIFF files. If options is null, no scene is stored, and pixels_per_inch is the figure's. */
HL_API HL_WARN_UNUSED hl_status hl_figure_write(hl_context *context, const hl_figure *figure,
                                                const char *path, const hl_image_write_options *options,
                                                hl_error *error);

/* Makes the bytes of a figure's file in memory. format: "pdf", "svg", "png" or "tif". *bytes: [*length],
 * owned by the caller (hl_bytes_release()). */
HL_API HL_WARN_UNUSED hl_status hl_figure_encode(hl_context *context, const hl_figure *figure,
                                                 const char *format, const hl_image_write_options *options,
                                                 unsigned char **bytes, size_t *length, hl_error *error);

#ifdef __cplusplus
}
#endif
#endif
