/* mesh/gltf.h - declares the structs and functions that the files of the glTF reader share: buffers, and
 * accessors, which find numbers in buffers. */
#ifndef HL_MESH_GLTF_H
#define HL_MESH_GLTF_H

#include <jansson.h>

#include "mesh/mesh.h"

typedef struct gltf_buffer {
  const unsigned char *bytes; /* [length]; the bytes of the buffer */
  size_t length;
  bool owned; /* whether `bytes` is owned; if not, the bytes belong to the content of the glTF file */
} gltf_buffer;

typedef struct gltf_file {
  hl_context *context;
  const char *path;     /* the file's name in errors */
  json_t *root;         /* the file's JSON text; owned */
  gltf_buffer *buffers; /* owned; [buffer_count]; the file's buffers */
  size_t buffer_count;
  gltf_buffer chunk; /* the buffer of a GLB file; its length is 0 if there is none */
  double **kept;     /* owned; [kept_count]; blocks of numbers, one for each sparse accessor that was read */
  size_t kept_count;
} gltf_file;

/* Reads all buffers. The bytes of a buffer are the chunk of a GLB file, a base64 text in the JSON, or a file
 * beside the glTF file. */
hl_status hl_gltf_read_buffers(gltf_file *file, hl_error *error);
void hl_gltf_release_buffers(gltf_file *file);

/* Reads a file in the folder of the glTF file (file->path). The block ends with a zero byte and is owned by
 * the caller. Names that lead out of the folder are refused. */
hl_status hl_gltf_read_beside(const gltf_file *file, const char *name, gltf_buffer *buffer, hl_error *error);

/* An accessor of a glTF file: numbers in a buffer. */
typedef struct gltf_accessor {
  const unsigned char *bytes;
  size_t count, stride; /* number of elements; bytes from one element to the next */
  int components, type; /* number of components of an element, and their glTF type */
  double *numbers;      /* [count][components]; owned by the file; the numbers of a sparse accessor, read
                         * in place of `bytes`; null for other accessors */
  bool normalized;      /* whether whole numbers stand for fractions of their type's greatest value */
} gltf_accessor;

/* Finds an accessor and checks that its buffer holds all its numbers. */
hl_status hl_gltf_find_accessor(gltf_file *file, size_t index, gltf_accessor *accessor, hl_error *error);

/* Returns one number of an accessor. Whole numbers are returned as they are, without division. */
double hl_gltf_number(const gltf_accessor *accessor, size_t element, int component);

/* The number by which colours of an accessor must be divided: the greatest value of their type; 1 for
 * floats. */
double hl_gltf_whole(const gltf_accessor *accessor);

/* Reads a member of a JSON object that is a whole number of at least 0. Returns false if there is no such
 * member. */
bool hl_gltf_index(const json_t *object, const char *key, size_t *index);

#endif
