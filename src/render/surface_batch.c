/* render/surface_batch.c - see surface_batch.h. */
#include "render/surface_batch.h"

#include "render/surface_point.h"

static void set_sample(surface_samples *samples, int i, const surface_point *point) {
  const vec3 *vectors[] = {&point->position, &point->normal, &point->towards_eye};
  float(*rows[])[SURFACE_SAMPLES] = {samples->position, samples->normal, samples->towards_eye};
  for (int n = 0; n < 3; n++) {
    rows[n][0][i] = (float)vectors[n]->x;
    rows[n][1][i] = (float)vectors[n]->y;
    rows[n][2][i] = (float)vectors[n]->z;
  }
  for (int c = 0; c < 3; c++) samples->color[c][i] = (float)point->color[c];
}

static void set_material(surface_samples *samples, const surface_look *look) {
  samples->ambient = (float)look->material.ambient;
  samples->diffuse = (float)look->material.diffuse;
  samples->specular = (float)look->material.specular;
  samples->shininess = (float)look->material.shininess;
  samples->emission = (float)look->material.emission;
  samples->receives_shadow = look->receives_shadow;
  samples->even = 0;
  samples->contact = NULL;
  for (int c = 0; c < 3; c++) samples->behind[c] = (float)(1 - look->opacity * look->attenuation_color[c]);
}

/* Does step 16 for one fragment. pixels: the pixels of the tile. */
static void composite_fragment(int back_to_front, const fragment *f, const float lit[3], float *pixels) {
  float *at = pixels + (size_t)(f->pixel / BLOCK_PIXELS) * 4 * BLOCK_PIXELS + f->pixel % BLOCK_PIXELS;
  float *alpha = at + 3 * BLOCK_PIXELS;
  float weight = back_to_front ? f->opacity : f->opacity * (1 - *alpha),
        keep = back_to_front ? 1 - f->opacity : 1;
  for (int c = 0; c < 3; c++) at[c * BLOCK_PIXELS] = lit[c] * weight + at[c * BLOCK_PIXELS] * keep;
  *alpha = *alpha * keep + weight;
}

void hl_surface_batch_place(const sweep *sweep, const tile_slab *slab, surface_batch *batch) {
  set_material(&batch->samples, &batch->mesh->look);
  surface_point first = hl_surface_point_of(sweep, slab, batch->fragments[0]);
  for (int i = 1; i < batch->count; i++) {
    surface_point point = hl_surface_point_of(sweep, slab, batch->fragments[i]);
    set_sample(&batch->samples, i, &point);
  }
  for (int i = 0; i < SURFACE_SAMPLES; i++)
    if (i == 0 || i >= batch->count) set_sample(&batch->samples, i, &first);
}

void hl_surface_batch_composite(const surface_batch *batch, int back_to_front, float *pixels) {
  const surface_samples *samples = &batch->samples;
  for (int i = 0; i < batch->count; i++) {
    const float lit[3] = {samples->lit[0][i], samples->lit[1][i], samples->lit[2][i]};
    composite_fragment(back_to_front, batch->fragments[i], lit, pixels);
  }
}
