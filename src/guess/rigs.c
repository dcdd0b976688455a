/* guess/rigs.c - makes light rigs: named sets of lights that are placed around the object as a photographer
 * would place them.
 *
 * In: a name, and a scene with its light. Out: new lights and a new sky, which together are about as strong
 * as the scene's light before. */
#include <math.h>
#include <string.h>

#include "core/door.h"
#include "core/error.h"
#include "guess/for_volume.h"
#include "guess/rigs.h"
#include "scene/scene.h"
#include "text/edit_distance.h"

/* One light of a rig, seen from the camera. */
typedef struct rig_light {
  double azimuth_deg, elevation_deg; /* as for hl_light_direction_beside() */
  double diameter_deg;               /* angular diameter */
  double share;                      /* intensity as a fraction of the scene's key light */
  double color[3];                   /* linear RGB */
  bool shadows;
} rig_light;

typedef struct rig {
  size_t count;
  rig_light lights[HL_LIGHT_RIG_MOST];
  double sky; /* the sky's strength as a fraction of the scene's sky */
  bool grey;  /* whether a gradient sky loses its colours, as below clouds */
} rig;

#define WHITE \
  { 1, 1, 1 }

/* clang-format off */
enum { STUDIO, RAKING, RIM, OVERCAST, RIGS };

const hl_setting_choice hl_light_rig_choices[] = {
    {"studio", STUDIO}, {"raking", RAKING}, {"rim", RIM}, {"overcast", OVERCAST}, {NULL, 0}};

static const rig rigs[RIGS] = {
    /* a large lamp at the upper left, a weak lamp at the right, and a lamp behind the object that lights its
     * edges */
    [STUDIO] = {3, {{-42, 38, 24, 0.95, HL_WARM_LIGHT, true},
                   {  55, 5,  0, 0.16, HL_COOL_LIGHT, false},
                   { 150, 45, 8, 0.55, HL_COOL_LIGHT, true}}, 0.94, false},
    /* a small lamp at the left, whose light grazes the object: surface relief shows, and shadows are long */
    [RAKING] = {1, {{-82, 14,  4, 1.70, HL_WARM_LIGHT, true}}, 0.50, false},
    /* two lamps behind the object light its outline; a weak lamp lights the front */
    [RIM] = {3, {{-112, 30, 8, 1.70, HL_COOL_LIGHT, true},
                   { 118, 18, 8, 1.50, HL_WARM_LIGHT, true},
                   { -25, 35, 24, 0.16, WHITE, true}}, 0.275, false},
    /* light almost only from a cloudy sky: folds and hollows are darker, and no shadow has an edge */
    [OVERCAST] = {1, {{0, 80, 60, 0.30, WHITE, true}}, 2.75, true}};
/* clang-format on */

/* The sky's strength that a rig gives to scenes without a sky, divided by the key light's intensity. Scenes
 * of bare volumes have this ratio. */
#define SKY_OVER_KEY 0.345

const char *hl_light_rig_name(size_t index) { return index < RIGS ? hl_light_rig_choices[index].name : NULL; }

static const rig *rig_named(const char *name) {
  for (size_t n = 0; n < RIGS; n++)
    if (strcmp(hl_light_rig_choices[n].name, name) == 0) return &rigs[n];
  return NULL;
}

/* The intensity of which the rig's lights get fractions: the intensity of the scene's strongest light. For a
 * scene without lights, the intensity of hl_scene_key_light(), which such scenes get. */
static double key_intensity(const hl_scene_description *description) {
  hl_light key;
  double strongest = 0;
  for (size_t l = 0; l < description->light_count; l++)
    strongest = fmax(strongest, description->lights[l].intensity);
  hl_scene_key_light(&key);
  return strongest > 0 ? strongest : key.intensity;
}

/* The factor by which the fractions of all lamps are multiplied. A medium gets light from all lamps, whatever
 * their directions. So if no volume has surfaces, the factor limits the sum of all lamps to the strength of
 * the key light. */
static double share_factor(const rig *rig, const hl_scene_description *description) {
  double sum = 0;
  bool media = description->volume_count > 0 && description->mesh_count == 0;
  for (size_t v = 0; v < description->volume_count; v++)
    media &= description->volumes[v].shading == HL_SHADING_NONE;
  for (size_t l = 0; l < rig->count; l++) sum += rig->lights[l].share;
  return media && sum > 1 ? 1 / sum : 1;
}

static void make_grey(double color[3]) {
  const double luminance = 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
  for (int c = 0; c < 3; c++) color[c] = luminance;
}

/* Takes the colours of a gradient sky away. */
static void cloud_over(hl_sky *sky) {
  if (sky->type != HL_SKY_GRADIENT) return;
  make_grey(sky->zenith);
  make_grey(sky->horizon);
  make_grey(sky->ground);
}

hl_status hl_scene_light_rig(const char *rig, hl_scene_description *description,
                             hl_light lights[HL_LIGHT_RIG_MOST], hl_error *error) {
  HL_DOOR;
  if (rig == NULL || description == NULL || lights == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_scene_light_rig: null rig, description or lights");
  const struct rig *of = rig_named(rig);
  if (of == NULL) {
    const char *names[RIGS + 1] = {NULL};
    char mend[200];
    for (size_t n = 0; n < RIGS; n++) names[n] = hl_light_rig_choices[n].name;
    hl_suggest_name(rig, names, mend, sizeof mend);
    return hl_fail(error, HL_ERROR_ARGUMENT, "'%.80s' is no light rig: %s", rig, mend);
  }
  const double before = description->sky.strength, key = key_intensity(description);
  const double factor = share_factor(of, description);
  for (size_t l = 0; l < of->count; l++) {
    const rig_light *row = &of->lights[l];
    hl_light_defaults(&lights[l]);
    lights[l].frame = HL_LIGHT_FRAME_CAMERA;
    hl_light_direction_beside(row->azimuth_deg, row->elevation_deg, lights[l].direction);
    lights[l].angular_diameter_deg = row->diameter_deg;
    lights[l].intensity = row->share * factor * key;
    memcpy(lights[l].color, row->color, sizeof row->color);
    if (!row->shadows) lights[l].shadows = HL_SHADOWS_OFF;
  }
  description->lights = lights;
  description->light_count = of->count;
  if (description->sky.type == HL_SKY_NONE) {
    hl_scene_choose_sky(of->sky * SKY_OVER_KEY * key, description);
  } else {
    description->sky.strength = of->sky * before;
    for (int c = 0; c < 3; c++) description->ambient[c] = BESIDE_SKY * of->sky * before;
  }
  if (of->grey) cloud_over(&description->sky);
  return HL_OK;
}
