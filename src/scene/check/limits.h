/* scene/check/limits.h - defines limits that several checks share; the range of each setting is in
 * settings_table.c.
 */
#ifndef HL_SCENE_CHECK_LIMITS_H
#define HL_SCENE_CHECK_LIMITS_H

#define HL_LIMIT_PIXELS         32768 /* greatest width and height of a picture, in pixels */
#define HL_LIMIT_LIGHTS         256
#define HL_LIMIT_VOLUMES        256
#define HL_LIMIT_MESHES         256
#define HL_LIMIT_ISO            64    /* greatest number of isosurfaces of one volume */
#define HL_LIMIT_CUTS           64    /* greatest number of cuts of one volume, and of a scene */
#define HL_LIMIT_VERTICES       1024  /* greatest number of vertices of one polygon */
#define HL_LIMIT_TEXTURE_SIDE   32768 /* greatest number of pixels along a side of a light's texture */
#define HL_LIMIT_TEXTURE_PIXELS (1 << 26)
#define HL_LIMIT_POINTS         65536 /* greatest number of points of one transfer function */
/* The greatest number of boxes, or of polygons, of a transfer function of two numbers. */
#define HL_LIMIT_SHAPES 256
/* greatest number of pixels along a side of the image of a transfer function of two numbers */
#define HL_LIMIT_PLANE_SIDE 4096
#define HL_LIMIT_LENGTH     1e15 /* greatest coordinate or length; its square and its cube are finite */
/* The greatest distance of a volume from the origin. A camera that frames a volume at this distance stands
 * within HL_LIMIT_LENGTH of the origin. */
#define HL_LIMIT_CORNER 1e14
/* The greatest intensity of a light. The limit is large because light may fall off with the square of a
 * distance that is given in nanometres. */
#define HL_LIMIT_INTENSITY 1e35
/* The greatest brightness of a light at a distance of one voxel edge. Floats can hold sums of such
 * brightnesses, and their products with factors up to 1e18. */
#define HL_LIMIT_BRIGHTNESS    1e20
#define HL_LIMIT_REACH         1e12 /* greatest distance or length, in edges of the smallest voxel */
#define HL_LIMIT_TEXTURE_VALUE 1e6
#define HL_LIMIT_RADIANCE      1e6 /* greatest radiance of a sky's colours, and greatest strength of a sky */
/* The greatest value of a voxel. Differences and sums of such values still fit floats. */
#define HL_LIMIT_VOXEL_VALUE   1e36
#define HL_LIMIT_LIGHT_SAMPLES 64
#define HL_LIMIT_PIXEL_SAMPLES 8
#define HL_LIMIT_THREADS       1024
#define HL_LIMIT_SLABS_AT_ONCE 64
#define HL_LIMIT_SHININESS     10000
#define HL_LIMIT_EMISSION      1e6
#define HL_LIMIT_EXPOSURE      32 /* greatest magnitude of an exposure, in stops */

#endif
