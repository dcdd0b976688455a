/* over_ranks.c - a field that lies in blocks in the memory of many processes becomes a picture, where it is.
 *
 *     cc over_ranks.c -o over_ranks $(pkg-config --cflags --libs halflight) -lm
 *     mpirun -n 8 ./over_ranks picture.png
 *
 * A simulation that has started MPI itself (with MPI_THREAD_MULTIPLE) gives hl_ranks_join() its communicator
 * in place of NULL, as (void *)(intptr_t)comm, and calls MPI_Abort() in place of hl_ranks_abort(). It sets no
 * library: the one that it is linked to is used.
 */
#include <halflight/halflight.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 96, GHOST = 1, WIDTH = 480, HEIGHT = 360 }; /* voxels along each side; of ghosts; pixels */

/* Which voxels a rank holds: slices of the whole, as a simulation in one dimension of blocks has them. */
typedef struct part {
  size_t first, count; /* slices */
  double *values;      /* owned; [count + 2 GHOST][SIZE + 2 GHOST][SIZE + 2 GHOST] */
} part;

static void choose_slices(const hl_ranks *ranks, part *own) {
  size_t rank = (size_t)hl_ranks_rank(ranks), size = (size_t)hl_ranks_size(ranks);
  own->first = SIZE * rank / size;
  own->count = SIZE * (rank + 1) / size - own->first;
}

/* Two hot spots, from 0 to about 1; ghosts stay as the simulation left them. */
static int simulate(part *own) {
  const size_t side = SIZE + 2 * GHOST;
  size_t i, j, k;
  own->values = (double *)calloc((own->count + 2 * GHOST) * side * side, sizeof *own->values);
  if (own->values == NULL) return 0;
  for (k = 0; k < own->count; k++)
    for (j = 0; j < SIZE; j++)
      for (i = 0; i < SIZE; i++) {
        double x = (double)i / SIZE, y = (double)j / SIZE, z = (double)(own->first + k) / SIZE;
        double near = pow(x - 0.4, 2) + pow(y - 0.4, 2) + pow(z - 0.4, 2);
        double far = pow(x - 0.65, 2) + pow(y - 0.6, 2) + pow(z - 0.65, 2);
        own->values[((k + GHOST) * side + j + GHOST) * side + i + GHOST] = exp(-near / 0.02) +
                                                                           0.7 * exp(-far / 0.01);
      }
  return 1;
}

/* The values are not copied: they stay the program's, and must stay as they are while the volume lives. */
static hl_status make_volume(hl_ranks *ranks, const part *own, hl_volume **volume, hl_error *error) {
  hl_volume_description whole;
  hl_block block;
  int axis;
  hl_volume_description_defaults(&whole);
  whole.type = HL_VOXEL_F64;
  memset(&block, 0, sizeof block);
  block.struct_size = sizeof block;
  block.voxels = own->values;
  block.offset[2] = own->first;
  for (axis = 0; axis < 3; axis++) {
    whole.dimensions[axis] = SIZE;
    whole.axis[axis][axis] = 0.5; /* half a world unit from voxel to voxel */
    block.size[axis] = SIZE;
    block.ghost[axis] = GHOST;
  }
  block.size[2] = own->count;
  return hl_volume_create_over_ranks(ranks, &whole, &block, volume, error);
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
  return hl_scene_create(context, &description, scene, error);
}

/* Each rank renders its own strips of the picture; rank 0 gets and writes their sum. */
static hl_status make_picture(hl_context *context, hl_ranks *ranks, const hl_scene *scene, const char *path,
                              hl_error *error) {
  hl_renderer *renderer = NULL;
  hl_image *image = NULL;
  hl_status status = hl_renderer_create(context, &renderer, error);
  if (status == HL_OK)
    status = hl_renderer_share(renderer, hl_ranks_rank(ranks), hl_ranks_size(ranks), error);
  if (status == HL_OK) status = hl_image_create(context, WIDTH, HEIGHT, &image, error);
  if (status == HL_OK)
    status = hl_renderer_render(renderer, scene, hl_image_pixels(image), 4 * WIDTH, NULL, error);
  if (status == HL_OK) hl_ranks_sum(ranks, hl_image_pixels(image), (size_t)4 * WIDTH * HEIGHT);
  if (status == HL_OK && hl_ranks_rank(ranks) == 0)
    status = hl_image_write(context, image, path, NULL, error);
  hl_image_destroy(image);
  hl_renderer_destroy(renderer);
  return status;
}

int main(int argc, char **argv) {
  hl_error error;
  hl_context_options options;
  hl_context *context = NULL;
  hl_ranks *ranks = NULL;
  hl_volume *volume = NULL;
  hl_scene *scene = NULL;
  part own;
  int done;
  if (argc != 2) {
    fprintf(stderr, "usage: over_ranks PICTURE\n");
    return 2;
  }
  own.values = NULL;
  snprintf(error.message, sizeof error.message, "out of memory");
  hl_context_options_defaults(&options);
  if (getenv("PMI_SIZE") != NULL) options.mpi = HL_MPI_MPICH; /* MPICH's mpirun has set it, or a relative's */
  done = hl_context_create(&options, &context, &error) == HL_OK &&
         hl_ranks_join(context, NULL, &ranks, &error) == HL_OK;
  if (done) choose_slices(ranks, &own);
  done = done && simulate(&own) && make_volume(ranks, &own, &volume, &error) == HL_OK &&
         make_scene(context, volume, &scene, &error) == HL_OK &&
         make_picture(context, ranks, scene, argv[1], &error) == HL_OK;
  if (!done) {
    fprintf(stderr, "over_ranks: %s\n", error.message);
    hl_ranks_abort(ranks, 1); /* the others may wait for this rank */
  }
  hl_scene_release(scene);
  hl_volume_release(volume); /* on all ranks: others may need this rank's block until then */
  hl_ranks_leave(ranks);
  hl_context_destroy(context);
  free(own.values);
  return done ? 0 : 1;
}
