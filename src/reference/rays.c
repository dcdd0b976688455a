/* reference/rays.c - finds how many rays a pixel needs, so that a small picture of a large volume is right.
 *
 * In: the scene and the boxes of its volumes' visible bricks. Out: the number of rays along each side of a
 * pixel. Where voxels are smaller than pixels, the renderer averages over a pixel's area (docs/decisions.md).
 * A reference with a single ray through each pixel's centre would make a different picture. */
#include "elementary/elementary.h"
#include "reference/reference.h"

/* SURFACE_RAYS: the number of rays along each side of a pixel in scenes with meshes, so that the meshes'
 * edges are smooth. */
enum { BRICK_CELLS = 4, LONGEST_SIDE = 4096, SURFACE_RAYS = 4 };

/* Finds the box, in index space, around the visible bricks within the volume's box. Bricks at the grid's
 * borders reach half a voxel beyond the outermost voxels. Returns false if no brick is visible. */
static bool shown_box(const reference_volume *volume, double low[3], double high[3]) {
  const unsigned char *clear = volume->clearance;
  size_t brick[3];
  bool any = false;
  for (brick[2] = 0; brick[2] < volume->bricks[2]; brick[2]++)
    for (brick[1] = 0; brick[1] < volume->bricks[1]; brick[1]++)
      for (brick[0] = 0; brick[0] < volume->bricks[0]; brick[0]++) {
        bool shown = *clear++ == 0;
        double from[3], to[3];
        for (int axis = 0; axis < 3; axis++) {
          from[axis] = (double)(BRICK_CELLS * brick[axis]) - 1;
          to[axis] = from[axis] + BRICK_CELLS;
          shown = shown && to[axis] + 1 >= volume->low[axis] && from[axis] - 1 <= volume->high[axis];
        }
        for (int axis = 0; axis < 3 && shown; axis++) {
          double last = (double)volume->grid->dimension[axis];
          if (brick[axis] == 0) from[axis] -= 0.5;
          if (to[axis] >= last - 1) to[axis] = last;
          low[axis] = any ? fmin(low[axis], from[axis]) : from[axis];
          high[axis] = any ? fmax(high[axis], to[axis]) : to[axis];
        }
        any = any || shown;
      }
  return any;
}

/* Sums over the corners, in the world, of the boxes around all volumes' visible bricks: the sum of the
 * corners' positions, the depth of the nearest corner, and the number of corners. */
typedef struct content {
  vec3 sum;
  double nearest;
  int corners;
} content;

static void add_volume(const reference_volume *volume, vec3 position, vec3 forward, content *all) {
  double low[3], high[3];
  if (!shown_box(volume, low, high)) return;
  affine3 to_world = hl_scene_volume_index_to_world(volume->described);
  for (int corner = 0; corner < 8; corner++) {
    vec3 at = affine3_apply(to_world, (vec3){corner & 1 ? high[0] : low[0], corner & 2 ? high[1] : low[1],
                                             corner & 4 ? high[2] : low[2]});
    all->sum = vec3_add(all->sum, at);
    all->nearest = fmin(all->nearest, vec3_dot(forward, vec3_subtract(at, position)));
    all->corners++;
  }
}

/* The length of a pixel's edge in the world at the depth 1; for an orthographic camera, at any depth.
 * Derived: the length is the picture's height in the world divided by the number of rows. At the depth 1, the
 * height of a perspective picture is 2 tan(fovy / 2). */
static double pixel_edge(const hl_scene_description *scene) {
  bool orthographic = scene->camera.type == HL_CAMERA_ORTHOGRAPHIC;
  return (orthographic ? scene->camera.height : 2 * hl_tan(scene->camera.fovy_deg * HL_PI / 360)) /
         scene->height;
}

int hl_reference_rays(const reference *all, double edge) {
  const hl_scene_description *scene = all->scene;
  vec3 position = vec3_of(scene->camera.position),
       forward = vec3_normalise(vec3_subtract(vec3_of(scene->camera.target), position));
  content shown = {.nearest = INFINITY};
  for (size_t v = 0; v < scene->volume_count; v++) add_volume(&all->volumes[v], position, forward, &shown);
  if (shown.corners == 0) return scene->mesh_count > 0 ? SURFACE_RAYS : 1;
  vec3 middle = vec3_scale(shown.sum, 1.0 / shown.corners);
  double depth = vec3_dot(forward, vec3_subtract(middle, position)),
         longer = fmax(scene->width, scene->height);
  if (scene->camera.type == HL_CAMERA_ORTHOGRAPHIC) depth = 1;
  else depth = fmax(depth, shown.nearest);
  double most = fmin(HL_REFERENCE_RAYS, floor(LONGEST_SIDE / longer));
  double least = scene->mesh_count > 0 ? SURFACE_RAYS : 1;
  return (int)fmax(fmin(floor(pixel_edge(scene) * depth / edge + 0.5), most), least);
}
