/* json/foreign/foreign_nodes.h - converts points of transfer functions of VTK, ParaView and Slicer. */
#ifndef HL_JSON_FOREIGN_FOREIGN_NODES_H
#define HL_JSON_FOREIGN_FOREIGN_NODES_H

#include "json/color_space.h"
#include "json/parts.h"

/* The greatest number of points of a foreign function. Each point becomes several of Halflight's points,
 * whose number must stay below HL_LIMIT_POINTS. */
enum { HL_FOREIGN_NODES = 2048 };

/* A point of a foreign transfer function: an opacity or an sRGB colour at a value. Midpoint and sharpness
 * shape the segment to the next point, as in VTK. */
typedef struct hl_foreign_node {
  double value, y[3], midpoint, sharpness;
} hl_foreign_node;

/* Checks the points of a foreign function before they are converted, so that errors name the points of the
 * file. */
hl_status hl_foreign_check(hl_json_reader *reader, const hl_foreign_node *nodes, size_t count);

/* Converts points of a foreign function to opacities, which are owned by the caller. */
hl_status hl_foreign_opacity(hl_context *context, const hl_foreign_node *nodes, size_t count,
                             const hl_opacity_point **opacity, size_t *opacity_count, hl_error *error);

/* Converts points of a foreign function to colours, which are owned by *function. */
hl_status hl_foreign_color(hl_context *context, const hl_foreign_node *nodes, size_t count,
                           hl_color_space space, hl_transfer_function *function, hl_error *error);

#endif
