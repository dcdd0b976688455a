/* tests/unit/scene_exposure.c - the brightness of bare volumes: the fit of lights, of skies and of cut faces.
 */
#include "guess/exposure.h"
#include "looks_volumes.h"
#include "scene_parts.h"

/* A ball whose values rise evenly towards its middle, 10 a voxel. */
static double cone(int i, int j, int k) { return fmax(0, 10 * (20 - distance(i, j, k, 24, 24, 24))); }

/* A scene of a volume with values[], as a whole in view. Opacities rise from 0 at `clear` to `most` at 200.
 */
static hl_volume *ball_scene(hl_context *context, double clear, double most, parts *p) {
  parts_make(p);
  hl_volume *volume = make_volume(context, N, values);
  p->opacity[0] = (hl_opacity_point){clear, 0};
  p->opacity[1] = (hl_opacity_point){200, most};
  p->scene_volume.volume = volume;
  p->scene_volume.transfer_function.unit_distance = 1;
  p->scene_volume.transfer_function.opacity_count = 2;
  p->scene_volume.transfer_function.color_count = 1;
  p->scene_volume.material = (hl_material){.ambient = 1, .diffuse = 1};
  p->scene_volume.clipped = 0;
  memset(&p->light.texture, 0, sizeof p->light.texture);
  assert_int_equal(hl_camera_frame(&p->description, 30, 20, 1, &p->description.camera), HL_OK);
  return volume;
}

/* The optical depth from the place where values are `clear` to a place t voxels farther on. Values rise by 10
 * a voxel, and the opacity is r v for a value that is v above `clear`. The integral of -ln(1 - r v) dv is ((1
 * - r v) ln(1 - r v) + r v) / r (derived). */
static double optical_depth(double clear, double most, double t) {
  double rate = most / (200 - clear), left = 1 - rate * 10 * t;
  return (left * log(left) + 1 - left) / rate / 10;
}

/* Steep functions have thin surfaces. The optical depth of 1 begins and ends within their thickness. */
static void surfaces_are_measured(void **state) {
  (void)state;
  static const double cases[][2] = {{20, 0.9}, {60, 0.9}, {100, 0.97}, {20, 0.5}};
  hl_context *context = make_context();
  fill(cone);
  for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
    parts p;
    hl_exposure exposure = {0, 0};
    hl_volume *volume = ball_scene(context, cases[n][0], cases[n][1], &p);
    assert_int_equal(hl_scene_exposure(&p.description, 0, 1, &exposure, NULL), HL_OK);
    double depth = optical_depth(cases[n][0], cases[n][1], exposure.thickness);
    if (!(fabs(depth - 1) < 0.06)) fail_msg("case %zu: %g, depth %g", n, exposure.thickness, depth);
    hl_volume_release(volume);
    hl_volume_release(p.volume);
    hl_context_destroy(p.context);
  }
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* A matt ball in the light of a lamp at the eye has the brightness of its colour in its middle. The factor is
 * 0.871 (240 of 255) divided by colour times intensity. Ambient light is added, and the lamp's light is less
 * by it. */
static void lights_are_fitted(void **state) {
  (void)state;
  hl_context *context = make_context();
  fill(ball_of_bytes);
  parts p;
  hl_volume *volume = ball_scene(context, 60, 0.9, &p);
  hl_light_direction(&p.description.camera, 0, 0, p.light.direction);
  static const struct {
    double color, intensity, ambient, left, factor;
  } cases[] = {{1, 1, 0, 1, 0.871},   {0.5, 1, 0, 1, 1.742}, {0.5, 2, 0, 1, 0.871},
               {0.5, 1, 1, 1, 0.871}, {1, 1, 0, 0.5, 0.871}, {0.1, 1, 0, 1, 2}};
  for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
    hl_exposure exposure = {0, 0};
    for (int c = 0; c < 3; c++)
      p.color[0].color[c] = cases[n].color, p.description.ambient[c] = cases[n].ambient;
    p.light.intensity = cases[n].intensity;
    assert_int_equal(hl_scene_exposure(&p.description, 0, cases[n].left, &exposure, NULL), HL_OK);
    if (fabs(exposure.factor / cases[n].factor - 1) > 0.04)
      fail_msg("case %zu: %g in place of %g", n, exposure.factor, cases[n].factor);
  }
  hl_volume_release(volume);
  hl_volume_release(p.volume);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
  hl_context_destroy(p.context);
}

/* The same under a sky alone. A sky that shines from a zenith behind the eye lights the ball's middle by 2/3
 * of its radiance, which is the mean of the sine weighted by the cosine. An even sky lights the whole ball
 * by 1. The light that matter leaves does not matter here, since the sky's light is the light at the ball's
 * outside. */
static void skies_are_fitted(void **state) {
  (void)state;
  static const struct {
    double zenith, horizon, ground, color, left, factor;
  } cases[] = {{2, 0, 0, 0.5, 1, 1.307}, {1, 1, 1, 0.9, 1, 0.968}, {1, 1, 1, 0.9, 0.5, 0.968}};
  hl_context *context = make_context();
  fill(ball_of_bytes);
  parts p;
  hl_volume *volume = ball_scene(context, 60, 0.9, &p);
  hl_sky *sky = &p.description.sky;
  sky->type = HL_SKY_GRADIENT;
  p.description.light_count = 0;
  for (int c = 0; c < 3; c++) {
    sky->up[c] = p.description.camera.position[c] - p.description.camera.target[c];
    p.description.ambient[c] = 0;
  }
  for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
    hl_exposure exposure = {0, 0};
    for (int c = 0; c < 3; c++) {
      p.color[0].color[c] = cases[n].color;
      sky->zenith[c] = cases[n].zenith, sky->horizon[c] = cases[n].horizon, sky->ground[c] = cases[n].ground;
    }
    assert_int_equal(hl_scene_exposure(&p.description, 0, cases[n].left, &exposure, NULL), HL_OK);
    if (fabs(exposure.factor / cases[n].factor - 1) > 0.04)
      fail_msg("case %zu: %g in place of %g", n, exposure.factor, cases[n].factor);
  }
  hl_volume_release(volume);
  hl_volume_release(p.volume);
  hl_context_destroy(context);
  hl_context_destroy(p.context);
}

/* A ball that is cut through its middle turns the face to the eye, in the light of a lamp at the eye or at an
 * angle of 45 degrees. The eye's ray meets .99 of the face's opacity in two steps. That part sends its colour
 * times the cosine of the angle, times 0.8 for the light that is lost on the way to the matter. The rest has
 * no normal. A clip box leaves the same face as a plane. */
static void cut_faces_are_fitted(void **state) {
  (void)state;
  static const double azimuths[] = {0, 45}, factors[] = {0.871, 1.223};
  hl_context *context = make_context();
  fill(ball_of_bytes);
  parts p;
  hl_exposure exposure[3];
  hl_volume *volume = ball_scene(context, 60, 0.9, &p);
  const hl_camera *camera = &p.description.camera;
  hl_cut plane = {.type = HL_CUT_PLANE, .point = {24, 24, 24}};
  p.scene_volume.cuts = &plane;
  p.scene_volume.cut_count = 1;
  for (int c = 0; c < 3; c++) {
    p.color[0].color[c] = 1;
    p.description.ambient[c] = 0;
    plane.normal[c] = camera->position[c] - camera->target[c];
  }
  for (int n = 0; n < 2; n++) {
    hl_light_direction(camera, azimuths[n], 0, p.light.direction);
    assert_int_equal(hl_scene_exposure(&p.description, 0, 1, &exposure[n], NULL), HL_OK);
    if (fabs(exposure[n].factor / factors[n] - 1) > 0.04)
      fail_msg("%g degrees: %g in place of %g", azimuths[n], exposure[n].factor, factors[n]);
  }
  /* the face of the clip box, seen and lit from above; matter that is cut away takes no light from it */
  assert_int_equal(hl_camera_frame(&p.description, 30, 80, 1, &p.description.camera), HL_OK);
  hl_light_direction(camera, 0, 0, p.light.direction);
  for (int by_clip = 0; by_clip < 2; by_clip++) {
    memcpy(plane.normal, (double[3]){0, 0, 1}, sizeof plane.normal);
    p.scene_volume.cut_count = by_clip ? 0 : 1;
    p.scene_volume.clipped = by_clip;
    for (int a = 0; a < 3; a++)
      p.scene_volume.clip_min[a] = -1, p.scene_volume.clip_max[a] = a == 2 ? 24 : 48;
    assert_int_equal(hl_scene_exposure(&p.description, 0, 1, &exposure[by_clip], NULL), HL_OK);
  }
  assert_true(fabs(exposure[0].factor / exposure[1].factor - 1) < 0.02);
  p.scene_volume.cut_count = 0;
  hl_volume_release(volume);
  hl_volume_release(p.volume);
  hl_context_destroy(context);
  hl_context_destroy(p.context);
}

/* A bare volume stands under a sky whose zenith is the camera's up. With a tight memory limit, the same
 * lights shine, with constant light in place of the sky. */
static void volumes_stand_under_a_sky(void **state) {
  (void)state;
  hl_context_options options;
  hl_context *context = make_context(), *tight = NULL;
  hl_context_options_defaults(&options);
  options.memory_limit = 300u << 20;
  assert_int_equal(hl_context_create(&options, &tight, NULL), HL_OK);
  fill(body);
  hl_volume *volume = make_volume(context, N, values), *other = make_volume(tight, N, values);
  hl_scene *scene = NULL, *without = NULL;
  assert_int_equal(hl_scene_for_volume(context, volume, NULL, &scene, NULL), HL_OK);
  assert_int_equal(hl_scene_for_volume(tight, other, NULL, &without, NULL), HL_OK);
  const hl_scene_description *a = hl_scene_describe(scene), *b = hl_scene_describe(without);
  assert_int_equal(a->sky.type, HL_SKY_GRADIENT);
  assert_memory_equal(a->sky.up, a->camera.up, sizeof a->sky.up);
  assert_true(a->sky.strength > 0.25 && a->sky.zenith[1] > 4 * a->sky.ground[1]);
  assert_int_equal(b->sky.type, HL_SKY_NONE);
  assert_true(b->ambient[0] > 4 * a->ambient[0] && a->ambient[0] > 0);
  assert_int_equal(a->light_count, b->light_count);
  for (size_t l = 0; l < a->light_count; l++) assert_true(a->lights[l].intensity == b->lights[l].intensity);
  hl_scene_release(scene);
  hl_scene_release(without);
  hl_volume_release(volume);
  hl_volume_release(other);
  hl_context_destroy(context);
  hl_context_destroy(tight);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(surfaces_are_measured),     cmocka_unit_test(lights_are_fitted),
      cmocka_unit_test(skies_are_fitted),          cmocka_unit_test(cut_faces_are_fitted),
      cmocka_unit_test(volumes_stand_under_a_sky),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
