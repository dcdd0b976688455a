/* tests/fuzz/support.c - see target.h. */
#define _GNU_SOURCE
#include "target.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "volume/volume.h"

enum { SLOTS = 4, PATH_BYTES = 512 };

static hl_context *the_context, *the_confined;
static char the_folder[64];
static char paths[SLOTS][PATH_BYTES];

_Noreturn void fuzz_broken(const char *file, int line, const char *promise) {
  fprintf(stderr, "%s:%d: broken promise: %s\n", file, line, promise);
  abort();
}

hl_context *fuzz_context(void) {
  if (the_context != NULL) return the_context;
  hl_context_options options;
  hl_context_options_defaults(&options);
  options.memory_limit = fuzz_memory_limit;
  REQUIRE(hl_context_create(&options, &the_context, NULL) == HL_OK);
  return the_context;
}

void fuzz_check_nothing_held(void) {
  REQUIRE(hl_context_memory_held(the_context) == 0);
  REQUIRE(hl_context_memory_peak(the_context) <= fuzz_memory_limit);
}

bool fuzz_check_answer(hl_status status, const hl_error *error, bool made) {
  REQUIRE(made == (status == HL_OK));
  if (status == HL_OK) return true;
  REQUIRE(status != HL_ERROR_INTERNAL && status != HL_ERROR_ARGUMENT);
  REQUIRE(error->code == status);
  REQUIRE(error->message[0] != 0);
  for (const char *c = error->message; *c != 0; c++) REQUIRE((unsigned char)*c >= 0x20 && *c != 0x7f);
  return false;
}

static void remove_folder(void) {
  for (int slot = 0; slot < SLOTS; slot++) fuzz_remove_file(slot);
  rmdir(the_folder);
}

const char *fuzz_folder(void) {
  if (the_folder[0] != 0) return the_folder;
  strcpy(the_folder,
         access("/dev/shm", W_OK) == 0 ? "/dev/shm/halflight-fuzz-XXXXXX" : "/tmp/halflight-fuzz-XXXXXX");
  REQUIRE(mkdtemp(the_folder) != NULL);
  atexit(remove_folder);
  return the_folder;
}

hl_context *fuzz_confined(void) {
  if (the_confined == NULL)
    REQUIRE(hl_context_confine(fuzz_context(), fuzz_folder(), &the_confined, NULL) == HL_OK);
  return the_confined;
}

void fuzz_remove_file(int slot) {
  if (paths[slot][0] != 0) unlink(paths[slot]);
  paths[slot][0] = 0;
}

const char *fuzz_write_file(int slot, const char *name, const uint8_t *data, size_t size) {
  fuzz_remove_file(slot);
  snprintf(paths[slot], PATH_BYTES, "%s/%s", fuzz_folder(), name);
  FILE *file = fopen(paths[slot], "wb");
  REQUIRE(file != NULL);
  REQUIRE(size == 0 || fwrite(data, 1, size, file) == size); /* without data, the pointer may be null */
  REQUIRE(fclose(file) == 0);
  return paths[slot];
}

/* Checks the properties that every accepted volume must have. */
static void check_volume(hl_volume *volume) {
  hl_volume_info info = {.struct_size = sizeof info};
  REQUIRE(hl_volume_get_info(volume, &info) == HL_OK);
  uint64_t voxels = 1, counted = info.nonfinite_count;
  for (int a = 0; a < 3; a++) {
    voxels *= info.dimensions[a];
    REQUIRE(info.spacing[a] > 0 && isfinite(info.spacing[a]) && isfinite(info.origin[a]));
  }
  for (int bin = 0; bin < HL_HISTOGRAM_BINS; bin++) counted += info.histogram[bin];
  REQUIRE(counted == voxels);
  REQUIRE(isfinite(info.range[0]) && isfinite(info.range[1]) && isfinite(info.mean));
  REQUIRE(info.range[0] <= info.mean && info.mean <= info.range[1]);
  double last = hl_volume_value(volume, info.dimensions[0] - 1, info.dimensions[1] - 1,
                                info.dimensions[2] - 1);
  /* The range of a field in bricks is the range of the bricks' coefficients, near which the field lies. */
  REQUIRE(isnan(last) || volume->bricks != NULL || (last >= info.range[0] && last <= info.range[1]));
  hl_transfer_function function = {0};
  hl_error error = {0};
  hl_status status = hl_transfer_function_automatic(fuzz_context(), volume, &function, &error);
  if (fuzz_check_answer(status, &error, function.opacity != NULL))
    hl_transfer_function_release(fuzz_context(), &function);
}

/* Reads the same content from memory, with another component and another spacing. */
static void load_otherwise(const char *name, const uint8_t *data, size_t size) {
  static const int components[] = {HL_COMPONENT_MAGNITUDE, 1};
  for (size_t n = 0; n < 2; n++) {
    hl_volume_load_options options;
    hl_volume_load_options_defaults(&options);
    options.component = components[n];
    options.array = n == 1 ? "" : NULL;
    options.bytes = data;
    options.byte_count = size;
    for (int axis = 0; axis < 3; axis++) options.spacing[axis] = 0.5 * (axis + 1);
    hl_volume *volume = NULL;
    hl_error error = {0};
    hl_status status = hl_volume_load_with(fuzz_confined(), name, &options, &volume, &error);
    if (fuzz_check_answer(status, &error, volume != NULL)) check_volume(volume);
    hl_volume_release(volume);
    fuzz_check_nothing_held();
  }
}

/* Writes the input as one file or, if it has a line "%%%%", as two files cut at that line. *first: the size
 * of the first file. */
static size_t write_input(const char *name, const char *second_name, const uint8_t *data, size_t size) {
  static const char cut[] = "\n%%%%\n";
  const uint8_t *second = second_name == NULL ? NULL : memmem(data, size, cut, sizeof cut - 1);
  size_t first_size = second == NULL ? size : (size_t)(second - data);
  fuzz_remove_file(1);
  if (second != NULL)
    fuzz_write_file(1, second_name, second + sizeof cut - 1, size - first_size - (sizeof cut - 1));
  fuzz_write_file(0, name, data, first_size);
  return first_size;
}

void fuzz_load_volume(const char *name, const char *second_name, const uint8_t *data, size_t size) {
  size_t first_size = write_input(name, second_name, data, size);
  hl_volume *volume = NULL;
  hl_error error = {0};
  hl_status status = hl_volume_load(fuzz_confined(), name, &volume, &error);
  if (fuzz_check_answer(status, &error, volume != NULL)) check_volume(volume);
  hl_volume_release(volume);
  fuzz_check_nothing_held();
  load_otherwise(name, data, first_size);
}

static void check_mesh(const hl_mesh *mesh) {
  const hl_mesh_description *d = hl_mesh_describe(mesh);
  double low[3], high[3];
  REQUIRE(d->triangle_count + d->sphere_count > 0 && hl_mesh_get_box(mesh, low, high) == HL_OK);
  for (int axis = 0; axis < 3; axis++) REQUIRE(isfinite(low[axis]) && low[axis] <= high[axis]);
  for (size_t t = 0; t < d->triangle_count; t++)
    for (int i = 0; i < 3; i++) REQUIRE(d->triangles[t][i] < d->vertex_count);
}

void fuzz_load_mesh(const char *name, const char *second_name, const uint8_t *data, size_t size) {
  hl_mesh *mesh = NULL;
  hl_error error = {0};
  write_input(name, second_name, data, size);
  hl_status status = hl_mesh_load(fuzz_confined(), name, &mesh, &error);
  if (fuzz_check_answer(status, &error, mesh != NULL)) check_mesh(mesh);
  hl_mesh_release(mesh);
  fuzz_remove_file(0);
  fuzz_check_nothing_held();
}

unsigned fuzz_byte(fuzz_source *source) {
  if (source->left == 0) return 0;
  source->left--;
  return *source->data++;
}

int fuzz_choice(fuzz_source *source, int count) { return (int)(fuzz_byte(source) % (unsigned)count); }

double fuzz_unit(fuzz_source *source) {
  unsigned high = fuzz_byte(source);
  return (high * 256.0 + fuzz_byte(source)) / 65535;
}

double fuzz_number(fuzz_source *source) {
  static const double special[] = {0, 1, -1, 1e-9, 1e9, 1e7, -1e7, 1e-3, 1000, 0.5};
  unsigned kind = fuzz_byte(source);
  if (kind >= 246) return special[kind - 246];
  return ((kind * 256.0 + fuzz_byte(source)) / (246 * 256.0) - 0.5) * 16;
}
