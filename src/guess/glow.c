/* guess/glow.c - see glow.h.
 *
 * Light that was not scattered is followed from each cell to each light source. Light that was scattered is
 * taken to be diffuse. Its mean over all directions, J, obeys
 *
 *     div (grad J / (3 e)) = (e - s) J - s I,
 *
 * with the extinction e, the scattering s and the unscattered light I (Ishimaru, "Wave propagation and
 * scattering in random media", 1978, chapter 9). At the border of the box, J - 2 / (3 e) dJ/dn is the sky's
 * light (Marshak's condition; n points inwards). A medium that scatters light onwards is replaced by one that
 * scatters it evenly, as in scatter/scatter.h. */
#include "guess/glow.h"

#include <math.h>

#include "core/memory.h"
#include "elementary/elementary.h"

/* LONGEST: the number of cells along the box's longest side. SUBDIVIDED: the number of places along each side
 * of a cell at which matter is looked up. SWEEPS: the number of times that all cells are relaxed. */
enum { LONGEST = 24, SUBDIVIDED = 3, SWEEPS = 150 };

/* Successive over-relaxation changes a cell by this multiple of the change that solves its own equation. */
#define RELAXATION 1.7

/* The grid while it is made. Each array is [count[2]][count[1]][count[0]]. */
typedef struct glow_grid {
  const hl_glow_request *request;
  hl_glow *glow;
  double edge[3];      /* the edges of a cell, world units */
  double *extinction;  /* owned; per world unit */
  double *scattering;  /* owned; per world unit */
  double *unscattered; /* owned */
  double thinnest;     /* the extinction that stands for empty cells, low enough for light to cross the whole
                        * box */
} glow_grid;

static size_t cell_of(const hl_glow *glow, int i, int j, int k) {
  return ((size_t)k * (size_t)glow->count[1] + (size_t)j) * (size_t)glow->count[0] + (size_t)i;
}

static void lay_out(glow_grid *grid) {
  const hl_glow_request *request = grid->request;
  hl_glow *glow = grid->glow;
  double side[3], longest = 0;
  for (int a = 0; a < 3; a++) {
    side[a] = (request->high[a] - request->low[a]) *
              vec3_length(mat3_column(request->index_to_world.linear, a));
    longest = fmax(longest, side[a]);
  }
  for (int a = 0; a < 3; a++) {
    glow->count[a] = (int)fmax(1, ceil(LONGEST * side[a] / longest));
    glow->low[a] = request->low[a];
    glow->size[a] = (request->high[a] - request->low[a]) / glow->count[a];
    grid->edge[a] = side[a] / glow->count[a];
  }
  grid->thinnest = 1 / longest;
}

/* Sets the matter of a cell to the mean over places that are evenly distributed in it. */
static void fill_cell(glow_grid *grid, const int at[3]) {
  const hl_glow_request *request = grid->request;
  const hl_glow *glow = grid->glow;
  const size_t cell = cell_of(glow, at[0], at[1], at[2]);
  enum { PLACES = SUBDIVIDED * SUBDIVIDED * SUBDIVIDED };
  double extinction = 0, scattering = 0;
  for (int n = 0; n < PLACES; n++) {
    const int part[3] = {n % SUBDIVIDED, n / SUBDIVIDED % SUBDIVIDED, n / SUBDIVIDED / SUBDIVIDED};
    double place[3];
    for (int a = 0; a < 3; a++)
      place[a] = glow->low[a] + glow->size[a] * (at[a] + (part[a] + 0.5) / SUBDIVIDED);
    const hl_glow_matter matter = request->matter(request->data, vec3_of(place));
    extinction += matter.extinction / PLACES;
    scattering += matter.scattering / PLACES;
  }
  const double onwards = request->anisotropy * scattering;
  grid->extinction[cell] = extinction - onwards;
  grid->scattering[cell] = scattering - onwards;
}

/* The light of all lamps that reaches the centre of a cell without being scattered. */
static double find_unscattered(const glow_grid *grid, const int at[3]) {
  const hl_glow_request *request = grid->request;
  const hl_glow *glow = grid->glow;
  double light = 0;
  affine3 to_index;
  if (!affine3_invert(request->index_to_world, &to_index)) return 0;
  for (size_t l = 0; l < request->light_count; l++) {
    const vec3 way = mat3_apply(to_index.linear, request->towards[l]);
    double direction[3] = {way.x / glow->size[0], way.y / glow->size[1], way.z / glow->size[2]}, most = 0;
    for (int a = 0; a < 3; a++) most = fmax(most, fabs(direction[a]));
    /* a step is half a cell long along the axis along which most cells are crossed */
    const double step = 0.5 / most;
    double depth = 0, place[3] = {at[0] + 0.5, at[1] + 0.5, at[2] + 0.5};
    for (;;) {
      int cell[3];
      bool within = true;
      for (int a = 0; a < 3; a++) {
        cell[a] = (int)floor(place[a]);
        within &= cell[a] >= 0 && cell[a] < glow->count[a];
        place[a] += step * direction[a];
      }
      if (!within) break;
      depth += step * grid->extinction[cell_of(glow, cell[0], cell[1], cell[2])];
    }
    light += request->strength[l] * hl_exp(-depth);
  }
  return light;
}

/* Brings the light of a cell closer to the equation's solution. */
static void relax_cell(glow_grid *grid, const int at[3]) {
  hl_glow *glow = grid->glow;
  const size_t cell = cell_of(glow, at[0], at[1], at[2]),
               stride[3] = {1, (size_t)glow->count[0], (size_t)glow->count[0] * (size_t)glow->count[1]};
  const double own = fmax(grid->extinction[cell], grid->thinnest);
  double inflow = grid->scattering[cell] * grid->unscattered[cell],
         loss = grid->extinction[cell] - grid->scattering[cell];
  for (int side = 0; side < 6; side++) {
    const int axis = side / 2, onwards = side % 2;
    const double edge = grid->edge[axis];
    const bool border = onwards ? at[axis] + 1 == glow->count[axis] : at[axis] == 0;
    double other = grid->request->sky, conductance;
    if (border) {
      conductance = 1 / (3 * own * edge * (0.5 * edge + 2 / (3 * own)));
    } else {
      const size_t beside = onwards ? cell + stride[axis] : cell - stride[axis];
      conductance = 2 / (3 * edge * edge * (own + fmax(grid->extinction[beside], grid->thinnest)));
      other = glow->light[beside];
    }
    inflow += conductance * other;
    loss += conductance;
  }
  glow->light[cell] += RELAXATION * (inflow / loss - glow->light[cell]);
}

static void for_each_cell(glow_grid *grid, void (*call)(glow_grid *grid, const int at[3])) {
  const int *count = grid->glow->count;
  for (int k = 0; k < count[2]; k++)
    for (int j = 0; j < count[1]; j++)
      for (int i = 0; i < count[0]; i++) call(grid, (const int[3]){i, j, k});
}

static void light_cell(glow_grid *grid, const int at[3]) {
  grid->unscattered[cell_of(grid->glow, at[0], at[1], at[2])] = find_unscattered(grid, at);
}

hl_status hl_glow_make(hl_context *context, const hl_glow_request *request, hl_glow *glow, hl_error *error) {
  glow_grid grid = {.request = request, .glow = glow};
  *glow = (hl_glow){.light = NULL};
  lay_out(&grid);
  const size_t cells = (size_t)glow->count[0] * (size_t)glow->count[1] * (size_t)glow->count[2];
  glow->light = hl_allocate_zeroed(context, cells, sizeof *glow->light);
  grid.extinction = hl_allocate(context, cells, sizeof *grid.extinction);
  grid.scattering = hl_allocate(context, cells, sizeof *grid.scattering);
  grid.unscattered = hl_allocate(context, cells, sizeof *grid.unscattered);
  hl_status status = HL_OK;
  if (glow->light == NULL || grid.extinction == NULL || grid.scattering == NULL || grid.unscattered == NULL)
    status = hl_fail_memory(error, cells * sizeof *glow->light, "scattered light");
  if (status == HL_OK) {
    for_each_cell(&grid, fill_cell);
    for_each_cell(&grid, light_cell);
    for (int sweep = 0; sweep < SWEEPS; sweep++) for_each_cell(&grid, relax_cell);
  }
  hl_release(context, grid.extinction);
  hl_release(context, grid.scattering);
  hl_release(context, grid.unscattered);
  return status;
}

void hl_glow_release(hl_context *context, hl_glow *glow) {
  hl_release(context, glow->light);
  glow->light = NULL;
}

double hl_glow_at(const hl_glow *glow, vec3 place) {
  const double at[3] = {place.x, place.y, place.z};
  int first[3];
  double part[3], light = 0;
  for (int a = 0; a < 3; a++) {
    const double cell = fmin(fmax((at[a] - glow->low[a]) / glow->size[a] - 0.5, 0), glow->count[a] - 1);
    first[a] = (int)fmin(floor(cell), fmax(glow->count[a] - 2, 0));
    part[a] = cell - first[a];
  }
  for (int n = 0; n < 8; n++) {
    const int beside[3] = {n % 2, n / 2 % 2, n / 4};
    int cell[3];
    double weight = 1;
    for (int a = 0; a < 3; a++) {
      weight *= beside[a] ? part[a] : 1 - part[a];
      cell[a] = (int)fmin(first[a] + beside[a], glow->count[a] - 1);
    }
    if (weight > 0) light += weight * glow->light[cell_of(glow, cell[0], cell[1], cell[2])];
  }
  return light;
}
