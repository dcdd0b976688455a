/* scene/geometry/lengths.h - finds the unit of lengths of a scene's world, and converts the lengths of files
 * to this unit. */
#ifndef HL_SCENE_GEOMETRY_LENGTHS_H
#define HL_SCENE_GEOMETRY_LENGTHS_H

#include <halflight/scene.h>

#include "volume/volume.h"

/* The length in metres of one unit of the scene's world, by the unit that the file of a volume tells and by
 * the volume's scale. The first volume counts whose file tells a unit and whose scale is the same along all
 * axes; the result is 0 if the scene has no such volume. */
double hl_scene_world_metres(const hl_scene_description *scene);

/* The factor by which the lengths of a volume's file are multiplied to be lengths of a scene's world. The
 * factor is 1 if the volume's file or the scene tells no unit. */
double hl_scene_file_scale(const hl_scene_description *scene, const hl_volume *volume);

#endif
