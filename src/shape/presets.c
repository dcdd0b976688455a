/* shape/presets.c - defines ready-made shapes. Each of them is a JSON text that hl_volume_from_shapes()
 * reads. */
#include <halflight/shape.h>

#include <string.h>

typedef struct preset {
  const char *name, *summary, *text;
} preset;

static const preset presets[] = {
    {"sphere", "a ball", "{\"shapes\": [{\"type\": \"sphere\", \"radius\": 1}]}"},
    {"torus", "a ring", "{\"shapes\": [{\"type\": \"torus\", \"radius\": 1, \"tube_radius\": 0.3}]}"},
    {"rings", "three rings, linked",
     "{\"shapes\": [\n"
     "  {\"type\": \"torus\", \"radius\": 1, \"tube_radius\": 0.18},\n"
     "  {\"type\": \"torus\", \"radius\": 1, \"tube_radius\": 0.18, \"position\": [1, 0, 0],\n"
     "   \"rotate\": {\"axis\": [1, 0, 0], \"angle_deg\": 90}},\n"
     "  {\"type\": \"torus\", \"radius\": 1, \"tube_radius\": 0.18, \"position\": [2, 0, 0]}]}"},
    {"hypertexture", "a ball that turbulence has eaten into",
     "{\"shapes\": [{\"type\": \"sphere\", \"radius\": 36,\n"
     "  \"hypertexture\": {\"frequency\": 0.042, \"octaves\": 5, \"gain\": 0.75, \"amplitude\": 30, "
     "\"soft\": 3.5}}]}"},
    {"furry-sphere", "hypertexture: a ball with fur",
     "{\"shapes\": [{\"type\": \"sphere\", \"radius\": 1,\n"
     "  \"hypertexture\": {\"pattern\": \"noise\", \"frequency\": 14, \"gain\": 0.8, \"amplitude\": 0.55,\n"
     "    \"soft\": 0.12, \"strands\": true}}]}"},
    {"eroded-cube", "hypertexture: a cube that turbulence has eaten into",
     "{\"shapes\": [{\"type\": \"box\", \"size\": [2, 2, 2], \"rounding\": 0.1,\n"
     "  \"hypertexture\": {\"frequency\": 2, \"octaves\": 5, \"gain\": 0.7, \"amplitude\": 0.7}}]}"},
    {"fire-ball", "hypertexture: a ball of fire, thin at its rim",
     "{\"shapes\": [{\"type\": \"sphere\", \"radius\": 1,\n"
     "  \"hypertexture\": {\"frequency\": 2, \"octaves\": 6, \"amplitude\": 0.9, \"soft\": 0.9}}]}"},
    {"cloud", "hypertexture: a cumulus",
     "{\"shapes\": [{\"type\": \"group\", \"shapes\": [\n"
     "    {\"type\": \"sphere\", \"radius\": 27, \"position\": [-4, 0, 8]},\n"
     "    {\"type\": \"sphere\", \"radius\": 20, \"position\": [24, 4, 1], \"blend\": 6},\n"
     "    {\"type\": \"sphere\", \"radius\": 18, \"position\": [-32, -2, 0], \"blend\": 6},\n"
     "    {\"type\": \"sphere\", \"radius\": 15, \"position\": [6, -18, -2], \"blend\": 6},\n"
     "    {\"type\": \"sphere\", \"radius\": 12, \"position\": [44, -2, -4], \"blend\": 6},\n"
     "    {\"type\": \"box\", \"size\": [160, 120, 40], \"position\": [0, 0, -30], \"operation\": "
     "\"subtract\",\n"
     "     \"blend\": 8}],\n"
     "  \"hypertexture\": {\"frequency\": 0.055, \"octaves\": 6, \"amplitude\": 24, \"soft\": 9}}]}"},
    {"orbital", "the wave function of hydrogen's 3d orbital with m = 1, from -1 to 1",
     "{\"shapes\": [{\"type\": \"orbital\", \"n\": 3, \"l\": 2, \"m\": 1, \"radius\": 1}]}"},
};

enum { PRESET_COUNT = sizeof presets / sizeof *presets };

const char *hl_shape_preset_name(size_t index) { return index < PRESET_COUNT ? presets[index].name : NULL; }

const char *hl_shape_preset_summary(size_t index) {
  return index < PRESET_COUNT ? presets[index].summary : NULL;
}

const char *hl_shape_preset_text(const char *name) {
  for (size_t p = 0; name != NULL && p < PRESET_COUNT; p++)
    if (strcmp(presets[p].name, name) == 0) return presets[p].text;
  return NULL;
}
