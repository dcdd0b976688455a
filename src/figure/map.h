/* figure/map.h - finds the places on the page of points of a scene's world. */
#ifndef HL_FIGURE_MAP_H
#define HL_FIGURE_MAP_H

#include <halflight/figure.h>
#include <stdbool.h>

#include "core/vector.h"

/* A rectangle on the page, in points; y runs downwards. */
typedef struct hl_rectangle {
  double left, top, width, height;
} hl_rectangle;

/* The camera's map from the world to the rectangle that the picture fills. */
typedef struct hl_map {
  vec3 eye, right, up, forward;
  double center_x, center_y; /* the picture's middle on the page, points */
  double scale; /* points on the page per unit of the world; with a perspective camera at a depth of 1 */
  bool perspective;
  double target_depth; /* distance from the eye to the camera's target along the line of sight */
} hl_map;

hl_map hl_map_of(const hl_camera *camera, hl_rectangle picture);

/* Returns the length on the page, in points, of one unit of the world. depth: the distance from the eye;
 * used only for perspective cameras. */
double hl_map_scale(const hl_map *map, double depth);

/* Finds the place on the page of a point of the world. Returns false if the point lies behind the eye. */
bool hl_map_point(const hl_map *map, vec3 world, double *x, double *y);

#endif
