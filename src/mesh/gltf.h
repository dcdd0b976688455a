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
} gltf_file;

/* Reads the file's buffers: its own chunk, base64 texts, or files beside it. */
hl_status hl_gltf_read_buffers(gltf_file *file, hl_error *error);
void hl_gltf_release_buffers(gltf_file *file);

/* Numbers in a buffer. */
typedef struct gltf_accessor {
  const unsigned char *bytes;
  size_t count, stride; /* elements; bytes from one to the next */
  int components, type; /* numbers of an element, and their glTF type */
} gltf_accessor;

/* Finds an accessor and checks that its buffer holds it. */
hl_status hl_gltf_find_accessor(const gltf_file *file, size_t index, gltf_accessor *accessor,
                                hl_error *error);

/* A number of an accessor; whole numbers as they are. */
double hl_gltf_number(const gltf_accessor *accessor, size_t element, int component);

/* The greatest value of an accessor's type, by which colours are divided; 1 for floats. */
double hl_gltf_whole(const gltf_accessor *accessor);

/* The whole number of a member, from 0. False where there is none. */
bool hl_gltf_index(const json_t *object, const char *key, size_t *index);

#endif
