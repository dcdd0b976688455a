/* surface/crossings.c - see crossings.h. */
#include "surface/crossings.h"

#include <string.h>

#include "surface/sample_rows.h"
#include "surface/shown_surface.h"

/* Fragments are cut into parts where they cross only in pixels with at most this number of fragments. In
 * pixels with more fragments, nobody sees the order of the surfaces. */
enum { MOST_FRAGMENTS = 32 };

/* The fragments of a pixel, with the surfaces of the fragments that may cross others. */
typedef struct pixel_fragments {
  const crossing_tile *tile;
  fragment list[2 * MOST_FRAGMENTS]; /* [count]; first the fragments that the caller gave, then the parts
                                      * that are cut off from them */
  uint8_t part_of[MOST_FRAGMENTS];   /* for each part, the index in `list` of the fragment from which the
                                      * part was cut */
  size_t given, count;
  shown_surface surfaces[MOST_FRAGMENTS];
  uint32_t has_surface, changed; /* One bit for each fragment that the caller gave. has_surface: the fragments
                                  * whose surface is known; changed: the fragments that were cut */
  int x, y;                      /* column and row of the pixel in the view */
} pixel_fragments;

/* Converts a height to a depth, a number that grows along the view's rays. */
static double depth_of(const pixel_fragments *pixel, double height) {
  return pixel->tile->order->falling ? -height : height;
}

/* The height of a surface at a point of the pixel. */
static double height_at(const pixel_fragments *pixel, const shown_surface *surface, double u, double v) {
  return hl_shown_height(pixel->tile->sheets, surface, u + pixel->x, v + pixel->y);
}

static const shown_surface *surface_of(pixel_fragments *pixel, size_t i) {
  const crossing_tile *tile = pixel->tile;
  const fragment *f = &pixel->list[i];
  shown_surface *surface = &pixel->surfaces[i];
  if (pixel->has_surface >> i & 1) return surface;
  pixel->has_surface |= 1u << i;
  double u, v;
  hl_fragment_middle(f->samples, &u, &v);
  surface->raster = hl_primitive_kind(tile->seen->all, f->primitive)->raster;
  surface->raster->show(tile->seen, tile->sheets, f, u + pixel->x, v + pixel->y, surface);
  return surface;
}

/* Returns the samples among the given ones at which fragment i lies before fragment j. */
static uint32_t samples_before(pixel_fragments *pixel, size_t i, size_t j, uint32_t samples) {
  const shown_surface *own = surface_of(pixel, i), *other = surface_of(pixel, j);
  uint32_t before = 0;
  for (; samples != 0; samples &= samples - 1) {
    int s = __builtin_ctz(samples);
    double u = (s + 0.5) / FRAGMENT_SAMPLES, v = (SAMPLE_ROWS[s] + 0.5) / FRAGMENT_SAMPLES;
    if (depth_of(pixel, height_at(pixel, own, u, v)) < depth_of(pixel, height_at(pixel, other, u, v)))
      before |= 1u << s;
  }
  return before;
}

/* Returns whether two fragments may cross within samples that both of them cover. first: the fragment that
 * comes before the other fragment. */
static bool may_cross(const pixel_fragments *pixel, const fragment *first, const fragment *second) {
  double apart = depth_of(pixel, (double)second->height) - depth_of(pixel, (double)first->height);
  return (first->samples & second->samples) != 0 &&
         apart <= hl_reach_of(first->reach, pixel->tile->sheets->spacing) +
                      hl_reach_of(second->reach, pixel->tile->sheets->spacing);
}

static void set_height(const pixel_fragments *pixel, const shown_surface *surface, fragment *f) {
  double u, v;
  hl_fragment_middle(f->samples, &u, &v);
  f->height = (float)fmin(fmax(height_at(pixel, surface, u, v), surface->lowest), surface->highest);
}

/* Makes a part of fragment i, which lets light through: some samples of it become a fragment of their own,
 * which comes before fragment j. The number of parts is at most the number of fragments. */
static void add_part(pixel_fragments *pixel, size_t i, size_t j, uint32_t samples) {
  fragment part = pixel->list[i], *other = &pixel->list[j];
  size_t number = pixel->count - pixel->given;
  if (number == pixel->given) return;
  pixel->list[i].samples &= (uint16_t)~samples;
  part.samples = (uint16_t)samples;
  set_height(pixel, surface_of(pixel, i), &part);
  if (depth_of(pixel, (double)part.height) > depth_of(pixel, (double)other->height))
    part.height = other->height;
  pixel->part_of[number] = (uint8_t)i;
  pixel->list[pixel->count++] = part;
}

/* Cuts fragment i, which lets light through, into parts where it crosses fragments that come before it. */
static void part_translucent(pixel_fragments *pixel, size_t i) {
  for (size_t j = 0; j < i; j++) {
    const fragment *own = &pixel->list[i], *other = &pixel->list[j];
    if (!may_cross(pixel, other, own)) continue;
    uint32_t nearer = samples_before(pixel, i, j, own->samples & other->samples);
    if (nearer != 0) add_part(pixel, i, j, nearer);
  }
}

/* Cuts fragment i, which is opaque, where it crosses fragments that come before it. If two fragments cross,
 * each of them loses the samples at which the other one hides it. */
static void part_opaque(pixel_fragments *pixel, size_t i) {
  const float *least = pixel->tile->order->least;
  fragment *own = &pixel->list[i];
  for (size_t k = 0; k < pixel->count; k++) {
    size_t j = k < pixel->given ? k : pixel->part_of[k - pixel->given];
    fragment *other = &pixel->list[k];
    if (j >= i || !may_cross(pixel, other, own)) continue;
    uint32_t both = own->samples & other->samples, nearer = samples_before(pixel, i, j, both);
    other->samples &= (uint16_t)~nearer;
    if (nearer == 0 || !hl_is_opaque(other, least)) continue;
    own->samples &= (uint16_t) ~(both & ~nearer);
    pixel->changed |= 1u << i | 1u << j;
  }
}

/* Writes a pixel's fragments in the order of their depths; a part comes before a fragment that has the same
 * depth. */
static size_t write_pixel(pixel_fragments *pixel, fragment *to) {
  size_t kept = 0, parts = pixel->count - pixel->given;
  for (size_t n = 0; n < pixel->count; n++) {
    size_t i = n < parts ? pixel->given + n : n - parts;
    fragment f = pixel->list[i];
    if (f.samples == 0) continue;
    if (i < pixel->given && (pixel->changed >> i & 1)) set_height(pixel, surface_of(pixel, i), &f);
    f.slab = hl_slab_of(pixel->tile->sheets, (double)f.height);
    size_t at = kept++;
    for (; at > 0 && depth_of(pixel, (double)to[at - 1].height) > depth_of(pixel, (double)f.height); at--)
      to[at] = to[at - 1];
    to[at] = f;
  }
  return kept;
}

/* Returns whether two fragments of a pixel share samples and may cross. */
static bool any_may_cross(const pixel_fragments *pixel, const fragment *list, size_t count) {
  uint32_t seen = 0;
  for (size_t i = 0; i < count; seen |= list[i++].samples)
    for (size_t j = 0; (list[i].samples & seen) != 0 && j < i; j++)
      if (may_cross(pixel, &list[j], &list[i])) return true;
  return false;
}

/* Cuts a pixel's fragments into parts where they cross. *parted: set to true if any fragment was cut. */
static size_t part_pixel(const crossing_tile *tile, const fragment *list, size_t count, fragment *to,
                         bool *parted) {
  pixel_fragments pixel;
  pixel.tile = tile;
  pixel.x = tile->x + hl_pixel_column(list->pixel);
  pixel.y = tile->y + hl_pixel_row(list->pixel);
  if (count > MOST_FRAGMENTS || !any_may_cross(&pixel, list, count)) {
    memcpy(to, list, count * sizeof *to);
    return count;
  }
  memcpy(pixel.list, list, count * sizeof *list);
  pixel.given = pixel.count = count;
  pixel.has_surface = pixel.changed = 0;
  for (size_t i = 1; i < count; i++)
    if (hl_is_opaque(&list[i], tile->order->least)) part_opaque(&pixel, i);
    else part_translucent(&pixel, i);
  *parted = true;
  return write_pixel(&pixel, to);
}

size_t hl_part_crossings(const crossing_tile *tile, const fragment *list, size_t count, fragment *to,
                         bool *parted) {
  size_t kept = 0;
  *parted = false;
  for (size_t i = 0, end; i < count; i = end) {
    for (end = i + 1; end < count && list[end].pixel == list[i].pixel;) end++;
    kept += part_pixel(tile, list + i, end - i, to + kept, parted);
  }
  return kept;
}
