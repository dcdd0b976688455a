/* cli/render_scene.c - a scene changed as the options of `halflight render` say.
 *
 * In: the scene of the file, or the one made for a bare volume. Out: another scene. The description
 * is copied flat; only the arrays that change (lights, volumes, transfer functions) are copied too.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render.h"

static const double degree = 3.14159265358979323846 / 180;

/* The changed description with what it owns. */
typedef struct scene_change {
  cli_host *host;
  const cli_value *values;
  bool bare;
  hl_scene_description description;
  hl_light *lights;         /* owned; [description.light_count] */
  hl_scene_volume *volumes; /* owned; [description.volume_count] */
  hl_transfer_function
      *functions; /* owned with their points; [description.volume_count]; null: none changed */
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

/* Inverse of hl_camera_frame: the eye stands at target + d (sin az cos el, -cos az cos el, sin el), and
 * its up vector is the derivative of that by the elevation. Where the view is vertical, up tells. */
static void camera_angles(const hl_camera *camera, double *azimuth_deg, double *elevation_deg) {
  double eye[3];
  subtract(camera->position, camera->target, eye);
  double flat = hypot(eye[0], eye[1]);
  *elevation_deg = atan2(eye[2], flat) / degree;
  double tilt = eye[0] * camera->up[1] - eye[1] * camera->up[0];        /* of right against the horizon */
  if (fabs(tilt) > 1e-6 * distance(camera->position, camera->target)) { /* up is another axis: begin anew */
    *azimuth_deg = 30;
    *elevation_deg = 20;
    return;
  }
  if (flat > 1e-9 * fabs(eye[2]))
    *azimuth_deg = atan2(eye[0], -eye[1]) / degree;
  else
    *azimuth_deg =
        (eye[2] > 0 ? atan2(-camera->up[0], camera->up[1]) : atan2(camera->up[0], -camera->up[1])) / degree;
}

/* The same height of the world is seen at the target before and after the change of projection. */
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

static int change_camera(scene_change *change) {
  const cli_value *values = change->values;
  hl_scene_description *description = &change->description;
  if (values[RENDER_SIZE].given) {
    description->width = (int)values[RENDER_SIZE].number[0];
    description->height = (int)values[RENDER_SIZE].number[1];
  }
  double azimuth_deg, elevation_deg;
  camera_angles(&description->camera, &azimuth_deg, &elevation_deg);
  change_projection(values, &description->camera);
  bool turned = values[RENDER_AZIMUTH].given || values[RENDER_ELEVATION].given;
  bool reshaped = values[RENDER_SIZE].given || values[RENDER_FOVY].given || values[RENDER_ORTHO].given;
  if (!turned && !values[RENDER_ZOOM].given && !(change->bare && reshaped)) return EXIT_CODE_OK;
  if (values[RENDER_AZIMUTH].given) azimuth_deg = values[RENDER_AZIMUTH].number[0];
  if (values[RENDER_ELEVATION].given) elevation_deg = values[RENDER_ELEVATION].number[0];
  double zoom = values[RENDER_ZOOM].given ? values[RENDER_ZOOM].number[0] : 1;
  hl_status status =
      turned ? hl_camera_frame(description, azimuth_deg, elevation_deg, zoom, &description->camera)
             : hl_camera_fit(description, zoom, &description->camera);
  if (status == HL_OK) return EXIT_CODE_OK;
  return fail(EXIT_CODE_USAGE,
              "--azimuth, --elevation, --zoom: no visible volume to frame: place the camera in the scene");
}

/* Right, up and forward of the camera: an orthonormal basis, rows of `basis`. */
static void camera_basis(const hl_camera *camera, double basis[3][3]) {
  double *right = basis[0], *up = basis[1], *forward = basis[2];
  subtract(camera->target, camera->position, forward);
  double length = sqrt(dot(forward, forward));
  for (int i = 0; i < 3; i++) forward[i] /= length;
  for (int i = 0; i < 3; i++)
    right[i] =
        forward[(i + 1) % 3] * camera->up[(i + 2) % 3] - forward[(i + 2) % 3] * camera->up[(i + 1) % 3];
  length = sqrt(dot(right, right));
  for (int i = 0; i < 3; i++) right[i] /= length;
  for (int i = 0; i < 3; i++)
    up[i] = right[(i + 1) % 3] * forward[(i + 2) % 3] - right[(i + 2) % 3] * forward[(i + 1) % 3];
}

/* The lights of a bare volume keep their place beside the camera. */
static void turn_lights(hl_light *lights, size_t count, const hl_camera *before, const hl_camera *after) {
  double from[3][3], to[3][3];
  camera_basis(before, from);
  camera_basis(after, to);
  for (size_t n = 0; n < count; n++) {
    if (lights[n].type != HL_LIGHT_DIRECTIONAL) continue;
    double direction[3] = {0, 0, 0};
    for (int axis = 0; axis < 3; axis++)
      for (int i = 0; i < 3; i++) direction[i] += dot(lights[n].direction, from[axis]) * to[axis][i];
    memcpy(lights[n].direction, direction, sizeof direction);
  }
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
      change->description.light_count = 1;
    }
    light->type = HL_LIGHT_DIRECTIONAL;
    hl_light_direction(&change->description.camera, values[RENDER_LIGHT].number[0],
                       values[RENDER_LIGHT].number[1], light->direction);
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

/* The scene's shadows, and those of each light that casts any. */
static void change_shadows(scene_change *change) {
  if (!change->values[RENDER_SHADOWS].given) return;
  hl_shadows shadows = (hl_shadows)change->values[RENDER_SHADOWS].choice;
  change->description.render.shadows = shadows;
  for (size_t i = 0; i < change->description.light_count; i++)
    if (change->lights[i].shadows != HL_SHADOWS_OFF) change->lights[i].shadows = HL_SHADOWS_DEFAULT;
}

static int change_lights(scene_change *change, const hl_camera *camera_before) {
  hl_scene_description *description = &change->description;
  change->lights = calloc(description->light_count + 1, sizeof *change->lights);
  if (change->lights == NULL) return fail(EXIT_CODE_FAILURE, "out of memory for the scene's lights");
  if (description->light_count > 0)
    memcpy(change->lights, description->lights, description->light_count * sizeof *change->lights);
  description->lights = change->lights;
  if (change->bare && memcmp(camera_before, &description->camera, sizeof *camera_before) != 0)
    turn_lights(change->lights, description->light_count, camera_before, &description->camera);
  change_shadows(change);
  return change_first_light(change);
}

static int change_volume(scene_change *change, size_t index) {
  const cli_value *values = change->values;
  hl_scene_volume *volume = &change->volumes[index];
  if (values[RENDER_SHADING].given) volume->shading = (hl_shading)values[RENDER_SHADING].choice;
  int exit_code = values[RENDER_CLIP].given ? render_clip(&values[RENDER_CLIP], volume) : EXIT_CODE_OK;
  bool looks = render_look_recolors(values, change->bare);
  if (exit_code != EXIT_CODE_OK || (!looks && !render_recolors(values))) return exit_code;
  hl_transfer_function look = {0};
  hl_error error = {0};
  hl_status status = looks ? render_look_function(change->host, values, volume->volume, &look, &error) : HL_OK;
  if (status != HL_OK) return host_fail(change->host, PHASE_READ, status, &error);
  if (looks) volume->transfer_function = look;
  exit_code = render_transfer_function(change->host, values, &change->description, index, &change->functions[index]);
  volume->transfer_function = change->functions[index];
  hl_transfer_function_release(change->host->context, &look);
  return exit_code;
}

static int change_volumes(scene_change *change) {
  const cli_value *values = change->values;
  hl_scene_description *description = &change->description;
  bool changed = render_look_recolors(values, change->bare) || render_recolors(values) || values[RENDER_SHADING].given || values[RENDER_CLIP].given;
  if (!changed || description->volume_count == 0) return EXIT_CODE_OK;
  change->volumes = calloc(description->volume_count, sizeof *change->volumes);
  change->functions = calloc(description->volume_count, sizeof *change->functions);
  if (change->volumes == NULL || change->functions == NULL)
    return fail(EXIT_CODE_FAILURE, "out of memory for the scene's volumes");
  memcpy(change->volumes, description->volumes, description->volume_count * sizeof *change->volumes);
  description->volumes = change->volumes;
  int exit_code = render_check_names(values, description);
  for (size_t i = 0; i < description->volume_count && exit_code == EXIT_CODE_OK; i++) exit_code = change_volume(change, i);
  return exit_code;
}

static void change_settings(const cli_value *values, hl_scene_description *description) {
  hl_render_settings *settings = &description->render;
  if (values[RENDER_SOFT_METHOD].given)
    settings->soft_method = (hl_soft_method)values[RENDER_SOFT_METHOD].choice;
  if (values[RENDER_LIGHT_SAMPLES].given) settings->light_samples = (int)values[RENDER_LIGHT_SAMPLES].number[0];
  if (values[RENDER_SHADOW_RESOLUTION].given) /* 0 for "auto" */
    settings->shadow_resolution = (int)values[RENDER_SHADOW_RESOLUTION].number[0];
  if (values[RENDER_SHADOW_LOOKUP].given)
    settings->shadow_lookup = (hl_shadow_lookup)values[RENDER_SHADOW_LOOKUP].choice;
  if (values[RENDER_SHEET_SPACING].given) settings->sheet_spacing = values[RENDER_SHEET_SPACING].number[0];
  if (values[RENDER_KERNEL].given) settings->kernel = (hl_kernel)values[RENDER_KERNEL].choice;
  if (values[RENDER_RECONSTRUCTION].given)
    settings->reconstruction = (hl_reconstruction)values[RENDER_RECONSTRUCTION].choice;
  if (values[RENDER_SLICING].given) settings->slicing = (hl_slicing)values[RENDER_SLICING].choice;
  if (values[RENDER_THREADS].given) settings->threads = (int)values[RENDER_THREADS].number[0];
  if (values[RENDER_AMBIENT].given)
    memcpy(description->ambient, values[RENDER_AMBIENT].number, sizeof description->ambient);
  if (values[RENDER_EXPOSURE].given) description->exposure = values[RENDER_EXPOSURE].number[0];
  const cli_value *background = &values[RENDER_BACKGROUND];
  if (!background->given) return;
  description->background_transparent = background->chosen;
  if (!background->chosen)
    memcpy(description->background, background->number, sizeof description->background);
}

/* Options that were asked for and change nothing are said, not swallowed. */
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
  free(change->volumes);
  free(change->lights);
}

int render_change_scene(cli_host *host, const cli_value *values, bool bare, hl_scene **scene) {
  const hl_scene_description *before = hl_scene_describe(*scene);
  scene_change change = {.host = host, .values = values, .bare = bare, .description = *before};
  int exit_code = change_camera(&change);
  if (exit_code == EXIT_CODE_OK) exit_code = change_lights(&change, &before->camera);
  if (exit_code == EXIT_CODE_OK) exit_code = change_volumes(&change);
  if (exit_code == EXIT_CODE_OK) {
    render_change_look(values, bare, &change.description);
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
