/* render/frame.h - the geometry of one frame: where the eye, the lights and the sheets are.
 *
 * Frame space is the world moved to the middle of the volumes and measured in units of about their smallest
 * voxel edge (framed_scene). */
#ifndef HL_RENDER_FRAME_H
#define HL_RENDER_FRAME_H

#include "core/error.h"
#include "light/light_source.h"
#include "render/slab.h"
#include "scene/scene.h"
#include "surface/surface_tree.h"
#include "view/occupancy.h"

enum { FRAME_LIGHTS = MAXIMUM_SWEEP_LIGHTS, CONTENT_POINTS = 64 };

/* One pass over the sheets, with the lights that one slicing direction serves. */
typedef struct frame_sweep {
  sheet_stack sheets;
  bool back_to_front;      /* the eye meets the last sheet first; light always travels with rising sheets */
  bool of_sectors;         /* the lights are sectors of lights, and the slicing direction is theirs */
  int light[FRAME_LIGHTS]; /* indices into frame lights */
  int light_count;
} frame_sweep;

typedef struct frame {
  int width, height; /* pixels: those of the picture times oversampling */
  int oversampling;  /* a pixel of the picture is the mean of oversampling x oversampling pixels of the
                      * frame */
  view eye;
  vec3 eye_direction;  /* e: unit, from the eye towards the content */
  vec3 middle;         /* of the content */
  double pixel;        /* edge of an image pixel where the content is nearest, frame units */
  double middle_pixel; /* edge of an image pixel at the content's middle, frame units */
  double voxel;        /* the smallest edge of a voxel, frame units */
  double spacing;      /* ds, frame units */
  vec3 *points;        /* corners of the content of all grids; owned by the caller; [8 * grids] */
  int point_count;
  light_sectors sectors; /* of lights within the content */
  light_source *lights;  /* [light_count]; owned by the caller; sectors of a light follow each other */
  int light_count;
  const scene_order *order;    /* of the scene's lists; borrowed */
  const surfaces *surfaces;    /* of the scene's meshes; null: none */
  const surface_tree *contact; /* of what shadow buffers leave light behind (contact.h) */
  const int *mesh_objects;     /* [meshes]; their numbers in the layer of objects */
} frame;

/* The eye's view in width x height pixels. */
hl_status hl_frame_eye(const hl_camera *camera, int width, int height, view *eye, hl_error *error);

/* Sets the frame's size, oversampling, eye and middle. The frame's points and voxel must be set. */
hl_status hl_frame_set_up_eye(frame *frame, const hl_scene_description *scene, hl_error *error);

/* After the eye. Brings the lights to frame space, and cuts lights that no sheets serve into sectors. Narrow
 * spot lights and lights with a texture shine in one direction and are never cut. The frame's lights need
 * room for LIGHT_SECTORS each. */
void hl_frame_set_up_lights(frame *frame, const hl_scene_description *scene);

/* Whether any picture of a volume or a mesh depends on arriving light: flat colours and maximum projections
 * do not. */
bool hl_is_lit(const hl_scene_description *scene);

static inline bool hl_is_maximum(const hl_scene_description *scene) {
  return scene->render.compositing == HL_COMPOSITING_MAXIMUM;
}

/* Corners of the box around a grid's relevant bricks, of which there is one at least. */
void hl_frame_content(const grid *grid, vec3 corners[8]);

/* Groups lights into sweeps and slices each (section 3.1 and fig. 3); sweeps: room for light_count + 1.
 * Returns how many there are: at least one. */
int hl_frame_sweeps(const frame *frame, const hl_render_settings *settings, frame_sweep *sweeps);

/* One more sweep, without lights, image-aligned: front to back for the eye. */
void hl_frame_add_eye_sweep(const frame *frame, frame_sweep *sweeps, int *count);

/* False where the light's rays do not cross the sheets that would serve it and the eye: it must be cut into
 * sectors. */
bool hl_frame_serves(const frame *frame, const hl_render_settings *settings, const light_source *source);

/* Refuses a sweep of too many sheets, or whose sheets some ray of the eye or a shadowing light does not
 * cross. */
hl_status hl_frame_check_sweeps(const frame *frame, const frame_sweep *sweeps, int count, hl_error *error);

/* Corners of the part of the content that the eye sees: what a shadow buffer must cover. points: room for
 * CONTENT_POINTS a grid. */
int hl_frame_visible_points(const frame *frame, vec3 *points);

/* ---- A scene in frame space: moved to the middle of its volumes, measured in its smallest voxels ---- */

/* Its lights, volumes and meshes stand in the order of frames (scene/order.h). */
typedef struct framed_scene {
  hl_scene_description
      scene; /* in frame space; voxels, images and texts are borrowed from the scene in the world */
  hl_scene_volume *volumes;    /* owned; [volume_count] */
  hl_light *lights;            /* owned; [light_count] */
  hl_scene_mesh *meshes;       /* owned; [mesh_count], with room for the volumes' isosurfaces */
  int *mesh_objects;           /* owned; likewise; their numbers in the layer of objects */
  const scene_order *order;    /* borrowed; where in the world's lists volumes, lights and meshes stand */
  double (*vertices)[3];       /* owned; of all polygons */
  hl_opacity_point *gradients; /* owned; of all volumes' gradient opacity */
  hl_cut *cuts;                /* owned; those of the volumes */
  double unit;                 /* world length of 1 in frame space: the smallest voxel edge is from 1 to 2 */
} framed_scene;

hl_status hl_framed_scene_create(hl_context *context, const hl_scene_description *scene,
                                 const scene_order *order, framed_scene *framed, hl_error *error);
void hl_framed_scene_release(hl_context *context, framed_scene *framed);

#endif
