/* scatter/faces.c - changes the light of nodes beside matter, so that samples between nodes are lit as the
 * matter is.
 *
 * Samples are lit by the light of nodes, interpolated linearly in the distance. The light itself is linear in
 * the optical depth. Consider a line that crosses the matter's face between two nodes. Let e and f be the
 * extinctions of the two nodes, and f the lesser one. Each extinction is taken to hold for half of the way.
 * Let u and v be the light at the nodes. In the middle of the way the light is then u + (v - u) e / (e + f).
 * Linear interpolation gives this value if the node of extinction f holds v + (v - u) (e - f) / (e + f) in
 * place of v (derived). Lines along the face are another case. Beside the matter, the light v along such a
 * line comes from the sky, or is 0. Within the matter, the light u along the line is scattered there. Each
 * line stands for all directions that are nearly along the face. At the face, one half of these directions
 * brings v and the other half u; a little deeper all of them bring u. Half-way between these two depths, v
 * has the weight 1/4. For this weight, the node of less matter must hold v + (u - v) / 2 (e - f) / (e + f).
 *
 * An empty node beside matter therefore holds the light at the matter's face. The light beside the matter
 * continues the light within the matter, and even light stays even. If a node has several neighbours with
 * more matter, it gets the mean of the changes for all of them. The weight of a neighbour is the difference
 * of matter. */
#include "scatter/parts.h"

typedef struct faces {
  const float *extinction;
  float *const *lines; /* [SCATTER_LINES][nodes]; the light along each line at each node */
} faces;

typedef struct face_sums {
  float change, weight;
} face_sums;

/* Continues the light across the face between a node and its neighbour along an axis. between: the fraction
 * of light that meshes let through from one of these nodes to the other. */
static void add_face(const faces *of, int axis, size_t node, size_t next, float between, face_sums *sums) {
  const float own = of->extinction[node], other = of->extinction[next];
  if (!(other > own)) return;
  const float weight = (other - own) * between;
  float change = 0;
  for (int line = 0; line < SCATTER_LINES; line++) {
    const float difference = of->lines[line][node] - of->lines[line][next];
    change += hl_scatter_line_weight(line) * (hl_scatter_step(line)[axis] != 0 ? 1 : -0.5f) * difference;
  }
  sums->change += weight * change * (other - own) / (other + own);
  sums->weight += weight;
}

void hl_scatter_continue(const scatter_nodes *nodes, const float *extinction, const scatter_work *work,
                         float *light) {
  const faces of = {extinction, work->along};
  const int32_t *count = nodes->count;
  const size_t step[3] = {1, (size_t)count[0], (size_t)count[0] * (size_t)count[1]};
  size_t node = 0;
  for (int32_t z = 0; z < count[2]; z++)
    for (int32_t y = 0; y < count[1]; y++)
      for (int32_t x = 0; x < count[0]; x++, node++) {
        const int32_t at[3] = {x, y, z};
        face_sums sums = {0, 0};
        for (int axis = 0; axis < 3; axis++) {
          const float *after = work->walls.after[axis];
          const size_t before = node - step[axis], next = node + step[axis];
          if (at[axis] > 0) add_face(&of, axis, node, before, after != NULL ? after[before] : 1, &sums);
          if (at[axis] < count[axis] - 1)
            add_face(&of, axis, node, next, after != NULL ? after[node] : 1, &sums);
        }
        const float continued = light[node] + (sums.weight > 0 ? sums.change / sums.weight : 0);
        light[node] = continued > 0 ? continued : 0;
      }
}
