/* mesh/gltf.h - what the files of the glTF reader share: buffers, and accessors into them. */
#ifndef HL_MESH_GLTF_H
#define HL_MESH_GLTF_H

#include <jansson.h>

#include "mesh/mesh.h"

typedef struct gltf_buffer {
  const unsigned char *bytes; /* [length] */
  size_t length;
  bool owned; /* else part of the file's text */
} gltf_buffer;

typedef struct gltf_file {
  hl_context *context;
  const char *path;     /* what errors call the file */
  json_t *root;         /* owned */
  gltf_buffer *buffers; /* owned; [buffer_count] */
  size_t buffer_count;
  gltf_buffer chunk; /* of a GLB file; length 0: none */
  double **kept;     /* owned; [kept_count]: numbers of sparse accessors */
  size_t kept_count;
} gltf_file;

/* Reads the file's buffers: its own chunk, base64 texts, or files beside it. */
hl_status hl_gltf_read_buffers(gltf_file *file, hl_error *error);
void hl_gltf_release_buffers(gltf_file *file);

/* Reads a file beside the glTF file, or beside another one at file->path, into a block that ends with a zero
 * byte and that the caller owns. Names that lead out of its folder are refused. */
hl_status hl_gltf_read_beside(const gltf_file *file, const char *name, gltf_buffer *buffer, hl_error *error);

/* Numbers in a buffer. */
typedef struct gltf_accessor {
  const unsigned char *bytes;
  size_t count, stride; /* elements; bytes from one to the next */
  int components, type; /* numbers of an element, and their glTF type */
  double *numbers; /* owned by the file; [count][components]; of a sparse accessor, in place of bytes; else
                      null */
  bool normalized; /* whole numbers stand for fractions of their type's greatest */
} gltf_accessor;

/* Finds an accessor and checks that its buffer holds it. */
hl_status hl_gltf_find_accessor(gltf_file *file, size_t index, gltf_accessor *accessor, hl_error *error);

/* A number of an accessor; whole numbers as they are. */
double hl_gltf_number(const gltf_accessor *accessor, size_t element, int component);

/* The greatest value of an accessor's type, by which colours are divided; 1 for floats. */
double hl_gltf_whole(const gltf_accessor *accessor);

/* The whole number of a member, from 0. False where there is none. */
bool hl_gltf_index(const json_t *object, const char *key, size_t *index);

#endif
