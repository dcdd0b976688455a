/* reference/reference.h - the inside of the oracle: a ray marcher in double precision.
 *
 * The oracle, also called the reference, computes a scene's picture slowly and accurately. The sheet renderer
 * is judged by this picture. The two share the scene and its transfer functions, but no rendering code.
 *
 *
 *     reference.c       camera, rows of pixels, the entry point
 *     march.c           a ray through the volumes' boxes, step by step, jumping over empty bricks
 *     bricks.c          fields in bricks
 *     field.c           reconstruction of one volume at a point: value, gradient, extinction, empty bricks
 *     cuts.c            which points cuts leave
 *     clip_faces.c      the box's faces that cut matter
 *     tint.c            the colours of a volume's own voxels, and of its mask
 *     mask.c            a mask's factor and colour
 *     coefficients.c    the coefficients of the interpolating kernel
 *     rays.c            how many rays a pixel of a small picture has
 *     lights.c          points on the lights, their images, and the transmittance towards them
 *     sky.c             cells of the sky, and their light that reaches a sample
 *     shade.c           the light that one sample sends to the eye
 *     layers.c          this light by its sources, depth and normals
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
  mat3 gradient_to_world;           /* inverse transpose of index-to-world */
  double low[3], high[3];           /* the box, in index space */
  double clip_low[3], clip_high[3]; /* the faces of the box at which matter ends; infinite where another
                                     * volume goes on */
  double empty_value;               /* data value of voxels that are not finite */
  double empty_stored;              /* data value of voxels that are not finite, as a stored value */
  double transparent_below; /* where the data value is below this, there is no matter; -infinity: no value
                             * means this */
  double surface_gradient;  /* least gradient that makes a surface, data value per world unit */
  double smallest_edge;     /* shortest edge of a voxel, world units */
  size_t bricks[3];         /* number of bricks along i, j, k */
  double *coefficients;     /* owned; [k][j][i], stored values; the coefficients that the interpolating kernel
                             * sums in place of voxels; null for other kernels */
  double least, greatest;   /* with coefficients: the range of values; values beyond the range count as its
                             * ends */
  double (*ranges)[2];      /* owned; [slots]; for a field in bricks, the least and greatest coefficient of
                             * each brick; null for voxels */
  double *feet; /* owned; [HL_REFERENCE_FEET]; the range from feet_low to feet_high is divided into equal
                 * steps. For each step: matter with these values belongs to a surface; this is the value at
                 * which the surface begins */
  double feet_low, feet_high;
  double *depths; /* owned; [HL_REFERENCE_FEET + 1]; the integral of extinction over values, from feet_low to
                   * the ends of these steps */
  const struct reference_volume *second; /* the other volume of a function of two numbers, else null */
  affine3 index_to_second;               /* maps the volume's index space to the second volume's */
  affine3 index_to_mask;    /* maps the volume's index space to its mask's index space, if it has a mask */
  unsigned char *clearance; /* owned; [k][j][i], for each brick: 0 if it may be visible, else the distance
                             * (chessboard metric, in bricks) to the nearest brick that may be, at most 255 */
} reference_volume;

/* One light. points: [point_count]; points of the light, in the world; for a directional light, unit vectors
 * towards points of it. */
typedef struct reference_light {
  const hl_light *described;
  bool directional;
  bool sphere;                       /* the light is a sphere, whose points are computed for every sample */
  vec3 centre;                       /* world; not for directional lights */
  vec3 towards;                      /* directional lights: unit vector to the light */
  double color[3];                   /* color * intensity */
  double least_distance;             /* world units; a light with falloff gets no brighter at smaller
                                      * distances */
  const hl_light_texture *texture;   /* null if absent */
  const hl_light_emission *emission; /* emission image; null if absent */
  double mean[3];                    /* mean of the emission image over the light's surface */
  vec3 *points;                      /* owned; null for lights without shadows and for spheres */
  size_t point_count;
  vec3 *extent; /* owned; [EXTENT_POINTS], positions in the world; null for parallel light or a point */
  double cap;   /* for a parallel light: cosine of half its angular diameter */
} reference_light;

/* The number of points of a light over which the phase function is averaged. */
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

/* A node of the tree: a box around triangles. second is 0 in a leaf. */
typedef struct reference_node {
  double low[3], high[3];
  size_t first, count; /* the triangles' first index and number */
  size_t second;       /* index of the second child; the first child follows the node */
} reference_node;

typedef struct reference_surfaces {
  reference_triangle *triangles; /* owned; [triangle_count] */
  reference_node *nodes;         /* owned; [node_count] */
  vec3 *normals;                 /* owned; normals, of any length, of the vertices of all meshes */
  size_t *first_normal;          /* owned; [mesh_count] */
  size_t triangle_count, node_count;
} reference_surfaces;

/* A part of the sky. */
typedef struct reference_sky_cell {
  /* World: the unit vector to the cell's middle, and the mean of the unit vectors to all points of the cell.
   * If the sky is an image, its light weights both of them. */
  vec3 direction, mean;
  double radiance[3]; /* the cell's mean radiance */
} reference_sky_cell;

typedef struct reference_sky {
  reference_sky_cell *cells; /* owned; [count]; null if there is no sky */
  size_t count;
  double solid_angle; /* solid angle of a cell */
} reference_sky;

typedef struct reference {
  hl_context *context;
  hl_pool *pool;
  const hl_scene_description *scene;
  reference_volume *volumes; /* owned; [scene->volume_count] */
  reference_light *lights;   /* owned; [scene->light_count] */
  reference_surfaces surfaces;
  reference_sky sky;
  double step;  /* world units */
  int rays;     /* rays along each side of a pixel */
  int paths;    /* number of paths from each pixel for light that is scattered more than once; 0 if no volume
                 * scatters light so */
  float *error; /* the caller's; [height][width][3]: the standard error of the light that paths estimate; null
                 * if not wanted */
  double most_opacity; /* greatest opacity that one sample may add to a pixel */
  bool all_shadows;    /* whether layers need the transmittance of every light at every sample */
} reference;

typedef struct reference_ray {
  vec3 origin, direction;   /* world; the direction has unit length */
  double nearest, farthest; /* distances along the ray, which may be infinite */
} reference_ray;

/* A ray's passage through one volume's box. */
typedef struct crossing {
  const reference_volume *volume;
  vec3 origin, direction;     /* in index space; distances along the ray are in world units */
  double enter, leave;        /* distances; enter >= leave if the ray misses the box */
  bool uncut;                 /* whether the volume's cuts are ignored */
  bool active;                /* whether the ray's current stretch lies in the part of the box that cuts
                               * leave */
  bool occupied;              /* whether the crossing is active and the brick at `here` may be visible */
  vec3 here;                  /* index space; the current sample; only if the crossing is active */
  double last_at, last_value; /* for hl_reference_outside(): the last distance at which the ray was in the
                               * volume, and the value there; NaN: there is none yet */
} crossing;

/* A march along a ray. A stretch is the part of the ray between two faces of boxes or cuts, and is divided
 * into equal steps. */
typedef struct march {
  crossing *crossings; /* borrowed; [count] */
  size_t count;
  double longest_step;
  double start, end;  /* the current stretch */
  double length;      /* length of a step */
  double next, steps; /* whole numbers: the index of the next step of the stretch, and the stretch's number of
                       * steps */
  double at;          /* distance of the current sample */
} march;

/* A receiver of light: either a point, or the outside of the volume's surface in which the point lies. */
typedef struct reference_receiver {
  vec3 point;                         /* world */
  const reference_volume *surface_of; /* the volume whose surface receives the light; null: the point receives
                                       * it */
  double value;                       /* the volume's value at the point */
} reference_receiver;

/* The light of one source that arrives at a sample. */
typedef struct arrival {
  vec3 towards;       /* unit vector to the light's centre */
  double incoming[3]; /* brightness before light texture and attenuation; eq. (1) */
  double pattern[3];  /* mean over the light's points of the colour that the light texture or emission image
                       * gives to their light; 1 if the light has neither; eq. (2) */
  double shadowed[3]; /* mean over the light's points of this colour times the transmittance from the point to
                       * the sample */
  double outside[3];  /* as `shadowed`, but for light that goes to the outside of the surface in which the
                       * sample lies */
  bool pattern_known, shadowed_known, outside_known;
} arrival;

/* One light's contribution: the light sent to the eye, and the transmittance towards the light. */
typedef struct light_part {
  double picture[3], shadow[3];
} light_part;

/* The contributions to a sample or to a ray. They are sums, weighted by extinction for a sample and by
 * opacity for a ray. */
typedef struct reference_parts {
  double weight;   /* sum of the weights; for a ray: alpha */
  int object;      /* for a sample: the object with the greatest weight; for a ray: the object at which alpha
                    * first reaches 0.01 */
  double greatest; /* for a sample: the greatest weight among the objects so far */
  double ambient[3], emission[3], sky[3];
  double sky_reaching[3], sky_open[3]; /* the sky's light, as if matter were white: the light that reaches the
                                        * matter, and the light that would reach it if nothing hid the sky */
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

/* One thread's state; all arrays are owned by hl_reference_render. */
typedef struct reference_worker {
  int number;             /* number in the pool */
  crossing *eye, *shadow; /* [volume_count] */
  arrival *arrivals;      /* [light_count] */
  reference_parts sample, ray, pixel;
} reference_worker;

hl_status hl_reference_volume_create(const reference *all, const hl_scene_volume *described, hl_pool *pool,
                                     reference_volume *made, hl_error *error);
/* Finds the number of rays along each side of a pixel, at most HL_REFERENCE_RAYS. It is more than one if
 * voxels are smaller than pixels. edge: the length of a voxel's edge, world units. */
enum { HL_REFERENCE_RAYS = 8 };
int hl_reference_rays(const reference *all, double edge);
/* The distance, in lengths of `direction`, for which a ray from `point` (index space) stays in transparent
 * bricks; 0 if the point's own brick may be visible. */
double hl_reference_clearance(const reference_volume *volume, vec3 point, vec3 direction);

/* Fills volume->coefficients. */
hl_status hl_reference_coefficients_create(hl_context *context, reference_volume *volume, hl_error *error);
void hl_reference_volume_release(hl_context *context, reference_volume *volume);

/* ---- cuts (cuts.c) ---- */

/* Whether the volume's cuts leave a point of index space. */
bool hl_reference_left(const reference_volume *volume, vec3 point);
/* Whether the scene's own cuts leave a point of a mesh. point: world. */
bool hl_reference_mesh_left(const hl_scene_description *scene, const hl_scene_mesh *mesh, vec3 point);
/* The distance, greater than `after`, at which a ray of index space next crosses the face of a cut; infinite
 * if there is none. */
double hl_reference_next_face(const reference_volume *volume, vec3 origin, vec3 direction, double after);
/* Changes the shading of a sample near the face of a cut or of the clip box. *normal, *surface: in: as the
 * data give them. Returns how much the face counts: 1 at the face, falling to 0 behind it. */
double hl_reference_cut_face(const reference_volume *volume, vec3 point, vec3 to_eye, vec3 *normal,
                             double *surface);
/* How much matter at a point belongs to the face through which light from this direction came last: 1 at the
 * face, 0 from two voxels behind it on. to_light: a unit vector of the world. uncut: only the faces of the
 * box count, and not those of cuts. */
double hl_reference_lit_face(const reference_volume *volume, vec3 point, vec3 to_light, bool uncut);

/* Finds the weights of the four taps along an axis, and their slopes (slope may be null). The point lies
 * between the second and the third tap, at the distance t (0 to 1) after the second. */
void hl_reference_weights(hl_kernel kernel, double t, double weight[4], double slope[4]);

/* The value of a field in bricks at a point of the volume's index space, and its derivative with respect to
 * the coordinates. Coefficients that are not finite are replaced by the empty value. */
double hl_reference_bricks_value(const reference_volume *volume, vec3 point);
vec3 hl_reference_bricks_slope(const reference_volume *volume, vec3 point);
/* Finds the range of the coefficients of each brick. *ranges: owned by the caller. False if memory is short.
 */
bool hl_reference_bricks_ranges(hl_context *context, const struct hl_bricks *bricks, double empty,
                                double (**ranges)[2]);
/* The range of the coefficients in all bricks that a box of index space touches. All values of the field in
 * the box lie in this range. */
void hl_reference_bricks_range(const struct hl_bricks *bricks, double empty, double (*ranges)[2],
                               const double low[3], const double high[3], double range[2]);

double hl_reference_stored_value(const reference_volume *volume, const size_t voxel[3]);
double hl_reference_value(const reference_volume *volume, vec3 point);
/* Multiplies a colour by the colour of the volume's own voxels, if they have colours, and mixes it with the
 * mask's colour. */
void hl_reference_tint(const reference_volume *volume, vec3 point, double color[3]);
/* The factor by which the volume's mask multiplies extinction, at a point of the volume's index space; 1
 * without a mask. */
double hl_reference_mask_factor(const reference_volume *volume, vec3 point);
/* The gradient of the mask's factor, per world unit, at a point of index space; 0 if the mask leaves no
 * faces. */
vec3 hl_reference_mask_slope(const reference_volume *volume, vec3 point);
/* Finds the mask's colour at a point. Returns the part of this colour that matter takes, 0 to 1. */
double hl_reference_mask_color(const reference_volume *volume, vec3 point, double color[3]);
/* The field's gradient, in data values per world unit. */
vec3 hl_reference_gradient(const reference_volume *volume, vec3 point);
/* Finds the faces of the volume's box at which its matter ends: those beyond which no other volume goes on.
 * The box must be known. */
void hl_reference_find_clip_faces(const hl_scene_description *scene, reference_volume *volume);
/* The outward normal, in the world, of the cut whose face is nearest to a point of index space. */
vec3 hl_reference_cut_normal(const reference_volume *volume, vec3 point);
/* The distance, in lengths of `direction`, from a point of index space to the place where a ray leaves the
 * box. It is negative if another volume goes on there. *outward: the normal of the face there, in the
 * world. */
double hl_reference_leaves_box(const reference_volume *volume, vec3 point, vec3 direction, vec3 *outward);
/* The extinction sigma at a point, 1 / world length: sigma(f) = -ln(1 - alpha(f)) / u, times gradient
 * opacity. value: the value at the point. */
double hl_reference_extinction(const reference_volume *volume, double value, vec3 point);
/* The sums of extinction and colour that a function of two numbers has at a point. */
plane_sum hl_reference_plane_sum(const reference_volume *volume, double value, vec3 point);
/* The colour of the transfer function, linear RGB. */
void hl_reference_color(const reference_volume *volume, double value, vec3 point, double color[3]);
/* Finds the second volume of a function of two numbers. Called after all volumes were made. */
void hl_reference_find_second(const reference *all, size_t index);

/* Sets the volumes of a march. */
typedef enum reference_role { REFERENCE_SEEN, REFERENCE_CASTS_SHADOW } reference_role;

/* Sets up a crossing of part->volume by the ray, between two distances. */
void hl_reference_cross_box(crossing *part, const reference_ray *ray, double nearest, double farthest);
void hl_reference_march_begin(const reference *all, reference_role role, const reference_ray *ray,
                              crossing *crossings, march *walk);
/* Moves all crossings to a distance in the current stretch. Returns the distance, from there on, for which
 * all volumes are transparent; 0 if one may be visible. */
double hl_reference_march_place(march *walk, double at);
/* Moves to the middle of the next step at which at least one crossing is occupied; false at the end of the
 * ray. */
bool hl_reference_march_next(march *walk);

hl_status hl_reference_light_create(const reference *all, const hl_light *light, int point_count,
                                    reference_light *made, hl_error *error);
/* The light that arrives at a point of the world if no volume attenuates it. */
void hl_reference_light_arrive(const reference_light *light, vec3 point, arrival *arrived);
/* The mean over the light's points of transmittance times the colour of the light texture or emission image
 * (1 without either). If `attenuated` is false, the transmittance counts as 1. */
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
/* The fraction of light, in each channel, that passes along a ray to the outside of the volume's surface in
 * which the ray begins. */
void hl_reference_outside(const reference *all, const reference_ray *ray, const reference_receiver *at,
                          crossing *scratch, double passing[3]);
/* Fills volume->feet and volume->depths. The volume's other members must be known. */
enum { HL_REFERENCE_FEET = 4096 };
hl_status hl_reference_feet_create(hl_context *context, reference_volume *volume, hl_error *error);
/* Henyey and Greenstein's phase function times 4 pi, for light that comes from `towards` (unit vector) and
 * goes to the eye. */
double hl_reference_phase(double anisotropy, vec3 to_eye, vec3 towards);

/* Adds the light of one random path from the eye: light that was scattered at least twice. seed: another one
 * for each path. */
void hl_reference_path(const reference *all, vec3 origin, vec3 direction, uint64_t seed,
                       reference_worker *worker, double sum[3]);

/* A point that the sky lights. */
typedef struct reference_sky_receiver {
  vec3 point, normal, to_eye; /* world; unit vectors; the normal is 0 in a medium */
  double surface;             /* 0 for a medium, 1 for a surface */
  double diffuse;             /* a surface's factor of diffuse colour */
  double anisotropy;          /* a medium's anisotropy, from -1 to 1 */
  const double *albedo;       /* [3]; the medium's; null for 1 */
  bool receives_shadow;
} reference_sky_receiver;

/* The sky's light at a receiver: all of the sky's light, the part of this light that reaches the receiver,
 * and the light that the receiver sends on. An even sky of radiance 1 has the light 1. */
typedef struct reference_sky_light {
  double open[3], reaching[3], sent[3];
} reference_sky_light;

/* Cuts the scene's sky into about cell_count cells. */
hl_status hl_reference_sky_create(reference *all, int cell_count, hl_error *error);
void hl_reference_sky_arrive(const reference *all, const reference_sky_receiver *at, reference_worker *worker,
                             reference_sky_light *light);

/* Adds the light that the sample sends to the eye, times the sample's weight, to the worker's sample. */
void hl_reference_shade(const reference *all, const reference_sample *at, reference_worker *worker);

/* Finds the pixel of a maximum projection: premultiplied RGBA, with alpha 1 if any volume shows something. */
void hl_reference_maximum(const reference *all, vec3 origin, vec3 direction, reference_worker *worker,
                          float rgba[4]);

/* ---- meshes (surfaces.c, shade_surface.c) ---- */

hl_status hl_reference_surfaces_create(reference *all, hl_error *error);
void hl_reference_surfaces_release(reference *all);

/* A hit: the point where a ray meets a triangle or a volume's isosurface. */
typedef struct reference_hit {
  const reference_triangle *triangle; /* null for an isosurface */
  double distance;
  double weight[3];               /* weights of the triangle's corners */
  const hl_isosurface *iso;       /* null for a triangle */
  const reference_volume *volume; /* the isosurface's volume */
  vec3 face;                      /* unit normal of the face, if a face of the box or of a cut closes the
                                   * isosurface here; else 0 */
  double opacity;
} reference_hit;

/* A point of a surface that is shaded. */
typedef struct reference_surface_point {
  vec3 point, normal, to_eye; /* world; unit vectors; the normal is on the eye's side */
  double color[3], behind[3]; /* behind: the fraction of light from behind that the surface lets through */
  hl_material material;
  bool receives_shadow;
} reference_surface_point;

/* Finds the first triangle or isosurface farther along the ray than `after` and nearer than ray->farthest;
 * false if there is none. */
bool hl_reference_surface_next(const reference *all, reference_role role, const reference_ray *ray,
                               double after, reference_hit *hit);
/* Sets *hit to the first isosurface farther along the ray than `after` and nearer than hit->distance, if
 * there is one. */
void hl_reference_iso_next(const reference *all, reference_role role, const reference_ray *ray, double after,
                           reference_hit *hit);
/* The unit normal of an isosurface. It points away from the inside, where values are greater. point:
 * world. */
vec3 hl_reference_iso_normal(const reference_hit *hit, vec3 point);
/* The fractions of red, green and blue light that pass all surfaces on a ray, which may begin on a surface.
 */
void hl_reference_surfaces_passing(const reference *all, const reference_ray *ray, double passing[3]);
/* Sets the worker's sample, with weight 1, to the light that the surface sends back along the ray. */
void hl_reference_surface_shade(const reference *all, const reference_hit *hit, const reference_ray *ray,
                                reference_worker *worker);

/* A ray that begins on a surface cannot meet this surface within this fraction of a step. */
#define LEAST_GAP 1e-3

/* These functions handle contributions to samples and rays (layers.c): set them to zero; add other
 * contributions, times `scale`; write one pixel of the caller's layers. */
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
