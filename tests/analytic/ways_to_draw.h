/* tests/analytic/ways_to_draw.h - the ways to draw a scene of one volume. A volume that is stored in another
 * form must give the same picture by each way. */
#ifndef WAYS_TO_DRAW_H
#define WAYS_TO_DRAW_H

#include "reference_stage.h"

typedef void way_to_draw(stage *set);

typedef struct way {
  const char *name;
  way_to_draw *draw;
} way;

static inline void set_method(stage *set, hl_shadows shadows, hl_soft_method method) {
  set->scene.render.shadows = shadows;
  set->scene.render.soft_method = method;
}

static inline void draw_paper(stage *set) { set_method(set, HL_SHADOWS_SOFT, HL_SOFT_PAPER); }
static inline void draw_cascade(stage *set) { set_method(set, HL_SHADOWS_SOFT, HL_SOFT_CASCADE); }
static inline void draw_sublights(stage *set) { set_method(set, HL_SHADOWS_SOFT, HL_SOFT_SUBLIGHTS); }
static inline void draw_maximum(stage *set) { set->scene.render.compositing = HL_COMPOSITING_MAXIMUM; }

static inline void draw_gradient_opacity(stage *set) {
  static const hl_opacity_point steep[] = {{0, 0}, {0.05, 0.3}, {0.4, 1}};
  set->volumes[0].transfer_function.gradient_opacity = steep;
  set->volumes[0].transfer_function.gradient_opacity_count = 3;
}

static inline void draw_isosurface(stage *set) {
  static const hl_isosurface surface = {.value = 0.6, .opacity = 1, .color = {0.9, 0.5, 0.3}};
  set->volumes[0].iso = &surface;
  set->volumes[0].iso_count = 1;
}

/* Gives a volume an opacity that begins gradually. */
static inline void set_soft_edge(hl_scene_volume *volume) {
  static const hl_opacity_point soft_edge[] = {{0, 0}, {0.35, 0}, {0.6, 0.7}, {1, 0.9}};
  volume->transfer_function.opacity = soft_edge;
  volume->transfer_function.opacity_count = sizeof soft_edge / sizeof *soft_edge;
}

#endif
