/* halflight/shape.h - makes volumes of shapes: solids, hypertexture, electron orbitals.
 *
 * A volume is described as in a scene file (docs/scene.md, "Shapes"): by a JSON object with the keys "shapes"
 * and, both optional, "voxel_size" and "groups":
 *
 *     { "shapes": [ { "type": "torus", "radius": 20, "tube_radius": 6 } ], "voxel_size": 1 }
 *
 * Solids have the value 1 inside, 0 outside and 0.5 on their surface; orbitals reach from -1 to 1. */
#ifndef HALFLIGHT_SHAPE_H
#define HALFLIGHT_SHAPE_H

#include "volume.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct hl_shapes_options {
  size_t struct_size; /* set by hl_shapes_options_defaults() */
  int size;    /* above 0: the number of voxels along the grid's longest side, which replaces the text's
                * voxel_size */
  int seed;    /* a number that is added to the seed of every hypertexture; default 0 */
  int threads; /* 0 stands for one thread per processor */
} hl_shapes_options;

HL_API void hl_shapes_options_defaults(hl_shapes_options *options);

/* Makes a volume of shapes. text: UTF-8 JSON, length bytes. name: the text's name in errors. options may be
 * null for the defaults. The same text gives the same voxels on every machine. *volume is owned by the
 * caller. */
HL_API HL_WARN_UNUSED hl_status hl_volume_from_shapes(hl_context *context, const char *text, size_t length,
                                                      const char *name, const hl_shapes_options *options,
                                                      hl_volume **volume, hl_error *error);

/* The presets are ready-made texts: "furry-sphere", "eroded-cube", "fire-ball", "cloud", "rings", "orbital",
 * ... */
HL_API const char *hl_shape_preset_name(size_t index);     /* null past the last */
HL_API const char *hl_shape_preset_summary(size_t index);  /* one line that describes the preset to a person;
                                                            * null past the last */
HL_API const char *hl_shape_preset_text(const char *name); /* null for an unknown name */

#ifdef __cplusplus
}
#endif
#endif
