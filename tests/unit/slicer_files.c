/* tests/unit/slicer_files.c - 3D Slicer's files presets.xml, .vp and .vp.json: which preset and component is
 * read, how, and errors. */
#define _GNU_SOURCE
#include <stdio.h>
#include <unistd.h>

#include "scene/function/transfer_function.h"
#include "scene_parts.h"

static char xml[] = "/tmp/halflight-slicer-XXXXXX.xml", vp[] = "/tmp/halflight-slicer-XXXXXX.vp",
            json[] = "/tmp/halflight-slicer-XXXXXX.vp.json", nrrd[] = "/tmp/halflight-slicer-XXXXXX.nrrd";

static int make_files(void **state) {
  (void)state;
  int a = mkstemps(xml, 4), b = mkstemps(vp, 3), c = mkstemps(json, 8), d = mkstemps(nrrd, 5);
  return a < 0 || b < 0 || c < 0 || d < 0 ? -1 : close(a) + close(b) + close(c) + close(d);
}

static int remove_files(void **state) {
  (void)state;
  return unlink(xml) + unlink(vp) + unlink(json) + unlink(nrrd);
}

static void write_text(const char *path, const char *text) {
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
}

#define PROPERTY(name, gradient)                        \
  "<VolumeProperty name=\"" name                        \
  "\" interpolation=\"1\" shade=\"1\" ambient=\"0.1\" " \
  "gradientOpacity=\"" gradient                         \
  "\" scalarOpacity=\"6 -100 0 50 0.25 50 0.75\" "      \
  "colorTransfer=\"8 -100 1 0 0 100 0 0 1\"/>"

static void check_functions(const hl_transfer_function *f) {
  double color[3];
  assert_true(f->unit_distance == 1);
  assert_near(hl_transfer_function_opacity(f, -25), 0.125, 1e-12);
  assert_near(hl_transfer_function_opacity(f, 49.999999), 0.25, 1e-6);
  assert_near(hl_transfer_function_opacity(f, 50), 0.75, 1e-12);
  hl_transfer_function_color(f, 0, color);
  assert_near(color[0], hl_srgb_decode(0.5), 0.002);
  assert_near(color[2], hl_srgb_decode(0.5), 0.002);
}

static void a_preset_is_chosen_by_name(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_transfer_function f = {0};
  char named[80];
  write_text(xml, "<?xml version=\"1.0\"?>\n<MRML>" PROPERTY("CT &amp; A", "4 0 1 255 1")
                      PROPERTY("B", "4 0 0 10 1") "</MRML>");
  snprintf(named, sizeof named, "%s:CT & A", xml);
  assert_int_equal(hl_transfer_function_load(context, named, &f, NULL), HL_OK);
  check_functions(&f);
  assert_int_equal(f.gradient_opacity_count, 0);
  hl_transfer_function_release(context, &f);
  snprintf(named, sizeof named, "%s:B", xml);
  assert_int_equal(hl_transfer_function_load(context, named, &f, NULL), HL_OK);
  check_functions(&f);
  assert_near(hl_transfer_function_gradient_opacity(&f, 5), 0.5, 1e-12);
  hl_transfer_function_release(context, &f);
  write_text(xml, "<MRML>" PROPERTY("alone", "4 0 1 255 1") "</MRML>");
  assert_int_equal(hl_transfer_function_load(context, xml, &f, NULL), HL_OK);
  check_functions(&f);
  hl_transfer_function_release(context, &f);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void lines_are_read(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_transfer_function f = {0};
  write_text(vp, "1\n1\n0.9\n0.1\n0.2\n10\n6 -100 0 50 0.25 40 0.75\r\n4 0 0 10 1\n8 -100 1 0 0 100 0 0 1\n");
  assert_int_equal(hl_transfer_function_load(context, vp, &f, NULL), HL_OK);
  check_functions(&f); /* 40 comes after 50 and counts as 50 */
  assert_near(hl_transfer_function_gradient_opacity(&f, 5), 0.5, 1e-12);
  hl_transfer_function_release(context, &f);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* VTK's lengths of gradients are data units for each mean edge of a voxel, and end at a quarter of the
 * values' range. For edges of 1, 2 and 6 the mean is 3. For a range of 40 the factor is 0.5 at 10, and stays
 * so. */
static void gradients_are_fitted_to_the_volume(void **state) {
  (void)state;
  hl_context *context = make_context();
  float voxels[8] = {0, 40};
  hl_volume_description d = describe_voxels(2, 2, 2, HL_VOXEL_F32, voxels);
  const double edges[3] = {1, 2, 6};
  for (int a = 0; a < 3; a++) d.axis[a][a] = edges[a];
  hl_volume *volume = create_volume(context, &d);
  hl_transfer_function f = {0};
  write_text(xml, "<MRML>" PROPERTY("alone", "6 0 0 20 1 30 0.25") "</MRML>");
  assert_int_equal(hl_transfer_function_load_for(context, xml, volume, &f, NULL), HL_OK);
  assert_near(hl_transfer_function_gradient_opacity(&f, 2.0 / 3), 0.1, 1e-12);
  assert_near(hl_transfer_function_gradient_opacity(&f, 10.0 / 3), 0.5, 1e-12);
  assert_near(hl_transfer_function_gradient_opacity(&f, 100), 0.5, 1e-12);
  hl_transfer_function_release(context, &f);
  hl_volume_release(volume);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

#define COMPONENT(opacity)                                                         \
  "\"scalarOpacity\": {\"points\": [{\"x\": 0, \"y\": " opacity                    \
  "}]}, \"rgbTransferFunction\": {\"points\": [{\"x\": 0, \"color\": [1, " opacity \
  ", 0]}]}, "                                                                      \
  "\"gradientOpacity\": {\"points\": [{\"x\": 0, \"y\": " opacity "}]}"
#define COMPONENTS(members, first) \
  "{\"volumeProperties\": [{" members "\"components\": [{" first "}, {" COMPONENT("0.75") "}]}]}"

static hl_volume *load_component(hl_context *context, int component) {
  hl_volume_load_options options;
  hl_volume_load_options_defaults(&options);
  options.component = component;
  hl_volume *volume = NULL;
  assert_int_equal(hl_volume_load_with(context, nrrd, &options, &volume, NULL), HL_OK);
  return volume;
}

/* The functions of component 1 are 3/4, and those of component 0 a quarter. For voxels with one component,
 * component 0 is read. */
static void each_component_has_its_functions(void **state) {
  (void)state;
  hl_context *context = make_context();
  static const struct {
    const char *sizes;
    int component;
    double opacity;
  } cases[] = {{"dimension: 4\nsizes: 2 1 1 1\nkinds: vector domain domain domain", 0, 0.25},
               {"dimension: 4\nsizes: 2 1 1 1\nkinds: vector domain domain domain", 1, 0.75},
               {"dimension: 4\nsizes: 1 1 1 2\nkinds: domain domain domain list", 1, 0.25},
               {"dimension: 3\nsizes: 1 1 2", HL_COMPONENT_DEFAULT, 0.25}};
  write_text(json, COMPONENTS("\"independentComponents\": true, ", COMPONENT("0.25")));
  for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
    char text[200];
    double color[3];
    hl_transfer_function f = {0};
    snprintf(text, sizeof text, "NRRD0004\ntype: uint8\n%s\nencoding: ascii\n\n7 9\n", cases[n].sizes);
    write_text(nrrd, text);
    hl_volume *volume = load_component(context, cases[n].component);
    assert_int_equal(hl_transfer_function_load_for(context, json, volume, &f, NULL), HL_OK);
    hl_transfer_function_color(&f, 5, color);
    assert_near(hl_transfer_function_opacity(&f, 5), cases[n].opacity, 1e-12);
    assert_near(hl_transfer_function_gradient_opacity(&f, 5), cases[n].opacity, 1e-12);
    assert_near(color[1], hl_srgb_decode(cases[n].opacity), 1e-12);
    hl_transfer_function_release(context, &f);
    hl_volume_release(volume);
  }
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void components_that_cannot_be_shown_are_refused(void **state) {
  (void)state;
  static const struct {
    const char *text;
    int component; /* HL_COMPONENT_DEFAULT: no volume */
    const char *message;
  } faults[] = {
      {COMPONENTS("", COMPONENT("0.25")), HL_COMPONENT_DEFAULT,
       "/volumeProperties/0/components: has 2 entries: load the file for a volume, whose component tells "
       "which of "
       "them is meant"},
      {COMPONENTS("", COMPONENT("0.25")), HL_COMPONENT_MAGNITUDE,
       "/volumeProperties/0/components: has 2 entries, and none of them is for component magnitude of the "
       "volume: "
       "give a \"component\" from 0 to 1, and a volume for each that is to be shown"},
      {COMPONENTS("", COMPONENT("0.25")), 2,
       "/volumeProperties/0/components: has 2 entries, and none of them is for component 2 of the volume: "
       "give a \"component\" from 0 to 1, and a volume for each that is to be shown"},
      {COMPONENTS("\"independentComponents\": false, ", COMPONENT("0.25")), 0,
       "/volumeProperties/0/components: components that depend on each other (independentComponents is "
       "false) are "
       "not supported: set it to true, or show colours by \"component\": \"color\""},
      {COMPONENTS("", "\"componentWeight\": 0.5, " COMPONENT("0.25")), 1,
       "/volumeProperties/0/components/0/componentWeight: 0.5 is not supported: set it to 1, and lower the "
       "opacities"}};
  hl_context *context = make_context();
  write_text(nrrd,
             "NRRD0004\ntype: int16\ndimension: 4\nsizes: 3 1 1 1\nkinds: vector domain domain domain\n"
             "encoding: ascii\n\n7 9 8\n");
  for (size_t n = 0; n < sizeof faults / sizeof *faults; n++) {
    hl_transfer_function f = {0};
    hl_error error = {0};
    hl_volume *volume = faults[n].component == HL_COMPONENT_DEFAULT
                            ? NULL
                            : load_component(context, faults[n].component);
    write_text(json, faults[n].text);
    assert_true(hl_transfer_function_load_for(context, json, volume, &f, &error) != HL_OK);
    assert_non_null(strstr(error.message, faults[n].message));
    hl_volume_release(volume);
    assert_int_equal(hl_context_memory_held(context), 0);
  }
  hl_context_destroy(context);
}

static void refusals_name_the_place(void **state) {
  (void)state;
  static const struct {
    const char *text, *name, *message;
  } faults[] = {{"<MRML>" PROPERTY("CT-Bone", "4 0 1 255 1") PROPERTY("CT-Lung", "4 0 1 255 1") "</MRML>", "",
                 "holds several presets: name one, as FILE.xml:NAME: use one of CT-Bone, CT-Lung"},
                {"<MRML>" PROPERTY("CT-Bone", "4 0 1 255 1") "</MRML>", ":CT-Bon",
                 "there is no preset \"CT-Bon\": did you mean \"CT-Bone\"?"},
                {"<MRML></MRML>", ":CT", "holds no VolumeProperty: give a presets.xml of Slicer"},
                {"<VolumeProperty interpolation=\"0\"/>", "",
                 "/interpolation: of the nearest voxel is not supported: set it to 1, linear"},
                {"<VolumeProperty/>", "", "/scalarOpacity: is missing: give the function's points"},
                {"<VolumeProperty scalarOpacity=\"4 1 2\"/>", "",
                 "/scalarOpacity: is no list of points: give how many numbers follow, then 2 for each point"},
                {"<VolumeProperty scalarOpacity=\"2 1 nan\"/>", "",
                 "/scalarOpacity: number 2 is not finite: give finite numbers"}};
  hl_context *context = make_context();
  for (size_t n = 0; n < sizeof faults / sizeof *faults; n++) {
    hl_transfer_function f = {0};
    hl_error error = {0};
    char named[80];
    snprintf(named, sizeof named, "%s%s", xml, faults[n].name);
    write_text(xml, faults[n].text);
    assert_true(hl_transfer_function_load(context, named, &f, &error) != HL_OK);
    assert_non_null(strstr(error.message, faults[n].message));
    assert_int_equal(hl_context_memory_held(context), 0);
  }
  hl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_preset_is_chosen_by_name),
      cmocka_unit_test(lines_are_read),
      cmocka_unit_test(gradients_are_fitted_to_the_volume),
      cmocka_unit_test(each_component_has_its_functions),
      cmocka_unit_test(components_that_cannot_be_shown_are_refused),
      cmocka_unit_test(refusals_name_the_place),
  };
  return cmocka_run_group_tests(tests, make_files, remove_files);
}
