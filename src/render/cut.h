/* render/cut.h - describes a cut of a volume, in the form that is tested at samples. */
#ifndef HL_RENDER_CUT_H
#define HL_RENDER_CUT_H

/* A cut's shape (scene/geometry/cut.h). */
typedef struct shade_cut {
  int type, keep_inside;
  float rows[3][4]; /* maps frame space to the shape's own space */
} shade_cut;

#endif
