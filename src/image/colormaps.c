/* image/colormaps.c - defines the named colormaps by sRGB tables, and finds the linear colours between the
 * tables' entries.
 *
 * Sources: viridis, inferno, magma and plasma by N. Smith, S. van der Walt and E. Firing (released to the
 * public domain, CC0); cividis by J. Nunez, C. Anderton and R. Renslow (2018); coolwarm by K. Moreland
 * (2009); each of these colormaps is given here by 33 equally spaced entries. The colormap turbo is A.
 * Mikhailov's polynomial (2019). The colormaps bone, hot and copper are the classic piecewise linear maps,
 * given by their corners. */
#include "image/colormaps.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include <halflight/scene.h>

#include "image/srgb.h"

#define EQUAL_STEPS 33

/* the entries of a colormap: sRGB, 0xRRGGBB */
static const struct {
  const char *name;
  unsigned int color[EQUAL_STEPS];
} tables[] = {
    {"viridis", {0x440154, 0x470d60, 0x48186a, 0x482374, 0x472d7b, 0x453681, 0x424086, 0x3f4989, 0x3b528b,
                 0x375a8d, 0x33638d, 0x2f6a8e, 0x2c728e, 0x297a8e, 0x26818e, 0x23898e, 0x21908c, 0x1f988b,
                 0x1f9f88, 0x21a685, 0x28ae80, 0x31b57b, 0x3ebc74, 0x4cc26c, 0x5dc963, 0x6ece58, 0x82d34c,
                 0x96d83f, 0xabdc32, 0xc0df24, 0xd5e21a, 0xeae51a, 0xfde725}},
    {"inferno", {0x000004, 0x040312, 0x0b0724, 0x150b37, 0x210c4a, 0x2e0a5a, 0x3c0965, 0x4a0c6b, 0x57106d,
                 0x63146e, 0x70196e, 0x7d1e6d, 0x89226a, 0x962766, 0xa32b61, 0xaf315c, 0xbb3755, 0xc63e4d,
                 0xd14644, 0xdb4f3b, 0xe35932, 0xeb6528, 0xf1711e, 0xf67f14, 0xf98d0a, 0xfb9c06, 0xfcab0f,
                 0xfbba1f, 0xf9ca32, 0xf5d949, 0xf2e865, 0xf3f586, 0xfcffa4}},
    {"magma", {0x000004, 0x030311, 0x0a0822, 0x130d33, 0x1d1146, 0x28115a, 0x36106a, 0x430f76, 0x50127c,
               0x5d177f, 0x691c81, 0x762181, 0x822681, 0x8f2a81, 0x9c2e7f, 0xa9327d, 0xb63779, 0xc33b75,
               0xcf4170, 0xdb486a, 0xe65163, 0xee5c5e, 0xf5695c, 0xf9785d, 0xfb8761, 0xfd9668, 0xfea571,
               0xfeb47b, 0xfec387, 0xfed194, 0xfde0a2, 0xfceeb0, 0xfcfdbf}},
    {"plasma", {0x0d0887, 0x220690, 0x310596, 0x3f049c, 0x4c02a1, 0x5901a5, 0x6600a7, 0x7201a8, 0x7e03a8,
                0x8909a6, 0x9511a2, 0x9f1a9c, 0xa92396, 0xb22c8e, 0xbb3587, 0xc33e80, 0xcb4778, 0xd25071,
                0xd9596a, 0xe06263, 0xe66c5c, 0xeb7555, 0xf07f4f, 0xf48a48, 0xf89441, 0xfb9f3a, 0xfdab33,
                0xfeb72d, 0xfdc328, 0xfcd025, 0xf9dd25, 0xf5eb27, 0xf0f921}},
    {"cividis", {0x00224e, 0x00285b, 0x002e6a, 0x043371, 0x1a386f, 0x273e6e, 0x32436d, 0x3b496c, 0x434e6c,
                 0x4b546c, 0x52596d, 0x5a5f6e, 0x61656f, 0x686a71, 0x6f7073, 0x757676, 0x7c7b78, 0x848179,
                 0x8b8778, 0x938d78, 0x9b9376, 0xa39a75, 0xaba072, 0xb3a670, 0xbbad6c, 0xc3b469, 0xccba64,
                 0xd4c15f, 0xddc958, 0xe6d051, 0xefd748, 0xf8df3c, 0xfee838}},
    {"coolwarm", {0x3b4cc0, 0x445acc, 0x4d68d7, 0x5775e1, 0x6282ea, 0x6c8ef1, 0x779af7, 0x82a5fb, 0x8db0fe,
                  0x98b9ff, 0xa3c2fe, 0xaec9fc, 0xb8d0f9, 0xc2d5f4, 0xccd9ee, 0xd5dbe6, 0xdddddd, 0xe5d8d1,
                  0xecd3c5, 0xf1ccb9, 0xf4c4ad, 0xf7bba0, 0xf7b194, 0xf7a687, 0xf49a7b, 0xf18d6f, 0xec7f63,
                  0xe57058, 0xde604d, 0xd55042, 0xcb3e38, 0xc0282f, 0xb40426}},
};

/* A point of a piecewise linear colormap: its position, and its colour in sRGB. */
typedef struct corner {
  double at, color[3];
} corner;

typedef struct cornered_map {
  const char *name;
  corner corners[4];
} cornered_map;

static const cornered_map cornered[] = {
    {"grays", {{0, {0, 0, 0}}, {1, {1, 1, 1}}}},
    {"hot", {{0, {0.0416, 0, 0}}, {0.365079, {1, 0, 0}}, {0.746032, {1, 1, 0}}, {1, {1, 1, 1}}}},
    {"bone",
     {{0, {0, 0, 0}},
      {0.365079, {0.319444, 0.319444, 0.444444}},
      {0.746032, {0.652778, 0.777778, 0.777778}},
      {1, {1, 1, 1}}}},
    {"copper", {{0, {0, 0, 0}}, {0.809524, {1, 0.632, 0.4025}}, {1, {1, 0.7812, 0.4975}}}},
    {"bronze",
     {{0, {0.30, 0.17, 0.11}},
      {0.35, {0.66, 0.40, 0.26}},
      {0.7, {0.90, 0.72, 0.52}},
      {1, {0.98, 0.94, 0.86}}}},
};

#define TABLE_COUNT    (sizeof tables / sizeof *tables)
#define CORNERED_COUNT (sizeof cornered / sizeof *cornered)

const char *hl_colormap_name(size_t index) {
  if (index < TABLE_COUNT) return tables[index].name;
  if (index == TABLE_COUNT) return "turbo";
  if (index - TABLE_COUNT - 1 < CORNERED_COUNT) return cornered[index - TABLE_COUNT - 1].name;
  return NULL;
}

static void turbo(double t, double srgb[3]) {
  static const double polynomial[3][6] = {
      {0.13572138, 4.61539260, -42.66032258, 132.13108234, -152.94239396, 59.28637943},
      {0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604},
      {0.10667330, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973}};
  for (int channel = 0; channel < 3; channel++) {
    double sum = 0;
    for (int power = 5; power >= 0; power--) sum = sum * t + polynomial[channel][power];
    srgb[channel] = fmin(fmax(sum, 0), 1);
  }
}

static void between_corners(size_t map, double t, double srgb[3]) {
  const corner *b = cornered[map].corners + 1;
  while (t > b->at) b++;
  const corner *a = b - 1;
  double weight = (t - a->at) / (b->at - a->at);
  for (int channel = 0; channel < 3; channel++)
    srgb[channel] = a->color[channel] + weight * (b->color[channel] - a->color[channel]);
}

static void between_steps(size_t map, double t, double srgb[3]) {
  int step = (int)fmin(t * (EQUAL_STEPS - 1), EQUAL_STEPS - 2);
  double weight = t * (EQUAL_STEPS - 1) - step;
  unsigned int a = tables[map].color[step], b = tables[map].color[step + 1];
  for (int channel = 0; channel < 3; channel++) {
    int shift = 16 - 8 * channel;
    srgb[channel] = ((1 - weight) * (a >> shift & 255) + weight * (b >> shift & 255)) / 255;
  }
}

bool hl_colormap_evaluate(const char *name, double t, double linear[3]) {
  double srgb[3];
  size_t index = 0;
  while (hl_colormap_name(index) != NULL && strcmp(hl_colormap_name(index), name) != 0) index++;
  if (hl_colormap_name(index) == NULL) return false;
  t = fmin(fmax(t, 0), 1);
  if (index < TABLE_COUNT) between_steps(index, t, srgb);
  else if (index == TABLE_COUNT) turbo(t, srgb);
  else between_corners(index - TABLE_COUNT - 1, t, srgb);
  for (int channel = 0; channel < 3; channel++) linear[channel] = hl_srgb_decode(srgb[channel]);
  return true;
}
