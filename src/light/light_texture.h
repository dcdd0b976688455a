/* light/light_texture.h - describes the image that a light projects (section 4, fig. 9), ready for look-ups
 * at samples.
 *
 * Every sample is projected onto the screen along its light ray. So the pattern is as sharp as the image,
 * whatever the resolution of the shadow buffer. An image that is finer than the picture is averaged once a
 * frame, to about the size of the picture's pixels.
 *
 * An extended light with soft shadows blurs the image: at a sample, the image is convolved with the scaled
 * shape of the light. For parallel light, the scale is the distance of the sample behind the screen. For a
 * near light, the scale is 1 - Zs / Z, where Zs and Z are the distances of the screen and of the sample from
 * the light (eq. (5) with the screen as occluder). Blurred levels of the image are made once a frame. The
 * variance of each level's blur is twice the variance of the level before. Each sample interpolates between
 * two levels. */
#ifndef HL_LIGHT_LIGHT_TEXTURE_H
#define HL_LIGHT_LIGHT_TEXTURE_H

#include "core/error.h"
#include "light/light_source.h"

/* One blurred level of a light texture: the image, blurred by the light's shape. The level has a border of
 * zeros, because no light passes outside the screen. */
typedef struct texture_level {
  const float *pixels; /* [height][width][3]; in the light texture's memory */
  int width, height;
  float scale[2], shift[2]; /* maps pixels of the image to pixels of the level */
} texture_level;

enum { TEXTURE_LEVELS = 24 };

typedef struct light_texture {
  const float *pixels; /* [height][width][3], linear RGB; the averaged image; null if the light has no
                        * texture */
  int width, height;
  /* maps frame space to (w, w u, w v), where u and v are pixels from the image's top left corner. If w <= 0,
   * the sample's ray does not cross the screen's plane */
  float map[3][4];
  float sharpness[2]; /* along u and v: the edge of a pixel of the image, in pixels of the picture; at least
                       * 1 */
  float beyond[4];    /* for parallel light: maps frame space to the distance behind the screen along the
                       * rays. For near light, the factor w of `map` takes the place of this distance */
  int parallel;
  /* The inverse square of the distance behind the screen at which the blur equals the blur of level 0. For a
   * near light, 1 - Zs / Z takes the place of the distance. At 2^l times this square the blur is the blur of
   * level l, whose variance is 2^l times greater. */
  float first;
  float edge[2];   /* along u and v: the width, in pixels of the image, of a box that has the same variance as
                    * the blur at the distance 1 */
  int level_count; /* number of levels; 0 if the light's extent does not blur the image */
  texture_level level[TEXTURE_LEVELS];
  float *memory; /* owned; the memory of the averaged image and the blurred levels; null if the texture needs
                  * neither the averaged image nor levels */
} light_texture;

/* The content that a light texture falls on, and the size of the picture's pixels at this content; frame
 * space. */
typedef struct texture_use {
  const vec3 *points; /* [point_count]; borrowed; corners of the content, frame space */
  int point_count;
  vec3 content; /* the content's middle; frame space */

  double pixel; /* the edge of a picture's pixel at the content's middle; frame units */
} texture_use;

/* Makes the texture of a light. Release it with hl_light_texture_release(), even after a failure. */
hl_status hl_light_texture_create(hl_context *context, const light_source *source, const texture_use *use,
                                  light_texture *texture, hl_error *error);
void hl_light_texture_release(hl_context *context, light_texture *texture);

#endif
