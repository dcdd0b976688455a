/* guess/for_volume.c - makes a scene that shows one volume well, without any settings. */
#include "guess/for_volume.h"

#include <string.h>

#include "core/context.h"
#include "core/door.h"
#include "core/error.h"
#include "core/sheet_constants.h"
#include "elementary/elementary.h"
#include "guess/analysis.h"
#include "guess/exposure.h"
#include "guess/holders.h"
#include "guess/looks.h"
#include "guess/scraps.h"
#include "guess/smoothing.h"
#include "guess/styles.h"
#include "guess/view.h"
#include "scene/check/check.h"
#include "scene/geometry/cut.h"
#include "scene/label/draw_labels.h"
#include "scene/scene.h"
#include "volume/scraps.h"
#include "volume/smooth.h"
#include "volume/store/gathered.h"

#define LIGHT_AZIMUTH   -40 /* key light from the upper left, degrees from the line of sight */
#define LIGHT_ELEVATION 45
/* Key light from the side, for media. Derived: a deep medium that scatters evenly sends m / (m + e) of the
 * light to the eye, where m and e are the cosines of the light's and of the eye's directions to its border
 * (Lommel and Seeliger). With light from the eye, this fraction is 1/2 everywhere, and a ball looks like a
 * disc. With light from the side, the fraction is 1 at the border towards the light and 0 at the border away
 * from the light. */
#define ASIDE_AZIMUTH   -75
#define ASIDE_ELEVATION 40
#define FILL_AZIMUTH    0 /* fill light from the eye, which suits a key light from any direction */
#define FILL_ELEVATION  0
/* Constant light that takes the place of a sky, as a fraction of the sky's strength. */
#define INSTEAD 0.35
/* Number of sheets across the grid's diagonal. Shaded surfaces need more sheets than media, because one
 * normal lights a whole slab. */
#define SHEETS_OF_MEDIA    540
#define SHEETS_OF_SURFACES 720
/* The greatest sheet spacing, as a fraction of a surface's thickness (hl_exposure). Rings on a surface get
 * stronger with the square of the spacing over the thickness. */
#define SPACING_PER_THICKNESS 0.28
/* The greatest sheet spacing in small grids, as a fraction of a surface's thickness. Small grids get at most
 * the number of sheets that other grids get, even if surfaces are thinner than this fraction allows. */
#define SMALL_GRIDS_SPACING_PER_THICKNESS 0.1
/* LEAST_SPACING: the least distance of sheets that is chosen, in smallest voxel edges. SMALL_GRIDS_SPACING:
 * the least distance of sheets for surfaces in small grids, in smallest voxel edges. */
#define LEAST_SPACING       0.25
#define SMALL_GRIDS_SPACING 0.125

void hl_scene_key_light(hl_light *light) {
  hl_light_defaults(light);
  light->frame = HL_LIGHT_FRAME_CAMERA;
  hl_light_direction_beside(LIGHT_AZIMUTH, LIGHT_ELEVATION, light->direction);
  light->angular_diameter_deg = 7;
  light->intensity = 1.7;
}

void hl_scene_warm_key_light(double intensity, hl_light *light) {
  static const double warm[3] = HL_WARM_LIGHT;
  hl_scene_key_light(light);
  light->intensity = intensity;
  memcpy(light->color, warm, sizeof warm);
}

void hl_scene_fill_light(hl_light *light) {
  hl_light_defaults(light);
  light->frame = HL_LIGHT_FRAME_CAMERA;
  hl_light_direction_beside(FILL_AZIMUTH, FILL_ELEVATION, light->direction);
  light->shadows = HL_SHADOWS_OFF;
}

hl_status hl_scene_frame(const hl_scene_description *description, hl_camera *camera, hl_error *error) {
  hl_view view;
  hl_outline outline = {0};
  hl_status status = hl_view_automatic(description, &outline, &view, error);
  if (status == HL_OK) status = hl_camera_frame_outline(description, &outline, &view, 1, camera, error);
  hl_outline_release(&outline);
  return status;
}

/* Chooses the key light and, where the look asks for it, a fill light. *count: 1 or 2. */
static void choose_lights(const hl_look *look, hl_light lights[2], size_t *count) {
  hl_scene_warm_key_light(look->light.key, &lights[0]);
  if (look->light.aside) hl_light_direction_beside(ASIDE_AZIMUTH, ASIDE_ELEVATION, lights[0].direction);
  *count = look->light.fill > 0 ? 2 : 1;
  hl_scene_fill_light(&lights[1]);
  lights[1].intensity = look->light.fill;
}

/* Returns true if the memory limit leaves room for a number of bytes beside the voxels and the renderer's
 * copy of the voxels. Memory that the process holds at present does not count, so that all processes that
 * share a volume make the same choice. */
static bool has_room(const hl_volume *volume, uint64_t bytes) {
  uint64_t limit = volume->context->options.memory_limit, taken = 0;
  if (hl_volume_is_in_memory(volume))
    taken = 2 * (uint64_t)hl_volume_voxel_count(volume) * hl_storage_bytes(volume->storage);
  return limit == 0 || limit >= bytes + taken;
}

/* Returns true if the memory limit leaves room to smooth the volume, and to draw a volume of a float for each
 * voxel. While the volume is smoothed, no renderer has a copy of it. The renderer's tables, such as the
 * bounds of bricks, take less than a sixteenth of the voxels' bytes plus a megabyte. */
static bool has_room_to_smooth(const hl_volume *volume) {
  const uint64_t limit = volume->context->options.memory_limit, count = hl_volume_voxel_count(volume),
                 voxels = count * hl_storage_bytes(volume->storage), tables = voxels / 16 + (1 << 20);
  return has_room(volume, count * sizeof(float)) &&
         (limit == 0 || limit >= voxels + tables + hl_volume_convolve_bytes(volume));
}

void hl_scene_choose_sky(double strength, hl_scene_description *description) {
  static const double zenith[3] = {0.90, 1.02, 1.22}, horizon[3] = {0.68, 0.74, 0.86},
                      ground[3] = {0.16, 0.14, 0.12};
  hl_sky *sky = &description->sky;
  for (int channel = 0; channel < 3; channel++) description->ambient[channel] = BESIDE_SKY * strength;
  if (!(strength > 0)) return;
  sky->type = HL_SKY_GRADIENT;
  sky->strength = strength;
  memcpy(sky->zenith, zenith, sizeof zenith);
  memcpy(sky->horizon, horizon, sizeof horizon);
  memcpy(sky->ground, ground, sizeof ground);
  memcpy(sky->up, description->camera.up, sizeof sky->up);
}

void hl_scene_choose_background(hl_scene_description *description) {
  static const double dark_grey[3] = {0.022, 0.025, 0.030};
  memcpy(description->background, dark_grey, sizeof dark_grey);
}

void hl_scene_level_sky(hl_scene_description *description) {
  HL_DOOR;
  if (description == NULL || description->sky.type == HL_SKY_NONE) return;
  for (int channel = 0; channel < 3; channel++)
    description->ambient[channel] = INSTEAD * description->sky.strength;
  hl_scene_description plain;
  hl_scene_description_defaults(&plain);
  description->sky = plain.sky;
}

/* The length of the diagonal of a grid with more voxels on each axis, in smallest voxel edges. */
static double diagonal_of(const hl_volume *volume, double more) {
  double edge = INFINITY, diagonal = 0;
  for (int a = 0; a < 3; a++) {
    double length = vec3_length(mat3_column(volume->index_to_world.linear, a));
    edge = fmin(edge, length);
    diagonal = hl_hypot(diagonal, length * ((double)volume->dimension[a] + more));
  }
  return diagonal / edge;
}

/* Warns if voxels that are thin on one axis make many sheets, because a frame's time grows with the number of
 * its sheets. A frame refuses more than GREATEST_SHEETS sheets. */
static void tell_of_sheets(const hl_volume *volume, double spacing) {
  double edges[3], cubes = 0, sheets = diagonal_of(volume, 1) / spacing;
  for (int a = 0; a < 3; a++) {
    edges[a] = vec3_length(mat3_column(volume->index_to_world.linear, a));
    cubes = hl_hypot(cubes, (double)volume->dimension[a] / spacing);
  }
  if (sheets > HL_MANY_SHEETS && sheets <= GREATEST_SHEETS && sheets > 2 * cubes)
    hl_log(volume->context, HL_LOG_WARNING,
           "about %.0f sheets, which takes long, since the voxels' edges are %.3g, %.3g and %.3g long: "
           "--spacing corrects wrong lengths%s",
           sheets, edges[0], edges[1], edges[2],
           spacing < GRID_MARGIN ? ", --sheet-spacing 4 makes the fewest sheets" : "");
}

/* The sheet spacing, in smallest voxel edges: from LEAST_SPACING to 1; in small grids with thin surfaces,
 * from SMALL_GRIDS_SPACING. In coarse grids, sheets a voxel apart would show as rings on smooth surfaces, and
 * closer sheets take little time. If a frame would have too many sheets, the spacing is greater, up to
 * GRID_MARGIN. thickness: the surfaces' thickness, in smallest voxel edges; infinite if the volume shows no
 * surfaces. */
static double choose_spacing(const hl_volume *volume, hl_shading shading, double thickness) {
  /* even: the spacing with which a grid of any size has about the same number of sheets */
  double even = diagonal_of(volume, 0) / (shading == HL_SHADING_PHONG ? SHEETS_OF_SURFACES : SHEETS_OF_MEDIA);
  double spacing = fmin(fmax(even, LEAST_SPACING), fmax(SPACING_PER_THICKNESS * thickness, LEAST_SPACING));
  double in_small = fmax(even, SMALL_GRIDS_SPACING_PER_THICKNESS * thickness);
  spacing = fmin(spacing, fmax(in_small, SMALL_GRIDS_SPACING));
  /* The sheets cover the matter, which reaches half a voxel beyond the faces. Of the ten sheets that are left
   * free, a sweep adds three sheets, and seven sheets allow for rounding. */
  double allowed = fmin(ceil(1000 * diagonal_of(volume, 1) / (GREATEST_SHEETS - 10)) / 1000, GRID_MARGIN);
  return fmax(round(1000 * fmin(spacing, 1)) / 1000, allowed);
}

static hl_status judge_exposure(const hl_look *look, const hl_data_analysis *analysis,
                                const hl_scene_description *description, hl_exposure *exposure,
                                hl_error *error) {
  double empty = analysis->kind == HL_DATA_FLOW ? analysis->middle : analysis->background;
  const bool fixed = !(look->left > 0), glows = description->volumes[0].multiple_scattering != 0;
  *exposure = (hl_exposure){1, INFINITY};
  if (fixed && !glows) return HL_OK;
  hl_status status = hl_scene_exposure(description, empty, fixed ? 1 : look->left, exposure, error);
  if (fixed) exposure->factor = fmin(exposure->factor, 1); /* the look's own light is strong enough */
  return status;
}

/* Scales all lights by one factor, so that the picture is as bright as possible without being clipped. The
 * function also puts sheets closer together if surfaces are thin. */
static hl_status expose(const hl_look *look, const hl_data_analysis *analysis, hl_light lights[2],
                        hl_scene_description *description, hl_error *error) {
  hl_exposure exposure;
  hl_status status = judge_exposure(look, analysis, description, &exposure, error);
  for (size_t l = 0; l < description->light_count; l++) lights[l].intensity *= exposure.factor;
  for (int channel = 0; channel < 3; channel++) description->ambient[channel] *= exposure.factor;
  description->sky.strength *= exposure.factor;
  const hl_volume *volume = description->volumes[0].volume;
  description->render.sheet_spacing = choose_spacing(volume, look->shading, exposure.thickness);
  tell_of_sheets(volume, description->render.sheet_spacing);
  return status;
}

/* Gives a volume cuts that remove the holders of the object, and hides scraps beside the object. The searches
 * always use the look `base`, which suits the volume, so that the holders and scraps do not depend on the
 * look that is shown. planes: memory for the cuts; it must last as long as the volume's description. */
static hl_status show_object_alone(hl_context *context, const hl_look *base, const hl_data_analysis *analysis,
                                   hl_cut planes[HL_HOLDER_PLANES], hl_scene_volume *volume,
                                   hl_error *error) {
  hl_scene_volume seen = *volume;
  size_t count = 0;
  hl_status status = hl_look_write(base, NULL, context, volume->volume, analysis, &seen.transfer_function,
                                   error);
  if (status != HL_OK) return status;
  status = hl_holders_find(&seen, analysis, planes, &count, error);
  if (status == HL_OK && has_room(volume->volume, hl_scraps_bytes(volume->volume)))
    status = hl_scraps_choose(&seen, analysis, volume, error);
  hl_transfer_function_release(context, &seen.transfer_function);
  volume->cuts = planes;
  volume->cut_count = count;
  return status;
}

/* Gives a label map its labels, with the names and colours in its file. A volume whose values turn out not to
 * be labels, or that is larger than memory, gets no labels. Such a volume is drawn by its values, and a log
 * line says so. *labels: owned by the caller; null if the volume gets no labels. */
static hl_status find_labels(hl_context *context, hl_scene_volume *volume, hl_label **labels,
                             hl_error *error) {
  int is_label_map = 0;
  hl_error found = {0};
  hl_status status = hl_volume_is_label_map(context, volume->volume, &is_label_map, error);
  if (status != HL_OK || !is_label_map) return status;
  status = hl_labels_of_volume(context, volume->volume, NULL, labels, &volume->label_count, &found);
  if (status == HL_ERROR_INPUT || status == HL_ERROR_UNSUPPORTED) {
    hl_log(context, HL_LOG_WARNING, "taken for a label map, and drawn by its values: %s", found.message);
    status = HL_OK;
  } else if (status != HL_OK && error != NULL) *error = found;
  volume->labels = *labels;
  return status;
}

/* Makes a scene of a volume in one look. style: the look that was asked for; null stands for the look that
 * suits the volume. The look that suits a label map draws its labels. */
static hl_status make_scene_of(hl_context *context, hl_volume *volume, const char *file, const hl_look *style,
                               hl_scene **scene, hl_error *error) {
  hl_data_analysis analysis;
  hl_status status = hl_data_analyse(volume, &analysis, error);
  if (status != HL_OK) return status;
  hl_scene_volume scene_volume;
  hl_scene_volume_defaults(&scene_volume);
  scene_volume.volume = volume;
  scene_volume.file = file;
  const hl_look *base = hl_look_for(volume, file, &analysis), *look = style != NULL ? style : base;
  hl_label *labels = NULL;
  if (style == NULL) status = find_labels(context, &scene_volume, &labels, error);
  bool labelled = status == HL_OK && scene_volume.label_count > 0;
  if (labelled) look = hl_look_automatic(volume, file, &analysis);
  else hl_look_material(look, &scene_volume);
  if (status == HL_OK)
    status = labelled ? hl_labels_function(context, &scene_volume, &scene_volume.transfer_function, error)
                      : hl_look_write(base, style, context, volume, &analysis,
                                      &scene_volume.transfer_function, error);
  if (status != HL_OK) {
    hl_labels_release(context, labels);
    return status;
  }
  hl_light lights[2];
  hl_cut planes[HL_HOLDER_PLANES];
  hl_scene_description description;
  hl_scene_description_defaults(&description);
  description.volumes = &scene_volume;
  description.volume_count = 1;
  if (!labelled) status = show_object_alone(context, base, &analysis, planes, &scene_volume, error);
  if (status == HL_OK) status = hl_scene_volume_check(&scene_volume, 0, error);
  if (status == HL_OK) status = hl_scene_frame(&description, &description.camera, error);
  if (status == HL_OK) {
    choose_lights(look, lights, &description.light_count);
    description.lights = lights;
    if (!look->on_black) hl_scene_choose_background(&description);
    hl_scene_choose_sky(look->light.sky, &description);
    description.render.kernel = labelled ? HL_KERNEL_BSPLINE : look->kernel; /* smooth labels are splines */
    status = expose(look, &analysis, lights, &description, error);
    if (!has_room(volume, HL_ROOM_FOR_SKY)) hl_scene_level_sky(&description);
  }
  if (status == HL_OK) status = hl_scene_create(context, &description, scene, error);
  hl_transfer_function_release(context, &scene_volume.transfer_function);
  hl_labels_release(context, labels);
  return status;
}

hl_status hl_smooth_where_needed(hl_volume *volume, const char *file, hl_volume **smoothed, hl_error *error) {
  hl_data_analysis analysis;
  *smoothed = NULL;
  hl_status status = hl_data_analyse(volume, &analysis, error);
  if (status != HL_OK || !has_room_to_smooth(volume)) return status;
  const double sigma = hl_smoothing_for(volume, file, &analysis);
  return sigma > 0 ? hl_volume_smooth(volume, sigma, smoothed, error) : HL_OK;
}

/* Makes the scene of the volume, or of a smoothed volume where the voxels need it. A volume that will be
 * projected is not smoothed, because smoothing lowers its greatest values. */
static hl_status make_scene(hl_context *context, hl_volume *volume, const char *file, const hl_look *style,
                            bool projected, hl_scene **scene, hl_error *error) {
  hl_volume *smoothed = NULL;
  hl_status status = projected ? HL_OK : hl_smooth_where_needed(volume, file, &smoothed, error);
  if (status == HL_OK)
    status = make_scene_of(context, smoothed != NULL ? smoothed : volume, file, style, scene, error);
  hl_volume_release(smoothed);
  return status;
}

hl_status hl_scene_for_volume(hl_context *context, hl_volume *volume, const char *file, hl_scene **scene,
                              hl_error *error) {
  HL_DOOR;
  if (context == NULL || volume == NULL || scene == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_scene_for_volume: null context, volume or scene");
  *scene = NULL;
  return make_scene(context, volume, file, NULL, false, scene, error);
}

hl_status hl_scene_for_volume_look(hl_context *context, hl_volume *volume, const char *file, const char *look,
                                   hl_scene **scene, hl_error *error) {
  HL_DOOR;
  if (context == NULL || volume == NULL || look == NULL || scene == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_scene_for_volume_look: null context, volume, look or scene");
  const hl_look *style = NULL;
  const bool projected = strcmp(look, "mip") == 0;
  *scene = NULL;
  hl_status status = hl_style_named(projected ? "auto" : look, &style, error);
  return status == HL_OK ? make_scene(context, volume, file, style, projected, scene, error) : status;
}

hl_status hl_scene_light_factor(const hl_scene_description *description, const char *look, double *factor,
                                hl_error *error) {
  HL_DOOR;
  if (description == NULL || description->volume_count == 0 || look == NULL || factor == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_scene_light_factor: null description, look or factor, or no volume");
  const hl_scene_volume *volume = &description->volumes[0];
  hl_context *context = volume->volume->context;
  hl_scene_description placed = *description;
  placed_cuts cuts = {NULL, NULL};
  const hl_look *style = NULL;
  hl_data_analysis analysis;
  hl_exposure exposure;
  *factor = 1;
  hl_status status = hl_style_named(look, &style, error);
  if (status == HL_OK) status = hl_data_analyse(volume->volume, &analysis, error);
  if (status != HL_OK) return status;
  if (style == NULL) style = hl_look_automatic(volume->volume, volume->file, &analysis);
  status = hl_cuts_place(context, &placed, &cuts, error);
  if (status == HL_OK) status = judge_exposure(style, &analysis, &placed, &exposure, error);
  if (status == HL_OK) *factor = exposure.factor;
  hl_placed_cuts_release(context, &cuts);
  return status;
}
