/* cli/output.h - makes names of files, and checks before the work that OUT can be written. */
#ifndef HL_CLI_OUTPUT_H
#define HL_CLI_OUTPUT_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/types.h>

#include <halflight/halflight.h>

/* The part of a path after its last slash. */
const char *base_name(const char *path);

/* Returns true if the path ends in the extension (".png"), in upper or lower case, and has at least one
 * character before it. */
bool has_extension(const char *path, const char *extension);
/* Whether a path ends in one of the extensions. extensions: ended by null. */
bool has_extension_among(const char *path, const char *const *extensions);
/* Whether a picture with this name holds linear light as numbers (.exr, .npy), and no coded colours. */
bool output_is_linear(const char *path);

/* The extensions that can be written; null after the last. */
extern const char *const picture_extensions[], *const figure_extensions[], *const volume_extensions[],
                                                                               *const mesh_extensions[];

/* Refuses a path that ends in none of the extensions, is a folder or one of the inputs, or lies in a folder
 * that cannot be written to. Returns the exit code. */
int output_check(const char *path, const char *const *extensions, char *const *inputs, int input_count);

/* Writes all the bytes to standard output; returns the exit code. */
int output_to_stdout(const unsigned char *bytes, size_t length);

/* The text of a scene for a picture at this path (hl_text_release()). Files beside the picture are named
 * relative to it. */
hl_status output_scene_text(hl_context *context, const hl_scene *scene, const char *path, char **text,
                            hl_error *error);

/* Makes the default name of an output: "head.png", in the current folder, for "scans/head.nii.gz" and ".png".
 * A URL's query does not become part of the name. Owned by the caller (free); null if memory is short. */
char *output_default_name(const char *input, const char *extension);

/* ---- names of pictures that are made of the inputs' names ---- */

/* Returns true if the text has one "%s", which stands for an input's name, and no other '%' but "%%". */
bool output_has_name(const char *text);

/* Returns true if the path names a folder: it ends in '/', or is the path of an existing folder. */
bool output_is_folder(const char *path);

/* The pattern "FOLDER/%s.png" of the pictures in a folder. extension: ".png". Owned by the caller (free);
 * null if memory is short. */
char *output_pattern(const char *folder, const char *extension);

/* The values that replace the words of a text. `name` replaces "%s"; if it is null, "%s" stays. `number`
 * replaces "%d", "%04d" and the like (text/number_word.h); if it is -1, these words stay. `doubled` says
 * whether "%%" becomes one '%', as in the names of files. */
typedef struct output_words {
  const char *name;
  long number;
  bool doubled;
} output_words;

/* Replaces the words of a text. Owned by the caller (free); null if memory is short. */
char *output_fill(const char *text, output_words words);

/* Makes the name of an input's picture: the pattern with the input's name, without folder and extension, in
 * place of its "%s" (output_has_name()). Owned by the caller (free); null if memory is short. */
char *output_name_picture(const char *pattern, const char *input);

/* Makes a folder for pictures, if it is missing. Returns the exit code. */
int output_make_folder(const char *folder);

/* Makes the folder of the file at this path, if it is missing. Returns the exit code. */
int output_make_folder_of(const char *path);

/* ---- files that the run has read: it must write over none of them ---- */

/* The identity of a file, which is the same for all of its names and links. */
typedef struct cli_file_identity {
  dev_t device;
  ino_t inode;
} cli_file_identity;

typedef struct cli_read_files {
  cli_file_identity *files; /* owned; [count] */
  size_t count, capacity;
  bool incomplete; /* whether memory was short, so that at least one of the read files is not in the list */
} cli_read_files;

void read_files_add(cli_read_files *read, const char *path);
void read_files_release(cli_read_files *read);

/* Refuses to write to a path that leads to one of the files that were read, or that is too long. reader: the
 * input, named in the error, that needs these files ("scene.json"). Returns the exit code. */
int read_files_protect(const cli_read_files *read, const char *path, const char *reader);

#endif
