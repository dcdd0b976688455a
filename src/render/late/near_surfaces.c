/* render/late/near_surfaces.c - finds the light that surfaces absorb before it reaches samples of volumes
 * close behind them: see late_surfaces.h. */
#include "core/sheet_constants.h"
#include "render/late/late_surfaces.h"

#include "render/surface_point.h"
#include "surface/late/lateness.h"
#include "surface/primitive.h"
#include "surface/small_triangles.h"
#include "surface/surface_plane.h"

double hl_surface_delay(const light_shadow *shadow) {
  return shadow->plan.cubic ? CUBIC_DELAY : shadow->method->surface_delay;
}

/* A sample of a volume that is close to a surface which the eye sees in the same pixel. */
typedef struct near_sample {
  const fragment *fragment;
  vec3 point, met;  /* point: the position of the sample; met: the position where the eye's ray meets the
                     * surface */
  double low, high; /* heights at which the pixel's piece of the slab begins and ends; the sample is its
                     * middle */
  bool cut;         /* whether the piece ends at the surface */
} near_sample;

/* Sets the heights at which a pixel's piece of the slab begins and ends. Returns false if the piece is
 * empty. */
static bool set_piece(const shade_job *job, slab_piece piece, int pixel, near_sample *sample) {
  sample->low = (double)job->height - (double)job->spacing;
  sample->high = (double)job->height;
  if (piece.from != NULL) sample->low = fmax(sample->low, (double)piece.from[pixel]);
  if (piece.to != NULL) sample->high = fmin(sample->high, (double)piece.to[pixel]);
  return sample->low < sample->high;
}

static double middle_of(const near_sample *sample) { return (sample->low + sample->high) / 2; }

/* The fraction of the piece that lies behind the surface as seen from a light, if the light's buffer takes
 * the surface into account only in a later slab. Otherwise 0. */
static double part_missed(const sweep *sweep, int light, const near_sample *sample, int slab) {
  const surfaces *all = sweep->frame->surfaces;
  const sheet_stack *sheets = &sweep->geometry->sheets;
  const light_shadow *shadow = &sweep->lights[light].shadow;
  const view *view = &shadow->buffer->view;
  uint32_t primitive = sample->fragment->primitive;
  surface_plane plane;
  double uv[2];
  if (!hl_view_project(view, sample->point, uv)) return 0;
  hl_primitive_kind(all, primitive)->plane(view, sheets, all, primitive, sample->met, &plane);
  double height = hl_plane_height(&plane, uv[0], uv[1]), middle = middle_of(sample);
  double part = (middle - height) / (sample->high - sample->low) + 0.5; /* beyond the surface */
  if (sample->cut) part = height < middle ? 1 : 0;
  if (!(part > 0)) return 0;
  double beside = sample->fragment->opacity < 1 ? 0 : READ_BESIDE;
  double delay = (hl_surface_delay(shadow) + beside) * hl_plane_slope(&plane, uv[0], uv[1]);
  return height + delay > (slab - 1 - LEAST_DELAY) * sheets->spacing ? fmin(part, 1) : 0;
}

/* Lowers a sample's light by the light that a fragment absorbs. part: the fraction of the sample's piece of
 * the slab that lies behind the fragment. */
static void take(const sweep *sweep, const near_sample *sample, int light, double part,
                 float (*passing)[TILE_PIXELS]) {
  const fragment *f = sample->fragment;
  const double *color = sweep->frame->surfaces->meshes[f->mesh].look.attenuation_color;
  int at = hl_pixel_row(f->pixel) * TILE + hl_pixel_column(f->pixel);
  for (int c = 0; c < sweep->frame_plan->channels; c++)
    passing[light * sweep->frame_plan->channels + c][at] *= 1 - f->opacity * (float)(color[c] * part);
}

/* Returns whether some volume may show something in a pixel's slab. */
static bool shows_matter(const tile_slab *slab, int pixel) {
  for (int p = 0; p < slab->patch_count; p++) {
    const shade_patch *patch = &slab->patches[p];
    const classifier *classifier = patch->volume->classifier;
    if ((patch->blocks >> pixel / BLOCK_PIXELS & 1) == 0) continue;
    float a = patch->before[pixel] * classifier->scale + classifier->offset,
          b = patch->current[pixel] * classifier->scale + classifier->offset;
    if (fmaxf(a, b) > classifier->first_visible && fminf(a, b) < classifier->last_visible) return true;
  }
  return false;
}

static void fill_with_ones(float (*passing)[TILE_PIXELS], int count) {
  for (int i = 0; i < count; i++)
    for (int k = 0; k < TILE_PIXELS; k++) passing[i][k] = 1;
}

/* Does the work of hl_near_surfaces_find() for one list of fragments. cut: whether slabs are cut at these
 * fragments. any: whether an earlier list has absorbed light, so that `passing` is set. */
static bool find_near(const sweep *sweep, const tile_slab *slab, fragment_range near, bool cut,
                      slab_piece piece, bool any, float (*passing)[TILE_PIXELS]) {
  const shade_job *job = slab->job;
  const float *pixels = sweep->target.pixels + slab->tile * 4 * TILE_PIXELS;
  for (size_t i = 0; i < near.count; i++) {
    const fragment *f = &near.first[i];
    int block = f->pixel / BLOCK_PIXELS, lane = f->pixel % BLOCK_PIXELS;
    if ((slab->blocks >> block & 1) == 0) continue;
    if (!sweep->frame->surfaces->meshes[f->mesh].look.casts_shadow) continue;
    if (!job->back_to_front && pixels[(block * 4 + 3) * BLOCK_PIXELS + lane] >= PIXEL_OPAQUE) continue;
    near_sample sample = {.fragment = f, .cut = cut};
    if (!set_piece(job, piece, f->pixel, &sample) || !shows_matter(slab, f->pixel)) continue;
    sample.point = hl_surface_place(sweep, slab, f, middle_of(&sample));
    sample.met = hl_surface_place(sweep, slab, f, (double)f->height);
    for (int light = 0; light < sweep->geometry->light_count; light++) {
      double part = sweep->lights[light].shadow.method == NULL
                        ? 0
                        : part_missed(sweep, light, &sample, job->sheet);
      if (part == 0) continue;
      if (!any) fill_with_ones(passing, sweep->geometry->light_count * sweep->frame_plan->channels);
      any = true;
      take(sweep, &sample, light, part, passing);
    }
  }
  return any;
}

bool hl_near_surfaces_find(const sweep *sweep, const tile_slab *slab, const near_fragments *near,
                           slab_piece piece, float (*passing)[TILE_PIXELS]) {
  bool any = find_near(sweep, slab, near->seen, true, piece, false, passing);
  return find_near(sweep, slab, near->unseen, false, piece, any, passing);
}
