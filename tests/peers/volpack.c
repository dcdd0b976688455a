/* VolPack's shear-warp on the volume of scripts/peers: frames of a turning camera, without and with its hard
 * shadows.
 *
 * usage: volpack VOLUME.raw JOB.txt FRAMES OUT
 *
 * JOB.txt has, as words: the size of the picture, the world height that it shows, the camera's right, up and
 * forward axes, the direction in which light travels, and 256 lines of a value's opacity and colour. Prints
 * JSON; pictures go to OUT-off.rgb and OUT-hard.rgb: bytes of linear red, green and blue, bottom row first,
 * where 255 is a colour of 1 in full light.
 *
 * Colours depend on the value alone, as in the other renderers of the comparison: where VolPack's examples
 * keep the index of a normal, and tables of shaded normals, a voxel has its value again, and tables are of
 * coloured values. */
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <volpack.h>

enum { SIDE = 256, VALUES = 256 };

struct voxel {
  unsigned short shade; /* the value is the index into tables of colours; VolPack needs two bytes for it */
  unsigned char value;
};

struct job {
  int size;
  double height, right[3], up[3], forward[3], light[3];
  float opacity[VALUES], color[VALUES][3], dark[VALUES][3];
};

static void check(vpContext *context, vpResult result, const char *what) {
  if (result == VP_OK) { return; }
  fprintf(stderr, "volpack: %s: %s\n", what, vpGetErrorString(vpGetError(context)));
  exit(1);
}

static double milliseconds(clockid_t clock) {
  struct timespec now;
  clock_gettime(clock, &now);
  return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

static void number(FILE *file, double *value) {
  if (fscanf(file, "%lf", value) != 1) {
    fprintf(stderr, "volpack: the job ends early\n");
    exit(1);
  }
}

static struct job *read_job(const char *path) {
  static struct job job;
  FILE *file = fopen(path, "r");
  if (file == NULL) {
    perror(path);
    exit(1);
  }
  double size;
  number(file, &size);
  job.size = (int)size;
  number(file, &job.height);
  double *axes[] = {job.right, job.up, job.forward, job.light};
  for (int axis = 0; axis < 4; axis++) {
    for (int i = 0; i < 3; i++) { number(file, &axes[axis][i]); }
  }
  for (int value = 0; value < VALUES; value++) {
    double words[4];
    for (int i = 0; i < 4; i++) { number(file, &words[i]); }
    job.opacity[value] = (float)words[0];
    for (int i = 0; i < 3; i++) { job.color[value][i] = (float)(255 * words[1 + i]); }
  }
  fclose(file);
  return &job;
}

static struct voxel *read_volume(const char *path) {
  size_t count = (size_t)SIDE * SIDE * SIDE;
  unsigned char *values = malloc(count);
  struct voxel *voxels = calloc(count, sizeof *voxels);
  FILE *file = fopen(path, "rb");
  if (values == NULL || voxels == NULL || file == NULL || fread(values, 1, count, file) != count) {
    perror(path);
    exit(1);
  }
  for (size_t i = 0; i < count; i++) { voxels[i] = (struct voxel){.shade = values[i], .value = values[i]}; }
  free(values);
  fclose(file);
  return voxels;
}

/* The grid fills the cube from -0.5 to 0.5. VolPack's eye looks along the z of a left-handed frame. */
static void look(vpContext *context, const struct job *job, double turn) {
  double c = cos(turn), s = sin(turn), half = job->height / 2 / SIDE;
  vpMatrix4 view = {{0}};
  for (int i = 0; i < 3; i++) {
    view[0][i] = c * job->right[i] + s * job->forward[i];
    view[1][i] = job->up[i];
    view[2][i] = c * job->forward[i] - s * job->right[i];
  }
  view[3][3] = 1;
  check(context, vpCurrentMatrix(context, VP_MODEL), "matrix");
  check(context, vpIdentityMatrix(context), "matrix");
  check(context, vpCurrentMatrix(context, VP_VIEW), "matrix");
  check(context, vpSetMatrix(context, view), "matrix");
  check(context, vpCurrentMatrix(context, VP_PROJECT), "matrix");
  check(context, vpIdentityMatrix(context), "matrix");
  check(context, vpWindow(context, VP_PARALLEL, -half, half, -half, half, -2, 2), "window");
}

static vpContext *classified(struct job *job, struct voxel *voxels, double *classify_ms) {
  vpContext *context = vpCreateContext();
  check(context, vpSetVolumeSize(context, SIDE, SIDE, SIDE), "volume size");
  int stride = (int)sizeof *voxels;
  check(context, vpSetVoxelSize(context, stride, 2, 1, 1), "voxel size");
  check(context, vpSetVoxelField(context, 0, sizeof voxels->shade, offsetof(struct voxel, shade), VALUES - 1),
        "voxel field");
  check(context, vpSetVoxelField(context, 1, sizeof voxels->value, offsetof(struct voxel, value), VALUES - 1),
        "voxel field");
  check(context,
        vpSetRawVoxels(context, voxels, SIDE * SIDE * SIDE * stride, stride, SIDE * stride,
                       SIDE * SIDE * stride),
        "voxels");
  check(context, vpSetClassifierTable(context, 0, 1, job->opacity, sizeof job->opacity), "opacities");
  check(context, vpSetd(context, VP_MIN_VOXEL_OPACITY, 0.002), "least opacity");
  check(context, vpSetd(context, VP_MAX_RAY_OPACITY, 0.99), "greatest opacity");
  double begin = milliseconds(CLOCK_MONOTONIC);
  check(context, vpClassifyVolume(context), "classifying");
  *classify_ms = milliseconds(CLOCK_MONOTONIC) - begin;
  return context;
}

static void lit(vpContext *context, struct job *job, int shadows) {
  if (!shadows) {
    check(context, vpSetLookupShader(context, 3, 1, 0, &job->color[0][0], sizeof job->color, 0, NULL, 0),
          "colours");
    return;
  }
  check(context,
        vpSetShadowLookupShader(context, 3, 1, 0, &job->dark[0][0], sizeof job->dark, 0, NULL, 0,
                                &job->color[0][0], sizeof job->color),
        "colours");
  check(context, vpSetLight(context, VP_LIGHT0, VP_DIRECTION, job->light[0], job->light[1], job->light[2]),
        "light");
  check(context, vpSetLight(context, VP_LIGHT0, VP_COLOR, 1, 1, 1), "light");
  check(context, vpEnable(context, VP_LIGHT0, 1), "light");
  check(context, vpSeti(context, VP_SHADOW_LIGHT, VP_LIGHT0), "light of shadows");
  check(context, vpEnable(context, VP_SHADOW, 1), "shadows");
}

static double frame(vpContext *context, const struct job *job, double turn) {
  double begin = milliseconds(CLOCK_MONOTONIC);
  look(context, job, turn);
  check(context, vpRenderClassifiedVolume(context), "rendering");
  return milliseconds(CLOCK_MONOTONIC) - begin;
}

static void save(const unsigned char *picture, int size, const char *out, const char *name) {
  char path[4096];
  snprintf(path, sizeof path, "%s-%s.rgb", out, name);
  FILE *file = fopen(path, "wb");
  if (file == NULL || fwrite(picture, 3, (size_t)size * (size_t)size, file) != (size_t)size * (size_t)size) {
    perror(path);
    exit(1);
  }
  fclose(file);
}

int main(int count, char **words) {
  if (count != 5) {
    fprintf(stderr, "usage: volpack VOLUME.raw JOB.txt FRAMES OUT\n");
    return 2;
  }
  struct job *job = read_job(words[2]);
  int frames = atoi(words[3]);
  struct voxel *voxels = read_volume(words[1]);
  unsigned char *picture = calloc((size_t)job->size * (size_t)job->size, 3);
  double classify_ms;
  printf("{");
  for (int shadows = 0; shadows < 2; shadows++) {
    vpContext *context = classified(job, voxels, &classify_ms);
    check(context, vpSetImage(context, picture, job->size, job->size, 3 * job->size, VP_RGB), "picture");
    lit(context, job, shadows);
    double first = frame(context, job, 0);
    save(picture, job->size, words[4], shadows ? "hard" : "off");
    printf("%s\"%s\": {\"first_ms\": %.3f, \"frame_ms\": [", shadows ? ", " : "", shadows ? "hard" : "off",
           first);
    double processor = milliseconds(CLOCK_PROCESS_CPUTIME_ID);
    for (int i = 0; i < frames; i++) {
      printf("%s%.3f", i > 0 ? ", " : "", frame(context, job, 0.02 * (i + 1)));
    }
    printf("], \"processor_ms\": [%.3f]}", (milliseconds(CLOCK_PROCESS_CPUTIME_ID) - processor) / frames);
    vpDestroyContext(context);
  }
  printf(", \"classify_ms\": %.3f}\n", classify_ms);
  free(picture);
  free(voxels);
  return 0;
}
