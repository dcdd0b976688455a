/* plan/frame_objects.h - describes the volumes, lights and meshes of a frame, as plain data in frame space.
 *
 * In: the scene that is brought to frame space (framed_scene.h). Out: the properties of the scene's volumes,
 * lights and meshes that back ends read. Back ends do not read descriptions of a scene. */
#ifndef HL_PLAN_FRAME_OBJECTS_H
#define HL_PLAN_FRAME_OBJECTS_H

#include "grid/classifier.h"
#include "light/light_source.h"
#include "plan/framed_scene.h"
#include "surface/surfaces.h"

/* The look of a volume's matter, and the amount of light that it absorbs. */
typedef struct volume_look {
  hl_shading shading;
  hl_cut_shading cut_shading;
  hl_material material;
  double anisotropy; /* anisotropy of the phase function */
  double albedo[HL_CHANNELS], attenuation_color[HL_CHANNELS];
  bool multiple_scattering;
} volume_look;

/* A volume of the frame. Its grid is the plan's grid with the same index. */
typedef struct frame_volume {
  const char *name;                 /* the volume's name; borrowed; null if the volume has no name */
  const hl_volume *volume;          /* the volume; borrowed for its own colours and for the range of its
                                     * values */
  const hl_volume *tints;           /* the mask whose colours tint the volume; borrowed; null if the volume
                                     * has no mask */
  const classifier *classifier;     /* borrowed; the transfer function's tables */
  double empty;                     /* the data value of the space beyond the volume */
  uint64_t version, tables_version; /* versions of the grid's voxels, and of all tables that follow from the
                                     * transfer function. Each change raises a version */
  int object;                       /* the volume's number in the layer of objects */
  bool visible, casts_shadow, receives_shadow;
  bool is_cut, is_clipped; /* whether the scene has shapes that cut the volume, and a clip box */
  volume_look look;
} frame_volume;

/* A light of the frame, as a whole. The light_source of the light, or of each of its sectors, describes the
 * rays. */
typedef struct frame_light {
  int index;       /* the light's number in the scene's list of lights; suns of a sky follow the
                    * lights of the list */
  double sun_part; /* if the light is a sun of the sky: the fraction of its light that a medium takes; for
                    * other lights 0 */
  bool is_wide;    /* whether the light has an extent, or its rays have several directions at a
                    * point */
  /* whether the light that a sample receives is the intensity divided by the square of the sample's
   * distance */
  bool is_inverse_square;
  bool projects_image, shows_image; /* whether the light projects a picture, and whether the light shows a
                                     * picture on its own surface */
  /* whether the light shows a picture of several colours on its surface, so that its colours come from
   * different places */
  bool has_colored_image;
  double color[HL_CHANNELS], intensity; /* the light's linear RGB, and its intensity in units of frame
                                         * space */
} frame_light;

/* A mesh of the frame, or an isosurface of a volume. The frame's surfaces hold the primitives of this mesh
 * under the same index. */
typedef struct frame_mesh {
  const char *name; /* the mesh's name; borrowed; null if the mesh has no name */
  int object;       /* the mesh's number in the layer of objects; an isosurface has the number of its
                     * volume */
  surface_look look;
} frame_mesh;

/* hl_frame_volume(), hl_frame_light() and hl_frame_mesh() describe a volume, a light and a mesh of the scene
 * for the frame. framed: the scene in frame space, which must live until the frame ends. The caller sets the
 * volume's classifier, its value beyond the volume, and its versions. */
frame_volume hl_frame_volume(const framed_scene *framed, size_t index);
frame_light hl_frame_light(const framed_scene *framed, size_t index);
frame_mesh hl_frame_mesh(const framed_scene *framed, size_t index);

#endif
