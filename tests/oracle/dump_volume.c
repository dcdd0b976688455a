/* tests/oracle/dump_volume.c - prints what a volume file holds, for comparison with other readers.
 *
 * usage: dump_volume VOLUME [VOXELS]...   (pairs: each VOLUME with the file for its voxels, or "-" for none);
 * VOLUME may end with #TIME,CHANNEL,LEVEL,COMPONENT, each -1 for the default One JSON object a line on
 * stdout: the volume's info, or {"error": line, "status": code}. VOXELS receives the data values as native
 * float64, i fastest.
 */
#include <stdio.h>
#include <string.h>

#include <halflight/volume.h>

static void print_text(const char *text) {
  putchar('"');
  for (; *text != 0; text++) {
    if (*text == '"' || *text == '\\') putchar('\\');
    if ((unsigned char)*text >= ' ') putchar(*text);
  }
  putchar('"');
}

static void print_numbers(const char *name, const double *values, int count) {
  printf("\"%s\": [", name);
  for (int n = 0; n < count; n++) printf("%s%.17g", n > 0 ? ", " : "", values[n]);
  printf("], ");
}

static int write_voxels(const hl_volume *volume, const hl_volume_info *info, const char *path) {
  FILE *file = fopen(path, "wb");
  if (file == NULL) return 1;
  for (size_t k = 0; k < info->dimensions[2]; k++)
    for (size_t j = 0; j < info->dimensions[1]; j++)
      for (size_t i = 0; i < info->dimensions[0]; i++) {
        double value = hl_volume_value(volume, i, j, k);
        fwrite(&value, sizeof value, 1, file);
      }
  int failed = ferror(file);
  return fclose(file) != 0 || failed;
}

static int dump(hl_context *context, const char *path, const char *voxels) {
  hl_error error = {0};
  hl_volume *volume = NULL;
  hl_volume_load_options options;
  hl_volume_load_options_defaults(&options);
  char name[4096];
  snprintf(name, sizeof name, "%s", path);
  char *mark = strrchr(name, '#');
  if (mark != NULL &&
      sscanf(mark, "#%d,%d,%d,%d", &options.time, &options.channel, &options.level, &options.component) == 4)
    *mark = 0;
  hl_status status = hl_volume_load_with(context, name, &options, &volume, &error);
  if (status != HL_OK) {
    printf("{\"status\": %d, \"error\": ", (int)status);
    print_text(error.message);
    printf("}\n");
    return 0;
  }
  hl_volume_info info = {.struct_size = sizeof info};
  if (hl_volume_get_info(volume, &info) != HL_OK) return 1;
  printf("{\"status\": 0, \"dimensions\": [%zu, %zu, %zu], \"type\": \"%s\", ", info.dimensions[0],
         info.dimensions[1], info.dimensions[2], hl_voxel_type_name(info.type));
  print_numbers("spacing", info.spacing, 3);
  print_numbers("origin", info.origin, 3);
  print_numbers("direction", &info.direction[0][0], 9);
  print_numbers("range", info.range, 2);
  print_numbers("mean", &info.mean, 1);
  printf("\"nonfinite_count\": %llu}\n", (unsigned long long)info.nonfinite_count);
  int failed = strcmp(voxels, "-") != 0 ? write_voxels(volume, &info, voxels) : 0;
  hl_volume_release(volume);
  return failed;
}

int main(int argc, char **argv) {
  hl_context *context = NULL;
  hl_error error = {0};
  if (argc < 2 || hl_context_create(NULL, &context, &error) != HL_OK) {
    fprintf(stderr, "%s\n", argc < 2 ? "usage: dump_volume VOLUME [VOXELS]..." : error.message);
    return 2;
  }
  int failed = 0;
  for (int n = 1; n < argc; n += 2) failed |= dump(context, argv[n], n + 1 < argc ? argv[n + 1] : "-");
  hl_context_destroy(context);
  return failed;
}
