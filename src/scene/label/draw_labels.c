/* scene/label/draw_labels.c - see draw_labels.h. */
#include "scene/label/draw_labels.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "elementary/elementary.h"
#include "label/mask.h"
#include "label/shelf.h"
#include "label/solids.h"
#include "scene/check/limits.h"
#include "scene/function/transfer_function.h"
#include "scene/geometry/placement.h"
#include "volume/store/gathered.h"

/* ---- a function over the map's own values ---- */

enum { OPACITY_A_LABEL = 4, COLORS_A_LABEL = 2 };

hl_status hl_labels_function(hl_context *context, const hl_scene_volume *volume,
                             hl_transfer_function *function, hl_error *error) {
  size_t labels = volume->label_count, opacity_count = 0, color_count = 0;
  hl_opacity_point *opacity = hl_allocate(context, OPACITY_A_LABEL * labels + 1, sizeof *opacity);
  hl_color_point *color = hl_allocate(context, COLORS_A_LABEL * labels + 1, sizeof *color);
  *function = (hl_transfer_function){
      .unit_distance = mat3_shortest_column(volume->volume->index_to_world.linear),
      .opacity = opacity,
      .color = color};
  if (opacity == NULL || color == NULL) {
    hl_transfer_function_release(context, function);
    return hl_fail_memory(error, OPACITY_A_LABEL * labels * sizeof *opacity, "a transfer function");
  }
  /* The value at which the points of the previous label end, and the opacity at this value. */
  double end = -INFINITY, last = 0;
  if (labels > 0) opacity[opacity_count++] = (hl_opacity_point){(double)volume->labels[0].value - 1, 0};
  for (size_t n = 0; n < labels; n++) {
    const hl_label *label = &volume->labels[n];
    const double value = (double)label->value;
    /* voxels hold labels as floats, which round large labels. A voxel's float differs from its label by less
     * than `around` */
    const double around = fmax(0.5, fabs(value) * 0x1p-24);
    double begin = fmax(value - around, end), shown = label->visible ? label->opacity : 0;
    if (begin > end && last > 0) opacity[opacity_count++] = (hl_opacity_point){end, last};
    if (begin > end && last > 0) opacity[opacity_count++] = (hl_opacity_point){end, last = 0};
    opacity[opacity_count++] = (hl_opacity_point){begin, last};
    opacity[opacity_count++] = (hl_opacity_point){begin, shown};
    last = shown;
    end = value + around;
    for (int side = 0; side < COLORS_A_LABEL; side++) {
      hl_color_point *point = &color[color_count++];
      point->value = side == 0 ? begin : end;
      memcpy(point->color, label->color, sizeof point->color);
    }
  }
  if (last > 0) opacity[opacity_count++] = (hl_opacity_point){end, last};
  if (last > 0) opacity[opacity_count++] = (hl_opacity_point){end, 0};
  function->opacity_count = opacity_count;
  function->color_count = color_count;
  return HL_OK;
}

/* ---- the volumes that are drawn ---- */

enum { POINTS = 4 };

/* The matter of a solid label begins at the occupancy SOLID_FROM, and is whole at SOLID_TO, a sixth of a
 * voxel deeper. If a ray just touches a ball of a few voxels at the occupancy 1/2, the ray's pixel is half
 * covered. So the outlines in the picture are the outlines of the label. */
static const double SOLID_FROM = 0.48, SOLID_TO = 0.51, SOLID_OPACITY = 0.9999;
/* A translucent label is a skin between the occupancies SKIN_FROM and SKIN_TO, inside the label's surface. A
 * label that is only one voxel thick has a skin on both sides. */
static const double SKIN_FROM = 0.5, SKIN_TO = 0.7;

/* The points of the transfer function of one drawn volume. */
typedef struct drawn_points {
  hl_opacity_point opacity[POINTS];
  hl_color_point color;
} drawn_points;

/* Gives a volume of occupancy its transfer function. A skin absorbs the fraction `opacity` of the light that
 * crosses it at a right angle. Derived: a homogeneous layer whose opacity is o per unit distance u has the
 * opacity o if the layer is u thick. */
static void set_function(const hl_label *label, hl_scene_volume *drawn, drawn_points *points) {
  mat3 placed = hl_scene_volume_index_to_world(drawn).linear;
  hl_transfer_function *function = &drawn->transfer_function;
  points->color = (hl_color_point){0, {label->color[0], label->color[1], label->color[2]}};
  *function = (hl_transfer_function){.opacity = points->opacity, .color = &points->color, .color_count = 1};
  if (label->opacity >= 1) {
    points->opacity[0] = (hl_opacity_point){SOLID_FROM, 0};
    points->opacity[1] = (hl_opacity_point){SOLID_TO, SOLID_OPACITY};
    function->opacity_count = 2;
    function->unit_distance = mat3_shortest_column(placed);
    return;
  }
  const hl_opacity_point skin[POINTS] = {
      {SKIN_FROM, 0}, {SKIN_FROM, label->opacity}, {SKIN_TO, label->opacity}, {SKIN_TO, 0}};
  memcpy(points->opacity, skin, sizeof skin);
  function->opacity_count = POINTS;
  double edge = hl_cbrt(vec3_length(mat3_column(placed, 0)) * vec3_length(mat3_column(placed, 1)) *
                        vec3_length(mat3_column(placed, 2)));
  function->unit_distance = (SKIN_TO - SKIN_FROM) / drawn->volume->surface_slope * edge;
}

static bool is_drawn(const hl_label *label) { return label->visible && label->opacity > 0; }
static bool is_solid(const hl_label *label) { return label->visible && label->opacity >= 1; }
static bool is_skin(const hl_label *label) { return is_drawn(label) && !is_solid(label); }

/* The number of volumes that draw a label map. One volume draws all solid labels, and each other label has a
 * volume of its own. */
static size_t count_drawn(const hl_scene_volume *volume) {
  if (volume->label_count == 0) return 1;
  size_t skins = 0, solids = 0;
  for (size_t n = 0; n < volume->label_count; n++) {
    skins += is_skin(&volume->labels[n]);
    solids += is_solid(&volume->labels[n]);
  }
  return skins + (solids > 0);
}

/* Adds the volume that draws a label, or all solid labels. The added volume owns the occupancy from now on.
 */
static void add_drawn(hl_scene_description *placed, const hl_scene_volume *map, const hl_label *label,
                      hl_volume *occupancy, drawn_points **points) {
  if (occupancy == NULL) return;
  hl_scene_volume *drawn = (hl_scene_volume *)&placed->volumes[placed->volume_count++];
  *drawn = *map;
  drawn->volume = occupancy;
  drawn->labels = NULL;
  drawn->label_count = 0;
  set_function(label, drawn, (*points)++);
}

/* Draws all solid labels as one volume. If the labels' colours differ, the volume's voxels have these
 * colours, and the transfer function's colour is white. */
static hl_status draw_solids(hl_context *context, hl_scene_description *placed, const hl_scene_volume *map,
                             drawn_points **points, hl_error *error) {
  size_t count = 0;
  hl_volume *made = NULL;
  hl_label *solids = hl_allocate(context, map->label_count, sizeof *solids);
  if (solids == NULL) return hl_fail_memory(error, map->label_count * sizeof *solids, "labels");
  for (size_t n = 0; n < map->label_count; n++)
    if (is_solid(&map->labels[n])) solids[count++] = map->labels[n];
  hl_status status = HL_OK;
  if (count > 0)
    status = hl_label_solids(context, placed->render.threads, map->volume, solids, count, &made, error);
  if (made != NULL) {
    hl_label all = solids[0];
    for (int c = 0; c < 3 && made->colors != NULL; c++) all.color[c] = 1;
    add_drawn(placed, map, &all, made, points);
  }
  hl_release(context, solids);
  return status;
}

static hl_status draw_skins(hl_context *context, hl_scene_description *placed, const hl_scene_volume *map,
                            drawn_points **points, hl_error *error) {
  size_t count = 0;
  int64_t *values = hl_allocate(context, map->label_count, sizeof *values);
  hl_volume **made = hl_allocate(context, map->label_count, sizeof(hl_volume *));
  hl_status status = HL_OK;
  if (values == NULL || made == NULL)
    status = hl_fail_memory(error, map->label_count * sizeof *values, "labels");
  for (size_t n = 0; status == HL_OK && n < map->label_count; n++)
    if (is_skin(&map->labels[n])) values[count++] = map->labels[n].value;
  if (status == HL_OK)
    status = hl_label_occupancies(context, placed->render.threads, map->volume, values, count, NULL, made,
                                  error);
  count = 0;
  for (size_t n = 0; status == HL_OK && n < map->label_count; n++)
    if (is_skin(&map->labels[n])) add_drawn(placed, map, &map->labels[n], made[count++], points);
  hl_release(context, values);
  hl_release(context, made);
  return status;
}

/* Adds the volumes that draw a label map. */
static hl_status draw_map(hl_context *context, hl_scene_description *placed, const hl_scene_volume *map,
                          drawn_points **points, hl_error *error) {
  hl_scene_volume whole = *map;
  hl_status status = hl_volume_in_memory(map->volume, &whole.volume, error);
  if (status == HL_OK) status = draw_solids(context, placed, &whole, points, error);
  return status == HL_OK ? draw_skins(context, placed, &whole, points, error) : status;
}

/* Maximum projections ignore masks. */
static bool is_projected(const hl_scene_description *placed) {
  return placed->render.compositing == HL_COMPOSITING_MAXIMUM;
}

/* Returns whether a mask ends the volume at the walls of its mesh of cells. */
static bool has_wall(const hl_scene_description *placed, const hl_scene_volume *volume) {
  return volume->volume->wall != NULL && volume->iso_count == 0 &&
         (volume->mask.volume == NULL || is_projected(placed));
}

/* Adds a volume whose mask is replaced by the mask's lattice, or a mesh of cells whose walls become a
 * lattice. */
static hl_status draw_masked(hl_context *context, hl_scene_description *placed, const hl_scene_volume *volume,
                             hl_error *error) {
  const bool walled = has_wall(placed, volume);
  hl_volume *lattice = NULL;
  if (volume->mask.volume != NULL && !is_projected(placed)) {
    hl_mask whole = volume->mask;
    hl_status status = hl_volume_in_memory(volume->mask.volume, &whole.volume, error);
    if (status == HL_OK) status = hl_label_mask(context, placed->render.threads, &whole, &lattice, error);
    if (status != HL_OK) return status;
  }
  if (walled) {
    hl_status status = hl_wall_mask(context, placed->render.threads, volume->volume->wall, &lattice, error);
    if (status != HL_OK) return status;
  }
  hl_scene_volume *drawn = (hl_scene_volume *)&placed->volumes[placed->volume_count++];
  *drawn = *volume;
  if (walled) drawn->volume = volume->volume->continued;
  hl_volume_retain(drawn->volume);
  drawn->mask = (hl_mask){.volume = lattice, .rest = walled ? 0 : volume->mask.rest};
  return HL_OK;
}

hl_status hl_labels_draw(hl_context *context, hl_scene_description *placed, drawn_labels *drawn,
                         hl_error *error) {
  /* the volumes before drawing; some of them are label maps */
  const hl_scene_volume *volumes = placed->volumes;
  const size_t volume_count = placed->volume_count;
  size_t count = 0, maps = 0;
  for (size_t v = 0; v < volume_count; v++) {
    maps += volumes[v].label_count > 0 || volumes[v].mask.volume != NULL || has_wall(placed, &volumes[v]);
    count += count_drawn(&volumes[v]);
  }
  if (maps == 0) return HL_OK;
  if (count > HL_LIMIT_VOLUMES)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "/volumes: %zu labels and volumes are visible, at most %d can be", count,
                   HL_LIMIT_VOLUMES);
  drawn->volumes = hl_allocate_zeroed(context, count + 1, sizeof *drawn->volumes);
  drawn->points = hl_allocate(context, count + 1, sizeof(drawn_points));
  if (drawn->volumes == NULL || drawn->points == NULL) {
    hl_release(context, drawn->volumes);
    hl_release(context, drawn->points);
    *drawn = (drawn_labels){0};
    return hl_fail_memory(error, count * sizeof *drawn->volumes, "labels");
  }
  placed->volumes = drawn->volumes;
  placed->volume_count = 0;
  drawn_points *points = drawn->points;
  hl_status status = HL_OK;
  for (size_t v = 0; v < volume_count && status == HL_OK; v++) {
    const hl_scene_volume *volume = &volumes[v];
    status = volume->label_count > 0 ? draw_map(context, placed, volume, &points, error)
                                     : draw_masked(context, placed, volume, error);
  }
  if (status == HL_OK && placed->volume_count == 0)
    status = hl_fail(error, HL_ERROR_INPUT, "/volumes: no label that is visible has voxels: show others");
  return status;
}

void hl_drawn_labels_release(hl_context *context, const hl_scene_description *placed, drawn_labels *drawn) {
  if (drawn->volumes == NULL) return;
  for (size_t v = 0; v < placed->volume_count; v++) {
    hl_volume_release(drawn->volumes[v].volume);
    hl_volume_release(drawn->volumes[v].mask.volume);
  }
  hl_release(context, drawn->volumes);
  hl_release(context, drawn->points);
}
