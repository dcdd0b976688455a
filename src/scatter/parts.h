/* scatter/parts.h - what the files of this room hand to each other. */
#ifndef HL_SCATTER_PARTS_H
#define HL_SCATTER_PARTS_H

#include "scatter/scatter.h"

/* Lines of the grid through a node: 3 along the axes, 6 along diagonals of faces, 4 along diagonals of cells.
 */
enum { SCATTER_LINES = 13 };

/* Matter and light at the nodes, each array [channels][nodes]. */
typedef struct scatter_arrays {
  float *extinction; /* per frame unit, of the medium that scatters evenly */
  float *scattering; /* likewise */
  float *direct;     /* [3][nodes]: the mean over all directions of light that was not scattered */
  int channels;      /* of extinction and scattering: 1 where all colours have the same, else 3 */
} scatter_arrays;

/* Working memory of transport.c, one channel at a time. */
typedef struct scatter_work {
  float *pass[SCATTER_LINES];                         /* [nodes] */
  float *along[SCATTER_LINES];                        /* [nodes] */
  float *vectors[5];                                  /* [nodes] */
  float *flux[SCATTER_LINES], *before[SCATTER_LINES]; /* [nodes]; null where no flux is wanted */
} scatter_work;

/* Fills extinction and scattering, and finds the number of channels. */
void hl_scatter_fill_matter(const scatter_scene *scene, const scatter_nodes *nodes, scatter_arrays *arrays);

/* Fills direct. */
void hl_scatter_fill_direct(const scatter_scene *scene, const scatter_nodes *nodes, scatter_arrays *arrays);

/* Prepares the lines for one channel of extinction. */
void hl_scatter_begin_lines(hl_pool *pool, const scatter_nodes *nodes, const float *extinction,
                            scatter_work *work);
/* Solves one channel: light = the mean over all directions of light that was scattered once or more often,
 * given the light that was not. flux: [3][nodes], its mean times its direction of travel; null: not wanted.
 */
void hl_scatter_solve(hl_pool *pool, const scatter_nodes *nodes, const float *extinction,
                      const float *scattering, const float *direct, scatter_work *work, float *light,
                      float *flux);

#endif
