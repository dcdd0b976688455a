/* guess/exposure.h - how bright a picture of one volume will be, before it is made. */
#ifndef HL_GUESS_EXPOSURE_H
#define HL_GUESS_EXPOSURE_H

#include <halflight/scene.h>

/* The factor for all lights that makes the brightest hundredth of a picture of the first volume 240 of 255 in
 * its brightest channel; within [0.5, 2]; 1 where nothing is seen. What is brightest is in nothing's shadow
 * but its own rim's: left is the part, 0 to 1, of a light with shadows that gets through to where matter is
 * seen. empty: a value of the volume that is not seen, towards which its surfaces look. Fails for lack of
 * memory. */
hl_status hl_scene_exposure(const hl_scene_description *scene, double empty, double left, double *factor,
                            hl_error *error);

#endif
