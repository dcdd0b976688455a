/* light/phase_table.c - see phase_table.h. */
#include "light/phase_table.h"

#include <math.h>

#include "core/memory.h"
#include "core/vector.h"
#include "elementary/elementary.h"
#include "light/light_caps.h"
#include "scene/light/light_kind.h"

/* ---- the mean over a cap ---- */

/* The number of places at which mean_over_cap() evaluates its integral. */
enum { RING_COUNT = 32 };

typedef struct ring_places {
  double cosine[RING_COUNT], sine[RING_COUNT];
} ring_places;

static void place_rings(ring_places *rings) {
  for (int i = 0; i < RING_COUNT; i++) {
    double turn = (i + 0.5) * HL_PI / RING_COUNT;
    rings->cosine[i] = hl_cos(turn);
    rings->sine[i] = hl_sin(turn);
  }
}

static double s_of(double g, double cosine) {
  return sqrt(fmax(1 + g * g - 2 * g * cosine, (1 - g) * (1 - g)));
}

static double cosine_of(double g, double s) { return fmin(fmax((1 + g * g - s * s) / (2 * g), -1), 1); }

/* The mean of the phase function p over a cap: the directions that are within acos(c) of the cap's middle. c:
 * below 1. T is the angle between the cap's middle and the direction in which light goes straight on.
 * towards: the cosine of T.
 *
 * Derived: all directions at one angle t from straight on form a ring, on which p has one value. The cap
 * holds a fraction f(t) of the ring: all, nothing, or acos((c - cos t cos T) / (sin t sin T)) / pi.
 * With s^2 = 1 + g^2 - 2 g cos t
 * and x = 1 / s, p sin t dt = -(1 - g^2) / g dx.
 *
 * The mean is therefore the integral of f dx times (1 - g^2) / (g (1 - c)). Where f is not constant, x
 * goes from m - h to m + h, and x = m + h cos(u) removes the square roots at both ends. */
static double mean_over_cap(double g, double c, double towards, const ring_places *rings) {
  double turn = hl_acos(towards), half = hl_acos(c), sine = hl_sin(turn);
  double nearest = fabs(turn - half), farthest = fmin(turn + half, 2 * HL_PI - turn - half);
  double low = 1 / s_of(g, hl_cos(farthest)), high = 1 / s_of(g, hl_cos(nearest)), sum = 0;
  for (int i = 0; i < RING_COUNT; i++) {
    double x = (low + high) / 2 + (high - low) / 2 * rings->cosine[i];
    double ring = cosine_of(g, 1 / x), across = sqrt(fmax(1 - ring * ring, 0)) * sine;
    double edge = across > 0 ? (c - ring * towards) / across : c > ring * towards ? 1 : -1;
    sum += rings->sine[i] * hl_acos(fmin(fmax(edge, -1), 1)) / HL_PI;
  }
  sum *= (high - low) / 2 * HL_PI / RING_COUNT;
  /* Adds the rings around the cap's middle that lie completely within the cap. */
  if (turn < half) sum += 1 / (1 - g) - high;
  if (turn + half > HL_PI)
    sum += low - 1 / (1 + g); /* adds the rings around the opposite direction that lie completely within the
                               * cap */
  return (1 - g * g) / (g * (1 - c)) * sum;
}

/* Fills a row of a table with the means of the phase function over a cap. c: the cosine of the angle between
 * the cap's edge and its middle. apart: the number of floats from one number of the row to the next. */
static void fill_row(double g, double c, const ring_places *rings, float *row, size_t apart) {
  for (int i = 0; i < PHASE_COLUMNS; i++) {
    double s = 1 - g + 2 * g * i / (PHASE_COLUMNS - 1);
    float *at = row + (size_t)i * apart;
    *at = 1;
    if (c < 1) *at = (float)(mean_over_cap(g, c, cosine_of(g, s), rings) * s * s * s / (1 - g * g));
  }
}

/* ---- the tables of a scene ---- */

static bool scatters_unevenly(const hl_scene_volume *volume) {
  return volume->anisotropy != 0 && volume->shading != HL_SHADING_FLAT;
}

/* Returns whether some light of a scene is wide: whether its size matters to the phase function. near:
 * whether only lights that are not parallel count. */
static bool has_wide_light(const hl_scene_description *scene, bool near) {
  bool found = false;
  for (size_t i = 0; i < scene->light_count; i++)
    found = found || (hl_light_shape(&scene->lights[i]).is_wide &&
                      !(near && hl_light_kind(&scene->lights[i])->parallel));
  return found;
}

/* Returns whether the tables need rows for caps of all sizes, because a light is wide and near, or because
 * the scene has a sky. */
static bool needs_caps(const hl_scene_description *scene) {
  return scene->sky.type != HL_SKY_NONE || has_wide_light(scene, true);
}

/* The number of tables that a scene needs. A volume that scatters unevenly needs a table for its anisotropy
 * g. If light is scattered more than once in the volume, the volume also needs a table for g^2. */
static size_t wanted_tables(const hl_scene_description *scene) {
  size_t count = 0;
  if (scene->render.compositing != HL_COMPOSITING_LIGHT ||
      (scene->sky.type == HL_SKY_NONE && !has_wide_light(scene, false)))
    return 0;
  for (size_t v = 0; v < scene->volume_count; v++)
    if (scatters_unevenly(&scene->volumes[v])) count += scene->volumes[v].multiple_scattering ? 2 : 1;
  return count;
}

/* The number of floats of one table. A table consists of rows for parallel lights, followed by rows for
 * caps. */
static size_t table_size(const hl_scene_description *scene) {
  return PHASE_COLUMNS * (scene->light_count + (needs_caps(scene) ? 2 * PHASE_CAPS : 0));
}

static void lay_out(const hl_scene_description *scene, phase_tables *tables, hl_layout *layout) {
  size_t most = wanted_tables(scene);
  tables->tables = hl_layout_take(layout, most, sizeof *tables->tables);
  tables->numbers = hl_layout_take(layout, most, table_size(scene) * sizeof *tables->numbers);
}

void hl_phase_count(const hl_scene_description *scene, hl_layout *layout) {
  lay_out(scene, &(phase_tables){0}, layout);
}

void hl_phase_release(hl_context *context, phase_tables *tables) {
  hl_release(context, tables->memory);
  hl_key_release(context, &tables->key);
  *tables = (phase_tables){0};
}

const phase_table *hl_phase_table(const phase_tables *tables, double anisotropy) {
  for (size_t i = 0; i < tables->count; i++)
    if (tables->tables[i].g == fabs(anisotropy)) return &tables->tables[i];
  return NULL;
}

static void write_key(const void *data, hl_key *key) {
  const hl_scene_description *scene = data;
  hl_key_add_whole(key, needs_caps(scene));
  for (size_t i = 0; i < scene->light_count; i++) {
    const hl_light *light = &scene->lights[i];
    bool parallel = hl_light_kind(light)->parallel;
    hl_key_add_whole(key, hl_light_shape(light).is_wide ? parallel ? 2 : 1 : 0);
    if (parallel) hl_key_add_numbers(key, &light->angular_diameter_deg, 1);
  }
  for (size_t v = 0; v < scene->volume_count; v++) {
    const hl_scene_volume *volume = &scene->volumes[v];
    if (!scatters_unevenly(volume)) continue;
    hl_key_add_numbers(key, &volume->anisotropy, 1);
    hl_key_add_whole(key, volume->multiple_scattering);
  }
}

typedef struct phase_job {
  const hl_scene_description *scene;
  const phase_tables *tables;
  bool with_caps;
  ring_places rings;
} phase_job;

/* Fills the rows of caps. The row of each cap size is stored in two places: as the numbers [0] of its own row
 * of the table, and as the numbers [1] of the row before. */
static void fill_caps(const phase_job *job, const phase_table *table, size_t row) {
  double g = table->g, part = (double)row / (PHASE_CAPS - 1), s = (1 - g) * hl_pow((1 + g) / (1 - g), part);
  float(*to)[2] = table->caps[row];
  fill_row(g, row > 0 ? cosine_of(g, s) : 1, &job->rings, &to[0][0], 2);
  for (int i = 0; i < PHASE_COLUMNS; i++) {
    if (row > 0) to[i - PHASE_COLUMNS][1] = to[i][0];
    if (row == PHASE_CAPS - 1) to[i][1] = to[i][0];
  }
}

/* Fills one row of one table. */
static void fill_row_of_table(void *data, size_t index, int worker) {
  (void)worker;
  const phase_job *job = data;
  const hl_scene_description *scene = job->scene;
  const size_t lights = scene->light_count, rows = lights + (job->with_caps ? PHASE_CAPS : 0),
               row = index % rows;
  const phase_table *table = &job->tables->tables[index / rows];
  if (row >= lights) {
    fill_caps(job, table, row - lights);
    return;
  }
  const hl_light *light = &scene->lights[row];
  if (hl_light_kind(light)->parallel && hl_light_shape(light).is_wide)
    fill_row(table->g, hl_cos(light->angular_diameter_deg * HL_PI / 360), &job->rings, table->parallel[row],
             1);
}

static void add_table(const hl_scene_description *scene, double anisotropy, phase_tables *tables) {
  if (hl_phase_table(tables, anisotropy) != NULL) return;
  double g = fabs(anisotropy), range = 2 * hl_log2((1 + g) / (1 - g));
  float *numbers = tables->numbers + tables->count * table_size(scene);
  tables->tables[tables->count++] = (phase_table){
      .g = g,
      .rows_per_log2 = (float)((PHASE_CAPS - 1) / range),
      .caps = (float(*)[PHASE_COLUMNS][2])(numbers + scene->light_count * PHASE_COLUMNS),
      .parallel = (float(*)[PHASE_COLUMNS])numbers};
}

hl_status hl_phase_update(hl_context *context, hl_pool *pool, const hl_scene_description *scene,
                          phase_tables *tables, hl_error *error) {
  if (wanted_tables(scene) == 0) {
    hl_phase_release(context, tables);
    return HL_OK;
  }
  bool same;
  hl_status status = hl_key_renew(context, write_key, scene, &tables->key, &same, error);
  if (status != HL_OK || (same && tables->count > 0)) return status;
  hl_release(context, tables->memory);
  tables->count = 0;
  hl_layout layout = {0};
  while (hl_layout_pass(&layout, context)) lay_out(scene, tables, &layout);
  tables->memory = layout.base;
  tables->bytes = layout.bytes;
  if (tables->memory == NULL) return hl_fail_memory(error, layout.bytes, "means of phase functions");
  for (size_t v = 0; v < scene->volume_count; v++) {
    const hl_scene_volume *volume = &scene->volumes[v];
    if (!scatters_unevenly(volume)) continue;
    add_table(scene, volume->anisotropy, tables);
    if (volume->multiple_scattering) add_table(scene, volume->anisotropy * volume->anisotropy, tables);
  }
  phase_job job = {.scene = scene, .tables = tables, .with_caps = needs_caps(scene)};
  place_rings(&job.rings);
  size_t rows = scene->light_count + (job.with_caps ? PHASE_CAPS : 0);
  hl_pool_run(pool, tables->count * rows, fill_row_of_table, &job);
  return HL_OK;
}
