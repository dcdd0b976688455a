/* tests/unit/scene_labels.c - labels from segmentations and tables, in scenes, and written and read again. */
#define _GNU_SOURCE
#include <stdio.h>
#include <unistd.h>

#include "scene/function/transfer_function.h"
#include "scene/label/label_table.h"
#include "scene/scene.h"
#include "scene_parts.h"

static char path[] = "/tmp/halflight-labels-XXXXXX.seg.nrrd";

static int make_file(void **state) {
  (void)state;
  int descriptor = mkstemps(path, 9);
  return descriptor < 0 ? -1 : close(descriptor);
}

static int remove_file(void **state) {
  (void)state;
  return unlink(path);
}

/* A 3 x 2 x 2 segmentation with labels 1 and 4; the second layer, if there is one, has 1 everywhere. */
static void write_segmentation(int layers) {
  static const unsigned char voxels[12] = {0, 1, 1, 0, 4, 4, 0, 0, 0, 1, 1, 4};
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  fprintf(file,
          "NRRD0004\ntype: uchar\ndimension: %d\nsizes: %s3 2 2\nkinds: %sdomain domain domain\n"
          "encoding: raw\nSegment0_Name:=left lung\nSegment0_Color:=1 0.5 0\nSegment0_LabelValue:=1\n"
          "Segment0_Layer:=0\nSegment1_Name:=heart\nSegment1_LabelValue:=4\nSegment2_Name:=all\n"
          "Segment2_LabelValue:=1\nSegment2_Layer:=1\nSegment9999999_Name:=no\nSegmentation_x:=y\n\n",
          layers == 2 ? 4 : 3, layers == 2 ? "2 " : "", layers == 2 ? "list " : "");
  for (int i = 0; i < 12; i++) {
    fputc(voxels[i], file);
    if (layers == 2) fputc(1, file);
  }
  fclose(file);
}

/* The factor of a mask is the one of its nearest voxel's label; labels that the mask does not name, and
 * places outside of its map, have the rest's. */
static void masks_have_factors(void **state) {
  (void)state;
  hl_context *context = make_context();
  write_segmentation(1);
  hl_volume *map = NULL;
  assert_int_equal(hl_volume_load(context, path, &map, NULL), HL_OK);
  hl_label labels[2] = {{.value = 1, .visible = false, .opacity = 1},
                        {.value = 4, .visible = true, .opacity = 0.5}};
  const hl_mask mask = {.volume = map, .labels = labels, .label_count = 2, .rest = 0.25};
  assert_true(hl_mask_factor(&mask, (vec3){1.4, -0.4, 0.4}) == 0);   /* 1, which is hidden */
  assert_true(hl_mask_factor(&mask, (vec3){0.6, 1.2, -0.2}) == 0.5); /* 4 */
  assert_true(hl_mask_factor(&mask, (vec3){0.4, 0.4, 0}) == 0.25);   /* 0, which no label has */
  assert_true(hl_mask_factor(&mask, (vec3){1, 0, -0.6}) == 0.25);    /* below the map */
  assert_true(hl_mask_factor(&mask, (vec3){2.6, 1, 1}) == 0.25);     /* beside the map */
  hl_volume_release(map);
  hl_context_destroy(context);
}

static void segmentations_name_their_labels(void **state) {
  (void)state;
  hl_context *context = make_context();
  for (int layer = 0; layer < 2; layer++) {
    write_segmentation(layer + 1);
    hl_volume_load_options options;
    hl_volume_load_options_defaults(&options);
    options.component = layer;
    hl_volume *map = NULL;
    hl_label *labels = NULL;
    size_t count = 0;
    assert_int_equal(hl_volume_load_with(context, path, &options, &map, NULL), HL_OK);
    assert_int_equal(hl_labels_of_volume(context, map, NULL, &labels, &count, NULL), HL_OK);
    assert_int_equal(count, layer == 0 ? 2 : 1);
    assert_string_equal(labels[0].name, layer == 0 ? "left lung" : "all");
    if (layer == 0) {
      assert_true(labels[0].color[1] == hl_srgb_decode(0.5) && labels[0].color[2] == 0);
      assert_true(labels[1].value == 4 && labels[1].visible && labels[1].opacity == 1);
      assert_string_equal(labels[1].name, "heart");
    }
    hl_labels_release(context, labels);
    hl_volume_release(map);
  }
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void tables_of_other_programs(void **state) {
  (void)state;
  hl_context *context = make_context();
  static const char snap[] =
      "################\n# ITK-SnAP\n    4  255    0  128   1  1  1    \"Heart\"\n"
      "    1    0  255  0  1  1 1 \"Left-Lung\"\n";
  const char *texts[] = {
      "# FreeSurfer\n4   Heart  255 0 128  0\n1 Left-Lung 0 255 0 0\n\n",
      snap,
      "number,name,red,green,blue\n1,Left-Lung,0,255,0\r\n4,\"Heart\",1.0,0,0.50196\n",
      "1 Wrong 1 2 3\n4 Heart 255 0 128\n1 Left-Lung 0 255 0",
      "\xef\xbb\xbf"
      "1,Left-Lung,0,255,0\n4,Heart,255,0,128",
      "# CR alone\r4 Heart 255 0 128\r1 Left-Lung 0 255 0\r",
      "index\tname\tabbreviation\tcolor\n1\tLeft-Lung\tLL\t#00ff00\n4\tHeart\tH\t#FF0080\n",
      "\xef\xbb\xbfname\tcolor\tindex\r\nHeart\t#ff0080\t4\r\nLeft-Lung\tn/a\t1\r\n"};
  for (size_t n = 0; n < sizeof texts / sizeof *texts; n++) {
    hl_label_list list;
    assert_int_equal(hl_label_table_parse(context, texts[n], strlen(texts[n]), "t", &list, NULL), HL_OK);
    assert_int_equal(list.count, 2);
    assert_string_equal(list.labels[0].name, "Left-Lung");
    assert_string_equal(list.labels[1].name, "Heart");
    assert_true(list.labels[1].value == 4 && list.labels[1].color[0] == 1);
    assert_true(fabs(list.labels[1].color[2] - hl_srgb_decode(128 / 255.0)) < 1e-4);
    hl_label_list_release(context, &list);
  }
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* If commas, semicolons or tabs separate words, names may have blanks. */
static void names_of_tables_have_blanks(void **state) {
  (void)state;
  static const char *const lines[] = {"4,left lung,255,0,128",       "4, left lung , 255, 0, 128",
                                      "4;left lung;255;0;128",       "4\tleft lung\t255\t0\t128\t0",
                                      "4\t\tleft lung\t255\t0\t128", "4 \"left lung\" 255 0 128"};
  hl_context *context = make_context();
  for (size_t n = 0; n < sizeof lines / sizeof *lines; n++) {
    hl_label_list list;
    assert_int_equal(hl_label_table_parse(context, lines[n], strlen(lines[n]), "t", &list, NULL), HL_OK);
    assert_int_equal(list.count, 1);
    assert_string_equal(list.labels[0].name, "left lung");
    assert_true(list.labels[0].value == 4 && list.labels[0].color[0] == 1 && list.labels[0].color[1] == 0);
    hl_label_list_release(context, &list);
  }
  hl_context_destroy(context);
}

static void tables_keep_great_numbers_and_blanks(void **state) {
  (void)state;
  hl_context *context = make_context();
  static const char text[] =
      "index\tname\tcolor\n614454277\tarea 1: left\t#010203\n"
      "9223372036854775807\tgreat, last\tn/a\n0\t\t#000000\n\n";
  hl_label_list list;
  assert_int_equal(hl_label_table_parse(context, text, strlen(text), "t", &list, NULL), HL_OK);
  assert_int_equal(list.count, 3);
  assert_string_equal(list.labels[1].name, "area 1: left");
  assert_true(list.labels[1].value == 614454277 && list.labels[2].value == INT64_MAX);
  assert_true(list.labels[1].color[2] == hl_srgb_decode(3 / 255.0));
  assert_string_equal(list.labels[2].name, "great, last");
  hl_label_list_release(context, &list);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void wrong_tables_are_refused(void **state) {
  (void)state;
  hl_context *context = make_context();
  const struct {
    const char *text, *message;
  } cases[] = {{"", "t: no label is in it: give lines of number, name, red, green, blue"},
               {"1 a 1 2 3\nword", "t: line 2: begins with no number"},
               {"1.5 a 1 2 3", "t: line 1: its number is no label's"},
               {"1 a 300 0 0", "t: line 1: is no label"}};
  for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
    hl_label_list list;
    hl_error error = {0};
    assert_int_equal(hl_label_table_parse(context, cases[n].text, strlen(cases[n].text), "t", &list, &error),
                     HL_ERROR_INPUT);
    assert_true(strncmp(error.message, cases[n].message, strlen(cases[n].message)) == 0);
  }
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void scenes_keep_their_labels(void **state) {
  (void)state;
  hl_context *context = make_context();
  write_segmentation(1);
  char text[600];
  snprintf(text, sizeof text,
           "{\"halflight\": 1, \"volumes\": [{\"file\": \"%s\", \"labels\": [{\"name\": \"heart\", "
           "\"opacity\": 0.5}, "
           "{\"value\": 1, \"color\": [0.25, 0, 1], \"visible\": false}]}]}",
           path);
  char *written[2] = {text, NULL};
  for (int pass = 0; pass < 2; pass++) {
    hl_scene *scene = NULL;
    hl_error error = {0};
    if (hl_scene_from_json(context, written[pass], strlen(written[pass]), NULL, "s", &scene, &error) != HL_OK)
      fail_msg("%s", error.message);
    const hl_scene_volume *volume = &hl_scene_describe(scene)->volumes[0];
    assert_int_equal(volume->label_count, 2);
    assert_true(volume->labels[0].value == 1 && !volume->labels[0].visible &&
                volume->labels[0].color[0] == 0.25);
    assert_true(volume->labels[1].value == 4 && volume->labels[1].opacity == 0.5);
    assert_string_equal(volume->labels[1].name, "heart");
    assert_true(hl_transfer_function_opacity(&volume->transfer_function, 4) == 0.5 &&
                hl_transfer_function_opacity(&volume->transfer_function, 1) == 0);
    if (pass == 0) assert_int_equal(hl_scene_to_json(context, scene, &written[1], NULL), HL_OK);
    hl_scene_release(scene);
  }
  hl_text_release(context, written[1]);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* The number of a label in a scene's text must be whole, however it is written. */
static void numbers_of_labels_are_whole(void **state) {
  (void)state;
  hl_context *context = make_context();
  write_segmentation(1);
  static const char *const numbers[] = {"4.0", "9223372036854775807", "1.5", "1e300", "\"4\""};
  for (int n = 0; n < 5; n++) {
    hl_scene *scene = NULL;
    hl_error error = {0};
    char text[300];
    snprintf(text, sizeof text,
             "{\"halflight\": 1, \"volumes\": [{\"file\": \"%s\", \"labels\": [{\"value\": %s}, {\"value\": "
             "1}]}]}",
             path, numbers[n]);
    hl_status status = hl_scene_from_json(context, text, strlen(text), NULL, "s", &scene, &error);
    assert_int_equal(status, n < 2 ? HL_OK : HL_ERROR_INPUT);
    if (n == 0) assert_true(hl_scene_describe(scene)->volumes[0].labels[1].value == 4);
    if (n == 1) assert_true(hl_scene_describe(scene)->volumes[0].labels[1].value == INT64_MAX);
    if (n >= 2) assert_non_null(strstr(error.message, "/volumes/0/labels/0/value: is no whole number"));
    hl_scene_release(scene);
  }
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* The settings of a look have their ranges also if the volume is drawn by its labels. */
static void looks_of_labels_have_their_ranges(void **state) {
  (void)state;
  hl_context *context = make_context();
  write_segmentation(1);
  static const char *const settings[] = {
      "\"material\": {\"diffuse\": -0.7}", "\"material\": {\"emission\": -1}",
      "\"material\": {\"shininess\": 1e6}", "\"attenuation_color\": [-1, 1, 1]",
      "\"scattering\": {\"anisotropy\": 1}"};
  static const char *const places[] = {"material/diffuse", "material/emission", "material/shininess",
                                       "attenuation_color", "scattering/anisotropy"};
  for (int n = 0; n < 5; n++) {
    hl_scene *scene = NULL;
    hl_error error = {0};
    char text[300];
    snprintf(text, sizeof text, "{\"halflight\": 1, \"volumes\": [{\"file\": \"%s\", \"labels\": true, %s}]}",
             path, settings[n]);
    assert_int_equal(hl_scene_from_json(context, text, strlen(text), NULL, "s", &scene, &error),
                     HL_ERROR_INPUT);
    assert_non_null(strstr(error.message, places[n]));
  }
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* A scene makes the fields of its labels once, for its first frame. Describing the scene needs no fields. */
static void fields_are_made_for_the_first_frame(void **state) {
  (void)state;
  hl_context *context = make_context();
  write_segmentation(1);
  hl_scene *scene = NULL;
  const drawn_scene *first, *second;
  char text[200];
  snprintf(text, sizeof text,
           "{\"halflight\": 1, \"volumes\": [{\"file\": \"%s\", \"labels\": [{\"value\": 4}]}]}", path);
  assert_int_equal(hl_scene_from_json(context, text, strlen(text), NULL, "s", &scene, NULL), HL_OK);
  hl_volume *map = hl_scene_describe(scene)->volumes[0].volume;
  assert_false(scene->drawn->made);
  assert_null(map->shelf); /* the place where fields of the map are kept */
  assert_int_equal(hl_scene_draw(scene, &first, NULL), HL_OK);
  assert_non_null(map->shelf);
  assert_ptr_not_equal(first->description.volumes[0].volume, map);
  const hl_volume *field = first->description.volumes[0].volume;
  assert_int_equal(hl_scene_draw(scene, &second, NULL), HL_OK);
  assert_ptr_equal(second->description.volumes[0].volume, field);
  hl_scene_release(scene);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* Faults that only the fields show are reported by the first frame, and by the next one again. */
static void labels_without_voxels_are_told(void **state) {
  (void)state;
  hl_context *context = make_context();
  write_segmentation(1);
  hl_scene *scene = NULL;
  char text[200];
  snprintf(text, sizeof text,
           "{\"halflight\": 1, \"volumes\": [{\"file\": \"%s\", \"labels\": [{\"value\": 9}]}]}", path);
  assert_int_equal(hl_scene_from_json(context, text, strlen(text), NULL, "s", &scene, NULL), HL_OK);
  for (int n = 0; n < 2; n++) {
    const drawn_scene *drawn;
    hl_error error = {0};
    assert_int_equal(hl_scene_draw(scene, &drawn, &error), HL_ERROR_INPUT);
    assert_string_equal(error.message, "/volumes: no label that is visible has voxels: show others");
  }
  hl_scene_release(scene);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(masks_have_factors),
      cmocka_unit_test(segmentations_name_their_labels),
      cmocka_unit_test(tables_of_other_programs),
      cmocka_unit_test(tables_keep_great_numbers_and_blanks),
      cmocka_unit_test(names_of_tables_have_blanks),
      cmocka_unit_test(wrong_tables_are_refused),
      cmocka_unit_test(scenes_keep_their_labels),
      cmocka_unit_test(numbers_of_labels_are_whole),
      cmocka_unit_test(looks_of_labels_have_their_ranges),
      cmocka_unit_test(fields_are_made_for_the_first_frame),
      cmocka_unit_test(labels_without_voxels_are_told),
  };
  return cmocka_run_group_tests(tests, make_file, remove_file);
}
