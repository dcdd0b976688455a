/* scatter/parts.h - declares the data and functions that the files of the folder scatter share. */
#ifndef HL_SCATTER_PARTS_H
#define HL_SCATTER_PARTS_H

#include "core/vector.h"
#include "scatter/scatter.h"
#include "surface/surface_tree.h"

/* The number of the grid's lines through a node: 3 along axes, 6 along diagonals of faces, 4 along diagonals
 * of cells. */
enum { SCATTER_LINES = 13 };

enum {
  SCATTER_LONGEST = 48, /* number of nodes along the longest side of the matter */
  SCATTER_MARGIN = 1,   /* number of empty nodes around the matter */
  SCATTER_MOST_NODES = SCATTER_LONGEST + 2 * SCATTER_MARGIN
};

/* Rays that look for meshes pass beside the nodes, at this offset in units of the nodes' spacing. So no ray
 * runs along an edge between triangles that lie in the planes of the grid. */
#define SCATTER_BESIDE ((vec3){0.0117, 0.0071, 0.0139})

/* Matter and light at the nodes of the grid. Each array is [channels][nodes], unless its comment says
 * otherwise. */
typedef struct scatter_arrays {
  float *extinction; /* extinction, per frame unit, of the evenly scattering medium (scatter.h) that
                      * replaces the real medium */
  float *scattering; /* scattering of the evenly scattering medium, per frame unit */
  float *own;        /* extinction of the real medium, per frame unit. If all media scatter evenly, this is
                      * the same array as `extinction` */
  /* [3][nodes]; for each colour channel, the mean over all directions of the light that was not scattered */
  float *direct;
  int channels; /* number of channels of extinction and scattering: 1 if these are the same for all
                 * colours, else 3 */
  const surface_tree *tree; /* borrowed; the tree of meshes; if there are no meshes, it has no boxes */
} scatter_arrays;

/* The light, in one channel, that enters the grid at the ends of its lines. For each direction of lines there
 * are two numbers: the radiance that travels along the direction, and the radiance that travels against
 * it. */
typedef struct scatter_inflow {
  float along[SCATTER_LINES], against[SCATTER_LINES];
} scatter_inflow;

/* The step, in nodes along x, y and z, from a node to the next node of a line. */
const int *hl_scatter_step(int line);

/* Two functions about a line's two directions. hl_scatter_way() returns the unit vector of one of these
 * directions: the direction of the line, or its opposite. hl_scatter_line_weight() gives the weight of both
 * directions together in the mean over all directions. */
vec3 hl_scatter_way(int line, bool onwards);
float hl_scatter_line_weight(int line);

/* Finds the sky's light that enters the grid, in each channel. A direction of the grid gets the mean radiance
 * of the sky's directions that are nearest to it. Then the radiances of all 26 directions are multiplied by
 * one factor, so that their weighted sum is the light of the whole sky. */
void hl_scatter_sky_inflow(const hl_sky *sky, scatter_inflow inflow[3]);

/* The division of the sky's light between two fields. The sky's field (field/sky_field.h) is finer than the
 * nodes. It lights samples with the fraction 1 - w of the sky's unscattered light, where w is the albedo. The
 * grid of nodes holds the rest:
 *
 *     all light of the grid - (1 - w) of its unscattered light.
 *
 * So in matter that scatters all light, details of the sky's shadow vanish. This is right, because a fold of
 * the matter that gets less of the sky's light gets more scattered light. Under an even sky a medium of
 * albedo 1 is lit by 1 everywhere, exactly. */

/* The attenuation of light by meshes along the grid's lines: the fractions of light that meshes let through,
 * and the optical depths that walls.c makes from these fractions and from a channel's extinction. Each array
 * is [nodes]. */
typedef struct scatter_walls {
  float *outside[SCATTER_LINES]; /* at the first node of a line: the fraction of light that meshes let through
                                  * between the sky and the node; at other nodes 0 */
  float *after[SCATTER_LINES];   /* the fraction of light that meshes let through between the node and the
                                  * line's next node; at the last node of a line, between the node and the
                                  * sky */
  float *at_node[SCATTER_LINES], *between[SCATTER_LINES]; /* at_node: the optical depth of the node's own box;
                                                           * between: the optical depth between the node and
                                                           * the line's next node */
} scatter_walls;

/* Working memory of transport.c, one channel at a time. */
typedef struct scatter_work {
  float *pass[SCATTER_LINES];                         /* [nodes]; for each line, the number g of each node
                                                       * (transport.c) */
  float *along[SCATTER_LINES];                        /* [nodes]; for each line, the light along the line
                                                       * at each node, and intermediate results */
  float *vectors[5];                                  /* [nodes]; vectors of the conjugate gradients */
  float *flux[SCATTER_LINES], *before[SCATTER_LINES]; /* [nodes]; memory for finding the flux; null if no flux
                                                       * is wanted */
  float *sky;          /* [nodes]; the sky's light that was not scattered; null if there is no sky */
  float *sky_flux;     /* [3][nodes]; the flux; null if no flux is wanted */
  scatter_walls walls; /* the meshes on the lines; without meshes the arrays are null */
} scatter_work;

/* Fills the nodes' extinction and scattering, and sets the number of channels. */
void hl_scatter_fill_matter(const scatter_scene *scene, const scatter_nodes *nodes, scatter_arrays *arrays);

/* Fills the array `direct`: the lights' unscattered light at the nodes. */
void hl_scatter_fill_direct(const scatter_scene *scene, const scatter_nodes *nodes, scatter_arrays *arrays);

/* Fills the fractions of light that meshes let through: the arrays `outside` and `after` of the walls. */
void hl_scatter_fill_walls(const scatter_scene *scene, const scatter_nodes *nodes, const surface_tree *tree,
                           const scatter_walls *walls);

/* Sets the optical depth between a node and the next node of a line, which are `length` apart. This depth
 * is the sum of the depths of the medium and of the meshes between the two nodes. Also raises the depths of
 * both nodes' boxes by a part of the meshes' depth. */
void hl_scatter_add_wall(const scatter_walls *walls, int line, size_t node, size_t next,
                         const float *extinction, float length);

/* Changes the light of nodes beside matter (faces.c). light: [nodes]; the mean over all directions.
 * work->along holds the light along each line. */
void hl_scatter_continue(const scatter_nodes *nodes, const float *extinction, const scatter_work *work,
                         float *light);

/* Prepares the working memory of all lines for the extinction of one channel. */
void hl_scatter_begin_lines(hl_pool *pool, const scatter_nodes *nodes, const float *extinction,
                            scatter_work *work);
/* Finds the sky's light that enters the grid and is not scattered there, as the mean over all directions.
 * flux: as for hl_scatter_solve(). scratch: [nodes]. */
void hl_scatter_enter(hl_pool *pool, const scatter_nodes *nodes, const float *extinction,
                      const scatter_inflow *inflow, scatter_work *work, float *scratch, float *light,
                      float *flux);

/* Finds the light of one colour channel at the nodes. direct: the lights' unscattered light. inflow: the
 * sky's light that enters the grid; null if there is none. light: receives the mean over all directions of
 * two kinds of light: scattered light, and the sky's light that was not scattered. flux: [3][nodes]; receives
 * the mean of this light times its direction of travel; null if it is not wanted. */
void hl_scatter_solve(hl_pool *pool, const scatter_nodes *nodes, const float *extinction,
                      const float *scattering, const float *direct, const scatter_inflow *inflow,
                      scatter_work *work, float *light, float *flux);

#endif
