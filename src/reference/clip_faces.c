/* reference/clip_faces.c - finds the faces of a volume's box at which the volume's matter is cut off. The box
 * ends at the grid's border or at the clip box. */
#include <math.h>

#include "reference/reference.h"

static const double TOUCHING = 1e-3; /* greatest distance, in voxels, of two faces that touch */

/* Finds the bounds, in this volume's index space, of another volume's box. */
static void bounds_of(const hl_scene_volume *other, affine3 world_to_index, double low[3], double high[3]) {
  affine3 placement = affine3_multiply(world_to_index, hl_scene_volume_index_to_world(other));
  double box[2][3];
  hl_scene_volume_box(other, box[0], box[1]);
  for (int a = 0; a < 3; a++) low[a] = INFINITY, high[a] = -INFINITY;
  for (int c = 0; c < 8; c++) {
    vec3 p = affine3_apply(placement, (vec3){box[c & 1][0], box[c >> 1 & 1][1], box[c >> 2][2]});
    const double corner[3] = {p.x, p.y, p.z};
    for (int a = 0; a < 3; a++) low[a] = fmin(low[a], corner[a]), high[a] = fmax(high[a], corner[a]);
  }
}

/* Removes from a volume's clip faces the faces of its box that touch the other volume's box. Beyond these
 * faces, matter goes on in the other volume. */
static void join(const hl_scene_volume *other, reference_volume *volume) {
  double low[3], high[3];
  bounds_of(other, volume->world_to_index, low, high);
  for (int a = 0; a < 3; a++) {
    bool beside = false;
    for (int n = 1; n < 3; n++) {
      int b = (a + n) % 3;
      beside = beside || low[b] > volume->high[b] - TOUCHING || high[b] < volume->low[b] + TOUCHING;
    }
    if (!beside && fabs(high[a] - volume->low[a]) < TOUCHING) volume->clip_low[a] = -INFINITY;
    if (!beside && fabs(low[a] - volume->high[a]) < TOUCHING) volume->clip_high[a] = INFINITY;
  }
}

void hl_reference_find_clip_faces(const hl_scene_description *scene, reference_volume *volume) {
  for (int a = 0; a < 3; a++) {
    bool faces = volume->described->cut_shading != HL_CUT_SHADING_GRADIENT;
    volume->clip_low[a] = faces ? volume->low[a] : -INFINITY;
    volume->clip_high[a] = faces ? volume->high[a] : INFINITY;
  }
  for (size_t i = 0; i < scene->volume_count; i++)
    if (&scene->volumes[i] != volume->described && scene->volumes[i].casts_shadow)
      join(&scene->volumes[i], volume);
}

double hl_reference_leaves_box(const reference_volume *volume, vec3 point, vec3 direction, vec3 *outward) {
  const double p[3] = {point.x, point.y, point.z}, along[3] = {direction.x, direction.y, direction.z};
  double least = INFINITY;
  bool open = false;
  for (int a = 0; a < 3; a++) {
    if (along[a] == 0) continue;
    const bool rising = along[a] > 0;
    const double way = fmax(((rising ? volume->high[a] : volume->low[a]) - p[a]) / along[a], 0);
    if (!(way < least)) continue;
    const vec3 rise = mat3_apply(volume->gradient_to_world, (vec3){a == 0, a == 1, a == 2});
    least = way;
    *outward = vec3_scale(vec3_normalise(rise), rising ? 1 : -1);
    open = isinf(rising ? volume->clip_high[a] : volume->clip_low[a]);
  }
  return open ? -least : least;
}
