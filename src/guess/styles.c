/* guess/styles.c - see styles.h. Opacities are per smallest voxel edge. Opacities are given at distances from
 * the background that the analysis has found. */
#include "guess/styles.h"

#include <math.h>
#include <string.h>

#include "text/edit_distance.h"

/* Opacities at rising distances from the background. */
typedef struct opacity_step {
  double distance, opacity;
} opacity_step;

/* Adds the steps to the function, on both sides of the background if objects have values on both sides. */
static void add_steps(hl_function_writer *w, const opacity_step *steps, int count) {
  w->opacity_count = 0;
  if (w->analysis->kind == HL_DATA_SIGNED) {
    w->direction = 1;
    for (int n = count - 1; n >= 0; n--) hl_add_opacity(w, -steps[n].distance, steps[n].opacity);
  }
  for (int n = 0; n < count; n++) hl_add_opacity(w, steps[n].distance, steps[n].opacity);
}

/* The distance from which on matter is inner matter: the dense matter of an object. In an object that is
 * dense for the most part, all solid matter is inner matter. */
static double inner_of(const hl_data_analysis *a) {
  return a->dense_share > 0.5 ? a->solid : fmax(a->dense, 1.001 * a->solid);
}

/* Writes one opaque surface, half way from the background to matter. */
static void write_surface(hl_function_writer *w) {
  const hl_data_analysis *a = w->analysis;
  double ramp = a->solid - a->faint;
  const opacity_step steps[] = {{a->faint + 0.3 * ramp, 0}, {a->faint + 0.6 * ramp, 0.5}, {a->solid, 0.97}};
  add_steps(w, steps, 3);
}

/* Writes the outside of matter, and the walls of all holes in it, as shells. Voxels at the boundary of matter
 * have values half way from the background to the value of the matter. The matter within is nearly clear. */
static void write_shells(hl_function_writer *w) {
  const hl_data_analysis *a = w->analysis;
  double veil = hl_opacity_for(a, 0.2);
  const opacity_step steps[] = {{0.25 * a->mean, 0},
                                {0.5 * a->mean, 0.1},
                                {0.8 * a->mean, veil},
                                {fmax(a->top, 0.801 * a->mean), veil}};
  add_steps(w, steps, 4);
}

/* Writes thin outer matter around opaque inner matter. */
static void write_translucent(hl_function_writer *w) {
  const hl_data_analysis *a = w->analysis;
  if (a->kind == HL_DATA_SURFACES && hl_data_is_one_material(a)) {
    write_shells(w);
    return;
  }
  double inner = inner_of(a), top = fmax(a->top, 1.001 * inner), veil = hl_opacity_for(a, 1.2);
  const opacity_step steps[] = {{a->faint, 0},
                                {a->faint + 0.5 * (a->solid - a->faint), veil},
                                {fmax(0.85 * inner, a->solid), veil},
                                {inner + 0.1 * (top - inner), 0.5},
                                {inner + 0.3 * (top - inner), 0.95}};
  add_steps(w, steps, 5);
}

/* Writes absorption that grows with the square of the distance, so that dense matter is seen through thinner
 * matter, as in an X-ray picture: white on black. */
static void write_xray(hl_function_writer *w) {
  enum { STEPS = 24 };
  static const double white[3] = {1, 1, 1}, depth = 0.5;
  const hl_data_analysis *a = w->analysis;
  opacity_step steps[STEPS + 1];
  for (int n = 0; n <= STEPS; n++) {
    double distance = a->top * n / STEPS;
    double over = fmax(distance - 0.5 * a->faint, 0); /* the noise of air stays black */
    steps[n] = (opacity_step){distance, hl_opacity_for(a, depth * over * over / (a->mean * a->mean))};
  }
  add_steps(w, steps, STEPS + 1);
  w->color_count = 0;
  hl_add_color(w, 0, white);
}

static void write_smoke(hl_function_writer *w) {
  static const double grey[3] = {0.8, 0.8, 0.8};
  const hl_data_analysis *a = w->analysis;
  const opacity_step steps[] = {{0.5 * a->faint, 0},
                                {a->solid, hl_opacity_for(a, 3)},
                                {fmax(a->top, 1.001 * a->solid), hl_opacity_for(a, 12)}};
  add_steps(w, steps, 3);
  w->color_count = 0;
  hl_add_color(w, 0, grey);
}

/* Writes only the brightest matter, in colours from red to cream, as vessels with a contrast medium show it.
 * If vessels were found, opacity begins a little below their values, because voxels at their edges also
 * contain the matter around them. Metal, such as a stent, is brighter than vessels: in a scan with metal, the
 * vessels are the solid matter darker than the metal. */
static void write_vessels(hl_function_writer *w) {
  static const double wall[3] = {0.42, 0.03, 0.02}, blood[3] = {0.75, 0.10, 0.05},
                      bright[3] = {0.95, 0.75, 0.50};
  const hl_data_analysis *a = w->analysis;
  const bool metal = a->kind == HL_DATA_SURFACES && !(a->vessels > 0) && hl_data_holds_metal(a);
  double from = a->vessels > 0 ? 0.9 * a->vessels
                : metal        ? a->solid
                               : inner_of(a),
         top = fmax(metal ? inner_of(a) : a->top, 1.001 * from), way = top - from;
  const opacity_step steps[] = {
      {from, 0}, {from + 0.1 * way, 0.15}, {from + 0.25 * way, 0.7}, {from + 0.5 * way, 0.97}};
  add_steps(w, steps, 4);
  w->color_count = 0;
  w->direction = w->analysis->kind == HL_DATA_SIGNED ? 1 : w->direction;
  hl_add_color(w, from, wall);
  hl_add_color(w, from + 0.4 * way, blood);
  hl_add_color(w, top, bright);
}

/* The columns of the table are the columns of the table in looks.c. */
static const hl_look styles[] = {
    {"surface", write_surface, HL_SHADING_PHONG, HL_KERNEL_BSPLINE, HL_LIGHT_OF_SURFACES, 0.72, false,
     "translucent", false, "surface"},
    {"translucent", write_translucent, HL_SHADING_PHONG, HL_KERNEL_BSPLINE, HL_LIGHT_OF_SHELLS, 0.72, false,
     "surface", false, "translucent"},
    {"xray",
     write_xray,
     HL_SHADING_FLAT,
     HL_KERNEL_BSPLINE,
     {1.20, 0, 0, false},
     0,
     true,
     "translucent",
     false,
     "xray"},
    {"smoke", write_smoke, HL_SHADING_NONE, HL_KERNEL_BSPLINE, HL_LIGHT_OF_MEDIA, 0, false, "surface", false,
     "smoke"},
    {"vessels", write_vessels, HL_SHADING_PHONG, HL_KERNEL_BSPLINE, HL_LIGHT_OF_SURFACES, 0.75, true,
     "surface", false, "vessels"},
};

enum { STYLES = sizeof styles / sizeof *styles };

const hl_look *hl_style(size_t index) { return index < STYLES ? &styles[index] : NULL; }

const hl_look *hl_style_find(const char *name) {
  for (size_t n = 0; n < STYLES; n++)
    if (strcmp(styles[n].name, name) == 0) return &styles[n];
  return NULL;
}

void hl_style_write(const hl_look *style, const hl_look *base, hl_function_writer *w) {
  const bool is_own = base->style != NULL && strcmp(base->style, style->name) == 0;
  base->write(w);
  if (w->analysis->kind != HL_DATA_CONSTANT && !is_own) style->write(w);
}

hl_status hl_style_named(const char *name, const hl_look **style, hl_error *error) {
  const char *names[STYLES + 2] = {"auto"};
  for (size_t n = 0; n < STYLES; n++) names[n + 1] = styles[n].name;
  *style = hl_style_find(name);
  if (*style != NULL || strcmp(name, "auto") == 0) return HL_OK;
  char mend[300];
  hl_suggest_name(name, names, mend, sizeof mend);
  return hl_fail(error, HL_ERROR_INPUT, "unknown look \"%.80s\": %s", name, mend);
}
