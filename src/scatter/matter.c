/* scatter/matter.c - finds extinction and scattering at the nodes: means over the boxes around the nodes. */
#include "scatter/parts.h"

#include <math.h>
#include <string.h>

#include "grid/field.h"

/* The greatest number of samples along an edge of a node's box. */
enum { MOST_SAMPLES = 4 };

typedef struct matter_job {
  const scatter_scene *scene;
  const scatter_nodes *nodes;
  scatter_arrays *arrays;
  size_t node_count;
} matter_job;

static bool is_relevant(const grid *grid, const double p[3]) {
  int32_t brick[3];
  for (int a = 0; a < 3; a++) {
    if (!(p[a] >= grid->box_low[a] && p[a] <= grid->box_high[a])) return false;
    double cell = fmin(fmax(floor(p[a]) + 1, 0), HL_BRICK_CELLS * grid->brick_count[a] - 1);
    brick[a] = (int32_t)cell / HL_BRICK_CELLS;
  }
  return grid->relevant[hl_brick_index(grid, brick)] != 0 &&
         (grid->cut_casts_shadow || hl_cuts_leave(grid->cuts, grid->cut_count, vec3_of(p)));
}

/* The value of a volume at a point of index space, linear along each axis between the voxels around the
 * point. */
static float value_between(const grid *grid, const double p[3]) {
  const int32_t first[3] = {(int32_t)floor(p[0]), (int32_t)floor(p[1]), (int32_t)floor(p[2])};
  double voxels[8];
  float value = 0;
  hl_field_window(grid, first, (const int32_t[3]){2, 2, 2}, voxels);
  for (int corner = 0; corner < 8; corner++) {
    float weight = 1;
    for (int a = 0; a < 3; a++) {
      const double part = p[a] - first[a];
      weight *= (float)(corner >> a & 1 ? part : 1 - part);
    }
    if (weight > 0) value += weight * (float)voxels[corner];
  }
  return value;
}

/* The gradient's length at a point of index space, in stored units per frame unit. Differences are taken over
 * the distance of a voxel. */
static double gradient_at(const scatter_volume *volume, const double p[3]) {
  vec3 gradient = {0, 0, 0};
  for (int a = 0; a < 3; a++) {
    double before[3] = {p[0], p[1], p[2]}, after[3] = {p[0], p[1], p[2]};
    before[a] -= 0.5;
    after[a] += 0.5;
    double slope = (double)value_between(volume->grid, after) - (double)value_between(volume->grid, before);
    gradient = vec3_add(gradient, vec3_scale(volume->grid->frame_to_index.linear.row[a], slope));
  }
  return vec3_length(gradient);
}

/* The factor by which gradient opacity multiplies extinction where the gradient has a given length. */
static float gradient_factor(const classifier *classifier, double length) {
  double x = fmin(length * (double)classifier->steepness_scale, STEEPNESS_ENTRIES);
  size_t low = (size_t)x;
  return classifier->steepness[low] +
         (float)(x - (double)low) * (classifier->steepness[low + 1] - classifier->steepness[low]);
}

/* The extinction of a volume at a point of frame space, and the colour there. The extinction is 0 where the
 * volume shows nothing. */
static float extinction_at(const scatter_volume *volume, vec3 point, float color[3]) {
  const classifier *classifier = volume->classifier;
  vec3 index = affine3_apply(volume->grid->frame_to_index, point);
  const double p[3] = {index.x, index.y, index.z};
  if (!is_relevant(volume->grid, p)) return 0;
  float density = value_between(volume->grid, p) - volume->grid->empty;
  float entry = density * classifier->scale + classifier->offset;
  if (!(entry > 0)) entry = 0;
  if (entry > CLASSIFIER_ENTRIES) entry = CLASSIFIER_ENTRIES;
  size_t low = (size_t)entry;
  float f = entry - (float)low;
  for (int c = 0; c < 3; c++)
    color[c] = classifier->color[low][c] + f * (classifier->color[low + 1][c] - classifier->color[low][c]);
  float found = classifier->sums[low][0] + f * (classifier->sums[low + 1][0] - classifier->sums[low][0]);
  if (!(found > 0)) return found;
  const float at[3] = {(float)point.x, (float)point.y, (float)point.z};
  double length = hl_classifier_needs_gradient(classifier) ? gradient_at(volume, p) : 0;
  if (classifier->plane.sums != NULL) {
    float second = classifier->plane.second != NULL ? hl_plane_second_at(&classifier->plane, at)
                                                    : (float)length;
    plane_point of_two = hl_plane_table_at(&classifier->plane, entry, second);
    memcpy(color, of_two.color, sizeof of_two.color);
    found = of_two.extinction;
  }
  if (classifier->steepness != NULL) found *= gradient_factor(classifier, length);
  if (classifier->mask.factors == NULL) return found;
  hl_mask_tint(&classifier->mask, at, color);
  return found * hl_mask_factor(&classifier->mask, at);
}

/* Sums over the samples in a node's box: extinction and scattering of the medium that scatters evenly, and
 * the extinction (own) of the real medium. */
typedef struct matter {
  float extinction[3], scattering[3], own[3];
} matter;

/* Adds a volume's matter at a point to the sums, times a weight. Converts it to the evenly scattering medium
 * by the similarity in scatter.h. */
static void add_volume(const scatter_volume *volume, vec3 point, float weight, matter *sum) {
  const hl_scene_volume *scene = volume->scene;
  float color[3], found = extinction_at(volume, point, color);
  if (!(found > 0)) return;
  for (int c = 0; c < 3; c++) {
    float taken = weight * found * (float)scene->attenuation_color[c];
    float scattered = scene->multiple_scattering ? taken * color[c] * (float)scene->albedo[c] : 0;
    sum->extinction[c] += taken - scattered * (float)scene->anisotropy;
    sum->scattering[c] += scattered - scattered * (float)scene->anisotropy;
    sum->own[c] += taken;
  }
}

/* The number of samples along an edge of a node's box, so that samples are about as close together as a
 * volume's voxels. */
static int samples_of(const scatter_volume *volume, float spacing) {
  double voxel = mat3_shortest_column(volume->grid->index_to_frame.linear);
  return (int)fmin(fmax(ceil(spacing / voxel), 1), MOST_SAMPLES);
}

static void fill_node(const matter_job *job, const int32_t at[3], size_t node) {
  matter sum = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  float spacing = job->nodes->spacing;
  for (size_t v = 0; v < job->scene->scene->volume_count; v++) {
    const scatter_volume *volume = &job->scene->volumes[v];
    if (!volume->scene->casts_shadow || volume->grid->relevant_count == 0) continue;
    int side = samples_of(volume, spacing);
    float weight = 1 / (float)(side * side * side);
    for (int s = 0; s < side * side * side; s++) {
      const int of[3] = {s % side, s / side % side, s / side / side};
      double p[3];
      for (int a = 0; a < 3; a++)
        p[a] = job->nodes->origin[a] + spacing * (at[a] + (of[a] + 0.5) / side - 0.5);
      add_volume(volume, vec3_of(p), weight, &sum);
    }
  }
  for (int c = 0; c < 3; c++) {
    size_t to = (size_t)c * job->node_count + node;
    job->arrays->extinction[to] = sum.extinction[c];
    job->arrays->scattering[to] = sum.scattering[c];
    if (job->arrays->own != job->arrays->extinction) job->arrays->own[to] = sum.own[c];
  }
}

/* Fills the extinction and the scattering of one slice of nodes. */
static void fill_slice(void *data, size_t z, int worker) {
  (void)worker;
  const matter_job *job = data;
  const int32_t *count = job->nodes->count;
  for (int32_t y = 0; y < count[1]; y++)
    for (int32_t x = 0; x < count[0]; x++) {
      const int32_t at[3] = {x, y, (int32_t)z};
      fill_node(job, at, (z * (size_t)count[1] + (size_t)y) * (size_t)count[0] + (size_t)x);
    }
}

void hl_scatter_fill_matter(const scatter_scene *scene, const scatter_nodes *nodes, scatter_arrays *arrays) {
  matter_job job = {scene, nodes, arrays, hl_scatter_node_count(nodes)};
  hl_pool_run(scene->pool, (size_t)nodes->count[2], fill_slice, &job);
  size_t bytes = job.node_count * sizeof(float);
  bool grey = true;
  for (int c = 1; c < 3; c++)
    grey = grey && memcmp(arrays->extinction, arrays->extinction + (size_t)c * job.node_count, bytes) == 0 &&
           memcmp(arrays->scattering, arrays->scattering + (size_t)c * job.node_count, bytes) == 0;
  arrays->channels = grey ? 1 : 3;
}
