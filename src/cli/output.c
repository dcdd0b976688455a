/* cli/output.c - makes names of files, and checks before the work that OUT can be written. */
#define _GNU_SOURCE
#include "output.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "message.h"
#include "text/number_word.h"
#include "text/plain.h"

const char *const picture_extensions[] = {".png", ".exr", ".npy", ".tif", ".tiff", NULL};
const char *const figure_extensions[] = {".png", ".exr", ".npy", ".tif", ".tiff", ".pdf", ".svg", NULL};
const char *const volume_extensions[] = {".nrrd", ".nii",  ".nii.gz", ".mha", ".vti",    ".mrc", ".mrc.gz",
                                         ".tif",  ".tiff", ".npy",    ".raw", ".raw.gz", NULL};

const char *const mesh_extensions[] = {".ply", ".stl", ".obj", NULL};

const char *base_name(const char *path) {
  const char *slash = strrchr(path, '/');
  return slash != NULL ? slash + 1 : path;
}

bool has_extension(const char *path, const char *extension) {
  size_t length = strlen(path), extension_length = strlen(extension);
  return length > extension_length && strcasecmp(path + length - extension_length, extension) == 0;
}

static int check_folder(const char *path) {
  char *folder = strdup(path);
  if (folder == NULL) return fail(EXIT_CODE_FAILURE, "out of memory");
  char *slash = strrchr(folder, '/');
  if (slash != NULL) slash[1] = '\0'; /* after a slash, the system takes no file for a folder */
  const char *name = slash != NULL ? folder : ".";
  int exit_code = EXIT_CODE_OK;
  if (access(name, W_OK | X_OK) != 0) {
    int reason = errno;
    if (slash != NULL && slash > folder) *slash = '\0';
    exit_code = fail(EXIT_CODE_FAILURE, "%s: its folder '%s' cannot be written: %s", path, name,
                     strerror(reason));
  }
  free(folder);
  return exit_code;
}

/* Refuses a path that ends in none of the extensions. */
static int check_extension(const char *path, const char *const *extensions) {
  char list[120] = "";
  size_t used = 0;
  for (int i = 0; extensions[i] != NULL; i++) {
    if (has_extension(path, extensions[i])) return EXIT_CODE_OK;
    const char *before = i == 0 ? "" : extensions[i + 1] != NULL ? ", " : " or ";
    if (used < sizeof list)
      used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", before, extensions[i]);
  }
  return fail(EXIT_CODE_USAGE, "OUT: '%s' must end in %s", path, list);
}

int output_check(const char *path, const char *const *extensions, char *const *inputs, int input_count) {
  int exit_code = check_extension(path, extensions);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  struct stat about, about_input;
  if (stat(path, &about) == 0) {
    if (S_ISDIR(about.st_mode)) return fail(EXIT_CODE_FAILURE, "%s: is a folder: name a file in it", path);
    for (int i = 0; i < input_count; i++)
      if (stat(inputs[i], &about_input) == 0 && about.st_dev == about_input.st_dev &&
          about.st_ino == about_input.st_ino)
        return fail(EXIT_CODE_USAGE, "OUT: '%s' is the input '%s': choose another name", path, inputs[i]);
  } else if (errno == ENAMETOOLONG) {
    return fail(EXIT_CODE_FAILURE, "%s: cannot be written: %s", path, strerror(errno));
  }
  return check_folder(path);
}

int output_to_stdout(const unsigned char *bytes, size_t length) {
  if (fwrite(bytes, 1, length, stdout) != length && ferror(stdout) == 0) errno = EIO;
  return finish_stdout();
}

/* The scene without its number of threads, which changes no picture. The caller owns it. */
static hl_status make_plain(hl_context *context, const hl_scene *scene, hl_scene **plain, hl_error *error) {
  hl_scene_description description = *hl_scene_describe(scene);
  description.render.threads = 0;
  return hl_scene_create(context, &description, plain, error);
}

hl_status output_scene_text(hl_context *context, const hl_scene *scene, const char *path, char **text,
                            hl_error *error) {
  char *folder = strdup(path);
  if (folder == NULL) {
    snprintf(error->message, sizeof error->message, "out of memory for a path");
    return HL_ERROR_MEMORY;
  }
  folder[base_name(folder) - folder] = '\0';
  hl_scene *plain = NULL;
  hl_status status = HL_OK;
  if (hl_scene_describe(scene)->render.threads != 0) status = make_plain(context, scene, &plain, error);
  if (status == HL_OK)
    status = hl_scene_to_json_beside(context, plain != NULL ? plain : scene, folder, text, error);
  hl_scene_release(plain);
  free(folder);
  return status;
}

bool has_extension_among(const char *path, const char *const *extensions) {
  for (int n = 0; extensions[n] != NULL; n++)
    if (has_extension(path, extensions[n])) return true;
  return false;
}

bool output_is_linear(const char *path) { return has_extension(path, ".exr") || has_extension(path, ".npy"); }

char *output_default_name(const char *input, const char *extension) {
  char folder[PATH_MAX];
  char url[PATH_MAX];
  if (hl_plain_is_url(input)) {
    size_t length = strcspn(input, "?");
    while (length > 0 && input[length - 1] == '/') length--;
    snprintf(url, sizeof url, "%.*s", (int)length, input);
    input = url;
  }
  const char *base = base_name(input);
  bool unnamed = base[0] == 0 || strcmp(base, ".") == 0 || strcmp(base, "..") == 0; /* of a folder */
  if (unnamed && realpath(input, folder) != NULL && folder[1] != 0) base = base_name(folder);
  size_t length = strlen(base);
  if (has_extension(base, ".gz")) length -= 3;
  size_t stem = length;
  while (stem > 0 && base[stem - 1] != '.') stem--;
  stem = stem > 1 ? stem - 1 : length;
  char *name = malloc(stem + strlen(extension) + 1);
  if (name == NULL) return NULL;
  memcpy(name, base, stem);
  strcpy(name + stem, extension);
  return name;
}

/* ---- names of pictures that are made of the inputs' names ---- */

bool output_has_name(const char *text) {
  int names = 0;
  for (const char *at = strchr(text, '%'); at != NULL; at = strchr(at + 2, '%')) {
    if (at[1] == 's') names++;
    else if (at[1] != '%') return false;
  }
  return names == 1;
}

bool output_is_folder(const char *path) {
  struct stat about;
  size_t length = strlen(path);
  return (length > 0 && path[length - 1] == '/') || (stat(path, &about) == 0 && S_ISDIR(about.st_mode));
}

char *output_pattern(const char *folder, const char *extension) {
  size_t length = strlen(folder), doubled = length;
  for (const char *c = folder; *c != '\0'; c++) doubled += *c == '%';
  char *pattern = malloc(doubled + strlen("/%s") + strlen(extension) + 1);
  if (pattern == NULL) return NULL;
  char *end = pattern;
  for (const char *c = folder; *c != '\0'; c++) {
    if (*c == '%') *end++ = '%';
    *end++ = *c;
  }
  sprintf(end, "%s%%s%s", length > 0 && folder[length - 1] == '/' ? "" : "/", extension);
  return pattern;
}

char *output_fill(const char *text, output_words words) {
  const size_t name_length = words.name != NULL ? strlen(words.name) : 0;
  size_t count = 0;
  for (const char *at = text; *at != '\0'; at++) count += *at == '%';
  char *filled = malloc(strlen(text) + count * (name_length + HL_NUMBER_BYTES) + 1), *end = filled;
  while (filled != NULL && *text != '\0') {
    hl_number_word word;
    if (words.name != NULL && text[0] == '%' && text[1] == 's') {
      memcpy(end, words.name, name_length);
      end += name_length;
      text += 2;
    } else if (words.number >= 0 && hl_number_word_read(text, "d", &word)) {
      end += hl_number_word_write(&word, words.number, end);
      text += word.length;
    } else {
      text += words.doubled && text[0] == '%' && text[1] == '%';
      *end++ = *text++;
    }
  }
  if (filled != NULL) *end = '\0';
  return filled;
}

char *output_name_picture(const char *pattern, const char *input) {
  char *stem = output_default_name(input, "");
  char *name = stem != NULL ? output_fill(pattern, (output_words){stem, -1, true}) : NULL;
  free(stem);
  return name;
}

int output_make_folder(const char *folder) {
  struct stat about;
  if (mkdir(folder, 0777) == 0 || (errno == EEXIST && stat(folder, &about) == 0 && S_ISDIR(about.st_mode)))
    return EXIT_CODE_OK;
  return fail(EXIT_CODE_FAILURE, "%s: no folder for the pictures can be made: %s", folder, strerror(errno));
}

int output_make_folder_of(const char *path) {
  int exit_code = EXIT_CODE_OK;
  char *folder = strdup(path);
  if (folder == NULL) return fail(EXIT_CODE_FAILURE, "out of memory");
  char *slash = strrchr(folder, '/');
  if (slash != NULL && slash != folder) {
    *slash = '\0';
    exit_code = output_make_folder(folder);
  }
  free(folder);
  return exit_code;
}

/* ---- files that the run has read ---- */

static bool make_room(cli_read_files *read) {
  if (read->count < read->capacity) return true;
  size_t capacity = read->capacity > 0 ? 2 * read->capacity : 16;
  cli_file_identity *files = realloc(read->files, capacity * sizeof *files);
  if (files == NULL) return false;
  read->files = files;
  read->capacity = capacity;
  return true;
}

void read_files_add(cli_read_files *read, const char *path) {
  struct stat about;
  if (stat(path, &about) != 0) return; /* the file does not exist any more, so it cannot be overwritten */
  if (make_room(read)) read->files[read->count++] = (cli_file_identity){about.st_dev, about.st_ino};
  else read->incomplete = true;
}

void read_files_release(cli_read_files *read) { free(read->files); }

int read_files_protect(const cli_read_files *read, const char *path, const char *reader) {
  struct stat about;
  if (stat(path, &about) != 0)
    return errno != ENAMETOOLONG
               ? EXIT_CODE_OK
               : fail(EXIT_CODE_FAILURE, "%s: cannot be written: %s", path, strerror(errno));
  if (read->incomplete)
    return fail(EXIT_CODE_FAILURE, "out of memory for the names of the files that were read");
  for (size_t i = 0; i < read->count; i++)
    if (about.st_dev == read->files[i].device && about.st_ino == read->files[i].inode)
      return fail(EXIT_CODE_USAGE, "OUT: '%s' is a file that '%s' needs: choose another name", path, reader);
  return EXIT_CODE_OK;
}
