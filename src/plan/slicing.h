/* plan/slicing.h - divides a frame into sweeps: chooses the direction of each sweep's sheets, and the lights
 * that share the sweep. */
#ifndef HL_PLAN_SLICING_H
#define HL_PLAN_SLICING_H

#include "plan/frame.h"
#include "plan/framed_scene.h"
#include "view/occupancy.h"

/* One pass over the sheets, with the lights for which one slicing direction is used. */
typedef struct sweep_sheets {
  sheet_stack sheets;
  bool back_to_front; /* whether the eye's rays meet the sheets from the last to the first. The lights' rays
                       * always meet the sheets from the first to the last */
  /* whether the sweep's lights are sectors of lights; the slicing direction is then the direction of these
   * sectors */
  bool of_sectors;
  int light[FRAME_LIGHTS]; /* [light_count]; indices into the frame's lights */
  int light_count;
} sweep_sheets;

/* Brings the lights to frame space. A light for which no sheets suit the eye and all its rays is divided into
 * sectors. Call this function after the eye is set up. Narrow spot lights and lights with a texture shine in
 * one direction and are never divided. The array of the frame's lights needs room for LIGHT_SECTORS sources
 * for each light. */
void hl_frame_set_up_lights(frame *frame, const framed_scene *framed);

/* Groups lights into sweeps, and chooses the sheets of each sweep (section 3.1 and fig. 3). sweeps: room for
 * light_count + 1. Returns the number of sweeps, which is at least one. */
int hl_frame_sweeps(const frame *frame, const hl_render_settings *settings, sweep_sheets *sweeps);

/* Adds a sweep without lights, whose sheets are parallel to the picture and go front to back for the eye. */
void hl_frame_add_eye_sweep(const frame *frame, sweep_sheets *sweeps, int *count);

/* Refuses a sweep that has too many sheets, and a sweep whose sheets are not crossed by all rays of the eye
 * and of the lights that cast shadows. */
hl_status hl_frame_check_sweeps(const frame *frame, const sweep_sheets *sweeps, int count, hl_error *error);

#endif
