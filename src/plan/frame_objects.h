/* plan/frame_objects.h - the volumes, lights and meshes of a frame, as plain data in frame space.
 *
 * In:  the scene that is brought to frame space (framed_scene.h). Out: the properties of a scene's things
 * that back ends ask for. Back ends see no descriptions. */
#ifndef HL_PLAN_FRAME_OBJECTS_H
#define HL_PLAN_FRAME_OBJECTS_H

#include "grid/classifier.h"
#include "light/light_source.h"
#include "plan/framed_scene.h"
#include "surface/surfaces.h"

/* How a volume's matter looks, and how much light it takes. */
typedef struct volume_look {
  hl_shading shading;
  hl_cut_shading cut_shading;
  hl_material material;
  double anisotropy; /* anisotropy of the phase function */
  double albedo[HL_CHANNELS], attenuation_color[HL_CHANNELS];
  bool multiple_scattering;
} volume_look;

/* A volume of the frame. Its grid is the plan's grid of the same index. */
typedef struct frame_volume {
  const char *name;                 /* borrowed; null: none */
  const hl_volume *volume;          /* borrowed; for its colours and the range of its values */
  const hl_volume *tints;           /* borrowed; the colours of its mask; null: none */
  const classifier *classifier;     /* borrowed; the transfer function's tables */
  double empty;                     /* data value beyond the volume */
  uint64_t version, tables_version; /* versions of the grid's voxels, and of all tables that follow from
                                     * the transfer function; a version rises with each change */
  int object;                       /* the volume's number in the layer of objects */
  bool visible, casts_shadow, receives_shadow, is_cut;
  volume_look look;
} frame_volume;

/* A light of the frame, as a whole. Its light_source, or the light_source of each of its sectors, says where
 * its rays run. */
typedef struct frame_light {
  int index;              /* the light's number in the scene's list of lights; suns of a sky follow the
                           * lights of the list */
  double sun_part;        /* the fraction of the light that a medium takes, where the light is a sun of the
                           * sky; else 0 */
  bool is_wide;           /* the light has an extent, or its rays have several directions at a point */
  bool is_inverse_square; /* samples receive the intensity divided by the square of their distance */
  bool has_image;         /* the light projects a picture, or shows a picture on its surface */
  bool has_colored_image; /* the light shows a picture on its surface, whose colours come from different
                           * places on the light */
  double color[HL_CHANNELS], intensity; /* frame space */
} frame_light;

/* A mesh of the frame, or an isosurface of a volume. Its primitives are those of the surfaces' mesh of the
 * same index. */
typedef struct frame_mesh {
  const char *name; /* borrowed; null: none */
  int object;       /* the mesh's number in the layer of objects; an isosurface has the number of its
                     * volume */
  surface_look look;
} frame_mesh;

/* Describe a volume, a light and a mesh of the scene for the frame. framed: must live until the frame ends.
 * The caller sets the volume's classifier, value beyond and versions. */
frame_volume hl_frame_volume(const framed_scene *framed, size_t index);
frame_light hl_frame_light(const framed_scene *framed, size_t index);
frame_mesh hl_frame_mesh(const framed_scene *framed, size_t index);

#endif
