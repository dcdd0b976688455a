/* tests/fuzz/seeds.c - writes the first inputs of the volume targets: every kind of file that the loaders
 * know, small.
 *
 * usage: seeds CORPUS_FOLDER. What a campaign finds beyond them is added by scripts/fuzz.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "volume_files.h"

/* A target, the name under which it loads its input, and the name that it gives to a second file. */
typedef struct seed_kind {
  const char *target, *ending, *second;
} seed_kind;

static const seed_kind kinds[] = {
    {"nrrd", ".nrrd", "v.raw"},     {"nrrd", ".nhdr", "v.raw"},   {"metaimage", ".mha", "v.raw"},
    {"metaimage", ".mhd", "v.raw"}, {"nifti", ".nii", NULL},      {"nifti", ".nii.gz", NULL},
    {"nifti", ".hdr", NULL},        {"legacy_vtk", ".vtk", NULL}, {"vti", ".vti", NULL},
    {"raw", ".raw", NULL},          {"raw", ".raw.gz", NULL},     {"raw", ".dat", "v.raw"},
    {"npy", ".npy", NULL},          {"mrc", ".mrc", NULL},        {"tiff", ".tif", NULL}};

enum { EVERY = 7 }; /* prime to the samples' periods: one sample of this number is written */

static const seed_kind *kind_of(const char *name) {
  size_t length = strlen(name);
  for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
    size_t ending = strlen(kinds[k].ending);
    if (length > ending && strcmp(name + length - ending, kinds[k].ending) == 0) return &kinds[k];
  }
  return NULL;
}

/* Writes the first file, in which the target's name replaces the name of the second file. */
static void write_header(FILE *out, const volume_sample *sample, const char *second) {
  const unsigned char *data = sample->file.data;
  size_t length = sample->file.length, old = strlen(sample->other_name), at = 0;
  while (at < length) {
    if (second != NULL && old > 0 && at + old <= length && memcmp(data + at, sample->other_name, old) == 0) {
      fputs(second, out);
      at += old;
    } else {
      fputc(data[at++], out);
    }
  }
}

static void write_seed(const volume_sample *sample, void *folder) {
  static int counter;
  const seed_kind *kind = kind_of(sample->name);
  if (kind == NULL || (counter++ % EVERY != 0 && strcmp(kind->target, "raw") != 0)) return;
  char path[1024];
  snprintf(path, sizeof path, "%s/%s", (const char *)folder, kind->target);
  mkdir(path, 0777);
  snprintf(path, sizeof path, "%s/%s/%s", (const char *)folder, kind->target, sample->name);
  FILE *out = fopen(path, "wb");
  assert_non_null(out);
  if (strcmp(kind->target, "raw") == 0) fprintf(out, "%s\n", sample->name);
  write_header(out, sample, kind->second);
  if (sample->other_name[0] != 0) {
    fputs("\n%%%%\n", out);
    fwrite(sample->other.data, 1, sample->other.length, out);
  }
  assert_int_equal(fclose(out), 0);
}

int main(int argc, char **argv) {
  if (argc != 2) return fprintf(stderr, "usage: seeds FOLDER\n"), 2;
  for_each_sample(write_seed, argv[1]);
  return 0;
}
