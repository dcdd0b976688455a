/* render/device_trial.c - see device_trial.h.
 *
 * A driver may compile wrongly, flush small numbers to zero, or round products where it should not. So a
 * device first computes with given numbers, and its results must equal the processor's to the last bit. Then
 * it renders a small picture: a ball in a volume, lit as a medium with hard shadows, and as a surface. */
#include "render/device_trial.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "gpu/gpu.h"
#include "gpu/kernels/trial.h"
#include "render/sweep.h"

enum { NUMBERS = 4096, BALL = 64, PICTURE = 128, BALL_VOXELS = BALL * BALL * BALL };

/* Pseudo-random bits: a linear congruential generator (Knuth's constants), of which the higher bits are used.
 */
static uint32_t next_bits(uint64_t *state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (uint32_t)(*state >> 32);
}

/* A finite float. The numbers have all magnitudes, subnormal ones included; every fourth number is near 1. */
static float next_number(uint64_t *state, int index) {
  uint32_t bits = next_bits(state);
  if (index % 4 == 0) bits = (bits & 0x807fffffu) | (120 + (bits >> 23 & 15)) << 23;
  if ((bits >> 23 & 255) == 255) bits &= 0xbfffffffu;
  float number;
  memcpy(&number, &bits, sizeof number);
  return number;
}

/* two NaN count as equal, whatever their bits are */
static bool same_number(float a, float b) { return memcmp(&a, &b, sizeof a) == 0 || (a != a && b != b); }

static bool compare_numbers(const float *numbers, const float *results, char *problem, const char *name) {
  for (int i = 0; i < NUMBERS; i++) {
    const float *of = numbers + 3 * i;
    float expected[TRIAL_RESULTS];
    try_numbers(of[0], of[1], of[2], expected);
    for (int r = 0; r < TRIAL_RESULTS; r++)
      if (!same_number(expected[r], results[i * TRIAL_RESULTS + r])) {
        snprintf(problem, GPU_PROBLEM_BYTES,
                 "%s computes otherwise than the processor: operation %d of %a, %a and %a gives %a, not %a",
                 name, r, (double)of[0], (double)of[1], (double)of[2], (double)results[i * TRIAL_RESULTS + r],
                 (double)expected[r]);
        return false;
      }
  }
  return true;
}

static bool try_arithmetic(hl_renderer *renderer, char *problem) {
  float *numbers = hl_allocate(renderer->context, NUMBERS * (3 + TRIAL_RESULTS), sizeof *numbers);
  if (numbers == NULL) return snprintf(problem, GPU_PROBLEM_BYTES, "no memory is left"), false;
  float *results = numbers + 3 * NUMBERS;
  uint64_t state = 1;
  for (int i = 0; i < 3 * NUMBERS; i++) numbers[i] = next_number(&state, i);
  bool passes = hl_gpu_try(renderer->device.gpu, numbers, NUMBERS, results, TRIAL_RESULTS);
  if (!passes) snprintf(problem, GPU_PROBLEM_BYTES, "%s", hl_gpu_problem(renderer->device.gpu));
  else passes = compare_numbers(numbers, results, problem, hl_gpu_device(renderer->device.gpu)->info.name);
  hl_release(renderer->context, numbers);
  return passes;
}

/* ---- the small picture ---- */

/* A ball with a soft edge, and coarse grains in it. */
static void fill_ball(uint8_t *voxels) {
  uint64_t state = 7;
  for (int z = 0; z < BALL; z++)
    for (int y = 0; y < BALL; y++)
      for (int x = 0; x < BALL; x++) {
        int a = 2 * x - BALL + 1, b = 2 * y - BALL + 1, c = 2 * z - BALL + 1;
        int left = 56 * 56 - (a * a + b * b + c * c);
        *voxels++ = (uint8_t)(left <= 0 ? 0
                                        : (left > 1600 ? 160 : left / 10) + (int)(next_bits(&state) >> 27));
      }
}

static hl_status make_scene(hl_context *context, hl_volume *volume, bool surface, hl_scene **scene,
                            hl_error *error) {
  const hl_opacity_point opacity[] = {{20, 0}, {120, 0.05}, {190, 0.4}};
  const hl_color_point color[] = {{20, {0.9, 0.3, 0.2}}, {150, {0.3, 0.8, 0.4}}, {190, {0.9, 0.9, 1}}};
  hl_scene_description description;
  hl_scene_volume shown;
  hl_light light;
  hl_scene_description_defaults(&description);
  hl_scene_volume_defaults(&shown);
  hl_light_defaults(&light);
  shown.volume = volume;
  shown.transfer_function = (hl_transfer_function){
      .unit_distance = 1, .opacity = opacity, .opacity_count = 3, .color = color, .color_count = 3};
  shown.shading = surface ? HL_SHADING_PHONG : HL_SHADING_NONE;
  light.type = HL_LIGHT_DIRECTIONAL;
  light.shadows = surface ? HL_SHADOWS_OFF : HL_SHADOWS_HARD;
  const double direction[3] = {0.4, -0.8, -0.45}, position[3] = {70, 50, 120};
  memcpy(light.direction, direction, sizeof direction);
  memcpy(description.camera.position, position, sizeof position);
  description.camera.type = HL_CAMERA_PERSPECTIVE;
  description.width = description.height = PICTURE;
  description.volumes = &shown;
  description.volume_count = 1;
  description.lights = &light;
  description.light_count = 1;
  description.render.shadows = light.shadows;
  description.render.sheet_spacing = 1;
  return hl_scene_create(context, &description, scene, error);
}

/* Renders a picture for the trial, on the owner's device if on_device is set, else on the processors. */
static hl_status render(hl_renderer *owner, bool on_device, const hl_scene *scene, int frames, float *pixels,
                        hl_render_statistics *statistics, hl_error *error) {
  hl_renderer *renderer = NULL;
  hl_status status = hl_renderer_create(owner->context, &renderer, error);
  if (status != HL_OK) return status;
  renderer->device.tried = true;
  renderer->device.gpu = on_device ? owner->device.gpu : NULL;
  if (renderer->device.gpu != NULL) hl_gpu_forget(renderer->device.gpu);
  for (int i = 0; i < frames && status == HL_OK; i++)
    status = hl_renderer_render(renderer, scene, pixels, 4 * PICTURE, statistics, error);
  if (on_device) owner->device.gpu = renderer->device.gpu; /* null if the device failed */
  if (on_device && renderer->device.gpu == NULL && status == HL_OK)
    status = hl_fail(error, HL_ERROR_UNSUPPORTED, "%s", renderer->device.problem);
  renderer->device.gpu = NULL;
  hl_renderer_destroy(renderer);
  if (owner->device.gpu != NULL) hl_gpu_forget(owner->device.gpu);
  return status;
}

/* Renders the trial's picture on the device and on the processors, and compares the bytes. faster: the device
 * must also take less time than the processors for its second frame. */
static bool try_picture(hl_renderer *renderer, hl_volume *volume, bool surface, bool faster, float *pixels,
                        char *problem) {
  enum { FLOATS = PICTURE * PICTURE * 4 };
  hl_scene *scene = NULL;
  hl_error error = {0};
  hl_render_statistics own = {.struct_size = sizeof own}, device = {.struct_size = sizeof device};
  hl_status status = make_scene(renderer->context, volume, surface, &scene, &error);
  if (status == HL_OK) status = render(renderer, false, scene, faster ? 2 : 1, pixels, &own, &error);
  if (status == HL_OK)
    status = render(renderer, true, scene, faster ? 2 : 1, pixels + FLOATS, &device, &error);
  hl_scene_release(scene);
  if (status != HL_OK) return snprintf(problem, GPU_PROBLEM_BYTES, "%.390s", error.message), false;
  if (memcmp(pixels, pixels + FLOATS, FLOATS * sizeof *pixels) != 0) {
    snprintf(problem, GPU_PROBLEM_BYTES, "%s makes another picture than the processors", device.device);
    return false;
  }
  if (!faster || device.seconds_render < own.seconds_render) return true;
  snprintf(problem, GPU_PROBLEM_BYTES, "%s takes %.3g ms for a small picture, the processors %.3g",
           device.device, device.seconds_render * 1000, own.seconds_render * 1000);
  return false;
}

static bool try_pictures(hl_renderer *renderer, bool faster, char *problem) {
  hl_context *context = renderer->context;
  hl_volume_description description;
  hl_volume *volume = NULL;
  hl_error error = {0};
  uint8_t *voxels = hl_allocate(context, BALL_VOXELS, 1);
  float *pixels = hl_allocate(context, 2 * PICTURE * PICTURE * 4, sizeof *pixels);
  hl_volume_description_defaults(&description);
  description.type = HL_VOXEL_U8;
  for (int axis = 0; axis < 3; axis++) description.dimensions[axis] = BALL;
  description.voxels = voxels;
  bool passes = voxels != NULL && pixels != NULL;
  if (passes) fill_ball(voxels);
  passes = passes && hl_volume_create(context, &description, &volume, &error) == HL_OK;
  if (!passes) snprintf(problem, GPU_PROBLEM_BYTES, "no memory is left for the device's trial");
  passes = passes && try_picture(renderer, volume, false, faster, pixels, problem) &&
           try_picture(renderer, volume, true, false, pixels, problem);
  hl_volume_release(volume);
  hl_release(context, voxels);
  hl_release(context, pixels);
  return passes;
}

bool hl_device_passes(hl_renderer *renderer, bool faster, char *problem) {
  return try_arithmetic(renderer, problem) && try_pictures(renderer, faster, problem);
}
