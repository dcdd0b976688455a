/* json/shapes.c - reads shapes and groups of shapes, and makes a volume of them.
 *
 * A group in a list names one of the scene's "groups", or holds its shapes itself. A named group is read each
 * time it is used; its errors point into "groups".
 */
#include "json/shapes.h"

#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "scene/check/check.h"
#include "shape/shape.h"
#include "text/edit_distance.h"

enum { DEFAULT_SIZE = 128, MOST_OCTAVES = 16, HIGHEST_N = 8 };

static const char *const type_names[] = {"box",   "sphere", "cylinder", "capsule", "cone",
                                         "torus", "plane",  "orbital",  "group",   NULL};
static const char *const operation_names[] = {"add", "subtract", "intersect", NULL};
/* The names of the patterns. The first name stands for HL_PATTERN_NOISE. */
static const char *const pattern_names[] = {"noise", "turbulence", NULL};

#define PLACEMENT_KEYS "type", "name", "position", "rotate", "scale"
#define COMMON_KEYS    PLACEMENT_KEYS, "operation", "blend", "hypertexture"

static const char *const keys_of_type[][16] = {
    [HL_SHAPE_BOX] = {COMMON_KEYS, "size", "rounding"},
    [HL_SHAPE_SPHERE] = {COMMON_KEYS, "radius"},
    [HL_SHAPE_CYLINDER] = {COMMON_KEYS, "from", "to", "radius", "rounding"},
    [HL_SHAPE_CAPSULE] = {COMMON_KEYS, "from", "to", "radius"},
    [HL_SHAPE_CONE] = {COMMON_KEYS, "from", "to", "radius", "end_radius"},
    [HL_SHAPE_TORUS] = {COMMON_KEYS, "radius", "tube_radius"},
    [HL_SHAPE_PLANE] = {COMMON_KEYS, "size", "thickness", "rounding"},
    [HL_SHAPE_ORBITAL] = {PLACEMENT_KEYS, "n", "l", "m", "radius"},
    [HL_SHAPE_GROUP] = {COMMON_KEYS, "shapes"},
};

/* The state of reading a list of shapes: the list, and the groups that contain the list, beginning with the
 * outermost group. */
typedef struct reading {
  hl_json_reader *reader;
  const json_t *groups;
  hl_shape_list *list;
  const char *open[HL_SHAPES_DEEPEST]; /* [depth]; the names of the groups that contain the list; null for a
                                        * group without a name */
  size_t depth;
  int seed; /* a number that is added to the seed of every hypertexture */
} reading;

static hl_status check_between(hl_json_reader *reader, const char *key, double value, double low, double high,
                               const char *mend) {
  if (value >= low && value <= high) return HL_OK;
  return hl_json_fail(reader, HL_ERROR_INPUT, key, "%.9g is out of range: %s", value, mend);
}

static hl_status check_positive(hl_json_reader *reader, const char *key, double value) {
  if (value > 0 && value <= HL_LIMIT_LENGTH) return HL_OK;
  return hl_json_fail(reader, HL_ERROR_INPUT, key, "%.9g is %s: give a length in world units, above 0", value,
                      value <= 0 ? "not above 0" : "out of range");
}

static hl_status read_length(hl_json_reader *reader, const json_t *value, const char *key, double *length) {
  hl_status status = hl_json_number(reader, value, key, length);
  return status == HL_OK ? check_positive(reader, key, *length) : status;
}

static hl_status read_point(hl_json_reader *reader, const json_t *value, const char *key, double point[3]) {
  hl_status status = hl_json_numbers(reader, value, key, 3, point);
  for (int a = 0; status == HL_OK && a < 3; a++)
    status = check_between(reader, key, point[a], -HL_LIMIT_LENGTH, HL_LIMIT_LENGTH,
                           "give coordinates between -1e15 and 1e15");
  return status;
}

static hl_status require(hl_json_reader *reader, const json_t *value, const char *key, const char *mend) {
  return json_object_get(value, key) != NULL
             ? HL_OK
             : hl_json_fail(reader, HL_ERROR_INPUT, key, "is missing: %s", mend);
}

static hl_status read_rotate(hl_json_reader *reader, const json_t *value, hl_shape *shape) {
  static const char *const keys[] = {"axis", "angle_deg", NULL};
  if (value == NULL) return HL_OK;
  size_t mark = hl_json_enter(reader, "rotate");
  hl_status status = hl_json_object(reader, value, keys);
  if (status == HL_OK) status = read_point(reader, value, "axis", shape->rotate_axis);
  if (status == HL_OK) status = hl_json_number(reader, value, "angle_deg", &shape->rotate_angle_deg);
  if (status == HL_OK)
    status = check_between(reader, "angle_deg", shape->rotate_angle_deg, -1e6, 1e6,
                           "give an angle in degrees");
  if (status == HL_OK && vec3_length(vec3_of(shape->rotate_axis)) < 1e-100)
    status = hl_json_fail(reader, HL_ERROR_INPUT, "axis", "has no length: give three numbers, not all 0");
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

static hl_status read_placement(hl_json_reader *reader, const json_t *value, hl_shape *shape) {
  hl_status status = read_point(reader, value, "position", shape->position);
  if (status == HL_OK) status = read_rotate(reader, json_object_get(value, "rotate"), shape);
  if (status == HL_OK) status = hl_json_number(reader, value, "scale", &shape->scale);
  return status == HL_OK ? check_between(reader, "scale", shape->scale, 1e-6, 1e6, "give a factor above 0")
                         : status;
}

static hl_status read_texture_numbers(hl_json_reader *reader, const json_t *value, hl_hypertexture *texture) {
  static const char share[] = "give a number above 0 and below 1, 0.5 changes nothing";
  hl_status status = hl_json_number(reader, value, "frequency", &texture->frequency);
  if (status == HL_OK)
    status = check_between(reader, "frequency", texture->frequency, 1e-9, 1e9,
                           "give cells per world unit, above 0");
  if (status == HL_OK) status = hl_json_integer(reader, value, "octaves", &texture->octaves);
  if (status == HL_OK)
    status = check_between(reader, "octaves", texture->octaves, 1, MOST_OCTAVES, "give 1 to 16");
  if (status == HL_OK) status = hl_json_number(reader, value, "bias", &texture->bias);
  if (status == HL_OK) status = check_between(reader, "bias", texture->bias, 1e-6, 1 - 1e-6, share);
  if (status == HL_OK) status = hl_json_number(reader, value, "gain", &texture->gain);
  if (status == HL_OK) status = check_between(reader, "gain", texture->gain, 1e-6, 1 - 1e-6, share);
  if (status == HL_OK) status = hl_json_number(reader, value, "amplitude", &texture->amplitude);
  if (status == HL_OK)
    status = check_between(reader, "amplitude", texture->amplitude, -HL_LIMIT_LENGTH, HL_LIMIT_LENGTH,
                           "give a length in world units");
  if (status == HL_OK) status = hl_json_number(reader, value, "soft", &texture->soft);
  return status == HL_OK ? check_between(reader, "soft", texture->soft, 0, HL_LIMIT_LENGTH,
                                         "give a length in world units, 0 for a sharp surface")
                         : status;
}

static hl_status read_texture(reading *r, const json_t *value, hl_hypertexture *texture) {
  static const char *const keys[] = {"pattern",   "frequency", "octaves", "bias", "gain",
                                     "amplitude", "soft",      "strands", "seed", NULL};
  if (value == NULL) return HL_OK;
  hl_json_reader *reader = r->reader;
  size_t mark = hl_json_enter(reader, "hypertexture");
  int pattern = HL_PATTERN_TURBULENCE, seed = 0;
  hl_status status = hl_json_object(reader, value, keys);
  if (status == HL_OK)
    status = hl_json_choice(reader, value, "pattern", pattern_names, HL_PATTERN_NOISE, &pattern);
  texture->pattern = (hl_shape_pattern)pattern;
  if (status == HL_OK) status = read_texture_numbers(reader, value, texture);
  if (status == HL_OK) status = hl_json_flag(reader, value, "strands", &texture->strands);
  if (status == HL_OK) status = hl_json_integer(reader, value, "seed", &seed);
  if (status != HL_OK) return status;
  hl_noise_begin(&texture->noise, (uint64_t)((int64_t)seed + r->seed));
  hl_json_leave(reader, mark);
  return HL_OK;
}

static hl_status read_box(hl_json_reader *reader, const json_t *value, hl_shape *shape) {
  bool plane = shape->type == HL_SHAPE_PLANE;
  size_t count = plane ? 2 : 3;
  hl_status status = require(reader, value, "size",
                             plane ? "give the plane's [x, y]" : "give the edges, [x, y, z]");
  if (status == HL_OK) status = hl_json_numbers(reader, value, "size", count, shape->size);
  for (size_t a = 0; status == HL_OK && a < count; a++)
    status = check_positive(reader, "size", shape->size[a]);
  if (status == HL_OK && plane)
    status = require(reader, value, "thickness", "give the slab's, below its upper face");
  if (status == HL_OK && plane) status = read_length(reader, value, "thickness", &shape->size[2]);
  return status;
}

static hl_status read_axis(hl_json_reader *reader, const json_t *value, hl_shape *shape) {
  hl_status status = require(reader, value, "from", "give one end of the axis");
  if (status == HL_OK) status = require(reader, value, "to", "give the other end of the axis");
  if (status == HL_OK) status = read_point(reader, value, "from", shape->from);
  if (status == HL_OK) status = read_point(reader, value, "to", shape->to);
  if (status != HL_OK) return status;
  vec3 axis = vec3_subtract(vec3_of(shape->to), vec3_of(shape->from));
  return vec3_length(axis) > 1e-9 * vec3_length(vec3_of(shape->from))
             ? HL_OK
             : hl_json_fail(reader, HL_ERROR_INPUT, "to", "is where from is: the axis needs a length");
}

static hl_status read_radius(hl_json_reader *reader, const json_t *value, hl_shape *shape) {
  hl_status status = require(reader, value, "radius", "give it in world units");
  if (status == HL_OK && shape->type != HL_SHAPE_CONE)
    return read_length(reader, value, "radius", &shape->radius);
  static const char mend[] = "give a radius, 0 for a tip";
  if (status == HL_OK) status = hl_json_number(reader, value, "radius", &shape->radius);
  if (status == HL_OK) status = check_between(reader, "radius", shape->radius, 0, HL_LIMIT_LENGTH, mend);
  if (status == HL_OK) status = hl_json_number(reader, value, "end_radius", &shape->end_radius);
  if (status == HL_OK)
    status = check_between(reader, "end_radius", shape->end_radius, 0, HL_LIMIT_LENGTH, mend);
  if (status == HL_OK && shape->radius == 0 && shape->end_radius == 0)
    status = hl_json_fail(reader, HL_ERROR_INPUT, "radius", "and end_radius are both 0: nothing is left");
  return status;
}

static hl_status read_rounding(hl_json_reader *reader, const json_t *value, hl_shape *shape) {
  hl_status status = hl_json_number(reader, value, "rounding", &shape->rounding);
  if (status != HL_OK) return status;
  double most = fmin(shape->size[0], fmin(shape->size[1], shape->size[2])) / 2;
  if (shape->type == HL_SHAPE_CYLINDER)
    most = fmin(shape->radius, vec3_length(vec3_subtract(vec3_of(shape->to), vec3_of(shape->from))) / 2);
  if (shape->rounding >= 0 && shape->rounding <= most) return HL_OK;
  return hl_json_fail(reader, HL_ERROR_INPUT, "rounding",
                      "%.9g is out of range: at most %.9g fits this shape", shape->rounding, most);
}

static hl_status read_quantum_number(hl_json_reader *reader, const json_t *value, const char *key, int low,
                                     int high, int *number) {
  hl_status status = require(reader, value, key, "an orbital has the quantum numbers n, l and m");
  if (status == HL_OK) status = hl_json_integer(reader, value, key, number);
  if (status != HL_OK || (*number >= low && *number <= high)) return status;
  return hl_json_fail(reader, HL_ERROR_INPUT, key, "%d is no quantum number here: give %d to %d", *number,
                      low, high);
}

static hl_status read_orbital(hl_json_reader *reader, const json_t *value, hl_shape *shape) {
  int *q = shape->quantum;
  hl_status status = read_quantum_number(reader, value, "n", 1, HIGHEST_N, &q[0]);
  if (status == HL_OK) status = read_quantum_number(reader, value, "l", 0, q[0] - 1, &q[1]);
  return status == HL_OK ? read_quantum_number(reader, value, "m", -q[1], q[1], &q[2]) : status;
}

static hl_status read_form(hl_json_reader *reader, const json_t *value, hl_shape *shape) {
  hl_status status = HL_OK;
  switch (shape->type) {
    case HL_SHAPE_BOX:
    case HL_SHAPE_PLANE: status = read_box(reader, value, shape); break;
    case HL_SHAPE_CYLINDER:
    case HL_SHAPE_CAPSULE:
    case HL_SHAPE_CONE: status = read_axis(reader, value, shape); break;
    case HL_SHAPE_TORUS:
      status = require(reader, value, "tube_radius", "give it in world units");
      if (status == HL_OK) status = read_length(reader, value, "tube_radius", &shape->tube_radius);
      break;
    case HL_SHAPE_ORBITAL: status = read_orbital(reader, value, shape); break;
    case HL_SHAPE_SPHERE:
    case HL_SHAPE_GROUP: break;
  }
  bool round = shape->type != HL_SHAPE_BOX && shape->type != HL_SHAPE_PLANE && shape->type != HL_SHAPE_GROUP;
  if (status == HL_OK && round) status = read_radius(reader, value, shape);
  return status == HL_OK ? read_rounding(reader, value, shape) : status;
}

static hl_status read_list(reading *r, const json_t *value);

/* Reads the shapes of a named group. The places in errors begin with "groups". */
static hl_status read_named_group(reading *r, const char *name) {
  hl_json_reader *reader = r->reader;
  const json_t *members = json_object_get(r->groups, name);
  char place[sizeof reader->place], mend[400] = "there are none: add \"groups\": { ... }";
  if (members == NULL) {
    const char *names[200] = {NULL}, *key;
    json_t *member;
    size_t count = 0;
    json_object_foreach((json_t *)r->groups, key, member) if (count < 199) names[count++] = key;
    if (count > 0) hl_suggest_name(name, names, mend, sizeof mend);
    return hl_json_fail(reader, HL_ERROR_INPUT, "name", "unknown group \"%.80s\": %s", name, mend);
  }
  for (size_t d = 0; d < r->depth; d++)
    if (r->open[d] != NULL && strcmp(r->open[d], name) == 0)
      return hl_json_fail(reader, HL_ERROR_INPUT, "name", "\"%.80s\" would hold itself: break the circle",
                          name);
  r->open[r->depth - 1] = name;
  memcpy(place, reader->place, sizeof place);
  snprintf(reader->place, sizeof reader->place, "/groups/%.200s", name);
  hl_status status = read_list(r, members);
  if (status == HL_OK) memcpy(reader->place, place, sizeof place);
  return status;
}

static hl_status read_members(reading *r, const json_t *value) {
  hl_json_reader *reader = r->reader;
  const json_t *members = json_object_get(value, "shapes");
  const char *name = NULL;
  hl_status status = hl_json_text(reader, value, "name", &name);
  if (status != HL_OK) return status;
  if (members == NULL && name == NULL)
    return hl_json_fail(reader, HL_ERROR_INPUT, "name",
                        "is missing: name a group of \"groups\", or give its shapes");
  if (r->depth == HL_SHAPES_DEEPEST)
    return hl_json_fail(reader, HL_ERROR_INPUT, NULL, "groups within groups are deeper than %d: flatten them",
                        HL_SHAPES_DEEPEST);
  r->open[r->depth++] = NULL;
  if (members == NULL) {
    status = read_named_group(r, name);
  } else {
    size_t mark = hl_json_enter(reader, "shapes");
    status = read_list(r, members);
    if (status == HL_OK) hl_json_leave(reader, mark);
  }
  r->depth--;
  return status;
}

static hl_status append(reading *r, hl_shape **shape) {
  hl_shape_list *list = r->list;
  if (list->count == HL_SHAPE_COUNT)
    return hl_json_fail(
        r->reader, HL_ERROR_INPUT, NULL,
        "is one shape too many: a volume holds %d, those of groups counted where they are placed",
        HL_SHAPE_COUNT);
  if (list->count == list->capacity) {
    size_t capacity = 2 * list->capacity + 16;
    hl_shape *grown = hl_reallocate(r->reader->context, list->shapes, capacity, sizeof *grown);
    if (grown == NULL) return hl_fail_memory(r->reader->error, capacity * sizeof *grown, "a list of shapes");
    list->shapes = grown;
    list->capacity = capacity;
  }
  *shape = &list->shapes[list->count++];
  hl_shape_defaults(*shape);
  return HL_OK;
}

static hl_status read_head(reading *r, const json_t *value, bool first, hl_shape *shape) {
  static const char *const all[] = {COMMON_KEYS,  "size",        "radius",    "from",     "to",
                                    "end_radius", "tube_radius", "thickness", "rounding", "n",
                                    "l",          "m",           "shapes",    NULL};
  hl_json_reader *reader = r->reader;
  int type = -1, operation = HL_SHAPE_ADD;
  hl_status status = hl_json_object(reader, value, all);
  if (status == HL_OK) status = require(reader, value, "type", "begin with the kind of shape");
  if (status == HL_OK) status = hl_json_choice(reader, value, "type", type_names, 0, &type);
  if (status == HL_OK) status = hl_json_object(reader, value, keys_of_type[type]);
  if (status == HL_OK) status = hl_json_choice(reader, value, "operation", operation_names, 0, &operation);
  if (status != HL_OK) return status;
  shape->type = (hl_shape_type)type;
  shape->operation = (hl_shape_operation)operation;
  if (first && operation != HL_SHAPE_ADD)
    return hl_json_fail(reader, HL_ERROR_INPUT, "operation",
                        "%s from nothing: put it after the shapes that it changes",
                        operation_names[operation]);
  if (type == HL_SHAPE_ORBITAL && r->depth > 0)
    return hl_json_fail(reader, HL_ERROR_INPUT, "type",
                        "an orbital in a group: put it into the volume's own list");
  if (r->depth == 0 && (type == HL_SHAPE_ORBITAL) != (r->list->shapes[0].type == HL_SHAPE_ORBITAL))
    return hl_json_fail(reader, HL_ERROR_INPUT, "type",
                        "orbitals and solids in one volume: their values mean different things, make two");
  return HL_OK;
}

static hl_status read_shape(reading *r, const json_t *value, bool first) {
  hl_json_reader *reader = r->reader;
  size_t index = r->list->count;
  const char *name = NULL;
  hl_shape *shape = NULL;
  hl_status status = append(r, &shape);
  if (status == HL_OK) status = read_head(r, value, first, shape);
  if (status == HL_OK) status = hl_json_text(reader, value, "name", &name);
  if (status == HL_OK) status = hl_json_number(reader, value, "blend", &shape->blend);
  if (status == HL_OK)
    status = check_between(reader, "blend", shape->blend, 0, HL_LIMIT_LENGTH,
                           "give a length in world units, or 0");
  if (status == HL_OK) status = read_placement(reader, value, shape);
  if (status == HL_OK) status = read_texture(r, json_object_get(value, "hypertexture"), &shape->texture);
  if (status == HL_OK) status = read_form(reader, value, shape);
  bool group = status == HL_OK && shape->type == HL_SHAPE_GROUP;
  if (group) status = read_members(r, value); /* reading members may move the list in memory */
  if (status == HL_OK) r->list->shapes[index].end = r->list->count;
  return status;
}

static hl_status read_list(reading *r, const json_t *value) {
  hl_status status = hl_json_array(r->reader, value, 1, HL_SHAPE_COUNT);
  for (size_t n = 0; status == HL_OK && n < json_array_size(value); n++) {
    size_t mark = hl_json_enter_index(r->reader, n);
    status = read_shape(r, json_array_get(value, n), n == 0);
    if (status == HL_OK) hl_json_leave(r->reader, mark);
  }
  return status;
}

hl_status hl_json_check_groups(hl_json_reader *reader, const json_t *groups) {
  const char *name;
  json_t *members;
  if (groups == NULL) return HL_OK;
  if (!json_is_object(groups)) {
    hl_json_enter(reader, "groups");
    return hl_json_fail(reader, HL_ERROR_INPUT, NULL, "is no object: give { \"name\": [ shapes ] }");
  }
  json_object_foreach((json_t *)groups, name, members) {
    hl_shape_list list = {0};
    reading r = {.reader = reader, .groups = groups, .list = &list, .depth = 1};
    hl_status status = read_named_group(&r, name);
    hl_release(reader->context, list.shapes);
    if (status != HL_OK) return status;
  }
  return HL_OK;
}

/* Chooses the edge of voxels. size: the wanted number of voxels along the longest side. If `size` is 0, the
 * edge is the value of the key "voxel_size"; if this key is absent, too, DEFAULT_SIZE is the wanted
 * number. */
static hl_status choose_voxel_size(hl_json_reader *reader, const json_t *object, const hl_shape_list *list,
                                   int size, double *voxel_size) {
  double extent = hl_shapes_extent(list), margin = HL_SHAPE_EDGE + 2 * HL_SHAPE_MARGIN;
  if (!(extent > 0 && extent <= 4 * HL_LIMIT_LENGTH))
    return hl_json_fail(reader, HL_ERROR_INPUT, "shapes",
                        "leave nothing: what is subtracted or intersected takes all");
  *voxel_size = extent / ((size > 0 ? size : DEFAULT_SIZE) - margin - 3);
  if (size > 0) return HL_OK;
  hl_status status = hl_json_number(reader, object, "voxel_size", voxel_size);
  return status == HL_OK ? check_positive(reader, "voxel_size", *voxel_size) : status;
}

static hl_status make_volume(hl_json_reader *reader, hl_shape_list *list, double voxel_size, int threads,
                             hl_volume **volume) {
  hl_shape_grid grid;
  hl_shapes_place(list, voxel_size);
  if (!hl_shapes_grid(list, voxel_size, &grid))
    return hl_json_fail(
        reader, HL_ERROR_INPUT, "voxel_size",
        "%.9g is too small for shapes %.9g long: at most %zu voxels are made, use a larger one", voxel_size,
        hl_shapes_extent(list), HL_SHAPE_VOXELS);
  char subject[600];
  snprintf(subject, sizeof subject, "%s: %s/shapes", reader->name, reader->place);
  return hl_shapes_sample(reader->context, list, &grid, threads, subject, volume, reader->error);
}

hl_status hl_json_read_shapes(hl_json_reader *reader, const json_t *object, const json_t *groups,
                              const hl_shapes_options *options, hl_volume **volume, double *voxel_size) {
  hl_shape_list list = {0};
  reading r = {.reader = reader, .groups = groups, .list = &list, .seed = options->seed};
  size_t mark = hl_json_enter(reader, "shapes");
  hl_status status = read_list(&r, json_object_get(object, "shapes"));
  if (status == HL_OK) {
    hl_json_leave(reader, mark);
    hl_shapes_place(&list, 1);
    status = choose_voxel_size(reader, object, &list, options->size, voxel_size);
  }
  if (status == HL_OK) status = make_volume(reader, &list, *voxel_size, options->threads, volume);
  hl_release(reader->context, list.shapes);
  return status;
}
