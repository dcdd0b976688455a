/* surface/fragment_order.c - see fragment_order.h. */
#include "surface/fragment_order.h"
#include "core/sheet_constants.h"

#include <math.h>
#include <string.h>

/* ---- sorting ---- */

uint32_t hl_ordered_bits(float height, bool falling) {
  uint32_t bits;
  height += 0.0f; /* turns minus zero into zero */
  memcpy(&bits, &height, sizeof bits);
  bits ^= bits >> 31 ? 0xffffffffu : 0x80000000u;
  return falling ? ~bits : bits;
}

/* Merges the sorted runs [0, middle) and [middle, count) of `from` into one sorted run in `to`. */
static void merge(const order_key *from, size_t middle, size_t count, order_key *to) {
  size_t a = 0, b = middle;
  for (size_t i = 0; i < count; i++) {
    bool first = b == count || (a < middle && from[a].key <= from[b].key);
    to[i] = first ? from[a++] : from[b++];
  }
}

/* Runs of this number of keys are sorted by insertion. */
enum { SHORT_RUN = 16 };

static void sort_short_run(order_key *list, size_t count) {
  for (size_t i = 1; i < count; i++) {
    order_key own = list[i];
    size_t at = i;
    for (; at > 0 && own.key < list[at - 1].key; at--) list[at] = list[at - 1];
    list[at] = own;
  }
}

/* Sorts short runs of keys by insertion, then merges the runs. */
void hl_sort_keys(order_key *list, order_key *spare, size_t count) {
  for (size_t at = 0; at < count; at += SHORT_RUN)
    sort_short_run(list + at, count - at < SHORT_RUN ? count - at : SHORT_RUN);
  order_key *from = list, *to = spare;
  for (size_t run = SHORT_RUN; run < count; run *= 2) {
    for (size_t at = 0; at < count; at += 2 * run) {
      size_t left = count - at, both = left < 2 * run ? left : 2 * run;
      merge(from + at, run < both ? run : both, both, to + at);
    }
    order_key *swapped = from;
    from = to;
    to = swapped;
  }
  if (from != list) memcpy(list, from, count * sizeof *list);
}

/* Returns whether two surfaces may cross. apart: the difference of their heights. reach, other: the reaches
 * of the two surfaces, the greatest distances from these heights (fragment.h). */
static bool may_meet(const fragment_order *order, float apart, uint8_t reach, uint8_t other) {
  return fabs((double)apart) <= hl_reach_of(reach, order->spacing) + hl_reach_of(other, order->spacing);
}

/* Copies a pixel's fragments in the order of their keys. Leaves out each fragment whose samples are surely
 * covered by opaque fragments before it, whatever the slopes of the surfaces. most: the greatest reach of any
 * fragment. Returns the number of copied fragments. */
static size_t copy_uncovered(const fragment *list, const order_key *keys, size_t count, uint8_t most,
                             const fragment_order *order, fragment *to) {
  size_t kept = 0;
  uint32_t covered = 0;
  float last = 0;    /* the height above the first sheet of the last opaque fragment so far */
  uint8_t reach = 0; /* the greatest reach of the opaque fragments so far */
  for (size_t i = 0; i < count; i++) {
    const fragment *f = &list[keys[i].index];
    if (covered == 0xffff && !may_meet(order, f->height - last, most, reach)) break;
    if ((f->samples & ~covered) == 0 && !may_meet(order, f->height - last, f->reach, reach)) continue;
    if (hl_is_opaque(f, order->least)) {
      covered |= f->samples;
      last = f->height;
      reach = f->reach > reach ? f->reach : reach;
    }
    to[kept++] = *f;
  }
  return kept;
}

size_t hl_sort_by_pixel(const fragment *list, size_t count, const fragment_order *order, order_key *keys,
                        fragment *sorted) {
  uint32_t places[TILE_PIXELS + 1] = {0};
  size_t kept = 0;
  uint8_t most = 0;
  for (size_t i = 0; i < count; i++) {
    places[list[i].pixel + 1]++;
    most = list[i].reach > most ? list[i].reach : most;
  }
  for (int p = 0; p < TILE_PIXELS; p++) places[p + 1] += places[p];
  for (size_t i = 0; i < count; i++)
    keys[places[list[i].pixel]++] = (order_key){
        (uint64_t)hl_ordered_bits(list[i].height, order->falling) << 32 | list[i].primitive, (uint32_t)i};
  /* places[p] is now the index of the fragment that follows pixel p's last fragment */
  for (size_t p = 0, first = 0; p < TILE_PIXELS; first = places[p++]) {
    size_t own = places[p] - first;
    hl_sort_keys(keys + first, keys + count, own);
    if (!order->slabs && !order->apart) {
      kept += copy_uncovered(list, keys + first, own, most, order, sorted + kept);
      continue;
    }
    for (size_t i = 0; i < own; i++) sorted[kept++] = list[keys[first + i].index];
  }
  return kept;
}

/* Reverses the order of the fragments within each pixel of each slab. */
static void turn_round(fragment *list, size_t count) {
  for (size_t i = 0, end; i < count; i = end) {
    for (end = i + 1; end < count && list[end].pixel == list[i].pixel && list[end].slab == list[i].slab;)
      end++;
    for (size_t a = i, b = end - 1; a < b; a++, b--) {
      fragment swapped = list[a];
      list[a] = list[b];
      list[b] = swapped;
    }
  }
}

void hl_sort_by_slab(const fragment *list, size_t count, const fragment_order *order, uint32_t *places,
                     int slabs, fragment *sorted) {
  memset(places, 0, ((size_t)slabs + 2) * sizeof *places);
  for (size_t i = 0; i < count; i++) places[list[i].slab + 1]++;
  for (int s = 0; s <= slabs; s++) places[s + 1] += places[s];
  for (size_t i = 0; i < count; i++) sorted[places[list[i].slab]++] = list[i];
  if (order->falling) turn_round(sorted, count);
}

/* ---- opacities ---- */

static int count_samples(uint32_t samples) {
  int count = 0;
  for (; samples != 0; samples &= samples - 1) count++;
  return count;
}

/* Finds the opacities of the opaque fragments with which a pixel's fragments begin, and returns the number of
 * these fragments, which may be 0. The fragments before such a fragment leave some samples open. The opacity
 * of the fragment is the fraction of these open samples that it covers. *open: receives the samples that all
 * of these fragments leave open. */
static size_t resolve_opaque(fragment *list, size_t count, const float *least, uint32_t *open) {
  size_t i = 0;
  *open = 0xffff;
  for (; i < count && hl_is_opaque(&list[i], least); i++) {
    int before = count_samples(*open), taken = count_samples(*open & list[i].samples);
    list[i].opacity = before > 0 ? (float)taken / (float)before : 0;
    list[i].seen = (uint16_t)(*open & list[i].samples);
    *open &= ~(uint32_t)list[i].samples;
  }
  return i;
}

/* Finds the opacities of one pixel's fragments. The fragments must be in the order in which the light or the
 * eye meets them. Fragments that absorb no light get the opacity 0. */
static void resolve_pixel(fragment *list, size_t count, const float *least) {
  uint32_t open;
  size_t first = resolve_opaque(list, count, least, &open);
  if (first == count) return;
  float left[FRAGMENT_SAMPLES], sum = (float)count_samples(open);
  for (int s = 0; s < FRAGMENT_SAMPLES; s++) left[s] = (float)(open >> s & 1);
  for (size_t i = first; i < count; i++) {
    float own = list[i].opacity, taken = 0, after = 0;
    list[i].seen = 0;
    for (int s = 0; s < FRAGMENT_SAMPLES; s++) {
      float part = list[i].samples >> s & 1 ? left[s] * own : 0;
      if (part > 0) list[i].seen |= (uint16_t)(1u << s);
      taken += part;
      left[s] -= part * least[list[i].mesh];
      after += left[s];
    }
    bool reached = sum > (1 - PIXEL_OPAQUE) * FRAGMENT_SAMPLES;
    list[i].opacity = !reached ? 0 : after <= 0 ? 1 : taken / sum < 1 ? taken / sum : 1;
    sum = after;
  }
}

/* Finds the opacities of one pixel's fragments, like resolve_pixel(), but for a light's view whose buffer is
 * also used for rays of other directions. A pixel that opaque surfaces cover in a slab, or in a slab and the
 * slab before it, is opaque there. This holds even where surfaces before this slab have absorbed all light of
 * the view's own ray, because other rays pass beside these surfaces. The previous slab counts as well, for
 * the following reason. Two triangles of a surface may share a pixel and lie in neighbouring slabs. If each
 * of them absorbed its part of the light, one after the other, some light would be left and come through the
 * surface. The fragments of one slab become one fragment. Returns the number of fragments that are left. */
static size_t resolve_slabs(fragment *list, size_t count, const float *least) {
  size_t kept = 0;
  uint32_t before = 0, covered = 0; /* before: the samples that opaque fragments cover in the slab before;
                                     * covered: the samples that they cover in this slab */
  for (size_t i = 0; i < count; i++) {
    if (i == 0 || list[i].slab != list[i - 1].slab) {
      before = i > 0 && list[i].slab == list[i - 1].slab + 1 ? covered : 0;
      covered = 0;
    }
    if (hl_is_opaque(&list[i], least)) covered |= list[i].samples;
    /* from here on, `primitive` tells whether opaque surfaces cover the whole pixel; a light's view does not
     * need the primitive's number any more */
    list[i].primitive = covered != 0 && (before | covered) == 0xffff;
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

/* Joins fragments of one pixel to one fragment if they belong to neighbouring triangles of a coloured pane
 * and cover different samples. Then the pane absorbs the same fraction of each colour however the pixel is
 * divided among its triangles. Returns the number of fragments that are left. */
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

/* Finds opacities as if no fragment hid another: each fragment absorbs the light of the part of the pixel
 * that it covers. Fragments are joined to one fragment if they belong to neighbouring triangles of a mesh and
 * cover different samples. Returns the number of fragments that are left. */
static size_t resolve_apart(fragment *list, size_t count) {
  size_t kept = 0;
  for (size_t i = 0; i < count; i++) {
    fragment *latest = kept > 0 ? &list[kept - 1] : NULL, own = list[i];
    own.opacity *= (float)count_samples(own.samples) / FRAGMENT_SAMPLES;
    if (latest == NULL || latest->pixel != own.pixel || latest->mesh != own.mesh ||
        (latest->samples & own.samples) != 0) {
      list[kept++] = own;
      continue;
    }
    latest->opacity += own.opacity;
    latest->samples |= own.samples;
  }
  return kept;
}

size_t hl_resolve_fragments(fragment *list, size_t count, const fragment_order *order) {
  const float *least = order->least;
  size_t kept = 0;
  if (order->apart) return resolve_apart(list, count);
  for (size_t i = 0, end; i < count; i = end) {
    for (end = i + 1; end < count && list[end].pixel == list[i].pixel;) end++;
    size_t left = join_panes(list + i, end - i, least);
    if (order->slabs) left = resolve_slabs(list + i, left, least);
    else resolve_pixel(list + i, left, least);
    for (size_t k = i; k < i + left; k++)
      if (list[k].opacity > 0) list[kept++] = list[k];
  }
  return kept;
}
