/* reference/reference.h - declares the parts of the oracle, which is a ray marcher in double precision.
 *
 * The oracle, also called the reference, computes a scene's picture slowly and accurately. The pictures of
 * the sheet renderer are compared with this picture. The reference and the renderer share the scene and its
 * transfer functions, but no rendering code.
 *
 *     reference.c       camera, rows of pixels, the entry point
 *     march.c           a ray through the volumes' boxes, step by step, jumping over empty bricks
 *     bricks.c          the value of a field that is stored in bricks
 *     field.c           reconstruction of one volume at a point: value, gradient, extinction, empty bricks
 *     cuts.c            which points remain after the cuts
 *     clip_faces.c      the faces of a volume's box at which its matter is cut off
 *     tint.c            the colours of a volume's own voxels, and of its mask
 *     mask.c            the factor by which a mask multiplies extinction, and its colour
 *     coefficients.c    the coefficients of the interpolating kernel
 *     rays.c            how many rays a pixel needs in a small picture of a large volume
 *     lights.c          points on the lights, their images, and the transmittance towards them
 *     sky.c             cells of the sky, and their light that reaches a sample
 *     shade.c           the light that one sample sends to the eye
 *     layers.c          layers beside the picture: light by its sources, depth and normals
 *     surfaces.c        where rays meet meshes
 *     isosurfaces.c     where rays meet surfaces of one value
 *     paths.c           light that media scatter more than once
 *     shade_surface.c   the light that a surface sends to the eye
 *     maximum.c         the greatest value along a ray, in place of light */
#ifndef HL_REFERENCE_REFERENCE_H
#define HL_REFERENCE_REFERENCE_H

#include <stdbool.h>

#include <halflight/layers.h>

#include "core/error.h"
#include "core/pool.h"
#include "core/vector.h"
#include "scene/function/function_plane.h"
#include "scene/light/light_shape.h"
#include "scene/light/sky.h"
#include "scene/scene.h"

/* One volume of the scene, prepared for sampling at points of its index space. */
typedef struct reference_volume {
  const hl_scene_volume *described;
  const hl_volume *grid;
  hl_kernel kernel;
  affine3 index_to_world, world_to_index;
  mat3 gradient_to_world;           /* maps a gradient in index space to a gradient in the world: the inverse
                                     * transpose of index_to_world's linear part */
  double low[3], high[3];           /* the volume's box, in index space */
  double clip_low[3], clip_high[3]; /* the faces of the box at which the volume's matter ends; infinite where
                                     * another volume continues the matter */
  double empty_value;               /* the data value that stands for voxels that are not finite */
  double empty_stored;              /* empty_value as a stored value */
  double transparent_below; /* space with a data value below this number holds no matter; -infinity if the
                             * transfer function alone decides */
  double surface_gradient;  /* the least gradient at which matter counts fully as a surface, in data values
                             * per world unit */
  double smallest_edge;     /* the length of a voxel's shortest edge, world units */
  size_t bricks[3];         /* number of bricks along i, j, k */
  double *coefficients;     /* owned; [k][j][i], stored values; the coefficients that the interpolating kernel
                             * sums in place of voxels; null for other kernels */
  double least, greatest;   /* the range of the data values, set only if the volume has coefficients; a value
                             * beyond the range counts as the nearer end of the range */
  double (*ranges)[2];      /* owned; [slots]; for a field in bricks, the least and greatest coefficient of
                             * each brick; null for voxels */
  double *feet; /* owned; [HL_REFERENCE_FEET]; the range of data values from feet_low to feet_high is divided
                 * into equal steps. Matter with a value in step i belongs to a surface, and feet[i] is the
                 * value at which this surface begins */
  double feet_low, feet_high;
  double *depths; /* owned; [HL_REFERENCE_FEET + 1]; depths[i] is the integral of extinction over the data
                   * values from feet_low to the beginning of step i */
  const struct reference_volume *second; /* the second volume, if the transfer function takes its second
                                          * number from another volume; else null */
  affine3 index_to_second;               /* maps the volume's index space to the second volume's index
                                          * space */
  affine3 index_to_mask;    /* maps the volume's index space to its mask's index space, if it has a mask */
  unsigned char *clearance; /* owned; [k][j][i], one number for each brick: 0 if the brick may be visible;
                             * else the chessboard distance, in bricks, to the nearest brick that may be
                             * visible, at most 255 */
} reference_volume;

/* One light. points: [point_count]; positions on the light, in the world; for a directional light, unit
 * vectors towards points of the light. */
typedef struct reference_light {
  const hl_light *described;
  bool directional;
  bool sphere;                       /* whether the light is a sphere, whose points depend on the sample and
                                      * are computed for each sample */
  vec3 centre;                       /* the light's centre, world; not for directional lights */
  vec3 towards;                      /* unit vector towards the light; only for directional lights */
  double color[3];                   /* color * intensity */
  double least_distance;             /* the distance, in world units, within which a light with falloff gets
                                      * no brighter */
  const hl_light_texture *texture;   /* null if the light projects no texture */
  const hl_light_emission *emission; /* the image on the light's surface; null if the light has no such
                                      * image */
  double mean[3];                    /* mean of the emission image over the light's surface */
  vec3 *points;                      /* owned; null for lights without shadows; a sphere's points are not
                                      * used */
  size_t point_count;
  vec3 *extent; /* owned; [EXTENT_POINTS], positions on the light, in the world; null for directional lights
                 * and for point-like lights */
  double cap;   /* for a directional light: cosine of half its angular diameter */
} reference_light;

/* The number of points of a light over which a medium's phase function is averaged. */
enum { EXTENT_POINTS = 256 };

/* A triangle or a sphere of a mesh, in the world. */
typedef struct reference_triangle {
  vec3 corner[3]; /* the corners of a triangle; for a sphere, two opposite corners of the box around it, and
                   * its centre */
  double radius;  /* 0 for a triangle */
  const hl_scene_mesh *mesh;
  size_t index; /* index among the mesh's triangles, or among its spheres */
  double opacity;
} reference_triangle;

/* A node of the tree of boxes by which rays find triangles: a box around some of the triangles. A leaf has
 * the second child 0. */
typedef struct reference_node {
  double low[3], high[3];
  size_t first, count; /* the index of the first triangle in the box, and the number of triangles */
  size_t second;       /* index of the second child; the first child is the next node of the array */
} reference_node;

typedef struct reference_surfaces {
  reference_triangle *triangles; /* owned; [triangle_count] */
  reference_node *nodes;         /* owned; [node_count] */
  vec3 *normals;                 /* owned; vertex normals of all meshes, of any length */
  size_t *first_normal;          /* owned; [mesh_count] */
  size_t triangle_count, node_count;
} reference_surfaces;

/* A cell of the sky: a part of all directions. */
typedef struct reference_sky_cell {
  /* World: the unit vector to the cell's middle, and the mean of the unit vectors to all points of the cell.
   * If the sky is an image, brighter points weigh more in both vectors. */
  vec3 direction, mean;
  double radiance[3]; /* the cell's mean radiance */
} reference_sky_cell;

typedef struct reference_sky {
  reference_sky_cell *cells; /* owned; [count]; null if the scene has no sky */
  size_t count;
  double solid_angle; /* solid angle of each cell, steradians */
} reference_sky;

typedef struct reference {
  hl_context *context;
  hl_pool *pool;
  const hl_scene_description *scene;
  reference_volume *volumes; /* owned; [scene->volume_count] */
  reference_light *lights;   /* owned; [scene->light_count] */
  reference_surfaces surfaces;
  reference_sky sky;
  double step;  /* length of a step along a ray, world units */
  int rays;     /* number of rays along each side of a pixel */
  int paths;    /* number of random paths from each pixel, for light that is scattered more than once; 0 if no
                 * volume scatters light more than once */
  float *error; /* the caller's; [height][width][3]: receives the standard error of the light that paths
                 * estimate; null if the error is not wanted */
  double most_opacity; /* greatest opacity that one sample may add to a pixel */
  bool all_shadows;    /* whether the layers need the transmittance from every light to every sample */
} reference;

typedef struct reference_ray {
  vec3 origin, direction;   /* world; the direction has unit length */
  double nearest, farthest; /* the distances along the ray between which it is followed; they may be
                             * infinite */
} reference_ray;

/* The part of a ray that lies in one volume's box. */
typedef struct crossing {
  const reference_volume *volume;
  vec3 origin, direction;     /* in index space; distances along the ray are in world units */
  double enter, leave;        /* the distances at which the ray enters and leaves the box; enter >= leave if
                               * the ray misses the box */
  bool uncut;                 /* whether the volume's cuts are ignored */
  bool active;                /* whether the ray, in its current stretch, is in the box and in matter that no
                               * cut removes */
  bool occupied;              /* whether the crossing is active and the brick at `here` may be visible */
  vec3 here;                  /* the current sample in index space; valid only if the crossing is active */
  double last_at, last_value; /* used by hl_reference_outside(): the last distance at which the ray was in the
                               * volume, and the volume's value there; the value is NaN if the ray was not in
                               * the volume yet */
} crossing;

/* A march along a ray. A stretch is the part of the ray between two successive faces of boxes or cuts. A
 * stretch is divided into equal steps. */
typedef struct march {
  crossing *crossings; /* borrowed; [count] */
  size_t count;
  double longest_step;
  double start, end;  /* the current stretch */
  double length;      /* length of a step */
  double next, steps; /* whole numbers: the index of the stretch's next step, and the number of the stretch's
                       * steps */
  double at;          /* distance of the current sample along the ray */
} march;

/* A receiver of light: either a point, or the outside of the volume's surface that the point belongs to. */
typedef struct reference_receiver {
  vec3 point;                         /* world */
  const reference_volume *surface_of; /* the volume whose surface's outside receives the light; null if the
                                       * point itself receives the light */
  double value;                       /* the value of surface_of at the point */
} reference_receiver;

/* The light of one source that arrives at a sample. */
typedef struct arrival {
  vec3 towards;       /* unit vector to the light's centre */
  double incoming[3]; /* the light's brightness at the sample without light texture and attenuation; eq.
                       * (1) */
  double pattern[3];  /* mean over the light's points of the colour that the light texture or emission image
                       * gives to their light; 1 if the light has neither; eq. (2) */
  double shadowed[3]; /* mean over the light's points of the colour of `pattern` times the transmittance from
                       * the point of the light to the sample */
  double outside[3];  /* like `shadowed`, but for the light that reaches the outside of the surface in which
                       * the sample lies */
  bool pattern_known, shadowed_known, outside_known;
} arrival;

/* The contribution of one light: the light of this source that is sent to the eye, and the transmittance
 * towards the source. */
typedef struct light_part {
  double picture[3], shadow[3];
} light_part;

/* The contributions to a sample or to a ray. The members are sums. A sample's sum over volumes is weighted by
 * extinction; a ray's sum over samples is weighted by opacity. */
typedef struct reference_parts {
  double weight;   /* sum of the weights; for a ray, this is alpha */
  int object;      /* for a sample: the object with the greatest weight; for a ray: the object at which alpha
                    * first reaches 0.01 */
  double greatest; /* for a sample: the greatest weight among the objects so far */
  double ambient[3], emission[3], sky[3];
  double sky_reaching[3], sky_open[3]; /* the sky's light on white matter: the light that reaches the matter,
                                        * and the light that would reach it if nothing hid the sky */
  vec3 normal;
  double depth;
  light_part *lights; /* [light_count] */
} reference_parts;

/* A point of one volume that is shaded. */
typedef struct reference_sample {
  const reference_volume *volume;
  vec3 point, index_point; /* the point in the world and in index space */
  double value, weight;
  vec3 to_eye; /* unit vector */
} reference_sample;

/* The state of one thread. hl_reference_render() owns all arrays of the struct. */
typedef struct reference_worker {
  int number;             /* number in the pool */
  crossing *eye, *shadow; /* [volume_count] */
  arrival *arrivals;      /* [light_count] */
  reference_parts sample, ray, pixel;
} reference_worker;

hl_status hl_reference_volume_create(const reference *all, const hl_scene_volume *described, hl_pool *pool,
                                     reference_volume *made, hl_error *error);
/* Finds the number of rays along each side of a pixel, at most HL_REFERENCE_RAYS. The number is more than one
 * if voxels are smaller than pixels. edge: the length of a voxel's edge, world units. */
enum { HL_REFERENCE_RAYS = 8 };
int hl_reference_rays(const reference *all, double edge);
/* The distance over which a ray from `point` stays in transparent bricks, in units of the length of
 * `direction`; 0 if the point's own brick may be visible. point, direction: index space. */
double hl_reference_clearance(const reference_volume *volume, vec3 point, vec3 direction);

/* Fills volume->coefficients. */
hl_status hl_reference_coefficients_create(hl_context *context, reference_volume *volume, hl_error *error);
void hl_reference_volume_release(hl_context *context, reference_volume *volume);

/* ---- cuts (cuts.c) ---- */

/* Returns whether a point of index space remains after the volume's cuts. */
bool hl_reference_left(const reference_volume *volume, vec3 point);
/* Returns whether a point of a mesh remains after the scene's own cuts. point: world. */
bool hl_reference_mesh_left(const hl_scene_description *scene, const hl_scene_mesh *mesh, vec3 point);
/* The least distance greater than `after` at which a ray crosses the face of one of the volume's cuts;
 * infinite if the ray crosses no further face. origin, direction: index space. */
double hl_reference_next_face(const reference_volume *volume, vec3 origin, vec3 direction, double after);
/* Changes the normal and the surface fraction of a sample near the face of a cut or of the clip box. *normal,
 * *surface: on entry, the normal and the surface fraction that follow from the volume's data. Returns the
 * weight of the face: 1 at the face, 0 from two voxels behind the face on. */
double hl_reference_cut_face(const reference_volume *volume, vec3 point, vec3 to_eye, vec3 *normal,
                             double *surface);
/* The fraction of the matter at a point that belongs to the face of a cut or of the box through which the
 * light reaches the point: 1 at the face, 0 from two voxels behind the face on. to_light: a unit vector of
 * the world. uncut: whether only the faces of the box count, and not the faces of cuts. */
double hl_reference_lit_face(const reference_volume *volume, vec3 point, vec3 to_light, bool uncut);

/* Finds the weights of the four taps along an axis, and the weights' derivatives (slope; may be null). The
 * point lies between the second and the third tap, at the distance t (0 to 1) from the second. */
void hl_reference_weights(hl_kernel kernel, double t, double weight[4], double slope[4]);

/* The value of a field in bricks at a point of the volume's index space, and its derivative with respect to
 * the coordinates. Coefficients that are not finite are replaced by the empty value. */
double hl_reference_bricks_value(const reference_volume *volume, vec3 point);
vec3 hl_reference_bricks_slope(const reference_volume *volume, vec3 point);
/* Finds the range of the coefficients of each brick. *ranges: [slots], owned by the caller afterwards.
 * Returns false if memory is short. */
bool hl_reference_bricks_ranges(hl_context *context, const struct hl_bricks *bricks, double empty,
                                double (**ranges)[2]);
/* The range of the coefficients in all bricks that a box of index space touches. All values of the field in
 * the box lie in this range. */
void hl_reference_bricks_range(const struct hl_bricks *bricks, double empty, double (*ranges)[2],
                               const double low[3], const double high[3], double range[2]);

double hl_reference_stored_value(const reference_volume *volume, const size_t voxel[3]);
double hl_reference_value(const reference_volume *volume, vec3 point);
/* Multiplies a colour by the colour of the volume's own voxels, if they have colours, and then mixes the
 * product with the mask's colour. */
void hl_reference_tint(const reference_volume *volume, vec3 point, double color[3]);
/* The factor by which the volume's mask multiplies extinction, at a point of the volume's index space; 1
 * without a mask. */
double hl_reference_mask_factor(const reference_volume *volume, vec3 point);
/* The gradient, per world unit, of the mask's factor at a point of index space. The gradient is 0 if matter
 * gets no faces where the mask hides the matter beside it. */
vec3 hl_reference_mask_slope(const reference_volume *volume, vec3 point);
/* Finds the mask's colour at a point. Returns the fraction of the mask's colour, from 0 to 1, that is mixed
 * into the matter's colour. */
double hl_reference_mask_color(const reference_volume *volume, vec3 point, double color[3]);
/* The field's gradient, in data values per world unit. */
vec3 hl_reference_gradient(const reference_volume *volume, vec3 point);
/* Finds the faces of the volume's box at which the volume's matter ends, because no other volume continues
 * the matter there. The volume's box must have been found before. */
void hl_reference_find_clip_faces(const hl_scene_description *scene, reference_volume *volume);
/* The outward normal, in the world, of the cut whose face is nearest to a point of index space. */
vec3 hl_reference_cut_normal(const reference_volume *volume, vec3 point);
/* The distance from a point of index space to the face at which a ray leaves the volume's box, in units of
 * the length of `direction`. The distance is negated if another volume continues the matter at this face.
 * *outward: the face's normal, in the world. */
double hl_reference_leaves_box(const reference_volume *volume, vec3 point, vec3 direction, vec3 *outward);
/* The extinction sigma at a point, 1 / world length: sigma(f) = -ln(1 - alpha(f)) / u, times gradient
 * opacity. value: the value at the point. */
double hl_reference_extinction(const reference_volume *volume, double value, vec3 point);
/* The extinction and the colour weighted by extinction that a transfer function of two numbers has at a
 * point. */
plane_sum hl_reference_plane_sum(const reference_volume *volume, double value, vec3 point);
/* The colour of the transfer function, linear RGB. */
void hl_reference_color(const reference_volume *volume, double value, vec3 point, double color[3]);
/* Finds the second volume of a transfer function of two numbers. All volumes must have been made before. */
void hl_reference_find_second(const reference *all, size_t index);

/* Sets the volumes of a march. */
typedef enum reference_role { REFERENCE_SEEN, REFERENCE_CASTS_SHADOW } reference_role;

/* Sets up the crossing of the box of part->volume by a ray, between the ray's nearest and farthest
 * distance. */
void hl_reference_cross_box(crossing *part, const reference_ray *ray, double nearest, double farthest);
void hl_reference_march_begin(const reference *all, reference_role role, const reference_ray *ray,
                              crossing *crossings, march *walk);
/* Moves all crossings to a distance in the current stretch. Returns the length from this distance on over
 * which all volumes are transparent; 0 if one of the volumes may be visible at this distance. */
double hl_reference_march_place(march *walk, double at);
/* Moves to the middle of the next step at which at least one volume may be visible. Returns false at the end
 * of the ray. */
bool hl_reference_march_next(march *walk);

hl_status hl_reference_light_create(const reference *all, const hl_light *light, int point_count,
                                    reference_light *made, hl_error *error);
/* The light that arrives at a point of the world if no volume attenuates it. */
void hl_reference_light_arrive(const reference_light *light, vec3 point, arrival *arrived);
/* The mean over the light's points of the transmittance times the colour of the light texture or emission
 * image. The colour is 1 if the light has neither image. If `attenuated` is false, the transmittance counts
 * as 1. */
void hl_reference_light_reach(const reference *all, const reference_light *light,
                              const reference_receiver *at, bool attenuated, reference_worker *worker,
                              double reach[3]);

/* The mean over the light's points of the phase function times 4 pi, for light that goes from the light to
 * `point` and on to the eye. */
double hl_reference_light_phase(const reference_light *light, double g, vec3 to_eye, vec3 point);

/* The fraction of light that passes along a ray, in each channel: exp(-optical depth) times the fraction that
 * surfaces let through. scratch: [volume_count]. */
void hl_reference_transmittance(const reference *all, const reference_ray *ray, crossing *scratch,
                                double passing[3]);
/* The fraction of light, in each channel, that passes along a ray to the outside of a volume's surface. The
 * ray begins in this surface. */
void hl_reference_outside(const reference *all, const reference_ray *ray, const reference_receiver *at,
                          crossing *scratch, double passing[3]);
/* Fills volume->feet and volume->depths. The volume's other members must be known, except clearance. */
enum { HL_REFERENCE_FEET = 4096 };
hl_status hl_reference_feet_create(hl_context *context, reference_volume *volume, hl_error *error);
/* Henyey and Greenstein's phase function times 4 pi, for light that comes from `towards` (unit vector) and
 * goes to the eye. */
double hl_reference_phase(double anisotropy, vec3 to_eye, vec3 towards);

/* Adds the light that one random path from the eye finds: light that was scattered at least twice. seed:
 * starts the random numbers, and must differ from path to path. */
void hl_reference_path(const reference *all, vec3 origin, vec3 direction, uint64_t seed,
                       reference_worker *worker, double sum[3]);

/* A point that the sky lights. */
typedef struct reference_sky_receiver {
  vec3 point, normal, to_eye; /* the point in the world; unit vectors: the normal, which is 0 in a medium, and
                               * the direction to the eye */
  double surface;             /* the fraction of the sample that is surface: 0 in a medium, 1 on a surface */
  double diffuse;             /* the material's diffuse reflectance, for a surface */
  double anisotropy;          /* the anisotropy of a medium's phase function */
  const double *albedo;       /* [3]; the scattering albedo of a medium; null stands for 1 in each channel */
  bool receives_shadow;
} reference_sky_receiver;

/* The sky's light at a receiver: the light that would reach the receiver if nothing hid the sky, the part of
 * this light that reaches the receiver, and the light that the receiver sends on. In a medium, a sky of
 * radiance 1 in all directions gives the light 1. */
typedef struct reference_sky_light {
  double open[3], reaching[3], sent[3];
} reference_sky_light;

/* Cuts the scene's sky into about cell_count cells. */
hl_status hl_reference_sky_create(reference *all, int cell_count, hl_error *error);
void hl_reference_sky_arrive(const reference *all, const reference_sky_receiver *at, reference_worker *worker,
                             reference_sky_light *light);

/* Adds the light that a sample of a volume sends to the eye, times the sample's weight, to worker->sample. */
void hl_reference_shade(const reference *all, const reference_sample *at, reference_worker *worker);

/* Finds one pixel of a maximum projection: premultiplied RGBA. Alpha is 1 if the ray meets a shown value of
 * any volume. */
void hl_reference_maximum(const reference *all, vec3 origin, vec3 direction, reference_worker *worker,
                          float rgba[4]);

/* ---- meshes (surfaces.c, shade_surface.c) ---- */

hl_status hl_reference_surfaces_create(reference *all, hl_error *error);
void hl_reference_surfaces_release(reference *all);

/* A hit: the point where a ray meets a triangle or a volume's isosurface. */
typedef struct reference_hit {
  const reference_triangle *triangle; /* null for an isosurface */
  double distance;
  double weight[3];               /* the weights of the triangle's corners at the hit (barycentric
                                   * coordinates) */
  const hl_isosurface *iso;       /* null for a triangle */
  const reference_volume *volume; /* the isosurface's volume */
  vec3 face;                      /* the unit normal of the face of the box or of a cut, if the hit is on such
                                   * a face, which closes the isosurface; else 0 */
  double opacity;
} reference_hit;

/* A point of a surface that is shaded. */
typedef struct reference_surface_point {
  vec3 point, normal, to_eye; /* the point in the world; unit vectors: the normal on the eye's side, and the
                               * direction to the eye */
  double color[3], behind[3]; /* behind: the fraction of light from behind that the surface lets through */
  hl_material material;
  bool receives_shadow;
} reference_surface_point;

/* Finds the first triangle, sphere or isosurface on the ray that is farther than `after` and nearer than
 * ray->farthest. Returns false if the ray meets no such surface. */
bool hl_reference_surface_next(const reference *all, reference_role role, const reference_ray *ray,
                               double after, reference_hit *hit);
/* Sets *hit to the first isosurface on the ray that is farther than `after` and nearer than hit->distance.
 * Without such an isosurface *hit does not change. */
void hl_reference_iso_next(const reference *all, reference_role role, const reference_ray *ray, double after,
                           reference_hit *hit);
/* The unit normal of an isosurface at a point of the world. The normal points to the side where values are
 * smaller. */
vec3 hl_reference_iso_normal(const reference_hit *hit, vec3 point);
/* The colour of an isosurface at a point of the world. */
void hl_reference_iso_color(const reference_hit *hit, vec3 point, double color[3]);
/* The fractions of red, green and blue light that pass all surfaces on a ray. The ray may begin on a
 * surface. */
void hl_reference_surfaces_passing(const reference *all, const reference_ray *ray, double passing[3]);
/* Sets worker->sample, with weight 1, to the light that the surface at the hit sends back along the ray. */
void hl_reference_surface_shade(const reference *all, const reference_hit *hit, const reference_ray *ray,
                                reference_worker *worker);

/* Hits nearer to a ray's beginning than this fraction of a step do not count, so that a ray does not meet the
 * surface at which it begins. */
#define LEAST_GAP 1e-3

/* Functions for contributions to samples and rays (layers.c): hl_reference_parts_clear() sets contributions
 * to zero, hl_reference_parts_add() adds other contributions times `scale`, and hl_reference_parts_write()
 * writes one pixel of the caller's layers. */
void hl_reference_parts_clear(reference_parts *parts, size_t light_count);
void hl_reference_parts_add(reference_parts *parts, const reference_parts *other, double scale,
                            size_t light_count);
void hl_reference_parts_write(const reference_parts *parts, double depth_first, const hl_layers *layers,
                              size_t pixel);

/* The fraction of a light that reaches a point, without the image that the light projects. For a light with
 * an emission image, each channel has its own fraction. reach: the result of hl_reference_light_reach() at
 * the point. */
void hl_reference_light_shadow(const reference *all, const reference_light *light,
                               const reference_receiver *at, bool attenuated, const double reach[3],
                               reference_worker *worker, double shadow[3]);

#endif
