/* compose/box_outline.c - makes the wires of "outline": the twelve edges of the box of voxels of each volume.
 *
 * The box holds all voxels of the file, also the voxels that cuts and clip boxes remove, so that the wires
 * show where something was cut away. */
#include "compose/composer.h"
#include "core/context.h"
#include "core/memory.h"
#include "scene/geometry/placement.h"

enum { CORNERS = 8, EDGES = 12 };

/* The radius of the wires, as a part of the box's diagonal: at 512 pixels a wire is nearly two pixels wide.
 */
static const double thickness = 1 / 600.0;

/* Finds the corners of a volume's box in the world. Corner n lies at the upper end of each axis whose bit is
 * set in n.
 */
static void find_corners(const hl_scene_volume *volume, vec3 corners[CORNERS]) {
  double ends[2][3];
  hl_scene_volume whole = *volume;
  whole.clipped = 0;
  hl_scene_volume_box(&whole, ends[0], ends[1]);
  for (int n = 0; n < CORNERS; n++)
    corners[n] = affine3_apply(hl_scene_volume_index_to_world(volume),
                               (vec3){ends[n & 1][0], ends[n >> 1 & 1][1], ends[n >> 2 & 1][2]});
}

static void store(vec3 point, double radius, float stored[4]) {
  vec3_store(stored, point);
  stored[3] = (float)radius;
}

/* Adds the edges of a box as lines of two points, and its corners as spheres. */
static void add_box(const vec3 corners[CORNERS], float (*points)[4], float (*spheres)[4]) {
  const double radius = thickness * vec3_length(vec3_subtract(corners[CORNERS - 1], corners[0]));
  for (int n = 0; n < CORNERS; n++) {
    store(corners[n], radius, *spheres++);
    for (int axis = 0; axis < 3; axis++)
      if ((n >> axis & 1) == 0) {
        store(corners[n], radius, *points++);
        store(corners[n | 1 << axis], radius, *points++);
      }
  }
}

hl_status hl_make_box_outline(const hl_composer *composer, const hl_scene_description *description,
                              hl_mesh **mesh) {
  hl_context *context = composer->context;
  const size_t boxes = description->volume_count;
  float(*points)[4] = hl_allocate(context, boxes * 2 * EDGES, sizeof *points);
  float(*spheres)[4] = hl_allocate(context, boxes * CORNERS, sizeof *spheres);
  uint32_t *lengths = hl_allocate(context, boxes * EDGES, sizeof *lengths);
  hl_status status = HL_OK;
  if (points == NULL || spheres == NULL || lengths == NULL) {
    status = hl_fail_memory(composer->error, boxes * 2 * EDGES * sizeof *points, "the outline");
  } else {
    for (size_t v = 0; v < boxes; v++) {
      vec3 corners[CORNERS];
      find_corners(&description->volumes[v], corners);
      add_box(corners, points + v * 2 * EDGES, spheres + v * CORNERS);
    }
    for (size_t n = 0; n < boxes * EDGES; n++) lengths[n] = 2;
    hl_mesh_description wires;
    hl_mesh_description_defaults(&wires);
    wires.line_points = (const float(*)[4])points;
    wires.line_point_count = boxes * 2 * EDGES;
    wires.line_lengths = lengths;
    wires.line_count = boxes * EDGES;
    wires.spheres = (const float(*)[4])spheres;
    wires.sphere_count = boxes * CORNERS;
    status = hl_mesh_create(context, &wires, mesh, composer->error);
  }
  hl_release(context, points);
  hl_release(context, spheres);
  hl_release(context, lengths);
  return status;
}

void hl_box_outline_defaults(hl_scene_mesh *outline) {
  hl_scene_mesh_defaults(outline);
  outline->name = "outline";
  for (int c = 0; c < 3; c++) outline->color[c] = 0.3; /* a grey that is seen before black and before white */
  outline->material = (hl_material){.emission = 1, .shininess = outline->material.shininess};
  outline->casts_shadow = outline->receives_shadow = 0;
  outline->cut = 0;
}
