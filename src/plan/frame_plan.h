/* plan/frame_plan.h - describes the plan of a frame: everything that is decided before the frame's first
 * sheet, as plain data in frame space.
 *
 * A plan is made once (render/plan_frame.c) and never changes afterwards. A back end (render/backend.h) makes
 * the picture of a plan; the processors and a device read the same plan. A part of a shared picture is the
 * same plan with another share. Data that a plan borrows do not change until the frame ends. */
#ifndef HL_PLAN_FRAME_PLAN_H
#define HL_PLAN_FRAME_PLAN_H

#include <halflight/layers.h>

#include "field/sky_field.h"
#include "grid/kernel.h"
#include "light/phase_table.h"
#include "plan/frame_objects.h"
#include "plan/share.h"
#include "plan/shown_values.h"
#include "plan/slicing.h"
#include "scatter/scatter.h"
#include "shadow/shadow_method.h"

/* The picture of the plan, and the part of this picture that this renderer makes. */
typedef struct plan_picture {
  int width, height;       /* size of the picture in pixels */
  int tiles_x;             /* number of the frame's tiles in a row of tiles */
  size_t tiles;            /* number of the frame's tiles */
  picture_share share;     /* the division of the picture into parts, and the part that this renderer makes */
  const hl_layers *layers; /* borrowed; the layers that are wanted; null if no layer is wanted */
} plan_picture;

/* The volumes of a frame, and the way in which their samples are made. */
typedef struct plan_volumes {
  frame_volume *list; /* owned; [count]; the properties of the volumes */
  grid *grids;        /* owned; [count]; the volumes made ready for sampling */
  /* owned; [count]; in a maximum projection, the values that each visible volume shows; else null */
  float (*shown)[SHOWN_ENTRIES][4];
  int count;
  const kernel *kernel;
  bool splat; /* whether densities are splatted; if not, they are gathered */
} plan_volumes;

/* Light that does not travel from sheet to sheet, because other grids than the sheets hold it. */
typedef struct plan_fields {
  bool scatters;                  /* whether media scatter light more than once */
  const scatter_field *scattered; /* borrowed; the light that media scatter more than once; null if the frame
                                   * has no such light */
  const sky_light *sky;           /* borrowed; the light of the sky; null if the scene has no sky */
  const phase_tables *phases;     /* borrowed; the means of phase functions over wide lights */
} plan_fields;

/* A light of a sweep. */
typedef struct light_plan {
  const light_source *source;
  light_emission *emission; /* owned; the picture on the light's own surface; null if the light has no such
                             * picture */
  light_shadow shadow;      /* the planned shadow, of which a back end makes a copy to work on
                             * (hl_light_shadow_begin) */
  shadow_layouts memory;    /* the memory that the shadow's method takes */
} light_plan;

/* One pass over the sheets. */
typedef struct sweep_plan {
  const sweep_sheets *geometry;
  light_plan *lights;   /* [geometry->light_count]; the lights of this sweep */
  bool adds_even_light; /* whether ambient light, emission, the sky and scattered light are added in this
                         * sweep */
  bool measures;        /* whether depth and normals are measured in this sweep, which then goes front to
                         * back */
} sweep_plan;

typedef struct plan_sweeps {
  sweep_sheets *sheets; /* owned; [count]; the direction and the sheets of each sweep */
  sweep_plan *list;     /* owned; [count]; the plan of each sweep */
  light_plan *lights;   /* owned; [light_count]; the lights of all sweeps; the lights of one sweep follow the
                         * lights of the sweep before */
  int count, light_count;
} plan_sweeps;

typedef struct frame_plan {
  hl_render_settings settings; /* settings of the scene; the texts in the settings are not used */
  plan_picture picture;
  double unit;                 /* the length in the world of one unit of frame space */
  double ambient[HL_CHANNELS]; /* ambient light, which comes from all directions: R, G, B */
  frame frame;                 /* the eye, the lights and the surfaces; the plan owns the arrays of the
                                * frame */
  frame_light *lights; /* owned; [light_count]; the `row` of a light_source is an index into this list */
  int light_count;
  frame_mesh *meshes; /* owned; [mesh_count]; the properties of the meshes */
  int mesh_count;
  plan_volumes volumes;
  plan_fields fields;
  plan_sweeps sweeps;
  int channels; /* number of channels of light attenuation: 1 or 3 */
  vec3 *seen;   /* owned; [seen_count]; corners of the content that the eye sees */
  int seen_count;
} frame_plan;

/* Allocates the arrays of a plan of zeros for a scene in frame space, and copies the scene's picture size and
 * settings, lights and meshes. Release the plan after a failure, too. */
hl_status hl_frame_plan_create(hl_context *context, const framed_scene *framed, frame_plan *plan,
                               hl_error *error);
void hl_frame_plan_release(hl_context *context, frame_plan *plan);

/* Chooses the sweeps. Refuses a frame for which no direction of sheets works. Call this function after the
 * frame's eye and lights are set up. */
hl_status hl_plan_sweeps(hl_context *context, frame_plan *plan, hl_error *error);

/* Returns whether some wanted layer must be measured: depth, normals or objects. If so, some sweep must go
 * from front to back. */
bool hl_layers_measure(const hl_layers *wanted);

/* Plans the shadows of all lights. Planning shadows is the last step of planning; the picture must have been
 * divided into parts before. */
hl_status hl_plan_lights(hl_context *context, frame_plan *plan, hl_error *error);

/* ---- the tiles that light reaches ---- */

/* Returns whether a slab lies beyond a light, on the side to which the light's rays travel in this sweep. */
static inline bool hl_is_beyond(const sheet_stack *sheets, const light_source *source, int sheet) {
  return source->parallel || hl_sheet_height(sheets, sheet - 1) >= vec3_dot(sheets->normal, source->position);
}

/* The first sheet at which a light's buffer may change as a whole. */
static inline int hl_first_beyond(const sheet_stack *sheets, const light_source *source) {
  int sheet = 1;
  while (sheet < sheets->count && !hl_is_beyond(sheets, source, sheet)) sheet++;
  return sheet;
}

/* Returns whether a light's shadows reach a slab. */
static inline bool hl_is_reached(const sheet_stack *sheets, const light_shadow *shadow, int sheet) {
  return hl_is_beyond(sheets, shadow->setup.source, sheet + 1 - shadow->method->first_slab);
}

#endif
