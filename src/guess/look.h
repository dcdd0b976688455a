/* guess/look.h - describes a look: a transfer function, and the light and shading that go with it. */
#ifndef HL_GUESS_LOOK_H
#define HL_GUESS_LOOK_H

#include "guess/function_writer.h"

/* The lights of a look. Where an exposure scales them, only their ratios count. */
typedef struct hl_look_light {
  double key, fill, sky; /* intensities of the light with shadows, of the light without shadows, and of the
                          * sky */
  bool aside;            /* whether the key light comes from the side, for media */
} hl_look_light;

/* The light of opaque surfaces, of matter that is seen through, and of media without surfaces. All looks that
 * show matter in one of these three ways have the same light, whether the data or the user chose the look. */
#define HL_LIGHT_OF_SURFACES \
  { 1.45, 0.06, 0.50, false }
#define HL_LIGHT_OF_SHELLS \
  { 1.40, 0.20, 0.45, false }
#define HL_LIGHT_OF_MEDIA \
  { 1.45, 0, 0.36, true }

typedef struct hl_look {
  const char *name;                     /* the kind of data, in words */
  void (*write)(hl_function_writer *w); /* writes the transfer function */
  hl_shading shading;
  hl_kernel kernel;
  hl_look_light light;
  double left;      /* for hl_scene_exposure(): the light of the sky, and of lights with shadows, that reaches
                     * media in spite of shadows, as a fraction; 0 if the lights' strengths are not scaled by
                     * an exposure */
  bool on_black;    /* whether a bare volume gets a black background */
  const char *next; /* the name of the style to try next for such data */
  bool glossy;      /* whether surfaces have sharp reflections, as glass has */
  const char *style; /* the name of the style that is this look; null if none is */
} hl_look;

#endif
