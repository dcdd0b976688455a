/* scatter/parts.h - data and functions that the files of this room share. */
#ifndef HL_SCATTER_PARTS_H
#define HL_SCATTER_PARTS_H

#include "core/vector.h"
#include "scatter/scatter.h"
#include "surface/surface_tree.h"

/* The number of lines of the grid through a node: 3 along the axes, 6 along diagonals of faces, 4 along
 * diagonals of cells. */
enum { SCATTER_LINES = 13 };

enum {
  SCATTER_LONGEST = 48, /* number of nodes along the longest side of the matter */
  SCATTER_MARGIN = 1,   /* number of empty nodes around the matter */
  SCATTER_MOST_NODES = SCATTER_LONGEST + 2 * SCATTER_MARGIN
};

/* Rays that look for meshes pass beside the nodes, at this offset in units of the nodes' spacing. So no ray
 * runs along the common edge of triangles that stand on the grid. */
#define SCATTER_BESIDE ((vec3){0.0117, 0.0071, 0.0139})

/* Matter and light at the nodes, each array [channels][nodes]. */
typedef struct scatter_arrays {
  float *extinction; /* extinction of the medium that scatters evenly, per frame unit */
  float *scattering; /* per frame unit; scattering of this medium */
  float *own;        /* extinction of the real medium, per frame unit. Where all media scatter evenly, it
                      * is the array `extinction` */
  float *direct;     /* [3][nodes]; the mean over all directions of the light that was not scattered */
  int channels;      /* channels of extinction and scattering: 1 where all colours have the same, else 3 */
  const surface_tree *tree; /* borrowed; the tree of meshes, without boxes where there are no meshes */
} scatter_arrays;

/* Light that enters the grid at the ends of its lines, for one channel: the radiance that travels along a
 * line's direction, and against it. */
typedef struct scatter_inflow {
  float along[SCATTER_LINES], against[SCATTER_LINES];
} scatter_inflow;

/* The step from a node to the next node of a line. */
const int *hl_scatter_step(int line);

/* The first function gives the unit direction of a line, or its opposite. The second gives the weight of
 * both directions together in the mean over all directions. */
vec3 hl_scatter_way(int line, bool onwards);
float hl_scatter_line_weight(int line);

/* Finds the sky's light that enters the grid, in each channel. Each of the 26 directions has the mean
 * radiance of the sky's directions that are nearest to it. One factor for all of them makes their sum the
 * light of the whole sky. */
void hl_scatter_sky_inflow(const hl_sky *sky, scatter_inflow inflow[3]);

/* Where w is the albedo, the field of the sky, whose cells are finer than the nodes, lights samples with (1
 * - w) of the sky's unscattered light. The rest is in the grid:
 *
 *
 *     all light of the grid - (1 - w) of its unscattered light.
 *
 * So where all light is scattered on, details of the sky's shadow vanish. This is right, because a fold
 * that gets less of the sky's light gets more scattered light. Under an even sky a medium of albedo 1 is
 * lit by 1 everywhere, exactly. */

/* The fractions of light that meshes let through along the lines, each array [nodes]; and the depths that
 * walls.c makes from them and from a channel's extinction. */
typedef struct scatter_walls {
  float *outside[SCATTER_LINES]; /* fractions let through between the sky and the first nodes of lines; 0
                                  * at other nodes */
  float *after[SCATTER_LINES];   /* fractions let through between a node and the next one; at last nodes,
                                  * between the node and the sky */
  float *at_node[SCATTER_LINES], *between[SCATTER_LINES]; /* depths at nodes, and depths between nodes */
} scatter_walls;

/* Working memory of transport.c, one channel at a time. */
typedef struct scatter_work {
  float *pass[SCATTER_LINES];                         /* [nodes] */
  float *along[SCATTER_LINES];                        /* [nodes] */
  float *vectors[5];                                  /* [nodes] */
  float *flux[SCATTER_LINES], *before[SCATTER_LINES]; /* [nodes]; null where no flux is wanted */
  float *sky;          /* [nodes]; the sky's light that was not scattered; null without a sky */
  float *sky_flux;     /* [3][nodes]; null where no flux is wanted */
  scatter_walls walls; /* arrays are null without meshes */
} scatter_work;

/* Fills the nodes' extinction and scattering, and sets the number of channels. */
void hl_scatter_fill_matter(const scatter_scene *scene, const scatter_nodes *nodes, scatter_arrays *arrays);

/* Fills direct. */
void hl_scatter_fill_direct(const scatter_scene *scene, const scatter_nodes *nodes, scatter_arrays *arrays);

/* Fills the fractions that meshes let through. */
void hl_scatter_fill_walls(const scatter_scene *scene, const scatter_nodes *nodes, const surface_tree *tree,
                           const scatter_walls *walls);

/* Sets the optical depth between a node and the next node of a line, which are `length` apart: the depth of
 * the medium and of the meshes between them. Raises the depths at both nodes by a part of the meshes' depth.
 */
void hl_scatter_add_wall(const scatter_walls *walls, int line, size_t node, size_t next,
                         const float *extinction, float length);

/* Changes the light of nodes beside matter (faces.c). The light is the mean over the lines in work->along. */
void hl_scatter_continue(const scatter_nodes *nodes, const float *extinction, const scatter_work *work,
                         float *light);

/* Prepares the lines for one channel of extinction. */
void hl_scatter_begin_lines(hl_pool *pool, const scatter_nodes *nodes, const float *extinction,
                            scatter_work *work);
/* Finds the light that enters the grid and is not scattered, as the mean over all directions. flux: as for
 * hl_scatter_solve(). scratch: [nodes]. */
void hl_scatter_enter(hl_pool *pool, const scatter_nodes *nodes, const float *extinction,
                      const scatter_inflow *inflow, scatter_work *work, float *scratch, float *light,
                      float *flux);

/* Solves one channel. light: the mean over all directions of light that was scattered once or more often.
 * direct: the light that was not scattered, without the light that enters. inflow: the light that enters,
 * which is added scattered and unscattered; null: none enters. flux: [3][nodes], the mean times the direction
 * of travel; null: not wanted. */
void hl_scatter_solve(hl_pool *pool, const scatter_nodes *nodes, const float *extinction,
                      const float *scattering, const float *direct, const scatter_inflow *inflow,
                      scatter_work *work, float *light, float *flux);

#endif
