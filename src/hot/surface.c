/* hot/surface.c - compiles the hot functions of meshes, which find the pixels that triangles and spheres
 * cover. */
#include "hot/tables.h"

#include "surface/small_spheres_lanes.h"
#include "surface/small_triangles_lanes.h"

const surface_functions HL_HOT(surface) = {cover_small, see_cluster, cover_cluster, cover_spheres};
