/* render/target.c - see target.h. */
#include "render/target.h"

#include "core/memory.h"
#include "render/maximum.h"
#include "render/picture.h"

/* ---- memory ---- */

static size_t floats_of_sweep(const frame_plan *plan) { return plan->picture.tiles * TILE_PIXELS * 4; }

/* Lays out the target's own pixels; or, if it uses the caller's pixels, rows of tiles beside them. */
static void lay_out_pixels(const hl_renderer *renderer, const frame_plan *plan, frame_target *target,
                           hl_layout *layout) {
  const size_t floats = TILE_PIXELS * 4 * sizeof(float), threads = (size_t)hl_pool_threads(renderer->pool);
  if (target->in_place)
    target->tile_rows = hl_layout_take(layout, threads * (size_t)plan->picture.tiles_x, floats);
  else target->pixels = hl_layout_take(layout, (size_t)plan->sweeps.count * plan->picture.tiles, floats);
}

static hl_status take_pixels(hl_renderer *renderer, const frame_request *request, const frame_plan *plan,
                             frame_target *target, hl_error *error) {
  hl_layout counted = {0};
  lay_out_pixels(renderer, plan, target, &counted);
  hl_layout handed = {.base = target->in_place ? hl_allocate(renderer->context, counted.bytes, 1)
                                               : hl_reserve_take(&renderer->cache.reserve, counted.bytes, 1)};
  if (handed.base == NULL) return hl_fail_memory(error, counted.bytes, "the picture");
  lay_out_pixels(renderer, plan, target, &handed);
  if (target->in_place) target->pixels = request->pixels;
  return HL_OK;
}

/* Returns whether the sweep composites directly into the caller's pixels. It does so if there is only one
 * sweep, and tiles fill these pixels exactly. */
static bool is_in_place(const frame_request *request, const frame_plan *plan) {
  const bool whole = plan->picture.width % TILE == 0 && plan->picture.height % TILE == 0 &&
                     request->row_stride == 4 * (size_t)plan->picture.width;
  return whole && plan->sweeps.count == 1 && plan->frame.oversampling == 1 &&
         (uintptr_t)request->pixels % 64 == 0;
}

hl_status hl_frame_target_create(hl_renderer *renderer, const frame_request *request, const frame_plan *plan,
                                 frame_target *target, hl_error *error) {
  hl_reserve *reserve = &renderer->cache.reserve;
  hl_layout counted = {0};
  target->in_place = is_in_place(request, plan);
  lay_out_pixels(renderer, plan, target, &counted);
  hl_layer_pixels_count(plan->picture.layers, &plan->frame, plan->picture.tiles, &counted);
  hl_maximum_count(plan, &counted);
  /* several sweeps take blocks of different sizes, so a returned block rarely fits the next sweep */
  reserve->keeps = plan->sweeps.count == 1;
  if (!reserve->keeps) hl_reserve_release(reserve);
  hl_status status = hl_renderer_check_room(renderer, counted.most, error);
  if (status == HL_OK) status = take_pixels(renderer, request, plan, target, error);
  if (status != HL_OK) return status;
  hl_frame_target_clear(renderer, plan, target);
  status = hl_layer_pixels_create(renderer->context, renderer->pool, plan->picture.layers, &plan->frame,
                                  plan->picture.tiles, &target->layers, error);
  if (status != HL_OK) return status;
  return hl_maximum_create(renderer->context, renderer->pool, plan, &target->maximum, error);
}

void hl_frame_target_release(hl_renderer *renderer, frame_target *target) {
  hl_context *context = renderer->context;
  if (!target->in_place) hl_reserve_return(&renderer->cache.reserve, target->pixels);
  hl_release(context, target->tile_rows);
  hl_layer_pixels_release(context, &target->layers);
  hl_maximum_release(context, &target->maximum);
}

float *hl_frame_target_pixels(const frame_target *target, const frame_plan *plan, int sweep) {
  return target->pixels + (size_t)sweep * floats_of_sweep(plan);
}

void hl_frame_target_clear(hl_renderer *renderer, const frame_plan *plan, frame_target *target) {
  hl_pool_clear(renderer->pool, target->pixels,
                (size_t)plan->sweeps.count * floats_of_sweep(plan) * sizeof *target->pixels);
}

/* ---- the caller's pixels ---- */

static void write_picture(const frame_target *target, const frame_request *request, const frame_plan *plan,
                          hl_pool *pool) {
  const picture picture = {.tiles = target->pixels,
                           .sweeps = plan->sweeps.count,
                           .tiles_x = (size_t)plan->picture.tiles_x,
                           .tiles_of_sweep = plan->picture.tiles,
                           .oversampling = plan->frame.oversampling,
                           .pixels = request->pixels,
                           .row_stride = request->row_stride,
                           .width = plan->picture.width,
                           .height = plan->picture.height};
  if (target->in_place) hl_picture_reorder(&picture, target->tile_rows, pool);
  else hl_picture_write(&picture, pool);
}

void hl_frame_target_write(hl_renderer *renderer, const frame_request *request, const frame_plan *plan,
                           frame_target *target) {
  const layer_grid grid = {plan->picture.width, plan->picture.height, plan->frame.oversampling,
                           (size_t)plan->picture.tiles_x, (float)plan->unit};
  if (target->maximum.values != NULL)
    hl_maximum_color(&target->maximum, plan, renderer->pool, target->pixels);
  write_picture(target, request, plan, renderer->pool);
  hl_layer_pixels_write(&target->layers, &grid, renderer->pool);
}
