/* surface/fragment_order.c - see fragment_order.h. */
#include "surface/fragment_order.h"

#include <string.h>

/* ---- sorting ---- */

/* Whether a comes before b in their pixel; heights rise. */
static bool is_below(const fragment *a, const fragment *b) {
  return a->height != b->height ? a->height < b->height : a->primitive <= b->primitive;
}

static bool is_above(const fragment *a, const fragment *b) {
  return a->height != b->height ? a->height > b->height : a->primitive <= b->primitive;
}

typedef bool comes_before(const fragment *a, const fragment *b);

/* Merges the sorted runs [0, middle) and [middle, count) of `from` into `to`. */
static void merge(const fragment *from, size_t middle, size_t count, fragment *to, comes_before *before) {
  size_t a = 0, b = middle;
  for (size_t i = 0; i < count; i++) {
    bool first = b == count || (a < middle && before(&from[a], &from[b]));
    to[i] = first ? from[a++] : from[b++];
  }
}

/* Sorts by merging. */
static void sort_pixel(fragment *list, fragment *spare, size_t count, comes_before *before) {
  fragment *from = list, *to = spare;
  for (size_t run = 1; run < count; run *= 2) {
    for (size_t at = 0; at < count; at += 2 * run) {
      size_t left = count - at, both = left < 2 * run ? left : 2 * run;
      merge(from + at, run < both ? run : both, both, to + at, before);
    }
    fragment *swapped = from;
    from = to;
    to = swapped;
  }
  if (from != list) memcpy(list, from, count * sizeof *list);
}

void hl_sort_by_pixel(fragment *list, fragment *spare, size_t count, bool falling) {
  uint32_t places[TILE_PIXELS + 1] = {0};
  for (size_t i = 0; i < count; i++) places[list[i].pixel + 1]++;
  for (int p = 0; p < TILE_PIXELS; p++) places[p + 1] += places[p];
  for (size_t i = 0; i < count; i++) spare[places[list[i].pixel]++] = list[i];
  memcpy(list, spare, count * sizeof *list);
  for (size_t i = 0, end; i < count; i = end) { /* a place is now its pixel's end */
    end = places[list[i].pixel];
    sort_pixel(list + i, spare, end - i, falling ? is_above : is_below);
  }
}

/* Turns round the fragments of each pixel of a slab whose heights fall. */
static void let_rise(fragment *list, size_t count) {
  for (size_t i = 0, end; i < count; i = end) {
    for (end = i + 1; end < count && list[end].pixel == list[i].pixel && list[end].slab == list[i].slab;)
      end++;
    if (list[i].height <= list[end - 1].height) continue;
    for (size_t a = i, b = end - 1; a < b; a++, b--) {
      fragment swapped = list[a];
      list[a] = list[b];
      list[b] = swapped;
    }
  }
}

void hl_sort_by_slab(fragment *list, fragment *spare, size_t count, uint32_t *places, int slabs) {
  memset(places, 0, ((size_t)slabs + 2) * sizeof *places);
  for (size_t i = 0; i < count; i++) places[list[i].slab + 1]++;
  for (int s = 0; s <= slabs; s++) places[s + 1] += places[s];
  for (size_t i = 0; i < count; i++) spare[places[list[i].slab]++] = list[i];
  memcpy(list, spare, count * sizeof *list);
  let_rise(list, count);
}

/* ---- opacities ---- */

/* Finds the opacities of one pixel's fragments, which are in the order that the light or the eye meets them.
 * Those that take nothing get opacity 0. */
static void resolve_pixel(fragment *list, size_t count, const float *least) {
  float left[FRAGMENT_SAMPLES], sum = FRAGMENT_SAMPLES;
  for (int s = 0; s < FRAGMENT_SAMPLES; s++) left[s] = 1;
  for (size_t i = 0; i < count; i++) {
    float own = list[i].opacity, taken = 0, after = 0;
    for (int s = 0; s < FRAGMENT_SAMPLES; s++) {
      float part = list[i].samples >> s & 1 ? left[s] * own : 0;
      taken += part;
      left[s] -= part * least[list[i].mesh];
      after += left[s];
    }
    bool reached = sum > (1 - PIXEL_OPAQUE) * FRAGMENT_SAMPLES;
    list[i].opacity = !reached ? 0 : after <= 0 ? 1 : taken / sum < 1 ? taken / sum : 1;
    sum = after;
  }
}

/* The same for a light's view whose buffer is also used for rays of other directions. A pixel that opaque
 * surfaces cover in a slab is opaque there, even where surfaces before it have taken all light of the view's
 * own ray: the other rays pass these by. Fragments of one slab become one; returns how many are left. */
static size_t resolve_slabs(fragment *list, size_t count, const float *least) {
  size_t kept = 0;
  uint32_t covered = 0;
  for (size_t i = 0; i < count; i++) {
    bool begins = i == 0 || list[i].slab != list[i - 1].slab;
    covered = (begins ? 0 : covered) | (list[i].opacity * least[list[i].mesh] >= 1 ? list[i].samples : 0u);
    list[i].primitive = covered ==
                        0xffff; /* of a light's fragments the primitive is not asked for any more */
  }
  resolve_pixel(list, count, least);
  for (size_t i = 0; i < count; i++) {
    if (list[i].primitive) list[i].opacity = 1;
    if (kept > 0 && list[kept - 1].slab == list[i].slab && list[kept - 1].mesh == list[i].mesh)
      list[kept - 1].opacity = 1 - (1 - list[kept - 1].opacity) * (1 - list[i].opacity);
    else list[kept++] = list[i];
  }
  return kept;
}

static int count_samples(uint32_t samples) {
  int count = 0;
  for (; samples != 0; samples &= samples - 1) count++;
  return count;
}

/* Makes one fragment of neighbouring triangles of a coloured pane, which cover different samples of a pixel:
 * each colour then loses what it loses to the pane, however the triangles share the pixel. Returns how many
 * fragments are left. */
static size_t join_panes(fragment *list, size_t count, const float *least) {
  size_t kept = 0;
  for (size_t i = 0; i < count; i++) {
    fragment *pane = kept > 0 ? &list[kept - 1] : NULL, own = list[i];
    if (pane == NULL || least[own.mesh] >= 1 || pane->mesh != own.mesh ||
        (pane->samples & own.samples) != 0) {
      list[kept++] = own;
      continue;
    }
    float before = (float)count_samples(pane->samples), added = (float)count_samples(own.samples);
    pane->opacity = (pane->opacity * before + own.opacity * added) / (before + added);
    pane->samples |= own.samples;
  }
  return kept;
}

size_t hl_resolve_fragments(fragment *list, size_t count, const float *least, bool slabs) {
  size_t kept = 0;
  for (size_t i = 0, end; i < count; i = end) {
    for (end = i + 1; end < count && list[end].pixel == list[i].pixel;) end++;
    size_t left = join_panes(list + i, end - i, least);
    if (slabs) left = resolve_slabs(list + i, left, least);
    else resolve_pixel(list + i, left, least);
    for (size_t k = i; k < i + left; k++)
      if (list[k].opacity > 0) list[kept++] = list[k];
  }
  return kept;
}
