/* compose/sky.c - applies the option "sky" COLOR|GRADIENT|IMAGE, which gives light from all directions. */
#include <halflight/image.h>
#include <string.h>

#include "compose/composer.h"
#include "core/memory.h"
#include "text/color.h"
#include "text/plain.h"

enum { COLOR_BYTES = 64, GRADIENT_COLORS = 3 };

static bool has_extension(const char *path, const char *extension) {
  size_t length = strlen(path), tail = strlen(extension);
  return length > tail && hl_plain_equal(path + length - tail, extension);
}

static bool names_image(const char *text) {
  static const char *const extensions[] = {".exr", ".hdr", ".pic", ".png", ".npy"};
  for (size_t n = 0; n < sizeof extensions / sizeof *extensions; n++)
    if (has_extension(text, extensions[n])) return true;
  return false;
}

/* Reads ZENITH:HORIZON[:GROUND] or one colour. Returns the number of colours; 0 if the text is something
 * else. */
static int read_colors(const char *text, double colors[GRADIENT_COLORS][3]) {
  const hl_setting *setting = hl_setting_find(HL_SETTINGS_SKY, "color");
  for (int count = 0; count < GRADIENT_COLORS; count++) {
    char color[COLOR_BYTES];
    size_t length = strcspn(text, ":");
    if (length >= sizeof color) return 0;
    memcpy(color, text, length);
    color[length] = '\0';
    if (!hl_parse_color(color, setting->low, setting->high, colors[count])) return 0;
    if (text[length] == '\0') return count + 1;
    text += length + 1;
  }
  return 0;
}

hl_status hl_check_sky(const hl_asked *sky, hl_error *error) {
  double colors[GRADIENT_COLORS][3];
  if (!sky->given || names_image(sky->text) || read_colors(sky->text, colors) > 0) return HL_OK;
  return hl_fail(
      error, HL_ERROR_ARGUMENT,
      "--sky: '%.300s' is not a colour (a number, linear R,G,B, #rrggbb or a CSS name), a gradient "
      "ZENITH:HORIZON[:GROUND] of colours, or an image's file (.exr, .hdr, .png, .npy)",
      sky->text);
}

/* The colours of an image without alpha. Because the image's colours are premultiplied by alpha, the result
 * is the image over black. */
static float *take_pixels(hl_context *context, const hl_image *image) {
  size_t count = (size_t)hl_image_width(image) * (size_t)hl_image_height(image);
  const float *from = hl_image_pixels_const(image);
  float *pixels = hl_allocate(context, count, 3 * sizeof *pixels);
  for (size_t i = 0; i < count && pixels != NULL; i++)
    for (size_t c = 0; c < 3; c++) pixels[3 * i + c] = from[4 * i + c];
  return pixels;
}

static hl_status load(const hl_composer *composer, const char *path, hl_sky *sky, float **pixels) {
  hl_image *image = NULL;
  hl_status status = hl_image_read(composer->context, path, &image, composer->error);
  if (status == HL_OK && (*pixels = take_pixels(composer->context, image)) == NULL)
    status = hl_fail(composer->error, HL_ERROR_MEMORY, "out of memory for '%.200s'", path);
  if (status == HL_OK) {
    sky->type = HL_SKY_IMAGE;
    sky->file = path;
    sky->pixels = *pixels;
    sky->width = hl_image_width(image);
    sky->height = hl_image_height(image);
  }
  hl_image_destroy(image);
  return status;
}

/* Sets the sky's colours: a single colour makes an even sky, and black makes no sky. */
static void set_colors(const char *text, hl_sky *sky) {
  double colors[GRADIENT_COLORS][3];
  int count = read_colors(text, colors);
  if (count == 1) {
    memcpy(sky->color, colors[0], sizeof sky->color);
    bool shines = colors[0][0] > 0 || colors[0][1] > 0 || colors[0][2] > 0;
    sky->type = shines ? HL_SKY_UNIFORM : HL_SKY_NONE;
    return;
  }
  sky->type = HL_SKY_GRADIENT;
  memcpy(sky->zenith, colors[0], sizeof sky->zenith);
  memcpy(sky->horizon, colors[1], sizeof sky->horizon);
  if (count == 3) memcpy(sky->ground, colors[2], sizeof sky->ground);
}

hl_status hl_compose_sky(const hl_composer *composer, hl_scene_description *description, float **pixels) {
  const hl_asked *asked = &composer->asked[HL_ASK_SKY];
  hl_scene_description plain;
  if (!asked->given) return HL_OK;
  hl_scene_description_defaults(&plain);
  hl_sky made = plain.sky;
  const hl_sky *before = &description->sky;
  memcpy(made.up, before->type != HL_SKY_NONE ? before->up : description->camera.up, sizeof made.up);
  hl_status status = HL_OK;
  if (names_image(asked->text)) status = load(composer, asked->text, &made, pixels);
  else set_colors(asked->text, &made);
  if (made.type == HL_SKY_NONE) made = plain.sky;
  if (status == HL_OK) description->sky = made;
  return status;
}
