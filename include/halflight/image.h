/* halflight/image.h - pictures in memory and as files. A pixel has linear premultiplied R, G, B and A in
 * float, and the top row comes first. */
#ifndef HALFLIGHT_IMAGE_H
#define HALFLIGHT_IMAGE_H

#include "context.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct hl_image hl_image;

/* Makes a picture of width x height pixels, all of which are zero. *image is owned by the caller, who
 * releases it. */
HL_API HL_WARN_UNUSED hl_status hl_image_create(hl_context *context, int width, int height, hl_image **image,
                                                hl_error *error);
HL_API void hl_image_destroy(hl_image *image); /* null is allowed */

HL_API int hl_image_width(const hl_image *image);
HL_API int hl_image_height(const hl_image *image);
/* Returns the pixels of a picture, [height][width][4]: linear premultiplied R, G, B, A. The array belongs to
 * the image. */
HL_API float *hl_image_pixels(hl_image *image);
HL_API const float *hl_image_pixels_const(const hl_image *image);

/* Adds a layer beside the picture's RGBA; its values are all zero. name: letters, digits and '_'; each layer
 * of an image has a name of its own. channels: a text with one letter for each channel, "RGB", "XYZ" or "Z".
 * *values: [height][width][channels], owned by the image. */
HL_API HL_WARN_UNUSED hl_status hl_image_add_layer(hl_image *image, const char *name, const char *channels,
                                                   float **values, hl_error *error);

/* The ways in which a PNG shows light that is brighter than white. */
typedef enum hl_tone {
  HL_TONE_CLIP = 0,  /* each channel above 1 is set to 1 */
  HL_TONE_FILMIC = 1 /* a curve without clipping. A colour whose brightest channel is at most 0.6 of white is
                      * not changed. Above 0.6, the curve lets the brightest channel approach 1 ever more
                      * slowly; the other channels keep their ratios to it, so that the hue stays */
} hl_tone;

/* Options of writing a picture's file. */
typedef struct hl_image_write_options {
  size_t struct_size;         /* set by hl_image_write_options_defaults() */
  int png_depth;              /* number of bits of each channel in PNG and TIFF files: 8 or 16 */
  double background[3];       /* the background over which the picture is composited, linear RGB; only for PNG
                               * and TIFF */
  int background_transparent; /* non-zero if PNG and TIFF files keep alpha; their colours are then not
                               * multiplied by alpha */
  const char *scene_json;     /* the scene's JSON, which a PNG stores as the text chunk "halflight:scene"; may
                               * be null */
  const char *field_errors;   /* a JSON array that says how much the fields of the scene's volumes differ from
                               * their files (hl_volume_get_field_error()); each entry has the volume's
                               * number. A PNG that stores scene_json also stores this array, as the text
                               * chunk "halflight:field_errors". hl_scene_write_options() sets it; may be
                               * null */
  double exposure;            /* exposure in stops, -32 to 32; only for PNG: the picture's light is multiplied
                               * by 2^exposure, but the background is not */
  hl_tone tone;           /* only for PNG: the way in which light is shown that is brighter than white after
                           * the exposure; the background keeps its colour */
  double pixels_per_inch; /* the number of pixels per inch that a PNG or TIFF file states, 1 to 100000; 0
                           * (default): the file states none */
} hl_image_write_options;

HL_API void hl_image_write_options_defaults(hl_image_write_options *options);

/* Writes a picture in the format of the path's extension: .png, .tif or .tiff (sRGB, composited over the
 * background), .exr (linear float) or .npy (float32, height x width x 4). The file is first written under a
 * temporary name beside the path and then renamed, so that nobody sees half a file. In an .exr, the channels
 * of a layer are named "name.R" and so on. Beside an .npy, each layer is written to a file of its own,
 * "picture-name.npy" (height x width x channels, or height x width), which is written before the picture. An
 * image with layers is refused for a .png or .tif. A build without libtiff refuses .tif. options may be
 * null. */
HL_API HL_WARN_UNUSED hl_status hl_image_write(hl_context *context, const hl_image *image, const char *path,
                                               const hl_image_write_options *options, hl_error *error);

/* Makes the bytes of a picture's file in memory. format: "png", "tif", "exr" or "npy". *bytes: [*length],
 * owned by the caller (hl_bytes_release()). Only "exr" can hold layers. */
HL_API HL_WARN_UNUSED hl_status hl_image_encode(hl_context *context, const hl_image *image,
                                                const char *format, const hl_image_write_options *options,
                                                unsigned char **bytes, size_t *length, hl_error *error);
HL_API void hl_bytes_release(hl_context *context, unsigned char *bytes); /* null is allowed */

/* Converts the picture to 8-bit sRGB, for windows and toolkits: bytes R, G, B, A of each pixel, top row
 * first. The codes are the same as in a .png file with png_depth 8. Pixels that are composited over a
 * background have A = 255. With options->background_transparent, alpha is kept, and colours are not
 * multiplied by alpha. bytes: the caller's, [height][row_stride], of which 4 x width are used in each row;
 * row_stride in bytes, at least 4 x width. If options is null, the picture is shown over black. */
HL_API HL_WARN_UNUSED hl_status hl_image_to_srgb8(const hl_image *image,
                                                  const hl_image_write_options *options, uint8_t *bytes,
                                                  size_t row_stride, hl_error *error);

/* Reads the picture of a .png or .tif (decoded from sRGB; of a .tif the first page, in 8 or 16 bits), .exr
 * (R, G, B, A; a missing A is 1), .npy (float32, height x width x 1, 3 or 4) or .hdr file (Radiance's RGBE; A
 * is 1). *image is owned by the caller, who releases it. */
HL_API HL_WARN_UNUSED hl_status hl_image_read(hl_context *context, const char *path, hl_image **image,
                                              hl_error *error);

enum { HL_IMAGE_LAYERS_TEXT = 2000 };

/* Facts that a picture's file states about the picture. */
typedef struct hl_image_about {
  size_t struct_size;     /* set by the caller */
  const char *format;     /* "PNG", "TIFF", "OpenEXR", "NPY" or "Radiance HDR"; static */
  uint64_t width, height; /* pixels */
  int channels, bits;     /* the number of values of a pixel, and the bits of each value. A palette's colours
                           * count as values of 8 bits; for OpenEXR, the bits are the bits of the widest
                           * channel */
  int has_scene;          /* non-zero if the file carries a scene, which hl_image_find_scene() finds */
  char layers[HL_IMAGE_LAYERS_TEXT]; /* the names of an OpenEXR file's layers, with ", " between them:
                                      * channels such as "depth", and of channels such as "key.R" the part
                                      * before the last point. R, G, B, A and Y are no layers. Names for which
                                      * there is no room are left out, and "..." ends the text */
} hl_image_about;

/* Finds facts about a picture from the bytes of its file, without its pixels. name: the file's name in
 * errors. bytes: [byte_count], the whole file. HL_ERROR_UNSUPPORTED: the bytes have no known format of
 * pictures, or a format that this build does not read. */
HL_API HL_WARN_UNUSED hl_status hl_image_get_about(const char *name, const void *bytes, size_t byte_count,
                                                   hl_image_about *about, hl_error *error);

/* Finds the JSON array of hl_image_write_options.field_errors that a PNG carries. *text: null-terminated;
 * free with hl_text_release(); null if the PNG carries no such array. The other arguments are the same as for
 * hl_image_find_scene(). */
HL_API HL_WARN_UNUSED hl_status hl_image_find_field_errors(hl_context *context, const char *name,
                                                           const void *bytes, size_t byte_count, char **text,
                                                           hl_error *error);

/* Finds the scene that a PNG carries (hl_image_write_options.scene_json). *text: null-terminated, for
 * hl_scene_from_json(); free with hl_text_release(). bytes: [byte_count], the whole file. name: the file's
 * name in errors. */
HL_API HL_WARN_UNUSED hl_status hl_image_find_scene(hl_context *context, const char *name, const void *bytes,
                                                    size_t byte_count, char **text, hl_error *error);

/* The differences of picture b from picture a. All numbers are differences of linear premultiplied R, G, B
 * and A. */
typedef struct hl_image_difference {
  size_t struct_size;     /* set by the caller */
  double rmse;            /* root of the mean square difference over all pixels and channels */
  double maximum;         /* greatest absolute difference */
  double percentile_99_9; /* the value that the greatest absolute difference of a pixel's channels does not
                           * exceed in 99.9 % of the pixels */
  double mean_signed[4];  /* the mean of b - a over all pixels, for each channel */
  double rmse_channel[4];
  uint64_t differing_pixels; /* number of pixels that are not equal in a and b */
  int maximum_x, maximum_y;  /* the pixel with the greatest difference */
} hl_image_difference;

HL_API HL_WARN_UNUSED hl_status hl_image_compare(const hl_image *a, const hl_image *b,
                                                 hl_image_difference *difference, hl_error *error);

#ifdef __cplusplus
}
#endif
#endif
