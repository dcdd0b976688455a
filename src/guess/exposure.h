/* guess/exposure.h - how bright a picture of one volume will be, before it is made. */
#ifndef HL_GUESS_EXPOSURE_H
#define HL_GUESS_EXPOSURE_H

#include <halflight/scene.h>

typedef struct hl_exposure {
  double factor; /* what to multiply all lights by, so that the brightest hundredth of the picture begins at
                    240 of 255 in its brightest channel; from 0.5 to 2, and 1 where nothing is seen */
  double thickness; /* smallest voxel edges from where a surface begins to where it hides what lies behind it:
                       a seventh of the visible surfaces is thinner; infinite where nothing is hidden */
} hl_exposure;

/* Judges a picture of the first volume. left: the fraction of a light with shadows, and in media of the sky,
 * that reaches bright surfaces. empty: a value of the invisible surroundings, to tell which way surfaces
 * face. Fails for lack of memory. */
hl_status hl_scene_exposure(const hl_scene_description *scene, double empty, double left, hl_exposure *result,
                            hl_error *error);

#endif
