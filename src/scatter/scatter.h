/* scatter/scatter.h - finds the light that media scatter more than once, at the nodes of a coarse grid over
 * the scene.
 *
 * The grid does not depend on the camera. Its light is found once, while volumes and lights stay the same:
 *
 *     matter.c      extinction and scattering at the grid's nodes, from the volumes
 *     direct.c      the lights' unscattered light at the nodes
 *     sky.c         the sky's light that enters the grid
 *     walls.c       the light that meshes absorb
 *     transport.c   how scattered light spreads
 *     field.c       the whole field, and the key by which a result is kept
 *
 * A medium with the extinction s, anisotropy g and albedo w is replaced by a medium that scatters evenly,
 * with the extinction s (1 - w g) and the scattering s w (1 - g) (similarity; van de Hulst, "Multiple light
 * scattering", 1980). After many scatterings light spreads alike in both media. */
#ifndef HL_SCATTER_SCATTER_H
#define HL_SCATTER_SCATTER_H

#include <halflight/scene.h>

#include "core/key.h"
#include "core/memory.h"
#include "core/pool.h"
#include "grid/classifier.h"
#include "light/light_source.h"
#include "surface/surfaces.h"

/* A volume of the scene, in the form in which the folder scatter reads it. */
typedef struct scatter_volume {
  const hl_scene_volume *scene; /* the volume in frame space */
  uint64_t plane_mark; /* the mark of the volume's function of two numbers, which identifies the function's
                        * content */
  const grid *grid;
  const classifier *classifier;
} scatter_volume;

/* The input from which a field is made. Everything is borrowed. */
typedef struct scatter_scene {
  hl_context *context;
  hl_pool *pool;
  const hl_scene_description *scene; /* the scene in frame space */
  const double *sun_parts;           /* [scene->light_count]; for each light, `of_sky` of its light_source */
  const scatter_volume *volumes;     /* [scene->volume_count]; the scene's volumes */
  uint64_t sky_mark;                 /* identifies the pixels of the sky's image */
  const surfaces *surfaces;          /* the scene's meshes, which absorb light; null if there are none */
} scatter_scene;

/* The places of the nodes, in frame space: node (x, y, z) lies at origin + spacing * (x, y, z). */
typedef struct scatter_nodes {
  int32_t count[3];
  float origin[3], spacing;
} scatter_nodes;

typedef struct scatter_field {
  scatter_nodes nodes;
  /* owned; [channels][count z][count y][count x]: the mean over all directions of scattered light, and of
   * that part of the sky's light that the sky's field does not give to samples (parts.h). The units are the
   * same as for a light's color. Null if there is no field. */
  float *light;
  float *flux;  /* in the block of `light`; [channels][3][count z][count y][count x]: the mean over all
                 * directions of the light times its direction of travel; null if all matter scatters
                 * evenly */
  int channels; /* number of channels: 1 if red, green and blue are the same, else 3 */
  hl_key key;   /* the key of the field's input */
} scatter_field;

/* Returns whether some volume asks for multiple scattering and can show it. */
bool hl_scatter_wanted(const hl_scene_description *scene);

/* Counts the memory that hl_scatter_update() takes where it has to make the field anew. */
void hl_scatter_count(const scatter_scene *scene, hl_layout *layout);

/* Brings the field up to date. Does nothing if the field's input has not changed. */
hl_status hl_scatter_update(const scatter_scene *scene, scatter_field *field, hl_error *error);
void hl_scatter_release(hl_context *context, scatter_field *field);

static inline size_t hl_scatter_node_count(const scatter_nodes *nodes) {
  return (size_t)nodes->count[0] * (size_t)nodes->count[1] * (size_t)nodes->count[2];
}

#endif
