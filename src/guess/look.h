/* guess/look.h - a look: a transfer function, and the light and shading that go with it. */
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
  double left;           /* the part of the light of shadow-casting lights that reaches surfaces, for
                          * hl_scene_exposure(); 0: exposure leaves the lights as they are */
  bool on_black;         /* the background of a bare volume is black */
  const char *next;      /* the style that is next best for such data */
} hl_look;

#endif
