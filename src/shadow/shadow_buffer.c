/* shadow/shadow_buffer.c - decides the position and size of shadow buffers, and manages their memory. */
#include "shadow/shadow_buffer.h"

#include <string.h>

#include "core/memory.h"
#include "light/light_source.h"

/* The tangent of the greatest angle between the middle of a point light's buffer and a direction that the
 * buffer covers. */
static const double WIDEST = 6;
enum { GREATEST_SIDE = 8192, BORDER_PIXELS = 2 };

static void bound_points(const view *unit, const light_source *source, const vec3 *points, int count,
                         double low[2], double high[2]) {
  low[0] = low[1] = INFINITY;
  high[0] = high[1] = -INFINITY;
  for (int i = 0; i < count; i++) {
    double uv[2];
    bool in_front = hl_view_project(unit, points[i], uv);
    for (int axis = 0; axis < 2; axis++) {
      /* If a point of the content lies beside or behind a near light, the buffer becomes as large as allowed.
       */
      if (!in_front) {
        low[axis] = -WIDEST;
        high[axis] = WIDEST;
        continue;
      }
      low[axis] = fmin(low[axis], uv[axis]);
      high[axis] = fmax(high[axis], uv[axis]);
    }
  }
  for (int axis = 0; axis < 2; axis++) {
    if (source->parallel) continue;
    low[axis] = fmax(low[axis], -WIDEST);
    high[axis] = fmin(high[axis], WIDEST);
    if (!(high[axis] > low[axis])) high[axis] = low[axis] + 1e-3;
  }
}

/* Finds bounds of the points, with a margin for penumbrae around the points. The margin ends where all
 * content ends. */
static void bound_buffer(const view *unit, const light_source *source, const shadow_extent *extent,
                         double low[2], double high[2]) {
  double content_low[2], content_high[2];
  bound_points(unit, source, extent->points, extent->point_count, low, high);
  if (!(extent->margin > 0)) return;
  bound_points(unit, source, extent->content, extent->content_count, content_low, content_high);
  for (int axis = 0; axis < 2; axis++) {
    low[axis] = fmin(low[axis], fmax(low[axis] - extent->margin, content_low[axis]));
    high[axis] = fmax(high[axis], fmin(high[axis] + extent->margin, content_high[axis]));
  }
}

/* The edge of a buffer's pixel. For parallel light, the edge is in frame units; for a near light, the result
 * is the edge at the distance 1 from the light. The pixels of a near light grow with the distance from the
 * light, so the edge is chosen to be small enough at the farthest point. */
static double pixel_edge(const light_source *source, vec3 normal, const shadow_extent *extent,
                         const double size[2]) {
  double pixel = extent->pixel;
  if (!source->parallel) {
    double farthest = 0;
    for (int i = 0; i < extent->point_count; i++)
      farthest = fmax(farthest, vec3_dot(normal, vec3_subtract(extent->points[i], source->position)));
    pixel = farthest > 0 ? pixel / farthest : pixel;
  }
  double longer = fmax(size[0], size[1]);
  if (extent->resolution > 0) pixel = longer / extent->resolution;
  pixel = fmax(pixel, longer / GREATEST_SIDE);
  return fmax(pixel, sqrt(size[0] * size[1] / (double)extent->greatest_pixels));
}

/* The pixels of a buffer along one axis. */
typedef struct pixel_row {
  int count;
  double start, pixel;
} pixel_row;

static pixel_row row_around(double low, double high, double size, double pixel) {
  int count = (int)ceil((size + 2 * BORDER_PIXELS * pixel) / pixel);
  if (count > GREATEST_SIDE) count = GREATEST_SIDE;
  return (pixel_row){count, (low + high) / 2 - count * pixel / 2, pixel};
}

/* The least width, in pixels, of bounds that row_between() fits. row_between() makes pixels a little smaller,
 * so that the middles of the first and the last pixel inside the borders lie just inside the bounds. So light
 * along a box's face is not mixed with light that passes outside the face. Bounds of soft shadows are not
 * fitted. */
static const double LEAST_FITTED = 0.25;

static pixel_row row_between(double low, double size, double pixel) {
  const double inside = 1e-3 * fmin(pixel, size);
  int steps = (int)ceil((size - 2 * inside) / pixel);
  if (steps > GREATEST_SIDE - 2 * BORDER_PIXELS - 1) steps = GREATEST_SIDE - 2 * BORDER_PIXELS - 1;
  pixel = (size - 2 * inside) / steps;
  return (pixel_row){steps + 1 + 2 * BORDER_PIXELS, low + inside - (BORDER_PIXELS + 0.5) * pixel, pixel};
}

void hl_shadow_view(const light_source *source, vec3 plane_normal, const shadow_extent *extent, view *view) {
  double low[2], high[2], size[2];
  vec3 tilt = vec3_subtract(source->direction,
                            vec3_scale(plane_normal, vec3_dot(source->direction, plane_normal)));
  vec3 u = vec3_length(tilt) > 1e-3 ? vec3_normalise(tilt) : vec3_perpendicular(plane_normal);
  if (vec3_length(extent->u) > 0) u = extent->u;
  vec3 v = vec3_cross(plane_normal, u), zero = {0, 0, 0};
  view->perspective = !source->parallel;
  view->origin = source->position;
  view->direction = source->direction;
  view->corner = source->parallel ? zero : plane_normal;
  view->du = u;
  view->dv = v;
  hl_view_finish(view);
  bound_buffer(view, source, extent, low, high);
  hl_lit_region(view, source, low, high);
  for (int axis = 0; axis < 2; axis++) size[axis] = fmax(high[axis] - low[axis], 1e-9);
  double pixel = pixel_edge(source, plane_normal, extent, size);
  pixel_row row[2];
  for (int axis = 0; axis < 2; axis++)
    row[axis] = source->shadows == HL_SHADOWS_SOFT || size[axis] < LEAST_FITTED * pixel
                    ? row_around(low[axis], high[axis], size[axis], pixel)
                    : row_between(low[axis], size[axis], pixel);
  view->width = row[0].count;
  view->height = row[1].count;
  view->corner = vec3_add(view->corner, vec3_add(vec3_scale(u, row[0].start), vec3_scale(v, row[1].start)));
  view->du = vec3_scale(u, row[0].pixel);
  view->dv = vec3_scale(v, row[1].pixel);
  hl_view_finish(view);
}

void hl_shadow_buffer_measure(const view *view, int reach, shadow_buffer *buffer) {
  size_t margin = ((size_t)reach + 1 + TILE) / TILE * TILE;
  buffer->view = *view;
  buffer->tiles_x = hl_tiles(view->width);
  buffer->tiles_y = hl_tiles(view->height);
  buffer->stride = (size_t)buffer->tiles_x * TILE + 2 * margin;
  buffer->plane = ((size_t)buffer->tiles_y * TILE + 2 * margin) * buffer->stride;
  buffer->origin = margin * buffer->stride + margin;
}

static size_t tiles_of(const shadow_buffer *buffer) {
  return (size_t)buffer->tiles_x * (size_t)buffer->tiles_y;
}

/* Lays out the memory of a buffer whose size has been set. plane_count: the number of planes of one sheet
 * (for all channels and all kinds) times the number of sheets that are kept. */
static void lay_out(shadow_buffer *buffer, size_t plane_count, hl_layout *layout) {
  buffer->planes = hl_layout_take(layout, plane_count, buffer->plane * sizeof *buffer->planes);
  buffer->changed = hl_layout_take(layout, tiles_of(buffer), sizeof *buffer->changed);
  buffer->tile_lit = hl_layout_take(layout, tiles_of(buffer), sizeof *buffer->tile_lit);
  buffer->tile_touched = hl_layout_take(layout, tiles_of(buffer), 2);
}

/* The number of kinds of planes of a sheet: each channel has one plane of each kind. */
static size_t kinds_of_planes(bool outside, bool second) {
  return 1 + (size_t)(outside ? 1 : 0) + (size_t)(second ? 1 : 0);
}

static hl_status reserve(hl_context *context, shadow_buffer *buffer, size_t plane_count, hl_error *error) {
  hl_layout counted = {0};
  lay_out(buffer, plane_count, &counted);
  if (buffer->capacity < counted.bytes) {
    hl_release(context, buffer->memory);
    buffer->memory = hl_allocate(context, counted.bytes, 1);
    buffer->capacity = buffer->memory == NULL ? 0 : counted.bytes;
  }
  if (buffer->memory == NULL) return hl_fail_memory(error, counted.bytes, "a shadow buffer");
  lay_out(buffer, plane_count, &(hl_layout){.base = buffer->memory});
  return HL_OK;
}

/* The number of planes of one sheet, with one plane for each channel and each kind. */
static size_t planes_of_sheet(const shadow_buffer_size *size) {
  return (size_t)size->channels * kinds_of_planes(size->outside, size->second);
}

size_t hl_shadow_plane(const view *view, int reach) {
  shadow_buffer buffer = {0};
  hl_shadow_buffer_measure(view, reach, &buffer);
  return buffer.plane;
}

void hl_shadow_buffer_count(const shadow_buffer_size *size, hl_layout *layout) {
  shadow_buffer buffer = {0};
  hl_shadow_buffer_measure(size->view, size->reach, &buffer);
  lay_out(&buffer, (size_t)size->ring * planes_of_sheet(size), layout);
}

uint64_t hl_shadow_sheet_bytes(const shadow_buffer_size *size) {
  return planes_of_sheet(size) * hl_shadow_plane(size->view, size->reach) * sizeof(float);
}

float *hl_shadow_plane_at(const shadow_buffer *buffer, int sheet, shadow_plane kind, int channel) {
  size_t channels = (size_t)buffer->channels, slot = (size_t)(sheet % buffer->ring);
  size_t kinds = kinds_of_planes(buffer->has_outside, buffer->has_second),
         number = kind == SHADOW_TRANSMITTANCE ? 0
                  : kind == SHADOW_OUTSIDE     ? 1
                                               : kinds - 1;
  size_t plane = (slot * kinds + number) * channels + (size_t)channel;
  return buffer->planes + plane * buffer->plane + buffer->origin;
}

void hl_shadow_buffer_reach(shadow_buffer *buffer, int sheet) {
  buffer->sheet = sheet;
  for (int c = 0; c < buffer->channels; c++) {
    buffer->transmittance[c] = hl_shadow_plane_at(buffer, sheet, SHADOW_TRANSMITTANCE, c);
    buffer->outside[c] = buffer->has_outside ? hl_shadow_plane_at(buffer, sheet, SHADOW_OUTSIDE, c) : NULL;
    buffer->second[c] = buffer->has_second ? hl_shadow_plane_at(buffer, sheet, SHADOW_SECOND, c) : NULL;
  }
}

/* Copies a tile of one plane from the planes of the previous sheet. at: the tile's first pixel. */
static void carry_plane(const shadow_buffer *buffer, shadow_plane kind, int sheet, int channel, size_t at) {
  const float *from = hl_shadow_plane_at(buffer, sheet - 1, kind, channel) + at;
  float *to = hl_shadow_plane_at(buffer, sheet, kind, channel) + at;
  for (size_t row = 0; row < TILE; row++)
    memcpy(to + row * buffer->stride, from + row * buffer->stride, TILE * sizeof *to);
}

void hl_shadow_buffer_carry(shadow_buffer *buffer, size_t tile, int sheet) {
  size_t tiles_x = (size_t)buffer->tiles_x;
  size_t at = tile / tiles_x * TILE * buffer->stride + tile % tiles_x * TILE;
  if (buffer->ring == 1 || !hl_shadow_is_carried(buffer, tile, sheet)) return;
  for (int c = 0; c < buffer->channels; c++) {
    carry_plane(buffer, SHADOW_TRANSMITTANCE, sheet, c, at);
    if (buffer->has_outside) carry_plane(buffer, SHADOW_OUTSIDE, sheet, c, at);
    if (buffer->has_second) carry_plane(buffer, SHADOW_SECOND, sheet, c, at);
  }
}

hl_status hl_shadow_buffer_reset(hl_context *context, hl_pool *pool, shadow_buffer *buffer,
                                 const shadow_buffer_size *size, hl_error *error) {
  size_t plane_count = (size_t)size->ring * planes_of_sheet(size);
  hl_shadow_buffer_measure(size->view, size->reach, buffer);
  buffer->channels = size->channels;
  buffer->ring = size->ring;
  buffer->has_outside = size->outside;
  buffer->has_second = size->second;
  hl_status status = reserve(context, buffer, plane_count, error);
  if (status != HL_OK) return status;
  hl_pool_fill(pool, buffer->planes, plane_count * buffer->plane, 1);
  for (size_t tile = 0; tile < tiles_of(buffer); tile++) buffer->tile_lit[tile] = ALL_BLOCKS;
  memset(buffer->tile_touched, 0, 2 * tiles_of(buffer));
  memset(buffer->changed, 0, tiles_of(buffer) * sizeof *buffer->changed);
  for (int c = 0; c < HL_CHANNELS; c++)
    buffer->transmittance[c] = buffer->outside[c] = buffer->second[c] = NULL;
  hl_shadow_buffer_reach(buffer, 0);
  return HL_OK;
}

static uint16_t lit_blocks_of(const shadow_buffer *buffer, float *const planes[HL_CHANNELS], int x, int y,
                              lit_blocks_function *lit_blocks) {
  const float *transmittance[HL_CHANNELS] = {NULL, NULL, NULL};
  for (int c = 0; c < buffer->channels; c++)
    transmittance[c] = planes[c] + (size_t)y * TILE * buffer->stride + (size_t)x * TILE;
  return (uint16_t)lit_blocks(transmittance, buffer->channels, buffer->stride);
}

void hl_shadow_buffer_find_lit(shadow_buffer *buffer, int x, int y, bool both,
                               lit_blocks_function *lit_blocks) {
  uint16_t lit = lit_blocks_of(buffer, buffer->has_outside ? buffer->outside : buffer->transmittance, x, y,
                               lit_blocks);
  if (both) lit |= lit_blocks_of(buffer, buffer->second, x, y, lit_blocks);
  buffer->tile_lit[y * buffer->tiles_x + x] = lit;
}

shadow_map hl_map_of_view(const view *view) {
  shadow_map map = {.width = view->width, .height = view->height};
  double rows[3][4];
  hl_view_homogeneous(view, affine3_identity(), rows);
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 4; column++) map.rows[row][column] = (float)rows[row][column];
  return map;
}

void hl_shadow_buffer_release(hl_context *context, shadow_buffer *buffer) {
  hl_release(context, buffer->memory);
  *buffer = (shadow_buffer){0};
}
