/* scatter/parts.h - what the files of this room hand to each other. */
#ifndef HL_SCATTER_PARTS_H
#define HL_SCATTER_PARTS_H

#include "core/vector.h"
#include "scatter/scatter.h"
#include "surface/surface_tree.h"

/* Lines of the grid through a node: 3 along the axes, 6 along diagonals of faces, 4 along diagonals of cells.
 */
enum { SCATTER_LINES = 13 };

enum {
  SCATTER_LONGEST = 48, /* nodes along the longest side of the matter */
  SCATTER_MARGIN = 1,   /* empty nodes around it */
  SCATTER_MOST_NODES = SCATTER_LONGEST + 2 * SCATTER_MARGIN
};

/* Rays that look for meshes pass this far beside nodes, in units of their spacing: so none runs along the
 * common edge of triangles that stand on the grid. */
#define SCATTER_BESIDE ((vec3){0.0117, 0.0071, 0.0139})

/* Matter and light at the nodes, each array [channels][nodes]. */
typedef struct scatter_arrays {
  float *extinction; /* per frame unit, of the medium that scatters evenly */
  float *scattering; /* likewise */
  float *own;    /* likewise; the extinction of the medium as it is; where all scatter evenly, `extinction` */
  float *direct; /* [3][nodes]: the mean over all directions of light that was not scattered */
  int channels;  /* of extinction and scattering: 1 where all colours have the same, else 3 */
  const surface_tree *tree; /* borrowed; of meshes; without boxes where there are none */
} scatter_arrays;

/* Light that enters the grid at the ends of its lines, one channel: radiance that travels along a line's way,
 * and against it. */
typedef struct scatter_inflow {
  float along[SCATTER_LINES], against[SCATTER_LINES];
} scatter_inflow;

/* From a node to the next one of a line. */
const int *hl_scatter_step(int line);

/* The way of a line, unit length, or the way back; its weight in the mean over all directions, both ways. */
vec3 hl_scatter_way(int line, bool onwards);
float hl_scatter_line_weight(int line);

/* The sky's light that enters in each channel. Each of the 26 directions has the mean radiance of the
 * directions that are nearest to it; the sum is the sky's. */
void hl_scatter_sky_inflow(const hl_sky *sky, scatter_inflow inflow[3]);

/* Samples are lit by (1 - w) of the sky's light that nothing has scattered, w the albedo, from the field of
 * the sky, whose cells are finer than the nodes. The rest is in the grid:
 *
 *     all light of the grid - (1 - w) of its unscattered light.
 *
 * So details of the shadow of the sky vanish where all light is scattered on, as they do: what a fold gets
 * less of the sky it gets more of scattered light. Under an even sky a medium of albedo 1 is lit by 1
 * everywhere, exactly. */

/* What meshes let through along the lines, as fractions, each array [nodes]; and what walls.c makes of this
 * and of a channel's extinction. */
typedef struct scatter_walls {
  float *outside[SCATTER_LINES]; /* between the sky and the first nodes of lines; 0 at others */
  float *after[SCATTER_LINES];   /* between a node and the next one; of last nodes: the sky */
  float *at_node[SCATTER_LINES], *between[SCATTER_LINES]; /* depths */
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

/* Fills extinction and scattering, and finds the number of channels. */
void hl_scatter_fill_matter(const scatter_scene *scene, const scatter_nodes *nodes, scatter_arrays *arrays);

/* Fills direct. */
void hl_scatter_fill_direct(const scatter_scene *scene, const scatter_nodes *nodes, scatter_arrays *arrays);

/* Fills what meshes let through. */
void hl_scatter_fill_walls(const scatter_scene *scene, const scatter_nodes *nodes, const surface_tree *tree,
                           const scatter_walls *walls);

/* Sets the depth between a node and the next one of a line, which are `length` apart, and adds to the depths
 * at both what meshes between them take. */
void hl_scatter_add_wall(const scatter_walls *walls, int line, size_t node, size_t next,
                         const float *extinction, float length);

/* Changes the light of nodes beside matter: the mean over the lines, which work->along holds. */
void hl_scatter_continue(const scatter_nodes *nodes, const float *extinction, const scatter_work *work,
                         float *light);

/* Prepares the lines for one channel of extinction. */
void hl_scatter_begin_lines(hl_pool *pool, const scatter_nodes *nodes, const float *extinction,
                            scatter_work *work);
/* Light that enters and is not scattered: the mean over all directions. flux: as below; scratch: [nodes]. */
void hl_scatter_enter(hl_pool *pool, const scatter_nodes *nodes, const float *extinction,
                      const scatter_inflow *inflow, scatter_work *work, float *scratch, float *light,
                      float *flux);

/* Solves one channel: light = the mean over all directions of light that was scattered once or more often,
 * given the light that was not (direct), and of light that enters (null: none), scattered or not; direct is
 * without the light that enters. flux: [3][nodes], the mean times the direction of travel; null: not wanted.
 */
void hl_scatter_solve(hl_pool *pool, const scatter_nodes *nodes, const float *extinction,
                      const float *scattering, const float *direct, const scatter_inflow *inflow,
                      scatter_work *work, float *light, float *flux);

#endif
