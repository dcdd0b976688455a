/* render/prepare.h - prepares volumes for rendering, and keeps them for the next frame. */
#ifndef HL_RENDER_PREPARE_H
#define HL_RENDER_PREPARE_H

#include "core/memory.h"
#include "core/pool.h"
#include "grid/classifier.h"
#include "grid/grid.h"
#include "render/hot.h"

/* An isosurface of a volume. It is kept between frames while its value, its volume's axes and its caps stay
 * the same. */
typedef struct prepared_iso {
  double value;
  double axis_scale[3]; /* the volume's axes */
  uint8_t capped;       /* the faces of the volume's box that have caps (hl_iso_capped_faces) */
  uint64_t colors;      /* a hash of what the colours of its vertices follow from; 0 if they have none */
  hl_mesh *mesh;        /* owned; if null, the surface is empty */
} prepared_iso;

/* A prepared volume. It is kept between frames while its voxels, kernel, clip box and transfer function stay
 * the same. */
typedef struct prepared_volume {
  const hl_scene_volume *scene; /* the volume in the frame's scene */
  hl_volume *volume;            /* retained */
  hl_volume *mask;              /* retained: the lattice of the volume's mask; null if the volume has no
                                 * mask */
  hl_volume *second;            /* retained: the other volume of a transfer function of two numbers; null if
                                 * there is none */
  double second_empty;          /* the second volume's empty value */
  grid grid;
  classifier classifier;
  double empty;                  /* data value */
  hl_kernel kernel;              /* the kernel for which bounds of the grid's cells were found */
  hl_transfer_function function; /* the transfer function from which the classifier was made; its points are
                                  * owned */
  uint64_t plane_mark; /* a number that identifies the content of a transfer function of two numbers; if 0,
                        * the function depends on the value alone */
  double clip[6];
  int clipped;
  uint64_t version, tables_version; /* versions of the grid's voxels, and of everything that follows from the
                                     * transfer function; they rise with each change, from 0 on */
  cut_shape *cuts;                  /* owned; the grid's cuts */
  prepared_iso *iso;                /* owned; [iso_count] */
  size_t iso_count;
} prepared_volume;

/* Brings prepared[0 .. count) up to date with the scene's volumes. Parts that have not changed are reused.
 * scene: in frame space (plan/framed_scene.h). plane_marks: [scene->volume_count]; numbers that identify the
 * contents of functions of two numbers. */
hl_status hl_prepare_volumes(hl_context *context, hl_pool *pool, const hot_functions *hot,
                             const hl_scene_description *scene, const uint64_t *plane_marks,
                             prepared_volume *prepared, hl_error *error);
/* Brings the volumes' isosurfaces up to date, after the volumes. */
hl_status hl_prepare_isosurfaces(hl_context *context, hl_pool *pool, const hl_scene_description *scene,
                                 prepared_volume *prepared, hl_error *error);
/* Releases the volumes of prepared[0 .. count) whose grids the scene's volumes cannot use any more. */
void hl_prepared_release_stale(hl_context *context, const hl_scene_description *scene,
                               prepared_volume *prepared);
/* Counts the memory that preparing one volume takes. kernel: the scene's kernel. */
void hl_prepared_count(const hl_scene_volume *scene, hl_kernel kernel, const grid_functions *functions,
                       int threads, hl_layout *layout);
void hl_prepared_release(hl_context *context, prepared_volume *prepared);

#endif
