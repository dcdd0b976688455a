/* scatter/field.c - makes a field of scattered light from volumes and lights, and keeps the field while they
 * do not change. */
#include "scatter/scatter.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "grid/matter_key.h"
#include "scatter/parts.h"
#include "scene/light/sky.h"

static bool scatters(const hl_scene_volume *volume) {
  return volume->multiple_scattering && volume->casts_shadow && volume->shading != HL_SHADING_FLAT;
}

bool hl_scatter_wanted(const hl_scene_description *scene) {
  bool wanted = false;
  for (size_t v = 0; v < scene->volume_count; v++) wanted = wanted || scatters(&scene->volumes[v]);
  return wanted && scene->render.compositing == HL_COMPOSITING_LIGHT;
}

void hl_scatter_release(hl_context *context, scatter_field *field) {
  hl_release(context, field->light);
  hl_key_release(context, &field->key);
  *field = (scatter_field){0};
}

/* Returns whether some matter scatters more light in some directions than in others. */
static bool is_uneven(const hl_scene_description *scene) {
  bool uneven = false;
  for (size_t v = 0; v < scene->volume_count; v++)
    uneven = uneven || (scatters(&scene->volumes[v]) && scene->volumes[v].anisotropy != 0);
  return uneven;
}

static bool has_sky(const hl_scene_description *scene) { return scene->sky.type != HL_SKY_NONE; }

/* ---- where the nodes are ---- */

/* Widens the bounds by the box of a volume's content. The box includes matter that only a mask hides, so that
 * no mask moves the nodes. */
static void add_box(const grid *grid, double low[3], double high[3]) {
  for (int corner = 0; corner < 8; corner++) {
    double p[3];
    for (int a = 0; a < 3; a++) {
      int32_t brick = corner >> a & 1 ? grid->content_high[a] + 1 : grid->content_low[a];
      p[a] = fmin(fmax(brick * HL_BRICK_CELLS - 1, grid->box_low[a]), grid->box_high[a]);
    }
    vec3 frame = affine3_apply(grid->index_to_frame, vec3_of(p));
    const double at[3] = {frame.x, frame.y, frame.z};
    for (int a = 0; a < 3; a++) low[a] = fmin(low[a], at[a]), high[a] = fmax(high[a], at[a]);
  }
}

/* Places the nodes of the grid around the scene's content. Returns false if there is no matter. */
static bool place_nodes(const scatter_scene *scene, scatter_nodes *nodes) {
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, longest = 0;
  for (size_t v = 0; v < scene->scene->volume_count; v++)
    if (scene->volumes[v].scene->casts_shadow && scene->volumes[v].grid->relevant_count > 0)
      add_box(scene->volumes[v].grid, low, high);
  for (int a = 0; a < 3; a++) longest = fmax(longest, high[a] - low[a]);
  if (!(longest > 0)) return false;
  double spacing = longest / SCATTER_LONGEST;
  nodes->spacing = (float)spacing;
  for (int a = 0; a < 3; a++) {
    double boxes = fmax(ceil((high[a] - low[a]) / spacing - 1e-6), 1);
    nodes->count[a] = (int32_t)boxes + 2 * SCATTER_MARGIN;
    nodes->origin[a] = (float)((low[a] + high[a]) / 2 - spacing * ((boxes - 1) / 2 + SCATTER_MARGIN));
  }
  return true;
}

/* ---- memory ---- */

/* The sizes and kinds of the arrays that a field consists of. */
typedef struct scatter_parts {
  size_t nodes;
  bool with_flux, with_sky, with_walls;
} scatter_parts;

static void lay_out_walls(size_t nodes, scatter_walls *walls, hl_layout *layout) {
  for (int line = 0; line < SCATTER_LINES; line++) {
    walls->outside[line] = hl_layout_take(layout, nodes, sizeof(float));
    walls->after[line] = hl_layout_take(layout, nodes, sizeof(float));
    walls->at_node[line] = hl_layout_take(layout, nodes, sizeof(float));
    walls->between[line] = hl_layout_take(layout, nodes, sizeof(float));
  }
}

static void lay_out(const scatter_parts *parts, scatter_arrays *arrays, scatter_work *work,
                    hl_layout *layout) {
  const size_t nodes = parts->nodes;
  const bool with_flux = parts->with_flux, with_sky = parts->with_sky;
  arrays->extinction = hl_layout_take(layout, 3 * nodes, sizeof(float));
  arrays->scattering = hl_layout_take(layout, 3 * nodes, sizeof(float));
  bool with_own = with_flux && with_sky;
  arrays->own = with_own ? hl_layout_take(layout, 3 * nodes, sizeof(float)) : arrays->extinction;
  work->sky = with_sky ? hl_layout_take(layout, nodes, sizeof(float)) : NULL;
  work->sky_flux = with_own ? hl_layout_take(layout, 3 * nodes, sizeof(float)) : NULL;
  arrays->direct = hl_layout_take(layout, 3 * nodes, sizeof(float));
  for (int line = 0; line < SCATTER_LINES; line++) {
    work->pass[line] = hl_layout_take(layout, nodes, sizeof(float));
    work->along[line] = hl_layout_take(layout, nodes, sizeof(float));
    work->flux[line] = with_flux ? hl_layout_take(layout, nodes, sizeof(float)) : NULL;
    work->before[line] = with_flux ? hl_layout_take(layout, nodes, sizeof(float)) : NULL;
  }
  for (size_t v = 0; v < sizeof work->vectors / sizeof *work->vectors; v++)
    work->vectors[v] = hl_layout_take(layout, nodes, sizeof(float));
  work->walls = (scatter_walls){{NULL}, {NULL}, {NULL}, {NULL}};
  if (parts->with_walls) lay_out_walls(nodes, &work->walls, layout);
}

static void lay_out_field(const scatter_parts *parts, scatter_field *field, hl_layout *layout) {
  field->light = hl_layout_take(layout, 3 * parts->nodes, sizeof *field->light);
  field->flux = parts->with_flux ? hl_layout_take(layout, 9 * parts->nodes, sizeof *field->flux) : NULL;
}

static scatter_parts parts_of(const scatter_scene *scene, const scatter_nodes *nodes, bool with_walls) {
  return (scatter_parts){hl_scatter_node_count(nodes), is_uneven(scene->scene), has_sky(scene->scene),
                         with_walls};
}

void hl_scatter_count(const scatter_scene *scene, hl_layout *layout) {
  scatter_nodes nodes;
  if (!place_nodes(scene, &nodes)) return;
  scatter_arrays arrays;
  scatter_work work;
  const bool with_walls = hl_surface_tree_count(scene->surfaces, ALL_SURFACES, layout);
  const scatter_parts parts = parts_of(scene, &nodes, with_walls);
  lay_out_field(&parts, &(scatter_field){0}, layout);
  lay_out(&parts, &arrays, &work, layout);
}

/* ---- the key ---- */

static void add_volume(hl_key *key, const scatter_volume *volume) {
  const hl_scene_volume *scene = volume->scene;
  const hl_transfer_function *function = &scene->transfer_function;
  hl_matter_key_add(key, scene, volume->plane_mark, volume->grid, volume->classifier);
  hl_key_add_whole(key, scatters(scene));
  hl_key_add_numbers(key, &scene->anisotropy, 1);
  hl_key_add_numbers(key, scene->albedo, 3);
  hl_key_add_whole(key, (int64_t)function->color_count);
  hl_key_add(key, function->color, function->color_count * sizeof *function->color);
}

static void add_light(hl_key *key, const hl_light *light, double sun_part) {
  const int64_t kinds[] = {light->type, light->falloff, light->shadows, (int64_t)light->vertex_count};
  const double numbers[] = {light->angular_diameter_deg,
                            light->opening_angle_deg,
                            light->falloff_angle_deg,
                            light->radius,
                            light->intensity,
                            sun_part};
  const double *const vectors[] = {light->position, light->direction, light->edge1,
                                   light->edge2,    light->normal,    light->color};
  for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) hl_key_add_whole(key, kinds[k]);
  hl_key_add_numbers(key, numbers, sizeof numbers / sizeof *numbers);
  for (size_t v = 0; v < sizeof vectors / sizeof *vectors; v++) hl_key_add_numbers(key, vectors[v], 3);
  hl_key_add(key, light->vertices, light->vertex_count * sizeof *light->vertices);
}

static void write_key(const void *data, hl_key *key) {
  const scatter_scene *scene = data;
  hl_key_add_whole(key, scene->scene->render.shadows);
  hl_sky_key_add(key, &scene->scene->sky, scene->sky_mark);
  hl_surfaces_key_add(key, scene->surfaces);
  for (size_t v = 0; v < scene->scene->volume_count; v++) add_volume(key, &scene->volumes[v]);
  for (size_t l = 0; l < scene->scene->light_count; l++)
    add_light(key, &scene->scene->lights[l], scene->sun_parts[l]);
}

/* ---- all steps together ---- */

/* The arrays of one colour channel. */
typedef struct channel {
  const float *extinction, *scattering, *own, *direct;
  const scatter_inflow *inflow; /* the sky's light that enters the grid; null if there is no sky */
  float *light, *flux;
} channel;

/* The albedo of all matter together: the fraction of the light that meets matter which is scattered. */
static float mean_albedo(const channel *of, size_t count) {
  double met = 0, kept = 0;
  for (size_t n = 0; n < count; n++) met += of->own[n], kept += of->extinction[n] - of->scattering[n];
  return met > 0 ? (float)(1 - kept / met) : 0;
}

/* Subtracts the fraction (1 - w) of the sky's unscattered light from the grid's light (parts.h), where w is
 * the albedo of the matter at a node. The evenly scattering medium absorbs as much light as the real medium
 * (similarity, scatter.h). The albedo w of the evenly scattering medium is therefore 1 - (extinction -
 * scattering) / own. Empty nodes beside matter have the albedo of all matter. */
static void leave_sky(const channel *of, const scatter_work *work, size_t count) {
  float elsewhere = mean_albedo(of, count);
  for (size_t n = 0; n < count; n++) {
    float kept = of->extinction[n] - of->scattering[n],
          albedo = of->own[n] > 0 ? 1 - kept / of->own[n] : elsewhere;
    of->light[n] -= (1 - albedo) * work->sky[n];
    for (size_t a = 0; a < 3 && of->flux != NULL; a++)
      of->flux[a * count + n] -= (1 - albedo) * work->sky_flux[a * count + n];
  }
}

/* Solves for the light of one channel. begun: whether the lines have been prepared already, for the same
 * extinction. */
static void solve_channel(const scatter_scene *scene, const scatter_nodes *nodes, const channel *of,
                          bool begun, scatter_work *work) {
  const bool two = of->inflow != NULL && of->own != of->extinction;
  if (two) hl_scatter_begin_lines(scene->pool, nodes, of->own, work);
  else if (!begun) hl_scatter_begin_lines(scene->pool, nodes, of->extinction, work);
  if (of->inflow != NULL)
    hl_scatter_enter(scene->pool, nodes, of->own, of->inflow, work, work->vectors[0], work->sky,
                     work->sky_flux);
  if (two) hl_scatter_begin_lines(scene->pool, nodes, of->extinction, work);
  hl_scatter_solve(scene->pool, nodes, of->extinction, of->scattering, of->direct, of->inflow, work,
                   of->light, of->flux);
  if (of->inflow != NULL) leave_sky(of, work, hl_scatter_node_count(nodes));
}

static void solve_channels(const scatter_scene *scene, const scatter_arrays *arrays,
                           const scatter_inflow inflow[3], scatter_work *work, scatter_field *field) {
  size_t count = hl_scatter_node_count(&field->nodes);
  for (size_t c = 0; c < (size_t)field->channels; c++) {
    size_t medium = arrays->channels == 3 ? c * count : 0;
    const channel of = {.extinction = arrays->extinction + medium,
                        .scattering = arrays->scattering + medium,
                        .own = arrays->own + medium,
                        .direct = arrays->direct + c * count,
                        .inflow = has_sky(scene->scene) ? &inflow[c] : NULL,
                        .light = field->light + c * count,
                        .flux = field->flux != NULL ? field->flux + 3 * c * count : NULL};
    solve_channel(scene, &field->nodes, &of, c > 0 && arrays->channels == 1, work);
  }
}

static hl_status find_field(const scatter_scene *scene, const surface_tree *tree, scatter_field *field,
                            hl_error *error) {
  scatter_arrays arrays;
  scatter_work work;
  hl_layout kept = {0}, passing = {0};
  const scatter_parts parts = parts_of(scene, &field->nodes, tree->box_count > 0);
  const size_t count = parts.nodes;
  while (hl_layout_pass(&kept, scene->context)) lay_out_field(&parts, field, &kept);
  if (kept.base == NULL) return hl_fail_memory(error, kept.bytes, "multiple scattering");
  while (hl_layout_pass(&passing, scene->context)) lay_out(&parts, &arrays, &work, &passing);
  if (passing.base == NULL) return hl_fail_memory(error, passing.bytes, "multiple scattering");
  arrays.tree = tree;
  hl_scatter_fill_matter(scene, &field->nodes, &arrays);
  hl_scatter_fill_direct(scene, &field->nodes, &arrays);
  if (parts.with_walls) hl_scatter_fill_walls(scene, &field->nodes, tree, &work.walls);
  bool grey = arrays.channels == 1;
  for (size_t c = 1; c < 3; c++)
    grey = grey && memcmp(arrays.direct, arrays.direct + c * count, count * sizeof(float)) == 0;
  scatter_inflow inflow[3] = {{{0}, {0}}, {{0}, {0}}, {{0}, {0}}};
  if (has_sky(scene->scene)) hl_scatter_sky_inflow(&scene->scene->sky, inflow);
  for (size_t c = 1; c < 3; c++) grey = grey && memcmp(inflow, inflow + c, sizeof *inflow) == 0;
  field->channels = grey ? 1 : 3;
  solve_channels(scene, &arrays, inflow, &work, field);
  hl_release(scene->context, passing.base);
  return hl_pool_check(scene->pool, "light is scattered", error);
}

hl_status hl_scatter_update(const scatter_scene *scene, scatter_field *field, hl_error *error) {
  bool same = false;
  hl_status status = hl_key_renew(scene->context, write_key, scene, &field->key, &same, error);
  if (status != HL_OK || same) return status;
  hl_key key = field->key;
  hl_release(scene->context, field->light);
  *field = (scatter_field){.key = key};
  if (place_nodes(scene, &field->nodes)) {
    surface_tree tree;
    status = hl_surface_tree_create(scene->context, scene->surfaces, ALL_SURFACES, &tree, error);
    if (status == HL_OK) status = find_field(scene, &tree, field, error);
    hl_surface_tree_release(scene->context, &tree);
  }
  if (status != HL_OK) hl_scatter_release(scene->context, field);
  return status;
}
