/* compose/compose.c - implements hl_scene_compose(), which applies options to a scene in a fixed order.
 *
 * A scene cannot be changed. So the scene's description is copied, the copy is changed, and another scene is
 * made of the changed copy. Of the description's arrays, only the arrays that change (lights, volumes,
 * transfer functions) are copied. */
#include <halflight/compose.h>
#include <limits.h>
#include <math.h>
#include <string.h>

#include "compose/color_by.h"
#include "compose/composer.h"
#include "compose/lights.h"
#include "compose/looks.h"
#include "compose/rulers.h"
#include "compose/slice.h"
#include "compose/volumes.h"
#include "core/context.h"
#include "core/door.h"
#include "core/memory.h"
#include "core/vector.h"
#include "elementary/elementary.h"

/* The changed copy of the description, and the arrays that this copy owns. */
typedef struct scene_change {
  hl_scene_description description;
  hl_changed_volumes volumes;
  hl_scene_volume *channels; /* owned; the volumes, of which some were made translucent; null if
                              * hl_see_through() judged no volume */
  hl_coloring coloring;      /* owned; the volumes and colours that "color-by" has made */
  hl_rulers rulers;          /* owned; the scene's marks, followed by added rulers */
  hl_light *lights;          /* owned; [description.light_count] */
  hl_scene_mesh *colored;    /* owned; the scene's meshes, if "colormap" gives a mesh a colour; else null */
  hl_scene_mesh *meshes; /* owned; the scene's meshes, followed by added meshes; null if no mesh is added */
  size_t added;          /* the number of added meshes, which `meshes` owns */
  float *sky;            /* owned; the pixels of the image of "sky"; null if "sky" names no image */
} scene_change;

/* Logs that the camera does not see the top of the floor, because the camera looks along the floor, or from
 * below. Derived: a floor with edges of length a is seen at the distance d, at an angle above the floor's
 * plane whose sine is s. The fraction of the picture's height that the floor takes is a s / (2 d tan(fovy /
 * 2)), or a s / height for an orthographic camera. A floor that is less than a pixel high is seen as a line.
 */
static void tell_of_hidden_floor(const hl_composer *composer, const hl_scene_description *description,
                                 const hl_mesh *floor) {
  const float(*corner)[3] = hl_mesh_describe(floor)->positions;
  const hl_camera *camera = &description->camera;
  hl_view view;
  if (hl_view_of_camera(description, &view) != HL_OK) return;
  vec3 corners[3], eye = vec3_of(camera->position);
  for (int n = 0; n < 3; n++) corners[n] = (vec3){corner[n][0], corner[n][1], corner[n][2]};
  const vec3 middle = vec3_scale(vec3_add(corners[0], corners[2]), 0.5),
             up = vec3_normalise(vec3_of(view.up));
  const bool orthographic = camera->type == HL_CAMERA_ORTHOGRAPHIC;
  const vec3 to_eye = vec3_subtract(eye, orthographic ? vec3_of(camera->target) : middle);
  const double seen = orthographic ? camera->height
                                   : 2 * vec3_length(to_eye) * hl_tan(camera->fovy_deg * HL_PI / 360);
  const double edge = vec3_length(vec3_subtract(corners[1], corners[0]));
  const double pixels = vec3_dot(vec3_normalise(to_eye), up) * edge / seen * description->height;
  if (!(pixels < 1)) return;
  hl_log(composer->context, HL_LOG_WARNING,
         "--floor: the camera %s, and does not see its top: look from above, as with --elevation 20",
         pixels > -1 ? "looks along the floor" : "looks at the floor from below");
}

/* Adds a mesh, which `change` owns afterwards. After a failure the mesh is released. */
static hl_status add_mesh(const hl_composer *composer, scene_change *change, const hl_scene_mesh *mesh) {
  hl_scene_description *description = &change->description;
  const size_t count = description->mesh_count;
  hl_scene_mesh *meshes = hl_reallocate(composer->context, change->meshes, count + 1, sizeof *meshes);
  if (meshes == NULL) {
    hl_mesh_release(mesh->mesh);
    return hl_fail_memory(composer->error, (count + 1) * sizeof *meshes, "the scene's meshes");
  }
  if (change->meshes == NULL && count > 0) memcpy(meshes, description->meshes, count * sizeof *meshes);
  meshes[count] = *mesh;
  description->meshes = change->meshes = meshes;
  description->mesh_count = count + 1;
  change->added++;
  return HL_OK;
}

/* Applies "outline": adds the edges of the volumes' boxes. */
static hl_status add_outline(const hl_composer *composer, scene_change *change) {
  hl_scene_description *description = &change->description;
  if (!composer->asked[HL_ASK_OUTLINE].given) return HL_OK;
  if (description->volume_count == 0)
    return hl_fail(composer->error, HL_ERROR_ARGUMENT,
                   "--outline is the edges of a volume's box: the picture has no volume");
  if (hl_is_maximum(composer, description))
    return hl_fail(composer->error, HL_ERROR_ARGUMENT,
                   "--outline is a mesh, and a maximum projection shows no meshes: leave it out, or give "
                   "another look, as --look xray");
  hl_scene_mesh outline;
  hl_box_outline_defaults(&outline);
  hl_status status = hl_make_box_outline(composer, description, &outline.mesh);
  return status == HL_OK ? add_mesh(composer, change, &outline) : status;
}

/* Applies "floor": adds a floor, which is a mesh below everything that is seen. The camera must have been
 * placed before. */
static hl_status add_floor(const hl_composer *composer, scene_change *change) {
  hl_scene_description *description = &change->description;
  if (!composer->asked[HL_ASK_FLOOR].given) return HL_OK;
  hl_scene_mesh floor;
  hl_scene_floor_defaults(&floor);
  floor.name = "floor";
  hl_status status = hl_scene_make_floor(composer->context, description, NULL, HL_FLOOR_SIZE, &floor.mesh,
                                         composer->error);
  if (status != HL_OK) return hl_blame_options(status);
  status = add_mesh(composer, change, &floor);
  if (status == HL_OK) tell_of_hidden_floor(composer, description, floor.mesh);
  return status;
}

/* Applies "colormap" NAME=COLOR to meshes: gives meshes their colours. */
static hl_status color_meshes(const hl_composer *composer, scene_change *change) {
  hl_scene_description *description = &change->description;
  const size_t count = description->mesh_count;
  if (!hl_colors_meshes(composer, description)) return HL_OK;
  change->colored = hl_allocate(composer->context, count, sizeof *change->colored);
  if (change->colored == NULL)
    return hl_fail_memory(composer->error, count * sizeof *change->colored, "the scene's meshes");
  memcpy(change->colored, description->meshes, count * sizeof *change->colored);
  hl_status status = hl_color_meshes(composer, description, change->colored);
  description->meshes = change->colored;
  return status;
}

/* Sets each render setting for which an option is given. */
static void change_render_settings(const hl_asked *asked, hl_render_settings *render) {
  for (int which = HL_ASK_SHADOWS; which < HL_ASK_COUNT; which++) {
    if (!asked[which].given) continue;
    const hl_setting *setting = hl_setting_find(HL_SETTINGS_RENDER, hl_option_rows[which].setting);
    const double number = asked[which].number[0];
    const int whole = asked[which].chosen ? asked[which].choice : (int)fmin(fmax(number, INT_MIN), INT_MAX);
    void *field = (char *)render + setting->offset;
    if (setting->type == HL_SETTING_NUMBER) memcpy(field, &number, sizeof number);
    else memcpy(field, &whole, sizeof whole);
  }
}

static void change_settings(const hl_asked *asked, hl_scene_description *description) {
  change_render_settings(asked, &description->render);
  if (asked[HL_ASK_EXPOSURE].given) description->exposure = asked[HL_ASK_EXPOSURE].number[0];
  if (asked[HL_ASK_TONE].given) description->tone = (hl_tone)asked[HL_ASK_TONE].choice;
  const hl_asked *background = &asked[HL_ASK_BACKGROUND];
  if (!background->given) return;
  description->background_transparent = background->chosen && background->choice == HL_BACKGROUND_TRANSPARENT;
  description->background_sky = background->chosen && background->choice == HL_BACKGROUND_SKY;
  if (!background->chosen)
    memcpy(description->background, background->number, sizeof description->background);
}

/* Gives scenes of smooth labels the B-spline as their kernel, because the numbers that stand for smooth
 * labels are coefficients of the B-spline. The scene of a bare label map has the linear kernel, which was
 * chosen for the numbers of labels. */
static void smooth_labels(const hl_composer *composer, hl_scene_description *description) {
  bool labels = false;
  for (size_t v = 0; v < description->volume_count; v++) labels |= description->volumes[v].label_count > 0;
  if (composer->bare && labels && description->render.kernel == HL_KERNEL_LINEAR)
    description->render.kernel = HL_KERNEL_BSPLINE;
}

static hl_status change_all(const hl_composer *composer, scene_change *change) {
  hl_scene_description *description = &change->description;
  /* volumes are changed before the camera is placed, because the camera frames their visible part */
  hl_status status = hl_compose_volumes(composer, description, &change->volumes);
  bool seen = change->volumes.seen || composer->asked[HL_ASK_OUTLINE].given ||
              (composer->flags & HL_COMPOSE_CHANGED) != 0;
  if (status == HL_OK) smooth_labels(composer, description);
  if (status == HL_OK) status = color_meshes(composer, change);
  if (status == HL_OK) status = add_outline(composer, change);
  if (status == HL_OK) status = hl_compose_camera(composer, seen, change->added, description);
  if (status == HL_OK) status = hl_see_through(composer, description, &change->channels);
  if (status == HL_OK) status = add_floor(composer, change);
  if (status == HL_OK) status = hl_compose_lights(composer, description, &change->lights);
  if (status == HL_OK) status = hl_compose_sky(composer, description, &change->sky);
  if (status == HL_OK) status = hl_compose_rulers(composer, description, &change->rulers);
  if (status == HL_OK) status = hl_compose_color_by(composer, description, &change->coloring);
  if (status != HL_OK) return status;
  hl_compose_look(composer, description);
  hl_compose_slice(composer, description);
  hl_compose_ambient(composer, description);
  change_settings(composer->asked, description);
  if (description->background_sky && description->sky.type == HL_SKY_NONE)
    return hl_fail(composer->error, HL_ERROR_ARGUMENT,
                   "--background sky: the scene has no sky: add --sky, as --sky skyblue:white:grey");
  hl_warn_of_idle_options(composer, description);
  return hl_tell_of_hidden_labels(composer, description);
}

static void change_release(hl_context *context, scene_change *change) {
  hl_changed_volumes_release(context, &change->volumes);
  hl_coloring_release(context, &change->coloring);
  hl_rulers_release(context, &change->rulers);
  hl_release(context, change->channels);
  hl_release(context, change->sky);
  for (size_t n = 1; n <= change->added; n++)
    hl_mesh_release(change->meshes[change->description.mesh_count - n].mesh);
  hl_release(context, change->meshes);
  hl_release(context, change->colored);
  hl_release(context, change->lights);
}

/* Returns whether two values of options can be for the same volume: the two begin with the same NAME=, or at
 * least one of them has no NAME=. */
static bool may_meet(const char *a, const char *b) {
  const size_t name = (size_t)(hl_after_name(a) - a), other = (size_t)(hl_after_name(b) - b);
  return name == 0 || other == 0 || (name == other && memcmp(a, b, name) == 0);
}

/* Refuses values of "range" that are no range, and values of other options beside which "range" has no
 * effect. */
static hl_status check_ranges(const hl_asked *asked, hl_error *error) {
  const hl_asked *range = &asked[HL_ASK_RANGE], *threshold = &asked[HL_ASK_THRESHOLD];
  if (asked[HL_ASK_RANGE_SCALE].given && !range->given)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "--range-scale says how --range spreads: give --range LO,HI, too");
  for (int n = 0; n < range->count; n++) {
    hl_asked ends;
    if (hl_row_numbers(&hl_option_rows[HL_ASK_RANGE], hl_after_name(range->texts[n]), &ends) &&
        ends.percent[0] == ends.percent[1] && ends.number[0] >= ends.number[1])
      return hl_fail(error, HL_ERROR_ARGUMENT, "--range: '%.200s': LO must be below HI", range->texts[n]);
    for (int t = 0; t < threshold->count && !asked[HL_ASK_COLORMAP].given; t++)
      if (may_meet(range->texts[n], threshold->texts[t]))
        return hl_fail(error, HL_ERROR_ARGUMENT,
                       "--threshold says what is opaque: --range beside it needs --colormap, to spread");
  }
  return HL_OK;
}

/* Refuses options whose values make no sense, and options that exclude each other. */
static hl_status check(const hl_asked *asked, hl_error *error) {
  hl_status status = check_ranges(asked, error);
  if (status != HL_OK) return status;
  if (asked[HL_ASK_ORTHO].given && asked[HL_ASK_FOVY].given)
    return hl_fail(error, HL_ERROR_ARGUMENT, "--ortho and --fovy exclude each other: give one of them");
  if (asked[HL_ASK_LIGHT].given && asked[HL_ASK_LIGHT_RIG].given)
    return hl_fail(error, HL_ERROR_ARGUMENT, "--light-rig and --light exclude each other: give one of them");
  if (asked[HL_ASK_LIGHT].given && fabs(asked[HL_ASK_LIGHT].number[1]) > 90)
    return hl_fail(error, HL_ERROR_ARGUMENT, "--light: '%.200s': the elevation must be from -90 to 90",
                   asked[HL_ASK_LIGHT].text);
  if (asked[HL_ASK_DENSITY].given && !(asked[HL_ASK_DENSITY].number[0] > 0))
    return hl_fail(error, HL_ERROR_ARGUMENT, "--density: '%.200s': give a factor above 0",
                   asked[HL_ASK_DENSITY].text);
  for (int n = 0; asked[HL_ASK_SIZE].given && n < 2; n++)
    if (!(asked[HL_ASK_SIZE].number[n] >= 1 && asked[HL_ASK_SIZE].number[n] <= 65536))
      return hl_fail(error, HL_ERROR_ARGUMENT, "--size: '%.200s': give WxH in pixels, each from 1 to 65536",
                     asked[HL_ASK_SIZE].text);
  status = hl_check_slice(asked, error);
  if (status == HL_OK) status = hl_check_clip(&asked[HL_ASK_CLIP], error);
  if (status == HL_OK) status = hl_check_cuts(asked, error);
  if (status == HL_OK) status = hl_check_rulers(&asked[HL_ASK_RULER], error);
  if (status == HL_OK) status = hl_check_isosurfaces(&asked[HL_ASK_ISO], error);
  return status == HL_OK ? hl_check_sky(&asked[HL_ASK_SKY], error) : status;
}

hl_status hl_options_check(const hl_option *options, size_t option_count, hl_error *error) {
  HL_DOOR;
  hl_asked asked[HL_ASK_COUNT];
  if (options == NULL && option_count > 0)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_options_check: null options");
  hl_status status = hl_options_read(options, option_count, asked, error);
  return status == HL_OK ? check(asked, error) : status;
}

/* Makes the scene of a description with its label maps. *scene is null if no option asks for label maps. */
static hl_status add_labels(const hl_composer *composer, const hl_scene_description *description,
                            hl_scene **scene) {
  if (!hl_asks_for_labels(composer, description)) return HL_OK;
  hl_status status = hl_scene_create(composer->context, description, scene, composer->error);
  return status == HL_OK ? hl_compose_labels(composer, scene) : status;
}

hl_status hl_scene_compose(hl_context *context, const hl_scene_description *description, unsigned flags,
                           const hl_option *options, size_t option_count, hl_scene **scene, hl_error *error) {
  HL_DOOR;
  hl_asked asked[HL_ASK_COUNT];
  if (context == NULL || description == NULL || scene == NULL || (options == NULL && option_count > 0))
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_scene_compose: null context, description, options or scene");
  *scene = NULL;
  hl_status status = hl_options_read(options, option_count, asked, error);
  if (status == HL_OK) status = check(asked, error);
  char plane[HL_SLICE_TEXT];
  if (status == HL_OK) status = hl_expand_slice(description, asked, plane, error);
  if (status != HL_OK) return status;
  const hl_composer composer = {context, asked, flags, (flags & HL_COMPOSE_BARE) != 0, error};
  hl_scene *values = NULL, *labelled = NULL;
  status = hl_compose_values(&composer, description, &values);
  if (values != NULL) description = hl_scene_describe(values);
  if (status == HL_OK) status = add_labels(&composer, description, &labelled);
  scene_change change = {.description = labelled != NULL ? *hl_scene_describe(labelled) : *description};
  if (status == HL_OK) status = change_all(&composer, &change);
  if (status == HL_OK) status = hl_scene_create(context, &change.description, scene, error);
  change_release(context, &change);
  hl_scene_release(labelled);
  hl_scene_release(values);
  return status;
}
