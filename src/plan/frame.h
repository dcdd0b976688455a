/* plan/frame.h - describes the geometry of one frame in frame space (framed_scene.h): the positions of the
 * eye, the lights and the content. */
#ifndef HL_PLAN_FRAME_H
#define HL_PLAN_FRAME_H

#include "core/error.h"
#include "grid/grid.h"
#include "light/light_source.h"
#include "scene/scene.h"
#include "surface/surface_tree.h"
#include "view/view.h"

enum { FRAME_LIGHTS = MAXIMUM_SWEEP_LIGHTS, CONTENT_POINTS = 64 };

/* The content of the picture: volumes and meshes. */
typedef struct frame_content {
  vec3 *points; /* corners of the boxes around the volumes' visible bricks and around the meshes; owned by
                 * the plan; [point_count], eight for each box */
  int point_count;
  vec3 middle;
  double voxel; /* the smallest edge of a voxel, frame units */
} frame_content;

typedef struct frame {
  int width, height; /* width and height in pixels of the frame: the picture's size times oversampling */
  int oversampling;  /* a pixel of the picture is the mean of oversampling x oversampling pixels of the
                      * frame */
  view eye;
  vec3 eye_direction;  /* the direction e: a unit vector from the eye towards the content */
  double pixel;        /* the edge of a picture's pixel, projected to the nearest content; frame units */
  double middle_pixel; /* edge of a picture's pixel at the content's middle, frame units */
  double spacing;      /* the distance ds between neighbouring sheets, frame units */
  frame_content content;
  light_sectors sectors; /* the directions of the sectors into which lights within the content are divided */
  light_source *lights;  /* [light_count]; owned by the caller; the sectors of one light follow each other */
  int light_count;
  const surfaces *surfaces;    /* surfaces of the scene's meshes; null if the scene has no meshes */
  const surface_tree *contact; /* the tree of the surfaces close behind which the light is corrected
                                * (render/late/) */
} frame;

/* Makes the eye's view of width x height pixels. */
hl_status hl_frame_eye(const hl_camera *camera, int width, int height, view *eye, hl_error *error);

/* Sets the frame's size, oversampling, eye and middle. The members `points` and `voxel` of the frame's
 * content must have been set. */
hl_status hl_frame_set_up_eye(frame *frame, const hl_scene_description *scene, hl_error *error);

/* Returns whether the picture of any volume or mesh depends on arriving light. Flat colours and maximum
 * projections do not depend on arriving light. */
bool hl_is_lit(const hl_scene_description *scene);

static inline bool hl_is_maximum(const hl_render_settings *settings) {
  return settings->compositing == HL_COMPOSITING_MAXIMUM;
}

/* Finds the corners of the box around a grid's relevant bricks. The grid must have at least one relevant
 * brick. */
void hl_frame_content(const grid *grid, vec3 corners[8]);

/* Finds corners that bound the part of the content that the eye sees; a shadow buffer must cover this part.
 * points: room for CONTENT_POINTS points for each grid. Returns the number of points. */
int hl_frame_visible_points(const frame *frame, vec3 *points);

#endif
