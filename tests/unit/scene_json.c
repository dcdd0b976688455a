/* tests/unit/scene_json.c - scene files: all cases of tests/scenes/cases.json, syntax, writing and reading
 * again, hostile bytes. */
#define _GNU_SOURCE
#include <jansson.h>
#include <stdio.h>
#include <unistd.h>

#include <halflight/image.h>

#include "core/file.h"
#include "core/memory.h"
#include "scene_parts.h"

static char folder[] = "/tmp/halflight-scene-XXXXXX";

static void write_file(const char *name, const void *bytes, size_t length) {
  char path[300];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(bytes, 1, length, file), length);
  fclose(file);
}

/* A picture of 2 x 1 pixels: red, and white of half alpha. */
static int write_slide(const char *name) {
  char path[300];
  hl_context *context = make_context();
  hl_image *image = NULL;
  hl_image_write_options options;
  hl_image_write_options_defaults(&options);
  options.background_transparent = 1;
  options.png_depth = 16;
  const float pixels[8] = {1, 0, 0, 1, 0.5f, 0.5f, 0.5f, 0.5f};
  snprintf(path, sizeof path, "%s/%s", folder, name);
  assert_int_equal(hl_image_create(context, 2, 1, &image, NULL), HL_OK);
  memcpy(hl_image_pixels(image), pixels, sizeof pixels);
  hl_status status = hl_image_write(context, image, path, &options, NULL);
  hl_image_destroy(image);
  hl_context_destroy(context);
  return status == HL_OK ? 0 : -1;
}

static int make_folder(void **state) {
  (void)state;
  unsigned char cube[64];
  for (int n = 0; n < 64; n++) cube[n] = (unsigned char)(4 * n);
  if (mkdtemp(folder) == NULL) return -1;
  write_file("cube_4x4x4_uint8.raw", cube, sizeof cube);
  const char *function = "{\"opacity\": [[0, 0], [255, 1]], \"colormap\": \"hot\", \"range\": [0, 255]}";
  write_file("function.json", function, strlen(function));
  const char *colors = "[{\"RGBPoints\": [0, 1, 0, 0, 255, 0, 0, 1]}]";
  write_file("colors.json", colors, strlen(colors));
  return write_slide("slide.png");
}

static int remove_folder(void **state) {
  (void)state;
  const char *names[] = {"cube_4x4x4_uint8.raw", "function.json", "colors.json", "scene.json", "slide.png"};
  for (size_t n = 0; n < sizeof names / sizeof *names; n++) {
    char path[300];
    snprintf(path, sizeof path, "%s/%s", folder, names[n]);
    unlink(path);
  }
  return rmdir(folder);
}

static hl_status read_text(hl_context *context, const char *text, hl_scene **scene, hl_error *error) {
  return hl_scene_from_json(context, text, strlen(text), folder, "S", scene, error);
}

/* Returns whether two texts are equal, or equal up to a star at the end of `expected`. */
static void assert_message(const char *message, const char *expected) {
  size_t length = strlen(expected);
  if (length > 0 && expected[length - 1] == '*') assert_memory_equal(message, expected, length - 1);
  else assert_string_equal(message, expected);
}

/* Asserts that read(write(s)) == s, by the text, which holds each field to the last digit. */
static void assert_round_trip(hl_context *context, const hl_scene *scene) {
  char *text = NULL, *again = NULL;
  hl_scene *second = NULL;
  assert_int_equal(hl_scene_to_json(context, scene, &text, NULL), HL_OK);
  hl_error error = {0};
  if (hl_scene_from_json(context, text, strlen(text), NULL, "again", &second, &error) != HL_OK)
    fail_msg("%s", error.message);
  assert_int_equal(hl_scene_to_json(context, second, &again, NULL), HL_OK);
  assert_string_equal(text, again);
  const hl_scene_description *a = hl_scene_describe(scene), *b = hl_scene_describe(second);
  assert_memory_equal(&a->camera.position, &b->camera.position, sizeof a->camera.position);
  assert_memory_equal(&a->render, &b->render,
                      offsetof(hl_render_settings, compositing)); /* padding follows */
  assert_true(a->render.compositing == b->render.compositing && a->exposure == b->exposure &&
              a->tone == b->tone);
  for (size_t l = 0; l < a->light_count; l++)
    assert_memory_equal(a->lights[l].color, b->lights[l].color, sizeof a->lights[l].color);
  for (size_t v = 0; v < a->volume_count; v++) {
    const hl_transfer_function *f = &a->volumes[v].transfer_function, *g = &b->volumes[v].transfer_function;
    assert_int_equal(f->opacity_count, g->opacity_count);
    if (f->opacity_count > 0)
      assert_memory_equal(f->opacity, g->opacity, f->opacity_count * sizeof *f->opacity);
    if (f->color_count > 0) assert_memory_equal(f->color, g->color, f->color_count * sizeof *f->color);
  }
  hl_scene_release(second);
  hl_text_release(context, text);
  hl_text_release(context, again);
}

static void every_case(void **state) {
  (void)state;
  hl_context *context = make_context();
  json_error_t fault;
  json_t *cases = json_load_file(HALFLIGHT_SOURCE "/tests/scenes/cases.json", 0, &fault), *one;
  assert_non_null(cases);
  size_t index, refused = 0;
  json_array_foreach(cases, index, one) {
    char *text = json_dumps(json_object_get(one, "scene"), JSON_ENCODE_ANY);
    const char *name = json_string_value(json_object_get(one, "name"));
    bool accepted = json_is_true(json_object_get(one, "accepted"));
    hl_scene *scene = NULL;
    hl_error error = {0};
    hl_status status = read_text(context, text, &scene, &error);
    if ((status == HL_OK) != accepted)
      fail_msg("case \"%s\": status %d, %s", name, (int)status, error.message);
    if (accepted) {
      assert_round_trip(context, scene);
      hl_scene_release(scene);
    } else {
      refused++;
      assert_null(scene);
      assert_message(error.message, json_string_value(json_object_get(one, "message")));
      assert_null(strchr(error.message, '\n'));
    }
    assert_int_equal(hl_context_memory_held(context), 0);
    free(text);
  }
  assert_true(refused >= 80);
  json_decref(cases);
  hl_context_destroy(context);
}

/* Equal shapes are sampled once. A program can write its own text of shapes, with groups and everything else.
 */
static void shapes_are_made_once(void **state) {
  (void)state;
  static const char text[] =
      "{\"halflight\": 1, \"groups\": {\"ball\": [{\"type\": \"sphere\", \"radius\": 3}]}, \"volumes\": ["
      "{\"shapes\": [{\"type\": \"group\", \"name\": \"ball\"}], \"voxel_size\": 1},"
      "{\"shapes\": [{\"type\": \"group\", \"name\": \"ball\"}], \"voxel_size\": 1, \"transform\": "
      "{\"scale\": 2}},"
      "{\"shapes\": [{\"type\": \"group\", \"name\": \"ball\"}], \"voxel_size\": 2}]}";
  hl_context *context = make_context();
  hl_scene *scene = NULL, *changed = NULL;
  assert_int_equal(read_text(context, text, &scene, NULL), HL_OK);
  hl_scene_description d = *hl_scene_describe(scene);
  assert_ptr_equal(d.volumes[0].volume, d.volumes[1].volume);
  assert_ptr_not_equal(d.volumes[0].volume, d.volumes[2].volume);
  const hl_transfer_function *f = &d.volumes[2].transfer_function;
  assert_true(f->unit_distance == 2 && f->color_count == 0 && f->opacity_count == 2);
  assert_true(hl_transfer_function_opacity(f, 0.5) > 0.4 && hl_transfer_function_opacity(f, 0.3) == 0);

  hl_scene_volume volume = d.volumes[0];
  volume.shapes =
      "{\"groups\": {\"ball\": [{\"type\": \"sphere\", \"radius\": 3}]},"
      " \"shapes\": [{\"type\": \"group\", \"name\": \"ball\"}], \"voxel_size\": 1}";
  d.volumes = &volume;
  d.volume_count = 1;
  hl_error error = {0};
  assert_int_equal(hl_scene_create(context, &d, &changed, &error), HL_OK);
  assert_round_trip(context, changed);
  hl_scene_release(changed);
  volume.file = "ball.nrrd";
  assert_int_equal(hl_scene_create(context, &d, &changed, &error), HL_ERROR_INPUT);
  assert_string_equal(error.message,
                      "/volumes/0/shapes: and file exclude each other: the voxels came from one of them");
  volume.file = NULL, volume.shapes = "a ball";
  assert_int_equal(hl_scene_create(context, &d, &changed, &error), HL_OK);
  char *written = NULL;
  assert_int_equal(hl_scene_to_json(context, changed, &written, &error), HL_ERROR_ARGUMENT);
  assert_memory_equal(error.message, "/volumes/0/shapes: is no text", 29);
  hl_scene_release(changed);
  hl_scene_release(scene);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* The names that the schema lists are the library's, in its order. */
static void assert_enumeration(const json_t *schema, const char *key, const char *(*name_at)(size_t index)) {
  const json_t *function = json_object_get(json_object_get(schema, "$defs"), "transfer_function");
  const json_t *names = json_object_get(json_object_get(json_object_get(function, "properties"), key),
                                        "enum");
  size_t count = 0;
  for (; name_at(count) != NULL; count++)
    assert_string_equal(json_string_value(json_array_get(names, count)), name_at(count));
  assert_int_equal(json_array_size(names), count);
  assert_true(count >= 5);
}

static void the_schema_knows_all_names(void **state) {
  (void)state;
  json_t *schema = json_load_file(HALFLIGHT_SOURCE "/share/halflight.schema.json", JSON_REJECT_DUPLICATES,
                                  NULL);
  assert_non_null(schema);
  assert_enumeration(schema, "colormap", hl_colormap_name);
  assert_enumeration(schema, "preset", hl_preset_name);
  json_decref(schema);
}

static void syntax_errors_have_line_and_column(void **state) {
  (void)state;
  const struct {
    const char *text;
    int line, column;
    const char *message;
  } faults[] = {
      {"{\n  \"halflight\": 1,\n  // a comment\n}", 3, 3,
       "S:3:3: string or '}' expected near '/': JSON has no comments, remove them"},
      {"{\"halflight\": 1,}", 1, 17, "S:1:17: string or '}' expected near '}'"},
      {"{\"halflight\": 1", 1, 15, "S:1:15: '}' expected near end of file"},
      {"", 1, 0, "S:1:0: '[' or '{' expected near end of file"},
      {"{\"a\": 1,\n \"a\": 2}", 2, 4, "S:2:4: duplicate object key near '\"a\"': remove one of the two"},
      {"{\"a\": NaN}", 1, 9, "S:1:9: invalid token near 'NaN': JSON has no NaN, give a number"},
      {"{\"a\": 1e999}", 1, 11,
       "S:1:11: real number overflow near '1e999': give a number that a double holds"},
      {"{\"a\": 1} x", 1, 10, "S:1:10: end of file expected near 'x'"},
  };
  hl_context *context = make_context();
  for (size_t n = 0; n < sizeof faults / sizeof *faults; n++) {
    hl_error error = {0};
    hl_scene *scene = NULL;
    assert_int_equal(read_text(context, faults[n].text, &scene, &error), HL_ERROR_INPUT);
    assert_string_equal(error.message, faults[n].message);
    assert_int_equal(error.line, faults[n].line);
    assert_int_equal(error.column, faults[n].column);
  }
  char deep[20001];
  memset(deep, '[', sizeof deep - 1);
  deep[sizeof deep - 1] = 0;
  assert_int_equal(read_text(context, deep, &(hl_scene *){NULL}, NULL), HL_ERROR_INPUT);
  hl_context_destroy(context);
}

/* The defaults of fields that the file does not have. */
static void defaults_are_the_documented_ones(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_scene *scene = NULL;
  const char *text =
      "{\"halflight\": 1, \"volumes\": [{\"file\": \"cube_4x4x4_uint8.raw\"},"
      " {\"file\": \"cube_4x4x4_uint8.raw\", \"transfer_function\": {\"opacity\": [[0, 1]]}}]}";
  assert_int_equal(read_text(context, text, &scene, NULL), HL_OK);
  const hl_scene_description *d = hl_scene_describe(scene);
  assert_true(d->width == 512 && d->height == 512 && d->ambient[0] == 0.2 && d->background[0] == 0);
  assert_true(d->camera.type == HL_CAMERA_PERSPECTIVE && d->camera.fovy_deg == 30);
  hl_camera framed = d->camera;
  assert_int_equal(hl_scene_frame(d, &framed, NULL), HL_OK);
  assert_memory_equal(framed.position, d->camera.position, sizeof framed.position);
  hl_light key;
  hl_scene_key_light(&key);
  assert_int_equal(d->light_count, 1);
  assert_memory_equal(key.direction, d->lights[0].direction, sizeof key.direction);
  assert_true(d->lights[0].frame == HL_LIGHT_FRAME_CAMERA);
  assert_true(d->lights[0].angular_diameter_deg == key.angular_diameter_deg &&
              d->lights[0].shadows == HL_SHADOWS_DEFAULT);
  assert_true(d->render.shadows == HL_SHADOWS_SOFT && d->render.soft_method == HL_SOFT_CASCADE);
  assert_true(d->render.sheet_spacing == 0.5 && d->render.shadow_resolution == 0 &&
              d->render.light_samples == 4);
  /* the file is named twice, and loaded once */
  assert_ptr_equal(d->volumes[0].volume, d->volumes[1].volume);
  assert_true(d->volumes[0].transfer_function.opacity_count > 1); /* automatic */
  assert_true(d->volumes[1].transfer_function.opacity_count == 1 &&
              d->volumes[1].transfer_function.unit_distance == 1);
  assert_true(d->volumes[1].material.specular == 0.3 && d->volumes[1].visible == 1);
  hl_scene_release(scene);
  hl_context_destroy(context);
}

/* A colour map without opacities keeps the automatic ones. */
static void colors_alone_keep_opacity(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_scene *plain = NULL, *colored = NULL;
  const char *a = "{\"halflight\": 1, \"volumes\": [{\"file\": \"cube_4x4x4_uint8.raw\"}]}";
  const char *b =
      "{\"halflight\": 1, \"volumes\": [{\"file\": \"cube_4x4x4_uint8.raw\", "
      "\"transfer_function\": {\"file\": "
      "\"colors.json\"}}]}";
  assert_int_equal(read_text(context, a, &plain, NULL), HL_OK);
  assert_int_equal(read_text(context, b, &colored, NULL), HL_OK);
  const hl_transfer_function *f = &hl_scene_describe(plain)->volumes[0].transfer_function;
  const hl_transfer_function *g = &hl_scene_describe(colored)->volumes[0].transfer_function;
  assert_int_equal(f->opacity_count, g->opacity_count);
  assert_memory_equal(f->opacity, g->opacity, f->opacity_count * sizeof *f->opacity);
  assert_true(g->color[0].color[0] == 1 && g->color[0].color[2] == 0);
  hl_scene_release(plain);
  hl_scene_release(colored);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void files_are_relative_to_the_scene_file(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_scene *scene = NULL;
  char path[300], volume[300];
  const char *text = "{\"halflight\": 1, \"volumes\": [{\"file\": \"cube_4x4x4_uint8.raw\"}]}";
  write_file("scene.json", text, strlen(text));
  snprintf(path, sizeof path, "%s/scene.json", folder);
  snprintf(volume, sizeof volume, "%s/cube_4x4x4_uint8.raw", folder);
  assert_int_equal(hl_scene_load(context, path, &scene, NULL), HL_OK);
  assert_string_equal(hl_scene_describe(scene)->volumes[0].file, volume);
  assert_round_trip(context, scene);
  hl_scene_release(scene);
  hl_error error = {0};
  assert_int_equal(hl_scene_load(context, "/nowhere/scene.json", &scene, &error), HL_ERROR_IO);
  assert_null(scene);
  hl_context_destroy(context);
}

/* The image is decoded to linear light over black. The name under which it opens from here, and the screen,
 * are the same after writing and reading. */
static void textures_are_read_linear(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_scene *scene = NULL;
  char path[300];
  const char *text =
      "{\"halflight\": 1, \"volumes\": [{\"file\": \"cube_4x4x4_uint8.raw\"}], \"lights\": [{\"texture\": "
      "{\"file\": \"slide.png\", \"screen\": {\"center\": [0.1, 2, 9], \"right\": [3, 0, 1], \"up\": [0, "
      "2, -0.0]}}}]}";
  assert_int_equal(read_text(context, text, &scene, NULL), HL_OK);
  const hl_light_texture *texture = &hl_scene_describe(scene)->lights[0].texture;
  const float expected[6] = {1, 0, 0, 0.5f, 0.5f, 0.5f};
  assert_true(texture->width == 2 && texture->height == 1);
  for (int i = 0; i < 6; i++) assert_near(texture->pixels[i], expected[i], 1e-4f);
  assert_true(texture->screen_center[0] == 0.1 && texture->screen_right[2] == 1 &&
              texture->screen_up[1] == 2);
  snprintf(path, sizeof path, "%s/slide.png", folder);
  assert_string_equal(texture->file, path);
  assert_round_trip(context, scene);
  hl_scene_release(scene);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* The image on a light's own surface is read in the same way, and is the same after writing and reading. A
 * rect states its own up. */
static void emissions_are_read_linear(void **state) {
  (void)state;
  static const char *const lights[] = {
      "{\"angular_diameter_deg\": 9, \"emission\": {\"file\": \"slide.png\", \"up\": [0.1, 2, -0.0]}}",
      "{\"type\": \"rect\", \"emission\": {\"file\": \"slide.png\"}}"};
  hl_context *context = make_context();
  const float expected[6] = {1, 0, 0, 0.5f, 0.5f, 0.5f};
  for (int l = 0; l < 2; l++) {
    hl_scene *scene = NULL;
    char text[400], path[300];
    snprintf(text, sizeof text,
             "{\"halflight\": 1, \"volumes\": [{\"file\": \"cube_4x4x4_uint8.raw\"}], \"lights\": [%s]}",
             lights[l]);
    assert_int_equal(read_text(context, text, &scene, NULL), HL_OK);
    const hl_light_emission *emission = &hl_scene_describe(scene)->lights[0].emission;
    assert_true(emission->width == 2 && emission->height == 1);
    for (int i = 0; i < 6; i++) assert_near(emission->pixels[i], expected[i], 1e-4f);
    assert_true(emission->up[1] == (l == 0 ? 2 : 0) && emission->up[2] == (l == 0 ? 0 : 1));
    snprintf(path, sizeof path, "%s/slide.png", folder);
    assert_string_equal(emission->file, path);
    assert_round_trip(context, scene);
    hl_scene_release(scene);
  }
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void textures_from_memory_cannot_be_written(void **state) {
  (void)state;
  parts p;
  parts_make(&p);
  p.light.texture.file = NULL;
  p.scene_volume.file = "cube.nrrd";
  hl_scene *scene = NULL;
  char *text = NULL;
  hl_error error = {0};
  assert_int_equal(hl_scene_create(p.context, &p.description, &scene, NULL), HL_OK);
  assert_int_equal(hl_scene_to_json(p.context, scene, &text, &error), HL_ERROR_ARGUMENT);
  assert_string_equal(error.message,
                      "/lights/0/texture/file: the image came from memory: write it to a file and name "
                      "that in the scene");
  hl_scene_release(scene);
  parts_release(&p);
}

static void volumes_from_memory_cannot_be_written(void **state) {
  (void)state;
  parts p;
  parts_make(&p);
  hl_scene *scene = NULL;
  char *text = NULL;
  hl_error error = {0};
  assert_int_equal(hl_scene_create(p.context, &p.description, &scene, NULL), HL_OK);
  assert_int_equal(hl_scene_to_json(p.context, scene, &text, &error), HL_ERROR_ARGUMENT);
  assert_string_equal(
      error.message,
      "/volumes/0/file: the volume came from memory: write it to a file and name that in the scene");
  assert_null(text);
  hl_scene_release(scene);
  parts_release(&p);
}

/* Numbers that need all their digits, and names that need escapes. */
static void odd_values_survive(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_scene *scene = NULL;
  const char *text =
      "{\"halflight\": 1, \"ambient\": [0.1, 1e-300, 3.0000000000000004], \"camera\": {\"position\": [-0.0, "
      "-123456789012.5, 0.3333333333333333], \"target\": [0, 0, 0]}, \"volumes\": [{\"file\": "
      "\"cube_4x4x4_uint8.raw\", \"name\": \"a \\\"quoted\\\" \\\\ \\u0007 \\u00e9 name\"}]}";
  assert_int_equal(read_text(context, text, &scene, NULL), HL_OK);
  const hl_scene_description *d = hl_scene_describe(scene);
  assert_true(d->ambient[1] == 1e-300 && d->ambient[2] == 3.0000000000000004 &&
              signbit(d->camera.position[0]));
  assert_string_equal(d->volumes[0].name, "a \"quoted\" \\ \a \xc3\xa9 name");
  assert_round_trip(context, scene);
  hl_scene_release(scene);
  hl_context_destroy(context);
}

/* In the text of a good scene, each byte is changed, left out or doubled, and the text is cut there. */
static void damage(hl_context *context, const char *good, int *accepted, int *refused) {
  size_t size = strlen(good) + 1;
  char *text = malloc(size + 1);
  for (size_t at = 0; at + 1 < size; at++)
    for (int kind = 0; kind < 4; kind++) {
      size_t keep = kind == 1 ? at + 1 : at; /* the text after the damage */
      memcpy(text, good, at);
      if (kind == 0) text[at] = (char)(rand() % 256), memcpy(text + at + 1, good + at + 1, size - at - 1);
      else if (kind == 1) memcpy(text + at, good + keep, size - keep);
      else if (kind == 2) text[at] = good[at], memcpy(text + at + 1, good + at, size - at);
      else text[at] = 0;
      hl_error error = {0};
      hl_scene *scene = NULL;
      hl_status status = read_text(context, text, &scene, &error);
      if (status == HL_OK) (*accepted)++;
      else (*refused)++;
      assert_true((status == HL_OK) == (scene != NULL) && (status == HL_OK || error.message[0] != 0));
      hl_scene_release(scene);
      assert_int_equal(hl_context_memory_held(context), 0);
    }
  free(text);
}

/* Reads the text. The call answers, and nothing leaks. */
static void damaged_scenes_are_answered(void **state) {
  (void)state;
  static const char *const good[] = {
      "{\"halflight\": 1, \"camera\": {\"fovy_deg\": 40}, \"volumes\": [{\"file\": \"cube_4x4x4_uint8.raw\","
      " \"clip\": {\"min\": [0, 0, 0], \"max\": [2, 3, 2]}, \"transfer_function\": {\"opacity\": [[0, 0], "
      "[9, 0.5]], \"colormap\": \"hot\"}}], \"lights\": [{\"type\": \"point\", \"radius\": 0.5}]}",
      "{\"halflight\": 1, \"groups\": {\"a\": [{\"type\": \"box\", \"size\": [2, 3, 2]}]}, \"volumes\": [{"
      "\"shapes\": [{\"type\": \"group\", \"name\": \"a\", \"scale\": 2}, {\"type\": \"cone\", \"from\": [0, "
      "0, 1], "
      "\"to\": [0, 3, 0], \"radius\": 2, \"blend\": 1, \"operation\": \"add\", \"hypertexture\": {\"soft\": "
      "1}}], "
      "\"voxel_size\": 1, \"transfer_function\": {\"color\": [1, 0, 0], \"opacity\": 0.5}}]}"};
  hl_context *context = make_context();
  srand(3);
  for (int n = 0; n < 2; n++) {
    int accepted = 0, refused = 0;
    damage(context, good[n], &accepted, &refused);
    assert_true(accepted > 20 && refused > 500);
  }
  hl_context_destroy(context);
}

static hl_status read_like(hl_context *context, const char *text, const hl_scene *like, hl_scene **scene,
                           hl_error *error) {
  return hl_scene_from_json_like(context, text, strlen(text), folder, "changed", like, scene, error);
}

/* The files have been removed when the changed text is read, so that all files that it names must be the open
 * scene's own. */
static void changed_texts_open_no_file(void **state) {
  (void)state;
  const char *text =
      "{\"halflight\": 1, \"lights\": [{\"type\": \"directional\", \"direction\": [0, 0, 1], \"texture\": "
      "{\"file\": \"slide.png\", \"screen\": {\"center\": [0, 0, 9], \"right\": [1, 0, 0], \"up\": [0, 1, "
      "0]}}}], "
      "\"volumes\": [{\"file\": \"cube_4x4x4_uint8.raw\"}, {\"shapes\": [{\"type\": \"sphere\", \"radius\": "
      "4}], "
      "\"voxel_size\": 1}]}";
  const struct {
    const char *from, *to, *place;
  } refused[] = {
      {"cube_4x4x4", "cube_4x4x5", "/volumes/0/file"},
      {"\"cube_4x4x4_uint8.raw\"", "\"cube_4x4x4_uint8.raw\", \"spacing\": [1, 1, 2]", "/volumes/0/file"},
      {"\"radius\": 4", "\"radius\": 5", "/volumes/1/shapes"},
      {"slide.png", "other.png", "/lights/0/texture/file"},
      {"_uint8.raw\"", "_uint8.raw\", \"transfer_function\": {\"file\": \"function.json\"}",
       "/volumes/0/transfer_function/file"},
  };
  hl_context *context = make_context();
  hl_scene *open = NULL, *changed = NULL;
  assert_int_equal(read_like(context, text, NULL, &open, NULL), HL_OK);
  char written_before[300], moved[310];
  snprintf(written_before, sizeof written_before, "%s/slide.png", folder);
  snprintf(moved, sizeof moved, "%s-away", written_before);
  assert_int_equal(rename(written_before, moved), 0);
  char *json = NULL, *again = NULL;
  assert_int_equal(hl_scene_to_json(context, open, &json, NULL), HL_OK);
  assert_int_equal(read_like(context, json, open, &changed, NULL), HL_OK);
  assert_int_equal(hl_scene_to_json(context, changed, &again, NULL), HL_OK);
  assert_string_equal(json, again);
  const hl_scene_description *a = hl_scene_describe(open), *b = hl_scene_describe(changed);
  assert_ptr_equal(a->volumes[0].volume, b->volumes[0].volume);
  assert_ptr_equal(a->volumes[1].volume, b->volumes[1].volume);
  assert_memory_equal(a->lights[0].texture.pixels, b->lights[0].texture.pixels, 6 * sizeof(float));
  for (size_t r = 0; r < sizeof refused / sizeof *refused; r++) {
    char hostile[1000];
    hl_scene *none = NULL;
    hl_error error = {0};
    const char *at = strstr(text, refused[r].from);
    snprintf(hostile, sizeof hostile, "%.*s%s%s", (int)(at - text), text, refused[r].to,
             at + strlen(refused[r].from));
    assert_int_equal(read_like(context, hostile, open, &none, &error), HL_ERROR_INPUT);
    assert_null(none);
    assert_non_null(strstr(error.message, refused[r].place));
  }
  assert_int_equal(rename(moved, written_before), 0);
  hl_text_release(context, json);
  hl_text_release(context, again);
  hl_scene_release(changed);
  hl_scene_release(open);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* a page writes 4.0 as 4 */
static void whole_numbers_have_one_spelling(void **state) {
  (void)state;
  const char *real =
                 "{\"halflight\": 1, \"volumes\": [{\"shapes\": [{\"type\": \"sphere\", \"radius\": 4.0, "
                 "\"position\": [-0.0, 1.5, 2e1]}], \"voxel_size\": 1}]}",
             *whole =
                 "{\"halflight\": 1, \"volumes\": [{\"shapes\": [{\"type\": \"sphere\", \"radius\": 4, "
                 "\"position\": [0, 1.5, 20]}], \"voxel_size\": 1}]}";
  hl_context *context = make_context();
  hl_scene *open = NULL, *changed = NULL;
  assert_int_equal(read_like(context, real, NULL, &open, NULL), HL_OK);
  assert_int_equal(read_like(context, whole, open, &changed, NULL), HL_OK);
  assert_ptr_equal(hl_scene_describe(open)->volumes[0].volume, hl_scene_describe(changed)->volumes[0].volume);
  hl_scene_release(changed);
  hl_scene_release(open);
  hl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_case),
      cmocka_unit_test(the_schema_knows_all_names),
      cmocka_unit_test(shapes_are_made_once),
      cmocka_unit_test(syntax_errors_have_line_and_column),
      cmocka_unit_test(defaults_are_the_documented_ones),
      cmocka_unit_test(colors_alone_keep_opacity),
      cmocka_unit_test(files_are_relative_to_the_scene_file),
      cmocka_unit_test(textures_are_read_linear),
      cmocka_unit_test(emissions_are_read_linear),
      cmocka_unit_test(textures_from_memory_cannot_be_written),
      cmocka_unit_test(volumes_from_memory_cannot_be_written),
      cmocka_unit_test(odd_values_survive),
      cmocka_unit_test(changed_texts_open_no_file),
      cmocka_unit_test(whole_numbers_have_one_spelling),
      cmocka_unit_test(damaged_scenes_are_answered),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
