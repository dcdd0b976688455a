/* json/paraview_state.c - the two-dimensional transfer function of a ParaView state (.pvsm, XML).
 *
 * In: proxies of type TransferFunction2D with the properties Boxes (x, y, width, height, sRGB, alpha) and
 * Range, and those of representations that show volumes by one. Out: Halflight's boxes.
 *
 * ParaView's boxes are Gaussians that are cut off at their sides (vtkPVTransferFunction2DBox): at a place
 * where the Gaussian is g, opacity is alpha g. Halflight's weights are of extinction, which is
 * -log(1 - alpha g) = sum over k of (alpha g)^k / k: one box per term, as g^k is a Gaussian, too (derived).
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/file.h"
#include "core/memory.h"
#include "core/vector.h"
#include "json/paraview_state.h"
#include "scene/scene.h"
#include "volume/text.h"
#include "volume/volume.h"
#include "volume/xml.h"

enum { BOX_NUMBERS = 8, TERMS = 8, MOST_BOXES = HL_LIMIT_SHAPES / TERMS };
static const double deviation = 0.3; /* of a Gaussian, of the box's sides */
static const double most_alpha = 0.9999;

/* What is read of a state. */
typedef struct state {
  double boxes[MOST_BOXES * BOX_NUMBERS], range[4], unit;
  size_t box_numbers, range_numbers;
  size_t functions; /* with boxes */
  size_t users;     /* representations that show a volume by a function of two numbers */
} state;

/* What is read of the proxy that the tags are in. */
typedef struct proxy {
  bool is_function, uses, by_gradient;
  double unit, range[4];
  size_t box_numbers, range_numbers;
  char property[32];
} proxy;

static hl_status refuse(hl_error *error, const char *path, const char *what) {
  return hl_fail(error, HL_ERROR_INPUT, "%s: %s", path, what);
}

static hl_status take_element(const hl_stream *stream, double value, proxy *in, state *made,
                              hl_error *error) {
  if (strcmp(in->property, "UseTransfer2D") == 0) in->uses = value != 0;
  if (strcmp(in->property, "UseGradientForTransfer2D") == 0) in->by_gradient = value != 0;
  if (strcmp(in->property, "ScalarOpacityUnitDistance") == 0) in->unit = value;
  if (!in->is_function) return HL_OK;
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

static hl_status end_proxy(const hl_stream *stream, const proxy *in, state *made, hl_error *error) {
  if (in->box_numbers > 0) {
    memcpy(made->range, in->range, sizeof in->range);
    made->range_numbers = in->range_numbers;
  }
  if (!in->uses) return HL_OK;
  if (!in->by_gradient)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: a function of a second array is not supported: choose Gradient Magnitude in ParaView",
                   stream->path);
  made->users++;
  made->unit = in->unit;
  return HL_OK;
}

static hl_status read_tags(hl_stream *stream, hl_xml_tag *tag, state *made, hl_error *error) {
  proxy in = {.by_gradient = true, .unit = 1};
  bool ended = false;
  for (;;) {
    hl_status status = hl_xml_next_tag(stream, tag, &ended, error);
    if (status != HL_OK || ended) return status;
    const char *name = hl_xml_attribute(tag, "name"), *type = hl_xml_attribute(tag, "type"),
               *text = hl_xml_attribute(tag, "value");
    bool is_proxy = strcmp(tag->name, "Proxy") == 0;
    if (is_proxy && tag->is_start)
      in = (proxy){.is_function = type != NULL && strcmp(type, "TransferFunction2D") == 0,
                   .by_gradient = true,
                   .unit = 1};
    if (is_proxy && tag->is_end) {
      status = end_proxy(stream, &in, made, error);
      in = (proxy){.by_gradient = true, .unit = 1};
    }
    if (strcmp(tag->name, "Property") == 0)
      snprintf(in.property, sizeof in.property, "%.31s", tag->is_start && name != NULL ? name : "");
    double value;
    if (strcmp(tag->name, "Element") == 0 && tag->is_start && text != NULL &&
        hl_text_number(text, strlen(text), &value) && isfinite(value))
      status = take_element(stream, value, &in, made, error);
    if (status != HL_OK) return status;
  }
}

/* ---- boxes ---- */

/* How a number of the function's range becomes one of the volume's. */
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

/* Writes the boxes of one of ParaView's; returns how many. */
static size_t write_terms(const double numbers[BOX_NUMBERS], const fit *f, hl_function_box *to) {
  double alpha = fmin(fmax(numbers[7], 0), most_alpha), left = -log1p(-alpha), power = 1;
  size_t made = 0;
  for (int k = 1; k <= TERMS && left > 0; k++) {
    power *= alpha;
    double term = k == TERMS || power / k < 1e-4 ? left : power / k;
    left -= term;
    hl_function_box *box = &to[made++];
    *box = (hl_function_box){.opacity = -expm1(-term), .sigma = deviation / sqrt(k)};
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
  if (made->users == 0)
    return refuse(error, path,
                  "no volume uses its function of two numbers: switch on Use 2D Transfer Function");
  if (made->users > 1) return refuse(error, path, "several volumes use a function of two numbers: keep one");
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
  function->unit_distance = made->unit;
  return HL_OK;
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
  if (status == HL_OK && (tag == NULL || made == NULL))
    status = hl_fail_memory(error, sizeof *tag + sizeof *made, "a state of ParaView");
  if (status == HL_OK) status = read_tags(stream, tag, made, error);
  if (status == HL_OK) status = make_plane(context, path, made, volume, function, error);
  hl_stream_close(stream);
  hl_release(context, made);
  hl_release(context, tag);
  hl_release(context, bytes);
  return status;
}
