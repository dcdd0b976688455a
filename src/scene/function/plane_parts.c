/* scene/function/plane_parts.c - checks and copies the description of a transfer function of two numbers, and
 * finds the mark that identifies its content. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/key.h"
#include "core/memory.h"
#include "scene/check/checker.h"
#include "scene/check/limits.h"
#include "scene/function/function_plane.h"

/* ---- checks ---- */

static const char GIVE_VALUE[] = "give a number between -1e30 and 1e30";

static hl_status check_pair(const hl_checker *check, const char *key, const double pair[2]) {
  hl_status status = HL_OK;
  for (int a = 0; a < 2 && status == HL_OK; a++) {
    char element[64];
    snprintf(element, sizeof element, "%s/%d", key, a);
    status = hl_check_range(check, element, pair[a], -1e30, 1e30, GIVE_VALUE);
  }
  return status;
}

const char *const hl_plane_range_keys[2] = {"value", "second"};

static hl_status check_ranges(const hl_checker *check, const double low[2], const double high[2]) {
  hl_status status = HL_OK;
  for (int a = 0; a < 2 && status == HL_OK; a++) {
    status = check_pair(check, hl_plane_range_keys[a], (const double[2]){low[a], high[a]});
    if (status == HL_OK && !(low[a] < high[a]))
      status = hl_fail(check->error, HL_ERROR_INPUT,
                       "%s/%s: %.9g to %.9g is empty: give two numbers, the lower one first", check->place,
                       hl_plane_range_keys[a], low[a], high[a]);
  }
  return status;
}

static hl_status check_look(const hl_checker *check, const double color[3], double opacity) {
  hl_status status = hl_check_range(check, "opacity", opacity, 0, 1, "give an opacity from 0 to 1");
  for (int c = 0; c < 3 && status == HL_OK; c++) {
    char element[16];
    snprintf(element, sizeof element, "color/%d", c);
    status = hl_check_range(check, element, color[c], 0, 1, "give linear RGB, each from 0 to 1");
  }
  return status;
}

static hl_status check_box(const hl_checker *check, const hl_function_box *box) {
  hl_status status = check_ranges(check, box->low, box->high);
  if (status == HL_OK) status = check_look(check, box->color, box->opacity);
  for (int a = 0; a < 2 && status == HL_OK; a++)
    status = hl_check_range(check, a == 0 ? "edge/0" : "edge/1", box->edge[a], 0, 1e30,
                            "give the edge's width, from 0 to 1e30");
  return status == HL_OK ? hl_check_range(check, "sigma", box->sigma, 0, 1e6,
                                          "give the Gaussian's width, of the box's sides, from 0 to 1e6")
                         : status;
}

static hl_status check_polygon(const hl_checker *check, const hl_function_polygon *polygon) {
  hl_status status = hl_check_count(check, "vertices", polygon->vertices, polygon->vertex_count,
                                    HL_LIMIT_VERTICES);
  if (status == HL_OK && polygon->vertex_count < 3)
    status = hl_check_refuse(check, "vertices", "has fewer than three: give a polygon's");
  for (size_t v = 0; v < polygon->vertex_count && status == HL_OK; v++) {
    char element[40];
    snprintf(element, sizeof element, "vertices/%zu", v);
    status = check_pair(check, element, polygon->vertices[v]);
  }
  if (status == HL_OK) status = check_pair(check, "apex", polygon->apex);
  if (status == HL_OK) status = check_look(check, polygon->color, polygon->opacity);
  return status == HL_OK ? hl_check_range(check, "falloff", polygon->falloff, 0, 1,
                                          "give a fraction of the way to the border, from 0 to 1")
                         : status;
}

static hl_status check_image(const hl_checker *check, const hl_function_image *image) {
  if (image->pixels == NULL) return HL_OK;
  hl_status status = check_ranges(check, image->low, image->high);
  const char *size = "give an image of at most 4096 pixels a side";
  if (status == HL_OK) status = hl_check_range(check, "width", image->width, 1, HL_LIMIT_PLANE_SIDE, size);
  if (status == HL_OK) status = hl_check_range(check, "height", image->height, 1, HL_LIMIT_PLANE_SIDE, size);
  for (size_t i = 0; status == HL_OK && i < 4 * (size_t)image->width * (size_t)image->height; i++)
    if (!(image->pixels[i] >= 0 && image->pixels[i] <= 1))
      status = hl_fail(check->error, HL_ERROR_INPUT,
                       "%s/file: pixel (%zu, %zu) has %.9g in channel %zu: give numbers from 0 to 1",
                       check->place, i / 4 % (size_t)image->width, i / 4 / (size_t)image->width,
                       (double)image->pixels[i], i % 4);
  return status;
}

static hl_checker inside(const char *place, const char *key, size_t index, hl_error *error) {
  hl_checker check = {error, ""};
  snprintf(check.place, sizeof check.place, "%s/%s/%zu", place, key, index);
  return check;
}

/* Checks the points of one curve. points: [count]; each point begins with its place along the axis. size: the
 * bytes of a point. */
static hl_status check_order(const hl_checker *check, const char *key, const void *points, size_t count,
                             size_t size) {
  hl_status status = hl_check_count(check, key, points, count, HL_LIMIT_POINTS);
  double before = -INFINITY;
  for (size_t n = 0; n < count && status == HL_OK; n++) {
    char element[48];
    double at;
    memcpy(&at, (const char *)points + n * size, sizeof at);
    snprintf(element, sizeof element, "%s/%zu/0", key, n);
    status = hl_check_range(check, element, at, -1e30, 1e30, GIVE_VALUE);
    if (status == HL_OK && at < before)
      status = hl_check_refuse(check, element, "is below the point before it: sort the points");
    before = at;
  }
  return status;
}

/* Checks the volume's own colours, which the volume keeps at some second numbers. */
static hl_status check_own(const hl_checker *check, const hl_function_curves *curves) {
  hl_status status = check_order(check, "own_color", curves->own_color, curves->own_color_count,
                                 sizeof *curves->own_color);
  for (size_t n = 0; n < curves->own_color_count && status == HL_OK; n++)
    status = hl_check_point_color(check, "own_color", n, curves->own_color[n].color);
  for (int end = 0; end < 2 && status == HL_OK; end++)
    status = hl_check_range(check, end ? "own_between/1" : "own_between/0", curves->own_between[end], -1e30,
                            1e30, "give a second number");
  if (status == HL_OK && curves->own_between[0] > curves->own_between[1])
    status = hl_check_refuse(check, "own_between", "ends below its beginning: give [LO, HI]");
  return status;
}

static hl_status check_curves(const char *place, const hl_function_curves *curves, hl_error *error) {
  hl_checker check = {error, ""};
  snprintf(check.place, sizeof check.place, "%s/curves", place);
  if (curves->opacity_count == 0)
    return curves->color_count == 0
               ? HL_OK
               : hl_check_refuse(&check, "opacity", "is missing: give [[value, opacity], ...]");
  hl_status status = check_order(&check, "opacity", curves->opacity, curves->opacity_count,
                                 sizeof *curves->opacity);
  if (status == HL_OK)
    status = check_order(&check, "color", curves->color, curves->color_count, sizeof *curves->color);
  for (size_t n = 0; n < curves->opacity_count && status == HL_OK; n++)
    status = hl_check_point_opacity(&check, "opacity", n, curves->opacity[n].opacity);
  for (size_t n = 0; n < curves->color_count && status == HL_OK; n++)
    status = hl_check_point_color(&check, "color", n, curves->color[n].color);
  return status == HL_OK ? check_own(&check, curves) : status;
}

hl_status hl_plane_check(const hl_function_plane *plane, const char *place, hl_error *error) {
  hl_checker check = {error, ""};
  snprintf(check.place, sizeof check.place, "%s", place);
  bool shapes = plane->box_count > 0 || plane->polygon_count > 0 || plane->image.pixels != NULL ||
                plane->curves.opacity_count > 0;
  if (plane->second == HL_SECOND_NONE)
    return shapes ? hl_check_refuse(&check, "second",
                                    "is missing: say what boxes, polygons, an image or curves take")
                  : HL_OK;
  if (plane->second != HL_SECOND_GRADIENT && plane->second != HL_SECOND_VOLUME)
    return hl_check_refuse(&check, "second", "is unknown: give \"gradient\" or {\"volume\": NAME}");
  if (!shapes)
    return hl_check_refuse(&check, "second", "has no use: give boxes, polygons, an image or curves");
  if (plane->second == HL_SECOND_VOLUME && plane->volume == NULL)
    return hl_check_refuse(&check, "second/volume", "is missing: give another volume's name");
  if (!(plane->second_scale >= 0 && plane->second_scale <= 1e30))
    return hl_check_refuse(&check, "second_scale", "is no factor: give a number from 0 to 1e30");
  hl_status status = hl_check_count(&check, "boxes", plane->boxes, plane->box_count, HL_LIMIT_SHAPES);
  if (status == HL_OK)
    status = hl_check_count(&check, "polygons", plane->polygons, plane->polygon_count, HL_LIMIT_SHAPES);
  for (size_t b = 0; b < plane->box_count && status == HL_OK; b++) {
    hl_checker at = inside(place, "boxes", b, error);
    status = check_box(&at, &plane->boxes[b]);
  }
  size_t vertices = 0;
  for (size_t p = 0; p < plane->polygon_count && status == HL_OK; p++) {
    vertices += plane->polygons[p].vertex_count;
    if (vertices > HL_LIMIT_VERTICES)
      return hl_check_refuse(&check, "polygons", "have more than 1024 vertices together: leave some out");
    hl_checker at = inside(place, "polygons", p, error);
    status = check_polygon(&at, &plane->polygons[p]);
  }
  if (status == HL_OK) status = check_curves(place, &plane->curves, error);
  if (status != HL_OK) return status;
  snprintf(check.place, sizeof check.place, "%s/image", place);
  return check_image(&check, &plane->image);
}

/* ---- copies ---- */

void hl_plane_release(hl_context *context, hl_function_plane *plane) {
  for (size_t p = 0; p < plane->polygon_count && plane->polygons != NULL; p++)
    hl_release(context, (void *)plane->polygons[p].vertices);
  hl_release(context, (void *)plane->polygons);
  hl_release(context, (void *)plane->boxes);
  hl_release(context, (void *)plane->curves.opacity);
  hl_release(context, (void *)plane->curves.color);
  hl_release(context, (void *)plane->curves.own_color);
  hl_release(context, (void *)plane->volume);
  hl_release(context, (void *)plane->image.file);
  hl_release(context, (void *)plane->image.pixels);
  *plane = (hl_function_plane){0};
}

/* Copies `count` items of an array. Returns null if `count` is 0, or if memory is short. */
static void *copy_of(hl_context *context, const void *items, size_t count, size_t size) {
  if (count == 0 || items == NULL) return NULL;
  void *copy = hl_allocate(context, count, size);
  if (copy != NULL) memcpy(copy, items, count * size);
  return copy;
}

static bool copy_polygons(hl_context *context, const hl_function_plane *from, hl_function_plane *to) {
  hl_function_polygon *polygons = copy_of(context, from->polygons, from->polygon_count, sizeof *polygons);
  if (from->polygon_count > 0 && polygons == NULL) return false;
  for (size_t p = 0; p < from->polygon_count; p++) polygons[p].vertices = NULL;
  to->polygons = polygons;
  to->polygon_count = from->polygon_count;
  for (size_t p = 0; p < from->polygon_count; p++) {
    const hl_function_polygon *polygon = &from->polygons[p];
    polygons[p].vertices = copy_of(context, polygon->vertices, polygon->vertex_count,
                                   sizeof *polygon->vertices);
    if (polygons[p].vertices == NULL) return false;
  }
  return true;
}

static bool copy_text(hl_context *context, const char *from, const char **to) {
  if (from != NULL) *to = hl_copy_text(context, from);
  return from == NULL || *to != NULL;
}

hl_status hl_plane_copy(hl_context *context, const hl_function_plane *from, hl_function_plane *to,
                        hl_error *error) {
  const hl_function_image *image = &from->image;
  *to = (hl_function_plane){.second = from->second, .second_scale = from->second_scale};
  if (from->second == HL_SECOND_NONE) return HL_OK;
  to->boxes = copy_of(context, from->boxes, from->box_count, sizeof *from->boxes);
  to->box_count = from->box_count;
  to->image = *image;
  to->image.file = NULL;
  to->image.pixels = copy_of(context, image->pixels, (size_t)image->width * (size_t)image->height,
                             4 * sizeof(float));
  to->curves = from->curves;
  to->curves.opacity = copy_of(context, from->curves.opacity, from->curves.opacity_count,
                               sizeof *from->curves.opacity);
  to->curves.color = copy_of(context, from->curves.color, from->curves.color_count,
                             sizeof *from->curves.color);
  to->curves.own_color = copy_of(context, from->curves.own_color, from->curves.own_color_count,
                                 sizeof *from->curves.own_color);
  bool whole = (from->box_count == 0 || to->boxes != NULL) &&
               (from->curves.opacity_count == 0 || to->curves.opacity != NULL) &&
               (from->curves.color_count == 0 || to->curves.color != NULL) &&
               (from->curves.own_color_count == 0 || to->curves.own_color != NULL) &&
               (image->pixels == NULL || to->image.pixels != NULL) &&
               copy_text(context, image->file, &to->image.file) &&
               (from->second != HL_SECOND_VOLUME || copy_text(context, from->volume, &to->volume)) &&
               copy_polygons(context, from, to);
  return whole ? HL_OK : hl_fail_memory(error, sizeof *to, "a transfer function of two numbers");
}

/* ---- the mark ---- */

static void add_block(uint64_t *mark, const void *bytes, size_t count) {
  const uint64_t both[2] = {*mark, hl_key_mark(bytes, count)};
  *mark = hl_key_mark(both, sizeof both);
}

uint64_t hl_plane_mark(const hl_function_plane *plane) {
  const hl_function_image *image = &plane->image;
  uint64_t mark = 1;
  const double numbers[] = {(double)plane->second,
                            plane->second_scale,
                            (double)plane->box_count,
                            (double)plane->polygon_count,
                            image->width,
                            image->height,
                            image->low[0],
                            image->low[1],
                            image->high[0],
                            image->high[1],
                            plane->curves.own_between[0],
                            plane->curves.own_between[1]};
  const hl_function_curves *curves = &plane->curves;
  add_block(&mark, numbers, sizeof numbers);
  if (curves->opacity_count > 0)
    add_block(&mark, curves->opacity, curves->opacity_count * sizeof *curves->opacity);
  if (curves->color_count > 0) add_block(&mark, curves->color, curves->color_count * sizeof *curves->color);
  if (curves->own_color_count > 0)
    add_block(&mark, curves->own_color, curves->own_color_count * sizeof *curves->own_color);
  if (plane->box_count > 0) add_block(&mark, plane->boxes, plane->box_count * sizeof *plane->boxes);
  for (size_t p = 0; p < plane->polygon_count; p++) {
    const hl_function_polygon *polygon = &plane->polygons[p];
    const double look[] = {polygon->apex[0],  polygon->apex[1], polygon->color[0], polygon->color[1],
                           polygon->color[2], polygon->opacity, polygon->falloff};
    add_block(&mark, look, sizeof look);
    add_block(&mark, polygon->vertices, polygon->vertex_count * sizeof *polygon->vertices);
  }
  if (image->pixels != NULL)
    add_block(&mark, image->pixels, 4 * sizeof(float) * (size_t)image->width * (size_t)image->height);
  return mark;
}
