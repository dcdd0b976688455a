/* scatter/transport.c - computes how scattered light spreads from node to node.
 *
 * Along a line through the nodes, let u be the mean of the light that travels onwards and of the light that
 * travels back. With even scattering, u obeys u'' = u - S, where u'' is the second derivative by the optical
 * depth, and S is the light that is scattered into each of the two ways (Feautrier, "Sur la resolution
 * numerique de l'equation de transfert", 1964). Let d_{i+1/2} be the optical distance of the nodes i and i +
 * 1, and t_i the optical depth of a node's own box:
 *
 *     t_i (u_i - S_i) = (u_{i+1} - u_i) / d_{i+1/2} - (u_i - u_{i-1}) / d_{i-1/2}
 *
 * At the ends of a line, the light I enters; only the sky's light enters the grid. These equations are solved
 * by elimination, which starts at one end. The form used here has no differences and no division by d, which
 * is 0 in empty space (derived; after Rybicki and Hummer, "An accelerated lambda iteration method for
 * multilevel radiative transfer", 1991, appendix A):
 *
 *     f_i = t_i + f_{i-1} g_{i-1},  y_i = t_i S_i + y_{i-1} g_{i-1},  g_i = 1 / (1 + f_i d_{i+1/2}),  f = 1
 *     and y = I before the first, u_i = (u_{i+1} + y_i d_{i+1/2}) g_i,  at the last node u = (y + I) / (1 +
 *     f)
 *
 * The mean over all directions is the weighted sum over the 13 lines between a node and its 26 neighbours, by
 * the weights of the cubature of degree 7 of Lebedev ("Values of the nodes and weights of ninth to
 * seventeenth order Gauss-Markov quadrature formulae invariant under the octahedron group with inversion",
 * 1975). The scheme conserves energy. If many mean free paths lie between neighbouring nodes, it becomes the
 * diffusion equation.
 *
 * From node i to the next node, the light that travels onwards exceeds the mean of both ways by v_{i+1/2} =
 * y_i - f_i u_i (derived: the first of these equations for (u_i - u_{i+1}) / d). The sum of v times the
 * line's direction is the light's flux.
 *
 * The scattered light depends on the light itself. Let G be the linear map that gives this weighted sum for
 * the energy that nodes send out. Let D be the scattering, u the scattered light, and b the light that was
 * not scattered. Then u = G D (u + b). G is symmetric, so conjugate gradients (Hestenes and Stiefel, 1952)
 * solve (1 - sqrt(D) G sqrt(D)) v = sqrt(D) G D b for v = sqrt(D) u. */
#include <math.h>
#include <string.h>

#include "scatter/parts.h"

/* MOST_STEPS: the greatest number of steps of conjugate gradients. The steps end earlier when the residual
 * has fallen to the fraction ENOUGH of the first residual. */
enum { MOST_STEPS = 60 };
static const double ENOUGH = 2e-3;

/* The step from a node to the next node of a line. */
static const int ways[SCATTER_LINES][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1},  {1, 1, 0},  {-1, 1, 0},
                                           {1, 0, 1},  {-1, 0, 1}, {0, 1, 1},  {0, -1, 1}, {1, 1, 1},
                                           {-1, 1, 1}, {1, -1, 1}, {-1, -1, 1}};

/* The weight of a line, for both of its directions: 2 x 1/21, 4/105, 9/280. */
static float weight_of(int line) { return line < 3 ? 2.0f / 21 : line < 9 ? 8.0f / 105 : 18.0f / 280; }

/* The distance of neighbouring nodes on a line, in units of the spacing. */
static float length_of(int line) { return line < 3 ? 1.0f : line < 9 ? 1.41421356f : 1.73205081f; }

vec3 hl_scatter_way(int line, bool onwards) {
  const int *way = ways[line];
  return vec3_scale(vec3_normalise((vec3){way[0], way[1], way[2]}), onwards ? 1 : -1);
}

float hl_scatter_line_weight(int line) { return weight_of(line); }
const int *hl_scatter_step(int line) { return ways[line]; }

typedef struct lines_job {
  const scatter_nodes *nodes;
  const float *extinction;
  const scatter_inflow *inflow; /* the light that enters the grid at the ends of its lines; null if no light
                                 * enters */
  const float *sent; /* [nodes]; the energy that a node sends out in all directions, per unit of length */
  scatter_work *work;
  float *mean; /* [nodes]; receives the mean over all directions */
} lines_job;

/* The meshes on the lines; null if there are no meshes. */
static const scatter_walls *walls_of(const lines_job *job) {
  return job->work->walls.after[0] != NULL ? &job->work->walls : NULL;
}

/* A row of nodes along x, as a part of all lines of one direction. */
typedef struct line_row {
  size_t at;         /* number of the row's first node */
  size_t step;       /* step, in node numbers, from a node to the next node of its line */
  int32_t low, high; /* the nodes of the row that have a next node: from low to high - 1 */
} line_row;

/* Finds row number `index` for lines of one direction. Rows are counted in the order in which light that
 * travels onwards reaches the rows. */
static line_row row_of(const scatter_nodes *nodes, int line, size_t index) {
  const int *way = ways[line];
  const int32_t *count = nodes->count;
  int32_t y = (int32_t)(index % (size_t)count[1]), z = (int32_t)(index / (size_t)count[1]);
  if (way[1] < 0) y = count[1] - 1 - y;
  line_row row = {.at = ((size_t)z * (size_t)count[1] + (size_t)y) * (size_t)count[0]};
  row.step = (size_t)((ptrdiff_t)way[0] + ((ptrdiff_t)way[2] * count[1] + way[1]) * count[0]);
  bool last = z + way[2] >= count[2] || y + way[1] < 0 || y + way[1] >= count[1];
  row.low = way[0] < 0 ? 1 : 0;
  row.high = last ? row.low : count[0] - (way[0] > 0 ? 1 : 0);
  return row;
}

/* Finds the number g (see the head of the file) at all nodes, for lines of one direction. At the last node
 * of each line, 1 / (1 + f) is stored in place of g. */
static void begin_line(void *data, size_t line, int worker) {
  (void)worker;
  const lines_job *job = data;
  const int32_t *count = job->nodes->count;
  size_t rows = (size_t)count[1] * (size_t)count[2];
  float length = length_of((int)line) * job->nodes->spacing, *pass = job->work->pass[line],
        *before = job->work->along[line]; /* receives f_{i-1} g_{i-1} of each node */
  const float *e = job->extinction;
  const scatter_walls *walls = walls_of(job);
  for (size_t n = 0; n < rows * (size_t)count[0]; n++) before[n] = 1;
  for (size_t n = 0; n < rows * (size_t)count[0] && walls != NULL; n++)
    walls->at_node[line][n] = length * e[n];
  for (size_t r = 0; r < rows; r++) {
    line_row row = row_of(job->nodes, (int)line, r);
    for (int32_t x = 0; x < count[0]; x++) {
      size_t at = row.at + (size_t)x;
      bool next = x >= row.low && x < row.high;
      if (next && walls != NULL) hl_scatter_add_wall(walls, (int)line, at, at + row.step, e, length);
      float f = (walls != NULL ? walls->at_node[line][at] : length * e[at]) + before[at];
      if (next && walls != NULL) pass[at] = 1 / (1 + f * walls->between[line][at]);
      else pass[at] = 1 / (1 + (next ? f * 0.5f * length * (e[at] + e[at + row.step]) : f));
      if (next) before[at + row.step] = f * pass[at];
    }
  }
}

/* The light that enters a line of the grid's nodes at its first node, and at its last node. */
static float entering(const lines_job *job, int line) {
  return job->inflow != NULL ? job->inflow->along[line] : 0;
}
static float entering_last(const lines_job *job, int line) {
  return job->inflow != NULL ? job->inflow->against[line] : 0;
}

/* Sets the number y (see the head of the file) at each node before light goes along the line: the energy that
 * the node sends out, plus the light that enters the line. Without meshes every node gets the entering light,
 * and go_forward() subtracts it again from all nodes but the first. With meshes only the first node gets the
 * entering light, reduced by the walls before it. */
static void begin_sums(const lines_job *job, int line, float *sums) {
  const scatter_walls *walls = walls_of(job);
  float length = length_of(line) * job->nodes->spacing, entered = entering(job, line);
  size_t nodes = hl_scatter_node_count(job->nodes);
  if (walls != NULL)
    for (size_t n = 0; n < nodes; n++) sums[n] = length * job->sent[n] + entered * walls->outside[line][n];
  else
    for (size_t n = 0; n < nodes; n++) sums[n] = length * job->sent[n] + entered;
}

/* The entering light that go_forward() subtracts from a node that is not the first of its line. */
static float taken_back(const lines_job *job, int line) {
  return walls_of(job) != NULL ? 0 : entering(job, line);
}

/* Finds the numbers y of a row of nodes, from the nodes before them on their lines. */
static void go_forward(const lines_job *job, int line, const line_row *row) {
  const float *pass = job->work->pass[line] + row->at;
  float *from = job->work->along[line] + row->at, *to = from + row->step, entered = taken_back(job, line);
  for (int32_t x = row->low; x < row->high; x++) to[x] += from[x] * pass[x] - entered;
}

/* Finds the light u of a row of nodes, from the numbers y and from the nodes after them on their lines. */
static void go_back(const lines_job *job, int line, const line_row *row) {
  float half = 0.5f * length_of(line) * job->nodes->spacing;
  const float *pass = job->work->pass[line] + row->at, *e = job->extinction + row->at, *ahead = e + row->step;
  float *here = job->work->along[line] + row->at;
  const float *next = here + row->step;
  int32_t count = job->nodes->count[0];
  float last = entering_last(job, line);
  const scatter_walls *walls = walls_of(job);
  const float *after = walls != NULL ? walls->after[line] + row->at : NULL;
  const float *between = walls != NULL ? walls->between[line] + row->at : NULL;
  for (int32_t x = row->high > row->low ? row->high : 0; x < count; x++)
    here[x] = (here[x] + (after != NULL ? last * after[x] : last)) * pass[x];
  for (int32_t x = 0; x < row->low && row->high > row->low; x++)
    here[x] = (here[x] + (after != NULL ? last * after[x] : last)) * pass[x];
  if (between != NULL)
    for (int32_t x = row->high - 1; x >= row->low; x--) here[x] = (next[x] + here[x] * between[x]) * pass[x];
  else if (row->step == 1)
    for (int32_t x = row->high - 1; x >= row->low; x--)
      here[x] = (next[x] + here[x] * (half * (e[x] + ahead[x]))) * pass[x];
  else
    for (int32_t x = row->low; x < row->high; x++)
      here[x] = (next[x] + here[x] * (half * (e[x] + ahead[x]))) * pass[x];
}

static void solve_line(void *data, size_t line, int worker) {
  (void)worker;
  const lines_job *job = data;
  const int32_t *count = job->nodes->count;
  size_t rows = (size_t)count[1] * (size_t)count[2];
  begin_sums(job, (int)line, job->work->along[line]);
  for (size_t r = 0; r < rows; r++) {
    line_row row = row_of(job->nodes, (int)line, r);
    go_forward(job, (int)line, &row);
  }
  for (size_t r = rows; r-- > 0;) {
    line_row row = row_of(job->nodes, (int)line, r);
    go_back(job, (int)line, &row);
  }
}

/* Finds, for lines of one direction, the excess of the light that travels onwards over the mean of both ways
 * (v at the head of the file): at each node, the mean of v on the links before and after the node. */
static void flux_line(void *data, size_t line, int worker) {
  (void)worker;
  const lines_job *job = data;
  const int32_t *count = job->nodes->count;
  size_t rows = (size_t)count[1] * (size_t)count[2], nodes = rows * (size_t)count[0];
  float length = length_of((int)line) * job->nodes->spacing, *along = job->work->along[line],
        *sent = job->work->flux[line], *before = job->work->before[line];
  const float *pass = job->work->pass[line], *e = job->extinction;
  const scatter_walls *walls = walls_of(job);
  float entered = taken_back(job, (int)line);
  begin_sums(job, (int)line, sent);
  for (size_t n = 0; n < nodes; n++) before[n] = 1;
  /* the array `along` holds u; the array `sent` becomes y, and later f */
  for (size_t r = 0; r < rows; r++) {
    line_row row = row_of(job->nodes, (int)line, r);
    for (int32_t x = 0; x < count[0]; x++) {
      size_t at = row.at + (size_t)x;
      before[at] += walls != NULL ? walls->at_node[line][at] : length * e[at];
      if (x < row.low || x >= row.high) continue;
      sent[at + row.step] += sent[at] * pass[at] - entered;
      before[at + row.step] = before[at] * pass[at];
    }
  }
  /* the link after a node has v = y - f u; in the link before it v is greater by t (u - S) (the first
   * equation) */
  for (size_t n = 0; n < nodes; n++) {
    float after = sent[n] - before[n] * along[n];
    if (walls != NULL) sent[n] = after + 0.5f * (walls->at_node[line][n] * along[n] - length * job->sent[n]);
    else sent[n] = after + 0.5f * length * (e[n] * along[n] - job->sent[n]);
  }
}

/* Sums the flux of one slice of nodes over all lines. The sums are [3][nodes], from job->mean on. */
static void sum_flux(void *data, size_t z, int worker) {
  (void)worker;
  const lines_job *job = data;
  size_t slice = (size_t)job->nodes->count[0] * (size_t)job->nodes->count[1],
         nodes = hl_scatter_node_count(job->nodes);
  for (int a = 0; a < 3; a++) {
    float *flux = job->mean + (size_t)a * nodes + z * slice;
    for (size_t n = 0; n < slice; n++) flux[n] = 0;
    for (int line = 0; line < SCATTER_LINES; line++) {
      if (ways[line][a] == 0) continue;
      const float *v = job->work->flux[line] + z * slice;
      float weight = weight_of(line) * (float)ways[line][a] / length_of(line);
      for (size_t n = 0; n < slice; n++) flux[n] += weight * v[n];
    }
  }
}

/* Finds the mean of the light over all lines, for one slice of nodes. */
static void sum_slice(void *data, size_t z, int worker) {
  (void)worker;
  const lines_job *job = data;
  size_t slice = (size_t)job->nodes->count[0] * (size_t)job->nodes->count[1];
  float *mean = job->mean + z * slice;
  for (size_t n = 0; n < slice; n++) mean[n] = 0;
  for (int line = 0; line < SCATTER_LINES; line++) {
    const float *along = job->work->along[line] + z * slice;
    float weight = weight_of(line);
    for (size_t n = 0; n < slice; n++) mean[n] += weight * along[n];
  }
}

/* Finds mean = G sent, where G is the linear map at the head of the file: the light at the nodes that results
 * from the energy that nodes send out. */
static void spread(hl_pool *pool, lines_job *job, const float *sent, float *mean) {
  job->sent = sent;
  job->mean = mean;
  hl_pool_run(pool, SCATTER_LINES, solve_line, job);
  hl_pool_run(pool, (size_t)job->nodes->count[2], sum_slice, job);
}

void hl_scatter_begin_lines(hl_pool *pool, const scatter_nodes *nodes, const float *extinction,
                            scatter_work *work) {
  lines_job job = {.nodes = nodes, .extinction = extinction, .work = work};
  hl_pool_run(pool, SCATTER_LINES, begin_line, &job);
}

static double dot(const float *a, const float *b, size_t count) {
  double sum = 0;
  for (size_t n = 0; n < count; n++) sum += (double)a[n] * b[n];
  return sum;
}

/* Finds product = (1 - sqrt(D) G sqrt(D)) v, the left side of the equation at the head of the file. scratch:
 * [nodes]. */
static void apply(hl_pool *pool, lines_job *job, const float *root, const float *v, float *scratch,
                  float *product) {
  size_t count = hl_scatter_node_count(job->nodes);
  for (size_t n = 0; n < count; n++) scratch[n] = root[n] * v[n];
  spread(pool, job, scratch, product);
  for (size_t n = 0; n < count; n++) product[n] = v[n] - root[n] * product[n];
}

/* Solves for v by conjugate gradients, starting at v = 0. rest: receives the residual; before the call, the
 * right side of the equation. */
static void solve_symmetric(hl_pool *pool, lines_job *job, const float *root, float *rest, float *v) {
  size_t count = hl_scatter_node_count(job->nodes);
  float *way = job->work->vectors[1], *product = job->work->vectors[2], *scratch = job->work->vectors[3];
  memset(v, 0, count * sizeof *v);
  memcpy(way, rest, count * sizeof *way);
  double square = dot(rest, rest, count), enough = ENOUGH * ENOUGH * square;
  for (int step = 0; step < MOST_STEPS && square > enough && square > 0 && !hl_pool_cancelled(pool); step++) {
    apply(pool, job, root, way, scratch, product);
    float length = (float)(square / dot(way, product, count));
    for (size_t n = 0; n < count; n++) v[n] += length * way[n], rest[n] -= length * product[n];
    double next = dot(rest, rest, count);
    float keep = (float)(next / square);
    for (size_t n = 0; n < count; n++) way[n] = rest[n] + keep * way[n];
    square = next;
  }
}

static void find_flux(hl_pool *pool, lines_job *job, float *flux) {
  if (flux == NULL) return;
  job->mean = flux;
  hl_pool_run(pool, SCATTER_LINES, flux_line, job);
  hl_pool_run(pool, (size_t)job->nodes->count[2], sum_flux, job);
}

void hl_scatter_enter(hl_pool *pool, const scatter_nodes *nodes, const float *extinction,
                      const scatter_inflow *inflow, scatter_work *work, float *scratch, float *light,
                      float *flux) {
  lines_job job = {.nodes = nodes, .extinction = extinction, .work = work, .inflow = inflow};
  memset(scratch, 0, hl_scatter_node_count(nodes) * sizeof *scratch);
  spread(pool, &job, scratch, light);
  hl_scatter_continue(nodes, extinction, work, light);
  find_flux(pool, &job, flux);
}

void hl_scatter_solve(hl_pool *pool, const scatter_nodes *nodes, const float *extinction,
                      const float *scattering, const float *direct, const scatter_inflow *inflow,
                      scatter_work *work, float *light, float *flux) {
  size_t count = hl_scatter_node_count(nodes);
  float *root = work->vectors[0], *sent = work->vectors[3], *rest = work->vectors[2],
        *right = work->vectors[4];
  lines_job job = {.nodes = nodes, .extinction = extinction, .work = work};
  for (size_t n = 0; n < count; n++) root[n] = sqrtf(scattering[n]), sent[n] = scattering[n] * direct[n];
  job.inflow = inflow;
  /* `rest` becomes G D b + E: the light that was scattered once, plus the light that enters */
  spread(pool, &job, sent, rest);
  job.inflow = NULL;
  for (size_t n = 0; n < count; n++) right[n] = root[n] * rest[n];
  solve_symmetric(pool, &job, root, right, light);
  for (size_t n = 0; n < count; n++) sent[n] = scattering[n] * direct[n] + root[n] * light[n];
  job.inflow = inflow;
  spread(pool, &job, sent, light);
  hl_scatter_continue(nodes, extinction, work, light);
  find_flux(pool, &job, flux);
}
