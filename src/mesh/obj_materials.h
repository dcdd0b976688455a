/* mesh/obj_materials.h - reads the materials of Wavefront OBJ files, names and colours, from .mtl files. */
#ifndef HL_MESH_OBJ_MATERIALS_H
#define HL_MESH_OBJ_MATERIALS_H

#include "mesh/mesh.h"

typedef struct obj_material {
  char name[128];
  float color[4]; /* linear RGB and opacity */
} obj_material;

typedef struct obj_materials {
  obj_material *list; /* owned; [count]; the materials */
  size_t count, room;
  bool has_images; /* whether a library names images for its colours, which are not read */
} obj_materials;

/* Adds the materials of a library beside the OBJ file `path`. A library that cannot be read causes a warning
 * and adds no materials. */
hl_status hl_obj_read_materials(hl_context *context, const char *path, const char *name,
                                obj_materials *materials, hl_error *error);
/* The material with a given name; null if there is no such material. */
const obj_material *hl_obj_find_material(const obj_materials *materials, const char *name);

#endif
