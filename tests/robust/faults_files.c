/* tests/robust/faults_files.c - every allocation fails in turn, and every question whether to stop is
 * answered with yes, while files are loaded of the formats that faults.c does not write: the committed inputs
 * of the fuzz targets. usage: faults_files CORPUS_FOLDER */
#define _GNU_SOURCE
#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "faulty.h"
#include "volume_files.h"

/* Loads a file and computes its size and its range or, for a mesh, its box. */
typedef hl_status file_loader(hl_context *context, const char *path, double bounds[6], hl_error *error);

static hl_status load_volume(hl_context *context, const char *path, double bounds[6], hl_error *error) {
  hl_volume *volume = NULL;
  hl_volume_info info = {.struct_size = sizeof info};
  hl_status status = hl_volume_load(context, path, &volume, error);
  if (status != HL_OK) return status;
  assert_int_equal(hl_volume_get_info(volume, &info), HL_OK);
  for (int axis = 0; axis < 3; axis++) bounds[axis] = (double)info.dimensions[axis];
  for (int end = 0; end < 2; end++) bounds[3 + end] = info.range[end];
  bounds[5] = (double)info.nonfinite_count;
  hl_volume_release(volume);
  return status;
}

static hl_status load_mesh(hl_context *context, const char *path, double bounds[6], hl_error *error) {
  hl_mesh *mesh = NULL;
  hl_status status = hl_mesh_load(context, path, &mesh, error);
  if (status == HL_OK) assert_int_equal(hl_mesh_get_box(mesh, bounds, bounds + 3), HL_OK);
  hl_mesh_release(mesh);
  return status;
}

/* The inputs of a fuzz target. An input is one file or, cut at the first line "%%%%", two files. */
typedef struct file_kind {
  const char *target, *ending; /* the ending of the inputs' names; "": all inputs */
  const char *name, *second;   /* the names under which the two files are written */
  file_loader *load;
  bool folder; /* whether the folder is loaded, in which the input stands under both names */
} file_kind;

static const file_kind kinds[] = {{"dicom", "", "v.dcm", "w.dcm", load_volume, false},
                                  {"tiff", "", "v.tif", "w.tif", load_volume, false},
                                  {"slices", ".png", "1.png", "2.png", load_volume, true},
                                  {"slices", ".jpg", "1.jpg", "2.jpg", load_volume, true},
                                  {"slices", ".tif", "1.tif", "2.tif", load_volume, true},
                                  {"zarr", "", "v.zip", NULL, load_volume, false},
                                  {"amrex", "", "v.zip", NULL, load_volume, false},
                                  {"nanovdb", "", "v.nvdb", NULL, load_volume, false},
                                  {"mgh", "", "v.mgh", NULL, load_volume, false},
                                  {"vgi", "", "v.vgi", "v.raw", load_volume, false},
                                  {"vgi", "", "v.vthb", "b.vti", load_volume, false},
                                  {"vtr", ".vtr", "v.vtr", NULL, load_volume, false},
                                  {"vtr", ".vtk", "v.vtk", NULL, load_volume, false},
                                  {"vtu", ".vtu", "v.vtu", NULL, load_volume, false},
                                  {"vtu", ".vts", "v.vts", NULL, load_volume, false},
                                  {"particle_files", ".csv", "v.csv", NULL, load_volume, false},
                                  {"particle_files", ".xyz", "v.xyz", NULL, load_volume, false},
                                  {"particle_files", ".dump", "v.lammpstrj", NULL, load_volume, false},
                                  {"particle_files", ".vtp", "v.vtp", NULL, load_volume, false},
                                  {"vtu", ".vtu", "m.vtu", NULL, load_mesh, false},
                                  {"vtp", "", "m.vtp", NULL, load_mesh, false},
                                  {"ply", "", "m.ply", NULL, load_mesh, false},
                                  {"stl", "", "m.stl", NULL, load_mesh, false},
                                  {"obj", "", "m.obj", "m.mtl", load_mesh, false},
                                  {"gltf", ".gltf", "m.gltf", "m.bin", load_mesh, false},
                                  {"gltf", ".glb", "m.glb", NULL, load_mesh, false}};

enum { MOST_BYTES = 1 << 20 };

static const char *corpus;

typedef struct file_work {
  const file_kind *kind;
  char path[PATH_BYTES];
  double bounds[6]; /* the bounds of the file's values when it is loaded without faults */
} file_work;

/* If an allocation fails that the work can do without, a smooth wall of cells is missing, or a list of bricks
 * keeps memory that it does not need. The voxels are the same. */
static hl_status load(faulty *f, void *data, hl_error *error) {
  const file_work *work = data;
  double bounds[6];
  hl_status status = work->kind->load(f->context, work->path, bounds, error);
  if (status == HL_OK) assert_memory_equal(bounds, work->bounds, sizeof bounds);
  return status;
}

static void write_bytes(const char *folder, const char *name, const void *bytes, size_t size) {
  char path[PATH_BYTES];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(bytes, 1, size, file), size);
  assert_int_equal(fclose(file), 0);
}

/* Writes the files of an input into the folder. */
static void write_input(const file_kind *kind, const char *input, const char *folder) {
  static const char cut[] = "\n%%%%\n";
  static unsigned char bytes[MOST_BYTES];
  char path[2 * PATH_BYTES];
  snprintf(path, sizeof path, "%s/%s/%s", corpus, kind->target, input);
  FILE *file = fopen(path, "rb");
  assert_non_null(file);
  size_t size = fread(bytes, 1, sizeof bytes, file), first = size;
  assert_int_equal(fclose(file), 0);
  const unsigned char *second = kind->second == NULL ? NULL : memmem(bytes, size, cut, sizeof cut - 1);
  if (kind->folder) write_bytes(folder, kind->second, bytes, size);
  if (second != NULL) {
    first = (size_t)(second - bytes);
    second += sizeof cut - 1;
    write_bytes(folder, kind->second, second, size - (size_t)(second - bytes));
  }
  write_bytes(folder, kind->name, bytes, first);
}

/* Loads one input with faults. Returns false if the input is no file of the kind. */
static bool load_input(faulty *f, const file_kind *kind, const char *input) {
  char folder[FOLDER_BYTES];
  file_work work = {.kind = kind};
  make_folder(folder);
  write_input(kind, input, folder);
  snprintf(work.path, sizeof work.path, "%s/%s", folder, kind->folder ? "" : kind->name);
  bool whole = kind->load(f->context, work.path, work.bounds, NULL) == HL_OK;
  if (whole) {
    assert_true(faulty_fail_each(f, load, NULL, &work) >= 3);
    assert_true(faulty_stop_each(f, load, NULL, &work) >= 1);
  }
  remove_folder(folder);
  return whole;
}

static int is_input(const struct dirent *entry) { return entry->d_name[0] != '.'; }

static bool ends_in(const char *name, const char *ending) {
  size_t length = strlen(name), most = strlen(ending);
  return length >= most && strcmp(name + length - most, ending) == 0;
}

static void test_kind(void **state) {
  const file_kind *kind = *state;
  char path[2 * PATH_BYTES];
  struct dirent **entries = NULL;
  int loaded = 0;
  faulty f;
  snprintf(path, sizeof path, "%s/%s", corpus, kind->target);
  int count = scandir(path, &entries, is_input, alphasort);
  assert_true(count > 0);
  faulty_open(&f);
  f.may_recover = f.may_do_without = strcmp(kind->target, "vtu") == 0 ||
                                     strcmp(kind->target, "particle_files") == 0;
  for (int n = 0; n < count; n++) {
    if (ends_in(entries[n]->d_name, kind->ending)) loaded += load_input(&f, kind, entries[n]->d_name);
    free(entries[n]);
  }
  free(entries);
  faulty_close(&f);
  assert_true(loaded > 0);
}

int main(int argc, char **argv) {
  enum { KINDS = sizeof kinds / sizeof *kinds };
  static struct CMUnitTest tests[KINDS];
  static char names[KINDS][64];
  if (argc < 2) return fprintf(stderr, "usage: faults_files CORPUS_FOLDER [NAME]\n"), 2;
  corpus = argv[1];
  if (argc > 2) cmocka_set_test_filter(argv[2]);
  for (size_t n = 0; n < KINDS; n++) {
    snprintf(names[n], sizeof names[n], "%s as %s", kinds[n].target, kinds[n].name);
    tests[n] = (struct CMUnitTest){
        .name = names[n], .test_func = test_kind, .initial_state = (void *)&kinds[n]};
  }
  return cmocka_run_group_tests_name("faults_files", tests, NULL, NULL);
}
