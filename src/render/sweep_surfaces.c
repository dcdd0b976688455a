/* render/sweep_surfaces.c - see sweep_surfaces.h. */
#include "render/sweep_surfaces.h"

#include "core/memory.h"
#include "core/sheet_constants.h"
#include "render/late/late_surfaces.h"
#include "render/surface_batch.h"
#include "render/sweep_layers.h"
#include "surface/late/lateness.h"

/* ---- begin and end ---- */

/* Makes the fragments of a view. light: the light whose view it is; if null, the view is the eye's. */
static hl_status make_fragments(sweep *sweep, const view *view, const sweep_light *light,
                                const occupancy *occupancy, fragments *made, hl_error *error) {
  const light_shadow *shadow = light != NULL ? &light->shadow : NULL;
  const bool unseen = made == &sweep->surfaces.unseen;
  const fragments_source source = {
      .context = sweep->content.context,
      .pool = sweep->content.pool,
      .functions = sweep->content.hot->surface,
      .surfaces = sweep->frame->surfaces,
      .view = view,
      .sheets = &sweep->geometry->sheets,
      .falling = shadow == NULL && sweep->geometry->back_to_front,
      .of_light = shadow != NULL,
      .unseen = unseen,
      .delay = shadow != NULL ? hl_surface_delay(shadow) : 0,
      .rise = shadow != NULL ? shadow->method->surface_rise : 0,
      .needed = light != NULL && shadow->method->divides ? light->needed_until : NULL,
      .marks = unseen ? NULL : occupancy->by_sheet,
      .tile_words = occupancy->tile_words};
  return hl_fragments_create(&source, made, error);
}

/* The number of arrays that a thread has in surfaces.passing: one for each light and channel. */
static size_t passings(const sweep *sweep) {
  return (size_t)sweep->geometry->light_count * (size_t)sweep->frame_plan->channels;
}

/* Lays out the memory of each thread for tiles with fragments. */
static void lay_out(sweep *sweep, hl_layout *layout) {
  size_t places = (size_t)hl_pool_threads(sweep->content.pool), volumes = (size_t)sweep->content.volume_count;
  surface_state *state = &sweep->surfaces;
  state->patches = hl_layout_take(layout, places * volumes, sizeof *state->patches);
  state->cuts = hl_layout_take(layout, places * volumes * 2, sizeof *state->cuts);
  state->bounds = hl_layout_take(layout, places * 2, sizeof *state->bounds);
  state->passing = hl_layout_take(layout, places * passings(sweep), sizeof *state->passing);
  state->contact = hl_layout_take(layout, places * passings(sweep), sizeof *state->contact);
  state->points = hl_layout_take(layout, (size_t)sweep->geometry->light_count, sizeof *state->points);
}

static hl_status make_room(sweep *sweep, hl_error *error) {
  hl_layout layout = {0};
  while (hl_layout_pass(&layout, sweep->content.context)) lay_out(sweep, &layout);
  sweep->surfaces.memory = layout.base;
  return layout.base != NULL ? HL_OK : hl_fail_memory(error, layout.bytes, "the surfaces");
}

void hl_sweep_surfaces_count(sweep *sweep, hl_layout *layout) {
  const surfaces *all = sweep->frame->surfaces;
  const int threads = hl_pool_threads(sweep->content.pool);
  if (all == NULL) return;
  lay_out(sweep, layout);
  hl_fragments_count(all, &sweep->frame->eye, threads, layout);
  if (hl_sweep_has_unseen(sweep)) hl_fragments_count(all, &sweep->frame->eye, threads, layout);
  for (int i = 0; i < sweep->geometry->light_count; i++)
    if (sweep->lights[i].shadow.method != NULL)
      hl_fragments_count(all, &sweep->lights[i].shadow.plan.view, threads, layout);
}

bool hl_sweep_has_unseen(const sweep *sweep) {
  const surfaces *all = sweep->frame->surfaces;
  for (size_t m = 0; sweep->content.volume_count > 0 && m < all->mesh_count; m++)
    if (!all->meshes[m].look.visible && hl_mesh_takes_light(&all->meshes[m])) return true;
  return false;
}

hl_status hl_sweep_surfaces_begin(sweep *sweep, hl_error *error) {
  if (sweep->frame->surfaces == NULL || sweep->act.purpose != SWEEP_PICTURE) return HL_OK;
  surface_state *state = &sweep->surfaces;
  hl_status status = make_room(sweep, error);
  if (status == HL_OK)
    status = make_fragments(sweep, &sweep->frame->eye, NULL, &sweep->image.occupancy, &state->image, error);
  if (status == HL_OK && hl_sweep_has_unseen(sweep))
    status = make_fragments(sweep, &sweep->frame->eye, NULL, &sweep->image.occupancy, &state->unseen, error);
  return status;
}

hl_status hl_sweep_surfaces_begin_lights(sweep *sweep, hl_error *error) {
  surface_state *state = &sweep->surfaces;
  hl_status status = HL_OK;
  if (sweep->frame->surfaces == NULL || sweep->act.purpose != SWEEP_PICTURE) return HL_OK;
  for (int i = 0; i < sweep->geometry->light_count && status == HL_OK; i++) {
    sweep_light *light = &sweep->lights[i];
    if (light->shadow.method == NULL) continue;
    hl_contact_points(light->source, &state->points[i]);
    status = make_fragments(sweep, &light->shadow.buffer->view, light, &light->sheets.occupancy,
                            &state->lights[i], error);
  }
  return status;
}

void hl_sweep_surfaces_end(sweep *sweep) {
  hl_context *context = sweep->content.context;
  hl_fragments_release(context, &sweep->surfaces.image);
  hl_fragments_release(context, &sweep->surfaces.unseen);
  for (int i = 0; i < FRAME_LIGHTS; i++) hl_fragments_release(context, &sweep->surfaces.lights[i]);
  hl_release(context, sweep->surfaces.memory);
}

static fragment_range reach(const fragments *all, size_t tile, int slab) {
  return all->of != NULL ? hl_fragments_reach(all, tile, slab) : (fragment_range){NULL, 0};
}

fragment_range hl_sweep_surfaces_reach(const sweep *sweep, size_t tile, int slab) {
  (void)reach(&sweep->surfaces.unseen, tile, slab);
  return reach(&sweep->surfaces.image, tile, slab);
}

fragment_range hl_sweep_surfaces_reach_light(const sweep *sweep, int light, size_t tile, int slab) {
  return reach(&sweep->surfaces.lights[light], tile, slab);
}

/* ---- the picture: slabs cut at fragments ---- */

/* Does steps 14 to 16 for a batch, and shades its layers. */
static void shade_batch(const sweep *sweep, const tile_slab *slab, surface_batch *batch) {
  if (batch->count == 0) return;
  float(*contact)[SURFACE_SAMPLES] = sweep->surfaces.contact + (size_t)slab->worker * passings(sweep);
  hl_surface_batch_place(sweep, slab, batch);
  if (hl_contact_find(sweep, slab, batch, contact))
    batch->samples.contact = (const float(*)[SURFACE_SAMPLES])contact;
  sweep->content.hot->render->surface(slab->job, &batch->samples);
  hl_surface_batch_composite(batch, slab->job->back_to_front,
                             sweep->target.pixels + slab->tile * 4 * TILE_PIXELS);
  hl_sweep_layers_batch(sweep, slab, batch);
  batch->count = 0;
}

/* Finds the fragments of one round of work on a slab: of each pixel, fragment number `round`, counted from
 * the lowest one. */
static size_t fragments_of_round(fragment_range range, int round, fragment *list) {
  size_t count = 0;
  int number = 0;
  for (size_t i = 0; i < range.count; i++) {
    number = i > 0 && range.first[i].pixel == range.first[i - 1].pixel ? number + 1 : 0;
    if (number == round) list[count++] = range.first[i];
  }
  return count;
}

/* Does steps 12 to 16 for the fragments of a slab in a tile, and composites them in the order of their
 * heights. */
static void shade_fragments(const sweep *sweep, const tile_slab *slab, uint32_t blocks,
                            fragment_range range) {
  surface_batch batch;
  batch.count = 0;
  for (size_t i = 0; i < range.count; i++) {
    const fragment *f = &range.first[i];
    if ((blocks >> f->pixel / BLOCK_PIXELS & 1) == 0) continue;
    const surface_mesh *own = &sweep->frame->surfaces->meshes[f->mesh];
    if (batch.count > 0 && (own != batch.mesh || batch.count == SURFACE_SAMPLES))
      shade_batch(sweep, slab, &batch);
    batch.mesh = own;
    batch.fragments[batch.count++] = f;
  }
  shade_batch(sweep, slab, &batch);
}

/* Runs the sweep's action (steps 12 to 16) for a slab, or for a piece of a slab. Before that it finds the
 * light that fragments of this slab and of the few slabs before it hide from the slab. */
static uint32_t act_behind(const sweep *sweep, const tile_slab *slab, slab_piece piece) {
  float(*passing)[TILE_PIXELS] = sweep->surfaces.passing + (size_t)slab->worker * passings(sweep);
  int first = slab->job->sheet - NEAR_SLABS;
  const fragments *unseen = &sweep->surfaces.unseen;
  near_fragments near = {.seen = hl_fragments_reached(&sweep->surfaces.image, slab->tile, first)};
  if (unseen->of != NULL) near.unseen = hl_fragments_reached(unseen, slab->tile, first);
  if (!hl_near_surfaces_find(sweep, slab, &near, piece, passing)) return sweep->act.run(sweep, slab);
  shade_job job = *slab->job;
  tile_slab behind = *slab;
  job.near_passing = (const float(*)[TILE_PIXELS])passing;
  job.near_u = (float)(slab->x * TILE), job.near_v = (float)(slab->y * TILE);
  behind.job = &job;
  return sweep->act.run(sweep, &behind);
}

uint32_t hl_sweep_surfaces_beside(const sweep *sweep, const tile_slab *slab) {
  if (sweep->surfaces.image.of == NULL) return sweep->act.run(sweep, slab);
  return act_behind(sweep, slab, (slab_piece){NULL, NULL});
}

/* Shades, in each pixel, the piece of the slab between two heights. from, to: [256]. */
static uint32_t shade_piece(const sweep *sweep, const tile_slab *slab, const float *from, const float *to) {
  const surface_state *state = &sweep->surfaces;
  size_t place = (size_t)slab->worker * (size_t)sweep->content.volume_count;
  shade_patch *patches = state->patches + place;
  for (int p = 0; p < slab->patch_count; p++) {
    const shade_patch *whole = &slab->patches[p];
    float *enter = state->cuts[(place + (size_t)p) * 2], *leave = state->cuts[(place + (size_t)p) * 2 + 1];
    bool open = whole->enter == NULL || whole->uncut;
    for (int i = 0; i < TILE_PIXELS; i++) {
      enter[i] = open || from[i] > whole->enter[i] ? from[i] : whole->enter[i];
      leave[i] = open || to[i] < whole->leave[i] ? to[i] : whole->leave[i];
    }
    patches[p] = *whole;
    patches[p].enter = enter;
    patches[p].leave = leave;
    patches[p].uncut = 0;
  }
  tile_slab piece = *slab;
  piece.patches = patches;
  return act_behind(sweep, &piece, (slab_piece){from, to});
}

/* Returns the blocks among `blocks` in which some pixel is not opaque. */
static uint32_t open_blocks(const sweep *sweep, const tile_slab *slab, uint32_t blocks) {
  const float *pixels = sweep->target.pixels + slab->tile * 4 * TILE_PIXELS;
  uint32_t open = 0;
  for (; blocks != 0; blocks &= blocks - 1) {
    int block = __builtin_ctz(blocks);
    const float *alpha = pixels + (block * 4 + 3) * BLOCK_PIXELS;
    for (int lane = 0; lane < BLOCK_PIXELS; lane++)
      if (alpha[lane] < PIXEL_OPAQUE) open |= 1u << block;
  }
  return open;
}

/* Heights beyond all sheets. */
static const float BELOW = -1e30f, ABOVE = 1e30f;

/* Shades a tile's slab, which has density and is cut into pieces at fragments. It is cut first at each
 * pixel's lowest fragment, then at each pixel's next fragment, and so on. */
static void shade_cut_slab(const sweep *sweep, const tile_slab *slab, uint32_t blocks, fragment_range range) {
  fragment list[TILE_PIXELS];
  float *from = sweep->surfaces.bounds[slab->worker * 2], *to = sweep->surfaces.bounds[slab->worker * 2 + 1];
  for (int i = 0; i < TILE_PIXELS; i++) from[i] = BELOW;
  for (int round = 0;; round++) {
    size_t count = fragments_of_round(range, round, list);
    for (int i = 0; i < TILE_PIXELS; i++) to[i] = ABOVE;
    for (size_t i = 0; i < count; i++) to[list[i].pixel] = list[i].height;
    (void)shade_piece(sweep, slab, from, to);
    if (count == 0) return;
    shade_fragments(sweep, slab, blocks, (fragment_range){list, count});
    /* in a pixel whose slab has been shaded to its end, `from` is now above all sheets */
    for (int i = 0; i < TILE_PIXELS; i++) from[i] = to[i];
  }
}

uint32_t hl_sweep_surfaces_tile(const sweep *sweep, const tile_slab *slab, uint32_t blocks,
                                fragment_range range) {
  if (slab->blocks == 0) shade_fragments(sweep, slab, blocks, range);
  else shade_cut_slab(sweep, slab, blocks, range);
  return slab->job->back_to_front ? blocks : open_blocks(sweep, slab, blocks);
}

/* ---- the lights ---- */

/* The transmittance of a pixel behind a surface. passing: the fraction of light that the surface lets
 * pass. */
static float behind_surface(const attenuate_job *job, float before, float passing) {
  if (!job->marks || (before >= DARK_AT_START && passing > 0)) return before * passing;
  if (before >= DARK_AT_START) return -LEAST_MARK;
  return fminf((before < 0 ? before : -DARK_MARK) * passing, -LEAST_MARK);
}

bool hl_sweep_surfaces_attenuate(const sweep *sweep, const attenuate_job *job, fragment_range range) {
  for (size_t i = 0; i < range.count; i++) {
    const fragment *f = &range.first[i];
    const double *color = sweep->frame->surfaces->meshes[f->mesh].look.attenuation_color;
    size_t row = (size_t)hl_pixel_row(f->pixel), column = (size_t)hl_pixel_column(f->pixel);
    for (int c = 0; c < job->channels; c++) {
      float *at = job->transmittance[c] + row * job->stride + column, before = *at;
      float passing = 1 - f->opacity * (float)color[c];
      *at = behind_surface(job, before, passing);
      if (job->outside[c] != NULL) job->outside[c][row * job->stride + column] *= passing;
      if (job->older[c] != NULL) job->older[c][row * job->stride + column] *= passing;
      if (job->moment[c] != NULL)
        job->moment[c][row * job->moment_stride + column] += (fmaxf(before, 0) - fmaxf(*at, 0)) *
                                                             job->position;
    }
  }
  return range.count > 0;
}
