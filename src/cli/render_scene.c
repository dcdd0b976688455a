/* cli/render_scene.c - applies the options of `halflight render` to a scene.
 *
 * A scene cannot be changed: its description is copied and another scene made of the copy. Of the arrays only
 * those that change (lights, volumes, transfer functions) are copied too.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render.h"

static const double degree = 3.14159265358979323846 / 180;

/* The changed description and its own arrays. */
typedef struct scene_change {
  cli_host *host;
  const cli_value *values;
  bool bare;
  hl_scene_description description;
  hl_light *lights;         /* owned; [description.light_count] */
  hl_scene_volume *volumes; /* owned; [description.volume_count] */
  hl_scene_mesh *meshes;    /* owned, with the floor, which is the last; null: no floor is added */
  hl_transfer_function
      *functions;          /* owned with their points; [description.volume_count]; null: none changed */
  float *sky;              /* owned; the pixels of the image of --sky; null: none */
  hl_isosurface *surfaces; /* owned; [description.volume_count][values of --iso]; null: none */
  hl_cut *cuts; /* owned; of the one volume, or of the scene with several, with those of the options; null:
                   none added */
} scene_change;

static void subtract(const double a[3], const double b[3], double difference[3]) {
  for (int i = 0; i < 3; i++) difference[i] = a[i] - b[i];
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static double distance(const double a[3], const double b[3]) {
  double difference[3];
  subtract(a, b, difference);
  return sqrt(dot(difference, difference));
}

/* --ortho and --fovy: changes the projection so that the picture shows the same height of the world at the
 * target as before. */
static void change_projection(const cli_value *values, hl_camera *camera) {
  double away = distance(camera->position, camera->target);
  if (values[RENDER_ORTHO].given && camera->type == HL_CAMERA_PERSPECTIVE) {
    camera->height = 2 * away * tan(camera->fovy_deg * degree / 2);
    camera->type = HL_CAMERA_ORTHOGRAPHIC;
  }
  if (!values[RENDER_FOVY].given) return;
  if (camera->type == HL_CAMERA_ORTHOGRAPHIC && away > 0) {
    double wanted = camera->height / (2 * tan(values[RENDER_FOVY].number[0] * degree / 2));
    for (int i = 0; i < 3; i++)
      camera->position[i] = camera->target[i] + (camera->position[i] - camera->target[i]) * wanted / away;
  }
  camera->type = HL_CAMERA_PERSPECTIVE;
  camera->fovy_deg = values[RENDER_FOVY].number[0];
}

/* The view to change: the one that --view and --up ask for; without them the view of the scene's camera, or
 * the automatic view of a bare volume. */
static int choose_view(const scene_change *change, hl_view *view) {
  const cli_value *values = change->values, *up = &values[RENDER_UP];
  hl_error error = {0};
  if (!change->bare && !up->given && !values[RENDER_VIEW].given) {
    if (hl_view_of_camera(&change->description, view) == HL_OK) return EXIT_CODE_OK;
    return fail(EXIT_CODE_USAGE, "the scene's camera looks nowhere: mend its position, target or up");
  }
  double vector[3];
  for (int axis = 0; axis < 3; axis++)
    vector[axis] = !up->chosen ? up->number[axis] : up->choice / 2 != axis ? 0 : up->choice % 2 ? -1 : 1;
  hl_side side = values[RENDER_VIEW].given ? (hl_side)values[RENDER_VIEW].choice : HL_SIDE_AUTOMATIC;
  if (up->given && vector[0] == 0 && vector[1] == 0 && vector[2] == 0)
    return fail(EXIT_CODE_USAGE,
                "--up: '%s' has no direction: give an axis, as +z, or a vector that is not 0", up->text);
  hl_status status = hl_view_choose(&change->description, side, up->given ? vector : NULL, view, &error);
  return status == HL_OK ? EXIT_CODE_OK : host_fail(change->host, PHASE_CHANGE, status, &error);
}

/* Sets the angles that are given; false if none of them changes. */
static bool turn_view(const cli_value *values, hl_view *view) {
  const hl_view before = *view;
  if (values[RENDER_AZIMUTH].given) view->azimuth_deg = values[RENDER_AZIMUTH].number[0];
  if (values[RENDER_ELEVATION].given) view->elevation_deg = values[RENDER_ELEVATION].number[0];
  if (values[RENDER_ROLL].given) view->roll_deg = values[RENDER_ROLL].number[0];
  return view->azimuth_deg != before.azimuth_deg || view->elevation_deg != before.elevation_deg ||
         view->roll_deg != before.roll_deg;
}

hl_status render_frame_anew(hl_scene_description *description, hl_error *error) {
  hl_view view;
  hl_status status = hl_view_of_camera(description, &view);
  return status == HL_OK ? hl_camera_frame_view(description, &view, 1, &description->camera, error) : status;
}

/* Frames the camera before it is turned: then all frames of a turn have the same target and distance. */
static int change_camera(scene_change *change) {
  const cli_value *values = change->values;
  hl_scene_description *description = &change->description;
  if (values[RENDER_SIZE].given) {
    description->width = (int)values[RENDER_SIZE].number[0];
    description->height = (int)values[RENDER_SIZE].number[1];
  }
  change_projection(values, &description->camera);
  bool turned = values[RENDER_AZIMUTH].given || values[RENDER_ELEVATION].given || values[RENDER_ROLL].given;
  bool reshaped = values[RENDER_SIZE].given || values[RENDER_FOVY].given || values[RENDER_ORTHO].given;
  bool framed = values[RENDER_ZOOM].given || values[RENDER_VIEW].given || values[RENDER_UP].given ||
                (change->bare && (reshaped || change->volumes != NULL));
  if (!turned && !framed) return EXIT_CODE_OK;
  hl_view view;
  int exit_code = choose_view(change, &view);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  if (change->bare) memcpy(description->sky.up, view.up, sizeof view.up);
  double zoom = values[RENDER_ZOOM].given ? values[RENDER_ZOOM].number[0] : 1;
  hl_error error = {0};
  hl_status status = framed ? hl_camera_frame_view(description, &view, zoom, &description->camera, &error)
                            : HL_OK;
  if (status == HL_ERROR_MEMORY) return host_fail(change->host, PHASE_CHANGE, status, &error);
  if (status == HL_OK && turn_view(values, &view)) status = hl_camera_turn(&view, &description->camera);
  if (status == HL_OK) return EXIT_CODE_OK;
  return fail(EXIT_CODE_USAGE,
              "--view, --up, --azimuth, --elevation, --roll, --zoom: no visible volume to frame: place the "
              "camera in the scene");
}

static const char *light_type_name(hl_light_type type) {
  switch (type) {
    case HL_LIGHT_DIRECTIONAL: return "directional";
    case HL_LIGHT_POINT: return "point";
    case HL_LIGHT_SPOT: return "spot";
    case HL_LIGHT_RECT: return "rect";
    case HL_LIGHT_DISK: return "disk";
    case HL_LIGHT_POLYGON: return "polygon";
  }
  return "unknown";
}

static int change_first_light(scene_change *change) {
  const cli_value *values = change->values;
  hl_light *light = &change->lights[0];
  if (values[RENDER_LIGHT].given) {
    if (change->description.light_count == 0) {
      hl_light_defaults(light);
      light->frame = HL_LIGHT_FRAME_CAMERA;
      change->description.light_count = 1;
    }
    light->type = HL_LIGHT_DIRECTIONAL;
    const double *angles = values[RENDER_LIGHT].number;
    if (light->frame == HL_LIGHT_FRAME_CAMERA)
      hl_light_direction_beside(angles[0], angles[1], light->direction);
    else hl_light_direction(&change->description.camera, angles[0], angles[1], light->direction);
  }
  if (!values[RENDER_LIGHT_SIZE].given) return EXIT_CODE_OK;
  if (change->description.light_count == 0)
    return fail(EXIT_CODE_USAGE, "--light-size: the scene has no light: add --light AZ,EL");
  if (light->type != HL_LIGHT_DIRECTIONAL)
    return fail(EXIT_CODE_USAGE,
                "--light-size is the angle of a directional light, and /lights/0 is a %s light: "
                "change its size in the scene, or add --light AZ,EL",
                light_type_name(light->type));
  light->angular_diameter_deg = values[RENDER_LIGHT_SIZE].number[0];
  return EXIT_CODE_OK;
}

/* --shadows: sets the scene's shadows, and makes every light that casts any follow them. */
static void change_shadows(scene_change *change) {
  if (!change->values[RENDER_SHADOWS].given) return;
  hl_shadows shadows = (hl_shadows)change->values[RENDER_SHADOWS].choice;
  change->description.render.shadows = shadows;
  for (size_t i = 0; i < change->description.light_count; i++)
    if (change->lights[i].shadows != HL_SHADOWS_OFF) change->lights[i].shadows = HL_SHADOWS_DEFAULT;
}

/* Automatic light is made for the whole volume: cut open, a bare volume gets the light that suits what is
 * left. */
static int expose_anew(scene_change *change) {
  const cli_value *values = change->values;
  hl_scene_description *description = &change->description;
  double factor = 1;
  hl_error error = {0};
  if (!change->bare || description->volume_count != 1 || render_is_maximum(values, description) ||
      (render_cut_count(values) == 0 && !values[RENDER_CLIP].given))
    return EXIT_CODE_OK;
  const char *look = render_look_name(values);
  hl_status status = hl_scene_light_factor(description, look != NULL ? look : "auto", &factor, &error);
  if (status != HL_OK) return host_fail(change->host, PHASE_CHANGE, status, &error);
  for (size_t l = 0; l < description->light_count; l++) change->lights[l].intensity *= factor;
  for (int c = 0; c < 3; c++) description->ambient[c] *= factor;
  description->sky.strength *= factor;
  return EXIT_CODE_OK;
}

static int change_lights(scene_change *change) {
  hl_scene_description *description = &change->description;
  change->lights = calloc(description->light_count + 1, sizeof *change->lights);
  if (change->lights == NULL) return fail(EXIT_CODE_FAILURE, "out of memory for the scene's lights");
  if (description->light_count > 0)
    memcpy(change->lights, description->lights, description->light_count * sizeof *change->lights);
  description->lights = change->lights;
  change_shadows(change);
  return change_first_light(change);
}

static int change_volume(scene_change *change, size_t index) {
  const cli_value *values = change->values;
  hl_scene_volume *volume = &change->volumes[index];
  if (values[RENDER_SHADING].given) volume->shading = (hl_shading)values[RENDER_SHADING].choice;
  if (values[RENDER_CUT_SHADING].given)
    volume->cut_shading = (hl_cut_shading)values[RENDER_CUT_SHADING].choice;
  if (values[RENDER_CUT_CASTS_SHADOW].given) volume->cut_casts_shadow = 1;
  int exit_code = values[RENDER_CLIP].given ? render_clip(&values[RENDER_CLIP], volume) : EXIT_CODE_OK;
  if (exit_code == EXIT_CODE_OK && change->cuts != NULL && change->description.volume_count == 1)
    exit_code = render_cuts(values, volume, change->cuts);
  bool looks = render_look_recolors(values, change->bare), iso = values[RENDER_ISO].given;
  if (exit_code != EXIT_CODE_OK || (!looks && !iso && !render_recolors(values))) return exit_code;
  hl_transfer_function look = {0};
  hl_error error = {0};
  hl_status status = looks ? render_look_volume(change->host, values, volume, &error) : HL_OK;
  if (status != HL_OK) return host_fail(change->host, PHASE_READ, status, &error);
  if (looks) look = volume->transfer_function;
  char color[8];
  bool colored = looks && render_channel_color(values, &change->description, index, color);
  exit_code = render_transfer_function(change->host, values, &change->description, index,
                                       colored ? color : NULL, &change->functions[index]);
  volume->transfer_function = change->functions[index];
  hl_transfer_function_release(change->host->context, &look);
  if (exit_code != EXIT_CODE_OK || !iso) return exit_code;
  hl_isosurface *own = change->surfaces + index * (size_t)values[RENDER_ISO].count;
  return render_iso(change->host, values, index, volume, own);
}

/* --floor: adds a mesh below what is seen, when the camera is placed. */
static int add_floor(scene_change *change) {
  hl_scene_description *description = &change->description;
  if (!change->values[RENDER_FLOOR].given) return EXIT_CODE_OK;
  size_t count = description->mesh_count;
  hl_error error = {0};
  hl_mesh *floor = NULL;
  hl_status status = hl_scene_make_floor(change->host->context, description, NULL, HL_FLOOR_SIZE, &floor,
                                         &error);
  if (status != HL_OK) return host_fail(change->host, PHASE_CHANGE, status, &error);
  change->meshes = calloc(count + 1, sizeof *change->meshes);
  if (change->meshes == NULL) {
    hl_mesh_release(floor);
    return fail(EXIT_CODE_FAILURE, "out of memory for the scene's meshes");
  }
  if (count > 0) memcpy(change->meshes, description->meshes, count * sizeof *change->meshes);
  hl_scene_floor_defaults(&change->meshes[count]);
  change->meshes[count].name = "floor";
  change->meshes[count].mesh = floor;
  description->meshes = change->meshes;
  description->mesh_count = count + 1;
  return EXIT_CODE_OK;
}

/* Makes room for the cuts of the one volume, or of a scene with several, and the options'. False: out of
 * memory. */
static bool make_room_for_cuts(scene_change *change) {
  const hl_scene_description *description = &change->description;
  size_t added = render_cut_count(change->values);
  size_t own = description->volume_count == 1 ? description->volumes[0].cut_count : description->cut_count;
  if (added > 0) change->cuts = calloc(own + added, sizeof *change->cuts);
  return added == 0 || change->cuts != NULL;
}

static bool changes_cuts(const cli_value *values) {
  return render_cut_count(values) > 0 || values[RENDER_CUT_SHADING].given ||
         values[RENDER_CUT_CASTS_SHADOW].given;
}

/* How many planes hl_scene_for_volume() has cut bare volumes by; before the options' cuts are added. */
static size_t count_holder_planes(const scene_change *change) {
  size_t planes = 0;
  for (size_t v = 0; v < change->description.volume_count; v++)
    planes += change->description.volumes[v].cut_count;
  return planes;
}

/* Whether to give back what hl_scene_for_volume() cut off beside the object. */
static bool shows_whole(const scene_change *change) {
  const cli_value *values = change->values;
  bool chosen = values[RENDER_WHOLE].given || values[RENDER_ISO].given || render_recolors(values);
  return change->bare && chosen && count_holder_planes(change) > 0;
}

/* Says what is not seen of a bare volume. */
static void tell_of_holders(const scene_change *change) {
  size_t planes = count_holder_planes(change);
  if (change->bare && !change->host->quiet && planes > 0 && !shows_whole(change))
    say("what holds the object is cut away, by %zu plane%s: --whole shows it", planes,
        planes == 1 ? "" : "s");
}

/* Refuses options for the look of volumes where there are none. */
static int refuse_looks(const cli_value *values) {
  for (int which = RENDER_LOOK; which <= RENDER_SHADING; which++)
    if (values[which].given)
      return fail(EXIT_CODE_USAGE, "--%s is for volumes: the picture has none", render_options[which].name);
  return EXIT_CODE_OK;
}

static int change_volumes(scene_change *change) {
  const cli_value *values = change->values;
  hl_scene_description *description = &change->description;
  bool whole = shows_whole(change);
  bool changed = whole || render_look_recolors(values, change->bare) || render_recolors(values) ||
                 values[RENDER_SHADING].given || values[RENDER_CLIP].given || values[RENDER_ISO].given ||
                 changes_cuts(values);
  if (description->volume_count == 0) return refuse_looks(values);
  if (!changed) return EXIT_CODE_OK;
  change->volumes = calloc(description->volume_count, sizeof *change->volumes);
  change->functions = calloc(description->volume_count, sizeof *change->functions);
  if (values[RENDER_ISO].given)
    change->surfaces = calloc(description->volume_count * (size_t)values[RENDER_ISO].count,
                              sizeof *change->surfaces);
  if (change->volumes == NULL || change->functions == NULL ||
      (values[RENDER_ISO].given && change->surfaces == NULL) || !make_room_for_cuts(change))
    return fail(EXIT_CODE_FAILURE, "out of memory for the scene's volumes");
  memcpy(change->volumes, description->volumes, description->volume_count * sizeof *change->volumes);
  description->volumes = change->volumes;
  for (size_t v = 0; whole && v < description->volume_count; v++) change->volumes[v].cut_count = 0;
  int exit_code = render_check_names(values, description);
  if (exit_code == EXIT_CODE_OK && change->cuts != NULL && description->volume_count > 1)
    exit_code = render_scene_cuts(values, description, change->cuts);
  for (size_t i = 0; i < description->volume_count && exit_code == EXIT_CODE_OK; i++)
    exit_code = change_volume(change, i);
  return exit_code;
}

/* Writes each option for a render setting into the setting's field. */
static void change_render_settings(const cli_value *values, hl_render_settings *render) {
  for (int which = 0; which < RENDER_OPTION_COUNT; which++) {
    const cli_option *option = &render_options[which];
    if (!values[which].given || option->setting == NULL || option->setting_kind != HL_SETTINGS_RENDER)
      continue;
    const hl_setting *setting = hl_setting_find(HL_SETTINGS_RENDER, option->setting);
    const int whole = values[which].chosen ? values[which].choice : (int)values[which].number[0];
    void *field = (char *)render + setting->offset;
    if (setting->type == HL_SETTING_NUMBER) memcpy(field, values[which].number, sizeof(double));
    else memcpy(field, &whole, sizeof whole);
  }
}

/* --ambient, in place of the sky that was chosen for a bare volume; --shadows off wants no shadow of that sky
 * either. */
static void change_ambient(scene_change *change) {
  const cli_value *values = change->values;
  hl_scene_description *description = &change->description;
  bool chosen = change->bare && !values[RENDER_SKY].given,
       unshadowed = values[RENDER_SHADOWS].given && values[RENDER_SHADOWS].choice == HL_SHADOWS_OFF;
  if (chosen && unshadowed) hl_scene_level_sky(description);
  if (!values[RENDER_AMBIENT].given) return;
  memcpy(description->ambient, values[RENDER_AMBIENT].number, sizeof description->ambient);
  if (chosen) description->sky.type = HL_SKY_NONE;
}

static void change_settings(const cli_value *values, hl_scene_description *description) {
  change_render_settings(values, &description->render);
  if (values[RENDER_EXPOSURE].given) description->exposure = values[RENDER_EXPOSURE].number[0];
  if (values[RENDER_TONE].given) description->tone = (hl_tone)values[RENDER_TONE].choice;
  const cli_value *background = &values[RENDER_BACKGROUND];
  if (!background->given) return;
  description->background_transparent = background->chosen;
  if (!background->chosen)
    memcpy(description->background, background->number, sizeof description->background);
}

/* Warns of options that were given and change nothing. */
static void warn_of_idle_options(const scene_change *change) {
  const hl_render_settings *settings = &change->description.render;
  const cli_value *values = change->values;
  if (change->host->quiet || render_warn_of_no_light(values, &change->description)) return;
  bool soft = settings->shadows == HL_SHADOWS_SOFT;
  for (size_t i = 0; i < change->description.light_count; i++)
    soft |= change->description.lights[i].shadows == HL_SHADOWS_SOFT;
  if (values[RENDER_LIGHT_SAMPLES].given && (!soft || settings->soft_method != HL_SOFT_SUBLIGHTS))
    warn("--light-samples changes nothing without --shadows soft and --soft-method sublights");
  if (values[RENDER_SOFT_METHOD].given && !soft) warn("--soft-method changes nothing without --shadows soft");
  if (values[RENDER_LIGHT_SIZE].given && values[RENDER_LIGHT_SIZE].number[0] > 0 && !soft)
    warn("--light-size changes nothing without --shadows soft");
}

static void change_release(scene_change *change) {
  if (change->functions != NULL)
    for (size_t i = 0; i < change->description.volume_count; i++)
      render_release_function(&change->functions[i]);
  free(change->functions);
  free(change->surfaces);
  free(change->sky);
  free(change->cuts);
  if (change->meshes != NULL) hl_mesh_release(change->meshes[change->description.mesh_count - 1].mesh);
  free(change->meshes);
  free(change->volumes);
  free(change->lights);
}

int render_change_scene(cli_host *host, const cli_value *values, bool bare, hl_scene **scene) {
  const hl_scene_description *before = hl_scene_describe(*scene);
  scene_change change = {.host = host, .values = values, .bare = bare, .description = *before};
  tell_of_holders(&change);
  int exit_code = change_volumes(&change); /* first: the camera frames what is seen of the volumes */

  if (exit_code == EXIT_CODE_OK) exit_code = change_camera(&change);
  if (exit_code == EXIT_CODE_OK) exit_code = add_floor(&change);
  if (exit_code == EXIT_CODE_OK) exit_code = change_lights(&change);
  if (exit_code == EXIT_CODE_OK) exit_code = expose_anew(&change);
  if (exit_code == EXIT_CODE_OK)
    exit_code = render_sky(host, &values[RENDER_SKY], &change.description, &change.sky);
  if (exit_code == EXIT_CODE_OK) {
    render_change_look(values, bare, &change.description);
    change_ambient(&change);
    change_settings(values, &change.description);
    warn_of_idle_options(&change);
    hl_scene *changed = NULL;
    hl_error error = {0};
    hl_status status = hl_scene_create(host->context, &change.description, &changed, &error);
    if (status == HL_OK) {
      hl_scene_release(*scene);
      *scene = changed;
    } else {
      exit_code = host_fail(host, PHASE_CHANGE, status, &error);
    }
  }
  change_release(&change);
  return exit_code;
}
