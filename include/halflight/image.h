/* halflight/image.h - pictures: linear premultiplied RGBA in float, top row first. */
#ifndef HALFLIGHT_IMAGE_H
#define HALFLIGHT_IMAGE_H

#include "context.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct hl_image hl_image;

/* Makes a picture of width x height pixels, which are all zero. *image is owned by the caller. */
HL_API HL_WARN_UNUSED hl_status hl_image_create(hl_context *context, int width, int height, hl_image **image,
                                                hl_error *error);
HL_API void hl_image_destroy(hl_image *image); /* null is allowed */

HL_API int hl_image_width(const hl_image *image);
HL_API int hl_image_height(const hl_image *image);
/* The pixels of a picture, [height][width][4]: linear premultiplied R, G, B, A; valid as long as the image.
 */
HL_API float *hl_image_pixels(hl_image *image);
HL_API const float *hl_image_pixels_const(const hl_image *image);

/* Adds a layer beside the picture's RGBA; its values are all zero. name: letters, digits and '_'; no other
 * layer may have it; channels: one letter each, "RGB", "XYZ" or "Z". *values: [height][width][channels],
 * owned by the image. */
HL_API HL_WARN_UNUSED hl_status hl_image_add_layer(hl_image *image, const char *name, const char *channels,
                                                   float **values, hl_error *error);

/* How a PNG shows light that is brighter than white. */
typedef enum hl_tone {
  HL_TONE_CLIP = 0,  /* each channel is cut at 1 */
  HL_TONE_FILMIC = 1 /* a curve without clipping: where a colour's brightest channel is above 0.6 of white,
                      * the curve lets this channel approach 1 ever more slowly. The other channels keep their
                      * ratio to it, so that hues stay. Darker colours are unchanged */
} hl_tone;

typedef struct hl_image_write_options {
  size_t struct_size;         /* set by hl_image_write_options_defaults() */
  int png_depth;              /* bits of a channel in PNG and TIFF files: 8 or 16 */
  double background[3];       /* linear RGB; PNG and TIFF only */
  int background_transparent; /* PNG and TIFF keep alpha, unassociated */
  const char *scene_json;     /* the scene's JSON, stored in a PNG as the text chunk "halflight:scene"; may
                               * be null */
  const char *field_errors;   /* a JSON array that says how much the fields of the scene's volumes differ from
                               * their files (hl_volume_get_field_error()); each entry has the volume's
                               * number. A PNG that stores scene_json stores it, too, as the text chunk
                               * "halflight:field_errors". hl_scene_write_options() sets it; may be null */
  double exposure;            /* exposure in stops, -32 to 32; PNG only: the picture's light is multiplied by
                               * 2^exposure, the background is not */
  hl_tone tone;           /* PNG only: how light that is brighter than white is shown, after the exposure; the
                           * background keeps its colour */
  double pixels_per_inch; /* the number of pixels per inch that a PNG or TIFF states as its physical size,
                           * 1 to 100000; 0 (default): none */
} hl_image_write_options;

HL_API void hl_image_write_options_defaults(hl_image_write_options *options);

/* Writes a picture in the format of the path's extension: .png, .tif or .tiff (sRGB, composited over the
 * background), .exr (linear float) or .npy (float32, height x width x 4). The file is written to a temporary
 * name beside the path and then renamed, so that nobody sees half a file. In an .exr, layers become channels
 * "name.R" and so on. Beside an .npy, each layer becomes a file of its own, "picture-name.npy" (height x
 * width x channels, or height x width), which is written before the picture. An image with layers is refused
 * for a .png or .tif. A build without libtiff refuses .tif. options may be null. */
HL_API HL_WARN_UNUSED hl_status hl_image_write(hl_context *context, const hl_image *image, const char *path,
                                               const hl_image_write_options *options, hl_error *error);

/* Makes the bytes of a picture's file in memory. format: "png", "tif", "exr" or "npy". *bytes: [*length],
 * owned by the caller (hl_bytes_release()). Layers fit into "exr" alone. */
HL_API HL_WARN_UNUSED hl_status hl_image_encode(hl_context *context, const hl_image *image,
                                                const char *format, const hl_image_write_options *options,
                                                unsigned char **bytes, size_t *length, hl_error *error);
HL_API void hl_bytes_release(hl_context *context, unsigned char *bytes); /* null is allowed */

/* Converts the picture to 8-bit sRGB, for windows and toolkits: bytes R, G, B, A of each pixel, top row
 * first. The codes are those of a .png with png_depth 8. Pixels over a background have A = 255. With
 * background_transparent, colours are not multiplied by alpha. bytes: the caller's, [height][row_stride], of
 * which 4 x width are used in each row; row_stride in bytes, at least 4 x width. options null: the picture is
 * shown over black. */
HL_API HL_WARN_UNUSED hl_status hl_image_to_srgb8(const hl_image *image,
                                                  const hl_image_write_options *options, uint8_t *bytes,
                                                  size_t row_stride, hl_error *error);

/* Reads .png (sRGB decoded), .exr (R, G, B, A; missing A is 1), .npy (float32, height x width x 1, 3 or 4)
 * and .hdr (Radiance's RGBE; A is 1). */
HL_API HL_WARN_UNUSED hl_status hl_image_read(hl_context *context, const char *path, hl_image **image,
                                              hl_error *error);

/* What the file of a picture says of itself. */
typedef struct hl_image_about {
  size_t struct_size;     /* set by the caller */
  const char *format;     /* "PNG", "OpenEXR", "NPY" or "Radiance HDR"; static */
  uint64_t width, height; /* pixels */
  int channels, bits; /* the numbers of a pixel, and the bits of each; a palette's colours count as numbers
                       * of 8 bits; of OpenEXR the bits of the widest channel */
  int has_scene;      /* non-zero: hl_image_find_scene() finds a scene */
} hl_image_about;

/* Finds what the file of a picture says of itself, without its pixels. name: the file's name in errors.
 * bytes: [byte_count], the whole file. HL_ERROR_UNSUPPORTED for bytes of no known format of pictures, and for
 * a format that this build does not read. */
HL_API HL_WARN_UNUSED hl_status hl_image_get_about(const char *name, const void *bytes, size_t byte_count,
                                                   hl_image_about *about, hl_error *error);

/* Finds the JSON array of hl_image_write_options.field_errors that a PNG carries. *text: as for
 * hl_image_find_scene(); null where it carries none. */
HL_API HL_WARN_UNUSED hl_status hl_image_find_field_errors(hl_context *context, const char *name,
                                                           const void *bytes, size_t byte_count, char **text,
                                                           hl_error *error);

/* Finds the scene that a PNG carries (hl_image_write_options.scene_json). *text: null-terminated, for
 * hl_scene_from_json(); free with hl_text_release(). bytes: [byte_count], the whole file. name: the file's
 * name in errors. */
HL_API HL_WARN_UNUSED hl_status hl_image_find_scene(hl_context *context, const char *name, const void *bytes,
                                                    size_t byte_count, char **text, hl_error *error);

/* How much picture b differs from picture a. All numbers are of linear premultiplied R, G, B and A. */
typedef struct hl_image_difference {
  size_t struct_size;     /* set by the caller */
  double rmse;            /* root mean square over all pixels and channels */
  double maximum;         /* greatest absolute difference */
  double percentile_99_9; /* each pixel has a greatest absolute difference of its channels; 99.9 % of the
                           * pixels do not exceed this value */
  double mean_signed[4];  /* mean of b - a per channel */
  double rmse_channel[4];
  uint64_t differing_pixels; /* pixels that are not equal */
  int maximum_x, maximum_y;  /* where the greatest difference is */
} hl_image_difference;

HL_API HL_WARN_UNUSED hl_status hl_image_compare(const hl_image *a, const hl_image *b,
                                                 hl_image_difference *difference, hl_error *error);

#ifdef __cplusplus
}
#endif
#endif
