/* light/light_caps.c - see light_caps.h. */
#include "light/light_caps.h"

#include "light/light_extent.h"

/* The number of points along each side of a part of a light. The part's middle and spread (light_cap) are
 * means over these points. */
enum { POINTS_OF_PART = 8 };

/* A light is not cut into parts if its apparent size is at most this fraction of its distance, and its
 * apparent length and width are about equal. */
static const double NARROW = 0.35;

/* Divides a rectangle into parts whose apparent length and width are about equal. length: the apparent
 * lengths of the rectangle's two edges. parts: receives the number of parts along each edge. */
static void cut_rect(const double length[2], int parts[2]) {
  int longer = length[1] > length[0], across = 1 - longer;
  double ratio = length[longer] / fmax(length[across], length[longer] / MOST_CAPS);
  if (!(ratio >= 1.5)) return;
  parts[longer] = (int)fmin(floor(ratio + 0.5), MOST_CAPS);
  parts[across] = 1;
}

/* Chooses the number of a light's parts along the two sides a and b of the unit square, whose points stand
 * for points of the light (hl_light_point). The light is seen from the content's middle. */
static void choose_parts(const light_source *source, int parts[2]) {
  const light_kind *kind = source->shape.kind;
  vec3 way = vec3_subtract(source->content, source->position), to = vec3_normalise(way);
  double length[2];
  kind->apparent_lengths(&source->shape, to, length);
  bool narrow = fmax(length[0], length[1]) <= NARROW * vec3_length(way);
  parts[0] = parts[1] = kind->sphere || narrow ? 1 : 2;
  if (kind->parallelogram) cut_rect(length, parts);
}

/* The offset of point number k of a part of a light from the light's centre. */
static vec3 point_of_part(const light_source *source, const int parts[2], int part, int k) {
  int i = part % parts[0], j = part / parts[0];
  double a = (i + (k % POINTS_OF_PART + 0.5) / POINTS_OF_PART) / parts[0],
         b = (j + (k / POINTS_OF_PART + 0.5) / POINTS_OF_PART) / parts[1];
  return hl_light_point(source, a, b);
}

static light_cap cap_of_part(const light_source *source, const int parts[2], int part) {
  const int count = POINTS_OF_PART * POINTS_OF_PART;
  vec3 sum = {0, 0, 0};
  double spread[6] = {0};
  for (int k = 0; k < count; k++) sum = vec3_add(sum, point_of_part(source, parts, part, k));
  vec3 middle = vec3_scale(sum, 1.0 / count);
  for (int k = 0; k < count; k++) {
    vec3 x = vec3_subtract(point_of_part(source, parts, part, k), middle);
    const double products[6] = {x.x * x.x, x.y * x.y, x.z * x.z, x.x * x.y, x.x * x.z, x.y * x.z};
    for (int i = 0; i < 6; i++) spread[i] += 2 * products[i] / count;
  }
  light_cap cap;
  vec3_store(cap.middle, vec3_add(source->position, middle));
  for (int i = 0; i < 6; i++) cap.spread[i] = (float)spread[i];
  return cap;
}

light_caps hl_light_caps(const light_source *source) {
  light_caps caps = {.count = 0};
  if (source->parallel || !source->shape.is_wide) return caps;
  int parts[2];
  choose_parts(source, parts);
  caps.count = parts[0] * parts[1];
  for (int i = 0; i < caps.count; i++) caps.cap[i] = cap_of_part(source, parts, i);
  if (!source->shape.kind->sphere) return caps;
  /* a sphere counts as a disk that faces the viewing point, from every viewing point */
  double radius = source->shape.radius;
  vec3_store(caps.cap[0].middle, source->position);
  for (int i = 0; i < 6; i++) caps.cap[0].spread[i] = i < 3 ? (float)(radius * radius / 2) : 0;
  return caps;
}
