/* guess/look.h - describes a look: a transfer function, and the light and shading that go with it. */
#ifndef HL_GUESS_LOOK_H
#define HL_GUESS_LOOK_H

#include "guess/function_writer.h"

typedef struct hl_look {
  const char *name;                     /* the kind of data, in words */
  void (*write)(hl_function_writer *w); /* writes the transfer function */
  hl_shading shading;
  hl_kernel kernel;
  double key, fill, sky; /* intensities of the light with shadows, of the light without shadows, and of the
                          * sky */
  double left;      /* for hl_scene_exposure(): the light of the sky, and of lights with shadows, that reaches
                     * media in spite of shadows, as a fraction; 0 if the lights' strengths are not scaled by
                     * an exposure */
  bool on_black;    /* whether a bare volume gets a black background */
  const char *next; /* the name of the style to try next for such data */
  bool aside;       /* whether the key light comes from the side, for media */
  bool glossy;      /* whether surfaces have sharp reflections, as glass has */
} hl_look;

#endif
