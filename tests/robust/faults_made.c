/* tests/robust/faults_made.c - every allocation fails in turn, and every question whether to stop is answered
 * with yes, in the calls that faults.c does not test: volumes of particles, cells and adaptive grids, and
 * things that are made of volumes: meshes, previews, planes, files, scenes, figures, plans and frames. usage:
 * faults_made [NAME] */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "faulty.h"
#include "volume_files.h"

static char folder[FOLDER_BYTES];

static int open_folder(void **state) {
  (void)state;
  make_folder(folder);
  return 0;
}

static int close_folder(void **state) {
  (void)state;
  remove_folder(folder);
  return 0;
}

/* ---- volumes of particles, cells and adaptive grids ---- */

enum { PARTICLES = 300 };

static void scatter_particles(double positions[PARTICLES][3], float values[PARTICLES]) {
  unsigned state = 7;
  for (int n = 0; n < PARTICLES; n++)
    for (int a = 0; a < 3; a++) {
      state = state * 1103515245u + 12345u;
      positions[n][a] = (double)(state >> 16 & 1023) / 1024;
      values[n] = (float)positions[n][a];
    }
}

/* Volumes of particles that are far apart or periodic, so that some volumes are arrays and some are bricks.
 */
static hl_status particles(hl_context *context, int kind, hl_volume **volume, hl_error *error) {
  double positions[PARTICLES][3];
  float values[PARTICLES];
  hl_particles_description d;
  scatter_particles(positions, values);
  hl_particles_description_defaults(&d);
  d.count = PARTICLES;
  d.positions = positions;
  d.values = values;
  d.side = kind == 2 ? 48 : 24;
  d.quantity = (hl_particles_quantity)kind;
  if (kind == 1)
    for (int a = 0; a < 3; a++) d.period[a] = 1;
  if (kind == 2) positions[0][0] = 9; /* this particle is far away, so that most of the box is empty */
  return hl_volume_from_particles(context, &d, volume, error);
}

static hl_status make_particles(faulty *f, void *data, hl_error *error) {
  hl_status status = HL_OK;
  (void)data;
  for (int kind = 0; status == HL_OK && kind < 3; kind++) {
    hl_volume *volume = NULL;
    status = particles(f->context, kind, &volume, error);
    hl_volume_release(volume);
  }
  return status;
}

static hl_status find_smoothing(faulty *f, void *data, hl_error *error) {
  double positions[PARTICLES][3];
  float values[PARTICLES], lengths[PARTICLES];
  hl_particles_description d;
  (void)data;
  scatter_particles(positions, values);
  hl_particles_description_defaults(&d);
  d.count = PARTICLES;
  d.positions = positions;
  return hl_particles_find_smoothing(f->context, &d, lengths, error);
}

/* A cube of hexahedra. Half of them are long. */
static hl_status cells(hl_context *context, bool of_cells, hl_volume **volume, hl_error *error) {
  enum { POINTS = 5, CELLS = POINTS - 1 };
  double points[POINTS * POINTS * POINTS][3], values[POINTS * POINTS * POINTS];
  unsigned char types[CELLS * CELLS * CELLS];
  int64_t ends[CELLS * CELLS * CELLS], corners[8 * CELLS * CELLS * CELLS];
  size_t corner = 0, cell = 0;
  for (int n = 0; n < POINTS * POINTS * POINTS; n++) {
    points[n][0] = n % POINTS * (n % POINTS > 2 ? 2 : 1);
    points[n][1] = n / POINTS % POINTS;
    points[n][2] = n / (POINTS * POINTS);
    values[n] = points[n][0] * points[n][1] + points[n][2];
  }
  for (int k = 0; k < CELLS; k++)
    for (int j = 0; j < CELLS; j++)
      for (int i = 0; i < CELLS; i++) {
        static const int steps[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                        {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
        for (int c = 0; c < 8; c++)
          corners[corner++] = ((k + steps[c][2]) * POINTS + j + steps[c][1]) * POINTS + i + steps[c][0];
        types[cell] = 12;
        ends[cell++] = (int64_t)corner;
      }
  hl_cells_description d;
  hl_cells_description_defaults(&d);
  d.points = points[0];
  d.point_count = POINTS * POINTS * POINTS;
  d.types = types;
  d.ends = ends;
  d.cell_count = cell;
  d.corners = corners;
  d.corner_count = corner;
  d.values = values;
  d.of_cells = of_cells;
  return hl_volume_create_cells(context, &d, volume, error);
}

static hl_status make_cells(faulty *f, void *data, hl_error *error) {
  hl_status status = HL_OK;
  (void)data;
  for (int of_cells = 0; status == HL_OK && of_cells < 2; of_cells++) {
    hl_volume *volume = NULL;
    status = cells(f->context, of_cells != 0, &volume, error);
    hl_volume_release(volume);
  }
  return status;
}

/* Two levels: a cube of cells, and finer cells in one of its corners. */
static hl_status adaptive(hl_context *context, hl_volume **volume, hl_error *error) {
  enum { SIDE = 8 };
  static float values[SIDE * SIDE * SIDE];
  static const int ratio = 2;
  for (int n = 0; n < SIDE * SIDE * SIDE; n++) values[n] = sinf((float)n);
  const hl_patch patches[] = {{0, {0, 0, 0}, {SIDE, SIDE, SIDE}, values},
                              {1, {2, 2, 2}, {SIDE, SIDE, SIDE}, values}};
  hl_amr_description d;
  hl_amr_description_defaults(&d);
  d.levels = 2;
  d.ratios = &ratio;
  for (int a = 0; a < 3; a++) d.count[a] = SIDE;
  d.patches = patches;
  d.patch_count = 2;
  return hl_volume_create_amr(context, &d, volume, error);
}

static hl_status make_adaptive(faulty *f, void *data, hl_error *error) {
  hl_volume *volume = NULL;
  (void)data;
  hl_status status = adaptive(f->context, &volume, error);
  hl_volume_release(volume);
  return status;
}

/* ---- things that are made of volumes ---- */

/* A cube of voxels. labels: whether they are labels of three numbers; else they are a ball that fades out. */
static hl_status cube(hl_context *context, size_t side, bool labels, hl_volume **volume, hl_error *error) {
  hl_volume_description d;
  unsigned char *voxels = malloc(side * side * side);
  assert_non_null(voxels);
  const double middle = ((double)side - 1) / 2;
  for (size_t n = 0; n < side * side * side; n++) {
    const double x = (double)(n % side) - middle, y = (double)(n / side % side) - middle,
                 z = (double)(n / side / side) - middle;
    const double far = sqrt(x * x + y * y + z * z) / middle;
    voxels[n] = (unsigned char)(labels ? (far < 0.8 ? 1 + (x > 0) : 0) : 250 * exp(-3 * far * far));
  }
  hl_volume_description_defaults(&d);
  for (int a = 0; a < 3; a++) d.dimensions[a] = side;
  d.type = HL_VOXEL_U8;
  d.voxels = voxels;
  hl_status status = hl_volume_create(context, &d, volume, error);
  free(voxels);
  return status;
}

static double expected_area; /* the area of the meshes that are made; 0 before the first one */

static hl_status keep_mesh(faulty *f, hl_mesh *mesh, hl_error *error) {
  static const char *const endings[] = {"ply", "stl", "obj"};
  double area, inside;
  char path[PATH_BYTES];
  hl_status status = hl_mesh_measure(f->context, mesh, &area, &inside, error);
  if (status == HL_OK) {
    assert_true(area > 0 && inside > 0);
    if (expected_area == 0) expected_area = area;
    assert_true(area == expected_area);
  }
  for (int n = 0; status == HL_OK && n < 3; n++) {
    snprintf(path, sizeof path, "%s/mesh.%s", folder, endings[n]);
    status = hl_mesh_save(f->context, mesh, path, error);
    assert_int_equal(access(path, F_OK) == 0, status == HL_OK); /* the file is whole, or there is no file */
    unlink(path);
  }
  return status;
}

static hl_status mesh_labels(faulty *f, void *data, hl_error *error) {
  hl_volume *map = NULL;
  hl_label *labels = NULL;
  hl_mesh *mesh = NULL;
  size_t count = 0;
  (void)data;
  hl_status status = cube(f->context, 12, true, &map, error);
  if (status == HL_OK) status = hl_labels_of_volume(f->context, map, NULL, &labels, &count, error);
  if (status == HL_OK) status = hl_mesh_of_labels(f->context, map, labels, count, &mesh, error);
  if (status == HL_OK) status = keep_mesh(f, mesh, error);
  hl_mesh_release(mesh);
  hl_labels_release(f->context, labels);
  hl_volume_release(map);
  return status;
}

static hl_status mesh_values(faulty *f, void *data, hl_error *error) {
  hl_volume *volume = NULL;
  hl_mesh *mesh = NULL;
  (void)data;
  hl_status status = cube(f->context, 12, false, &volume, error);
  if (status == HL_OK) status = hl_mesh_of_isosurface(f->context, volume, 90, &mesh, error);
  if (status == HL_OK) status = keep_mesh(f, mesh, error);
  hl_mesh_release(mesh);
  hl_volume_release(volume);
  return status;
}

static hl_status find_facts(faulty *f, void *data, hl_error *error) {
  static const double percents[] = {1, 50, 99};
  double values[3], plane[30 * 40];
  int is_map;
  const char *text;
  hl_volume *volume = NULL, *smoothed = NULL;
  hl_reslice_options options;
  hl_reslice_options_defaults(&options);
  options.width = 30, options.height = 40, options.depth = 3;
  options.interpolate = 1;
  options.blend = HL_BLEND_MEAN;
  (void)data;
  hl_status status = cube(f->context, 20, false, &volume, error);
  if (status == HL_OK) status = hl_volume_percentiles(volume, percents, 3, values, error);
  if (status == HL_OK) status = hl_volume_reslice(volume, &options, plane, error);
  if (status == HL_OK) status = hl_volume_is_label_map(f->context, volume, &is_map, error);
  if (status == HL_OK) status = hl_volume_guess(volume, NULL, &text, error);
  if (status == HL_OK) status = hl_volume_next_look(volume, NULL, &text, error);
  if (status == HL_OK) status = hl_volume_smooth(volume, 1.5, &smoothed, error);
  if (status == HL_OK) status = hl_volume_percentiles(smoothed, percents, 3, values, error);
  hl_volume_release(smoothed);
  hl_volume_release(volume);
  return status;
}

static hl_status save_volumes(faulty *f, void *data, hl_error *error) {
  static const char *const names[] = {"v.nrrd", "v.nii.gz", "v.mha", "v.vti", "v.mrc", "v.npy"};
  hl_volume *volume = NULL;
  hl_volume_save_options options;
  char path[PATH_BYTES];
  (void)data;
  hl_volume_save_options_defaults(&options);
  hl_status status = cube(f->context, 9, true, &volume, error);
  for (int n = 0; status == HL_OK && n < 6; n++) {
    snprintf(path, sizeof path, "%s/%s", folder, names[n]);
    options.shrink = 1 + (size_t)n % 2;
    options.labels = n % 3 == 0;
    status = hl_volume_save_with(f->context, volume, path, &options, error);
    assert_int_equal(access(path, F_OK) == 0, status == HL_OK);
    unlink(path);
  }
  hl_volume_release(volume);
  return status;
}

/* ---- scenes ---- */

/* A scene of a volume, in a small picture. volume: released. */
static hl_status show(hl_context *context, hl_volume *volume, const hl_option *options, size_t count,
                      hl_scene **scene, hl_error *error) {
  hl_scene *bare = NULL;
  hl_status status = hl_scene_for_volume(context, volume, NULL, &bare, error);
  if (status == HL_OK) {
    hl_scene_description d = *hl_scene_describe(bare);
    d.width = 20;
    d.height = 14;
    d.render.threads = 1;
    d.render.shadow_resolution = 16;
    d.render.sheet_spacing = 4;
    status = hl_scene_compose(context, &d, HL_COMPOSE_BARE, options, count, scene, error);
  }
  hl_scene_release(bare);
  hl_volume_release(volume);
  return status;
}

static hl_status compose_scenes(faulty *f, void *data, hl_error *error) {
  static const hl_option values[] = {
      {"iso", "100:gold:0.4"}, {"cut-plane", "0,0,0:1,0,1"}, {"floor", NULL},      {"view", "iso"},
      {"light-rig", "studio"}, {"range", "20%,99%"},         {"colormap", "turbo"}};
  static const hl_option labels[] = {{"view", "top"}, {"exposure", "1"}};
  hl_volume *volume = NULL;
  hl_scene *scenes[2] = {NULL, NULL}, *joined = NULL;
  (void)data;
  hl_status status = cube(f->context, 14, false, &volume, error);
  if (status == HL_OK)
    status = show(f->context, volume, values, sizeof values / sizeof *values, &scenes[0], error);
  if (status == HL_OK) status = cube(f->context, 14, true, &volume, error);
  if (status == HL_OK)
    status = show(f->context, volume, labels, sizeof labels / sizeof *labels, &scenes[1], error);
  if (status == HL_OK) status = hl_scene_join(f->context, scenes, 2, &joined, error);
  for (int n = 0; n < 2; n++) hl_scene_release(scenes[n]);
  hl_scene_release(joined);
  return status;
}

static hl_status compose_meshes(faulty *f, void *data, hl_error *error) {
  static const float spheres[2][4] = {{0, 0, 0, 1}, {2, 0, 0, 0.5f}},
                     points[3][4] = {{0, 0, 0, 0.1f}, {1, 1, 0, 0.2f}, {2, 0, 1, 0.1f}};
  static const uint32_t length = 3;
  hl_mesh_description d;
  hl_mesh *mesh = NULL;
  hl_scene *scene = NULL;
  (void)data;
  hl_mesh_description_defaults(&d);
  d.spheres = spheres;
  d.sphere_count = 2;
  d.line_points = points;
  d.line_point_count = length;
  d.line_lengths = &length;
  d.line_count = 1;
  hl_status status = hl_mesh_create(f->context, &d, &mesh, error);
  if (status == HL_OK) {
    hl_scene_mesh shown;
    hl_scene_mesh_defaults(&shown);
    shown.mesh = mesh;
    status = hl_scene_for_meshes(f->context, &shown, 1, &scene, error);
  }
  hl_scene_release(scene);
  hl_mesh_release(mesh);
  return status;
}

/* A preview's copies of 64^3 voxels, of values and of labels. If memory is short for the copies that the
 * second scene needs, the volume itself is rendered. */
static hl_status preview(faulty *f, void *data, hl_error *error) {
  const bool labels = *(const bool *)data;
  hl_volume *volume = NULL;
  hl_scene *scene = NULL, *quick = NULL, *other = NULL;
  hl_preview *made = NULL;
  hl_status status = cube(f->context, 64, labels, &volume, error);
  if (status == HL_OK) status = show(f->context, volume, NULL, 0, &scene, error);
  if (status == HL_OK) {
    hl_scene_description d = *hl_scene_describe(scene);
    hl_scene_volume drawn = d.volumes[0];
    drawn.labels = NULL;
    drawn.label_count = 0;
    d.volumes = &drawn;
    status = hl_scene_create(f->context, &d, &other, error);
  }
  if (status == HL_OK) status = hl_preview_create(f->context, scene, &made, error);
  if (status == HL_OK) status = hl_preview_scene(made, other, &quick, error);
  hl_preview_destroy(made);
  hl_scene_release(quick);
  hl_scene_release(other);
  hl_scene_release(scene);
  return status;
}

/* ---- pictures ---- */

static hl_status render(hl_context *context, const hl_scene *scene, hl_error *error) {
  const hl_scene_description *d = hl_scene_describe(scene);
  hl_renderer *renderer = NULL;
  char *plan = NULL;
  float *pixels = malloc(4 * sizeof *pixels * (size_t)d->width * (size_t)d->height);
  assert_non_null(pixels);
  hl_status status = hl_renderer_create(context, &renderer, error);
  if (status == HL_OK) status = hl_renderer_plan(renderer, scene, &plan, error);
  if (status == HL_OK)
    status = hl_renderer_render(renderer, scene, pixels, 4 * (size_t)d->width, NULL, error);
  hl_text_release(context, plan);
  hl_renderer_destroy(renderer);
  free(pixels);
  return status;
}

typedef hl_status maker(hl_context *context, hl_volume **volume, hl_error *error);

static hl_status sparse_particles(hl_context *context, hl_volume **volume, hl_error *error) {
  return particles(context, 2, volume, error);
}
static hl_status cells_by_points(hl_context *context, hl_volume **volume, hl_error *error) {
  return cells(context, false, volume, error);
}

/* Makes a scene of a volume, with hard shadows and without a sky. The volume is released. */
static hl_status show_plainly(hl_context *context, hl_volume *volume, hl_scene **scene, hl_error *error) {
  hl_scene *rich = NULL;
  hl_status status = show(context, volume, NULL, 0, &rich, error);
  if (status == HL_OK) {
    hl_scene_description d = *hl_scene_describe(rich);
    hl_scene_level_sky(&d);
    d.render.shadows = HL_SHADOWS_HARD;
    status = hl_scene_create(context, &d, scene, error);
  }
  hl_scene_release(rich);
  return status;
}

/* A frame of a volume of bricks. The volume is made anew each time, because results about it are kept with
 * it. Other tests have the failures of making it. */
static hl_status render_bricks(faulty *f, maker *make, hl_error *error) {
  hl_volume *volume = NULL;
  hl_scene *scene = NULL;
  long allocations = atomic_exchange(&f->allocations_left, -1),
       questions = atomic_exchange(&f->questions_left, -1);
  assert_int_equal(make(f->context, &volume, error), HL_OK);
  assert_int_equal(show_plainly(f->context, volume, &scene, error), HL_OK);
  atomic_store(&f->questions_left, questions);
  atomic_store(&f->allocations_left, allocations);
  hl_status status = render(f->context, scene, error);
  hl_scene_release(scene);
  return status;
}

static hl_status render_particles(faulty *f, void *data, hl_error *error) {
  (void)data;
  return render_bricks(f, sparse_particles, error);
}
static hl_status render_cells(faulty *f, void *data, hl_error *error) {
  (void)data;
  return render_bricks(f, cells_by_points, error);
}
static hl_status render_adaptive(faulty *f, void *data, hl_error *error) {
  (void)data;
  return render_bricks(f, adaptive, error);
}

static hl_status draw_figures(faulty *f, void *data, hl_error *error) {
  static const char *const formats[] = {"png", "pdf", "svg", "tif"};
  hl_volume *volume = NULL;
  hl_scene *scene = NULL;
  hl_image *image = NULL;
  (void)data;
  hl_status status = cube(f->context, 10, false, &volume, error);
  if (status == HL_OK) status = show(f->context, volume, NULL, 0, &scene, error);
  if (status == HL_OK) status = hl_image_create(f->context, 20, 14, &image, error);
  hl_figure figure;
  hl_figure_panel panel = {.image = NULL};
  hl_figure_defaults(&figure);
  hl_overlay_defaults(&panel.overlay);
  if (status == HL_OK) {
    hl_figure_of_picture(image, scene, 90, &figure, &panel);
    panel.overlay.scale_bar = panel.overlay.legend = 1;
    panel.overlay.scale_bar_depth = HL_DEPTH_OF_TARGET;
    panel.overlay.world_unit = "mm";
    panel.overlay.axes = HL_AXES_ARROWS;
    panel.overlay.letter = "a";
    panel.overlay.legend_corner = HL_CORNER_BELOW;
    status = hl_figure_check(f->context, &figure, error);
  }
  if (status == HL_OK) status = hl_figure_add_strip(f->context, &figure, error);
  for (int n = 0; status == HL_OK && n < 4; n++) {
    unsigned char *bytes = NULL;
    size_t length = 0;
    status = hl_figure_encode(f->context, &figure, formats[n], NULL, &bytes, &length, error);
    hl_bytes_release(f->context, bytes);
  }
  hl_image_destroy(image);
  hl_scene_release(scene);
  return status;
}

static hl_status look_into_pictures(faulty *f, void *data, hl_error *error) {
  hl_image *image = NULL;
  unsigned char *bytes = NULL;
  char *text = NULL;
  size_t length = 0;
  hl_image_write_options options;
  (void)data;
  hl_image_write_options_defaults(&options);
  options.scene_json = "{\"halflight\": 1}";
  hl_status status = hl_image_create(f->context, 30, 20, &image, error);
  if (status == HL_OK) status = hl_image_encode(f->context, image, "png", &options, &bytes, &length, error);
  if (status == HL_OK) status = hl_image_find_scene(f->context, "p.png", bytes, length, &text, error);
  hl_text_release(f->context, text);
  hl_bytes_release(f->context, bytes);
  hl_image_destroy(image);
  return status;
}

/* ---- the tests ---- */

static bool of_labels = true, of_values = false;

typedef struct work {
  const char *name;
  faulty_work *run;
  void *data;
  long allocations, questions; /* the least numbers of allocations and questions that each work must have */
  bool recovers;               /* whether a failing allocation may cost only time or exactness */
} work;

static const work works[] = {{"particles", make_particles, NULL, 10, 10, true},
                             {"smoothing lengths", find_smoothing, NULL, 5, 3, false},
                             {"cells", make_cells, NULL, 10, 4, true},
                             {"adaptive grids", make_adaptive, NULL, 5, 4, true},
                             {"meshes of labels", mesh_labels, NULL, 10, 10, true},
                             {"meshes of values", mesh_values, NULL, 10, 4, false},
                             {"facts", find_facts, NULL, 5, 3, false},
                             {"files of volumes", save_volumes, NULL, 5, 3, false},
                             {"composed scenes", compose_scenes, NULL, 10, 1, true},
                             {"scenes of meshes", compose_meshes, NULL, 5, 0, false},
                             {"previews of values", preview, &of_values, 5, 3, true},
                             {"previews of labels", preview, &of_labels, 5, 3, true},
                             {"frames of particles", render_particles, NULL, 20, 20, true},
                             {"frames of cells", render_cells, NULL, 20, 20, true},
                             {"frames of adaptive grids", render_adaptive, NULL, 20, 20, true},
                             {"figures", draw_figures, NULL, 5, 0, true},
                             {"pictures in memory", look_into_pictures, NULL, 3, 0, false}};

static void test_work(void **state) {
  const work *work = *state;
  faulty f;
  faulty_open(&f);
  f.may_recover = f.may_do_without = work->recovers;
  expected_area = 0;
  hl_error error = {0};
  if (work->run(&f, work->data, &error) != HL_OK) fail_msg("%s", error.message);
  assert_true(faulty_fail_each(&f, work->run, NULL, work->data) >= work->allocations);
  assert_true(faulty_stop_each(&f, work->run, NULL, work->data) >= work->questions);
  faulty_close(&f);
}

int main(int count, char **arguments) {
  enum { WORKS = sizeof works / sizeof *works };
  static struct CMUnitTest tests[WORKS];
  if (count > 1) cmocka_set_test_filter(arguments[1]);
  for (size_t n = 0; n < WORKS; n++)
    tests[n] = (struct CMUnitTest){
        .name = works[n].name, .test_func = test_work, .initial_state = (void *)&works[n]};
  return cmocka_run_group_tests_name("faults_made", tests, open_folder, close_folder);
}
