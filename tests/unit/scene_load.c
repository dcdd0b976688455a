/* tests/unit/scene_load.c - transfer functions from files of Halflight, ParaView and Slicer. The expected
 * numbers of ParaView and Slicer were computed with VTK 9.1. */
#define _GNU_SOURCE
#include <stdio.h>
#include <unistd.h>

#include "scene/function/transfer_function.h"
#include "scene_parts.h"

static char path[] = "/tmp/halflight-function-XXXXXX";

static int make_file(void **state) {
  (void)state;
  int descriptor = mkstemp(path);
  return descriptor < 0 ? -1 : close(descriptor);
}

static int remove_file(void **state) {
  (void)state;
  return unlink(path);
}

static hl_status load(hl_context *context, const char *text, hl_transfer_function *function,
                      hl_error *error) {
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
  return hl_transfer_function_load(context, path, function, error);
}

static void halflights_own(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_transfer_function f = {0};
  assert_int_equal(
      load(context,
           "{\"unit_distance\": 2.5, \"opacity\": [[1, 0], [3, 0.5]], \"color\": [[0, 1, 0.5, 0.25]]}", &f,
           NULL),
      HL_OK);
  assert_true(f.unit_distance == 2.5 && f.opacity_count == 2 && f.opacity[1].opacity == 0.5 &&
              f.color[0].color[2] == 0.25);
  hl_transfer_function_release(context, &f);
  assert_int_equal(
      load(context, "{\"opacity\": [[1, 0]], \"colormap\": \"viridis\", \"range\": [5, 6]}", &f, NULL),
      HL_OK);
  assert_true(f.color[0].value == 5 && f.unit_distance == 1);
  hl_transfer_function_release(context, &f);
  assert_int_equal(load(context, "{\"color\": [[1, 0, 0, 1]]}", &f, NULL), HL_OK);
  assert_true(f.opacity == NULL && f.color_count == 1);
  hl_transfer_function_release(context, &f);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void paraview_color_spaces(void **state) {
  (void)state;
  const struct {
    const char *name;
    double color[3][3];
  } spaces[] = {
      {"RGB", {{0.35, 0.227451, 0.601961}, {0.468627, 0.156863, 0.450981}, {0.646568, 0.05098, 0.22451}}},
      {"Lab",
       {{0.466813, 0.253075, 0.59516}, {0.580663, 0.202498, 0.443043}, {0.681838, 0.093696, 0.223382}}},
      {"Diverging",
       {{0.553318, 0.688635, 0.995188}, {0.865395, 0.86541, 0.865396}, {0.869565, 0.378584, 0.299679}}},
      {"HSV",
       {{0.376427, 0.174936, 0.741176}, {0.631629, 0.120176, 0.729411}, {0.711764, 0.04118, 0.332892}}},
      {"Step",
       {{0.705882, 0.0156863, 0.14902}, {0.705882, 0.0156863, 0.14902}, {0.705882, 0.0156863, 0.14902}}}};
  hl_context *context = make_context();
  for (size_t s = 0; s < sizeof spaces / sizeof *spaces; s++) {
    char text[400];
    snprintf(
        text, sizeof text,
        "[{\"ColorSpace\": \"%s\", \"Name\": \"x\", \"NanColor\": [1, 0, 0], \"RGBPoints\": [0, 0.231373, "
        "0.298039, 0.752941, 10, 0.705882, 0.0156863, 0.14902]}]",
        spaces[s].name);
    hl_transfer_function f = {0};
    assert_int_equal(load(context, text, &f, NULL), HL_OK);
    assert_int_equal(f.opacity_count, 0); /* the name that the file does not have */
    const double values[3] = {2.5, 5, 8.75};
    for (int n = 0; n < 3; n++) {
      double linear[3];
      hl_transfer_function_color(&f, values[n], linear);
      for (int c = 0; c < 3; c++) assert_near(linear[c], hl_srgb_decode(spaces[s].color[n][c]), 0.003);
    }
    hl_transfer_function_release(context, &f);
  }
  hl_context_destroy(context);
}

/* "Blue to Red Rainbow" of ParaView passes green. On the shorter arc of hues it would pass magenta. */
static void paraview_rainbow(void **state) {
  (void)state;
  hl_context *context = make_context();
  for (int by_arc = 0; by_arc < 2; by_arc++) {
    char text[200];
    snprintf(text, sizeof text,
             "[{\"ColorSpace\": \"HSV\", \"HSVWrap\": %d, \"RGBPoints\": [0, 0, 0, 1, 10, 1, 0, 0]}]",
             by_arc);
    hl_transfer_function f = {0};
    double linear[3];
    assert_int_equal(load(context, text, &f, NULL), HL_OK);
    hl_transfer_function_color(&f, 5, linear);
    for (int c = 0; c < 3; c++) assert_near(linear[c], by_arc ? c != 1 : c == 1, 0.003);
    hl_transfer_function_release(context, &f);
  }
  hl_context_destroy(context);
}

static void paraview_opacities_ease(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_transfer_function f = {0};
  assert_int_equal(
      load(context,
           "[{\"RGBPoints\": [0, 1, 1, 1], \"Points\": [0, 0, 0.3, 0.6, 10, 1, 0.5, 0, 20, 0.5, 0.5, 0]}]",
           &f, NULL),
      HL_OK);
  const double expected[][2] = {{0, 0},        {1, 9.2e-05},     {2.5, 0.087605}, {3, 0.5},
                                {5, 0.977105}, {8.75, 0.999999}, {10, 1},         {15, 0.75}};
  for (size_t n = 0; n < sizeof expected / sizeof *expected; n++)
    assert_near(hl_transfer_function_opacity(&f, expected[n][0]), expected[n][1], 0.04);
  assert_near(hl_transfer_function_opacity(&f, 15), 0.75, 1e-12);
  hl_transfer_function_release(context, &f);
  hl_context_destroy(context);
}

static void slicer_presets(void **state) {
  (void)state;
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  hl_transfer_function f = {0};
  const char *text =
      "{\"@schema\": \"volume-property-schema-v1.0.0.json#\", \"volumeProperties\": [{\"components\": [{"
      "\"scalarOpacityUnitDistance\": 0.5, \"scalarOpacity\": {\"type\": \"piecewiseLinearFunction\", "
      "\"points\": "
      "[{\"x\": -100, \"y\": 0}, {\"x\": 100, \"y\": 0.8, \"midpoint\": 0.5, \"sharpness\": 0}]}, "
      "\"rgbTransferFunction\": {\"points\": [{\"x\": 0, \"color\": [1, 0, 0]}, {\"x\": 10, \"color\": [0, "
      "0, 1]}]}, "
      "\"gradientOpacity\": {\"points\": [{\"x\": 0, \"y\": 0}, {\"x\": 9, \"y\": 1}]}}]}]}";
  assert_int_equal(load(context, text, &f, NULL), HL_OK);
  assert_int_equal(f.gradient_opacity_count, 2);
  assert_near(hl_transfer_function_gradient_opacity(&f, 4.5), 0.5, 1e-12);
  assert_true(f.unit_distance == 0.5);
  assert_near(hl_transfer_function_opacity(&f, 0), 0.4, 1e-12);
  double linear[3];
  hl_transfer_function_color(&f, 5, linear);
  assert_near(linear[0], hl_srgb_decode(0.5), 0.002);
  assert_near(linear[2], hl_srgb_decode(0.5), 0.002);
  hl_transfer_function_release(context, &f);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* The apex of a polygon without one is the mean of its vertices. */
static void functions_of_two_numbers(void **state) {
  (void)state;
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  hl_transfer_function f = {0};
  assert_int_equal(
      load(context,
           "{\"unit_distance\": 2, \"second\": {\"volume\": \"t2\"}, \"boxes\": [{\"value\": [1, 5], "
           "\"second\": [-3, 4], \"color\": [0.1, 0.2, 0.3], \"opacity\": 0.7, \"edge\": [1, 0.5]}], "
           "\"polygons\": [{\"vertices\": [[0, 0], [3, 0], [3, 6]], \"falloff\": 0.25}]}",
           &f, NULL),
      HL_OK);
  assert_int_equal(f.plane.second, HL_SECOND_VOLUME);
  assert_string_equal(f.plane.volume, "t2");
  assert_int_equal(f.plane.box_count, 1);
  const hl_function_box box = {{1, -3}, {5, 4}, {0.1, 0.2, 0.3}, 0.7, {1, 0.5}, 0};
  assert_memory_equal(f.plane.boxes, &box, sizeof box);
  assert_int_equal(f.plane.polygon_count, 1);
  const hl_function_polygon *polygon = &f.plane.polygons[0];
  assert_int_equal(polygon->vertex_count, 3);
  assert_true(polygon->apex[0] == 2 && polygon->apex[1] == 2 && polygon->falloff == 0.25);
  assert_true(polygon->color[1] == 1 && polygon->opacity == 0.5);
  hl_transfer_function_release(context, &f);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void refusals_name_the_place(void **state) {
  (void)state;
  const struct {
    const char *text, *message;
    hl_status status;
  } faults[] = {
      {"[]", "/: has 0 elements: give 1", HL_ERROR_INPUT},
      {"[{\"Name\": \"x\"}]", "/0/RGBPoints: is missing: a ParaView colour map needs it", HL_ERROR_INPUT},
      {"[{\"RGBPoints\": [0, 1, 1]}]", "/0/RGBPoints: has 3 elements: give 4 to 8192", HL_ERROR_INPUT},
      {"[{\"RGBPoints\": [0, 1, 1, 1, 2]}]", "/0/RGBPoints: has 5 numbers: give groups of four",
       HL_ERROR_INPUT},
      {"[{\"RGBPoints\": [0, 1, \"1\", 1]}]", "/0/RGBPoints/2: is no number: give one", HL_ERROR_INPUT},
      {"[{\"RGBPoints\": [5, 1, 1, 1, 4, 1, 1, 1]}]",
       "/0/RGBPoints: point 1: 4 comes after 5: sort the points by value", HL_ERROR_INPUT},
      {"[{\"RGBPoints\": [0, 1, 1, 1], \"ColorSpace\": \"RBG\"}]",
       "/0/ColorSpace: \"RBG\" is no known choice: did you mean \"RGB\"?", HL_ERROR_INPUT},
      {"[{\"RGBPoints\": [0, 1, 1, 1], \"UseLogScale\": 1}]",
       "/0/UseLogScale: logarithmic colour maps are not supported: save the map with a linear scale",
       HL_ERROR_UNSUPPORTED},
      {"[{\"RGBPoints\": [0, 1, 1, 1], \"Points\": [0, 1, 1.5, 0]}]",
       "/0/Points: point 0: midpoint 1.5 and sharpness 0: give numbers from 0 to 1, the midpoint inside",
       HL_ERROR_INPUT},
      {"{\"volumeProperties\": []}", "/volumeProperties: has 0 elements: give 1", HL_ERROR_INPUT},
      {"{\"volumeProperties\": [{}]}", "/volumeProperties/0/components: is null: give an array, [ ... ]",
       HL_ERROR_INPUT},
      {"{\"volumeProperties\": [{\"components\": [{}]}]}",
       "/volumeProperties/0/components/0/scalarOpacity/points: is missing: give the function's points",
       HL_ERROR_INPUT},
      {"{}", "/opacity: is missing: give [[value, opacity], ...]", HL_ERROR_INPUT},
      {"{\"opacity\": [[0, 2]]}", "/opacity/0/1: 2 is out of range: give an opacity from 0 to 1",
       HL_ERROR_INPUT},
      {"{\"boxes\": []}",
       "/boxes: needs a second number: give \"second\": \"gradient\" or {\"volume\": NAME}", HL_ERROR_INPUT},
      {"{\"second\": \"slope\"}", "/second: is an unknown name: give \"gradient\" or {\"volume\": NAME}",
       HL_ERROR_INPUT},
      {"{\"second\": \"gradient\"}", "/second: has no use: give boxes, polygons, an image or curves",
       HL_ERROR_INPUT},
      {"{\"second\": \"gradient\", \"curves\": {}}",
       "/curves/opacity: is missing: give [[value, opacity], ...]", HL_ERROR_INPUT},
      {"{\"second\": \"gradient\", \"curves\": {\"opacity\": [[2, 0], [1, 1]]}}",
       "/curves/opacity/1/0: is below the point before it: sort the points", HL_ERROR_INPUT},
      {"{\"second\": \"gradient\", \"curves\": {\"opacity\": [[0, 1]], \"color\": [[0, 1, 2, 0]]}}",
       "/curves/color/0/2: 2 is out of range: give linear RGB, each from 0 to 1", HL_ERROR_INPUT},
      {"{\"second\": \"gradient\", \"color\": [1, 1, 1]}",
       "/color: and second exclude each other: boxes, polygons, images and curves have opacities and colours "
       "of "
       "their "
       "own",
       HL_ERROR_INPUT},
      {"{\"second\": \"gradient\", \"boxes\": [{\"value\": [0, 1]}]}",
       "/boxes/0/second: is missing: give two numbers, [from, to]", HL_ERROR_INPUT},
      {"{\"second\": \"gradient\", \"polygons\": [{\"vertices\": [[0, 1], [1]]}]}",
       "/polygons/0/vertices: has 2 elements: give 3 to 1024", HL_ERROR_INPUT},
      {"3", "1:1: '[' or '{' expected near '3'", HL_ERROR_INPUT}};
  hl_context *context = make_context();
  for (size_t n = 0; n < sizeof faults / sizeof *faults; n++) {
    hl_transfer_function f = {0};
    hl_error error = {0};
    char expected[400];
    snprintf(expected, sizeof expected, faults[n].text[0] == '3' ? "%s:%s" : "%s: %s", path,
             faults[n].message);
    assert_int_equal(load(context, faults[n].text, &f, &error), faults[n].status);
    assert_string_equal(error.message, expected);
    assert_null(f.opacity);
    assert_int_equal(hl_context_memory_held(context), 0);
  }
  hl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(halflights_own),          cmocka_unit_test(paraview_color_spaces),
      cmocka_unit_test(paraview_rainbow),        cmocka_unit_test(paraview_opacities_ease),
      cmocka_unit_test(slicer_presets),          cmocka_unit_test(functions_of_two_numbers),
      cmocka_unit_test(refusals_name_the_place),
  };
  return cmocka_run_group_tests(tests, make_file, remove_file);
}
