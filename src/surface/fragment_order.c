/* surface/fragment_order.c - see fragment_order.h. */
#include "surface/fragment_order.h"

#include <string.h>

/* ---- sorting ---- */

int hl_by_pixel_rising(const fragment *a, const fragment *b) {
  if (a->pixel != b->pixel) return (int)a->pixel - (int)b->pixel;
  if (a->height != b->height) return a->height < b->height ? -1 : 1;
  return a->primitive < b->primitive ? -1 : a->primitive > b->primitive;
}

int hl_by_pixel_falling(const fragment *a, const fragment *b) {
  if (a->pixel != b->pixel) return (int)a->pixel - (int)b->pixel;
  if (a->height != b->height) return a->height > b->height ? -1 : 1;
  return a->primitive < b->primitive ? -1 : a->primitive > b->primitive;
}

int hl_by_slab(const fragment *a, const fragment *b) {
  return a->slab != b->slab ? (a->slab < b->slab ? -1 : 1) : hl_by_pixel_rising(a, b);
}

/* Merges the sorted runs [0, middle) and [middle, count) of `from` into `to`. */
static void merge(const fragment *from, size_t middle, size_t count, fragment *to, fragment_order *order) {
  size_t a = 0, b = middle;
  for (size_t i = 0; i < count; i++) {
    bool first = b == count || (a < middle && order(&from[a], &from[b]) <= 0);
    to[i] = first ? from[a++] : from[b++];
  }
}

void hl_sort_fragments(fragment *list, fragment *spare, size_t count, fragment_order *order) {
  fragment *from = list, *to = spare;
  for (size_t run = 1; run < count; run *= 2) {
    for (size_t at = 0; at < count; at += 2 * run) {
      size_t left = count - at, both = left < 2 * run ? left : 2 * run;
      merge(from + at, run < both ? run : both, both, to + at, order);
    }
    fragment *swapped = from;
    from = to;
    to = swapped;
  }
  if (from != list) memcpy(list, from, count * sizeof *list);
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
