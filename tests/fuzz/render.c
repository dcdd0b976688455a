/* tests/fuzz/render.c - fuzz target: whole renders of small random scenes, of every kind of light, shadow and
 * volume.
 *
 * The input's bytes are drawn one by one as choices and numbers, so that most inputs give scenes that the
 * library accepts. A scene that is refused must be refused with a line; a picture must be finite with alpha
 * in [0, 1].
 */
#include <math.h>
#include <string.h>

#include "target.h"

const uint64_t fuzz_memory_limit = 32 << 20;

enum {
  MOST_SIDE = 8,
  MOST_EDGE = 7,
  MOST_VOXELS = MOST_EDGE * MOST_EDGE * MOST_EDGE,
  MOST_POINTS = 4,
  MOST_LIGHTS = 3,
  MOST_VOLUMES = 2,
  TEXTURE = 3,
  SKY_WIDTH = 4,
  SKY_HEIGHT = 3,
  MOST_MESHES = 2,
  MOST_VERTICES = 6,
  MOST_CUTS = 3,
  MOST_LABELS = 3
};

/* The memory of everything to which a description points. */
typedef struct scene_parts {
  hl_scene_description description;
  hl_light lights[MOST_LIGHTS];
  double vertices[MOST_LIGHTS][5][3];
  float texture[TEXTURE * TEXTURE * 3];
  hl_scene_volume volumes[MOST_VOLUMES];
  hl_opacity_point opacity[MOST_VOLUMES][MOST_POINTS];
  hl_color_point color[MOST_VOLUMES][MOST_POINTS];
  float sky[SKY_WIDTH * SKY_HEIGHT * 3];
  hl_scene_mesh meshes[MOST_MESHES];
  hl_isosurface iso[2];
  hl_cut cuts[MOST_CUTS];
  hl_label labels[MOST_LABELS];
  hl_volume *mask;
} scene_parts;

static void draw_vector(fuzz_source *source, double v[3]) {
  for (int a = 0; a < 3; a++) v[a] = fuzz_number(source);
}

static void draw_color(fuzz_source *source, double color[3]) {
  for (int c = 0; c < 3; c++) color[c] = fuzz_byte(source) / 128.0;
}

static void draw_voxels(fuzz_source *source, hl_voxel_type type, void *voxels, size_t count) {
  static const float special[] = {NAN, INFINITY, -INFINITY, 1e30f};
  for (size_t n = 0; n < count; n++) {
    unsigned value = fuzz_byte(source);
    if (source->left == 0) value = (unsigned)(n * 37 % 256); /* not all alike */
    if (type == HL_VOXEL_U8) ((uint8_t *)voxels)[n] = (uint8_t)value;
    if (type == HL_VOXEL_I16) ((int16_t *)voxels)[n] = (int16_t)(value * 257u);
    if (type == HL_VOXEL_F32) ((float *)voxels)[n] = value >= 252 ? special[value - 252] : (float)value;
  }
}

/* A factor from 1/4 to 4, so that sheets stay few and an input takes little time. */
static double draw_factor(fuzz_source *source) { return exp2(4 * fuzz_unit(source) - 2); }

static void draw_grid(fuzz_source *source, hl_volume_description *grid) {
  unsigned kind = fuzz_byte(source);
  for (int a = 0; a < 3; a++) {
    grid->dimensions[a] = 1 + (size_t)fuzz_choice(source, MOST_EDGE);
    if (kind & 1) grid->axis[a][a] = kind & 8 ? -draw_factor(source) : draw_factor(source);
    grid->origin[a] = kind & 2 ? fuzz_number(source) : -3;
  }
  for (int a = 0; a < 3 && kind & 4; a++) grid->axis[a][(a + 1) % 3] = fuzz_unit(source) / 4; /* oblique */
}

/* Makes a volume; null if the grid is refused. */
static hl_volume *draw_volume(fuzz_source *source) {
  static const hl_voxel_type types[] = {HL_VOXEL_U8, HL_VOXEL_I16, HL_VOXEL_F32};
  float voxels[MOST_VOXELS];
  hl_volume_description grid;
  hl_volume_description_defaults(&grid);
  grid.type = types[fuzz_choice(source, 3)];
  draw_grid(source, &grid);
  draw_voxels(source, grid.type, voxels, grid.dimensions[0] * grid.dimensions[1] * grid.dimensions[2]);
  grid.voxels = voxels;
  hl_volume *volume = NULL;
  hl_error error = {0};
  hl_status status = hl_volume_create(fuzz_context(), &grid, &volume, &error);
  fuzz_check_answer(status, &error, volume != NULL);
  return volume;
}

static void draw_function(fuzz_source *source, scene_parts *parts, int index) {
  hl_transfer_function *function = &parts->volumes[index].transfer_function;
  double value = -20, scale = fuzz_choice(source, 4) == 0 ? 300 : 1;
  function->unit_distance = fuzz_choice(source, 4) == 0 ? fabs(fuzz_number(source)) : 1;
  function->opacity = parts->opacity[index];
  function->color = parts->color[index];
  function->opacity_count = (size_t)fuzz_choice(source, MOST_POINTS + 1);
  function->color_count = (size_t)fuzz_choice(source, MOST_POINTS + 1);
  for (size_t n = 0; n < function->opacity_count; n++) {
    value += fuzz_byte(source) * scale;
    parts->opacity[index][n] = (hl_opacity_point){value, fuzz_byte(source) / 255.0};
  }
  value = -20;
  for (size_t n = 0; n < function->color_count; n++) {
    value += fuzz_byte(source);
    parts->color[index][n].value = value;
    for (int c = 0; c < 3; c++) parts->color[index][n].color[c] = fuzz_byte(source) / 255.0;
  }
}

static bool draw_scene_volume(fuzz_source *source, scene_parts *parts, int index) {
  hl_scene_volume *volume = &parts->volumes[index];
  hl_scene_volume_defaults(volume);
  volume->volume = draw_volume(source);
  if (volume->volume == NULL) return false;
  unsigned flags = fuzz_byte(source);
  volume->visible = (flags & 7) != 0;
  volume->casts_shadow = (flags >> 3 & 3) != 0;
  volume->receives_shadow = (flags >> 5 & 3) != 0;
  volume->shading = flags & 128 ? HL_SHADING_NONE : HL_SHADING_PHONG;
  unsigned more = fuzz_byte(source);
  if (more & 1) draw_color(source, volume->attenuation_color);
  if (more & 2) volume->scale = draw_factor(source);
  if (more & 4) {
    draw_vector(source, volume->rotate_axis);
    volume->rotate_angle_deg = 45 * fuzz_number(source);
  }
  if (more & 8)
    for (int a = 0; a < 3; a++) volume->translate[a] = 8 * fuzz_unit(source);
  volume->clipped = (more & 16) != 0;
  if (volume->clipped) {
    draw_vector(source, volume->clip_min);
    for (int a = 0; a < 3; a++) volume->clip_max[a] = volume->clip_min[a] + fabs(fuzz_number(source));
  }
  if (more & 32) {
    volume->material.ambient = fuzz_unit(source);
    volume->material.diffuse = fuzz_unit(source);
    volume->material.specular = fuzz_unit(source);
    volume->material.shininess = 100 * fuzz_unit(source);
  }
  if (more & 64) {
    volume->material.emission = fabs(fuzz_number(source));
    for (int a = 0; a < 3; a++) volume->axis_scale[a] = draw_factor(source);
  }
  if (more & 128) volume->shading = HL_SHADING_FLAT;
  draw_function(source, parts, index);
  return true;
}

static void draw_texture(fuzz_source *source, scene_parts *parts, hl_light_texture *texture) {
  texture->pixels = parts->texture;
  texture->width = 1 + fuzz_choice(source, TEXTURE);
  texture->height = 1 + fuzz_choice(source, TEXTURE);
  draw_vector(source, texture->screen_center);
  draw_vector(source, texture->screen_right);
  draw_vector(source, texture->screen_up);
}

static void draw_light(fuzz_source *source, scene_parts *parts, int index) {
  hl_light *light = &parts->lights[index];
  hl_light_defaults(light);
  unsigned kind = fuzz_byte(source);
  light->type = (hl_light_type)(kind % 6);
  draw_vector(source, light->direction);
  draw_vector(source, light->position);
  light->angular_diameter_deg = kind & 64 ? 90 * fuzz_unit(source) : 0;
  light->radius = kind & 64 ? fabs(fuzz_number(source)) : 0;
  draw_vector(source, light->normal);
  if (light->type == HL_LIGHT_RECT) {
    draw_vector(source, light->edge1);
    draw_vector(source, light->edge2);
  }
  if (light->type == HL_LIGHT_SPOT) {
    light->opening_angle_deg = 0.01 + 178.9 * fuzz_unit(source);
    light->falloff_angle_deg = light->opening_angle_deg / 2 * fuzz_unit(source);
  }
  if (light->type == HL_LIGHT_POLYGON) {
    /* points around a middle at one height lie in a plane, if they are in order */
    light->vertex_count = 3 + (size_t)fuzz_choice(source, 3);
    double radius = fabs(fuzz_number(source));
    for (size_t v = 0; v < light->vertex_count; v++) {
      double angle = 6.28 * (double)v / (double)light->vertex_count;
      parts->vertices[index][v][0] = light->position[0] + radius * cos(angle);
      parts->vertices[index][v][1] = light->position[1] + radius * sin(angle);
      parts->vertices[index][v][2] = light->position[2];
    }
    light->vertices = (const double(*)[3])parts->vertices[index];
  }
  if (light->type != HL_LIGHT_DIRECTIONAL && kind & 128) light->falloff = HL_FALLOFF_INVERSE_SQUARE;
  draw_color(source, light->color);
  light->intensity = fuzz_byte(source) / 64.0;
  light->shadows = (hl_shadows)fuzz_choice(source, 4);
  if (fuzz_choice(source, 4) == 1) draw_texture(source, parts, &light->texture);
}

static void draw_settings(fuzz_source *source, hl_render_settings *render) {
  static const double spacings[] = {0.5, 1, 0.25, 2, 0.7, 10};
  /* "auto" would be up to a million pixels, which takes too long here */
  static const int resolutions[] = {16, 32, 7, 40, 1, 24, 12, 3};
  render->shadows = (hl_shadows)(1 + fuzz_choice(source, 3));
  render->soft_method = (hl_soft_method)fuzz_choice(source, 3);
  render->light_samples = 1 + fuzz_choice(source, 3);
  if (render->light_samples == 3 && render->shadows == HL_SHADOWS_OFF)
    render->compositing = HL_COMPOSITING_MAXIMUM;
  render->sheet_spacing = spacings[fuzz_choice(source, 6)];
  render->kernel = (hl_kernel)fuzz_choice(source, 3);
  render->reconstruction = (hl_reconstruction)fuzz_choice(source, 3);
  render->slicing = (hl_slicing)fuzz_choice(source, 2);
  render->shadow_lookup = (hl_shadow_lookup)fuzz_choice(source, 4);
  render->shadow_resolution = resolutions[fuzz_choice(source, 8)];
  render->threads = 1;
}

static void draw_camera(fuzz_source *source, hl_scene_description *description) {
  hl_camera *camera = &description->camera;
  unsigned kind = fuzz_byte(source);
  camera->type = (hl_camera_type)(kind & 1);
  if (kind & 2) camera->fovy_deg = 1 + 170 * fuzz_unit(source);
  if (kind & 4) {
    draw_vector(source, camera->position);
    draw_vector(source, camera->target);
    draw_vector(source, camera->up);
    camera->height = fabs(fuzz_number(source));
    return;
  }
  double azimuth = 360 * fuzz_unit(source), elevation = 180 * fuzz_unit(source) - 90;
  if (hl_camera_frame(description, azimuth, elevation, 1, camera) != HL_OK) camera->height = 1;
}

static void draw_sky(fuzz_source *source, scene_parts *parts, hl_sky *sky) {
  sky->type = (hl_sky_type)fuzz_choice(source, 4);
  draw_color(source, sky->color);
  draw_color(source, sky->zenith);
  draw_color(source, sky->horizon);
  draw_vector(source, sky->up);
  sky->strength = fuzz_unit(source);
  if (sky->type != HL_SKY_IMAGE) return;
  sky->pixels = parts->sky;
  sky->width = 1 + fuzz_choice(source, SKY_WIDTH);
  sky->height = 1 + fuzz_choice(source, SKY_HEIGHT);
  for (size_t n = 0; n < sizeof parts->sky / sizeof *parts->sky; n++) {
    unsigned value = fuzz_byte(source);
    parts->sky[n] = value > 250 ? 2000.0f * (float)value : (float)value / 64;
  }
}

/* Makes a strip of triangles, or spheres. */
static void draw_mesh(fuzz_source *source, scene_parts *parts, hl_scene_description *description) {
  float positions[MOST_VERTICES][3], spheres[MOST_VERTICES][4];
  uint32_t triangles[MOST_VERTICES - 2][3];
  hl_mesh_description mesh;
  hl_error error = {0};
  hl_mesh_description_defaults(&mesh);
  bool round = fuzz_choice(source, 2) == 1;
  for (uint32_t n = 0; n < MOST_VERTICES; n++) {
    for (int a = 0; a < 3; a++) spheres[n][a] = positions[n][a] = (float)fuzz_number(source);
    spheres[n][3] = (float)fuzz_unit(source);
    for (uint32_t c = 0; c < 3 && n + 2 < MOST_VERTICES; c++) triangles[n][c] = n + c;
  }
  if (round) mesh.spheres = spheres, mesh.sphere_count = MOST_VERTICES;
  else mesh.positions = positions, mesh.vertex_count = MOST_VERTICES;
  if (!round) mesh.triangles = triangles, mesh.triangle_count = MOST_VERTICES - 2;
  hl_scene_mesh *placed = &parts->meshes[description->mesh_count];
  hl_scene_mesh_defaults(placed);
  hl_status status = hl_mesh_create(fuzz_context(), &mesh, &placed->mesh, &error);
  if (!fuzz_check_answer(status, &error, placed->mesh != NULL)) return;
  draw_color(source, placed->color);
  placed->opacity = fuzz_unit(source);
  placed->casts_shadow = fuzz_choice(source, 4) != 0;
  description->mesh_count++;
}

static void draw_cuts(fuzz_source *source, scene_parts *parts, hl_scene_volume *volume) {
  volume->cut_count = (size_t)fuzz_choice(source, MOST_CUTS + 1);
  volume->cuts = parts->cuts;
  for (size_t n = 0; n < volume->cut_count; n++) {
    hl_cut *cut = &parts->cuts[n];
    hl_cut_defaults(cut);
    cut->type = (hl_cut_type)fuzz_choice(source, 3);
    cut->keep = (hl_cut_keep)fuzz_choice(source, 2);
    draw_vector(source, cut->point);
    draw_vector(source, cut->normal);
    draw_vector(source, cut->min);
    for (int a = 0; a < 3; a++) cut->max[a] = cut->min[a] + fabs(fuzz_number(source));
    draw_vector(source, cut->center);
    cut->radius = fabs(fuzz_number(source));
  }
  volume->cut_shading = (hl_cut_shading)fuzz_choice(source, 3);
  volume->cut_casts_shadow = fuzz_choice(source, 2);
}

static void draw_labels(fuzz_source *source, scene_parts *parts) {
  for (int n = 0; n < MOST_LABELS; n++) {
    hl_label *label = &parts->labels[n];
    label->value = n + 1 + (n > 0 ? fuzz_choice(source, 200) * n : 0);
    draw_color(source, label->color);
    for (int c = 0; c < 3; c++) label->color[c] /= 2;
    label->opacity = fuzz_unit(source);
    label->visible = fuzz_choice(source, 4) != 0;
    label->tint = fuzz_unit(source);
  }
}

/* Draws surfaces, cuts, labels or a mask of the first volume, then meshes and a sky. This stands at the end
 * of an input, so that older inputs keep their meaning. */
static void draw_more(fuzz_source *source, scene_parts *parts) {
  hl_scene_description *description = &parts->description;
  hl_scene_volume *volume = &parts->volumes[0];
  unsigned kind = fuzz_byte(source);
  if (kind & 1) {
    volume->iso = parts->iso;
    volume->iso_count = 1 + (size_t)fuzz_choice(source, 2);
    for (int n = 0; n < 2; n++) {
      hl_isosurface_defaults(&parts->iso[n]);
      parts->iso[n].value = fuzz_byte(source) + 0.5 * n;
      parts->iso[n].opacity = fuzz_unit(source);
    }
  }
  if (kind & 2) draw_cuts(source, parts, volume);
  if (kind & 4) draw_labels(source, parts);
  if ((kind & 12) == 4) volume->labels = parts->labels, volume->label_count = MOST_LABELS;
  if ((kind & 12) == 12 && (parts->mask = draw_volume(source)) != NULL)
    volume->mask = (hl_mask){.volume = parts->mask,
                             .component = HL_COMPONENT_DEFAULT,
                             .labels = parts->labels,
                             .label_count = MOST_LABELS,
                             .rest = fuzz_unit(source)};
  for (int n = 0; kind & 16 && n < 1 + fuzz_choice(source, MOST_MESHES); n++)
    draw_mesh(source, parts, description);
  description->meshes = parts->meshes;
  if (kind & 32) draw_sky(source, parts, &description->sky);
  if ((kind & 80) == 80) description->volume_count = 0; /* meshes alone */
}

static bool draw_scene(fuzz_source *source, scene_parts *parts) {
  hl_scene_description *description = &parts->description;
  hl_scene_description_defaults(description);
  description->width = 1 + fuzz_choice(source, MOST_SIDE);
  description->height = 1 + fuzz_choice(source, MOST_SIDE);
  draw_settings(source, &description->render);
  description->volumes = parts->volumes;
  int volumes = 1 + (fuzz_choice(source, 3) == 1);
  for (int v = 0; v < volumes; v++, description->volume_count++)
    if (!draw_scene_volume(source, parts, v)) return false;
  description->lights = parts->lights;
  description->light_count = (size_t)fuzz_choice(source, MOST_LIGHTS + 1);
  for (size_t n = 0; n < sizeof parts->texture / sizeof *parts->texture; n++)
    parts->texture[n] = (float)(n % 7) / 6;
  for (size_t l = 0; l < description->light_count; l++) draw_light(source, parts, (int)l);
  draw_camera(source, description);
  draw_more(source, parts);
  return true;
}

static void check_pixels(const float *pixels, size_t count) {
  for (size_t n = 0; n < count; n++) {
    const float *pixel = pixels + 4 * n;
    for (int c = 0; c < 4; c++) REQUIRE(isfinite(pixel[c]) && pixel[c] >= 0);
    REQUIRE(pixel[3] <= 1);
  }
}

static void check_layers(const float *layer, size_t count) {
  for (size_t n = 0; n < count; n++) REQUIRE(!isnan(layer[n]));
}

static void render(const hl_scene *scene, bool with_layers) {
  static float pixels[MOST_SIDE * MOST_SIDE * 4], planes[4][MOST_SIDE * MOST_SIDE * 3];
  static float lights[MOST_LIGHTS][2][MOST_SIDE * MOST_SIDE * 3];
  const hl_scene_description *description = hl_scene_describe(scene);
  size_t width = (size_t)description->width, count = width * (size_t)description->height;
  hl_light_layers light_layers[MOST_LIGHTS];
  for (int l = 0; l < MOST_LIGHTS; l++) light_layers[l] = (hl_light_layers){lights[l][0], lights[l][1]};
  hl_layers layers = {.struct_size = sizeof layers,
                      .ambient = planes[0],
                      .depth_first = planes[1],
                      .depth_mean = planes[2],
                      .normal = planes[3],
                      .lights = light_layers,
                      .light_count = description->light_count};
  hl_renderer *renderer = NULL;
  hl_error error = {0};
  hl_status status = hl_renderer_create(fuzz_context(), &renderer, &error);
  if (!fuzz_check_answer(status, &error, renderer != NULL)) return;
  status = with_layers ? hl_renderer_render_layers(renderer, scene, pixels, width * 4, &layers, NULL, &error)
                       : hl_renderer_render(renderer, scene, pixels, width * 4, NULL, &error);
  if (fuzz_check_answer(status, &error, status == HL_OK)) {
    check_pixels(pixels, count);
    for (int plane = 0; with_layers && plane < 4; plane++)
      check_layers(planes[plane], count * (plane == 0 || plane == 3 ? 3 : 1));
    for (size_t l = 0; with_layers && l < description->light_count; l++)
      for (int kind = 0; kind < 2; kind++) check_layers(lights[l][kind], count * 3);
  }
  hl_renderer_destroy(renderer);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  fuzz_source source = {data, size};
  static scene_parts parts;
  memset(&parts, 0, sizeof parts);
  bool with_layers = fuzz_choice(&source, 4) == 1;
  if (draw_scene(&source, &parts)) {
    hl_scene *scene = NULL;
    hl_error error = {0};
    hl_status status = hl_scene_create(fuzz_context(), &parts.description, &scene, &error);
    if (fuzz_check_answer(status, &error, scene != NULL)) render(scene, with_layers);
    hl_scene_release(scene);
  }
  for (int v = 0; v < MOST_VOLUMES; v++) hl_volume_release(parts.volumes[v].volume);
  for (int m = 0; m < MOST_MESHES; m++) hl_mesh_release(parts.meshes[m].mesh);
  hl_volume_release(parts.mask);
  fuzz_check_nothing_held();
  return 0;
}
