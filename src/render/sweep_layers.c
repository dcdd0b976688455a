/* render/sweep_layers.c - see sweep_layers.h. */
#include "render/sweep_layers.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"

/* Sets up white copies of the volumes. The copies of the first list send on all light that arrives. The
 * copies of the second list shade as the volumes do. The copies of the third list shade in the same way, but
 * receive no shadow. */
static void set_up_white_volumes(sweep *sweep) {
  sweep_layers *layers = &sweep->layers;
  for (size_t i = 0; i < CLASSIFIER_ENTRIES + 2; i++)
    layers->ones[i][0] = layers->ones[i][1] = layers->ones[i][2] = 1;
  for (int g = 0; g < sweep->content.volume_count; g++) {
    layers->white[g] = *sweep->content.volumes[g].classifier;
    layers->white[g].color = layers->ones;
    layers->white[g].plane.color = NULL;
    shade_volume white = sweep->constants.volumes[g];
    white.classifier = &layers->white[g];
    white.colors.voxels = NULL;
    white.ambient = white.emission = 0;
    white.absorbs = white.multiple = 0;
    layers->white_volumes[g] = layers->open_volumes[g] = white;
    layers->open_volumes[g].receives_shadow = 0;
    white.even = 1;
    white.specular = 0;
    white.anisotropy = 0;
    white.lit = 1;
    layers->even_volumes[g] = white;
  }
}

static void set_up_white_light(const shade_light *from, shade_light *white) {
  *white = *from;
  white->inverse_square = 0;
  white->texture = (light_texture){0};
  white->cone = (light_cone){.scale = 0};
  for (int c = 0; c < 3; c++) white->color[c] = 1;
}

/* The greatest number of passes that do not belong to lights: ambient light, emission, the sky, the sky's two
 * pictures of white volumes, and measures. */
enum { MOST_OTHER_PASSES = 6 };

static bool wants_layers(const sweep *sweep) {
  return sweep->target.layers != NULL && sweep->target.layers->wanted != NULL;
}

/* Lays out all arrays of the layers in one block, which begins with the passes. */
static void lay_out(sweep *sweep, hl_layout *layout) {
  sweep_layers *layers = &sweep->layers;
  const size_t lights = (size_t)sweep->geometry->light_count, volumes = (size_t)sweep->content.volume_count,
               threads = (size_t)hl_pool_threads(sweep->content.pool);
  layers->passes = hl_layout_take(layout, 3 * lights + MOST_OTHER_PASSES, sizeof *layers->passes);
  layers->white_lights = hl_layout_take(layout, lights, sizeof *layers->white_lights);
  layers->even_volumes = hl_layout_take(layout, volumes, sizeof *layers->even_volumes);
  layers->white_volumes = hl_layout_take(layout, volumes, sizeof *layers->white_volumes);
  layers->open_volumes = hl_layout_take(layout, volumes, sizeof *layers->open_volumes);
  layers->patches = hl_layout_take(layout, threads * volumes, sizeof *layers->patches);
  layers->white = hl_layout_take(layout, volumes, sizeof *layers->white);
  layers->ones = hl_layout_take(layout, CLASSIFIER_ENTRIES + 2, sizeof *layers->ones);
}

void hl_sweep_layers_count(sweep *sweep, hl_layout *layout) {
  if (wants_layers(sweep)) lay_out(sweep, layout);
}

/* Adds a pass that shades the given lights, without ambient light, sky and emission. Returns null if the
 * layer is not wanted. */
static layer_pass *add_pass(sweep *sweep, float *pixels, const shade_light *lights, int light_count) {
  if (pixels == NULL) return NULL;
  layer_pass *pass = &sweep->layers.passes[sweep->layers.pass_count++];
  *pass = (layer_pass){.shade = sweep->content.hot->render->shade,
                       .lights = lights,
                       .light_count = light_count,
                       .pixels = pixels,
                       .tile_floats = COLORS * TILE_PIXELS};
  return pass;
}

/* Adds the passes of a light: its picture and its shadow. For a sun of the sky it adds passes for the sun's
 * share of the sky's two pictures. */
static void add_light_passes(sweep *sweep, int index) {
  const light_pixels *to = &sweep->target.layers->lights[sweep->geometry->light[index]];
  const shade_light *light = &sweep->constants.lights[index];
  shade_light *white = &sweep->layers.white_lights[index];
  (void)add_pass(sweep, to->picture, light, 1);
  set_up_white_light(light, white);
  layer_pass *shadow = add_pass(sweep, to->shadow, white, 1);
  if (shadow != NULL) shadow->matter = MATTER_EVEN;
  layer_pass *reaching = add_pass(sweep, to->reaching, light, 1);
  if (reaching != NULL) reaching->matter = MATTER_WHITE;
  layer_pass *open = add_pass(sweep, to->open, light, 1);
  if (open != NULL) open->matter = MATTER_OPEN;
}

static void add_sky_passes(sweep *sweep) {
  const layer_pixels *pixels = sweep->target.layers;
  sweep_layers *layers = &sweep->layers;
  if (sweep->constants.shade.sky == NULL) return;
  layers->white_sky = *sweep->constants.shade.sky;
  for (int c = 0; c < 3; c++) layers->white_sky.color[c] = 1;
  layer_pass *sky = add_pass(sweep, pixels->sky, NULL, 0);
  if (sky != NULL) sky->sky = sweep->constants.shade.sky;
  layer_pass *reaching = add_pass(sweep, pixels->sky_reaching, NULL, 0);
  if (reaching != NULL) reaching->sky = &layers->white_sky, reaching->matter = MATTER_WHITE;
  layer_pass *open = add_pass(sweep, pixels->sky_open, NULL, 0);
  if (open != NULL) open->sky = &layers->white_sky, open->matter = MATTER_OPEN;
}

hl_status hl_sweep_layers_begin(sweep *sweep, hl_error *error) {
  const layer_pixels *pixels = sweep->target.layers;
  hl_layout layout = {0};
  if (!wants_layers(sweep)) return HL_OK;
  while (hl_layout_pass(&layout, sweep->content.context)) lay_out(sweep, &layout);
  if (layout.base == NULL) return hl_fail_memory(error, layout.bytes, "the layers");
  memset(layout.base, 0, layout.bytes);
  set_up_white_volumes(sweep);
  for (int i = 0; i < sweep->geometry->light_count; i++) add_light_passes(sweep, i);
  layer_pass *ambient = sweep->plan->adds_even_light ? add_pass(sweep, pixels->ambient, NULL, 0) : NULL;
  for (int c = 0; c < 3 && ambient != NULL; c++) ambient->ambient[c] = sweep->constants.shade.ambient[c];
  if (ambient != NULL) ambient->scattered = sweep->constants.shade.scattered;
  layer_pass *emission = sweep->plan->adds_even_light ? add_pass(sweep, pixels->emission, NULL, 0) : NULL;
  if (emission != NULL) emission->emission = sweep->constants.shade.emission;
  add_sky_passes(sweep);
  layer_pass *measures = sweep->plan->measures ? add_pass(sweep, pixels->measures, NULL, 0) : NULL;
  if (measures != NULL) {
    measures->shade = sweep->content.hot->render->measure;
    measures->tile_floats = MEASURES * TILE_PIXELS;
  }
  return HL_OK;
}

void hl_sweep_layers_end(sweep *sweep) { hl_release(sweep->content.context, sweep->layers.passes); }

/* The tile's patches, with volumes that have the pass's matter in place of the scene's volumes. */
static const shade_patch *patches_of(const sweep *sweep, const tile_slab *slab, layer_matter matter) {
  const shade_volume *volumes = matter == MATTER_EVEN    ? sweep->layers.even_volumes
                                : matter == MATTER_WHITE ? sweep->layers.white_volumes
                                                         : sweep->layers.open_volumes;
  shade_patch *patches = sweep->layers.patches + (size_t)slab->worker * (size_t)sweep->content.volume_count;
  for (int i = 0; i < slab->patch_count; i++) {
    patches[i] = slab->patches[i];
    patches[i].volume = &volumes[slab->patches[i].volume - sweep->constants.volumes];
  }
  return patches;
}

/* The slab's job, with the lights, the ambient light, the sky and the emission of the pass in place of its
 * own. */
static shade_job job_of_pass(const layer_pass *pass, const shade_job *slab) {
  shade_job job = *slab;
  job.lights = pass->lights;
  job.light_count = pass->light_count;
  memcpy(job.ambient, pass->ambient, sizeof job.ambient);
  job.emission = pass->emission;
  job.scattered = pass->scattered;
  job.sky = pass->sky;
  return job;
}

void hl_sweep_layers_tile(const sweep *sweep, const tile_slab *slab) {
  if (sweep->layers.pass_count == 0) return;
  for (int i = 0; i < sweep->layers.pass_count; i++) {
    const layer_pass *pass = &sweep->layers.passes[i];
    const shade_job job = job_of_pass(pass, slab->job);
    tile_slab own = *slab;
    if (pass->matter != MATTER_OWN) own.patches = patches_of(sweep, slab, pass->matter);
    uint64_t samples = 0; /* receives the number of samples of passes, which the statistics leave out */
    (void)pass->shade(&job, &own, pass->pixels + slab->tile * pass->tile_floats, &samples);
  }
}

/* ---- surfaces ---- */

/* Replaces the material of samples of surfaces by the matter of a pass. */
static void change_matter(layer_matter matter, surface_samples *samples) {
  if (matter == MATTER_OWN) return;
  for (int c = 0; c < 3; c++)
    for (int i = 0; i < SURFACE_SAMPLES; i++) samples->color[c][i] = 1;
  samples->ambient = samples->emission = 0;
  if (matter == MATTER_OPEN) samples->receives_shadow = 0;
  if (matter != MATTER_EVEN) return;
  samples->diffuse = samples->specular = 0;
  samples->even = 1;
}

static float dot_of_sample(const float a[3][SURFACE_SAMPLES], int i, const float b[3]) {
  return a[0][i] * b[0] + a[1][i] * b[1] + a[2][i] * b[2];
}

/* The distance of a point along the eye's ray. */
static float depth_of_sample(const shade_job *job, const surface_samples *samples, int i) {
  const float towards_eye[3] = {samples->towards_eye[0][i], samples->towards_eye[1][i],
                                samples->towards_eye[2][i]};
  const float eye = job->eye[0] * towards_eye[0] + job->eye[1] * towards_eye[1] +
                    job->eye[2] * towards_eye[2];
  return eye - dot_of_sample(samples->position, i, towards_eye);
}

/* Measures the first depth of a pixel in which a mesh is seen. A mesh may have several fragments in the
 * pixel, which lie side by side or one behind another. The depth is the mean over the pixel's samples, each
 * with the depth of the first of these fragments that covers it. Fragments of a faint mesh count before the
 * pixel's alpha reaches FIRST_OPACITY, too: their samples are stored with a minus sign until then, and depth
 * and object do not hold yet (layers.c leaves them out). at: the pixel's measures; alpha: the pixel's alpha
 * before and after the fragment. */
static void measure_first(const fragment *f, float depth, int object, float before, float after, float *at) {
  float *first = at + MEASURE_DEPTH_FIRST * BLOCK_PIXELS, *covered = at + MEASURE_SAMPLES * BLOCK_PIXELS,
        *seen = at + MEASURE_OBJECT * BLOCK_PIXELS;
  const bool open = before < FIRST_OPACITY;
  if (!open && (*covered <= 0 || *seen != (float)object)) return;
  if (*seen != (float)object) *covered = 0;
  const unsigned known = (unsigned)fabsf(*covered), met = f->samples & ~known;
  const int count = __builtin_popcount(met), all = __builtin_popcount(met | known);
  if (met != 0) *first = known == 0 ? depth : *first + (depth - *first) * (float)count / (float)all;
  *covered = after < FIRST_OPACITY ? -(float)(known | met) : (float)(known | met);
  *seen = (float)object;
}

/* Measures depth, normal and object of a batch, in a sweep that goes from front to back. pixels: the tile's
 * pixels. */
static void measure_batch(const shade_job *job, const surface_batch *batch, int object, float *pixels) {
  for (int i = 0; i < batch->count; i++) {
    const fragment *f = batch->fragments[i];
    float *at = pixels + (size_t)(f->pixel / BLOCK_PIXELS) * MEASURES * BLOCK_PIXELS +
                f->pixel % BLOCK_PIXELS;
    float before = at[MEASURE_ALPHA * BLOCK_PIXELS], weight = f->opacity * (1 - before),
          depth = depth_of_sample(job, &batch->samples, i);
    at[MEASURE_ALPHA * BLOCK_PIXELS] = before + weight;
    at[MEASURE_DEPTH * BLOCK_PIXELS] += depth * weight;
    for (int c = 0; c < 3; c++)
      at[(MEASURE_NORMAL + c) * BLOCK_PIXELS] += batch->samples.normal[c][i] * weight;
    measure_first(f, depth, object, before, before + weight, at);
  }
}

void hl_sweep_layers_batch(const sweep *sweep, const tile_slab *slab, const surface_batch *batch) {
  for (int i = 0; i < sweep->layers.pass_count; i++) {
    const layer_pass *pass = &sweep->layers.passes[i];
    const shade_job job = job_of_pass(pass, slab->job);
    float *pixels = pass->pixels + slab->tile * pass->tile_floats;
    if (pass->shade != sweep->content.hot->render->shade) {
      measure_batch(&job, batch,
                    sweep->frame_plan->meshes[batch->mesh - sweep->frame->surfaces->meshes].object, pixels);
      continue;
    }
    surface_batch own = *batch;
    change_matter(pass->matter, &own.samples);
    sweep->content.hot->render->surface(&job, &own.samples);
    hl_surface_batch_composite(&own, job.back_to_front, pixels);
  }
}
