/* guess/function_writer.c - writes the transfer function of each look, by the analysis of a volume.
 *
 * Opacities are per smallest voxel edge. Surfaces become solid between the distances `faint` and `solid`.
 * Fields and media get an optical depth across the whole object, so that large and small grids look alike.
 */
#include "guess/function_writer.h"

#include <math.h>
#include <string.h>

#include "elementary/elementary.h"
#include "guess/analysis.h"
#include "scene/function/transfer_function.h"
#include "scene/scene.h"

#define FLOW_DEPTH   2.0  /* optical depth of a flow in which all values are shown */
#define MEDIUM_DEPTH 10.0 /* optical depth of smoke across the whole object */
#define METAL_DEPTH  12.0 /* optical depth of matter around metal across the whole object */
#define SHELL        0.2  /* optical depth of the shell of a field, along a line that crosses the shell */
#define PALE         0.25 /* fraction of white in the shell's colour */
/* The least mean distance of dense matter that is metal from the background, as a multiple of the objects'
 * mean distance. Measured: a stent in vessels has the multiple 4.3; seven scans without metal have multiples
 * of at most 2.1. */
#define METAL 3
/* The width of an object, in voxels, for which the opacities of solid matter were chosen. */
#define FINE 96

/* The distances dense and top, raised where needed so that solid < dense < top. */
static double dense_of(const hl_data_analysis *a) { return fmax(a->dense, a->solid + 1e-6 * a->top); }
static double top_of(const hl_data_analysis *a) { return fmax(a->top, dense_of(a) * 1.001); }

/* The colour of matter at a distance from the background. Linear RGB. */
typedef struct shade {
  double distance, color[3];
} shade;

/* Writes the function for solid matter. shades: [count]; the colours at rising distances. In coarse grids
 * fewer voxel edges lie between an object's rim and its inside, so the function makes each edge absorb more.
 */
static void write_solid(hl_function_writer *w, const shade *shades, size_t count) {
  const hl_data_analysis *a = w->analysis;
  const double ramp = a->solid - a->faint, dense = dense_of(a), edges = fmax(FINE / fmax(a->depth, 1), 1);
  const double rows[][2] = {{a->faint, 0},
                            {a->faint + 0.35 * ramp, 0.08},
                            {a->faint + 0.7 * ramp, 0.28},
                            {a->solid, 0.85},
                            {a->solid + 0.5 * (dense - a->solid), 0.93},
                            {dense, 0.97}};
  for (size_t n = 0; n < sizeof rows / sizeof *rows; n++)
    hl_add_opacity(w, rows[n][0], 1 - hl_pow(1 - rows[n][1], edges));
  for (size_t n = 0; n < count; n++) hl_add_color(w, shades[n].distance, shades[n].color);
}

/* Writes colours of several materials, from the lightest to the densest. Two materials are aluminium and
 * copper; more are sage, wood, stone and steel. From one material to the next, colours change within a tenth
 * of the way to the next valley. */
static void color_materials(hl_function_writer *w) {
  static const double two[2][3] = {{0.68, 0.69, 0.70}, {0.72, 0.38, 0.18}};
  static const double more[HL_MOST_MATERIALS][3] = {
      {0.54, 0.57, 0.36}, {0.62, 0.40, 0.23}, {0.70, 0.68, 0.64}, {0.62, 0.72, 0.82}};
  const hl_data_analysis *a = w->analysis;
  const double(*colors)[3] = a->material_count == 2 ? two : more;
  w->color_count = 0;
  hl_add_color(w, a->faint, colors[0]);
  for (int m = 0; m + 1 < a->material_count; m++) {
    double next = m + 2 < a->material_count ? a->valleys[m + 1] : fmax(a->top, 1.001 * a->valleys[m]),
           half = 0.1 * fmin(a->valleys[m] - (m > 0 ? a->valleys[m - 1] : a->faint), next - a->valleys[m]);
    hl_add_color(w, a->valleys[m] - half, colors[m]);
    hl_add_color(w, a->valleys[m] + half, colors[m + 1]);
  }
}

bool hl_data_holds_metal(const hl_data_analysis *a) {
  return a->material_count <= 1 && a->dense_mean > METAL * a->mean;
}

/* Writes the function for metal and the matter around it: flesh, bone and steel. The matter lets some light
 * pass, so that metal is seen within it, as a stent in a vessel. */
static void write_metal(hl_function_writer *w) {
  static const double wall[3] = {0.44, 0.12, 0.08}, flesh[3] = {0.60, 0.20, 0.12},
                      bone[3] = {0.89, 0.80, 0.65}, steel[3] = {0.62, 0.72, 0.82};
  const hl_data_analysis *a = w->analysis;
  const double metal = dense_of(a), before = fmax(0.85 * metal, a->solid),
               veil = hl_opacity_for(a, METAL_DEPTH);
  hl_add_opacity(w, a->faint, 0);
  hl_add_opacity(w, a->solid, veil);
  hl_add_opacity(w, before, veil);
  hl_add_opacity(w, metal, 0.9);
  hl_add_opacity(w, top_of(a), 0.97);
  hl_add_color(w, a->faint, wall);
  hl_add_color(w, a->solid, flesh);
  hl_add_color(w, before, bone);
  hl_add_color(w, metal, steel);
}

/* Writes ivory for one material, whose values differ by noise alone. Two tissues, such as the grey and the
 * white matter of a head, are ivory in two shades, so that they differ on the faces of cuts. */
void hl_write_matter(hl_function_writer *w) {
  const hl_data_analysis *a = w->analysis;
  const shade one[] = {{a->faint, {0.60, 0.53, 0.41}},
                       {a->solid, {0.76, 0.69, 0.56}},
                       {dense_of(a), {0.78, 0.78, 0.75}},
                       {top_of(a), {0.74, 0.83, 0.92}}};
  const shade two[] = {{a->faint, {0.60, 0.53, 0.41}},
                       {a->solid, {0.71, 0.64, 0.52}},
                       {a->light_mean, {0.64, 0.57, 0.46}},
                       {dense_of(a), {0.97, 0.96, 0.94}},
                       {top_of(a), {0.97, 0.97, 0.97}}};
  if (hl_data_holds_metal(a)) write_metal(w);
  else if (hl_data_is_one_material(a)) write_solid(w, one, sizeof one / sizeof *one);
  else write_solid(w, two, sizeof two / sizeof *two);
  if (a->material_count > 1) color_materials(w);
}

/* Writes the colours of skin, with flesh and bone inside; the faces of cuts show the difference between flesh
 * and bone. In CT flesh has the shades of a slice, from fluid, which has 0 Hounsfield units or a few less, to
 * muscle, which has 60. In other scans flesh takes a part of the way between the distances solid and dense.
 */
void hl_write_body(hl_function_writer *w) {
  const hl_data_analysis *a = w->analysis;
  const double fluid = -20 - a->background, muscle = 60 - a->background, way = dense_of(a) - a->solid;
  const bool ct = w->hounsfield && a->solid < fluid && muscle < a->dense;
  const shade flesh[2][2] = {
      {{a->solid + 0.4 * way, {0.64, 0.33, 0.23}}, {a->solid + 0.65 * way, {0.64, 0.33, 0.23}}},
      {{fluid, {0.44, 0.20, 0.13}}, {muscle, {0.76, 0.44, 0.34}}}};
  const shade shades[] = {
      {a->faint, {0.62, 0.36, 0.25}},    {a->solid, {0.76, 0.50, 0.37}}, flesh[ct][0], flesh[ct][1],
      {dense_of(a), {0.89, 0.80, 0.65}}, {top_of(a), {0.93, 0.91, 0.86}}};
  write_solid(w, shades, sizeof shades / sizeof *shades);
}

/* Writes the colours of a brain. Grey matter has nearly the colour of the surface, and white matter is nearly
 * white, so that the two differ on the faces of cuts. In MR weighted by T1 the lighter half of the values is
 * grey matter, and the denser half is white matter. */
void hl_write_brain(hl_function_writer *w) {
  const hl_data_analysis *a = w->analysis;
  const shade shades[] = {{a->faint, {0.60, 0.40, 0.35}},
                          {a->solid, {0.66, 0.46, 0.39}},
                          {a->light_mean, {0.66, 0.46, 0.39}},
                          {a->dense_mean, {0.97, 0.94, 0.90}}};
  write_solid(w, shades, sizeof shades / sizeof *shades);
}

/* The distance from the background at which a field's core begins. */
static double core_of(const hl_data_analysis *a) {
  return a->solid + 0.35 * (fmax(a->top, a->solid * 1.001) - a->solid);
}

/* Adds the opacities of a field on one side of its background (+1: above; -1: below): a clear shell around an
 * opaque core. Reflections show the shape of the shell, and the core is seen through it. Between shell and
 * core lies a trace of matter, which hardly dims the core. The trace makes the inside of the shell count as
 * matter where the grid cuts the shell off. */
static void add_shell_and_core(hl_function_writer *w, int side) {
  const hl_data_analysis *a = w->analysis;
  const double ramp = a->solid - a->faint, top = fmax(a->top, a->solid * 1.001), way = top - a->solid;
  const double shell = a->faint + 0.35 * ramp, core = core_of(a),
               half = fmin(fmin(0.03 * top, 0.25 * ramp), 0.15 * way);
  const double trace = 0.05; /* the optical depth, across the object, of matter between shell and core */
  /* The greatest opacity of the shell. Derived: if a field falls from its top to nothing over half of the
   * object, the shell's values, which span the width 2 * half, take the fraction half / top of the object.
   * The mean of a tent is half its peak. */
  const double peak = SHELL * 2 * top / half;
  const double rows[][2] = {{shell - half, 0},    {shell, peak}, {shell + half, trace},
                            {core - half, trace}, {core, 80},    {top, 80}};
  enum { ROWS = sizeof rows / sizeof *rows };
  for (int n = 0; n < ROWS; n++) {
    const double *row = rows[side > 0 ? n : ROWS - 1 - n];
    hl_add_opacity(w, side * row[0], hl_opacity_for(a, row[1]));
  }
}

void hl_write_field(hl_function_writer *w) {
  const hl_data_analysis *a = w->analysis;
  const double way = fmax(a->top, a->solid * 1.001) - a->solid;
  add_shell_and_core(w, 1);
  hl_add_colormap(w, "plasma", a->faint, core_of(a), 0.2, 0.8);
  /* White is mixed into the colours of the shell, because a shell of the map's dark colours would hardly
   * stand out from a dark background. */
  for (size_t n = 0; n < w->color_count; n++)
    for (int c = 0; c < 3; c++) {
      const double pale = PALE * (1 - (double)n / (double)w->color_count);
      w->color[n].color[c] += pale * (1 - w->color[n].color[c]);
    }
  hl_add_colormap(w, "plasma", core_of(a), a->solid + 0.6 * way, 0.8, 0.95);
}

/* Writes the function for particles. The densities of particles extend over many powers of ten, so the values
 * are logarithms. Values below the mean, which fill most of the space, are clear, and the densest matter is
 * nearly opaque. Each row has a value, as a fraction of the way from the mean to the densest value, and the
 * optical depth of matter with this value across the object. */
void hl_write_particles(hl_function_writer *w) {
  static const double rows[][2] = {{0, 0}, {0.3, 0.05}, {0.5, 0.5}, {0.65, 3}, {0.8, 15}, {1, 80}};
  const hl_data_analysis *a = w->analysis;
  double from = a->mean, top = fmax(a->top, 1.001 * from);
  for (size_t n = 0; n < sizeof rows / sizeof *rows; n++)
    hl_add_opacity(w, from + rows[n][0] * (top - from), hl_opacity_for(a, rows[n][1]));
  hl_add_colormap(w, "inferno", from, top, 0.25, 1);
}

/* Adds the opacities on one side of a flow's middle: common values are clear, and rare values are dense. Each
 * row has a value, as a fraction of the way from the middle to the last value, and an optical depth. */
static void add_rare(hl_function_writer *w, double reach, int side) {
  static const double rarity[][2] = {{0.4, 0}, {0.6, 0.5}, {0.8, 3}, {1, 20}};
  enum { STEPS = sizeof rarity / sizeof *rarity };
  double middle = w->analysis->middle - w->analysis->background;
  for (int n = 0; n < STEPS; n++) {
    int p = side > 0 ? n : STEPS - 1 - n;
    hl_add_opacity(w, middle + side * rarity[p][0] * reach, hl_opacity_for(w->analysis, rarity[p][1]));
  }
}

/* Writes the function for a flow: the extreme values on each side of the middle are dense. If no value is
 * common, all values are equally dense. */
void hl_write_flow(hl_function_writer *w) {
  const hl_data_analysis *a = w->analysis;
  double reach = fmax(a->lower, a->upper), middle = a->middle - a->background;
  w->direction = 1;
  if (a->common < 0.5) hl_add_opacity(w, middle, hl_opacity_for(a, FLOW_DEPTH));
  else {
    if (a->lower > 0.3 * reach) add_rare(w, a->lower, -1);
    if (a->upper > 0.3 * reach) add_rare(w, a->upper, 1);
  }
  hl_add_colormap(w, "plasma", middle - a->lower, middle + a->upper, 0.2, 0.94);
}

/* Kelly's colours of greatest contrast (1965), without greys and the darkest colours, followed by lighter
 * shades of the rest. */
static void label_color(size_t label, double linear[3]) {
  static const unsigned int kelly[] = {0xf3c300, 0x875692, 0xf38400, 0xa1caf1, 0xbe0032, 0xc2b280,
                                       0x008856, 0xe68fac, 0x0067a5, 0xf99379, 0x604e97, 0xf6a600,
                                       0xb3446c, 0xdcd300, 0x8db600, 0xe25822};
  enum { COLORS = sizeof kelly / sizeof *kelly };
  double lighter = fmin((double)(label / COLORS) * 0.3, 0.6);
  for (int c = 0; c < 3; c++) {
    double srgb = (double)(kelly[label % COLORS] >> (16 - 8 * c) & 255) / 255;
    linear[c] = hl_srgb_decode(srgb + lighter * (1 - srgb));
  }
}

/* Makes a label opaque only close to its own number. Between two regions the kernel interpolates numbers that
 * belong to neither region; such numbers must stay clear. */
static void add_label(hl_function_writer *w, double label, double before, double after, double narrowest) {
  static const double part = 0.03; /* fraction of the way to the next number */
  double down = fmin(fmax(part * (label - before), narrowest), 0.45 * (label - before)),
         up = fmin(fmax(part * (after - label), narrowest), 0.45 * (after - label)),
         at = label - w->analysis->background;
  hl_add_opacity(w, at - down, 0);
  hl_add_opacity(w, at - 0.5 * down, 0.97);
  hl_add_opacity(w, at + 0.5 * up, 0.97);
  hl_add_opacity(w, at + up, 0);
}

void hl_write_labels(hl_function_writer *w) {
  const hl_data_analysis *a = w->analysis;
  size_t last = a->label_count - 1;
  double narrowest = (a->labels[last] - fmin(a->labels[0], 0)) /
                     2000; /* two steps of the renderer's tables */
  w->direction = 1;
  for (size_t n = 0; n <= last; n++) {
    double label = a->labels[n], before = n > 0 ? a->labels[n - 1] : label - 1,
           after = n < last ? a->labels[n + 1] : label + 1;
    if (before < 0 && label > 0) before = 0; /* 0 may be a value of the volume, though it is no label */
    if (label < 0 && after > 0) after = 0;
    double color[3];
    label_color(n, color);
    add_label(w, label, before, after, narrowest);
    hl_add_color(w, 0.5 * (before + label) - a->background, color);
    hl_add_color(w, 0.5 * (label + after) - a->background, color);
  }
}

void hl_write_medium(hl_function_writer *w) {
  const hl_data_analysis *a = w->analysis;
  static const double white[3] = {0.8, 0.8, 0.8};
  for (int step = 0; step <= 32; step++) {
    double distance = a->top * step / 32;
    hl_add_opacity(w, distance, hl_opacity_for(a, MEDIUM_DEPTH * distance / a->mean));
  }
  hl_add_color(w, 0, white);
}

/* Writes the function for a field on both sides of the background: in blue and in orange. */
void hl_write_signed(hl_function_writer *w) {
  const hl_data_analysis *a = w->analysis;
  static const double cold[3][3] = {{0.10, 0.30, 0.75}, {0.06, 0.18, 0.62}, {0.02, 0.06, 0.35}};
  static const double warm[3][3] = {{0.95, 0.52, 0.20}, {0.85, 0.28, 0.08}, {0.60, 0.08, 0.03}};
  w->direction = 1; /* the function has points on both sides of the background */
  const double top = fmax(a->top, a->solid * 1.001), at[3] = {a->faint, a->solid, top};
  add_shell_and_core(w, -1);
  add_shell_and_core(w, 1);
  for (int p = 2; p >= 0; p--) hl_add_color(w, -at[p], cold[p]);
  for (int p = 0; p < 3; p++) hl_add_color(w, at[p], warm[p]);
}

void hl_write_constant(hl_function_writer *w) {
  static const double grey[3] = {0.6, 0.6, 0.6};
  hl_add_opacity(w, 0, 0.2);
  hl_add_color(w, 0, grey);
}

/* ---- points ---- */

void hl_begin_function(hl_function_writer *w, const hl_volume *volume, const hl_data_analysis *analysis) {
  *w = (hl_function_writer){
      .analysis = analysis, .hounsfield = hl_is_hounsfield(volume), .direction = analysis->direction};
}

void hl_add_opacity(hl_function_writer *w, double distance, double opacity) {
  if (w->opacity_count == sizeof w->opacity / sizeof *w->opacity) return;
  double value = w->analysis->background + w->direction * distance;
  w->opacity[w->opacity_count++] = (hl_opacity_point){value, fmin(fmax(opacity, 0), 1)};
}

void hl_add_color(hl_function_writer *w, double distance, const double color[3]) {
  if (w->color_count == sizeof w->color / sizeof *w->color) return;
  hl_color_point *point = &w->color[w->color_count++];
  point->value = w->analysis->background + w->direction * distance;
  memcpy(point->color, color, sizeof point->color);
}

void hl_add_colormap(hl_function_writer *w, const char *name, double from, double to, double start,
                     double end) {
  for (int step = 0; step <= 32; step++) {
    double t = step / 32.0, color[3];
    hl_colormap_evaluate(name, start + t * (end - start), color);
    hl_add_color(w, step < 32 ? from + t * (to - from) : to, color); /* the last point lies exactly at `to`,
                                                                      * not beyond it by rounding */
  }
}

double hl_opacity_for(const hl_data_analysis *analysis, double optical_depth) {
  return 1 - hl_exp(-optical_depth / fmax(analysis->depth, 1));
}

/* Reverses the order of the points if objects lie below the background, because points are added with rising
 * distance, and so with falling value. */
static void put_in_order(hl_function_writer *w) {
  if (w->direction > 0) return;
  for (size_t a = 0, b = w->opacity_count; a + 1 < b; a++) {
    hl_opacity_point swap = w->opacity[--b];
    w->opacity[b] = w->opacity[a];
    w->opacity[a] = swap;
  }
  for (size_t a = 0, b = w->color_count; a + 1 < b; a++) {
    hl_color_point swap = w->color[--b];
    w->color[b] = w->color[a];
    w->color[a] = swap;
  }
}

hl_status hl_finish_function(hl_function_writer *w, hl_context *context, const hl_volume *volume,
                             hl_transfer_function *function, hl_error *error) {
  put_in_order(w);
  double edge = mat3_shortest_column(volume->index_to_world.linear);
  hl_transfer_function made = {.unit_distance = edge,
                               .opacity = w->opacity,
                               .opacity_count = w->opacity_count,
                               .color = w->color,
                               .color_count = w->color_count};
  return hl_transfer_function_copy(context, &made, function, error);
}
