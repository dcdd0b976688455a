/* golden/volumes.c - see volumes.h. Only exact arithmetic and sqrt: the voxels are the same on every
 * machine. */
#include "volumes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static double clamp(double value) { return value < 0 ? 0 : value > 1 ? 1 : value; }

static double distance(double x, double y, double z) { return sqrt(x * x + y * y + z * z); }

static bool write_file(const char *folder, const char *name, const char *header, const void *data,
                       size_t length) {
  char path[1000];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *file = fopen(path, "wb");
  if (file == NULL) return false;
  bool written = fwrite(header, 1, strlen(header), file) == strlen(header) &&
                 fwrite(data, 1, length, file) == length;
  return fclose(file) == 0 && written;
}

static bool write_ball(const char *folder) {
  enum { N = 24 };
  static unsigned char voxels[N][N][N];
  for (int k = 0; k < N; k++)
    for (int j = 0; j < N; j++)
      for (int i = 0; i < N; i++)
        voxels[k][j][i] = (unsigned char)(255 * clamp((10 - distance(i - 11.5, j - 11.5, k - 11.5)) / 4) +
                                          0.5);
  return write_file(folder, "ball_24x24x24_uint8.raw", "", voxels, sizeof voxels);
}

static bool write_stage(const char *folder) {
  enum { N = 32 };
  static unsigned char voxels[N][N][N];
  for (int k = 0; k < N; k++)
    for (int j = 0; j < N; j++)
      for (int i = 0; i < N; i++) {
        unsigned char value = k >= 2 && k <= 5 && i > 0 && j > 0 && i < N - 1 && j < N - 1 ? 80 : 0;
        if (distance(i - 12, j - 18, k - 20) < 6) value = 160;
        if (i >= 22 && i <= 25 && j >= 8 && j <= 11 && k >= 2 && k <= 24) value = 240;
        voxels[k][j][i] = value;
      }
  return write_file(folder, "stage_32x32x32_uint8.raw", "", voxels, sizeof voxels);
}

/* A smooth wave of period 1 from 0 to 1: two parabolas. */
static double wave(double t) {
  double phase = t - floor(t), half = phase < 0.5 ? phase * 2 : phase * 2 - 1, bow = 4 * half * (1 - half);
  return phase < 0.5 ? 0.5 + bow / 2 : 0.5 - bow / 2;
}

static bool write_waves(const char *folder) {
  enum { NI = 26, NJ = 22, NK = 18 };
  static float voxels[NK][NJ][NI];
  for (int k = 0; k < NK; k++)
    for (int j = 0; j < NJ; j++)
      for (int i = 0; i < NI; i++) {
        double u = (i + 0.5) / NI, v = (j + 0.5) / NJ, w = (k + 0.5) / NK;
        double inside = 64 * u * (1 - u) * v * (1 - v) * w * (1 - w);
        voxels[k][j][i] = (float)(inside * wave(2 * u + v) * (0.4 + 0.6 * wave(2 * w + u + 0.3)));
      }
  return write_file(folder, "waves.nrrd",
                    "NRRD0005\ntype: float\ndimension: 3\nspace dimension: 3\nsizes: 26 22 18\n"
                    "space directions: (0.9,0.2,0) (-0.3,1.1,0.1) (0,-0.2,1.6)\nspace origin: (-8,-11,-13)\n"
                    "endian: little\nencoding: raw\n\n",
                    voxels, sizeof voxels);
}

bool volumes_write(const char *folder) {
  return write_ball(folder) && write_stage(folder) && write_waves(folder);
}
