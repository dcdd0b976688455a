/* json/foreign/paraview_state.c - reads the transfer function of the volume that a ParaView state (.pvsm,
 * XML) shows.
 *
 * In: proxies of representations that show volumes, and the proxies that these representations name: a lookup
 * table and a function of opacity, or a TransferFunction2D with the properties Boxes (x, y, width, height,
 * sRGB, alpha) and Range. Out: colours and opacities, or Halflight's boxes.
 *
 * A tag Proxy with a group defines a proxy. A tag Proxy without a group stands within a property, and names
 * another proxy by its id. Lookup tables and functions of opacity are kept as JSON objects whose keys are the
 * names of their properties. ParaView uses the same names in its colour maps, which are JSON.
 *
 * ParaView's boxes are Gaussians that are cut off at their sides (vtkPVTransferFunction2DBox). At a place at
 * which the Gaussian has the value g, the opacity is alpha g. Halflight's boxes multiply extinction instead.
 * The extinction is -log(1 - alpha g) = sum over k of (alpha g)^k / k. Each term of this sum becomes a box,
 * because g^k is a Gaussian, too (derived). */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "core/vector.h"
#include "elementary/elementary.h"
#include "json/foreign/paraview_state.h"
#include "scene/scene.h"
#include "volume/io/text.h"
#include "volume/io/xml.h"
#include "volume/volume.h"

enum { BOX_NUMBERS = 8, TERMS = 8, MOST_BOXES = HL_LIMIT_SHAPES / TERMS };
static const double deviation = 0.3; /* standard deviation of a Gaussian, as a fraction of the box's sides */
static const double most_alpha = 0.9999;

enum { ID_BYTES = 24 };

/* The properties of a representation that shows a volume. */
typedef struct shown_volume {
  bool by_plane;      /* whether the representation uses a function of two numbers */
  bool by_gradient;   /* whether the second of the two numbers is the length of the gradient */
  bool other_opacity; /* whether the opacity depends on another array than the colours */
  double unit;
  char colors[ID_BYTES], opacities[ID_BYTES]; /* ids of the lookup table and of the opacity function */
} shown_volume;

/* The parts of a state that have been read so far. */
typedef struct state {
  double boxes[MOST_BOXES * BOX_NUMBERS], range[4];
  size_t box_numbers, range_numbers;
  size_t functions;       /* number of proxies TransferFunction2D with boxes in the state */
  size_t planes, volumes; /* number of volumes that are shown by a function of two numbers, and by a function
                           * of one number */
  shown_volume shown;     /* the last representation that shows a volume */
  json_t *kept;           /* owned; the lookup tables and opacity functions by their ids; each is an object
                           * that has an array of numbers for each property */
} state;

/* The parts of the current proxy that have been read so far. The current proxy is the one whose tag encloses
 * the tags that are being read. */
typedef struct proxy {
  bool is_function; /* whether the proxy is a function of two numbers */
  /* is_representation: whether the proxy shows a volume; is_other: whether the proxy is a representation of
   * another kind, which shows no volume */
  bool is_representation, is_other;
  bool is_named_volume, is_visible;
  shown_volume shown;
  json_t *kept; /* borrowed from the state; collects the proxy's properties; null if the properties are not
                 * needed */
  double range[4];
  size_t box_numbers, range_numbers;
  char property[32];
  /* whether the current tags list the values that a property may have, and not the value that it has */
  bool in_domain;
} proxy;

static hl_status refuse(hl_error *error, const char *path, const char *what) {
  return hl_fail(error, HL_ERROR_INPUT, "%s: %s", path, what);
}

static bool is_one_of(const char *name, const char *const names[]) {
  while (*names != NULL && strcmp(name, *names) != 0) names++;
  return *names != NULL;
}

/* Stores a number of the current property, if colour maps have this property. */
static hl_status keep(proxy *in, double value, hl_error *error) {
  static const char *const names[] = {
      "RGBPoints",   "Points",        "ColorSpace",         "HSVWrap",
      "UseLogScale", "IndexedLookup", "UseBelowRangeColor", "UseAboveRangeColor",
      NULL};
  if (!is_one_of(in->property, names)) return HL_OK;
  json_t *list = json_object_get(in->kept, in->property);
  if (list == NULL) {
    list = json_array();
    if (json_object_set_new(in->kept, in->property, list) != 0) list = NULL;
  }
  return list != NULL && json_array_append_new(list, json_real(value)) == 0
             ? HL_OK
             : hl_fail_memory(error, sizeof(double), "a transfer function");
}

static hl_status take_box_number(const hl_stream *stream, double value, proxy *in, state *made,
                                 hl_error *error) {
  if (strcmp(in->property, "Range") == 0 && in->range_numbers < 4) in->range[in->range_numbers++] = value;
  if (strcmp(in->property, "Boxes") != 0) return HL_OK;
  if (in->box_numbers++ == 0 && made->functions++ > 0)
    return refuse(error, stream->path, "holds boxes of several functions: keep one of them");
  if (made->box_numbers == MOST_BOXES * BOX_NUMBERS)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: holds more than %d boxes: merge some", stream->path,
                   MOST_BOXES);
  made->boxes[made->box_numbers++] = value;
  return HL_OK;
}

static void take_setting(double value, proxy *in) {
  if (strcmp(in->property, "Visibility") == 0) in->is_visible = value != 0;
  if (strcmp(in->property, "UseTransfer2D") == 0) in->shown.by_plane = value != 0;
  if (strcmp(in->property, "UseGradientForTransfer2D") == 0) in->shown.by_gradient = value != 0;
  if (strcmp(in->property, "UseSeparateOpacityArray") == 0) in->shown.other_opacity = value != 0;
  if (strcmp(in->property, "ScalarOpacityUnitDistance") == 0) in->shown.unit = value;
}

static hl_status take_element(const hl_stream *stream, const char *text, proxy *in, state *made,
                              hl_error *error) {
  double value;
  if (in->is_representation && strcmp(in->property, "Representation") == 0) {
    in->is_named_volume = strcmp(text, "Volume") == 0;
    in->is_other = !in->is_named_volume;
  }
  if (!hl_text_number(text, strlen(text), &value) || !isfinite(value)) return HL_OK;
  if (in->is_representation) take_setting(value, in);
  if (in->is_function) return take_box_number(stream, value, in, made, error);
  return in->kept != NULL ? keep(in, value, error) : HL_OK;
}

/* Stores the id of the proxy that the current property names. */
static void take_name(const char *id, proxy *in) {
  if (strcmp(in->property, "LookupTable") == 0) snprintf(in->shown.colors, ID_BYTES, "%.23s", id);
  if (strcmp(in->property, "ScalarOpacityFunction") == 0)
    snprintf(in->shown.opacities, ID_BYTES, "%.23s", id);
}

static hl_status begin_proxy(const hl_xml_tag *tag, proxy *in, state *made, hl_error *error) {
  static const char *const kept[] = {"PVLookupTable", "PiecewiseFunction", NULL};
  const char *type = hl_xml_attribute(tag, "type"), *id = hl_xml_attribute(tag, "id");
  *in = (proxy){.is_visible = true, .shown = {.by_gradient = true, .unit = 1}};
  if (type == NULL) return HL_OK;
  in->is_representation = strcmp(hl_xml_attribute(tag, "group"), "representations") == 0;
  in->is_function = strcmp(type, "TransferFunction2D") == 0;
  if (id == NULL || !is_one_of(type, kept)) return HL_OK;
  in->kept = json_object();
  return json_object_set_new_nocheck(made->kept, id, in->kept) == 0
             ? HL_OK
             : hl_fail_memory(error, sizeof(proxy), "a transfer function");
}

static void end_proxy(proxy *in, state *made) {
  if (in->box_numbers > 0) {
    memcpy(made->range, in->range, sizeof in->range);
    made->range_numbers = in->range_numbers;
  }
  bool shows = in->is_representation && in->is_visible && !in->is_other;
  if (shows && (in->shown.by_plane || in->is_named_volume)) {
    if (in->shown.by_plane) made->planes++;
    else made->volumes++;
    made->shown = in->shown;
  }
  *in = (proxy){0};
}

static hl_status take_tag(const hl_stream *stream, const hl_xml_tag *tag, proxy *in, state *made,
                          hl_error *error) {
  const char *name = hl_xml_attribute(tag, "name"), *text = hl_xml_attribute(tag, "value");
  bool named = strcmp(tag->name, "Proxy") == 0 && hl_xml_attribute(tag, "group") == NULL;
  hl_status status = HL_OK;
  if (strcmp(tag->name, "Domain") == 0) in->in_domain = !tag->is_end;
  if (in->in_domain) return HL_OK;
  if (strcmp(tag->name, "Property") == 0)
    snprintf(in->property, sizeof in->property, "%.31s", tag->is_start && name != NULL ? name : "");
  if (strcmp(tag->name, "Element") == 0 && tag->is_start && text != NULL)
    return take_element(stream, text, in, made, error);
  if (named && tag->is_start && text != NULL) take_name(text, in);
  if (strcmp(tag->name, "Proxy") == 0 && tag->is_start && !named) status = begin_proxy(tag, in, made, error);
  if (strcmp(tag->name, "Proxy") == 0 && tag->is_end && !(named && tag->is_start)) end_proxy(in, made);
  return status;
}

static hl_status read_tags(hl_stream *stream, hl_xml_tag *tag, state *made, hl_error *error) {
  proxy in = {0};
  bool ended = false;
  for (;;) {
    hl_status status = hl_xml_next_tag(stream, tag, &ended, error);
    if (status == HL_OK && !ended) status = take_tag(stream, tag, &in, made, error);
    if (status != HL_OK || ended) return status;
  }
}

/* ---- colours and opacities ---- */

/* The first number of a property among the kept properties of a proxy; 0 if the property has no number. */
static double number_of(const json_t *kept, const char *property) {
  return json_number_value(json_array_get(json_object_get(kept, property), 0));
}

/* Makes a colour map of a lookup table and a function of opacity, in the form in which ParaView writes colour
 * maps. The result is owned by the caller; null if memory is short. */
static json_t *map_of(const json_t *colors, const json_t *opacities) {
  static const char *const spaces[] = {"RGB", "HSV", "Lab", "Diverging", "Lab/CIEDE2000", "Step"};
  double space = number_of(colors, "ColorSpace");
  bool logarithmic = number_of(colors, "UseLogScale") != 0 || number_of(opacities, "UseLogScale") != 0;
  return json_pack("{s:s, s:f, s:i, s:O, s:O}", "ColorSpace",
                   space >= 0 && space <= 5 ? spaces[(int)space] : "unknown", "HSVWrap",
                   number_of(colors, "HSVWrap"), "UseLogScale", (int)logarithmic, "RGBPoints",
                   json_object_get(colors, "RGBPoints"), "Points", json_object_get(opacities, "Points"));
}

static hl_status make_map(hl_context *context, const char *path, const state *made,
                          hl_transfer_function *function, hl_error *error) {
  const json_t *colors = json_object_get(made->kept, made->shown.colors),
               *opacities = json_object_get(made->kept, made->shown.opacities);
  if (made->shown.other_opacity)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: opacity by another array is not supported: switch off Use Separate Opacity Array",
                   path);
  if (json_object_get(colors, "RGBPoints") == NULL || json_object_get(opacities, "Points") == NULL)
    return refuse(error, path, "the colours or opacities of its volume are missing: save the state anew");
  if (number_of(colors, "IndexedLookup") != 0)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: colours of categories are not supported: switch off Interpret Values As Categories",
                   path);
  if (number_of(colors, "UseBelowRangeColor") != 0 || number_of(colors, "UseAboveRangeColor") != 0)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: colours below and above the range are not supported: switch them off", path);
  json_t *map = map_of(colors, opacities);
  if (map == NULL) return hl_fail_memory(error, sizeof *made, "a transfer function");
  hl_json_reader reader = {.context = context, .name = path, .error = error};
  hl_status status = hl_json_read_paraview_map(&reader, map, function);
  json_decref(map);
  function->unit_distance = made->shown.unit;
  return status;
}

/* ---- boxes ---- */

/* Two linear maps from ParaView's Range: to data values, and to lengths of gradients. */
typedef struct fit {
  double from[2], factor[2], to[2];
} fit;

static fit fit_to(const state *made, const hl_volume *volume) {
  fit f = {{0, 0}, {1, 1}, {0, 0}};
  if (volume == NULL) return f;
  double edges = 0, width = volume->maximum - volume->minimum;
  for (int axis = 0; axis < 3; axis++)
    edges += vec3_length(mat3_column(volume->index_to_world.linear, axis)) / 3;
  f.from[0] = made->range[0], f.from[1] = made->range[2];
  f.factor[0] = width / (made->range[1] - made->range[0]);
  f.factor[1] = width / 4 / edges / (made->range[3] - made->range[2]);
  f.to[0] = volume->minimum;
  return f;
}

/* Writes Halflight's boxes that together stand for one box of ParaView's. Returns the number of Halflight's
 * boxes. */
static size_t write_terms(const double numbers[BOX_NUMBERS], const fit *f, hl_function_box *to) {
  double alpha = fmin(fmax(numbers[7], 0), most_alpha), left = -hl_log1p(-alpha), power = 1;
  size_t made = 0;
  for (int k = 1; k <= TERMS && left > 0; k++) {
    power *= alpha;
    double term = k == TERMS || power / k < 1e-4 ? left : power / k;
    left -= term;
    hl_function_box *box = &to[made++];
    *box = (hl_function_box){.opacity = -hl_expm1(-term), .sigma = deviation / sqrt(k)};
    for (int a = 0; a < 2; a++) {
      box->low[a] = (numbers[a] - f->from[a]) * f->factor[a] + f->to[a];
      box->high[a] = box->low[a] + numbers[2 + a] * f->factor[a];
    }
    for (int c = 0; c < 3; c++) box->color[c] = hl_srgb_decode(fmin(fmax(numbers[4 + c], 0), 1));
    if (power / k < 1e-4) break;
  }
  return made;
}

static hl_status make_plane(hl_context *context, const char *path, const state *made, const hl_volume *volume,
                            hl_transfer_function *function, hl_error *error) {
  if (made->functions == 0) return refuse(error, path, "holds no TransferFunction2D with boxes: add one");
  if (!made->shown.by_gradient)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: a function of a second array is not supported: choose Gradient Magnitude in ParaView",
                   path);
  if (made->box_numbers % BOX_NUMBERS != 0 || made->range_numbers != 4 ||
      !(made->range[1] > made->range[0] && made->range[3] > made->range[2]))
    return refuse(error, path, "the function's Boxes or Range are incomplete: save the state anew");
  size_t count = made->box_numbers / BOX_NUMBERS;
  hl_function_box *boxes = hl_allocate(context, count * TERMS, sizeof *boxes);
  if (boxes == NULL) return hl_fail_memory(error, count * TERMS * sizeof *boxes, "a transfer function");
  const fit f = fit_to(made, volume);
  hl_function_plane *plane = &function->plane;
  plane->second = HL_SECOND_GRADIENT;
  plane->boxes = boxes;
  for (size_t b = 0; b < count; b++)
    plane->box_count += write_terms(&made->boxes[b * BOX_NUMBERS], &f, &boxes[plane->box_count]);
  function->unit_distance = made->shown.unit;
  return HL_OK;
}

/* Makes the transfer function of the volume that the state shows. Fails unless the state shows exactly one
 * volume. */
static hl_status make_function(hl_context *context, const char *path, const state *made,
                               const hl_volume *volume, hl_transfer_function *function, hl_error *error) {
  if (made->planes + made->volumes == 0 && made->functions > 0)
    return refuse(error, path,
                  "no volume uses its function of two numbers: switch on Use 2D Transfer Function");
  if (made->planes + made->volumes == 0)
    return refuse(error, path, "shows no volume: choose the representation Volume in ParaView");
  if (made->planes > 1) return refuse(error, path, "several volumes use a function of two numbers: keep one");
  if (made->planes + made->volumes > 1) return refuse(error, path, "shows several volumes: hide all but one");
  return made->planes > 0 ? make_plane(context, path, made, volume, function, error)
                          : make_map(context, path, made, function, error);
}

hl_status hl_paraview_read_state(hl_context *context, const char *path, const hl_volume *volume,
                                 hl_transfer_function *function, hl_error *error) {
  unsigned char *bytes = NULL;
  size_t size = 0;
  hl_stream *stream = NULL;
  hl_status status = hl_file_read(context, path, HL_JSON_LIMIT, &bytes, &size, error);
  if (status == HL_OK) status = hl_stream_open_memory(context, path, bytes, size, &stream, error);
  hl_xml_tag *tag = hl_allocate(context, 1, sizeof *tag);
  state *made = hl_allocate_zeroed(context, 1, sizeof *made);
  if (made != NULL) made->kept = json_object();
  if (status == HL_OK && (tag == NULL || made == NULL || made->kept == NULL))
    status = hl_fail_memory(error, sizeof *tag + sizeof *made, "a state of ParaView");
  if (status == HL_OK) status = read_tags(stream, tag, made, error);
  if (status == HL_OK) status = make_function(context, path, made, volume, function, error);
  hl_stream_close(stream);
  if (made != NULL) json_decref(made->kept);
  hl_release(context, made);
  hl_release(context, tag);
  hl_release(context, bytes);
  return status;
}
