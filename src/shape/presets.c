/* shape/presets.c - ready-made shapes, as texts that hl_volume_from_shapes() reads. */
#include <halflight/shape.h>

#include <string.h>

typedef struct preset { const char *name, *summary, *text; } preset;

static const preset presets[] = {
    {"sphere", "a ball", "{\"shapes\": [{\"type\": \"sphere\", \"radius\": 1}]}"},
    {"torus", "a ring", "{\"shapes\": [{\"type\": \"torus\", \"radius\": 1, \"tube_radius\": 0.3}]}"},
    {"rings", "three rings through each other",
     "{\"shapes\": [\n"
     "  {\"type\": \"torus\", \"radius\": 1, \"tube_radius\": 0.22},\n"
     "  {\"type\": \"torus\", \"radius\": 1, \"tube_radius\": 0.22, \"position\": [1, 0, 0],\n"
     "   \"rotate\": {\"axis\": [1, 0, 0], \"angle_deg\": 90}},\n"
     "  {\"type\": \"torus\", \"radius\": 1, \"tube_radius\": 0.22, \"position\": [2, 0, 0]}]}"},
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
     "    {\"type\": \"sphere\", \"radius\": 0.7},\n"
     "    {\"type\": \"sphere\", \"radius\": 0.5, \"position\": [0.8, 0.1, -0.15], \"blend\": 0.3},\n"
     "    {\"type\": \"sphere\", \"radius\": 0.45, \"position\": [-0.8, 0, -0.2], \"blend\": 0.3},\n"
     "    {\"type\": \"sphere\", \"radius\": 0.35, \"position\": [-0.2, -0.4, -0.3], \"blend\": 0.3},\n"
     "    {\"type\": \"sphere\", \"radius\": 0.3, \"position\": [1.3, 0, -0.3], \"blend\": 0.3},\n"
     "    {\"type\": \"box\", \"size\": [4, 3, 1], \"position\": [0, 0, -0.95], \"operation\": \"subtract\",\n"
     "     \"blend\": 0.2}],\n"
     "  \"hypertexture\": {\"frequency\": 1.6, \"octaves\": 6, \"amplitude\": 0.6, \"soft\": 0.3}}]}"},
    {"orbital", "the wave function of hydrogen's 3d orbital, m = 0, -1 to 1",
     "{\"shapes\": [{\"type\": \"orbital\", \"n\": 3, \"l\": 2, \"m\": 0, \"radius\": 1}]}"},
};

enum { PRESET_COUNT = sizeof presets / sizeof *presets };

const char *hl_shape_preset_name(size_t index) { return index < PRESET_COUNT ? presets[index].name : NULL; }

const char *hl_shape_preset_summary(size_t index) { return index < PRESET_COUNT ? presets[index].summary : NULL; }

const char *hl_shape_preset_text(const char *name) {
  for (size_t p = 0; name != NULL && p < PRESET_COUNT; p++)
    if (strcmp(presets[p].name, name) == 0) return presets[p].text;
  return NULL;
}
