/* light/light_screen.h - the image that a light projects (section 4, fig. 9), ready for lookups at samples.
 *
 * Every sample is projected onto the screen along its light ray: the pattern is as sharp as its image, whatever the shadow
 * buffer's resolution. An image finer than the picture is averaged down to the picture's pixels once a frame. */
#ifndef HL_LIGHT_LIGHT_SCREEN_H
#define HL_LIGHT_LIGHT_SCREEN_H

#include "core/error.h"
#include "light/light_source.h"

typedef struct light_screen {
  const float *pixels; /* [height][width][3], linear RGB; null: the light has no texture */
  int width, height;
  float map[3][4];     /* frame space -> (w, w u, w v): u, v in pixels from the image's top left corner; w <= 0: the ray
                          does not pass the screen's plane */
  float sharpness[2];  /* along u and v: pixels of the picture that one of the image covers, at least 1 */
} light_screen;

/* pixel: edge of a picture's pixel at content, the middle of what is lit; frame units. *averaged: owned by the caller, null
 * where the image is used as it is. */
hl_status hl_light_screen_create(hl_context *context, const light_source *source, vec3 content, double pixel,
                                 light_screen *screen, float **averaged, hl_error *error);

#endif
