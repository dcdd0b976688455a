/* tests/unit/scene_create.c - scenes that cannot be changed: deep copies, and each refusal with its exact
 * message. */
#include "scene_parts.h"

#include "scene/light/light_kind.h"

static void copies_everything(void **state) {
  (void)state;
  parts p;
  parts_make(&p);
  hl_scene *scene = NULL;
  assert_int_equal(hl_scene_create(p.context, &p.description, &scene, NULL), HL_OK);
  /* The caller may change its own arrays afterwards. */
  p.light.intensity = 77;
  p.slide[1] = 77;
  p.opacity[1].opacity = 0.9;
  p.scene_volume.scale = 5;
  const hl_scene_description *d = hl_scene_describe(scene);
  assert_true(d->lights[0].intensity == 1 && d->volumes[0].scale == 1);
  assert_true(d->volumes[0].transfer_function.opacity[1].opacity == 0.25);
  assert_true(d->lights[0].texture.pixels[1] == 0.2f && d->lights[0].texture.pixels[5] == 1);
  assert_string_equal(d->lights[0].texture.file, "slide.png");
  assert_string_equal(d->volumes[0].name, "cube");
  assert_ptr_not_equal(d->volumes[0].name, p.scene_volume.name);
  assert_ptr_equal(d->volumes[0].volume, p.volume);
  hl_scene_retain(scene);
  hl_scene_release(scene);
  assert_true(hl_scene_describe(scene)->volume_count == 1);
  hl_scene_release(scene);
  parts_release(&p);
}

static void copies_a_lights_own_image(void **state) {
  (void)state;
  parts p;
  parts_make(&p);
  p.light.type = HL_LIGHT_RECT;
  p.light.texture.pixels = NULL;
  p.light.emission = (hl_light_emission){"glow.png", p.glow, 2, 2, {0, 0, 1}};
  p.glow[7] = 3;
  hl_scene *scene = NULL;
  assert_int_equal(hl_scene_create(p.context, &p.description, &scene, NULL), HL_OK);
  p.glow[7] = 0;
  const hl_light_emission *emission = &hl_scene_describe(scene)->lights[0].emission;
  assert_true(emission->pixels[7] == 3 && emission->pixels[0] == 0 && emission->width == 2 &&
              emission->up[2] == 1);
  assert_string_equal(emission->file, "glow.png");
  hl_scene_release(scene);
  parts_release(&p);
}

/* With any memory limit below the need, the call fails in order, and nothing leaks. */
static void survives_any_memory_limit(void **state) {
  (void)state;
  int refused = 0, made = 0;
  for (uint64_t limit = 1024; made == 0; limit += 256) {
    parts p;
    parts_make(&p);
    hl_volume_release(p.volume);
    hl_context_destroy(p.context);
    hl_context_options options;
    hl_context_options_defaults(&options);
    options.memory_limit = limit;
    float value[27] = {0};
    hl_volume_description d;
    hl_volume_description_defaults(&d);
    for (int a = 0; a < 3; a++) d.dimensions[a] = 3;
    d.type = HL_VOXEL_F32;
    d.voxels = value;
    assert_int_equal(hl_context_create(&options, &p.context, NULL), HL_OK);
    hl_error error = {0};
    if (hl_volume_create(p.context, &d, &p.volume, NULL) == HL_OK) {
      p.scene_volume.volume = p.volume;
      hl_scene *scene = NULL;
      hl_status status = hl_scene_create(p.context, &p.description, &scene, &error);
      if (status == HL_OK) made++;
      else assert_int_equal(status, HL_ERROR_MEMORY), refused++;
      assert_true((status == HL_OK) == (scene != NULL));
      hl_scene_release(scene);
      parts_release(&p);
    } else hl_context_destroy(p.context);
  }
  assert_true(refused > 2);
}

/* Each case makes one field of a good scene wrong. */
typedef struct refusal {
  const char *message;
  hl_status status;
  void (*spoil)(parts *p);
} refusal;

#define SPOIL(name, statement) \
  static void name(parts *p) { statement; }
SPOIL(width_zero, p->description.width = 0)
SPOIL(height_huge, p->description.height = 40000)
SPOIL(background_bright, p->description.background[1] = 255)
SPOIL(background_nan, p->description.background[2] = NAN)
SPOIL(eye_at_target, memcpy(p->description.camera.target, p->description.camera.position, 3 * sizeof(double)))
SPOIL(eye_nan, p->description.camera.position[0] = NAN)
SPOIL(target_infinite, p->description.camera.target[2] = INFINITY)
SPOIL(up_zero, p->description.camera.up[2] = 0)
SPOIL(fovy_zero, p->description.camera.fovy_deg = 0)
SPOIL(fovy_wide, p->description.camera.fovy_deg = 180)
SPOIL(camera_type, p->description.camera.type = (hl_camera_type)7)
SPOIL(height_negative, p->description.camera.type = HL_CAMERA_ORTHOGRAPHIC; p->description.camera.height = -2)
SPOIL(ambient_negative, p->description.ambient[0] = -0.5)
SPOIL(lights_null, p->description.lights = NULL)
SPOIL(lights_many, p->description.light_count = 1000)
SPOIL(light_direction_zero, memset(p->light.direction, 0, sizeof p->light.direction))
SPOIL(light_diameter, p->light.angular_diameter_deg = -1)
SPOIL(light_falloff, p->light.falloff = HL_FALLOFF_INVERSE_SQUARE)
SPOIL(light_radius, p->light.type = HL_LIGHT_POINT; p->light.radius = -1)
SPOIL(light_radius_nan, p->light.type = HL_LIGHT_POINT; p->light.radius = NAN)
SPOIL(spot_wide, p->light.type = HL_LIGHT_SPOT; p->light.opening_angle_deg = 180)
SPOIL(spot_nan, p->light.type = HL_LIGHT_SPOT; p->light.opening_angle_deg = NAN)
SPOIL(spot_edge, p->light.type = HL_LIGHT_SPOT; p->light.falloff_angle_deg = 21)
SPOIL(spot_direction, p->light.type = HL_LIGHT_SPOT; p->light.direction[2] = 0)
SPOIL(light_edge, p->light.type = HL_LIGHT_RECT; p->light.edge2[1] = NAN)
SPOIL(light_normal, p->light.type = HL_LIGHT_DISK; p->light.normal[2] = 0)
SPOIL(light_disk_radius, p->light.type = HL_LIGHT_DISK; p->light.radius = -2)

static void make_polygon(parts *p, const double (*vertices)[3], size_t count) {
  p->light.type = HL_LIGHT_POLYGON;
  p->light.vertices = vertices;
  p->light.vertex_count = count;
}
static const double line[][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}},
                    bent[][3] = {{0, 0, 0}, {1, 0, 0.1}, {1, 1, 0}, {0, 1, 0.1}},
                    crossed[][3] = {{0, 0, 0}, {2, 1, 0}, {2, 0, 0}, {0, 3, 0}},
                    infinite[][3] = {{0, 0, 0}, {1, INFINITY, 0}, {1, 1, 0}};
SPOIL(polygon_null, make_polygon(p, NULL, 3))
SPOIL(polygon_two, make_polygon(p, line, 2))
SPOIL(polygon_line, make_polygon(p, line, 3))
SPOIL(polygon_bent, make_polygon(p, bent, 4))
SPOIL(polygon_crossed, make_polygon(p, crossed, 4))
SPOIL(polygon_infinite, make_polygon(p, infinite, 3))
SPOIL(light_color, p->light.color[2] = -0.1)
SPOIL(light_intensity, p->light.intensity = -3)
SPOIL(light_shadows, p->light.shadows = (hl_shadows)9)
SPOIL(texture_width, p->light.texture.width = 0)
SPOIL(texture_height, p->light.texture.height = 40000)
SPOIL(texture_vast, p->light.texture.width = p->light.texture.height = 32768)
SPOIL(texture_nan, p->slide[4] = NAN)
SPOIL(texture_negative, p->slide[2] = -1)
SPOIL(screen_nan, p->light.texture.screen_center[1] = NAN)
SPOIL(screen_narrow, p->light.texture.screen_right[0] = 0)
SPOIL(screen_flat, p->light.texture.screen_up[0] = 1e6)
SPOIL(screen_edge_on, p->light.direction[1] = 1; p->light.direction[2] = 0)
static void glow(parts *p) {
  p->light.type = HL_LIGHT_RECT;
  p->light.texture.pixels = NULL;
  p->light.emission = (hl_light_emission){"glow.png", p->glow, 2, 2, {0, 0, 1}};
}
SPOIL(emission_width, glow(p); p->light.emission.width = 0)
SPOIL(emission_nan, glow(p); p->glow[5] = NAN)
SPOIL(emission_up, glow(p); p->light.emission.up[2] = 0)
SPOIL(emission_beside_texture, glow(p); p->light.texture.pixels = p->slide; p->light.position[2] = -1)
SPOIL(emission_on_line, glow(p); p->light.edge2[0] = 3; p->light.edge2[1] = 0)
SPOIL(emission_on_point, glow(p); p->light.type = HL_LIGHT_POINT)
SPOIL(emission_on_sharp_light, glow(p); p->light.type = HL_LIGHT_DIRECTIONAL)
SPOIL(volumes_none, p->description.volume_count = 0)
SPOIL(volume_null, p->scene_volume.volume = NULL)
SPOIL(scale_zero, p->scene_volume.scale = 0)
SPOIL(axis_scale_zero, p->scene_volume.axis_scale[1] = 0)
SPOIL(compositing_unknown, p->description.render.compositing = (hl_compositing)2)
SPOIL(exposure_nan, p->description.exposure = NAN)
SPOIL(tone_unknown, p->description.tone = (hl_tone)2)
SPOIL(emission_negative, p->scene_volume.material.emission = -1)
SPOIL(axis_zero, p->scene_volume.rotate_angle_deg = 10; p->scene_volume.rotate_axis[2] = 0)
SPOIL(angle_nan, p->scene_volume.rotate_angle_deg = NAN)
SPOIL(translate_far, p->scene_volume.translate[1] = 1e20)
SPOIL(unit_zero, p->scene_volume.transfer_function.unit_distance = 0)
SPOIL(opacity_unsorted, p->opacity[2].value = 3)
SPOIL(opacity_thrice, p->opacity[1].value = p->opacity[2].value = 0)
SPOIL(opacity_high, p->opacity[3].opacity = 1.5)
SPOIL(opacity_nan, p->opacity[3].value = NAN)
SPOIL(color_unsorted, p->color[1].value = -5)
SPOIL(color_high, p->color[1].color[1] = 128)
SPOIL(shading_unknown, p->scene_volume.shading = (hl_shading)3)
SPOIL(diffuse_negative, p->scene_volume.material.diffuse = -0.7)
SPOIL(shininess_huge, p->scene_volume.material.shininess = 1e9)
SPOIL(attenuation_negative, p->scene_volume.attenuation_color[0] = -1)
SPOIL(clip_inverted, p->scene_volume.clipped = 1; p->scene_volume.clip_min[1] = 2;
      p->scene_volume.clip_max[0] = 1)
SPOIL(shadows_unknown, p->description.render.shadows = HL_SHADOWS_DEFAULT)
SPOIL(samples_zero, p->description.render.light_samples = 0)
SPOIL(spacing_zero, p->description.render.sheet_spacing = 0)
SPOIL(kernel_unknown, p->description.render.kernel = (hl_kernel)4)
SPOIL(resolution_huge, p->description.render.shadow_resolution = 100000)
SPOIL(threads_negative, p->description.render.threads = -2)
SPOIL(size_wrong, p->description.struct_size = 8)

static const refusal refusals[] = {
    {"/image/width: 0 is out of range: give a number of pixels from 1 to 32768", HL_ERROR_INPUT, width_zero},
    {"/image/height: 40000 is out of range: give a number of pixels from 1 to 32768", HL_ERROR_INPUT,
     height_huge},
    {"/image/background/1: 255 is out of range: give linear RGB, each from 0 to 1", HL_ERROR_INPUT,
     background_bright},
    {"/image/background/2: nan is not a number: give linear RGB, each from 0 to 1", HL_ERROR_INPUT,
     background_nan},
    {"/camera/target: is where the eye is: move the target or the position, so that there is a line of sight",
     HL_ERROR_INPUT, eye_at_target},
    {"/camera/position/0: nan is not a number: give a coordinate between -1e15 and 1e15", HL_ERROR_INPUT,
     eye_nan},
    {"/camera/target/2: inf is out of range: give a coordinate between -1e15 and 1e15", HL_ERROR_INPUT,
     target_infinite},
    {"/camera/up: has no length: give the direction as three numbers, not all 0", HL_ERROR_INPUT, up_zero},
    {"/camera/fovy_deg: 0 is out of range: give an angle in degrees, above 0 and below 180", HL_ERROR_INPUT,
     fovy_zero},
    {"/camera/fovy_deg: 180 is out of range: give an angle in degrees, above 0 and below 180", HL_ERROR_INPUT,
     fovy_wide},
    {"/camera/type: 7 is no known choice: use the enumerators of scene.h", HL_ERROR_INPUT, camera_type},
    {"/camera/height: -2 is not above 0: give the picture's height in world units, above 0", HL_ERROR_INPUT,
     height_negative},
    {"/ambient/0: -0.5 is negative: give linear RGB, none below 0", HL_ERROR_INPUT, ambient_negative},
    {"/lights: is null but its count is 1", HL_ERROR_ARGUMENT, lights_null},
    {"/lights: has 1000 entries: at most 256 are allowed", HL_ERROR_INPUT, lights_many},
    {"/lights/0/direction: has no length: give the direction as three numbers, not all 0", HL_ERROR_INPUT,
     light_direction_zero},
    {"/lights/0/angular_diameter_deg: -1 is negative: give an angle in degrees from 0 (a sharp light) to 120",
     HL_ERROR_INPUT, light_diameter},
    {"/lights/0/falloff: inverse_square on a directional light, which is infinitely far: use none, or a "
     "point light",
     HL_ERROR_INPUT, light_falloff},
    {"/lights/0/radius: -1 is negative: give a length in world units, 0 for a point", HL_ERROR_INPUT,
     light_radius},
    {"/lights/0/radius: nan is not a number: give a length in world units, 0 for a point", HL_ERROR_INPUT,
     light_radius_nan},
    {"/lights/0/opening_angle_deg: 180 is out of range: give the cone's full angle in degrees, from 0.01 to "
     "179",
     HL_ERROR_INPUT, spot_wide},
    {"/lights/0/opening_angle_deg: nan is not a number: give the cone's full angle in degrees, from 0.01 to "
     "179",
     HL_ERROR_INPUT, spot_nan},
    {"/lights/0/falloff_angle_deg: 21 is out of range: give the width of the cone's smooth edge in degrees, "
     "from 0 to "
     "half the opening angle",
     HL_ERROR_INPUT, spot_edge},
    {"/lights/0/direction: has no length: give the direction as three numbers, not all 0", HL_ERROR_INPUT,
     spot_direction},
    {"/lights/0/edge2/1: nan is not a number: give a coordinate between -1e15 and 1e15", HL_ERROR_INPUT,
     light_edge},
    {"/lights/0/normal: has no length: give the direction as three numbers, not all 0", HL_ERROR_INPUT,
     light_normal},
    {"/lights/0/radius: -2 is negative: give a length in world units, 0 for a point", HL_ERROR_INPUT,
     light_disk_radius},
    {"/lights/0/vertices: is null but its count is 3", HL_ERROR_ARGUMENT, polygon_null},
    {"/lights/0/vertices: has 2 entries: give three points or more", HL_ERROR_INPUT, polygon_two},
    {"/lights/0/vertices: span no area: move one off the line, or use a rect light with an edge of no length",
     HL_ERROR_INPUT, polygon_line},
    {"/lights/0/vertices: do not lie in one plane: move them, or use several lights", HL_ERROR_INPUT,
     polygon_bent},
    {"/lights/0/vertices: go around an outline that crosses itself: give them in order around it",
     HL_ERROR_INPUT, polygon_crossed},
    {"/lights/0/vertices/1/1: inf is out of range: give a coordinate between -1e15 and 1e15", HL_ERROR_INPUT,
     polygon_infinite},
    {"/lights/0/color/2: -0.1 is negative: give linear RGB, none below 0", HL_ERROR_INPUT, light_color},
    {"/lights/0/intensity: -3 is negative: give a factor, 0 or more", HL_ERROR_INPUT, light_intensity},
    {"/lights/0/shadows: 9 is no known choice: use the enumerators of scene.h", HL_ERROR_INPUT,
     light_shadows},
    {"/lights/0/texture/width: 0 is out of range: give an image of at most 32768 pixels a side, 67108864 in "
     "all",
     HL_ERROR_INPUT, texture_width},
    {"/lights/0/texture/height: 40000 is out of range: give an image of at most 32768 pixels a side, "
     "67108864 in all",
     HL_ERROR_INPUT, texture_height},
    {"/lights/0/texture: has 32768 x 32768 pixels: give an image of at most 32768 pixels a side, 67108864 in "
     "all",
     HL_ERROR_INPUT, texture_vast},
    {"/lights/0/texture/file: pixel (1, 0) has nan in channel 1: give linear RGB from 0 to 1e6",
     HL_ERROR_INPUT, texture_nan},
    {"/lights/0/texture/file: pixel (0, 0) has -1 in channel 2: give linear RGB from 0 to 1e6",
     HL_ERROR_INPUT, texture_negative},
    {"/lights/0/texture/screen/center/1: nan is not a number: give a coordinate between -1e15 and 1e15",
     HL_ERROR_INPUT, screen_nan},
    {"/lights/0/texture/screen/right: has no length: give the direction as three numbers, not all 0",
     HL_ERROR_INPUT, screen_narrow},
    {"/lights/0/texture/screen/up: lies along right: give two directions that span the screen",
     HL_ERROR_INPUT, screen_flat},
    {"/lights/0/texture/screen/center: the light's rays run along the screen, not through it: turn or move "
     "the "
     "screen",
     HL_ERROR_INPUT, screen_edge_on},
    {"/lights/0/emission/width: 0 is out of range: give an image of at most 32768 pixels a side, 67108864 in "
     "all",
     HL_ERROR_INPUT, emission_width},
    {"/lights/0/emission/file: pixel (1, 0) has nan in channel 2: give linear RGB from 0 to 1e6",
     HL_ERROR_INPUT, emission_nan},
    {"/lights/0/emission/up: has no length: give the direction as three numbers, not all 0", HL_ERROR_INPUT,
     emission_up},
    {"/lights/0/emission: is beside a texture: a light has an image of its own or projects one, use two "
     "lights",
     HL_ERROR_INPUT, emission_beside_texture},
    {"/lights/0/emission: is on a light without a surface: give it a radius, an angle or two edges",
     HL_ERROR_INPUT, emission_on_line},
    {"/lights/0/emission: is on a light without a surface: give it a radius, an angle or two edges",
     HL_ERROR_INPUT, emission_on_point},
    {"/lights/0/emission: is on a light without a surface: give it a radius, an angle or two edges",
     HL_ERROR_INPUT, emission_on_sharp_light},
    {"/volumes: is empty: name at least one volume or mesh", HL_ERROR_INPUT, volumes_none},
    {"/volumes/0/volume: is null: give a volume", HL_ERROR_ARGUMENT, volume_null},
    {"/volumes/0/transform/scale: 0 is not above 0: give a factor above 0", HL_ERROR_INPUT, scale_zero},
    {"/render/compositing: 2 is no known choice: use the enumerators of scene.h", HL_ERROR_INPUT,
     compositing_unknown},
    {"/volumes/0/transform/scale/1: 0 is not above 0: give a factor above 0", HL_ERROR_INPUT,
     axis_scale_zero},
    {"/image/exposure: nan is not a number: give stops from -32 to 32: each doubles the light",
     HL_ERROR_INPUT, exposure_nan},
    {"/image/tone: 2 is no known choice: use the enumerators of scene.h", HL_ERROR_INPUT, tone_unknown},
    {"/volumes/0/material/emission: -1 is negative: give the part of the colour that shines by itself, from "
     "0 to 1e6",
     HL_ERROR_INPUT, emission_negative},
    {"/volumes/0/transform/rotate/axis: has no length: give the direction as three numbers, not all 0",
     HL_ERROR_INPUT, axis_zero},
    {"/volumes/0/transform/rotate/angle_deg: nan is not a number: give an angle in degrees", HL_ERROR_INPUT,
     angle_nan},
    {"/volumes/0/transform/translate/1: 1e+20 is out of range: give a coordinate between -1e15 and 1e15",
     HL_ERROR_INPUT, translate_far},
    {"/volumes/0/transfer_function/unit_distance: 0 is not above 0: give the length in world units that the "
     "opacities are for, above 0",
     HL_ERROR_INPUT, unit_zero},
    {"/volumes/0/transfer_function/opacity/2/0: 3 comes after 8: sort the points by value", HL_ERROR_INPUT,
     opacity_unsorted},
    {"/volumes/0/transfer_function/opacity/2/0: 0 is there a third time: two points at one value make a "
     "step, remove the others",
     HL_ERROR_INPUT, opacity_thrice},
    {"/volumes/0/transfer_function/opacity/3/1: 1.5 is out of range: give an opacity from 0 to 1",
     HL_ERROR_INPUT, opacity_high},
    {"/volumes/0/transfer_function/opacity/3/0: nan is not a number: give a data value between -1e30 and "
     "1e30",
     HL_ERROR_INPUT, opacity_nan},
    {"/volumes/0/transfer_function/color/1/0: -5 comes after 0: sort the points by value", HL_ERROR_INPUT,
     color_unsorted},
    {"/volumes/0/transfer_function/color/1/2: 128 is out of range: give linear RGB, each from 0 to 1",
     HL_ERROR_INPUT, color_high},
    {"/volumes/0/shading: 3 is no known choice: use the enumerators of scene.h", HL_ERROR_INPUT,
     shading_unknown},
    {"/volumes/0/material/diffuse: -0.7 is negative: give a factor from 0 to 1000", HL_ERROR_INPUT,
     diffuse_negative},
    {"/volumes/0/material/shininess: 1e+09 is out of range: give an exponent from 0 to 10000", HL_ERROR_INPUT,
     shininess_huge},
    {"/volumes/0/attenuation_color/0: -1 is negative: give relative extinctions from 0 to 1000, 1 for as "
     "much as the opacity says",
     HL_ERROR_INPUT, attenuation_negative},
    {"/volumes/0/clip/max/1: 0 is not above min, 2: nothing would be left, enlarge the box", HL_ERROR_INPUT,
     clip_inverted},
    {"/render/shadows: 0 is no known choice: use the enumerators of scene.h", HL_ERROR_INPUT,
     shadows_unknown},
    {"/render/light_samples: 0 is out of range: give M from 1 to 64, for M x M parts of the light",
     HL_ERROR_INPUT, samples_zero},
    {"/render/sheet_spacing: 0 is out of range: give voxels between sheets, from 0.01 to 100", HL_ERROR_INPUT,
     spacing_zero},
    {"/render/kernel: 4 is no known choice: use the enumerators of scene.h", HL_ERROR_INPUT, kernel_unknown},
    {"/render/shadow_resolution: 100000 is out of range: give pixels from 1 to 16384, or auto",
     HL_ERROR_INPUT, resolution_huge},
    {"/render/threads: -2 is negative: give a number of threads up to 1024, 0 for one per processor",
     HL_ERROR_INPUT, threads_negative},
    {NULL, HL_ERROR_ARGUMENT, size_wrong},
};

static void refuses_with_the_place_and_the_mend(void **state) {
  (void)state;
  for (size_t r = 0; r < sizeof refusals / sizeof *refusals; r++) {
    parts p;
    parts_make(&p);
    refusals[r].spoil(&p);
    hl_error error = {0};
    hl_scene *scene = (hl_scene *)&p;
    assert_int_equal(hl_scene_create(p.context, &p.description, &scene, &error), refusals[r].status);
    assert_null(scene);
    assert_int_equal(error.code, refusals[r].status);
    if (refusals[r].message != NULL) assert_string_equal(error.message, refusals[r].message);
    assert_int_equal(hl_scene_create(p.context, &p.description, &scene, NULL), refusals[r].status);
    parts_release(&p);
  }
}

/* The moments of a rect are known. A polygon with the same outline has the same moments, also with one corner
 * cut in and out again. */
static void shapes_have_their_moments(void **state) {
  (void)state;
  static const double outline[][3] = {{-1, -3, 5}, {3, -3, 5}, {3, 1, 5}, {3, 3, 5}, {-1, 3, 5}};
  static const double notched[][3] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {1, 1, 0}, {0, 1, 0}};
  hl_light rect, polygon;
  hl_light_defaults(&rect);
  rect.type = HL_LIGHT_RECT;
  memcpy(rect.position, (double[3]){1, 0, 5}, sizeof rect.position);
  memcpy(rect.edge1, (double[3]){4, 0, 0}, sizeof rect.edge1);
  memcpy(rect.edge2, (double[3]){0, 6, 0}, sizeof rect.edge2);
  hl_light_defaults(&polygon);
  polygon.type = HL_LIGHT_POLYGON;
  polygon.vertices = outline;
  polygon.vertex_count = 5;
  light_shape box = hl_light_shape(&rect), shape = hl_light_shape(&polygon);
  mat3 a = box.kind->spread(&box, (vec3){0, 0, 1}), b = shape.kind->spread(&shape, (vec3){0, 0, 1});
  vec3 centre = shape.centre;
  assert_near(vec3_length(vec3_subtract(centre, (vec3){1, 0, 5})), 0, 1e-12);
  assert_near(a.row[0].x, 16.0 / 12, 1e-12);
  assert_near(a.row[1].y, 36.0 / 12, 1e-12);
  for (int row = 0; row < 3; row++) assert_near(vec3_length(vec3_subtract(a.row[row], b.row[row])), 0, 1e-12);
  /* for three unit squares, the mean of x is 7/6, of x^2 (1/3 + 7/3 + 7/3) / 3, and of x y (1/4 + 3/4 + 9/4)
   * / 3 */
  polygon.vertices = notched;
  polygon.vertex_count = 6;
  shape = hl_light_shape(&polygon);
  centre = shape.centre;
  b = shape.kind->spread(&shape, (vec3){0, 0, 1});
  assert_near(centre.x, 7.0 / 6, 1e-12);
  assert_near(centre.y, 5.0 / 6, 1e-12);
  assert_near(b.row[0].x, 5.0 / 3 - 49.0 / 36, 1e-12);
  assert_near(b.row[0].y, 13.0 / 12 - 35.0 / 36, 1e-12);
}

/* Two points at one value are a step. The second point holds at the value itself. */
static void transfer_function_closed_forms(void **state) {
  (void)state;
  hl_opacity_point points[] = {{0, 0}, {10, 0}, {10, 0.5}, {20, 1}, {30, 0}, {40, 0}, {40, 0.25}};
  hl_color_point colors[] = {{0, {0, 0, 1}}, {4, {1, 0, 0}}, {4, {0, 1, 0}}, {8, {0, 1, 1}}};
  hl_transfer_function f = {
      .unit_distance = 1, .opacity = points, .opacity_count = 7, .color = colors, .color_count = 4};
  const double expected[][2] = {{-5, 0},   {9.999, 0}, {10, 0.5},  {15, 0.75},  {20, 1},
                                {25, 0.5}, {35, 0},    {40, 0.25}, {1e9, 0.25}, {NAN, 0}};
  for (size_t n = 0; n < sizeof expected / sizeof *expected; n++)
    assert_near(hl_transfer_function_opacity(&f, expected[n][0]), expected[n][1], 1e-12);
  double c[3];
  hl_transfer_function_color(&f, 2, c);
  assert_true(c[0] == 0.5 && c[1] == 0 && c[2] == 0.5);
  hl_transfer_function_color(&f, 4, c);
  assert_true(c[0] == 0 && c[1] == 1 && c[2] == 0);
  hl_transfer_function_color(&f, 6, c);
  assert_true(c[0] == 0 && c[1] == 1 && c[2] == 0.5);
  hl_transfer_function_color(&f, 1e9, c);
  assert_true(c[0] == 0 && c[1] == 1 && c[2] == 1);
  assert_true(!hl_transfer_function_visible(&f, -10, 9.99) && hl_transfer_function_visible(&f, -10, 10));
  assert_true(hl_transfer_function_visible(&f, 5, 35) && !hl_transfer_function_visible(&f, 30, 39));
  assert_true(hl_transfer_function_visible(&f, 30, 40) && !hl_transfer_function_visible(&f, 40, 30));
  f.opacity_count = f.color_count = 0;
  assert_true(hl_transfer_function_opacity(&f, 3) == 0 && !hl_transfer_function_visible(&f, 0, 1));
  hl_transfer_function_color(&f, 3, c);
  assert_true(c[0] == 1 && c[1] == 1 && c[2] == 1);
}

/* On random functions with steps, visible() agrees with a dense sampling of the function. */
static void visible_agrees_with_sampling(void **state) {
  (void)state;
  srand(7);
  for (int trial = 0; trial < 300; trial++) {
    hl_opacity_point points[8];
    double value = 0;
    for (int p = 0; p < 8; p++) {
      points[p] = (hl_opacity_point){value, rand() % 3 == 0 ? rand() % 4 * 0.25 : 0};
      if (p % 2 == 1 || rand() % 2) value += 1 + rand() % 3;
    }
    hl_transfer_function f = {
        .unit_distance = 1, .opacity = points, .opacity_count = 8, .color = NULL, .color_count = 0};
    double low = rand() % 200 * 0.1 - 2, high = low + rand() % 60 * 0.1;
    int found = 0;
    for (int s = 0; s <= 1000; s++)
      found |= hl_transfer_function_opacity(&f, low + (high - low) * s / 1000) > 0;
    for (int p = 0; p < 8; p++)
      found |= points[p].value >= low && points[p].value <= high && points[p].opacity > 0 &&
               hl_transfer_function_opacity(&f, points[p].value) > 0;
    if (found) assert_true(hl_transfer_function_visible(&f, low, high));
    double nearest;
    if (hl_transfer_function_transparent(&f, low, high, (low + high) / 2, &nearest)) {
      assert_true(nearest >= low && nearest <= high && hl_transfer_function_opacity(&f, nearest) == 0);
      for (int s = 0; s <= 1000; s++) {
        double v = low + (high - low) * s / 1000;
        if (hl_transfer_function_opacity(&f, v) == 0)
          assert_true(fabs(v - (low + high) / 2) >= fabs(nearest - (low + high) / 2) - 1e-12);
      }
    } else
      for (int s = 0; s <= 1000; s++)
        assert_true(hl_transfer_function_opacity(&f, low + (high - low) * s / 1000) > 0);
  }
}

static void empty_value_is_the_commonest_transparent_one(void **state) {
  (void)state;
  hl_context *context = make_context();
  float values[64];
  /* air is 0, a wall is 5, and a few voxels have other values */
  for (int v = 0; v < 64; v++) values[v] = v < 40 ? 0.0f : v < 60 ? 5.0f : (float)v;
  hl_volume *volume = make_volume(context, 4, values);
  hl_scene_volume sv;
  hl_scene_volume_defaults(&sv);
  sv.volume = volume;
  hl_opacity_point low[] = {{1, 0}, {2, 1}}, band[] = {{4.5, 1}, {4.9, 0}, {5.1, 0}, {6, 1}},
                   none[] = {{0, 0.5}};
  sv.transfer_function = (hl_transfer_function){.unit_distance = 1, .opacity = low, .opacity_count = 2};
  assert_true(hl_scene_volume_empty_value(&sv) == 0);
  sv.transfer_function = (hl_transfer_function){
      .unit_distance = 1,
      .opacity = band,
      .opacity_count = 4}; /* zero is opaque, so that the wall is the surroundings */
  assert_near(hl_scene_volume_empty_value(&sv), 5, 0.2);
  assert_true(hl_transfer_function_opacity(&sv.transfer_function, hl_scene_volume_empty_value(&sv)) == 0);
  sv.transfer_function = (hl_transfer_function){.unit_distance = 1, .opacity = none, .opacity_count = 1};
  assert_true(hl_scene_volume_empty_value(&sv) < 0);
  hl_volume_release(volume);
  hl_context_destroy(context);
}

/* The three scales stretch the file's own axes, whatever the rotation does with these. */
static void three_scales_come_before_the_rotation(void **state) {
  (void)state;
  parts p;
  parts_make(&p);
  p.scene_volume.scale = 2;
  memcpy(p.scene_volume.axis_scale, (double[3]){1, 3, 0.5}, sizeof p.scene_volume.axis_scale);
  p.scene_volume.rotate_angle_deg = 90; /* turned about z, x becomes y and y becomes -x */
  vec3 world = affine3_apply(hl_scene_volume_index_to_world(&p.scene_volume), (vec3){1, 2, 3});
  assert_near(world.x, -12, 1e-12);
  assert_near(world.y, 2, 1e-12);
  assert_near(world.z, 3, 1e-12);
  hl_scene_volume clipped = p.scene_volume;
  clipped.clipped = 1; /* in the file's world, before the scales */
  for (int a = 0; a < 3; a++) clipped.clip_min[a] = 0.25, clipped.clip_max[a] = 1.5;
  double low[3], high[3];
  hl_scene_volume_box(&clipped, low, high);
  for (int a = 0; a < 3; a++) assert_true(low[a] == 0.25 && high[a] == 1.5);
  parts_release(&p);
}

static void transform_is_scale_then_rotate_then_translate(void **state) {
  (void)state;
  parts p;
  parts_make(&p);
  p.scene_volume.scale = 2;
  p.scene_volume.rotate_angle_deg = 90; /* turned about z, x becomes y */
  p.scene_volume.translate[0] = 10;
  vec3 world = affine3_apply(hl_scene_volume_index_to_world(&p.scene_volume), (vec3){1, 2, 3});
  assert_near(world.x, 10 - 4, 1e-12);
  assert_near(world.y, 2, 1e-12);
  assert_near(world.z, 6, 1e-12);
  double low[3], high[3];
  hl_scene_volume_box(&p.scene_volume, low, high);
  for (int a = 0; a < 3; a++) assert_true(low[a] == -0.5 && high[a] == 2.5);
  p.scene_volume.clipped = 1; /* in the file's world, before the transform */
  for (int a = 0; a < 3; a++)
    p.scene_volume.clip_min[a] = 0.25, p.scene_volume.clip_max[a] = a == 2 ? 100 : 1.5;
  hl_scene_volume_box(&p.scene_volume, low, high);
  assert_true(low[0] == 0.25 && high[0] == 1.5 && low[2] == 0.25 && high[2] == 2.5);
  for (int a = 0; a < 3; a++) p.scene_volume.clip_min[a] = 50, p.scene_volume.clip_max[a] = 60;
  hl_scene_volume_box(&p.scene_volume, low, high);
  assert_true(high[0] - low[0] == 0); /* nothing is left */
  parts_release(&p);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(copies_everything),
      cmocka_unit_test(copies_a_lights_own_image),
      cmocka_unit_test(survives_any_memory_limit),
      cmocka_unit_test(refuses_with_the_place_and_the_mend),
      cmocka_unit_test(shapes_have_their_moments),
      cmocka_unit_test(transfer_function_closed_forms),
      cmocka_unit_test(visible_agrees_with_sampling),
      cmocka_unit_test(empty_value_is_the_commonest_transparent_one),
      cmocka_unit_test(transform_is_scale_then_rotate_then_translate),
      cmocka_unit_test(three_scales_come_before_the_rotation),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
