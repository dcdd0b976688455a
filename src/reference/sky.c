/* reference/sky.c - computes the sky's light at a sample. The sky is light from all directions, and is
 * integrated over cells of equal solid angle.
 *
 * The sky's sphere, or its upper hemisphere, is cut into rings about the axis `up`. Each ring is cut into
 * cells with sides of nearly equal length. A cell has the mean radiance of its directions. A single ray to
 * the cell's middle finds the shadow for the whole cell. If the sky is an image, the ray goes to the middle
 * of the light in the cell. The cosine between a surface's normal and the mean of the cell's directions
 * stands for the whole cell. This cosine is the exact mean over the cell, unless a part of the cell is below
 * the surface's horizon. */
#include "core/memory.h"
#include "elementary/elementary.h"
#include "reference/reference.h"

/* An image is sampled PIXEL_SAMPLES times along each side of its pixels, but no more than MOST_SAMPLES times
 * along each side of a cell. */
enum { PIXEL_SAMPLES = 3, MOST_SAMPLES = 256 };

/* A ring of cells. Heights are cosines of the angle to the axis `up`. */
typedef struct sky_ring {
  double low, high; /* heights of the ring's lower and upper border */
  size_t cells;
  double turn; /* angle at which the ring's first cell begins, as a fraction of the full circle */
} sky_ring;

static vec3 direction_of(const sky_axes *axes, double height, double turn) {
  double side = sqrt(fmax(1 - height * height, 0));
  vec3 level = vec3_add(vec3_scale(axes->middle, side * hl_cos(2 * HL_PI * turn)),
                        vec3_scale(axes->right, side * hl_sin(2 * HL_PI * turn)));
  return vec3_add(level, vec3_scale(axes->up, height));
}

/* Finds the mean of the radiance over a cell that begins at the angle `turn`, and the mean of the cell's
 * directions. If the sky is an image, each direction is weighted by its brightness. So the light of a sun in
 * the cell comes from the sun's own direction. */
static void find_means(const hl_sky *sky, const sky_axes *axes, const sky_ring *ring, double turn,
                       reference_sky_cell *cell) {
  double wide = sky->type == HL_SKY_IMAGE ? ceil(PIXEL_SAMPLES * (double)sky->width / (double)ring->cells)
                                          : 4;
  double high = sky->type == HL_SKY_IMAGE ? ceil(PIXEL_SAMPLES * (ring->high - ring->low) * sky->height) : 4;
  size_t columns = (size_t)fmin(wide, MOST_SAMPLES), rows = (size_t)fmin(high, MOST_SAMPLES);
  vec3 sum = {0, 0, 0}, bright = {0, 0, 0};
  double samples = (double)columns * (double)rows, brightness = 0;
  for (size_t i = 0; i < rows; i++)
    for (size_t j = 0; j < columns; j++) {
      double height = ring->low + (ring->high - ring->low) * ((double)i + 0.5) / (double)rows, radiance[3];
      double at = turn + ((double)j + 0.5) / (double)(columns * ring->cells);
      vec3 direction = direction_of(axes, height, at);
      hl_sky_radiance(sky, axes, direction, radiance);
      sum = vec3_add(sum, direction);
      double here = radiance[0] + radiance[1] + radiance[2];
      bright = vec3_add(bright, vec3_scale(direction, here));
      brightness += here;
      for (int c = 0; c < 3; c++) cell->radiance[c] += radiance[c] / samples;
    }
  bool weighed = sky->type == HL_SKY_IMAGE && brightness > 0;
  cell->mean = weighed ? vec3_scale(bright, 1 / brightness) : vec3_scale(sum, 1 / samples);
}

/* The number of cells in ring i. Rings are `angle` high, and cells are about as wide as high. */
static size_t cells_in_ring(size_t i, double angle) {
  double middle = ((double)i + 0.5) * angle;
  return (size_t)fmax(floor(2 * HL_PI * hl_sin(middle) / angle + 0.5), 3);
}

hl_status hl_reference_sky_create(reference *all, int cell_count, hl_error *error) {
  const hl_sky *sky = &all->scene->sky;
  if (sky->type == HL_SKY_NONE) return HL_OK;
  double least = sky->hemisphere ? 0 : -1, widest = sky->hemisphere ? HL_PI / 2 : HL_PI;
  /* derived: all cells together cover the solid angle 2 pi (1 - least); a cell whose sides are the angle a
   * covers a^2 */
  double angle = sqrt(2 * HL_PI * (1 - least) / cell_count);
  size_t rings = (size_t)fmax(floor(widest / angle + 0.5), 1), count = 0;
  angle = widest / (double)rings;
  for (size_t i = 0; i < rings; i++) count += cells_in_ring(i, angle);
  all->sky.cells = hl_allocate_zeroed(all->context, count, sizeof *all->sky.cells);
  if (all->sky.cells == NULL)
    return hl_fail_memory(error, count * sizeof *all->sky.cells, "the cells of the sky");
  all->sky.count = count;
  all->sky.solid_angle = 2 * HL_PI * (1 - least) / (double)count;
  const sky_axes axes = hl_sky_axes(sky);
  reference_sky_cell *cell = all->sky.cells;
  double height = 1, taken = (1 - least) / (double)count;
  for (size_t i = 0; i < rings; i++) {
    sky_ring ring = {.high = height, .cells = cells_in_ring(i, angle)};
    ring.low = height - taken * (double)ring.cells;
    ring.turn = (double)i * (sqrt(5) - 1) / 2; /* no two rings begin at the same angle */
    for (size_t j = 0; j < ring.cells; j++, cell++) {
      double turn = ring.turn + (double)j / (double)ring.cells;
      find_means(sky, &axes, &ring, turn, cell);
      cell->direction = vec3_normalise(cell->mean);
    }
    height = ring.low;
  }
  return HL_OK;
}

/* Applies eqs. (3) and (4) to the light of each cell. A surface receives diffuse / pi times radiance, cosine
 * and solid angle. A medium receives 1 / (4 pi) times radiance, p and solid angle. p is the phase function
 * times 4 pi. */
void hl_reference_sky_arrive(const reference *all, const reference_sky_receiver *at, reference_worker *worker,
                             reference_sky_light *light) {
  *light = (reference_sky_light){{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  for (size_t i = 0; i < all->sky.count && !hl_pool_stops(all->pool, worker->number); i++) {
    const reference_sky_cell *cell = &all->sky.cells[i];
    double cosine = fmax(vec3_dot(at->normal, cell->mean), 0) * at->surface * at->diffuse / HL_PI;
    double scattered = (1 - at->surface) / (4 * HL_PI) *
                       hl_reference_phase(at->anisotropy, at->to_eye, cell->direction);
    double weight = (cosine + scattered) * all->sky.solid_angle, passing[3] = {1, 1, 1};
    if (weight <= 0) continue;
    const reference_ray ray = {.origin = at->point, .direction = cell->direction, .farthest = INFINITY};
    if (at->receives_shadow) hl_reference_transmittance(all, &ray, worker->shadow, passing);
    for (int c = 0; c < 3; c++) {
      light->open[c] += weight * cell->radiance[c];
      light->reaching[c] += weight * cell->radiance[c] * passing[c];
      double albedo = at->albedo != NULL ? at->albedo[c] : 1;
      light->sent[c] += (cosine + albedo * scattered) * all->sky.solid_angle * cell->radiance[c] * passing[c];
    }
  }
}
