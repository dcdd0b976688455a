/* from_memory.c - numbers that a program holds become a picture: volume, look, light and camera, all set
 * here.
 *
 *     cc from_memory.c -o from_memory $(pkg-config --cflags --libs halflight) -lm
 *     ./from_memory picture.png
 */
#include <halflight/halflight.h>
#include <math.h>
#include <stdio.h>

enum { SIZE = 96, WIDTH = 480, HEIGHT = 360 }; /* voxels along each side; pixels */

/* Two hot spots: a field as a simulation would leave it in memory, from 0 to about 1. x runs fastest. */
static float field[SIZE][SIZE][SIZE];

static void simulate(void) {
  int i, j, k;
  for (k = 0; k < SIZE; k++)
    for (j = 0; j < SIZE; j++)
      for (i = 0; i < SIZE; i++) {
        double x = (double)i / SIZE, y = (double)j / SIZE, z = (double)k / SIZE;
        double near = pow(x - 0.4, 2) + pow(y - 0.4, 2) + pow(z - 0.4, 2);
        double far = pow(x - 0.65, 2) + pow(y - 0.6, 2) + pow(z - 0.65, 2);
        field[k][j][i] = (float)(exp(-near / 0.02) + 0.7 * exp(-far / 0.01));
      }
}

/* The voxels are borrowed: the array stays the program's, and must live as long as the volume. */
static hl_status make_volume(hl_context *context, hl_volume **volume, hl_error *error) {
  hl_volume_description description;
  int axis;
  hl_volume_description_defaults(&description);
  for (axis = 0; axis < 3; axis++) {
    description.dimensions[axis] = SIZE;
    description.axis[axis][axis] = 0.5; /* half a world unit from voxel to voxel */
  }
  description.type = HL_VOXEL_F32;
  description.voxels = field;
  description.borrow = 1;
  return hl_volume_create(context, &description, volume, error);
}

static hl_status make_scene(hl_context *context, hl_volume *volume, hl_scene **scene, hl_error *error) {
  /* Opacity per world unit, and linear RGB, by the field's value. */
  static const hl_opacity_point opacity[] = {{0.1, 0}, {0.3, 0.05}, {0.6, 0.5}};
  static const hl_color_point color[] = {{0.1, {0.1, 0.2, 0.8}}, {0.4, {0.9, 0.5, 0.1}}, {1, {1, 0.9, 0.6}}};
  hl_scene_volume shown;
  hl_light light;
  hl_scene_description description;

  hl_scene_volume_defaults(&shown);
  shown.volume = volume;
  shown.transfer_function.opacity = opacity;
  shown.transfer_function.opacity_count = sizeof opacity / sizeof opacity[0];
  shown.transfer_function.color = color;
  shown.transfer_function.color_count = sizeof color / sizeof color[0];

  hl_scene_description_defaults(&description);
  description.width = WIDTH;
  description.height = HEIGHT;
  description.volumes = &shown;
  description.volume_count = 1;
  if (hl_camera_frame(&description, 30, 20, 1, &description.camera) != HL_OK) {
    snprintf(error->message, sizeof error->message, "there is nothing to frame");
    return HL_ERROR_ARGUMENT;
  }

  hl_light_defaults(&light);
  hl_light_direction(&description.camera, -40, 45, light.direction); /* from the upper left */
  light.angular_diameter_deg = 10;                                   /* soft shadows */
  description.lights = &light;
  description.light_count = 1;
  return hl_scene_create(context, &description, scene, error); /* copies all but the voxels */
}

int main(int argc, char **argv) {
  hl_error error;
  hl_context *context = NULL;
  hl_volume *volume = NULL;
  hl_scene *scene = NULL;
  hl_renderer *renderer = NULL;
  hl_image *image = NULL;
  int done;
  if (argc != 2) {
    fprintf(stderr, "usage: from_memory PICTURE\n");
    return 2;
  }
  simulate();
  done = hl_context_create(NULL, &context, &error) == HL_OK &&
         make_volume(context, &volume, &error) == HL_OK &&
         make_scene(context, volume, &scene, &error) == HL_OK &&
         hl_renderer_create(context, &renderer, &error) == HL_OK &&
         hl_image_create(context, WIDTH, HEIGHT, &image, &error) == HL_OK &&
         hl_renderer_render(renderer, scene, hl_image_pixels(image), 4 * WIDTH, NULL, &error) == HL_OK &&
         hl_image_write(context, image, argv[1], NULL, &error) == HL_OK;
  if (!done) fprintf(stderr, "from_memory: %s\n", error.message);
  hl_image_destroy(image); /* null is allowed */
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
  hl_volume_release(volume);
  hl_context_destroy(context); /* last: the others were made with it */
  return done ? 0 : 1;
}
