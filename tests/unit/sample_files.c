/* tests/unit/sample_files.c - writes the samples of volume_files.h into folders, and compares volumes with
 * them. */
#define _GNU_SOURCE
#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "volume_files.h"

void make_folder(char folder[FOLDER_BYTES]) {
  strcpy(folder, "/tmp/halflight-volume-XXXXXX");
  assert_non_null(mkdtemp(folder));
}

void remove_folder(const char *folder) {
  DIR *listing = opendir(folder);
  assert_non_null(listing);
  for (struct dirent *entry; (entry = readdir(listing)) != NULL;)
    if (entry->d_name[0] != '.') unlinkat(dirfd(listing), entry->d_name, 0);
  closedir(listing);
  assert_int_equal(rmdir(folder), 0);
}

void write_file(const char *folder, const char *name, const byte_buffer *content, char path[PATH_BYTES]) {
  snprintf(path, PATH_BYTES, "%s/%s", folder, name);
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(content->data, 1, content->length, file), content->length);
  assert_int_equal(fclose(file), 0);
}

void write_sample(const char *folder, const volume_sample *sample, char path[PATH_BYTES]) {
  if (sample->other_name[0] != 0) write_file(folder, sample->other_name, &sample->other, path);
  write_file(folder, sample->name, &sample->file, path);
}

void remove_sample(const char *folder, const volume_sample *sample) {
  char path[PATH_BYTES];
  const char *const names[2] = {sample->name, sample->other_name};
  for (int n = 0; n < 2; n++) {
    snprintf(path, sizeof path, "%s/%s", folder, names[n]);
    if (names[n][0] != 0) unlink(path);
  }
}

bool is_sample(const hl_volume *volume, const volume_sample *sample, int voxels) {
  static const size_t dimension[3] = {NI, NJ, NK};
  bool same = memcmp(volume->dimension, dimension, sizeof dimension) == 0 && volume->type == sample->type;
  for (int n = 0; same && n < voxels; n++) {
    double expected = sample->scale * voxel_value(sample->type, n) + sample->shift;
    double value = hl_volume_value(volume, (size_t)(n % NI), (size_t)(n / NI % NJ), (size_t)(n / NI / NJ));
    same = fabs(value - expected) <= 1e-9 * fabs(expected);
  }
  const double origin[3] = {volume->index_to_world.offset.x, volume->index_to_world.offset.y,
                            volume->index_to_world.offset.z};
  for (int axis = 0; same && axis < 3; axis++) {
    vec3 step = vec3_subtract(mat3_column(volume->index_to_world.linear, axis), vec3_of(sample->axis[axis]));
    same = vec3_length(step) < 1e-6 && fabs(origin[axis] - sample->origin[axis]) < 1e-6;
  }
  return same;
}
